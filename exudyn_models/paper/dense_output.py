"""States between the steps of a solver."""

from collections.abc import Callable

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from exudyn_models.solver.solver_run import Steps
from reference_model.systems import FloatArray


def creep_between(steps: Steps) -> Callable[[FloatArray], FloatArray]:
    """Return a function that gives the states of a creeping body at times (s), shape (len(times), 2d).

    Velocities are cubic Hermite interpolants, because rounding of positions would spoil the creep in short steps.
    """
    velocities = _velocities(steps)

    def states(times: FloatArray) -> FloatArray:
        positions, _ = np.split(states_at(steps, times), 2, axis=1)
        return np.hstack((positions, velocities(times)))

    return states


def creep_until(steps: Steps, time: float) -> Steps:
    """Return ``steps`` of a creeping body up to ``time`` (s)."""
    before = int(np.searchsorted(steps.times, time))
    return Steps(
        np.append(steps.times[:before], time),
        np.vstack((steps.states[:before], creep_between(steps)(np.array([time])))),
        np.vstack((steps.accelerations[:before], _velocities(steps)(time, 1))),
        steps.evaluations,
    )


def _velocities(steps: Steps) -> CubicHermiteSpline:
    return CubicHermiteSpline(
        steps.times, steps.states[:, steps.accelerations.shape[1] :], steps.accelerations
    )


def states_at(steps: Steps, times: FloatArray) -> FloatArray:
    """Return the states at ``times`` (s), shape (len(times), 2d).

    Between two steps each coordinate is the quintic polynomial with the positions, velocities and accelerations of
    both ends. Its error is h⁶/46080 times the sixth derivative, below the error of the step.
    """
    index = np.clip(np.searchsorted(steps.times, times, side="right") - 1, 0, max(len(steps.times) - 2, 0))
    after = np.minimum(index + 1, len(steps.times) - 1)
    h = (steps.times[after] - steps.times[index])[:, None]
    h = np.where(h > 0.0, h, 1.0)
    s = (times - steps.times[index])[:, None] / h
    size = steps.accelerations.shape[1]
    p0, p1 = steps.states[index, :size], steps.states[after, :size]
    v0, v1 = h * steps.states[index, size:], h * steps.states[after, size:]
    a0, a1 = h * h * steps.accelerations[index], h * h * steps.accelerations[after]
    dp = p1 - p0 - v0 - a0 / 2.0
    dv = v1 - v0 - a0
    da = a1 - a0
    c3 = 10.0 * dp - 4.0 * dv + da / 2.0
    c4 = -15.0 * dp + 7.0 * dv - da
    c5 = 6.0 * dp - 3.0 * dv + da / 2.0
    position = p0 + s * (v0 + s * (a0 / 2.0 + s * (c3 + s * (c4 + s * c5))))
    velocity = (v0 + s * (a0 + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)))) / h
    return np.where(s == 1.0, steps.states[after], np.hstack((position, velocity)))
