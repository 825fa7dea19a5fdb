"""``mbs.SolveDynamic`` for models of one's own, checked for what Exudyn itself lets pass."""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import ExitStack, closing
from typing import Any

import exudyn as exu

from exudyn_models.solver.breaks import checked_breaks, parts_of_run
from exudyn_models.solver.jumps import JumpCheck
from exudyn_models.solver.linear_matrices import singular_mass
from exudyn_models.solver.repeated_steps import newton_without_restart, restored_accelerations
from exudyn_models.solver.solver_run import NOT_FINITE, advice, after_every_step, raise_interrupt
from exudyn_models.solver.starting_rates import starting_rates
from exudyn_models.solver.steep_laws import peaks_resolved
from exudyn_models.solver.step_limit import INTERVALS, StepCheck
from exudyn_models.solver.sticking_contacts import ModeChange, StickingContact, sticking_contacts
from exudyn_models.solver.switching import first_modes, run_switching
from reference_model.trajectory import SimulationError, StepCount

IMPLICIT = (exu.DynamicSolverType.GeneralizedAlpha, exu.DynamicSolverType.TrapezoidalIndex2)


def solve_dynamic(
    mbs: Any,
    simulationSettings: Any,
    solverType: Any = None,
    updateInitialValues: bool = False,
    *,
    breaks: Sequence[float] = (),
) -> list[ModeChange]:
    """Run ``mbs.SolveDynamic`` with the same arguments, and raise what it does not tell.

    A step across a jump of a load is wrong by the jump times the part of the step that lies before it, of any order
    the solver may be, and by more under an implicit one. With ``breaks`` the run ends at these times, from before,
    and goes on from there.

    Exudyn's explicit solvers ignore algebraic constraints, or lose their order where they eliminate them, and they go
    on with a state that is not finite and report success. A look at every step, which costs about 1.5 μs, ends the
    run there; the model's own function after a step is called besides.

    A step beyond what is stable where contacts stick gives a run that looks like any other: before a run with a fixed
    step a ``RuntimeWarning`` tells of it, see ``largest_stable_step``. It sees the contacts of ``add_ring_friction``,
    whether they will stick or not, and all dampers at the initial values. Loads and coefficients that are functions
    are looked at at the start and at a hundred times of the run, where the warning may come too: they are never asked
    about a time or a motion that is not the run's.

    An implicit run starts with the rates that heat and works have, which Exudyn takes to be zero. Steps that Exudyn
    repeats begin with all of the state from their start, see ``repeated_steps``; for that modified Newton renews its
    Jacobian where it would start over, whatever ``newton`` says about that. Steps that skip a peak of friction are
    repeated with a smaller size; if steps are fixed, a ``RuntimeWarning`` reports the first one, see ``steep_laws``.
    Where a power of ``add_energy_balance`` or of a sensor of heat jumps a ``RuntimeWarning`` tells so at the end of
    the run, see ``jumps``.

    Friction contacts without a regularisation switch between sliding and stick at the times at which Coulomb's law
    does. Sensors have an additional row at each of these times, see ``switching``.

    Parameters
    ----------
    mbs : exudyn MainSystem
        The model.
    simulationSettings : exudyn SimulationSettings
        Of the run.
    solverType : exudyn DynamicSolverType, optional
        In place of that of the settings.
    updateInitialValues : bool
        Let the next run go on from where this one ends.
    breaks : sequence of float
        In s, in growing order and within the run: where a load, a coefficient or any other function jumps.

    Returns
    -------
    list of ModeChange
        Changes of the modes of all contacts without a regularisation, in the order of their times.

    Raises
    ------
    ValueError
        If the solver is explicit and the model has algebraic constraints, or ``breaks`` are none.
    SimulationError
        If a step does not converge, a matrix is singular, a state is not finite, or a solver that chooses its steps
        would need too many.
    exudyn.ExudynError
        What else Exudyn finds; an error in a function of a friction contact arrives as its ``__cause__``.

    """
    solver = simulationSettings.timeIntegration.solverType if solverType is None else solverType
    if not mbs.systemIsConsistent:
        mbs.Assemble()
    _check_constraints(mbs, solver)
    times = checked_breaks(breaks, simulationSettings.timeIntegration)
    contacts, changes = sticking_contacts(mbs), []
    with closing(parts_of_run(mbs, simulationSettings, times, updateInitialValues)) as parts:
        for goes_on in parts:
            changes += _solve(mbs, simulationSettings, solver, goes_on, contacts)
    return changes


def _solve(
    mbs: Any, simulationSettings: Any, solver: Any, updateInitialValues: bool, contacts: list[StickingContact]
) -> list[ModeChange]:
    """Run an assembled model without a break; return the changes of modes of ``contacts``."""
    data = mbs.systemData
    options = simulationSettings.timeIntegration
    start = reached = options.startTime
    finite, too_many = True, ""
    count = None if solver in IMPLICIT or solver.name in INTERVALS else StepCount(options.endTime)
    if count is not None:  # steps are as small as the solver likes
        count.look_from(start)
    check = StepCheck(mbs, solver.name, options)
    check.warn(start, data.GetODE2Coordinates(exu.ConfigurationType.Initial))
    jumps = JumpCheck(mbs) if solver in IMPLICIT else None
    changes: list[ModeChange] = []

    positions, velocities, others = (
        data.GetODE2Coordinates,
        data.GetODE2Coordinates_t,
        data.GetODE1Coordinates,
    )

    def look(mbs: Any, t: float) -> bool:
        nonlocal reached, finite, too_many
        reached = t
        if t >= check.next_time:
            check.warn(t, positions())
        finite = math.isfinite(
            sum(positions().tolist()) + sum(velocities().tolist()) + sum(others().tolist())
        )
        if jumps is not None:
            jumps.look(t, data.GetODE1Coordinates_t())
        if count is not None:
            too_many = count.count(t)
        return finite and not too_many

    try:
        with ExitStack() as repairs:
            repairs.enter_context(after_every_step(mbs, look))
            repairs.enter_context(first_modes(mbs, contacts, start))
            if jumps is not None:
                repairs.enter_context(starting_rates(mbs, start))
                repairs.enter_context(newton_without_restart(mbs, options.newton))
                repairs.enter_context(peaks_resolved(mbs, options))
                if solver == exu.DynamicSolverType.GeneralizedAlpha and options.adaptiveStep:
                    repairs.enter_context(restored_accelerations(mbs))
                jumps.look(start, data.GetODE1Coordinates_t(exu.ConfigurationType.Initial))
            if contacts:
                changes = run_switching(mbs, simulationSettings, solver, contacts, updateInitialValues)
            else:
                mbs.SolveDynamic(simulationSettings, solver, updateInitialValues)
    except exu.ExudynError as error:
        raise_interrupt(error)
        if isinstance(error.__cause__, Warning):  # of the step, for someone to whom warnings are errors
            raise error.__cause__ from None
        if isinstance(error, (exu.SolverError, exu.InternalError)):
            if massless := _singular(mbs, reached == start):
                raise SimulationError(
                    f"Exudyn's {solver.name} failed 0 s after the start: {massless}; give the body some"
                ) from error
            what = mbs.sys["dynamicSolver"].GetErrorString() or str(error)
            raise SimulationError(advice(solver.name, reached - start, what)) from error
        raise
    if not finite or too_many:
        raise SimulationError(advice(solver.name, reached - start, too_many or NOT_FINITE))
    if jumps is not None:
        jumps.warn()
    return changes


def _singular(mbs: Any, at_start: bool) -> str:
    """Return in words that the mass matrix is singular, if a run has failed at its start for that."""
    if not at_start:
        return ""
    try:
        return singular_mass(mbs)
    except exu.ExudynError:  # the run's own error is the one to tell
        return ""


def _check_constraints(mbs: Any, solver: Any) -> None:
    """Raise ``ValueError`` if ``solver`` is explicit and an assembled model has algebraic constraints."""
    constraints = mbs.systemData.AEsize()
    if solver not in IMPLICIT and constraints > 0:
        raise ValueError(
            f"solverType = {solver.name}: it is explicit and would ignore {constraints} constraint equations of the "
            "model; take GeneralizedAlpha or TrapezoidalIndex2, or replace the constraints by springs, any "
            "NodeRigidBodyEP, whose norm is one, by a NodeRigidBodyRotVecLG, and contacts without regularisation, "
            "which lock by one, by contacts with it"
        )
