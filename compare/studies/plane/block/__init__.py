"""A block on a plane at rest: thrown, held, let go, on a spring, and pulled."""

from compare.studies.plane.block.claims import STUDY

__all__ = ["STUDY"]
