"""The pieces of work of a sweep, as functions that another process or machine can import."""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.run.provenance import stamp
from compare.sweep.arrays import Chunks
from compare.sweep.plan import Numbers, Plan
from compare.sweep.quantities import RESULTS
from reference_model import simulate
from reference_model.ensemble import EndState
from reference_model.systems import COLUMNS, FloatArray, System
from reference_model.trajectory import SimulationError, Trajectory

DOUBLINGS = 3
"""How often the plain reference simulates for twice as long where it has not found the end yet."""


class OtherCodeError(RuntimeError):
    """Workers have another version of the code than who made the store; the message says so."""


@dataclass(frozen=True, eq=False)
class Plain:
    """A trajectory of the plain reference: its state at a time that was asked for, and what it ends as.

    NaN and undecided where it gave up at once.
    """

    state: FloatArray
    end: int


def simulate_chunk(
    chunks: Chunks, chunk: int, plan: Plan, numbers: Numbers, threads: int | None, made_by: str
) -> int:
    """Simulate the trajectories of a chunk and write what they come to; return how many there are.

    Raises :class:`OtherCodeError`, and writes nothing, where the code is not that of the stamp ``made_by``.
    """
    if stamp() != made_by:
        raise OtherCodeError("a worker has other code or libraries than this process")
    chunks.write(chunk, compute(plan, numbers, threads))
    return len(numbers)


def compute(plan: Plan, numbers: Numbers, threads: int | None) -> dict[str, NDArray[Any]]:
    """Simulate the trajectories of these numbers on ``threads`` threads, None for all cores.

    Returns arrays of length n by the names of ``RESULTS``.
    """
    from reference_model.ensemble import simulate_ensemble  # the one place where sweeps meet the kernel

    states, parameters = plan.trajectories(numbers)
    found = simulate_ensemble(
        plan.system,
        states,
        duration=plan.duration,
        tolerance=plan.tolerance,
        parameters=parameters,
        threads=threads,
    )
    return {name: np.asarray(getattr(found, name)) for name in RESULTS}


def recompute(plan: Plan, number: int, time: float, end: int) -> Plain:
    """Simulate one trajectory with the plain reference; ``time`` (s) is when its state is asked for.

    It is watched for as long again as the kernel took to be certain of ``end``. Where it does not end like this, it
    is simulated for longer and longer before that counts: what shall be certain from the motion alone takes more
    time than a kernel may need that knows where motions end. What is undecided is simulated up to ``time`` only.
    """
    states, parameters = plan.trajectories(range(number, number + 1))
    changes: dict[str, Any] = {name: float(values[0]) for name, values in parameters.items()}
    system = replace(plan.system, **changes)
    until = time if end == EndState.UNDECIDED else watched_until(system, time, plan.duration)
    state = np.full(system.state_size, np.nan)
    found = EndState.UNDECIDED
    with suppress(SimulationError):
        trajectory = plain_trajectory(system, states[0], time, until, plan.tolerance)
        state = trajectory.states[np.searchsorted(trajectory.times, time)]
        found = end_of(trajectory)
        for _ in range(DOUBLINGS):
            if end in (found, EndState.UNDECIDED):
                break
            trajectory = twice_as_long(trajectory)
            found = end_of(trajectory)
    return Plain(state, int(found))


# --- What a trajectory of the plain reference ends as: the judge of a sweep's random sample.

WATCHED = 0.5
"""Part of a trajectory, before its end, by which it is judged."""

SAMPLES_PER_TURN = 64
"""Of what is watched; of what was before, which only tells how far the motion went, ``SAMPLES_BEFORE``."""

SAMPLES_BEFORE = 4

AT_REST = 0.02
"""Largest distance from the last place, in units of that of the whole motion, at which the centre is at rest."""

STEADY = 0.01
"""Spread (largest − smallest)/(largest + smallest) of the radius, turn after turn, up to which a motion is steady."""

SAME = 1.4
"""Ratio of the spreads in both halves of what is watched, up to which a modulation neither grows nor decays."""

DYING = 0.1
"""Ratio of the slip speeds in both halves of what is watched, below which slip dies out: a whirl's stays as it is."""

LEAST_TURNS = 24
"""After which the second half of a motion is watched, at the earliest."""


def plain_trajectory(
    system: System, state: FloatArray, time: float, duration: float, tolerance: float
) -> Trajectory:
    """Return the motion from 0 to ``duration`` (s) by the plain reference, at times of which ``time`` (s) is one."""
    since = (1.0 - WATCHED) * duration
    before = _samples(system, 0.0, since, SAMPLES_BEFORE)
    watched = _samples(system, since, duration, SAMPLES_PER_TURN)
    times = np.unique(np.concatenate((before, watched, [time])))
    return simulate(system, state, times, tolerance=tolerance)


def twice_as_long(trajectory: Trajectory) -> Trajectory:
    """Return the motion for twice its duration, simulated on from its last state."""
    times, last, solution = trajectory.times, float(trajectory.times[-1]), trajectory.solution
    later = _samples(trajectory.system, last, 2.0 * last - float(times[0]), SAMPLES_PER_TURN)
    more = simulate(trajectory.system, trajectory.at_end, later, tolerance=solution.tolerance)
    return replace(
        trajectory,
        times=np.concatenate((times, later[1:])),
        states=np.concatenate((trajectory.states, more.states[1:])),
        phases=trajectory.phases + more.phases,
        solution=replace(
            solution,
            evaluations=solution.evaluations + more.solution.evaluations,
            steps=solution.steps + more.solution.steps,
            wall_time=solution.wall_time + more.solution.wall_time,
        ),
    )


def watched_until(system: System, certain: float, duration: float) -> float:
    """Return until when (s) to simulate a motion whose end another knew at ``certain`` (s): for as long again."""
    return max(certain, LEAST_TURNS * _turn(system, duration)) / WATCHED


def _samples(system: System, first: float, last: float, per_turn: int) -> FloatArray:
    """Return times in s from ``first`` to ``last``."""
    return np.linspace(first, last, math.ceil((last - first) / _turn(system, last) * per_turn) + 2)


def _turn(system: System, duration: float) -> float:
    """Return the time of a turn in s, of which something that never turns has one in ``duration``."""
    return 2.0 * math.pi / max(system.natural_frequency, abs(system.disc_speed), 1.0 / duration)


def end_of(trajectory: Trajectory) -> EndState:
    """Return what a trajectory ends as, UNDECIDED where its second half leaves a doubt.

    - *Stuck*: the last stick phase has lasted for a whole turn of the master disc: it sees no force that it has not
      seen; or the contact slips all the time, but ever more slowly. *Stick–slip*: there are shorter stick phases, and
      they begin at the same radius again and again.
    - *Self-centred*: the centre hardly moves in the last quarter.
    - *Whirl*, *modulated*: the motion goes round the axis, and where it passes the positive x-axis (once a turn, so
      that an offset does not matter) the radius is the same, or not, in both halves alike.
    """
    system, times = trajectory.system, trajectory.times
    since, middle = (times[-1] - part * (times[-1] - times[0]) for part in (WATCHED, 0.5 * WATCHED))
    sticks = [phase for phase in trajectory.stick_phases if phase.end > since]
    if sticks:
        last = sticks[-1]
        turned = (last.end - last.start) * abs(system.disc_speed)
        if last.end == times[-1] and (turned >= 2.0 * math.pi or system.disc_speed == 0.0):
            return EndState.STUCK
        spreads = _spreads(
            np.array([phase.start for phase in sticks]),
            np.array([math.hypot(*phase.initial_state[:2]) for phase in sticks]),
            middle,
        )
        return EndState.STICK_SLIP if max(spreads) <= STEADY else EndState.UNDECIDED
    if _at_rest(trajectory, middle):
        return EndState.SELF_CENTRED
    if _slip_dies_out(trajectory, since, middle):
        return EndState.STUCK
    before, after = _spreads(*_passages(trajectory, since), middle)
    if max(before, after) <= STEADY:
        return EndState.WHIRL
    if math.isfinite(before + after) and max(before, after) <= SAME * min(before, after):
        return EndState.MODULATED
    return EndState.UNDECIDED


def _at_rest(trajectory: Trajectory, since: float) -> bool:
    """Return whether the centre hardly moves from ``since`` (s) on, beside all its motion."""
    x, y = trajectory.states.T[:2]
    distance = np.hypot(x - x[-1], y - y[-1])
    last = trajectory.times >= since
    return bool(np.max(distance[last]) <= AT_REST * np.max(distance))


def _slip_dies_out(trajectory: Trajectory, since: float, middle: float) -> bool:
    """Return whether the slip after ``middle`` (s) is below ``DYING`` of that before, or below its error."""
    slip, times = trajectory.slip_speed, trajectory.times
    before, after = np.max(slip[(times >= since) & (times < middle)]), np.max(slip[times >= middle])
    error = trajectory.solution.tolerance * abs(trajectory.system.disc_speed) * np.max(trajectory.radius)
    return bool(after <= max(DYING * before, error))


def _passages(trajectory: Trajectory, since: float) -> tuple[FloatArray, FloatArray]:
    """Return times in s and radii in m of the passages of the positive x-axis in the sense of the master disc."""
    velocities = COLUMNS[type(trajectory.system)].index(("vx", "m/s"))
    x, y = trajectory.states.T[:2]
    vx, vy = trajectory.states.T[velocities : velocities + 2]
    y, vy = (math.copysign(1.0, trajectory.system.disc_speed) * values for values in (y, vy))
    at = np.flatnonzero((y[:-1] < 0.0) & (y[1:] >= 0.0) & (trajectory.times[:-1] >= since))
    step = trajectory.times[at + 1] - trajectory.times[at]
    # the zero of the cubic through y and its slope at both ends by two steps of Newton's method
    share = y[at] / (y[at] - y[at + 1])
    for _ in range(2):
        value, slope = _cubic(y, vy, at, step, share)
        share = share - value / slope
    radius, _ = _cubic(x, vx, at, step, share)
    ahead = radius > 0.0
    return (trajectory.times[at] + share * step)[ahead], radius[ahead]


def _cubic(
    values: FloatArray, slopes: FloatArray, at: Any, step: FloatArray, share: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return Hermite's cubic between samples ``at`` and ``at`` + 1, and its derivative by ``share`` of the step."""
    low, high = values[at], values[at + 1]
    left, right = slopes[at] * step, slopes[at + 1] * step
    second, third = 3.0 * (high - low) - 2.0 * left - right, 2.0 * (low - high) + left + right
    value = low + share * (left + share * (second + share * third))
    return value, left + share * (2.0 * second + 3.0 * share * third)


def _spreads(times: FloatArray, radii: FloatArray, middle: float) -> tuple[float, float]:
    """Return (largest − smallest)/(largest + smallest) of radii before and after ``middle``, inf for a single one."""
    spreads = []
    for chosen in (radii[times < middle], radii[times >= middle]):
        low, high = (float(np.min(chosen)), float(np.max(chosen))) if chosen.size > 1 else (0.0, math.inf)
        spreads.append((high - low) / (high + low) if math.isfinite(high) else math.inf)
    return spreads[0], spreads[1]
