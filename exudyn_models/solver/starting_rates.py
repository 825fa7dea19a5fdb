"""Initial rates of first-order coordinates for implicit solvers, and works that these integrate.

Exudyn's implicit solvers start them with stored values: zero, or at a break the rate before it. The trapezoidal rule
turns this into an error of half a step times the missing rate.

``Works`` evaluates their powers once at the ends of accepted steps, not in each of Newton's iterations. A load that
depends on a work sees its extrapolation within a step, which is of second order.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from functools import partial
from typing import Any

import exudyn as exu
import numpy as np

from exudyn_models.solver.checks.jumps import watch_powers
from exudyn_models.solver.items import add_integrals
from exudyn_models.solver.solver_run import after_every_step, quiet

_WORKS = "works"


@contextmanager
def starting_rates(mbs: Any, t: float) -> Iterator[None]:
    """Start an implicit run of an assembled model with the correct first-order rates at the time t (s)."""
    data, initial = mbs.systemData, exu.ConfigurationType.Initial
    if data.ODE1Size() == 0:
        yield
        return
    before = np.array(data.GetODE1Coordinates_t(initial))
    with initialised_solver(mbs, t) as solver:
        data.SetAECoordinates(data.GetAECoordinates(initial))  # a load may be a reaction
        renew_rates(mbs, solver)
    data.SetODE1Coordinates_t(data.GetODE1Coordinates_t(), initial)
    try:
        yield
    except BaseException:
        data.SetODE1Coordinates_t(before, initial)
        raise
    finally:
        for works in _works_of(mbs):
            works.held = []


def renew_rates(mbs: Any, solver: Any) -> None:
    """Set the first-order rates of the present state, which an initialised ``solver`` evaluates."""
    data = mbs.systemData
    if data.ODE1Size() == 0:
        return
    all_works = _works_of(mbs)
    for works in all_works:
        works.held = []
    solver.ComputeODE1RHS(mbs)
    rates = np.array(solver.GetSystemResidual())[data.ODE2Size() :][: data.ODE1Size()]
    if np.all(np.isfinite(rates)):  # otherwise the run will report it
        data.SetODE1Coordinates_t(rates)
    for works in all_works:
        works.held = rates[works.own(mbs)].tolist()


Power = Callable[[Any, float], float]
"""Function of ``mbs`` and time (s) that returns a power in W of the current motion."""


class Works:
    """Integrals of powers, in ``unit`` J; ``node`` contains their coordinates."""

    node: Any = None

    def __init__(self, mbs: Any, powers: Sequence[Power], unit: float) -> None:
        self.powers, self.unit = powers, unit
        #: Powers at the start of an implicit step, in units of the coordinates.
        self.held = list[float]()
        mbs.sys.setdefault(_WORKS, []).append(self)

    def rates(self, mbs: Any, t: float, item: int, works: Any) -> list[float]:
        """Return the powers, or within an implicit step those at its start (user function of the node's object)."""
        return self.held or [power(mbs, t) / self.unit for power in self.powers]

    def own(self, mbs: Any) -> slice:
        """Return the places of the coordinates."""
        first = mbs.GetNodeODE1Index(self.node)
        return slice(first, first + len(self.powers))


def add_works(mbs: Any, powers: Mapping[str, Power], unit: float = 1.0) -> Any:
    """Add the integrals of powers to a model; return the ``NodeIndex`` of their coordinates, in ``unit`` J."""
    works = Works(mbs, list(powers.values()), unit)
    rates = partial(works.rates)  # takes attributes, unlike a method
    watch_powers(rates, list(powers), unit)
    works.node = add_integrals(mbs, rates, [0.0] * len(powers))
    return works.node


def _works_of(mbs: Any) -> list[Works]:
    present = range(mbs.systemData.NumberOfNodes())
    return [
        works for works in mbs.sys.get(_WORKS, ()) if works.node is not None and int(works.node) in present
    ]


def works_at_step_ends(mbs: Any) -> AbstractContextManager[None]:
    """Integrate all works by the trapezoidal rule after every step of an implicit run."""
    all_works = _works_of(mbs)

    distinct = list(dict.fromkeys(power for works in all_works for power in works.powers))
    which = np.array([distinct.index(power) for works in all_works for power in works.powers], dtype=int)
    units = np.repeat([works.unit for works in all_works], [len(works.powers) for works in all_works])
    data, start, slices = (
        mbs.systemData,
        exu.ConfigurationType.StartOfStep,
        [one.own(mbs) for one in all_works],
    )
    own = np.concatenate([np.arange(data.ODE1Size())[one] for one in slices] or [which])

    def add_step(mbs: Any, t: float) -> bool:
        step = t - data.GetTime(start)
        if step > 0.0:
            works, rates = data.GetODE1Coordinates(), data.GetODE1Coordinates_t()
            rates[own] = np.array([power(mbs, t) for power in distinct])[which] / units
            means = (data.GetODE1Coordinates_t(start, False)[own] + rates[own]) / 2.0
            works[own] = data.GetODE1Coordinates(start, False)[own] + step * means
            data.SetODE1Coordinates(works)
            data.SetODE1Coordinates_t(rates)
            for one, places in zip(all_works, slices, strict=True):
                one.held = rates[places].tolist()
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
