"""``mbs.SolveDynamic`` for any model, with checks for problems that Exudyn does not report.

- *Load jumps.* A step across a load jump has an error of at least the jump times the part of the step before it. With
  ``breaks`` the run stops just before these times and continues just after. A ``RuntimeWarning`` reports jumps that
  ``jumps`` finds.
- *Explicit solvers.* Exudyn's explicit solvers ignore algebraic constraints, or lose their order when they eliminate
  constraints, and report success with a state that is not finite. A check after every step (about 1.5 μs) ends such a
  run.
- *Fixed explicit steps.* A ``RuntimeWarning`` reports steps beyond the ``step_limit`` of sticking contacts.
- *Implicit solvers.* The run starts with the actual rates of heat and work (``starting_rates``). Repeated steps start
  from their complete first state (``repeated_steps``). Steps that skip a peak of friction are repeated or reported
  (``steep_laws``).
- *Exact stick.* Contacts without a regularisation lock and release at the times of Coulomb's law
  (``stick.switching``). Sensors have an additional row at each of these times.
"""

import copy
import math
from collections.abc import Mapping, Sequence
from contextlib import ExitStack, closing
from types import MappingProxyType
from typing import Any

import exudyn as exu
import numpy as np

from exudyn_models.forces.axial_pairs import Mode
from exudyn_models.solver.breaks import (
    Controller,
    checked_breaks,
    parts_of_run,
    take_samples,
    with_samples,
)
from exudyn_models.solver.checks.jumps import JumpCheck
from exudyn_models.solver.checks.steep_laws import peaks_resolved
from exudyn_models.solver.checks.step_limit import INTERVALS, StepCheck
from exudyn_models.solver.contacts import find_again
from exudyn_models.solver.items import CURRENT
from exudyn_models.solver.linear.matrices import singular_mass
from exudyn_models.solver.repeated_steps import newton_without_restart, restored_accelerations
from exudyn_models.solver.solver_run import NOT_FINITE, advice, after_every_step, raise_interrupt
from exudyn_models.solver.starting_rates import starting_rates
from exudyn_models.solver.stick.dynamics import Dynamics
from exudyn_models.solver.stick.sticking_contacts import (
    ModeChange,
    StickingContact,
    running,
    sticking_contacts,
)
from exudyn_models.solver.stick.switching import run_switching
from exudyn_models.solver.works import works_of
from reference_model.systems import require_flag, require_kind
from reference_model.trajectory import SimulationError, StepCount

IMPLICIT = (exu.DynamicSolverType.GeneralizedAlpha, exu.DynamicSolverType.TrapezoidalIndex2)


def solve_dynamic(
    mbs: Any,
    simulationSettings: Any,
    solverType: Any = None,
    updateInitialValues: bool = False,
    *,
    breaks: Sequence[float] = (),
    sampled: Mapping[float, Controller] = MappingProxyType({}),
) -> list[ModeChange]:
    """Run ``mbs.SolveDynamic`` with the same arguments and the checks and repairs of this module.

    Parameters
    ----------
    mbs, simulationSettings : exudyn MainSystem, SimulationSettings
        Model, and settings of the run.
    solverType : exudyn DynamicSolverType, optional
        Solver, if not that of the settings.
    updateInitialValues : bool
        Whether the next run continues from the end of this one.
    breaks : sequence of float
        Increasing times in s within the run when a load, a coefficient or another function jumps.
    sampled : dict of float and callable
        Controllers by their period in s, from the start of the run: functions of ``mbs`` and the time in s, called
        once at each sample.

    Returns
    -------
    list of ModeChange
        Mode changes of all contacts with exact stick, in order of time.

    Raises
    ------
    ValueError
        If the solver is explicit and the model has constraints, if ``breaks`` or ``sampled`` are invalid, or if a
        contact in the plane that sticks exactly accompanies a gear with losses or a one-way clutch.
    SimulationError
        If a step does not converge, a matrix is singular, a state is not finite, or DOPRI5 would need too many steps.
    exudyn.ExudynError
        Any other error of Exudyn; an error in a function of a friction contact is its ``__cause__``.

    """
    require_kind("mbs", mbs, exu.MainSystem)
    require_kind("simulationSettings", simulationSettings, exu.SimulationSettings)
    solver = simulationSettings.timeIntegration.solverType if solverType is None else solverType
    require_kind("solverType", solver, exu.DynamicSolverType)
    require_flag("updateInitialValues", updateInitialValues)
    simulationSettings = copy.copy(simulationSettings)  # other runs may share them
    if not mbs.systemIsConsistent:
        mbs.Assemble()
    _check_constraints(mbs, solver)
    options, changes = simulationSettings.timeIntegration, list[ModeChange]()
    calls = with_samples(checked_breaks(breaks, options), sampled, options)
    find_again(mbs)
    contacts = sticking_contacts(mbs, options.startTime, options.endTime)
    with closing(parts_of_run(mbs, simulationSettings, list(calls)[1:], updateInitialValues)) as parts:
        modes: list[Mode] = []
        for goes_on, (t, functions) in zip(parts, calls.items(), strict=False):
            take_samples(mbs, t, functions)
            changes += _solve(mbs, simulationSettings, solver, goes_on, contacts, modes)
            modes = [contact.stick.visible_mode for contact in contacts]
    return changes


class _Look:
    """Checks the state of a model after every step of a run."""

    def __init__(self, mbs: Any, solver: Any, options: Any) -> None:
        data, self._solver, self._start = mbs.systemData, solver, options.startTime
        self._positions, self._velocities = data.GetODE2Coordinates, data.GetODE2Coordinates_t
        self._others, self._rates = data.GetODE1Coordinates, data.GetODE1Coordinates_t
        self._works = data.ODE1Size() > 0
        automatic = solver not in IMPLICIT and solver.name not in INTERVALS
        self._count = StepCount(options.endTime) if automatic else None
        if self._count is not None:
            self._count.look_from(self._start)
        self._steps = StepCheck(mbs, solver.name, options)
        self._steps.warn(self._start, self._positions(exu.ConfigurationType.Initial))
        jumps = JumpCheck(mbs)
        self._jumps = jumps if solver in IMPLICIT and jumps.names else None
        self._reached, self._finite, self._too_many = self._start, True, ""

    @property
    def duration(self) -> float:
        """Time in s since the start of the run."""
        return float(self._reached - self._start)

    def start(self) -> None:
        if self._jumps is not None:
            self._jumps.look(self._start, self._rates(exu.ConfigurationType.Initial))

    def __call__(self, mbs: Any, t: float) -> bool:
        self._reached = t
        if t >= self._steps.next_time:
            self._steps.warn(t, self._positions())
        total = sum(self._velocities(CURRENT, False).tolist())  # positions are their integrals
        if self._works:
            total += sum(self._others(CURRENT, False).tolist())
        self._finite = math.isfinite(total)
        if self._jumps is not None:
            self._jumps.look(t, self._rates())
        if self._count is not None:
            self._too_many = self._count.count(t)
        return self._finite and not self._too_many

    def finish(self, changes: Sequence[ModeChange]) -> None:
        """Raise ``SimulationError`` if a check ended the run; warn about jumps at other times than ``changes``."""
        if not self._finite or self._too_many:
            raise SimulationError(advice(self._solver.name, self.duration, self._too_many or NOT_FINITE))
        if self._jumps is not None:
            self._jumps.warn([change.time for change in changes])


def _solve(
    mbs: Any,
    simulationSettings: Any,
    solver: Any,
    updateInitialValues: bool,
    contacts: list[StickingContact],
    modes: list[Mode],
) -> list[ModeChange]:
    options = simulationSettings.timeIntegration
    look = _Look(mbs, solver, options)
    changes: list[ModeChange] = []
    try:
        with ExitStack() as repairs:
            repairs.enter_context(after_every_step(mbs, look))
            repairs.enter_context(running(mbs, contacts))
            if solver in IMPLICIT:
                _repair_implicit(repairs, mbs, solver, options)
            look.start()
            if contacts:
                changes = run_switching(mbs, simulationSettings, contacts, updateInitialValues, modes)
            else:
                mbs.SolveDynamic(simulationSettings, solver, updateInitialValues)
    except exu.ExudynError as error:
        _raise_cause(error, mbs, solver.name, look.duration)
        raise
    look.finish(changes)
    return changes


def _repair_implicit(repairs: ExitStack, mbs: Any, solver: Any, options: Any) -> None:
    works = works_of(mbs)
    if works is not None:
        repairs.enter_context(works.at_step_ends())
    repairs.enter_context(starting_rates(mbs, options.startTime))
    repairs.enter_context(newton_without_restart(mbs, options.newton))
    repairs.enter_context(peaks_resolved(mbs, options))
    if solver == exu.DynamicSolverType.GeneralizedAlpha and options.adaptiveStep:
        repairs.enter_context(restored_accelerations(mbs))


def _raise_cause(error: exu.ExudynError, mbs: Any, solver: str, time: float) -> None:
    """Raise the cause of an error in a run, unless it is Exudyn's own."""
    raise_interrupt(error)
    if isinstance(
        error.__cause__, (Warning, SimulationError)
    ):  # of a check, a warning made an error by a filter
        raise error.__cause__ from None
    if isinstance(error, (exu.SolverError, exu.InternalError)):
        if singular := _singular(mbs, time == 0.0):
            raise SimulationError(f"Exudyn's {solver} failed 0 s after the start: {singular}") from error
        what = mbs.sys["dynamicSolver"].GetErrorString() or str(error)
        raise SimulationError(advice(solver, time, what)) from error


def _singular(mbs: Any, at_start: bool) -> str:
    """Return a message about massless coordinates, or constraints that depend on each other, or ""."""
    if not at_start:
        return ""
    try:
        if massless := singular_mass(mbs):
            return f"{massless}; add mass or inertia"
        dynamics = Dynamics(mbs, 0.0, 1.0)
        dynamics.evaluate(0.0)
    except exu.ExudynError:  # the run's own error is more useful
        return ""
    rows = dynamics.gradients[dynamics.gradients.any(axis=1)]
    surplus = len(rows) and len(rows) - np.linalg.matrix_rank(rows / np.linalg.norm(rows, axis=1)[:, None])
    return f"{surplus} of {len(rows)} constraints depend on the others; remove them" if surplus else ""


def _check_constraints(mbs: Any, solver: Any) -> None:
    constraints = mbs.systemData.AEsize()
    if solver not in IMPLICIT and constraints > 0:
        raise ValueError(
            f"solverType = {solver.name}: explicit solvers ignore constraints, and this model has {constraints}; use "
            "GeneralizedAlpha or TrapezoidalIndex2, or replace joints by springs and NodeRigidBodyEP by "
            "NodeRigidBodyRotVecLG, and give contacts a regularisation"
        )
