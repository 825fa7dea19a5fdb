"""The speed above which the clutch disc does not stay on the engine's axis: closed form, reference and Exudyn."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
from scipy.linalg import eig, matrix_balance, norm
from scipy.optimize import brentq

from compare.claims.measured import Measured
from compare.engines import Engine
from compare.studies.drivetrain.frozen.claims.study import STUDY
from compare.studies.drivetrain.frozen.theory import CASES
from compare.studies.toolkit.drivetrain_bench import (
    Operation,
    centred_car,
    facings,
    natural_frequency,
    onset_speed,
    parameters_of,
)
from reference_model.steady.stability import jacobian_without_angle
from reference_model.systems import FloatArray

IN_WORDS = [f"{torque:g} N m and {slip:g} rad/s" for torque, slip in CASES]

NAMED = {f"onset at {words}": i for i, words in enumerate(IN_WORDS)}

NOTE = (
    "D = μN·∂F/∂U at U = 0, averaged over the facings, is their damping of small motions, which turns with the "
    "flywheel. The zero of the real part of the radial eigenvalue over ω; numerical error: rounding of that "
    "eigenvalue, by its condition, over the slope."
)


@STUDY.claim(
    "Exudyn's linearisation of the whole drivetrain: the centred disc becomes unstable at ω = k(1 + β/D)",
    unit="rad/s",
    resolution=1e-9,
    note=NOTE,
    named=NAMED,
)
def loses_stability(engine: Engine) -> Measured:
    """Compare what Exudyn's linearisation says; the flywheel is the car's own, free to turn."""
    from exudyn_models import build_drivetrain
    from exudyn_models.paper.linearisation import REGULARISATION
    from exudyn_models.solver.linear_matrices import state_matrix

    car = centred_car()

    def matrix(speed: float, slip: float, torque: float) -> FloatArray:
        model = build_drivetrain(
            car,
            normal_load=car.normal_load(torque),
            regularisation=REGULARISATION,
            engine_speed=speed,
            gearbox_speed=speed - slip,
        )
        return state_matrix(model.mbs)

    return _measured(matrix)


@STUDY.claim(
    "The reference's eigenvalues of the reduced disc: the centred disc becomes unstable at ω = k(1 + β/D)",
    unit="rad/s",
    resolution=1e-9,
    note=NOTE,
    named=NAMED,
)
def reduced_disc_loses_stability() -> Measured:
    """Compare what the reference says of the reduced disc."""
    car = centred_car()

    def matrix(speed: float, slip: float, torque: float) -> FloatArray:
        disc = Operation(speed, slip, torque).reduced(car)
        return jacobian_without_angle(disc, [0.0] * 5 + [speed - slip], facings(car))

    return _measured(matrix)


def _measured(matrix: Callable[..., FloatArray]) -> Measured:
    """Compare the onset by ``matrix(speed, slip, torque)`` with the closed form."""
    car = centred_car()
    closed = [onset_speed(car, slip, torque) for torque, slip in CASES]
    found = [
        _onset(partial(matrix, slip=slip, torque=torque), near, natural_frequency(car))
        for (torque, slip), near in zip(CASES, closed, strict=True)
    ]
    measured, errors = np.transpose(found)
    return Measured(
        predicted=closed,
        value=measured,
        error=errors,
        at={"torque and slip": IN_WORDS},
        parameters=parameters_of(car),
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
