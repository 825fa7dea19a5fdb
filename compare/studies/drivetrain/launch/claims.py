"""A launch of the passenger car: its clutch engages from full slip, sticks, and is opened again.

Where the clutch sticks, Exudyn's law of friction creeps with the share of ε that its torque has of its capacity. What
that changes vanishes with ε, and is measured against Coulomb friction that sticks, see ``theory``.
"""

from __future__ import annotations

import functools
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.interpolate import CubicSpline

from compare.claims.error_estimates import COARSENING, WORKING, observed_exponent, refined
from compare.claims.measured import Measured
from compare.claims.parameters import at_each
from compare.claims.study import Study
from compare.engines import Engine
from compare.studies.drivetrain.launch.model import launch, slipping
from compare.studies.drivetrain.launch.parameters import (
    CAPACITIES,
    ENGINE_SPEED,
    EPSILONS,
    KNOTS,
    MEAN,
    RATE,
    RIPPLE,
    SLIP,
    STUCK,
    UNTIL,
)
from compare.studies.drivetrain.launch.pictures import draw
from compare.studies.drivetrain.launch.theory import FullSlip, end_of_launch, time_of_stick, torque_held
from compare.studies.toolkit.drivetrain_bench import (
    SOURCE,
    balance_of,
    centred_car,
    parameters_of,
    passenger_car,
)
from reference_model.systems import FloatArray

if TYPE_CHECKING:
    from exudyn_models.drivetrain.model import DrivetrainMotion

STUDY = Study.beside(__file__, "drivetrain-launch", source=SOURCE, draw=draw, only=("exudyn",), seconds=2.5)

SPEEDS_AND_HEAT = ("speed of the engine", "speed of the disc", "speed of the vehicle", "heat")

OF_STICK = (
    f"{SOURCE}; four cylinders that fire with {MEAN * RIPPLE:g} N m, capacity up to {max(CAPACITIES):g} N m"
)

SEVERAL = f"{at_each('ε in m/s', EPSILONS)}; a centred disc. "


@STUDY.claim(
    "Energy is balanced in a launch from full slip to stick and on",
    kind="conservation",
    resolution=1e-6,
    basis="self-check",  # the model's own law of friction gives the heat
)
def balance(engine: Engine, until: float = UNTIL) -> Measured:
    """Check the energy of the launch with all that the car has, and keep it for the figure."""
    car, epsilon = passenger_car(), float(EPSILONS[0])
    motion, finer = (
        launch(car, epsilon=epsilon, tolerance=tolerance, until=until)
        for tolerance in (8e-7, 8e-7 / COARSENING)
    )
    twist, rate = motion.disc[:, 2] - motion.vehicle_angle, motion.disc_velocity[:, 2] - motion.vehicle_speed
    measured = balance_of([motion.energy, finer.energy], parameters_of(car, regularisation=epsilon))
    data = {
        "t": motion.times,
        "speeds": np.column_stack((motion.engine_speed, motion.disc_velocity[:, 2], motion.vehicle_speed)),
        "centre": motion.disc[:, :2],
        "shaft torque": car.torsional_stiffness * twist + car.torsional_damping * rate,
        "capacity": np.interp(motion.times, KNOTS, CAPACITIES),
        "heat": motion.energy.losses["friction"],
    }
    return replace(measured, data=data)


@STUDY.claim(
    "Engine, vehicle and unbalanced disc gain the angular momentum that the engine's torque gives",
    kind="conservation",
    unit="kg m²/s",
    resolution=1e-6,
    note=f"About the engine's axis, after {KNOTS[1]:g} s of slip in which the engine's mean torque gives "
    f"{MEAN * KNOTS[1]:g} N m s. Numerical error: the change with the tolerance.",
)
def momentum(engine: Engine) -> Measured:
    """Compare the angular momentum at the end of full slip with the impulse of the engine's torque.

    The support is at the origin and undamped: its force has no moment about it.
    """
    car = replace(passenger_car(), offset=0.0, radial_damping=0.0, unbalance=1e-3)
    until = KNOTS[1]

    def at_end(tolerance: float) -> float:
        motion = slipping(car, tolerance=tolerance, until=until)
        (x, y, angle), (vx, vy, spin) = motion.disc[-1], motion.disc_velocity[-1]
        centre = complex(x, y) + car.unbalance * np.exp(1j * angle)
        velocity = complex(vx, vy) + 1j * spin * car.unbalance * np.exp(1j * angle)
        moment = car.disc_mass * float((np.conj(centre) * velocity).imag)
        turning = (
            (car.engine_inertia, motion.engine_speed[-1]),
            (car.vehicle_inertia, motion.vehicle_speed[-1]),
        )
        return float(moment + car.disc_inertia * spin + sum(inertia * speed for inertia, speed in turning))

    found = refined(at_end, WORKING)
    return Measured(
        predicted=car.engine_inertia * ENGINE_SPEED + MEAN * until,
        value=found.value,
        error=found.error,
        parameters=parameters_of(car),
        source=f"{SOURCE}; unbalance of 1 mm, an undamped shaft on the engine's axis",
    )


@STUDY.claim(
    "Until lock-up a clutch slips and heats as in a rigid drivetrain, but for the wind-up of its spring",
    resolution=1e-7,
)
def full_slip(engine: Engine) -> Measured:
    """Compare speeds and heat shortly before lock-up with the closed form."""
    car = centred_car()
    theory = FullSlip(car, ENGINE_SPEED, MEAN, RATE)
    until = theory.time_of(SLIP)
    scale = np.array([ENGINE_SPEED, ENGINE_SPEED, ENGINE_SPEED, theory.heat(until)])
    found = refined(
        lambda tolerance: _speeds_and_heat(slipping(car, tolerance=tolerance, until=until)) / scale, WORKING
    )
    return Measured(
        predicted=np.array([*theory.speeds(until), theory.heat(until)]) / scale,
        value=found.value,
        error=found.largest,
        components=SPEEDS_AND_HEAT,
        parameters=parameters_of(car),
        source=f"{SOURCE}; a centred disc, {MEAN:g} N m, a capacity of {RATE:g} N m/s times the time",
        note=f"Speeds of engine, disc and vehicle over the first of the engine, and heat over {scale[-1]:.5g} J, "
        f"when the slip is {SLIP:g} rad/s, {until:.4f} s after the start. The wind-up is {theory.wind_up:.3g} rad/s "
        "of the disc's speed. Numerical error: the largest change with the tolerance.",
    )


def _speeds_and_heat(motion: DrivetrainMotion) -> FloatArray:
    """Return the speeds of engine, disc and vehicle in rad/s and the heat in J at the end."""
    speeds = motion.engine_speed[-1], motion.disc_velocity[-1, 2], motion.vehicle_speed[-1]
    return np.array([*speeds, motion.energy.losses["friction"][-1]])


@functools.lru_cache(maxsize=1)
def _creeping(engine: Engine) -> tuple[FloatArray, FloatArray]:
    """Return the end of the centred car's launch at each ε, shape (n, 4), and the torques at ``STUCK``, (n, 12).

    The torque in stick is the capacity times the share of ε with which the facings creep.
    """
    car = centred_car()
    ends, torques = [], []
    for epsilon in EPSILONS:
        motion = launch(car, epsilon=float(epsilon), tolerance=1e-5)
        ends.append(_speeds_and_heat(motion))
        share = CubicSpline(motion.times, motion.slip)(STUCK) * car.friction_radius / epsilon
        torques.append(share * np.interp(STUCK, KNOTS, CAPACITIES))
    return np.array(ends), np.array(torques)


@STUDY.claim(
    "From slip to stick and on: a launch ends as under Coulomb friction that sticks",
    resolution=1e-3,
    note=f"{SEVERAL}Speeds and heat at {UNTIL:g} s, extrapolated to ε = 0. Numerical error: the most that its last "
    "order changes.",
)
def exact(engine: Engine) -> Measured:
    """Compare the end of the launch, extrapolated to ε = 0, with that of the launch that sticks."""
    ending = end_of_launch()
    scale = np.array([ENGINE_SPEED, ENGINE_SPEED, ENGINE_SPEED, ending[-1]])
    end, error = limit(_creeping(engine)[0] / scale)
    start, stop = stick = time_of_stick()
    return Measured(
        predicted=ending / scale,
        value=end,
        error=error.max(),
        components=SPEEDS_AND_HEAT,
        parameters=parameters_of(centred_car()),
        source=OF_STICK,
        note=f"Speeds are over the first of the engine, and heat is over {ending[-1]:.5g} J. It sticks from "
        f"{start:.4f} to {stop:.4f} s.",
        data={"stick": stick},
    )


@STUDY.claim(
    "In stick the clutch creeps in proportion to the torque that it holds",
    unit="N m",
    resolution=1.0,
    note=f"{SEVERAL}Torque from {STUCK[0]:g} to {STUCK[-1]:g} s: the capacity times the share of ε with which "
    "the facings creep, and what takes engine and disc along as one body. Extrapolated to ε = 0 as before, "
    "with the largest error at any time, because it oscillates as the torque does.",
)
def held(engine: Engine) -> Measured:
    """Compare the torque that creep shows, extrapolated to ε = 0, with what holds a clutch that sticks."""
    _, torques = _creeping(engine)
    torque, error = limit(torques)
    times = np.linspace(STUCK[0], STUCK[-1], 200)
    return Measured(
        predicted=torque_held(STUCK),
        value=torque,
        error=error.max(),
        at={"t in s": STUCK},
        parameters=parameters_of(centred_car()),
        source=OF_STICK,
        data={
            "stuck": STUCK,
            "creep": torques,
            "limit": torque,
            "t held": times,
            "held": torque_held(times),
        },
    )


@STUDY.claim(
    "The error that creep in stick causes in a launch falls like ε",
    kind="order",
    resolution=0.15,
    note=f"{SEVERAL}Change of speeds and heat at {UNTIL:g} s, all over their scales, against Coulomb friction "
    "that sticks. Numerical error: scatter about the power law, tolerance; model error: its next term.",
)
def order(engine: Engine) -> Measured:
    """Compare the power of ε with which the end of the launch comes to that of the launch that sticks."""
    ending = end_of_launch()
    scale = np.array([ENGINE_SPEED, ENGINE_SPEED, ENGINE_SPEED, ending[-1]])
    changes = np.linalg.norm((_creeping(engine)[0] - ending) / scale, axis=1)
    exponent, numerical, model = observed_exponent(EPSILONS, changes, next_term=1.0, noise=1e-6)
    return Measured(
        predicted=1.0,
        value=exponent,
        error=numerical,
        model=model,
        parameters=parameters_of(centred_car()),
        source=OF_STICK,
        data={"epsilon": EPSILONS, "changes": changes},
    )


def limit(values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return ``values`` (shape (n, ...)), of ε that doubles from one to the next, at ε = 0, and the error.

    By the parabola through the three smallest ε. The error is its change against the line through two of them: it
    covers what is left for every series in ε or in powers of ε from 1.5 on.
    """
    line, next_line = 2.0 * values[0] - values[1], 2.0 * values[1] - values[2]
    correction = (line - next_line) / 3.0
    return line + correction, np.abs(correction)
