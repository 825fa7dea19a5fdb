"""Tasks of a sweep, as functions that other processes and machines can import."""

import math
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.run.provenance import stamp
from compare.sweep.arrays import Group
from compare.sweep.plan import Numbers, Plan
from compare.sweep.quantities import RESULTS
from reference_model import simulate
from reference_model.ensemble import EndState
from reference_model.systems import FloatArray, System
from reference_model.trajectory import SimulationError, Trajectory

DOUBLINGS = 3  # largest number of times that the plain reference doubles its duration


class OtherCodeError(RuntimeError):
    """A worker has a different version of the code."""


@dataclass(frozen=True, eq=False)
class Plain:
    """A trajectory of the plain reference: its state at a requested time (NaN if it failed), and its end."""

    state: FloatArray
    end: int


def simulate_chunk(
    group: Group, where: slice, plan: Plan, numbers: Numbers, threads: int | None, made_by: str
) -> int:
    """Simulate the trajectories of a chunk, write their results to ``where`` and return their number.

    Raises :class:`OtherCodeError`, before anything is written, if the code does not match the stamp ``made_by``.
    """
    if stamp() != made_by:
        raise OtherCodeError("a worker uses a different version of the code or libraries")
    values = compute(plan, numbers, threads)
    group.write(values, {"trajectory": where})
    group.seal_chunk(where, values)
    return len(numbers)


def compute(plan: Plan, numbers: Numbers, threads: int | None) -> dict[str, NDArray[Any]]:
    """Simulate trajectories on ``threads`` threads (None: all cores); return the arrays ``RESULTS``."""
    from reference_model.ensemble import simulate_ensemble

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
    """Simulate one trajectory with the plain reference; its state is returned at ``time`` (s).

    The simulation lasts twice as long as the kernel needed to be certain of ``end``. If it ends differently, the
    duration is doubled up to ``DOUBLINGS`` times, because the kernel sees the end earlier. An undecided trajectory
    ends at ``time``.
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


# --- Ends of trajectories of the plain reference, for the check of a sweep's random sample

WATCHED = 0.5  # share of a trajectory that decides the end state

SAMPLES_PER_TURN = 64
"""Samples per turn in the last part; earlier samples only give the extent of the motion."""

SAMPLES_BEFORE = 4
AT_REST = 0.02  # largest distance of a resting centre from its last position, relative to the motion

STEADY = 0.01
"""Largest spread (largest − smallest)/(largest + smallest) of the radii of a steady motion at successive turns."""

SAME = 1.4  # largest ratio of the spreads of a constant modulation

DYING = 0.1
"""Ratio of the slip speeds in both halves of the last part below which slip dies out."""

LEAST_TURNS = 24  # smallest number of turns before the last part of a motion


def plain_trajectory(
    system: System, state: FloatArray, time: float, duration: float, tolerance: float
) -> Trajectory:
    """Return the motion of the plain reference to ``duration`` (s), at times that include ``time`` (s)."""
    since = (1.0 - WATCHED) * duration
    before = _samples(system, 0.0, since, SAMPLES_BEFORE)
    watched = _samples(system, since, duration, SAMPLES_PER_TURN)
    times = np.unique(np.concatenate((before, watched, [time])))
    return simulate(system, state, times, tolerance=tolerance)


def twice_as_long(trajectory: Trajectory) -> Trajectory:
    """Return the motion for twice its duration."""
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
    """Return the duration of a check in s: twice ``certain`` (s) or ``LEAST_TURNS`` turns, whichever is longer."""
    return max(certain, LEAST_TURNS * _turn(system, duration)) / WATCHED


def _samples(system: System, first: float, last: float, per_turn: int) -> FloatArray:
    turns = (last - first) / _turn(system, last) if last > first else 0.0
    return np.linspace(first, last, math.ceil(turns * per_turn) + 2)


def _turn(system: System, duration: float) -> float:
    rates = system.natural_frequency, abs(system.disc_speed)
    return 2.0 * math.pi * min(duration, *(1.0 / rate for rate in rates if rate > 0.0), math.inf)


def end_of(trajectory: Trajectory) -> EndState:
    """Return the end of a trajectory, UNDECIDED if its second half is ambiguous.

    - *Stuck*: the last stick phase lasts a whole turn of the master disc, so no new force can release it; or the
      contact slips ever more slowly. *Stick–slip*: shorter stick phases repeatedly begin at the same radius.
    - *Self-centred*: the centre hardly moves in the last quarter.
    - *Whirl*, *modulated*: the motion encircles the axis. Its radius at the positive x-axis is constant, or varies
      equally in both halves.
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
    x, y = trajectory.states.T[:2]
    distance = np.hypot(x - x[-1], y - y[-1])
    last = trajectory.times >= since
    return bool(np.max(distance[last]) <= AT_REST * np.max(distance))


def _slip_dies_out(trajectory: Trajectory, since: float, middle: float) -> bool:
    slip, times = trajectory.slip_speed, trajectory.times
    before, after = np.max(slip[(times >= since) & (times < middle)]), np.max(slip[times >= middle])
    error = trajectory.solution.tolerance * abs(trajectory.system.disc_speed) * np.max(trajectory.radius)
    return bool(after <= max(DYING * before, error))


def _passages(trajectory: Trajectory, since: float) -> tuple[FloatArray, FloatArray]:
    """Return interpolated times and radii of crossings of the positive x-axis in the disc's direction."""
    x, y = trajectory.states.T[:2]
    y = math.copysign(1.0, trajectory.system.disc_speed) * y
    at = np.flatnonzero((y[:-1] < 0.0) & (y[1:] >= 0.0) & (x[1:] > 0.0) & (trajectory.times[:-1] >= since))
    share = y[at] / (y[at] - y[at + 1])
    times, radii = (
        (1.0 - share) * values[at] + share * values[at + 1] for values in (trajectory.times, np.hypot(x, y))
    )
    return times, radii


def _spreads(times: FloatArray, radii: FloatArray, middle: float) -> tuple[float, float]:
    """Return (largest − smallest)/(largest + smallest) of radii before and after ``middle``."""
    spreads = []
    for chosen in (radii[times < middle], radii[times >= middle]):
        low, high = (float(np.min(chosen)), float(np.max(chosen))) if chosen.size > 1 else (0.0, math.inf)
        spreads.append((high - low) / (high + low) if math.isfinite(high) else math.inf)
    return spreads[0], spreads[1]
