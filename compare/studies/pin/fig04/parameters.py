"""Speeds and offsets at which the whirl of Fig. 4 is measured."""

from __future__ import annotations

from dataclasses import replace

from compare.claims.error_estimates import WORKING
from compare.claims.paper_parameters import FIG4
from reference_model import PinOnDisc

SPEEDS = (1.15, 1.2, 1.25, 1.3, 1.4, 1.5, 1.7, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0)
"""ω in rad/s. The paper does not print its range; below 1.15 this whirl is about to end in a fold."""

CLAIM_SPEEDS = (1.2, 1.5, 3.0)
"""Those among them that claims are made for."""

OFFSETS = (0.02, 0.01, 0.005)
"""X0 in m for the orders, each half of the one before and far below the whirl's radius of 1.2 m."""

SHIFT_TOLERANCE = 1e3 * WORKING
"""Of the means over ω, which (18) gives to a few per cent."""

SOURCE = "Fig. 4; ω is its axis, printed without a range"
SOURCE_OF_OFFSETS = f"{SOURCE}; X0 = {', '.join(f'{offset:g}' for offset in OFFSETS)} m"


def pin_at(speed: float, offset: float = FIG4.offset) -> PinOnDisc:
    """Return the pin of Fig. 4 at ω = ``speed`` in rad/s and X0 = ``offset`` in m."""
    return replace(FIG4, disc_speed=float(speed), offset=offset)
