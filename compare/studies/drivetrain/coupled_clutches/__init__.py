"""Modelica's CoupledClutches: four rotors and three clutches that slip, hold and open."""

from compare.studies.drivetrain.coupled_clutches.claims import STUDY as STUDY
