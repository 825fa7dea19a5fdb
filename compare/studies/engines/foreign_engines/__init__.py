"""What foreign engines make of the paper's systems, from data recorded with them: laws, orders, errors over time."""

from compare.studies.engines.foreign_engines.study import STUDY

__all__ = ["STUDY"]
