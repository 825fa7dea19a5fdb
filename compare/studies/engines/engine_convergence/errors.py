"""Errors of simulations, and the work they take."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np

from compare.claims.paper_parameters import FIG5, FIG5_STARTS
from compare.studies.engines.engine_convergence.parameters import (
    SLIDING_STARTS,
    SLIDING_TIMES,
    STICK_SLIP_TIMES,
)
from compare.studies.engines.engine_convergence.theory import (
    root_mean_square,
    sliding_truth,
    stick_slip_truth,
)
from reference_model import Trajectory
from reference_model.systems import FloatArray

Simulate = Callable[..., Trajectory]


def of_sliding(run: Simulate, **how: Any) -> tuple[float, float, float]:
    """Simulate the sliding pins; return their error (m, m/s), evaluations, and processor time in s."""
    began = time.process_time()  # unlike wall time it does not count what other studies do on the same cores
    trajectories = [run(FIG5, start, SLIDING_TIMES, **how) for start in SLIDING_STARTS]
    spent = time.process_time() - began
    truth, _ = sliding_truth()
    error = root_mean_square(np.array([trajectory.states for trajectory in trajectories]) - truth)
    return error, sum(trajectory.solution.evaluations for trajectory in trajectories), spent


def of_stick_slip(run: Simulate, **how: Any) -> tuple[float, float, float]:
    """Simulate Fig. 5's way to the whirl; return the error (m, m/s), evaluations, and processor time in s."""
    began = time.process_time()
    trajectory = run(FIG5, FIG5_STARTS["whirl"], STICK_SLIP_TIMES, **how)
    spent = time.process_time() - began
    error = root_mean_square(trajectory.states - stick_slip_truth())
    return error, trajectory.solution.evaluations, spent


def gap(found: FloatArray, exact: FloatArray) -> FloatArray:
    """Return how far the events found are off; without numbers where there are too many or too few of them."""
    return np.abs(found - exact) if found.shape == exact.shape else np.full(exact.shape, np.nan)
