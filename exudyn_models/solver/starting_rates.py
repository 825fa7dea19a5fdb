"""The rates of coordinates of first order with which an implicit solver starts.

Exudyn's implicit solvers find the first accelerations from the forces, but start all rates of first order, those of
heat and works, with what the initial values hold: zero, or at a break the rate from before it. By the trapezoidal
rule of their first step that is an error of half the step times what is missing.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import exudyn as exu
import numpy as np

from exudyn_models.solver.solver_run import quiet
from reference_model.systems import FloatArray


@contextmanager
def starting_rates(mbs: Any, t: float) -> Iterator[None]:
    """Let an assembled model begin an implicit run at the time t (s) with the rates of first order that it has."""
    data, initial = mbs.systemData, exu.ConfigurationType.Initial
    if data.ODE1Size() == 0:
        yield
        return
    before = np.array(data.GetODE1Coordinates_t(initial))
    rates = _rates(mbs, t)
    if np.all(np.isfinite(rates)):  # else the run will tell
        data.SetODE1Coordinates_t(rates, initial)
    try:
        yield
    except BaseException:
        data.SetODE1Coordinates_t(before, initial)
        raise


def _rates(mbs: Any, t: float) -> FloatArray:
    """Return the rates at the initial values, shape (n,)."""
    with initialised_solver(mbs, t) as solver:
        solver.ComputeODE1RHS(mbs)
        first, size = mbs.systemData.ODE2Size(), mbs.systemData.ODE1Size()
        return np.array(solver.GetSystemResidual())[first : first + size]


@contextmanager
def initialised_solver(mbs: Any, t: float) -> Iterator[Any]:
    """Let an implicit solver evaluate an assembled model at its initial values and the time t (s)."""
    solver: Any = exu.MainSolverImplicitSecondOrder()
    settings = exu.SimulationSettings()
    settings.solution.file.write = settings.solution.sensors.active = False
    options = settings.timeIntegration
    options.startTime, options.endTime, options.verboseMode = t, t + max(1.0, abs(t)), 0
    options.generalizedAlpha.computeInitialAccelerations = False
    with quiet():
        solver.InitializeSolver(mbs, settings)
        yield solver
        solver.FinalizeSolver(mbs, settings)
