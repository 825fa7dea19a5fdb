"""Engines with one fault each, which the claims must detect, and the sound engines that they modify."""

from faults.catalogue import FAULTS, SOUND

__all__ = ["FAULTS", "SOUND"]
