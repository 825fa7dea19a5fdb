"""The reference about which mistakes are made: by compiled kernels if they serve many runs, for much is simulated.

Plain and compiled runs are two implementations of one physics, and agree within the tolerance. What a mistake changes
must not hide behind the tolerance, of which compiled runs use up more.
"""

from __future__ import annotations

from numpy.typing import ArrayLike

import reference_model
from reference_model.contact.contact_law import Contact
from reference_model.systems import SMALLEST_TOLERANCE, System
from reference_model.trajectory import Trajectory

SHARE = 0.1
"""Of the tolerance, for runs that may be compiled."""

POINTS = (None, 6)
"""Of contacts whose kernels serve many runs: to compile one for another number takes longer than to do without."""


def simulate(
    system: System,
    initial_state: ArrayLike,
    times: ArrayLike,
    *,
    tolerance: float = 1e-9,
    contact: Contact | None = None,
) -> Trajectory:
    """Return the motion, as :func:`reference_model.simulate` does."""
    if contact is None:
        tolerance = max(SHARE * tolerance, SMALLEST_TOLERANCE)
    compiled = None if getattr(system, "contact_points", None) in POINTS else False
    return reference_model.simulate(
        system, initial_state, times, tolerance=tolerance, contact=contact, compiled=compiled
    )
