"""Four rotors and three clutches, Modelica's example, against exact solutions from event to event."""

from compare.studies.drivetrain.coupled_clutches.pictures import draw
from compare.studies.drivetrain.coupled_clutches.study import STUDY

STUDY.provides(figures=draw)

__all__ = ["STUDY"]
