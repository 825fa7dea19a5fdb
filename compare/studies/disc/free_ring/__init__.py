"""A ring thrown on a table at rest: sliding and spinning end together, in a ratio that forgets the start."""

from compare.studies.disc.free_ring.claims import STUDY

__all__ = ["STUDY"]
