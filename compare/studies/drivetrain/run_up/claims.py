"""The car's drivetrain runs up from idle to 6000 turns a minute while its clutch slips under control."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from compare.claims.claim import Claim, ErrorBudget
from compare.claims.error_estimates import COARSENING, change_as_error
from compare.claims.study import Data, Findings, Study
from compare.engines import Engine
from compare.studies.drivetrain.run_up.pictures import TURNS, animations, draw, strongest_line
from compare.studies.toolkit.drivetrain_bench import (
    EPSILON,
    RPM,
    SOURCE,
    Operation,
    balance_claim,
    natural_frequency,
    onset_speed,
    parameters_of,
    passenger_car,
    rotating_damping,
)
from compare.studies.toolkit.drivetrain_steady import rest_of, whirl_of
from reference_model.systems import FloatArray

if TYPE_CHECKING:
    from exudyn_models import Drivetrain
    from exudyn_models.drivetrain.model import DrivetrainMotion

BALANCE = "Energy is balanced in the run-up of the whole drivetrain"
LINES = (
    "The strongest line of the run-up's spectrum is the unbalance's below the natural frequency, above the onset "
    "it is the reference's whirl"
)

IDLE, TOP = 800.0, 6000.0
"""In turns a minute."""

TORQUE, RIPPLE = 100.0, 1.0
"""Mean torque of the engine in N m, and what its firing order adds to it, as a part of the mean."""

SLIP, GAIN = 12.0, 0.05
"""Slip to hold in rad/s, and by which part of itself the load grows with each rad/s too much."""

TOLERANCE = 8e-7

LINES_APART = 0.06
"""In orders of the engine: what lies between unbalance and whirl at least, above the onset."""

SAMPLE = 5e-4
"""In s: 20 times in a turn at 6000 turns a minute."""


def duration(car: Drivetrain, top: float) -> float:
    """Return how many s the mean torque takes to bring engine and vehicle from idle to ``top`` (turns a minute)."""
    inertia = car.engine_inertia + car.disc_inertia + car.vehicle_inertia
    return (top - IDLE) * RPM * inertia / TORQUE


def transmitted(car: Drivetrain) -> float:
    """Return what of the mean torque goes through the clutch, in N m."""
    behind = car.disc_inertia + car.vehicle_inertia
    return TORQUE * behind / (car.engine_inertia + behind)


def run(car: Drivetrain, tolerance: float, top: float = TOP) -> DrivetrainMotion:
    """Return the run-up to ``top`` (turns a minute); the load is fed forward and corrected by the slip."""
    from exudyn_models import build_drivetrain, four_cylinder

    torque = transmitted(car)
    needed = car.normal_load(torque)
    model = build_drivetrain(
        car,
        normal_load=needed,
        regularisation=EPSILON,
        engine_speed=IDLE * RPM,
        gearbox_speed=IDLE * RPM - SLIP,
        engine_torque=four_cylinder(TORQUE, RIPPLE),
        shaft_torque=torque,
    )
    model.friction.change(normal_load=lambda time: max(0.0, needed * (1.0 + GAIN * (model.slip() - SLIP))))
    return model.run(duration(car, top), sample_every=SAMPLE, tolerance=tolerance)


def measure(engine: Engine, top: float = TOP) -> Findings:
    """Run the drivetrain up to ``top`` (turns a minute), at two tolerances."""
    car = passenger_car()
    motions = [run(car, tolerance, top) for tolerance in (TOLERANCE, TOLERANCE / COARSENING)]
    claim = balance_claim(
        BALANCE,
        engine.name,
        [motion.energy for motion in motions],
        parameters_of(car, torque=TORQUE, ripple=RIPPLE, slip=SLIP, gain=GAIN),
    )
    data, finer = (
        {
            "times": motion.times,
            "engine": np.column_stack((motion.engine_angle, motion.engine_speed)),
            "disc": motion.disc,
            "slip": motion.slip,
        }
        for motion in motions
    )
    lines = (
        ()
        if motions[0].engine_angle[-1] < 2.0 * math.pi * TURNS
        else (lines_claim(engine.name, data, finer),)
    )
    return Findings((claim, *lines), data)


def lines_claim(engine: str, found: Data, finer: Data) -> Claim:
    """Return the order of the strongest forward line in each window of the spectrum."""
    car = passenger_car()
    (speeds, measured), (_, other) = strongest_line(found), strongest_line(finer)
    circling, _, frequency = whirls_above_onset(car).T
    below, above = speeds < natural_frequency(car), speeds >= circling[0]
    unbalance = 1.0 - SLIP / speeds
    whirl = np.interp(speeds, circling, frequency) / speeds
    chosen = below | above
    return Claim(
        LINES,
        equation="",
        engine=engine,
        predicted=np.where(below, unbalance, whirl)[chosen],
        measured=measured[chosen],
        budget=ErrorBudget(
            float(np.max(change_as_error(measured, other))), model=1.0 / TURNS, resolution=0.5 * LINES_APART
        ),
        parameters=parameters_of(car, torque=TORQUE, ripple=RIPPLE, slip=SLIP, gain=GAIN),
        source=SOURCE,
        note=f"Orders of the engine in windows of {TURNS} turns, {np.count_nonzero(below)} below "
        f"{natural_frequency(car) / RPM:.0f} and {np.count_nonzero(above)} above {circling[0] / RPM:.0f} turns a "
        f"minute; a parabola through the top. Predicted: 1 − slip/ω, and the whirl at frozen speeds without offset. "
        f"Between the two lines lie {LINES_APART:g} orders or more. Model error: 1/{TURNS} of an order, what a "
        "window of so many turns resolves. Numerical error: the largest change at a smaller tolerance.",
    )


def whirls_above_onset(car: Drivetrain) -> FloatArray:
    """Return speed in rad/s, radius in m and frequency in rad/s of the reference's whirl, shape (30, 3)."""
    torque = transmitted(car)
    speeds = np.linspace(onset_speed(car, SLIP, torque), TOP * RPM, 31)[1:]
    circles = [whirl_of(car, Operation(speed, SLIP, torque)) for speed in speeds]
    return np.array([(s, each.radius, each.frequency) for s, each in zip(speeds, circles, strict=True)])


def theory() -> Findings:
    """Compute what the reference predicts of the reduced disc at frozen speeds."""
    car = passenger_car()
    k, torque = natural_frequency(car), transmitted(car)
    onset, damping = onset_speed(car, SLIP, torque), rotating_damping(car, SLIP, torque)
    slow = np.linspace(IDLE * RPM, onset, 121)[:-1]
    rests = [rest_of(car, Operation(speed, SLIP, torque, car.offset)) for speed in slow]
    # Small motions of the unbalanced disc: mz̈ + (β + D)ż + (C − iωD)z = m·e·s²·exp(ist) at its own speed s.
    own = slow - SLIP
    dynamic = car.radial_stiffness - car.disc_mass * own**2
    net = (car.radial_damping + damping) * own - slow * damping
    data: Data = {
        "rest": np.column_stack((slow, [abs(complex(each.x, each.y)) for each in rests])),
        "unbalance": car.disc_mass * car.unbalance * own**2 / np.hypot(dynamic, net),
        "whirl": whirls_above_onset(car),
        "onset": np.array([onset, k]),
    }
    return Findings((), data)


STUDY = Study(
    name="drivetrain-run-up",
    title="A car runs up with a slipping clutch",
    section="The drivetrain",
    paper="The paper has a clutch in mind. This is one: engine and flywheel with the torque ripple of four "
    "cylinders, a disc with facings and unbalance between them, on an elastic shaft whose axis lies 0.2 mm beside "
    "the engine's and which has 0.5 mm of play in its pilot bearing, and behind a torsional spring the car. Its load "
    "is controlled so that the clutch slips by 12 rad/s. From idle to 6000 turns a minute it goes through all that "
    "the paper describes: self-centring, the natural frequency, the loss of stability, and the limit cycle with "
    "large displacements, which the play limits, as the paper expects of what is not linear.",
    by_hand=measure,
    theory=theory,
    draw=draw,
    animations=animations,
    figures={
        "drivetrain-run-up": "Distance of the disc's centre from the engine's axis, in every two turns of the "
        "engine, and slip. Black: where the reference's disc rests at a frozen speed, and how far the unbalance "
        "swings it in linear theory, for whose resonance the run-up is too fast. Blue: the whirl of the reference on "
        "its stop, without offset, and shifted by the offset, because the stop is about the shaft's axis.",
        "drivetrain-waterfall": "Order-tracked spectrum of x + iy, 36 turns a window. Below the onset the disc rests "
        "beside the engine's axis (0 Hz) and follows its unbalance, whose order is below the engine's by the slip. "
        "Above, it whirls forwards on the line of the reference, beside the unbalance, and the stop adds multiples.",
        "drivetrain-picture": "The drivetrain in three moments of the run-up, by Exudyn's ray tracer, the cover cut "
        "open. Radial motion, offset and play are enlarged 50 times.",
        "drivetrain-turning": "Slow motion of two turns of the engine at the same three speeds: at rest in space, "
        "near the resonance, whirling on the stop. Radial motion is enlarged 50 times on the left.",
    },
    only=("exudyn",),
    seconds=10.0,
)
