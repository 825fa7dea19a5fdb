"""Four rotors and three clutches, Modelica's example, against exact solutions from event to event."""

from compare.studies.drivetrain.coupled_clutches.study import STUDY

__all__ = ["STUDY"]
