"""The speed above which the clutch disc does not stay on the engine's axis: closed form, reference and Exudyn."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from scipy.linalg import eig, matrix_balance, norm
from scipy.optimize import brentq

from compare.claims.claim import Claim, ErrorBudget
from compare.studies.toolkit.drivetrain_bench import (
    SOURCE,
    Operation,
    facings,
    natural_frequency,
    onset_speed,
    parameters_of,
)
from reference_model.steady.stability import jacobian_without_angle
from reference_model.systems import FloatArray

if TYPE_CHECKING:
    from exudyn_models import Drivetrain

ONSET = "Exudyn's linearisation of the whole drivetrain: the centred disc becomes unstable at ω = k(1 + β/D)"
REFERENCE_ONSET = (
    "The reference's eigenvalues of the reduced disc: the centred disc becomes unstable there too"
)

CASES = ((80.0, 12.0), (40.0, 12.0), (80.0, 30.0))
"""Torque in N m and slip in rad/s."""


def claim_of_linearised_drivetrain(engine: str, car: Drivetrain) -> Claim:
    """Return what Exudyn's linearisation says; the flywheel is the car's own, free to turn."""
    from exudyn_models import build_drivetrain
    from exudyn_models.paper.linearisation import REGULARISATION
    from exudyn_models.solver.linear_matrices import state_matrix

    centred = replace(car, offset=0.0, unbalance=0.0)

    def matrix(speed: float, slip: float, torque: float) -> FloatArray:
        model = build_drivetrain(
            centred,
            normal_load=car.normal_load(torque),
            regularisation=REGULARISATION,
            engine_speed=speed,
            gearbox_speed=speed - slip,
        )
        return state_matrix(model.mbs)

    return _claim(ONSET, engine, centred, matrix)


def claim_of_reference(car: Drivetrain) -> Claim:
    """Return what the reference says of the reduced disc."""
    centred = replace(car, offset=0.0, unbalance=0.0)

    def matrix(speed: float, slip: float, torque: float) -> FloatArray:
        disc = Operation(speed, slip, torque).reduced(centred)
        return jacobian_without_angle(disc, [0.0] * 5 + [speed - slip], facings(car))

    return _claim(REFERENCE_ONSET, "theory", centred, matrix)


def _claim(sentence: str, engine: str, car: Drivetrain, matrix: Callable[..., FloatArray]) -> Claim:
    found = [
        _onset(
            partial(matrix, slip=slip, torque=torque), onset_speed(car, slip, torque), natural_frequency(car)
        )
        for torque, slip in CASES
    ]
    measured, errors = np.transpose(found)
    words = ", ".join(f"{torque:g} N m and {slip:g} rad/s" for torque, slip in CASES)
    return Claim(
        sentence,
        equation="",
        engine=engine,
        predicted=[onset_speed(car, slip, torque) for torque, slip in CASES],
        measured=measured,
        budget=ErrorBudget(errors, resolution=1e-9),
        parameters=parameters_of(car),
        source=SOURCE,
        unit="rad/s",
        note=f"For torque and slip of {words}. D = μN·∂F/∂U at U = 0, averaged over the facings, is their damping of "
        "small motions, which turns with the flywheel. The zero of the real part of the radial eigenvalue over ω; "
        "numerical error: rounding of that eigenvalue, by its condition, over the slope.",
        named={f"onset at {torque:g} N m and {slip:g} rad/s": i for i, (torque, slip) in enumerate(CASES)},
    )


def _onset(matrix: Callable[[float], FloatArray], near: float, frequency: float) -> tuple[float, float]:
    """Return at which speed the eigenvalue nearest to ``frequency`` has no real part, and the error."""

    def radial(speed: float) -> tuple[float, float]:
        balanced, _ = matrix_balance(matrix(speed))
        values, left, right = eig(balanced, left=True)
        i = int(np.argmin(np.abs(values - 1j * frequency)))
        condition = 1.0 / abs(np.vdot(left[:, i], right[:, i]))
        return float(values[i].real), len(values) * np.finfo(float).eps * float(norm(balanced)) * condition

    low, high = 0.98 * near, 1.02 * near
    speed = float(brentq(lambda speed: radial(speed)[0], low, high, xtol=1e-12))
    slope = (radial(high)[0] - radial(low)[0]) / (high - low)
    return speed, 2.0 * radial(speed)[1] / slope
