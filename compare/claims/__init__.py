"""Claims, studies and error estimates; this package exports the names that most studies need."""

from compare.claims.claim import Claim, ErrorBudget
from compare.claims.error_estimates import (
    COARSENING,
    ROUNDING,
    SAFETY,
    TIGHTEST,
    TRUTH,
    WORKING,
    Measurement,
    change_as_error,
    extrapolated_order,
    known,
    observed_exponent,
    open_where_coarse,
    refined,
)
from compare.claims.measured import Measured, answers_of, asked
from compare.claims.study import ByEngine, Data, Figures, Findings, Study
from compare.claims.validation import Recorded

__all__ = [
    "COARSENING",
    "ROUNDING",
    "SAFETY",
    "TIGHTEST",
    "TRUTH",
    "WORKING",
    "ByEngine",
    "Claim",
    "Data",
    "ErrorBudget",
    "Figures",
    "Findings",
    "Measured",
    "Measurement",
    "Recorded",
    "Study",
    "answers_of",
    "asked",
    "change_as_error",
    "extrapolated_order",
    "known",
    "observed_exponent",
    "open_where_coarse",
    "refined",
]
