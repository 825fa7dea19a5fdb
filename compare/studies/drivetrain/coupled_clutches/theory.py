"""The exact motion, and the published one."""

from __future__ import annotations

import csv
import functools
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from compare.studies.drivetrain.coupled_clutches.parameters import (
    COEFFICIENT,
    ENGAGED_FROM,
    FREQUENCY,
    INERTIAS,
    LOAD,
    OPEN_FROM,
    OPENS,
    RADIUS,
    SPEED,
    STATIC_RATIO,
    TORQUE,
    UNTIL,
)
from compare.studies.toolkit.torsional_chain import Chain, Harmonic, Motion
from reference_model.systems import FloatArray

PUBLISHED = Path(__file__).with_name("published.csv")

NOTHING = Harmonic()


def chain() -> Chain:
    """Return the rotors with their clutches."""
    capacity = RADIUS * COEFFICIENT * LOAD
    falling = Harmonic(capacity, 2.0 * math.pi * OPENS)
    drive = Harmonic(TORQUE, 2.0 * math.pi * FREQUENCY, 0.0)
    return Chain(
        INERTIAS,
        torques=[((0.0, drive),), *[((0.0, NOTHING),)] * 3],
        capacities=[
            ((0.0, falling), (OPEN_FROM, NOTHING)),
            *(((0.0, NOTHING), (begin, Harmonic(capacity))) for begin in ENGAGED_FROM),
        ],
        static_ratio=STATIC_RATIO,
    )


@functools.cache
def exact() -> Motion:
    """Return the exact motion."""
    return chain().motion([SPEED, 0.0, 0.0, 0.0], UNTIL)


@functools.cache
def switches() -> list[tuple[float, int, int]]:
    """Return time in s, clutch and new mode where a clutch begins to hold, or lets go, by friction alone."""
    found = [
        (time, clutch, mode)
        for clutch in range(len(INERTIAS) - 1)
        for time, mode in exact().switches(clutch)
        if time not in exact().chain.breaks
    ]
    return sorted(found)


@dataclass(frozen=True)
class Published:
    """The published times in s, speeds in rad/s and angles in rad of the first rotor and of each slip, and modes."""

    times: FloatArray
    speeds: FloatArray
    angles: FloatArray
    modes: NDArray[np.int_]


@functools.cache
def published() -> Published:
    """Return every tenth row of the published result, and those beside its events.

    Source: Modelica Association, MAP-LIB_ReferenceResults, Modelica.Mechanics.Rotational.Examples.CoupledClutches,
    Dymola 2020x, DASSL at a tolerance of 1e-6.
    """
    with PUBLISHED.open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    clutches = range(1, len(INERTIAS))

    def columns(*names: str) -> FloatArray:
        return np.array([[float(row[name]) for name in names] for row in rows])

    return Published(
        columns("time")[:, 0],
        columns("J1.w", *(f"clutch{i}.w_rel" for i in clutches)),
        columns("J1.phi", *(f"clutch{i}.phi_rel" for i in clutches)),
        columns(*(f"clutch{i}.mode" for i in clutches)).astype(int),
    )


def first_and_slips(values: FloatArray) -> FloatArray:
    """Return the first rotor's and the differences of neighbours from what each rotor has, both of shape (n, 4)."""
    return np.column_stack((values[:, 0], np.diff(values, axis=1)))
