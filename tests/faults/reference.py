"""The reference for faults around it, compiled for the law of the parameters.

Plain and compiled runs implement the same physics and agree within the tolerance. Compiled runs have larger errors,
so they get a smaller tolerance: the effect of a fault must exceed the error.
"""

import reference_model
from reference_model.systems import SMALLEST_TOLERANCE

SHARE = 0.1
"""Fraction of the tolerance for runs that may be compiled."""


def simulate(system, start, times, *, tolerance=1e-9, contact=None):
    """Return the motion like :func:`reference_model.simulate`."""
    if contact is None:
        tolerance = max(SHARE * tolerance, SMALLEST_TOLERANCE)
    return reference_model.simulate(system, start, times, tolerance=tolerance, contact=contact, compiled=None)
