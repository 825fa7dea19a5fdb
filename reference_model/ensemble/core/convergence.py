"""Whether a series of distances shows by itself that little is left to go."""

from __future__ import annotations

from reference_model.ensemble.core.jit import scalar

ACCURACY = 1e-4
"""What may be left to go, as a fraction, of a motion that shows by itself where it goes."""

STILL = 1e-2
"""Distance between crossings, as a fraction of what ACCURACY allows, below which they have met but for noise."""


@scalar
def converged(last: float, before: float, first: float, scale: float) -> bool:
    """Tell whether the last three distances between crossings show that less than ACCURACY·scale is left to go."""
    allowed = ACCURACY * scale
    if max(last, before, first) < STILL * allowed and not last > before > first:
        return True  # beside a saddle they are small too, but grow
    ratio = max(last / before, before / first) if before > 0.0 and first > 0.0 else 1.0
    return ratio < 1.0 and last * ratio < allowed * (1.0 - ratio)
