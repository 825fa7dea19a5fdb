"""Initial rates of first-order coordinates for implicit solvers, and works that these integrate.

Exudyn's implicit solvers start them with stored values: zero, or at a break the rate before it. The trapezoidal rule
turns this into an error of half a step times the missing rate.

Nothing depends on works, so ``Works`` evaluates their powers only at the ends of accepted steps, not in each of
Newton's iterations.
"""

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from typing import Any

import exudyn as exu
import numpy as np

from exudyn_models.solver.solver_run import after_every_step, quiet
from reference_model.systems import FloatArray

_WORKS = "works"


@contextmanager
def starting_rates(mbs: Any, t: float) -> Iterator[None]:
    """Start an implicit run of an assembled model with the correct first-order rates at the time t (s)."""
    data, initial = mbs.systemData, exu.ConfigurationType.Initial
    if data.ODE1Size() == 0:
        yield
        return
    before, all_works = np.array(data.GetODE1Coordinates_t(initial)), _works_of(mbs)
    for works in all_works:
        works.release()
    with initialised_solver(mbs, t) as solver:
        data.SetAECoordinates(data.GetAECoordinates(initial))  # a load may be a reaction
        solver.ComputeODE1RHS(mbs)
        rates = np.array(solver.GetSystemResidual())[data.ODE2Size() :][: data.ODE1Size()]
    if np.all(np.isfinite(rates)):  # otherwise the run will report it
        data.SetODE1Coordinates_t(rates, initial)
    for works in all_works:
        works.start(mbs, t, rates)
    try:
        yield
    except BaseException:
        data.SetODE1Coordinates_t(before, initial)
        raise
    finally:
        for works in all_works:
            works.release()


class Works:
    """Integrals of the powers that a function of ``mbs`` and time returns; ``node`` contains their coordinates."""

    node: Any = None

    def __init__(self, mbs: Any, powers: Callable[[Any, float], list[float]]) -> None:
        self._powers, self._held, self._works, self._time = powers, list[float](), np.empty(0), 0.0
        mbs.sys.setdefault(_WORKS, []).append(self)

    def rates(self, mbs: Any, t: float, item: int, works: Any) -> list[float]:
        """Return the powers, or within an implicit step those at its start (user function of the node's object)."""
        return self._held or self._powers(mbs, t)

    def _own(self, mbs: Any) -> slice:
        first = mbs.GetNodeODE1Index(self.node)
        return slice(first, first + len(mbs.GetNodeParameter(self.node, "referenceCoordinates")))

    def start(self, mbs: Any, t: float, rates: FloatArray) -> None:
        """Start implicit steps at the time t (s) with the ``rates`` of all first-order coordinates."""
        own = self._own(mbs)
        self._time, self._held = t, rates[own].tolist()
        self._works = mbs.systemData.GetODE1Coordinates(exu.ConfigurationType.Initial)[own]

    def release(self) -> None:
        """End implicit steps."""
        self._held = []

    def add_step(self, mbs: Any, t: float) -> None:
        """Integrate over the step that ends at the time t (s), by the trapezoidal rule."""
        if t <= self._time:
            return
        data, own, powers = mbs.systemData, self._own(mbs), np.array(self._powers(mbs, t))
        self._works = self._works + (t - self._time) / 2.0 * (powers + self._held)
        self._time, self._held = t, powers.tolist()
        works, rates = data.GetODE1Coordinates(), data.GetODE1Coordinates_t()
        works[own], rates[own] = self._works, powers
        data.SetODE1Coordinates(works)
        data.SetODE1Coordinates_t(rates)


def _works_of(mbs: Any) -> list[Works]:
    present = range(mbs.systemData.NumberOfNodes())
    return [
        works for works in mbs.sys.get(_WORKS, ()) if works.node is not None and int(works.node) in present
    ]


def works_at_step_ends(mbs: Any) -> AbstractContextManager[None]:
    """Integrate all works after every step of an implicit run."""
    all_works = _works_of(mbs)

    def add_step(mbs: Any, t: float) -> bool:
        for works in all_works:
            works.add_step(mbs, t)
        return True

    return after_every_step(mbs, add_step) if all_works else nullcontext()


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
