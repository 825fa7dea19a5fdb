"""Four rotors and three clutches, Modelica's example, compared with exact solutions between events."""

from compare.studies.drivetrain.coupled_clutches.study import STUDY

__all__ = ["STUDY"]
