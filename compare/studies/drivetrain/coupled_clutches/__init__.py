"""Four rotors and three clutches, Modelica's example."""

from compare.studies.drivetrain.coupled_clutches.study import STUDY as STUDY
