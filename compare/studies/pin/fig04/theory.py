"""Eq. 18 and the exact first-order response over the speed, and what (18) may be off by."""

from __future__ import annotations

import numpy as np

from compare.claims.study import Data
from compare.studies.pin.fig04.parameters import pin_at
from reference_model import PinOnDisc
from reference_model.formulas.pin import (
    first_order_whirl_shift,
    third_order_of_whirl_shift,
    whirl_radius,
    whirl_shift,
    whirl_shift_error_limit,
)


def curves() -> Data:
    """Return both formulas over ω."""
    speeds = np.geomspace(1.08, 5.0, 200)
    return {
        "speeds": speeds,
        "eq18": np.array([whirl_shift(pin_at(speed)) for speed in speeds]),
        "first order": np.array([first_order_whirl_shift(pin_at(speed)) for speed in speeds]),
    }


def error_of_eq18(pin: PinOnDisc) -> float:
    """Return what (18) may be off by in m: the second harmonic, and all orders of X0 but the first.

    Orders follow each other like (X0·w/ρ_c)², w = ω/(ω − k): so much does the offset turn the slip.
    """
    turn = pin.offset / whirl_radius(pin) * pin.disc_speed / (pin.disc_speed - pin.natural_frequency)
    higher = abs(third_order_of_whirl_shift(pin)) / (1.0 - turn**2)
    return float(np.hypot(*first_order_whirl_shift(pin))) * (abs(whirl_shift_error_limit(pin)) + higher)
