"""What the error bars of all claims are worth: true errors of random motions beside their estimates."""

from compare.studies.engines.error_estimates.study import STUDY

__all__ = ["STUDY"]
