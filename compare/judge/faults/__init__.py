"""Mistakes that a judge of engines has to find, each in an engine that is right but for it."""

from compare.judge.faults.catalogue import FAULTS, RIGHT
from compare.judge.faults.fault import Fault

__all__ = ["FAULTS", "RIGHT", "Fault"]
