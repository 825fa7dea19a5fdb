"""Reliability of error bars: true errors of random motions compared with their estimates."""

from compare.studies.engines.error_estimates.study import STUDY as STUDY
