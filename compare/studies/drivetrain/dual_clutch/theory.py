"""The drivetrain's torsion by SciPy, from the equations as they stand: no part is shared with the Exudyn model."""

from __future__ import annotations

import functools

import numpy as np
from scipy.integrate import solve_ivp

from compare.studies.drivetrain.dual_clutch.parameters import (
    COEFFICIENT,
    DAMPING,
    DENSE,
    ENGINE,
    EPSILON,
    HAND_OVER,
    PLATES,
    RADIUS,
    RATIOS,
    RESISTANCE,
    SHAFTS,
    STIFFNESS,
    TORQUE,
    UNTIL,
    VEHICLE,
    closing,
    opening,
    speeds,
    wind_up,
)
from reference_model.systems import FloatArray


def rates(t: float, y: FloatArray) -> list[float]:
    """Return rates of twist of both gears, speed of engine, both shafts and wheels, and heat of both clutches."""
    twists, engine, shafts, wheels = y[:2], y[2], y[3:5], y[5]
    drive, turning, heat = TORQUE, -RESISTANCE, []
    twisting, shaft_rates = [], []
    for load, twist, shaft, ratio, inertia in zip(
        (opening, closing), twists, shafts, RATIOS, SHAFTS, strict=True
    ):
        slip = RADIUS * (shaft - engine)
        clutch = -PLATES * COEFFICIENT * load(t) * RADIUS * slip / max(abs(slip), EPSILON)
        rate = shaft - ratio * wheels
        gear = STIFFNESS * twist + DAMPING * rate
        drive -= clutch
        turning += ratio * gear
        twisting.append(rate)
        shaft_rates.append((clutch - gear) / inertia)
        heat.append(-clutch * (shaft - engine))
    return [*twisting, drive / ENGINE, *shaft_rates, turning / VEHICLE, *heat]


@functools.cache
def change(tolerance: float = 1e-11) -> FloatArray:
    """Return the states of the gear change at ``DENSE``, shape (n, 8), as ``rates`` orders them."""
    state = np.array([wind_up(), 0.0, *speeds(), 0.0, 0.0])
    parts = [state[np.newaxis]]
    for begin, end in zip((0.0, *HAND_OVER), (*HAND_OVER, UNTIL), strict=True):
        asked = DENSE[(begin < DENSE) & (end >= DENSE)]
        run = solve_ivp(
            rates, (begin, end), state, method="LSODA", t_eval=asked, rtol=tolerance, atol=tolerance
        )
        parts.append(run.y.T)
        state = run.y[:, -1]
    return np.vstack(parts)
