"""Output that contradicts itself, whatever the forces: batches, jumps at the start, and late states.

A body moves freely, because its friction and springs are negligible. Forces and drag leave these ratios at 1.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from compare.diagnosis.ladder import Ladder
from compare.diagnosis.laws import DISTINCT
from compare.diagnosis.probes import SMOOTH, discs
from compare.engines import Engine
from compare.report.numbers import error_text
from reference_model.systems import DiscOnDisc, FloatArray, PinOnDisc

TIMES = np.array([0.0, 0.0137, 0.0473, 0.0931, 0.1419])
"""Times in s that are multiples of no usual step, so a state of the nearest step shows."""

PLACE, VELOCITY, SPIN = (0.3, -0.2), (0.6, 0.8), 2.0
LEAST = 1e-3
"""Smallest deviation of a ratio that shows something; a soft contact or drag may explain less."""

MOST_DECIMALS = 7
"""Largest number of decimals that shows rounding, because the weak springs change the tenth decimal."""

FLAT, MOSTLY = 1e-6, 0.3
"""Largest bend on a straight line, over the largest bend, and the smallest share of such states that counts."""

COORDINATES = ("x", "y", "angle")
NAMES = ("velocity along x", "velocity along y", "spin")

UNITS = {
    180.0 / math.pi: "degrees",
    30.0 / math.pi: "revolutions per minute",
    0.5 / math.pi: "revolutions",
    1e3: "thousandths of the SI unit",
}
"""Factors that another unit explains."""


@dataclass(frozen=True)
class Output:
    """Ratios that are 1 in any consistent answer, one column for each coordinate, and their errors.

    The first row contains the velocities just after the start, divided by the given velocities. The other rows
    contain the distances from each of ``TIMES`` to the next, divided by the integrals of the velocity.
    """

    ratios: FloatArray  # (5, 2) for a block, (5, 3) for a disc
    errors: FloatArray
    order: tuple[int, ...] = ()  # the motion at each place of a batch, or () if it contains others
    batch: float = 0.0  # largest difference of a batch from single motions, as a share of the states
    decimals: int = 0  # of all states if the engine rounds them, or 0
    straight: float = (
        0.0  # share of the states of a vibration that lie on a straight line between their neighbours
    )


class Flaw(NamedTuple):
    """A flaw of the output in words, and whether only the spin is concerned."""

    text: str
    only_spin: bool = False


def output(engine: Engine) -> Output:
    """Return how the states of a free body contradict each other, and how a batch contradicts single motions."""
    system: PinOnDisc | DiscOnDisc = SMOOTH
    start: tuple[float, ...] = (*PLACE, *VELOCITY)
    for points in (None, 6):
        disc = replace(discs(points)[0][0], friction_force=SMOOTH.friction_force)
        if engine.simulates(disc):
            system, start = disc, (*PLACE, 0.0, *VELOCITY, SPIN)
    ladder = Ladder.of(engine, lambda tolerance: _ratios(engine, system, start, tolerance))
    # the states may belong to the nearest steps
    noise = (DISTINCT * engine.noise + (engine.step or 0.0)) / float(np.min(np.diff(TIMES)))
    order, difference = _batch(engine, system, start)
    changes = np.max(np.abs(np.diff(ladder.values[-3:], axis=0)), axis=0)
    states = engine.simulate(system, start, TIMES).states[1:]
    decimals = next(
        (n for n in range(1, MOST_DECIMALS + 1) if np.array_equal(np.round(states, n), states)), 0
    )
    straight = _straight(engine) if engine.step is None and engine.simulates(SMOOTH) else 0.0
    return Output(ladder.finest, DISTINCT * changes + noise, order, difference, decimals, straight)


def _straight(engine: Engine) -> float:
    vibrating, times = replace(SMOOTH, stiffness=400.0), 0.1 * np.linspace(0.0, 1.0, 65)
    x = engine.simulate(vibrating, (*PLACE, *VELOCITY), times).states[:, 0]
    bends = np.abs(np.diff(x, 2))
    return float(np.mean(bends < FLAT * np.max(bends)))


def _ratios(
    engine: Engine, system: PinOnDisc | DiscOnDisc, start: tuple[float, ...], tolerance: float
) -> FloatArray:
    run = engine.simulate(system, start, TIMES, tolerance=tolerance)
    half = len(start) // 2
    places, velocities = run.states[:, :half], run.states[:, half:]
    begun = velocities[1] - (velocities[2] - velocities[1]) * TIMES[1] / (TIMES[2] - TIMES[1])
    means = np.vstack((0.5 * (begun + velocities[1]), 0.5 * (velocities[1:-1] + velocities[2:])))
    ways = np.diff(places, axis=0) / (np.diff(TIMES)[:, None] * np.where(means == 0.0, 1e-300, means))
    return np.vstack((begun / np.array(start[half:]), ways))


def _batch(
    engine: Engine, system: PinOnDisc | DiscOnDisc, start: tuple[float, ...]
) -> tuple[tuple[int, ...], float]:
    if getattr(engine.function, "simulate_many", None) is None:
        return (), 0.0
    motions = [
        (replace(system, mass=float(i), friction_force=0.1 * i * i), np.multiply(i, start), TIMES)
        for i in (1, 3, 2)
    ]
    single = np.array([engine.simulate(*motion).states for motion in motions])
    many = np.array([run.states for run in engine.simulate_many(motions)])
    off = np.max(np.abs(many[:, None] - single), axis=(2, 3)) / np.max(np.abs(single))
    order = tuple(np.argmin(off, axis=1).tolist())
    alike = np.max(np.min(off, axis=1)) <= LEAST and len(set(order)) == len(order)
    return order if alike else (), float(np.max(np.diag(off)))


def flaw_of(found: Output, noise: float) -> Flaw | None:
    """Return the flaw of the output, or None; ``noise`` is the difference of equal calls."""
    if found.batch > max(LEAST, DISTINCT * noise):
        how = f"differ by {error_text(found.batch)} of their size from the same motions one by one"
        other = "a batch returns its motions in another order than asked"
        return Flaw(other if found.order else f"motions of a batch {how}")
    if found.decimals:
        return Flaw(f"states are rounded to {found.decimals} decimals")
    ratios = found.ratios
    off = np.abs(ratios - 1.0) > np.maximum(LEAST, DISTINCT * found.errors) + DISTINCT * noise / TIMES[1]
    columns = np.flatnonzero(np.any(off, axis=0)).tolist()
    if not columns:
        straight = "states lie on straight lines between times of the engine, at any tolerance"
        return Flaw(straight) if found.straight > MOSTLY else None
    text = _jump(ratios[0], np.flatnonzero(off[0]).tolist()) or _way(ratios[1:, columns], columns)
    return Flaw(text, columns == [2])


def _jump(ratios: FloatArray, columns: Sequence[int]) -> str:
    if not columns:
        return ""
    found = [f"{ratios[column]:.4g} times the given {NAMES[column]}" for column in columns]
    unit = next(
        (unit for factor, unit in UNITS.items() if abs(ratios[columns[0]] / factor - 1.0) < LEAST), ""
    )
    could = f", as if the output were in {unit}" if unit else ""
    return f"right after the start, the output contains {' and '.join(found)}{could}"


def _way(ratios: FloatArray, columns: Sequence[int]) -> str:
    names = " and ".join(COORDINATES[column] for column in columns)
    first, later, factor = ratios[0], ratios[1:], float(np.mean(ratios[1:]))
    if np.ptp(later) > LEAST:
        ends = f"{np.min(ratios):.4g} to {np.max(ratios):.4g}"
        because = "as if states belonged to other times than asked"
    elif abs(factor - 1.0) > LEAST:
        ends = f"{factor:.4g}"
        because = "so the positions, the velocities or the times have another unit or other axes"
    elif len(columns) > 1 and np.ptp(first) < LEAST:
        late = (1.0 - float(first[0])) * float(TIMES[1])
        when = "late" if late > 0.0 else "early"
        return f"the states of a free body are returned {error_text(1e3 * abs(late))} ms {when}"
    else:
        return f"right after the start, a free body is at another {names} than its velocity explains"
    return f"a free body moves by {ends} times the integral of its velocity along {names}, {because}"
