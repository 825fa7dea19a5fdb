"""Numerical error of a measured quantity, estimated from the measurement itself."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from reference_model.systems import FloatArray

COARSENING = 8.0
"""Factor between the two tolerances of an estimate.

With an error that falls like tolerance^p the difference of the two results is at least the error of the finer
one for every p >= 1/3, which covers the slowest convergence in use (that of a regularised law through stick),
and for the usual p = 1 it is seven times that error, which leaves room for one of the two being good by chance.
"""

ROUNDING = 64.0 * np.finfo(float).eps
"""Relative error below which two runs may coincide by chance."""


def refined(
    quantity: Callable[[float], ArrayLike], tolerance: float = 1e-9
) -> tuple[FloatArray, FloatArray]:
    """Return ``quantity(tolerance)`` and an estimate of its error, of the same shape.

    The estimate is the change against ``quantity(COARSENING * tolerance)``, and never less than rounding.
    """
    coarse = np.asarray(quantity(COARSENING * tolerance), dtype=float)
    fine = np.asarray(quantity(tolerance), dtype=float)
    scale = np.max(np.abs(fine), initial=0.0)
    return fine, np.abs(fine - coarse) + ROUNDING * scale
