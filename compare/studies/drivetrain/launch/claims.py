"""A launch of the passenger car: its clutch engages from full slip, sticks, and is opened again.

Where the clutch sticks, Exudyn's law of friction creeps with the share of ε that its torque has of its capacity. What
that changes vanishes with ε, and is measured against Coulomb friction that sticks (``drivetrain_launch_theory``).
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.interpolate import CubicSpline

from compare.claims.claim import Claim, ErrorBudget
from compare.claims.error_estimates import COARSENING, observed_exponent, refined
from compare.claims.parameters import at_each
from compare.claims.study import Data, Findings, Study
from compare.engines import Engine
from compare.studies.drivetrain.launch.pictures import draw
from compare.studies.drivetrain.launch.theory import FullSlip, Launch, states_at
from compare.studies.toolkit.drivetrain_bench import RPM, SOURCE, balance_claim, parameters_of, passenger_car
from reference_model.systems import FloatArray

if TYPE_CHECKING:
    from exudyn_models import Drivetrain
    from exudyn_models.drivetrain.model import DrivetrainMotion

ENGINE_SPEED = 2000.0 * RPM
MEAN, RIPPLE = 100.0, 1.0
"""The engine's mean torque in N m, and what its firing adds to it, as a share."""

KNOTS, CAPACITIES = (0.0, 0.8, 1.2, 1.25), (0.0, 180.0, 180.0, 30.0)
"""Times in s, and the clutch's capacity in N m at them: it is pressed on, held, and opened."""

RATE = CAPACITIES[1] / KNOTS[1]
"""Of the capacity's growth at first, in N m/s."""

UNTIL = 1.35
STUCK = np.linspace(1.08, 1.19, 12)
"""In s: the end, and times at which the clutch sticks."""

SLIP = 10.0
"""rad/s, to which the clutch slips where it does not stick yet."""

EPSILONS = np.array([0.05, 0.1, 0.2, 0.4])
"""ε in m/s. The first is the one of the launch with all its eccentricities."""

LARGEST_STEP = 0.01
"""In s: so large that the tolerance decides."""

ROLLING, AIR = 1300.0 * 9.81 * 0.012 * 0.3 / 13.0, 0.5 * 1.2 * 0.65 * (0.3 / 13.0) ** 3
"""In N m and N m s²/rad² at the input shaft, 0.3 m of wheel behind 13 : 1: 1300 kg on 1.2 %, 0.65 m² in the air."""

BALANCE = "Energy is balanced in a launch from full slip to stick and on"
MOMENTUM = "Engine, vehicle and unbalanced disc gain the angular momentum that the engine's torque gives"
FULL_SLIP = (
    "Until lock-up a clutch slips and heats as in a rigid drivetrain, but for the wind-up of its spring"
)
EXACT = "From slip to stick and on: a launch ends as under Coulomb friction that sticks"
HELD = "In stick the clutch creeps in proportion to the torque that it holds"
ORDER = "What creep in stick changes of a launch falls like ε"


def capacity(time: float) -> float:
    """Return the clutch's capacity in N m."""
    return float(np.interp(time, KNOTS, CAPACITIES))


def resistance(time: float, angle: float, speed: float) -> float:
    """Return the torque in N m by which the vehicle resists, at the input shaft."""
    return -ROLLING * math.tanh(speed) - AIR * speed * abs(speed)


def launch(
    car: Drivetrain, *, epsilon: float, tolerance: float, until: float = UNTIL, sample_every: float = 1e-3
) -> DrivetrainMotion:
    """Return the launch of ``car`` with the engine's ripple and the vehicle's resistance."""
    from exudyn_models import build_drivetrain, four_cylinder

    model = build_drivetrain(
        car,
        normal_load=lambda time: car.normal_load(capacity(time)),
        regularisation=epsilon,
        engine_speed=ENGINE_SPEED,
        gearbox_speed=0.0,
        engine_torque=four_cylinder(MEAN, RIPPLE),
        vehicle_torque=resistance,
    )
    return model.run(until, sample_every=sample_every, largest_step=LARGEST_STEP, tolerance=tolerance)


def slipping(car: Drivetrain, *, tolerance: float, until: float) -> DrivetrainMotion:
    """Return a motion of full slip, under the engine's mean torque alone and a capacity that grows steadily."""
    from exudyn_models import build_drivetrain, four_cylinder

    model = build_drivetrain(
        car,
        normal_load=lambda time: car.normal_load(RATE * time),
        regularisation=float(EPSILONS[0]),
        engine_speed=ENGINE_SPEED,
        gearbox_speed=0.0,
        engine_torque=four_cylinder(MEAN, 0.0),
    )
    return model.run(until, sample_every=until / 10, largest_step=LARGEST_STEP, tolerance=tolerance)


def centred(car: Drivetrain) -> Drivetrain:
    """Return ``car`` with its shaft on the engine's axis and no unbalance: its disc has no radial motion."""
    return replace(car, offset=0.0, unbalance=0.0)


def measure(engine: Engine, epsilons: FloatArray = EPSILONS) -> Findings:
    """Launch the car, and a centred one at several ε; let both slip under a growing load."""
    car = passenger_car()
    data: Data = {}
    claims = [
        claim_of_balance(engine, car, data),
        claim_of_momentum(engine, car),
        claim_of_full_slip(engine, centred(car)),
        *claims_of_stick(engine, centred(car), epsilons, data),
    ]
    return Findings(tuple(claims), data)


def claim_of_balance(engine: Engine, car: Drivetrain, data: Data) -> Claim:
    """Check the energy of the launch with all that the car has, and keep it for the figure."""
    motion, finer = (
        launch(car, epsilon=float(EPSILONS[0]), tolerance=tolerance)
        for tolerance in (8e-7, 8e-7 / COARSENING)
    )
    data["t"] = motion.times
    data["speeds"] = np.column_stack((motion.engine_speed, motion.disc_velocity[:, 2], motion.vehicle_speed))
    data["centre"] = motion.disc[:, :2]
    twist, rate = motion.disc[:, 2] - motion.vehicle_angle, motion.disc_velocity[:, 2] - motion.vehicle_speed
    data["shaft torque"] = car.torsional_stiffness * twist + car.torsional_damping * rate
    data["capacity"] = np.interp(motion.times, KNOTS, CAPACITIES)
    data["heat"] = motion.energy.losses["friction"]
    return balance_claim(
        BALANCE,
        engine.name,
        [motion.energy, finer.energy],
        parameters_of(car, regularisation=float(EPSILONS[0])),
    )


def claim_of_momentum(engine: Engine, car: Drivetrain) -> Claim:
    """Compare the angular momentum at the end of full slip with the impulse of the engine's torque.

    The support is at the origin and undamped: its force has no moment about it.
    """
    car = replace(car, offset=0.0, radial_damping=0.0, unbalance=1e-3)
    until = KNOTS[1]
    impulse = MEAN * until

    def momentum(tolerance: float) -> float:
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

    measured, error = refined(momentum, 1e-9)
    return Claim(
        MOMENTUM,
        equation="",
        kind="conservation",
        engine=engine.name,
        predicted=car.engine_inertia * ENGINE_SPEED + impulse,
        measured=measured,
        budget=ErrorBudget(error, resolution=1e-6),
        parameters=parameters_of(car),
        source=f"{SOURCE}; unbalance of 1 mm, an undamped shaft on the engine's axis",
        unit="kg m²/s",
        note=f"About the engine's axis, after {until:g} s of slip in which the engine's mean torque gives "
        f"{impulse:g} N m s. Numerical error: the change with the tolerance.",
    )


def claim_of_full_slip(engine: Engine, car: Drivetrain) -> Claim:
    """Compare speeds and heat shortly before lock-up with the closed form."""
    theory = FullSlip(car, ENGINE_SPEED, MEAN, RATE)
    until = theory.time_of(SLIP)
    scale = np.array([ENGINE_SPEED, ENGINE_SPEED, ENGINE_SPEED, theory.heat(until)])

    def speeds_and_heat(tolerance: float) -> FloatArray:
        motion = slipping(car, tolerance=tolerance, until=until)
        speeds = motion.engine_speed[-1], motion.disc_velocity[-1, 2], motion.vehicle_speed[-1]
        return np.asarray(np.array([*speeds, motion.energy.losses["friction"][-1]]) / scale)

    measured, error = refined(speeds_and_heat, 1e-9)
    return Claim(
        FULL_SLIP,
        equation="",
        engine=engine.name,
        predicted=np.array([*theory.speeds(until), theory.heat(until)]) / scale,
        measured=measured,
        budget=ErrorBudget(error.max(), resolution=1e-7),
        parameters=parameters_of(car),
        source=f"{SOURCE}; a centred disc, {MEAN:g} N m, a capacity of {RATE:g} N m/s times the time",
        note=f"Speeds of engine, disc and vehicle over the first of the engine, and heat over {scale[-1]:.5g} J, "
        f"when the slip is {SLIP:g} rad/s, {until:.4f} s after the start. The wind-up is {theory.wind_up:.3g} rad/s "
        "of the disc's speed. Numerical error: the largest change with the tolerance.",
    )


def claims_of_stick(engine: Engine, car: Drivetrain, epsilons: FloatArray, data: Data) -> list[Claim]:
    """Compare launches at several ε with the one that sticks."""
    from exudyn_models import four_cylinder

    theory = Launch(car, capacity, KNOTS[1:], four_cylinder(MEAN, RIPPLE), resistance)
    parts = theory.run(ENGINE_SPEED, UNTIL)
    stuck = next(part for part in parts if part.sticks)
    data["stick"] = np.array(
        [stuck.start, next(part.start for part in parts if not part.sticks and part.start > stuck.start)]
    )
    held = np.array([theory.held(t, states_at(parts, t)) for t in STUCK])
    *_, engine_speed, disc_speed, vehicle_speed, heat = parts[-1].states(UNTIL)
    ending = np.array([engine_speed, disc_speed, vehicle_speed, heat])
    scale = np.array([ENGINE_SPEED, ENGINE_SPEED, ENGINE_SPEED, heat])

    ends, torques = [], []
    for epsilon in epsilons:
        motion = launch(car, epsilon=float(epsilon), tolerance=1e-6)
        speeds = motion.engine_speed[-1], motion.disc_velocity[-1, 2], motion.vehicle_speed[-1]
        ends.append(np.array([*speeds, motion.energy.losses["friction"][-1]]))
        share = CubicSpline(motion.times, motion.slip)(STUCK) * car.friction_radius / epsilon
        torques.append(share * np.interp(STUCK, KNOTS, CAPACITIES))
    end, end_error = limit(np.array(ends) / scale)
    torque, torque_error = limit(np.array(torques))
    changes = np.linalg.norm((np.array(ends) - ending) / scale, axis=1)
    data["stuck"], data["creep"], data["limit"] = STUCK, np.array(torques), torque
    data["t held"] = np.linspace(STUCK[0], STUCK[-1], 200)
    data["held"] = np.array([theory.held(t, states_at(parts, t)) for t in data["t held"]])
    data["epsilon"], data["changes"] = epsilons, changes
    order, numerical, model = observed_exponent(epsilons, changes, next_term=1.0, noise=1e-6)
    note = f"{at_each('ε in m/s', epsilons)}; a centred disc. "
    source = f"{SOURCE}; four cylinders that fire with {MEAN * RIPPLE:g} N m, capacity up to {max(CAPACITIES):g} N m"
    return [
        Claim(
            EXACT,
            equation="",
            engine=engine.name,
            predicted=ending / scale,
            measured=end,
            budget=ErrorBudget(end_error.max(), resolution=1e-3),
            parameters=parameters_of(car),
            source=source,
            note=f"{note}Speeds of engine, disc and vehicle over the first of the engine, and heat over {heat:.5g} "
            f"J, at {UNTIL:g} s, extrapolated to ε = 0. Numerical error: the most that its last order changes. "
            f"It sticks from {data['stick'][0]:.4f} to {data['stick'][1]:.4f} s.",
        ),
        Claim(
            HELD,
            equation="",
            engine=engine.name,
            predicted=held,
            measured=torque,
            budget=ErrorBudget(torque_error.max(), resolution=1.0),
            parameters=parameters_of(car),
            source=source,
            unit="N m",
            note=f"{note}Torque from {STUCK[0]:g} to {STUCK[-1]:g} s: the capacity times the share of ε with which "
            "the facings creep, and what takes engine and disc along as one body. Extrapolated to ε = 0 as before, "
            "with the largest error at any time, because it oscillates as the torque does.",
        ),
        Claim(
            ORDER,
            equation="",
            kind="order",
            engine=engine.name,
            predicted=1.0,
            measured=order,
            budget=ErrorBudget(numerical, model=model, resolution=0.15),
            parameters=parameters_of(car),
            source=source,
            note=f"{note}Change of speeds and heat at {UNTIL:g} s, all over their scales, against Coulomb friction "
            "that sticks. Numerical error: scatter about the power law, tolerance; model error: its next term.",
        ),
    ]


def limit(values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return ``values`` (shape (n, ...)), of ε that doubles from one to the next, at ε = 0, and the error.

    By the parabola through the three smallest ε. The error is its change against the line through two of them: it
    covers what is left for every series in ε or in powers of ε from 1.5 on.
    """
    line, next_line = 2.0 * values[0] - values[1], 2.0 * values[1] - values[2]
    correction = (line - next_line) / 3.0
    return line + correction, np.abs(correction)


STUDY = Study(
    name="drivetrain-launch",
    title="A launch: from full slip to stick and on",
    section="The drivetrain",
    paper="Not in the paper, which has constant speeds on both sides. A clutch in a car slips from standstill until "
    "engine and disc turn alike, then holds the engine's torque with its ripple, and slips again once its capacity "
    "falls below that. The friction that moves the disc radially is the one that heats the facings.",
    by_hand=measure,
    draw=draw,
    figures={
        "drivetrain-launch": "The passenger car's launch, with the shaft's axis 0.2 mm beside the engine's. Grey: "
        "the clutch sticks, by three rotors with Coulomb friction. Torque of the shaft against the clutch's "
        "capacity; power and heat of the facings; distance of the disc's centre from the engine's axis: the nearer "
        "to lock-up, the stronger friction pulls it there. In stick it turns with the flywheel, and ε lets it creep.",
        "drivetrain-launch-stick": "Left: the torque that the clutch holds in stick, and the same from the creep of "
        "the facings at each ε and extrapolated to ε = 0. Right: what creep changes of speeds and heat at "
        "the end of the launch.",
    },
    only=("exudyn",),
    seconds=8.0,
)
