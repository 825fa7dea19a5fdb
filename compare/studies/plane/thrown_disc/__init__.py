"""Discs thrown on a plane at rest while they spin: a ring, points and a full disc."""

from compare.studies.plane.thrown_disc.claims import STUDY

__all__ = ["STUDY"]
