"""The car's drivetrain runs up from idle to 6000 turns a minute while its clutch slips under control."""

from __future__ import annotations

import functools
import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from compare.claims.error_estimates import COARSENING, change_as_error
from compare.claims.measured import Measured
from compare.claims.study import Data, Study
from compare.engines import Engine
from compare.studies.drivetrain.run_up.model import run
from compare.studies.drivetrain.run_up.parameters import (
    GAIN,
    LINES_APART,
    RIPPLE,
    SLIP,
    TOLERANCE,
    TOP,
    TORQUE,
    TURNS,
)
from compare.studies.drivetrain.run_up.pictures import animations, draw
from compare.studies.drivetrain.run_up.spectrum import strongest_line
from compare.studies.drivetrain.run_up.theory import curves, whirls_above_onset
from compare.studies.toolkit.drivetrain_bench import (
    RPM,
    SOURCE,
    balance_of,
    natural_frequency,
    parameters_of,
    passenger_car,
)

if TYPE_CHECKING:
    from exudyn_models.drivetrain.model import DrivetrainMotion

STUDY = Study.beside(
    __file__,
    "drivetrain-run-up",
    words={"turns": str(TURNS)},
    source=SOURCE,
    only=("exudyn",),
    seconds=5.0,
)
STUDY.provides(figures=draw, animations=animations, curves=curves)


@functools.lru_cache(maxsize=1)
def _run_ups(engine: Engine, top: float) -> tuple[DrivetrainMotion, DrivetrainMotion]:
    """Return the run-up to ``top`` (turns a minute) at two tolerances."""
    car = passenger_car()
    return run(car, TOLERANCE, top), run(car, TOLERANCE / COARSENING, top)


def _shown(motion: DrivetrainMotion) -> Data:
    """Return what spectrum and figures are made of."""
    return {
        "times": motion.times,
        "engine": np.column_stack((motion.engine_angle, motion.engine_speed)),
        "disc": motion.disc,
        "slip": motion.slip,
    }


def _parameters() -> dict[str, float | str]:
    return parameters_of(passenger_car(), torque=TORQUE, ripple=RIPPLE, slip=SLIP, gain=GAIN)


@STUDY.claim(
    "Energy is balanced in the run-up of the whole drivetrain",
    kind="conservation",
    resolution=1e-6,
    basis="self-check",  # the model's own law of friction gives the heat
)
def balance(engine: Engine, top: float = TOP) -> Measured:
    """Check the energy of the run-up to ``top`` (turns a minute), and keep it for the figures."""
    motions = _run_ups(engine, top)
    measured = balance_of([motion.energy for motion in motions], _parameters())
    return replace(measured, data=_shown(motions[0]))


@STUDY.claim(
    "The run-up's strongest line is the unbalance below the natural frequency, the reference's whirl above the onset",
    resolution=0.5 * LINES_APART,
)
def lines(engine: Engine, top: float = TOP) -> Measured | None:
    """Compare the order of the strongest forward line in each window of the spectrum.

    A run-up that is shorter than a window claims nothing.
    """
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
        f"{natural_frequency(car) / RPM:.0f} and {np.count_nonzero(above)} above {circling[0] / RPM:.0f} turns a "
        f"minute; a parabola through the top. Predicted: 1 − slip/ω, and the whirl at frozen speeds without offset. "
        f"Between the two lines lie {LINES_APART:g} orders or more. Model error: 1/{TURNS} of an order, what a "
        "window of so many turns resolves. Numerical error: the largest change at a smaller tolerance.",
    )
