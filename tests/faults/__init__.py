"""Engines with one mistake each, which the claims have to find, and the sound engines that they are made from."""

from faults.catalogue import FAULTS, SOUND
from faults.fault import Fault

__all__ = ["FAULTS", "SOUND", "Fault"]
