"""The modulated whirl of the clutch disc: eigenvalues, growth and the resulting cycle.

A whirl reduces the friction moment, so a clutch may slip under a load larger than its torque needs.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from scipy.linalg import matrix_balance
from scipy.optimize import brentq

import compare.studies.drivetrain.frozen.theory as theory
from compare.claims import COARSENING, ROUNDING, WORKING, Measured, refined
from compare.claims.linearised_flow import eigenvalues_with_rounding, matched, real_and_imaginary
from compare.engines import Engine
from compare.studies.drivetrain.frozen.theory import STUDY, build
from compare.studies.toolkit import drivetrain_bench as bench
from compare.studies.toolkit.deviations import PARTS
from compare.studies.toolkit.drivetrain_bench import RINGS, RPM, centre, centred_car, parameters_of
from compare.studies.toolkit.measuring import compared
from reference_model.systems import FloatArray

if TYPE_CHECKING:
    from exudyn_models import Drivetrain

Matrix = Callable[[theory.CarWhirl], FloatArray]
"""State matrix of small motions, see ``state_matrix_of``."""


def _by_exudyn(car: Drivetrain) -> Matrix:
    from exudyn_models.paper.linearisation import REGULARISATION
    from exudyn_models.solver.linear.matrices import state_matrix

    return lambda whirl: state_matrix(build(car, whirl, regularisation=REGULARISATION).mbs)


@STUDY.claim(
    "Exudyn's linearisation about a whirl has the eigenvalues that follow from the reference's friction law",
    unit="1/s",
    resolution=1e-9,
    note="All eigenvalues refer to axes that turn with the whirl. Six of the ten eigenvalues are compared; "
    "the other four belong to "
    "free angles, phase and speed. The prediction contains the reference's friction with its whole "
    "reaction on the engine. "
    "Numerical error: the change with finer rings of the reference's annulus, and rounding.",
)
def linearised(engine: Engine) -> Measured:
    car = centred_car()
    by_exudyn = _by_exudyn(car)
    found, expected, errors = [], [], []
    for whirl in theory.whirls_of(car):
        predicted, finer = (theory.modulation(car, whirl, rings) for rings in (RINGS, theory.FINER))
        found.append(matched(theory.of_modulation(by_exudyn(whirl), whirl.frequency), predicted))
        expected.append(predicted)
        errors.append(np.max(np.abs(matched(finer, predicted) - predicted)))
    scale = max(abs(value) for values in expected for value in values)
    whirls = [
        f"{speed:g} rpm with {torque:g} N m and {100.0 * surplus:g} % too much load"
        for speed, torque, surplus in theory.WHIRLS
    ]
    return Measured(
        predicted=real_and_imaginary(expected),
        value=real_and_imaginary(found),
        error=max(errors) + ROUNDING * scale,
        at={"whirl": whirls, "eigenvalue": range(1, 7)},
        components=PARTS,
        parameters=parameters_of(car),
    )


@STUDY.claim(
    "A whirl within the play is modulated above the speed at which the reference's eigenvalue becomes unstable",
    unit="rpm",
    resolution=1.0,
    note=f"With {100.0 * theory.BORDER_SURPLUS:g} % too much load. Measured: the speed at which Exudyn's "
    "linearisation about the whirl has an imaginary eigenvalue. Numerical error: rounding of both eigenvalue "
    "problems, and the change with finer rings of the reference's annulus.",
    named={f"border at {torque:g} N m": i for i, torque in enumerate(theory.BORDER_TORQUES)},
)
def border(engine: Engine, between: tuple[float, float] = theory.BETWEEN) -> Measured:
    car = centred_car()

    def borders(matrix: Matrix) -> FloatArray:
        return np.transpose([_border(car, matrix, torque, between) for torque in theory.BORDER_TORQUES])

    predicted, rounding = borders(partial(theory.state_matrix_of, car))
    finer, _ = borders(partial(theory.state_matrix_of, car, rings=theory.FINER))
    measured, rounded = borders(_by_exudyn(car))
    return Measured(
        predicted=predicted,
        value=measured,
        error=np.abs(finer - predicted) + rounding + rounded,
        at={"torque in N m": theory.BORDER_TORQUES},
        parameters=parameters_of(car, surplus=theory.BORDER_SURPLUS),
    )


def _border(
    car: Drivetrain, matrix: Matrix, torque: float, between: tuple[float, float]
) -> tuple[float, float]:
    """Return the speed (rpm) and its rounding error; NaN if there is none."""

    def growth(speed: float) -> tuple[float, float]:
        whirl = theory.whirl_under_surplus(car, speed * RPM, torque, theory.BORDER_SURPLUS)
        if whirl is None:
            return math.nan, math.nan
        balanced, _ = matrix_balance(theory.in_turning_axes(matrix(whirl), whirl.frequency))
        values, errors = eigenvalues_with_rounding(balanced)
        slowest = theory.of_modulation(matrix(whirl), whirl.frequency)[0]
        return slowest.real, float(errors[np.argmin(np.abs(values - slowest))])

    low, high = (growth(speed)[0] for speed in between)
    if not low < 0.0 < high:
        return math.nan, 0.0
    speed = float(brentq(lambda speed: growth(speed)[0], *between, xtol=1e-9))
    return speed, 2.0 * growth(speed)[1] * (between[1] - between[0]) / (high - low) + 1e-9


@STUDY.claim(
    "Small deviations from a whirl within the play grow and oscillate with the eigenvalue of its modulation",
    unit="1/s",
    note=f"Two runs that start {100.0 * theory.DEVIATION:g} % of the radius outside and inside of the whirl; the "
    f"component of their difference in the mode, after {theory.TIME:g} s. Numerical error: the change "
    "with twice the deviation, and at a smaller tolerance.",
)
def growth(engine: Engine) -> Measured:
    car = centred_car()
    whirl = theory.whirls_of(car)[0]
    matrix = theory.in_turning_axes(theory.state_matrix_of(car, whirl), whirl.frequency)
    predicted = theory.modulation(car, whirl)[0]
    values, left = np.linalg.eig(matrix.T)
    mode = left[:, np.argmin(np.abs(values - predicted))]

    def grown(deviation: float, tolerance: float) -> complex:
        runs = [_deviations(car, whirl, sign * deviation, tolerance) for sign in (1.0, -1.0)]
        start, end = (runs[0] - runs[1]) @ mode
        return complex(np.log(end / start) / theory.TIME)

    found = refined(
        lambda tolerance: real_and_imaginary(grown(theory.DEVIATION, tolerance)), theory.TOLERANCE
    )
    wide = abs(grown(2.0 * theory.DEVIATION, theory.TOLERANCE) - complex(*found.value))
    return compared(
        real_and_imaginary(predicted),
        found,
        error=np.hypot(*found.error) + wide,
        resolution=1e-3 * abs(predicted),
        components=PARTS,
        parameters=_parameters(car, whirl),
    )


def _parameters(car: Drivetrain, whirl: theory.CarWhirl) -> dict[str, float | str]:
    speed, _, surplus = theory.MODULATED
    return parameters_of(car, speed=speed, torque=whirl.torque, surplus=surplus)


def _deviations(car: Drivetrain, whirl: theory.CarWhirl, deviation: float, tolerance: float) -> FloatArray:
    """Return the first and last state in axes that turn with the whirl, ordered as in ``in_turning_axes``."""
    motion = build(car, whirl, deviation=deviation).run(
        theory.TIME, sample_every=theory.TIME, tolerance=tolerance
    )
    turn = np.exp(-1j * whirl.frequency * motion.times)
    z, velocity = turn * centre(motion.disc), turn * centre(motion.disc_velocity)
    place = z.real, z.imag, motion.disc[:, 2] - motion.vehicle_angle
    spins = motion.engine_speed, motion.vehicle_speed
    rates = *spins, velocity.real, velocity.imag, motion.disc_velocity[:, 2]
    return np.column_stack((*place, *rates))[[0, -1]]


@STUDY.claim(
    "The energy balance closes in the modulated whirl of the clutch disc",
    kind="conservation",
    resolution=1e-6,
    basis="self-check",  # the heat comes from the friction law of the model itself
)
def balance(engine: Engine, until: float = theory.UNTIL) -> Measured:
    car = centred_car()
    whirl = theory.whirls_of(car)[0]
    every, roughest = theory.CYCLE_SAMPLE, theory.ROUGHER * WORKING
    motion, finer = (
        build(car, whirl, deviation=theory.PUSH).run(until, sample_every=every, tolerance=tolerance)
        for tolerance in (roughest, roughest / COARSENING)
    )
    measured = bench.balance_of([motion.energy, finer.energy], _parameters(car, whirl))
    shown = np.column_stack((motion.times, np.abs(centre(motion.disc)), motion.slip))
    return replace(measured, data={"modulated": shown})
