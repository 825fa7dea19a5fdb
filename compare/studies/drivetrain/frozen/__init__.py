"""The car's drivetrain at frozen speeds: onset, self-centring, whirl on the stop, and where a whirl is modulated."""

from compare.studies.drivetrain.frozen.claims import STUDY

__all__ = ["STUDY"]
