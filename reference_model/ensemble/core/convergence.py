"""Convergence of a series of distances."""

from __future__ import annotations

from reference_model.ensemble.core.jit import scalar

ACCURACY = 1e-4
"""Relative distance that may remain when a motion counts as converged."""

STILL = 1e-2
"""Distance between crossings, as a fraction of the distance allowed by ACCURACY, that is only noise."""


@scalar
def converged(last: float, before: float, first: float, scale: float) -> bool:
    """Return whether the last three distances between crossings imply that less than ACCURACY·scale remains."""
    allowed = ACCURACY * scale
    if max(last, before, first) < STILL * allowed and not last > before > first:
        return True  # near a saddle they are small too, but grow
    ratio = max(last / before, before / first) if before > 0.0 and first > 0.0 else 1.0
    return ratio < 1.0 and last * ratio < allowed * (1.0 - ratio)
