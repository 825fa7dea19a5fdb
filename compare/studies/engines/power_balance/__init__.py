"""Energy: what the drive puts in is heat and stored energy, on every kind of trajectory and without a reference."""

from compare.studies.engines.power_balance.claims import STUDY

__all__ = ["STUDY"]
