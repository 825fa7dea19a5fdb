"""The modulated whirl of the clutch disc: eigenvalues of the whole drivetrain, growth and the cycle that follows.

A clutch that is pressed more than its torque needs may still slip, because a whirl takes a part of the moment of
friction away. Slip and radius of such a whirl swing about each other, and where the map says so the swing grows.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from scipy.linalg import matrix_balance
from scipy.optimize import brentq

from compare.claims.claim import Claim, ErrorBudget
from compare.claims.error_estimates import COARSENING, ROUNDING, refined
from compare.claims.linearised_flow import eigenvalues_with_rounding, matched, real_and_imaginary
from compare.claims.parameters import at_each
from compare.claims.study import Data
from compare.studies.drivetrain.frozen.linear import (
    CarWhirl,
    in_turning_axes,
    of_modulation,
    state_matrix_of,
    whirl_under_surplus,
)
from compare.studies.toolkit.drivetrain_bench import (
    EPSILON,
    RPM,
    SOURCE,
    balance_claim,
    centre,
    parameters_of,
    start_disc,
)
from reference_model.systems import FloatArray

if TYPE_CHECKING:
    from exudyn_models import Drivetrain, DrivetrainModel

LINEARISED = (
    "Exudyn's linearisation about a whirl has the eigenvalues that the reference's law of friction gives"
)
BORDER = (
    "A whirl in the play is modulated above the speed at which an eigenvalue by the reference's law of friction is "
    "imaginary"
)
GROWTH = "Small deviations from a whirl in the play grow and turn with the eigenvalue of its modulation"
BALANCE = "Energy is balanced in the modulated whirl that they lead to"

MODULATED = (6000.0, 0.6, 0.1)
"""Speed in turns a minute, torque in N m, and by how much the load is more than the torque needs."""

WHIRLS = (MODULATED, (3800.0, 1.3, 0.05), (4500.0, 8.0, 0.01))
"""The same: the second whirl is not modulated, the third is on the stop."""

BORDER_SURPLUS, BORDER_TORQUES = MODULATED[2], (0.2, 0.8, 1.4)
"""Of load, and torques in N m: from a small whirl to one that all but reaches the stop."""

BETWEEN = (3900.0, 4300.0)
"""Speeds in turns a minute below and above the border."""

FINER = 24
"""Rings of the reference's annulus, in place of 16, which show their error."""

TIME = 0.4
"""In s: for how long small deviations are followed."""

DEVIATION = 3e-3
"""As a part of the radius."""

TOLERANCE = 1e-9

PUSH, UNTIL = 0.2, 6.0
"""The same of the modulated motion: first deviation, and when it ends, in s."""

ROUGHER = 80.0
"""Its tolerance over that of the small deviations."""

SAMPLE = 2e-3
"""In s, of the modulated motion."""


def whirls_of(car: Drivetrain) -> list[CarWhirl]:
    """Return the whirls of ``WHIRLS``."""
    found = [whirl_under_surplus(car, speed * RPM, torque, surplus) for speed, torque, surplus in WHIRLS]
    return [whirl for whirl in found if whirl is not None]


def build(
    car: Drivetrain, whirl: CarWhirl, *, deviation: float = 0.0, regularisation: float = EPSILON
) -> DrivetrainModel:
    """Return the drivetrain in a whirl between an engine and a load of constant torque.

    The radius is larger by the part ``deviation``.
    """
    from exudyn_models import build_drivetrain

    model = build_drivetrain(
        car,
        normal_load=whirl.friction_force / (car.faces * car.friction_coefficient),
        regularisation=regularisation,
        engine_speed=whirl.engine_speed,
        gearbox_speed=whirl.engine_speed - whirl.slip,
        engine_torque=lambda time, angle, speed: whirl.engine_torque,
        vehicle_torque=lambda time, angle, speed: -whirl.torque,
        shaft_torque=whirl.torque,
    )
    start_disc(model, (1.0 + deviation) * whirl.place, (1.0 + deviation) * whirl.velocity)
    return model


def claim_of_linearisation(engine: str, car: Drivetrain) -> Claim:
    """Return what Exudyn's linearisation about the whirls says."""
    from exudyn_models.paper.linearisation import REGULARISATION
    from exudyn_models.solver.linear_matrices import state_matrix

    found, expected, errors = [], [], []
    for whirl in whirls_of(car):
        model = build(car, whirl, regularisation=REGULARISATION)
        predicted = of_modulation(state_matrix_of(car, whirl), whirl.frequency)
        finer = of_modulation(state_matrix_of(car, whirl, FINER), whirl.frequency)
        found.append(matched(of_modulation(state_matrix(model.mbs), whirl.frequency), predicted))
        expected.append(predicted)
        errors.append(np.max(np.abs(matched(finer, predicted) - predicted)))
    scale = max(abs(value) for values in expected for value in values)
    return Claim(
        LINEARISED,
        equation="",
        engine=engine,
        predicted=real_and_imaginary(expected),
        measured=real_and_imaginary(found),
        budget=ErrorBudget(max(errors) + ROUNDING * scale, resolution=1e-9),
        parameters=parameters_of(car),
        source=SOURCE,
        unit="1/s",
        note=f"In axes that turn with the whirl, at {IN_WORDS}. Of ten eigenvalues the six that do not belong to "
        "angles, phase and speed, which are free. Friction of the reference enters by hand, with its whole reaction "
        "on the engine. Numerical error: the change with finer rings of the reference's annulus, and rounding.",
    )


def claim_of_border(engine: str, car: Drivetrain) -> Claim:
    """Return the speeds above which Exudyn's linearisation has the modulation grow."""
    from exudyn_models.paper.linearisation import REGULARISATION
    from exudyn_models.solver.linear_matrices import state_matrix

    def by_reference(whirl: CarWhirl, rings: int = 16) -> FloatArray:
        return state_matrix_of(car, whirl, rings)

    def by_exudyn(whirl: CarWhirl) -> FloatArray:
        return state_matrix(build(car, whirl, regularisation=REGULARISATION).mbs)

    def border(torque: float, matrix: Callable[[CarWhirl], FloatArray]) -> tuple[float, float]:
        """Return the speed in turns a minute, and its error by the rounding of the eigenvalue."""

        def growth(speed: float) -> tuple[float, float]:
            whirl = whirl_under_surplus(car, speed * RPM, torque, BORDER_SURPLUS)
            if whirl is None:
                return math.nan, math.nan
            balanced, _ = matrix_balance(in_turning_axes(matrix(whirl), whirl.frequency))
            values, errors = eigenvalues_with_rounding(balanced)
            slowest = of_modulation(matrix(whirl), whirl.frequency)[0]
            return slowest.real, float(errors[np.argmin(np.abs(values - slowest))])

        low, high = (growth(speed)[0] for speed in BETWEEN)
        if not low < 0.0 < high:
            return math.nan, 0.0
        speed = float(brentq(lambda speed: growth(speed)[0], *BETWEEN, xtol=1e-9))
        return speed, 2.0 * growth(speed)[1] * (BETWEEN[1] - BETWEEN[0]) / (high - low) + 1e-9

    predicted, rounding = np.transpose([border(torque, by_reference) for torque in BORDER_TORQUES])
    finer = np.array([border(torque, partial(by_reference, rings=FINER))[0] for torque in BORDER_TORQUES])
    measured, rounded = np.transpose([border(torque, by_exudyn) for torque in BORDER_TORQUES])
    return Claim(
        BORDER,
        equation="",
        engine=engine,
        predicted=predicted,
        measured=measured,
        budget=ErrorBudget(np.abs(finer - predicted) + rounding + rounded, resolution=1.0),
        parameters=parameters_of(car, surplus=BORDER_SURPLUS),
        source=SOURCE,
        unit="turns a minute",
        note=f"For {at_each('torque', BORDER_TORQUES)} N m, with {100.0 * BORDER_SURPLUS:g} % of load too much. "
        "Measured: the speed at which Exudyn's linearisation about the whirl has an imaginary eigenvalue. "
        "Numerical error: rounding of both eigenvalue problems, and the change with finer rings of the "
        "reference's annulus.",
        named={f"border at {torque:g} N m": i for i, torque in enumerate(BORDER_TORQUES)},
    )


IN_WORDS = ", ".join(
    f"{speed:g} turns a minute with {torque:g} N m and {100.0 * surplus:g} % of load too much"
    for speed, torque, surplus in WHIRLS
)


def claim_of_growth(engine: str, car: Drivetrain) -> Claim:
    """Return with which eigenvalue deviations from the modulated whirl grow in a run."""
    whirl = whirls_of(car)[0]
    matrix = in_turning_axes(state_matrix_of(car, whirl), whirl.frequency)
    predicted = of_modulation(state_matrix_of(car, whirl), whirl.frequency)[0]
    values, left = np.linalg.eig(matrix.T)
    mode = left[:, np.argmin(np.abs(values - predicted))]

    def growth(deviation: float, tolerance: float) -> complex:
        runs = [deviations(car, whirl, sign * deviation, tolerance) for sign in (1.0, -1.0)]
        start, end = (runs[0] - runs[1]) @ mode
        return complex(np.log(end / start) / TIME)

    parts, error = refined(lambda tolerance: real_and_imaginary(growth(DEVIATION, tolerance)), TOLERANCE)
    measured = complex(*parts)
    error = np.hypot(*error) + abs(growth(2.0 * DEVIATION, TOLERANCE) - measured)
    return Claim(
        GROWTH,
        equation="",
        engine=engine,
        predicted=real_and_imaginary(predicted),
        measured=real_and_imaginary(measured),
        budget=ErrorBudget(error, resolution=1e-3 * abs(predicted)),
        parameters=parameters_of(car, speed=MODULATED[0], torque=whirl.torque, surplus=MODULATED[2]),
        source=SOURCE,
        unit="1/s",
        note=f"Two runs that start {100.0 * DEVIATION:g} % of the radius outside and inside of the whirl; the part "
        f"of their difference that belongs to the mode, after {TIME:g} s. Numerical error: the change with twice the "
        "deviation, and at a smaller tolerance.",
    )


def deviations(car: Drivetrain, whirl: CarWhirl, deviation: float, tolerance: float) -> FloatArray:
    """Return the state in axes that turn with the whirl, as ``in_turning_axes`` orders it, at both ends, (2, 8)."""
    motion = build(car, whirl, deviation=deviation).run(TIME, sample_every=TIME, tolerance=tolerance)
    turn = np.exp(-1j * whirl.frequency * motion.times)
    z, velocity = turn * centre(motion.disc), turn * centre(motion.disc_velocity)
    twist = motion.disc[:, 2] - motion.vehicle_angle
    return np.column_stack(
        (
            *(z.real, z.imag, twist, motion.engine_speed, motion.vehicle_speed),
            *(velocity.real, velocity.imag, motion.disc_velocity[:, 2]),
        )
    )[[0, -1]]


def modulated_whirl(engine: str, car: Drivetrain) -> tuple[Claim, Data]:
    """Return the energy balance of the modulated motion, and what the figure shows of it."""
    whirl = whirls_of(car)[0]
    motions = [
        build(car, whirl, deviation=PUSH).run(UNTIL, sample_every=SAMPLE, tolerance=tolerance)
        for tolerance in (ROUGHER * TOLERANCE, ROUGHER * TOLERANCE / COARSENING)
    ]
    claim = balance_claim(
        BALANCE,
        engine,
        [motion.energy for motion in motions],
        parameters_of(car, speed=MODULATED[0], torque=whirl.torque, surplus=MODULATED[2]),
    )
    motion = motions[0]
    return claim, {
        "modulated": np.column_stack((motion.times, np.abs(centre(motion.disc)), motion.slip)),
    }
