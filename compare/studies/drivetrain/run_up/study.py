"""Parameters, formulas and claims."""

from __future__ import annotations

import functools
import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.interpolate import CubicSpline

from compare.claims import COARSENING, Data, Measured, Study, change_as_error
from compare.engines import Engine
from compare.studies.toolkit import drivetrain_bench as bench
from compare.studies.toolkit.drivetrain_bench import RPM, SOURCE, Operation, natural_frequency, passenger_car
from reference_model.systems import FloatArray

if TYPE_CHECKING:
    from exudyn_models import Drivetrain
    from exudyn_models.drivetrain.model import DrivetrainMotion

IDLE, TOP, TORQUE, RIPPLE = 800.0, 6000.0, 100.0, 1.0
"""Speeds in rpm, mean torque of the engine in N m, and amplitude of its firing order relative to the mean."""

SLIP, GAIN = 12.0, 0.05
"""Target slip in rad/s, and relative increase of the load per rad/s of excess slip."""

TOLERANCE, SAMPLE = 6.4e-6, 5e-4
"""Tolerance, which gives the energy balance an error of 2.5e-7, and sampling interval in s."""

LINES_APART = 0.06
"""Smallest distance of the lines of unbalance and whirl above the onset, in orders of the engine."""

TURNS, SAMPLES = 36, 16
"""Window of the spectrum in turns of the engine, and samples per turn."""


def duration(car: Drivetrain, top: float) -> float:
    """Return the time (s) until the mean torque has accelerated engine and vehicle to ``top`` (rpm)."""
    inertia = car.engine_inertia + car.disc_inertia + car.vehicle_inertia
    return (top - IDLE) * RPM * inertia / TORQUE


def transmitted(car: Drivetrain) -> float:
    """Return the mean torque (N m) that the clutch transmits."""
    behind = car.disc_inertia + car.vehicle_inertia
    return TORQUE * behind / (car.engine_inertia + behind)


# --- The reduced disc at frozen speeds, by the reference


@functools.lru_cache(maxsize=2)
def whirls_above_onset(car: Drivetrain) -> FloatArray:
    """Return speed (rad/s), radius (m) and frequency (rad/s) of the whirl, shape (30, 3)."""
    torque = transmitted(car)
    speeds = np.linspace(bench.onset_speed(car, SLIP, torque), TOP * RPM, 31)[1:]
    circles = [bench.whirl_of(car, Operation(speed, SLIP, torque)) for speed in speeds]
    return np.array([(s, each.radius, each.frequency) for s, each in zip(speeds, circles, strict=True)])


def curves(count: int = 120) -> Data:
    car = passenger_car()
    k, torque = natural_frequency(car), transmitted(car)
    onset, damping = bench.onset_speed(car, SLIP, torque), bench.rotating_damping(car, SLIP, torque)
    slow = np.linspace(IDLE * RPM, onset, count + 1)[:-1]
    rests = [bench.rest_of(car, Operation(speed, SLIP, torque, car.offset)) for speed in slow]
    # Small motions with unbalance, at the disc's own speed s: mz̈ + (β + D)ż + (C − iωD)z = m·e·s²·exp(ist)
    own = slow - SLIP
    dynamic = car.radial_stiffness - car.disc_mass * own**2
    net = (car.radial_damping + damping) * own - slow * damping
    return {
        "rest": np.column_stack((slow, [abs(complex(each.x, each.y)) for each in rests])),
        "unbalance": car.disc_mass * car.unbalance * own**2 / np.hypot(dynamic, net),
        "whirl": whirls_above_onset(car),
        "onset": np.array([onset, k]),
    }


# --- The run-up in Exudyn


def run(car: Drivetrain, tolerance: float, top: float = TOP) -> DrivetrainMotion:
    """Return the run-up to ``top`` (rpm), with a feedforward load that the slip corrects."""
    from exudyn_models import build_drivetrain, four_cylinder

    torque = transmitted(car)
    needed = car.normal_load(torque)
    model = build_drivetrain(
        car,
        normal_load=needed,
        regularisation=bench.EPSILON,
        engine_speed=IDLE * RPM,
        gearbox_speed=IDLE * RPM - SLIP,
        engine_torque=four_cylinder(TORQUE, RIPPLE),
        shaft_torque=torque,
    )
    model.friction.change(normal_load=lambda time: max(0.0, needed * (1.0 + GAIN * (model.slip() - SLIP))))
    return model.run(duration(car, top), sample_every=SAMPLE, tolerance=tolerance)


# --- Order-tracked spectrum

HOP = 2 * SAMPLES
"""Samples from one window to the next."""


def order_spectrum(found: Data) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return speeds (rad/s, shape (m,)), orders (n,) and amplitudes of x + iy (m, shape (n, m)).

    Samples at equal angles of the engine keep an order constant.
    """
    angle, speed = found["engine"].T
    even = np.arange(angle[0], angle[-1], 2.0 * math.pi / SAMPLES)
    times = np.interp(even, angle, found["times"])
    z = CubicSpline(found["times"], bench.centre(found["disc"]))(times)
    window = np.hanning(TURNS * SAMPLES)
    # scipy.signal contains such a transform, but its import takes longer than the transform of a run-up.
    first = -(-(len(window) // 2) // HOP) * HOP  # the first middle whose window lies within the run-up
    samples = np.lib.stride_tricks.sliding_window_view(z, len(window))[first - len(window) // 2 :: HOP]
    lines = 2 * len(window)
    spectrum = np.fft.fft(samples * (window / np.sum(window)), lines)
    amplitude = np.abs(np.fft.fftshift(spectrum, axes=1)).T
    orders = np.fft.fftshift(np.fft.fftfreq(lines, 1.0 / SAMPLES))
    middles = even[0] + 2.0 * math.pi / SAMPLES * (first + HOP * np.arange(len(samples)))
    return np.interp(middles, angle, speed), orders, amplitude


def strongest_line(found: Data) -> tuple[FloatArray, FloatArray]:
    """Return the speed (rad/s) and the order of the strongest forward line in each window, shape (m,) each.

    Orders below one half are excluded, so a disc almost at rest does not count.
    """
    speed, orders, amplitude = order_spectrum(found)
    first = int(np.searchsorted(orders, 0.5))
    top = first + np.argmax(amplitude[first:-1], axis=0)
    low, middle, high = (np.log(np.take_along_axis(amplitude, (top + i)[None], 0)[0]) for i in (-1, 0, 1))
    return speed, orders[top] + (orders[1] - orders[0]) * 0.5 * (low - high) / (low - 2.0 * middle + high)


WORDS = {"turns": str(TURNS)}
STUDY = Study.beside(__file__, "drivetrain-run-up", words=WORDS, source=SOURCE, only=("exudyn",), seconds=5.0)
STUDY.provides(curves=curves)


@functools.lru_cache(maxsize=1)
def _run_ups(engine: Engine, top: float) -> tuple[DrivetrainMotion, DrivetrainMotion]:
    car = passenger_car()
    return run(car, TOLERANCE, top), run(car, TOLERANCE / COARSENING, top)


def _shown(motion: DrivetrainMotion) -> Data:
    return {
        "times": motion.times,
        "engine": np.column_stack((motion.engine_angle, motion.engine_speed)),
        "disc": motion.disc,
        "slip": motion.slip,
    }


def _parameters() -> dict[str, float | str]:
    return bench.parameters_of(passenger_car(), torque=TORQUE, ripple=RIPPLE, slip=SLIP, gain=GAIN)


@STUDY.claim(
    "The energy balance closes in the run-up of the whole drivetrain",
    kind="conservation",
    resolution=1e-6,
    basis="self-check",  # the heat comes from the friction law of the model itself
)
def balance(engine: Engine, top: float = TOP) -> Measured:
    motions = _run_ups(engine, top)
    measured = bench.balance_of([motion.energy for motion in motions], _parameters())
    return replace(measured, data=_shown(motions[0]))


@STUDY.claim(
    "The strongest line of the run-up is the unbalance below the natural frequency and the whirl above the onset",
    resolution=0.5 * LINES_APART,
)
def lines(engine: Engine, top: float = TOP) -> Measured | None:
    motions = _run_ups(engine, top)
    if motions[0].engine_angle[-1] < 2.0 * math.pi * TURNS:
        return None
    car = passenger_car()
    (speeds, measured), (_, other) = (strongest_line(_shown(motion)) for motion in motions)
    circling, _, frequency = whirls_above_onset(car).T
    below, above = speeds < natural_frequency(car), speeds >= circling[0]
    unbalance = 1.0 - SLIP / speeds
    whirl = np.interp(speeds, circling, frequency) / speeds
    chosen = below | above
    return Measured(
        predicted=np.where(below, unbalance, whirl)[chosen],
        value=measured[chosen],
        error=float(np.max(change_as_error(measured, other))),
        model=1.0 / TURNS,
        at={"speed in rpm": speeds[chosen] / RPM},
        parameters=_parameters(),
        note=f"Orders of the engine in windows of {TURNS} turns, {np.count_nonzero(below)} below "
        f"{natural_frequency(car) / RPM:.0f} rpm and {np.count_nonzero(above)} above {circling[0] / RPM:.0f} rpm, "
        "with a parabola through the maximum. Predicted: 1 − slip/ω, and the reference's whirl at frozen speeds "
        f"without offset. Both lines are at least {LINES_APART:g} orders apart. Model error: 1/{TURNS} of an order, "
        "the resolution of a window. Numerical error: the largest change at a smaller tolerance.",
    )
