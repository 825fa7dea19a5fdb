"""The car's drivetrain at frozen speeds: onset, self-centring, whirl on the stop, and where a whirl is modulated.

The modules are imported in the order of the report.
"""

from compare.studies.drivetrain.frozen.claims import onset, steady, whirls
from compare.studies.drivetrain.frozen.claims.study import STUDY

__all__ = ["STUDY", "onset", "steady", "whirls"]
