"""Checks of the trajectories that an engine returns, before a study sees them."""

import reprlib
from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import ArrayLike

from reference_model.systems import FloatArray
from reference_model.systems.joint import AnySystem
from reference_model.trajectory import Phase, Trajectory

PHASES = ("slip", "pivot", "stick")

TIME_ROUNDING = 1e-12
"""Largest relative rounding error of times."""

REAL = "fiu"


class BadTrajectoryError(RuntimeError):
    """An engine returned an invalid trajectory; the message says why."""


def checked(trajectory: object, system: AnySystem, times: ArrayLike) -> Trajectory:
    """Return ``trajectory`` with arrays of its own if it is valid for ``system`` at ``times`` (n,).

    Raises ``TypeError`` if it is not a trajectory, and ``BadTrajectoryError`` if it is invalid.
    """
    if not isinstance(trajectory, Trajectory):
        raise TypeError(f"simulate() returned {reprlib.repr(trajectory)}: it must be a Trajectory")
    asked, got = np.asarray(times, dtype=float), np.asarray(trajectory.times)
    states, shape = np.asarray(trajectory.states), (len(asked), system.state_size)
    for name, array in (("times", got), ("states", states)):
        if array.dtype.kind not in REAL:
            raise BadTrajectoryError(
                f"the trajectory's {name} have the type {array.dtype}: they must be real numbers"
            )
    if got.shape != asked.shape:
        raise BadTrajectoryError(f"the trajectory's times have shape {got.shape}: expected {asked.shape}")
    strange = ~(np.abs(got - asked) <= TIME_ROUNDING * np.max(np.abs(asked)))  # also true for NaN
    if np.any(strange):
        i = int(np.argmax(strange))
        raise BadTrajectoryError(
            f"the trajectory's times[{i}] = {float(got[i])!r} s: expected {float(asked[i])!r} s"
        )
    if states.shape != shape:
        raise BadTrajectoryError(f"the trajectory's states have shape {states.shape}: expected {shape}")
    broken = ~np.all(np.isfinite(states), axis=1)
    if np.any(broken):
        i = int(np.argmax(broken))
        raise BadTrajectoryError(f"the state at t = {asked[i]:g} s is not finite: {states[i].tolist()}")
    _check_phases(trajectory.phases, asked, system.state_size)
    # an engine may return integers, or fill the same array in its next call
    own = np.array(got, dtype=float), np.array(states, dtype=float)
    return Trajectory(trajectory.system, *own, tuple(trajectory.phases), trajectory.solution)


def _check_phases(phases: Sequence[object], times: FloatArray, components: int) -> None:
    slack = TIME_ROUNDING * np.max(np.abs(times))
    earliest, latest = times[0] - slack, times[-1] + slack
    for i, phase in enumerate(phases):
        if not isinstance(phase, Phase) or phase.kind not in PHASES:
            shown = reprlib.repr(getattr(phase, "kind", phase))
            raise BadTrajectoryError(f"phases[{i}] is {shown}: it must be a Phase of a kind in {PHASES}")
        if not (_is_real(phase.initial_state, (components,)) and _is_real([phase.start, phase.end], (2,))):
            raise BadTrajectoryError(
                f"phases[{i}] must have finite times and {components} finite numbers as its initial_state"
            )
        if not earliest <= phase.start <= phase.end <= latest:
            raise BadTrajectoryError(
                f"phases[{i}] lasts from {phase.start:g} to {phase.end:g} s: phases must follow each other between "
                f"{times[0]:g} and {times[-1]:g} s"
            )
        earliest = phase.end - slack


def _is_real(value: object, shape: tuple[int, ...]) -> bool:
    array = np.asarray(value)
    return array.dtype.kind in REAL and array.shape == shape and bool(np.isfinite(array).all())


def as_many_as(answers: object, asked: int) -> list[object]:
    """Return ``answers`` as a list; raise ``BadTrajectoryError`` unless there are ``asked``."""
    if isinstance(answers, Trajectory) or not isinstance(answers, Iterable):
        raise TypeError(
            f"simulate_many() returned {reprlib.repr(answers)}: it must be a list of trajectories"
        )
    found = list(answers)
    if len(found) != asked:
        raise BadTrajectoryError(f"simulate_many() returned {len(found)} trajectories: expected {asked}")
    return found
