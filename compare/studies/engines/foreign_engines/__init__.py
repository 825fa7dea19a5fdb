"""Recorded foreign engines: friction laws, orders and errors over time."""

from compare.studies.engines.foreign_engines.study import STUDY as STUDY
