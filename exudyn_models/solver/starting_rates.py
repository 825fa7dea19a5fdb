"""Initial rates of first-order coordinates for implicit solvers.

Exudyn's implicit solvers start them with stored values: zero, or at a break the rate before it. The trapezoidal rule
turns this into an error of half a step times the missing rate.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import exudyn as exu
import numpy as np

from exudyn_models.solver.solver_run import quiet
from exudyn_models.solver.works import running_works


@contextmanager
def starting_rates(mbs: Any, t: float) -> Iterator[None]:
    """Start an implicit run of an assembled model with the correct first-order rates at the time t (s)."""
    data, initial = mbs.systemData, exu.ConfigurationType.Initial
    if data.ODE1Size() == 0:
        yield
        return
    before = data.GetODE1Coordinates_t(initial)
    with initialised_solver(mbs, t) as solver:
        data.SetAECoordinates(data.GetAECoordinates(initial))  # a load may be a reaction
        data.SetODE2Coordinates_tt(data.GetODE2Coordinates_tt(initial))
        renew_rates(mbs, t, solver)
    data.SetODE1Coordinates_t(data.GetODE1Coordinates_t(), initial)
    try:
        yield
    except BaseException:
        data.SetODE1Coordinates_t(before, initial)
        raise


def renew_rates(mbs: Any, t: float, solver: Any) -> None:
    """Set the first-order rates of the present state at the time t (s), which an initialised ``solver`` evaluates."""
    data, works = mbs.systemData, running_works(mbs)
    if data.ODE1Size() == 0:
        return
    solver.ComputeODE1RHS(mbs)
    rates = np.array(solver.GetSystemResidual())[data.ODE2Size() :][: data.ODE1Size()]
    if works is not None:
        rates[works.places] = works.hold(t)
    if np.isfinite(rates).all():  # otherwise the run will report it
        data.SetODE1Coordinates_t(rates)


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
