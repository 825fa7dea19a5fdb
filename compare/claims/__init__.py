"""Claims, studies and error estimates; this package exports the names that most studies need."""

from compare.claims.claim import Claim as Claim
from compare.claims.claim import ErrorBudget as ErrorBudget
from compare.claims.error_estimates import COARSENING as COARSENING
from compare.claims.error_estimates import ROUNDING as ROUNDING
from compare.claims.error_estimates import SAFETY as SAFETY
from compare.claims.error_estimates import TIGHTEST as TIGHTEST
from compare.claims.error_estimates import TRUTH as TRUTH
from compare.claims.error_estimates import WORKING as WORKING
from compare.claims.error_estimates import Measurement as Measurement
from compare.claims.error_estimates import change_as_error as change_as_error
from compare.claims.error_estimates import extrapolated_order as extrapolated_order
from compare.claims.error_estimates import known as known
from compare.claims.error_estimates import observed_exponent as observed_exponent
from compare.claims.error_estimates import open_where_coarse as open_where_coarse
from compare.claims.error_estimates import refined as refined
from compare.claims.measured import Measured as Measured
from compare.claims.measured import answers_of as answers_of
from compare.claims.measured import asked as asked
from compare.claims.study import ByEngine as ByEngine
from compare.claims.study import Data as Data
from compare.claims.study import Figures as Figures
from compare.claims.study import Findings as Findings
from compare.claims.study import Recorded as Recorded
from compare.claims.study import Study as Study
