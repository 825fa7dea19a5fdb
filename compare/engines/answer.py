"""What an engine returns, looked at before a study sees it."""

from __future__ import annotations

import reprlib
from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike

from reference_model.systems import System
from reference_model.trajectory import Trajectory

TIME_ROUNDING = 1e-12
"""Relative: times of the same grid that were added up in another order agree to this."""


class BadTrajectoryError(RuntimeError):
    """An engine returned what is no answer to the question; the message says why."""


def checked(trajectory: object, system: System, times: ArrayLike) -> Trajectory:
    """Return ``trajectory`` if it is one of ``system`` at ``times`` (n,); raise ``BadTrajectoryError`` otherwise."""
    if not isinstance(trajectory, Trajectory):
        raise TypeError(f"simulate() returned {reprlib.repr(trajectory)}: it must be a Trajectory")
    asked, got = np.asarray(times, dtype=float), np.asarray(trajectory.times)
    if got.shape != asked.shape:
        raise BadTrajectoryError(
            f"the trajectory's times have shape {got.shape}: {asked.shape} were asked for"
        )
    strange = ~(np.abs(got - asked) <= TIME_ROUNDING * np.max(np.abs(asked)))  # also true for NaN
    if np.any(strange):
        i = int(np.argmax(strange))
        raise BadTrajectoryError(
            f"the trajectory's times[{i}] = {float(got[i])!r} s: {float(asked[i])!r} s was asked for"
        )
    states, shape = np.asarray(trajectory.states), (len(asked), system.state_size)
    if states.shape != shape:
        raise BadTrajectoryError(f"the trajectory's states have shape {states.shape}: they must have {shape}")
    broken = ~np.all(np.isfinite(states), axis=1)
    if np.any(broken):
        i = int(np.argmax(broken))
        raise BadTrajectoryError(f"the state at t = {asked[i]:g} s is not finite: {states[i].tolist()}")
    return trajectory


def as_many_as(answers: object, asked: int) -> list[object]:
    """Return the ``answers`` of ``simulate_many`` if they are so many; raise ``BadTrajectoryError`` otherwise."""
    if isinstance(answers, Trajectory) or not isinstance(answers, Iterable):
        raise TypeError(
            f"simulate_many() returned {reprlib.repr(answers)}: it must be a list of trajectories"
        )
    found = list(answers)
    if len(found) != asked:
        raise BadTrajectoryError(
            f"simulate_many() returned {len(found)} trajectories: {asked} were asked for"
        )
    return found
