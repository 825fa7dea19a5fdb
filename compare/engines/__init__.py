"""Engines of the comparison, each with the kinds of systems that it simulates.

A study of a single system calls ``engine.simulate``; if the engine does not support it, the report says so. A study
of several systems measures some and reports the others::

    mine = [disc for disc in discs if engine.simulates(disc)]
    return Findings(claims_of(mine), data_of(mine), not_simulated=engine.lacking(discs))
"""

import os

# A user's ~/.exudyn/config.json, which Exudyn reads on import, would change the results. Child processes inherit the
# setting.
os.environ["EXUDYN_NO_USER_SETTINGS"] = "1"

from compare.engines.answer import BadTrajectoryError
from compare.engines.engine import (
    EVERY_KIND,
    KINDS,
    DeclaredLackError,
    Engine,
    OutOfRangeError,
    Simulate,
    UnsupportedSystemError,
)
from compare.engines.live.installed import INSTALLED, installed_engine
from compare.engines.outside.fmu import Fmu
from compare.engines.outside.motion_files import MotionFiles
from compare.engines.outside.program import Program
from compare.engines.precision import COARSENING, USUAL_TOLERANCE
from compare.engines.ranges import EVERYWHERE, Ranges
from compare.engines.registry import (
    ByName,
    engines,
    exudyn,
    exudyn_native,
    imported,
    is_registered,
    known_name,
    on_request,
    owner_of,
    plain,
    reference,
    register,
    repeated_by,
    shares_code,
    told_apart,
)
from compare.engines.stick import StatesOnly
from compare.output.outside_text import one_of

__all__ = [
    "COARSENING",
    "EVERYWHERE",
    "EVERY_KIND",
    "INSTALLED",
    "KINDS",
    "USUAL_TOLERANCE",
    "BadTrajectoryError",
    "ByName",
    "DeclaredLackError",
    "Engine",
    "Fmu",
    "MotionFiles",
    "OutOfRangeError",
    "Program",
    "Ranges",
    "Simulate",
    "StatesOnly",
    "UnsupportedSystemError",
    "engines",
    "exudyn",
    "exudyn_native",
    "imported",
    "installed_engine",
    "is_registered",
    "known_name",
    "on_request",
    "one_of",
    "owner_of",
    "plain",
    "reference",
    "register",
    "repeated_by",
    "shares_code",
    "told_apart",
]
