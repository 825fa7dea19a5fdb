"""Predictions of the reference for the clutch, and small motions of the whole drivetrain about a whirl.

Their five coordinates are x, y and the angle φ of the disc, and the angles θ of the engine and ψ of the vehicle. The
slip u = (ẋ + θ̇y) + i(ẏ − θ̇x) and the relative spin S = θ̇ − φ̇ are linear in their rates. The transpose of this map
applies friction to the disc and its reaction, the moment −(M + z×F), to the engine.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import brentq

from compare.claims import WORKING, Data, Study
from compare.claims.linearised_flow import ComplexArray
from compare.studies.toolkit import drivetrain_bench as bench
from compare.studies.toolkit.drivetrain_bench import EPSILON, RINGS, RPM, SOURCE, Operation, facings
from reference_model import Annulus
from reference_model.steady.stability import QUARTER_TURN
from reference_model.support import ROUNDED_UP, Support
from reference_model.systems import FloatArray

if TYPE_CHECKING:
    from exudyn_models import Drivetrain, DrivetrainModel


FINER = 24
"""Rings of the reference's annulus in place of 16, which shows the error of 16 rings."""

CASES = ((80.0, 12.0), (40.0, 12.0), (80.0, 30.0))
TORQUE, SLIPPING = 80.0, 12.0
"""Torques in N m and slips in rad/s of the onsets and of the bench; they resemble the run-up."""

BELOW, ABOVE = (1500.0, 2200.0, 2700.0), (3600.0, 4500.0, 6000.0)
"""Speeds in rpm below and above the onset."""

DECAYS, SEEN = 20.0, 5.0
"""Length of a run in decay times of its slowest mode; the last ``SEEN`` show the remaining transient."""

START, SAMPLE = 3e-4, 5e-4
"""Initial position of a whirl in m, within the play, and sampling interval in s."""

MODULATED = (6000.0, 0.6, 0.1)
"""Speed in rpm, torque in N m, and relative surplus of the load over the load that this torque needs."""

WHIRLS = (MODULATED, (3800.0, 1.3, 0.05), (4500.0, 8.0, 0.01))
"""The second whirl is not modulated, the third touches the stop."""

BORDER_SURPLUS, BORDER_TORQUES = MODULATED[2], (0.2, 0.8, 1.4)
"""Surplus, and torques in N m from a small whirl to one that almost reaches the stop."""

BETWEEN = (3900.0, 4300.0)
"""Speeds in rpm below and above the border."""

TIME, DEVIATION, TOLERANCE = 0.4, 3e-3, 20 * WORKING
"""Runs whose difference is taken: duration in s, initial deviation as a share of the radius, and tolerance."""

PUSH, UNTIL, CYCLE_SAMPLE, ROUGHER = 0.2, 6.0, 2e-3, 80.0
"""Modulated motion: initial deviation as a share of the radius, end and sampling interval in s, and tolerance as a
multiple of the usual tolerance.
"""

SPEEDS, TORQUES = np.linspace(2900.0, 6500.0, 32), np.geomspace(0.2, 60.0, 32)
SURPLUSES = np.geomspace(1e-4, 0.2, 32)
SURPLUS, SPEED = 0.1, 6000.0
"""Axes of the maps: speeds in rpm from just above the natural frequency, torques in N m and surpluses. Then the
surplus of the map of speeds, and the speed of the map of surpluses.
"""

ENGINE, VEHICLE, ANGLE, CENTRE = 0, 1, 4, slice(2, 4)
"""Indices of θ, ψ, φ, and of x and y, among the coordinates."""


@dataclass(frozen=True)
class CarWhirl:
    """A steady whirl of the clutch disc in a car whose engine and load have constant torques (N m).

    ω, S and κ are in rad/s, ρ in m, and μN of both facings in N. The engine also drives the whirl, with ρ·βκρ.
    """

    engine_speed: float
    slip: float
    frequency: float
    radius: float
    friction_force: float
    torque: float
    engine_torque: float


def whirl_under_surplus(
    car: Drivetrain, engine_speed: float, torque: float, surplus: float
) -> CarWhirl | None:
    """Return the whirl of a clutch whose load exceeds that for ``torque`` by the fraction ``surplus``, or None.

    M(U, S), with the slips U of the centre and S of the rim, equals the torque at one ratio U/S. This ratio
    determines F, and ρ·β·κ(ρ) = μN·F determines the radius. Then S = (ω − κ)ρ/(U/S).
    """
    law, support = facings(car), support_of(car)
    needed = car.friction_radius / (1.0 + surplus)
    ratio = _ratio_of_moment(law, needed)
    friction = torque / needed
    drive = friction * law.shares(ratio, 1.0).resistance
    damping, mass = car.radial_damping, car.disc_mass

    def left(radius: float) -> float:
        return damping * math.sqrt(support.secant(radius) / mass) * radius - drive

    largest = drive / (damping * bench.natural_frequency(car)) * ROUNDED_UP
    radius = float(brentq(left, 0.0, largest, xtol=1e-18, rtol=1e-14))
    frequency = math.sqrt(support.secant(radius) / mass)
    if frequency >= engine_speed:
        return None
    slip = (engine_speed - frequency) * radius / ratio
    return CarWhirl(engine_speed, slip, frequency, radius, friction, torque, torque + drive * radius)


@functools.lru_cache(maxsize=64)
def _ratio_of_moment(law: Annulus, needed: float) -> float:
    widest = 10.0 * law.outer_radius
    return float(brentq(lambda ratio: law.shares(ratio, 1.0).moment - needed, 0.0, widest, xtol=1e-15))


def support_of(car: Drivetrain) -> Support:
    return Support(car.radial_stiffness, 0.0, car.hardening, car.stop_gap, car.stop_stiffness)


def state_matrix_of(car: Drivetrain, whirl: CarWhirl, rings: int = RINGS) -> FloatArray:
    """Return A of small motions (θ, ψ, x, y, φ and rates), shape (10, 10), with the centre on the x axis."""
    x, omega, law = whirl.radius, whirl.engine_speed, facings(car, rings)
    place_to_slip, rate_to_slip = np.zeros((3, 5)), np.zeros((3, 5))  # rows: u_x, u_y, S
    place_to_slip[:2, CENTRE] = -omega * QUARTER_TURN
    rate_to_slip[:2, CENTRE] = np.eye(2)
    rate_to_slip[1, ENGINE] = -x
    rate_to_slip[2, [ENGINE, ANGLE]] = 1.0, -1.0
    slip = 1j * (whirl.frequency - omega) * x
    force, _ = law.force_and_moment(slip, whirl.slip, 0.0)
    changes = whirl.friction_force * law.jacobian(slip, whirl.slip, 0.0)[:, :3]
    # The moment on the disc resists S, so its generalised force for S is negative.
    put = rate_to_slip.T @ np.diag([1.0, 1.0, -1.0])
    stiffness, damping = -put @ changes @ place_to_slip, -put @ changes @ rate_to_slip
    fx, fy = whirl.friction_force * force.real, whirl.friction_force * force.imag
    stiffness[ENGINE, CENTRE] -= -fy, fx  # the arm of the force changes
    stiffness[CENTRE, CENTRE] += support_of(car).stiffness_matrix(complex(x))
    damping[CENTRE, CENTRE] += car.radial_damping * np.eye(2)
    twist = np.zeros(5)
    twist[[VEHICLE, ANGLE]] = -1.0, 1.0
    stiffness += car.torsional_stiffness * np.outer(twist, twist)
    damping += car.torsional_damping * np.outer(twist, twist)
    inertias = np.array(
        [car.engine_inertia, car.vehicle_inertia, car.disc_mass, car.disc_mass, car.disc_inertia]
    )
    lower = -np.hstack((stiffness, damping)) / inertias[:, None]
    return np.vstack((np.eye(5, 10, 5), lower))


def in_turning_axes(matrix: FloatArray, frequency: float) -> FloatArray:
    """Return the matrix of small motions in axes that turn with ``frequency`` (rad/s), shape (8, 8).

    The state is x, y, the twist φ − ψ and the rates of θ, ψ, x, y, φ.
    """
    turned = matrix.copy()
    for first in (2, 7):
        turned[first : first + 2, first : first + 2] -= frequency * QUARTER_TURN
    turned[ANGLE] -= turned[VEHICLE]  # nothing depends on θ, and on ψ only through the twist
    return turned[2:, 2:]


def of_modulation(matrix: FloatArray, frequency: float) -> ComplexArray:
    """Return six eigenvalues (1/s), slowest decay first, without the two of the free phase and of the car's speed."""
    values = np.linalg.eigvals(in_turning_axes(matrix, frequency)).astype(complex)
    values = values[np.argsort(np.abs(values))[2:]]
    return np.asarray(values[np.lexsort((-values.imag, -values.real))])


def modulation(car: Drivetrain, whirl: CarWhirl, rings: int = RINGS) -> ComplexArray:
    return of_modulation(state_matrix_of(car, whirl, rings), whirl.frequency)


def whirls_of(car: Drivetrain) -> list[CarWhirl]:
    found = [whirl_under_surplus(car, speed * RPM, torque, surplus) for speed, torque, surplus in WHIRLS]
    return [whirl for whirl in found if whirl is not None]


def curves(every: int = 1) -> Data:
    """Return the reference's lines against the speed and maps of the modulation, at every ``every``-th point."""
    car, centred = bench.passenger_car(), bench.centred_car()
    onset = bench.onset_speed(car, SLIPPING, TORQUE) / RPM
    slow = np.linspace(300.0, onset - 1.0, 40)[::every]
    fast = np.linspace(onset + 5.0, 6200.0, 25)[::every]
    rests = [bench.rest_of(car, Operation(speed * RPM, SLIPPING, TORQUE, car.offset)) for speed in slow]
    circles = [bench.whirl_of(car, Operation(speed * RPM, SLIPPING, TORQUE)) for speed in fast]
    speeds, torques, surpluses = SPEEDS[::every], TORQUES[::every], SURPLUSES[::every]
    return {
        "onset": np.array(onset),
        "rest": np.array([(speed, each.x, each.y) for speed, each in zip(slow, rests, strict=True)]),
        "whirl": np.array([(n, each.radius, each.frequency) for n, each in zip(fast, circles, strict=True)]),
        "speeds": speeds,
        "torques": torques,
        "surpluses": surpluses,
        "over speed": np.array([[whirl_growth(centred, n, t, SURPLUS) for n in speeds] for t in torques]),
        "over surplus": np.array([[whirl_growth(centred, SPEED, t, s) for s in surpluses] for t in torques]),
    }


def whirl_growth(car: Drivetrain, speed: float, torque: float, surplus: float) -> FloatArray:
    """Return the growth rate (1/s) of the modulation and the radius (m) of the whirl; NaN if there is none."""
    whirl = whirl_under_surplus(car, speed * RPM, torque, surplus)
    if whirl is None:
        return np.array([np.nan, np.nan])
    return np.array([modulation(car, whirl)[0].real, whirl.radius])


def build(
    car: Drivetrain, whirl: CarWhirl, *, deviation: float = 0.0, regularisation: float = EPSILON
) -> DrivetrainModel:
    """Return the drivetrain in a whirl whose radius is larger by the fraction ``deviation``."""
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
    scale = 1.0 + deviation
    bench.start_disc(model, complex(scale * whirl.radius), scale * (1j * whirl.frequency * whirl.radius))
    return model


LOW, *_, HIGH = (f"{torque:g}" for torque in BORDER_TORQUES)
WORDS = {"surplus": f"{100.0 * BORDER_SURPLUS:g}", "low": LOW, "high": HIGH}
STUDY = Study.beside(__file__, "drivetrain-frozen", words=WORDS, source=SOURCE, only=("exudyn",), seconds=4.0)
STUDY.provides(curves=curves)
