"""Contacts that stick exactly in Exudyn."""

from compare.studies.drivetrain.exact_stick.study import STUDY as STUDY
