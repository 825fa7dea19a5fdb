"""One call of an Exudyn solver: quiet, without files, and checked for what Exudyn itself lets pass."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import exudyn as exu
import numpy as np

from exudyn_models.supported_body import Model
from reference_model.systems import FloatArray
from reference_model.trajectory import SimulationError

EXPLICIT = ("RK44", "RK67", "DOPRI5")
FIXED_STEP = ("RK44", "RK67", "GeneralizedAlpha", "TrapezoidalIndex2")


@dataclass(frozen=True)
class Steps:
    """The states at the start and after every step of a solver.

    Parameters
    ----------
    times : array of shape (n,)
        In s.
    states : array of shape (n, 2d)
        The d coordinates of the system (m, rad) and their d velocities (m/s, rad/s).
    accelerations : array of shape (n, d)
        In m/s², rad/s².
    evaluations : int
        Evaluations of the equations of motion.

    """

    times: FloatArray
    states: FloatArray
    accelerations: FloatArray
    evaluations: int


def joined(parts: Sequence[Steps]) -> Steps:
    """Return consecutive runs as one; each starts with the state with which the one before it ends."""
    return Steps(
        np.concatenate([parts[0].times, *(part.times[1:] for part in parts[1:])]),
        np.concatenate([parts[0].states, *(part.states[1:] for part in parts[1:])]),
        np.concatenate([parts[0].accelerations, *(part.accelerations[1:] for part in parts[1:])]),
        sum(part.evaluations for part in parts),
    )


NOT_FINITE = "the state is not finite any more"
"""Where Exudyn itself would go on and report success."""

Watch = Callable[[float, list[float]], bool]
"""Called with time (s) and state after every step; returns False to end the run there."""


def solve(
    model: Model,
    start: float,
    end: float,
    *,
    integrator: str,
    step: float,
    tolerance: float,
    watch: Watch | None = None,
) -> Steps:
    """Run ``model`` from its initial values at ``start`` (s) to ``end`` or to where ``watch`` ends it.

    Parameters
    ----------
    model : Model
        Assembled.
    start, end : float
        In s, start <= end.
    integrator : str
        One of ``EXPLICIT`` or ``FIXED_STEP``.
    step : float
        In s: the step, for DOPRI5 the largest one.
    tolerance : float
        Of DOPRI5's local error, absolute; for the implicit solvers the residual force in N.
    watch : callable, optional
        Looks at every step.

    Raises
    ------
    SimulationError
        If a state is not finite, the Newton iteration fails or the step falls below what time resolves.

    """
    data = model.mbs.systemData
    own = slice(model.first, model.first + model.size)
    if start == end:
        initial = [
            values(configuration=exu.ConfigurationType.Initial)[own]
            for values in (data.GetODE2Coordinates, data.GetODE2Coordinates_t)
        ]
        return Steps(np.array([start]), np.hstack(initial)[None, :], np.zeros((1, model.size)), 0)
    # A step below the resolution of time leaves it where it is.
    smallest = 8.0 * float(np.spacing(max(abs(start), abs(end))))
    settings = _settings(start, end, integrator, step, tolerance)
    settings.timeIntegration.minimumStepSize = smallest
    explicit = integrator in EXPLICIT
    solver: Any = exu.MainSolverExplicit() if explicit else exu.MainSolverImplicitSecondOrder()
    failure = ""
    stopped = False
    previous = start

    def after_step(mbs: Any, t: float) -> bool:
        nonlocal failure, stopped, previous
        state = [*data.GetODE2Coordinates()[own].tolist(), *data.GetODE2Coordinates_t()[own].tolist()]
        if not math.isfinite(sum(state)):
            failure = NOT_FINITE
        elif start < t < end and t - previous <= smallest:
            failure = f"the step fell to {t - previous:.1g} s"
        previous = t
        stopped = bool(failure) or not (watch is None or watch(t, state))
        return not stopped

    with quiet():
        try:
            if explicit:
                first_acceleration = _initial_acceleration(model, start)
            with after_every_step(model.mbs, after_step):
                success = solver.SolveSystem(model.mbs, settings)
        except exu.ExudynError as error:
            raise_interrupt(error)
            raise SimulationError(advice(integrator, solver.it.currentTime, str(error))) from error
    if failure or not success:
        raise SimulationError(advice(integrator, solver.it.currentTime, failure or "the solver gave up"))
    recorded = [np.array(model.mbs.GetSensorStoredData(sensor)) for sensor in model.sensors]
    times = recorded[0][:, 0]
    if not stopped:  # what fixed steps add up to may differ from it in the last digits
        times[-1] = end
    positions, velocities, accelerations = (values[:, 1 : 1 + model.size] for values in recorded)
    if explicit:
        accelerations[0] = first_acceleration
    if explicit:
        steps = solver.it.currentStepIndex - 1 + solver.it.rejectedAutomaticStepSizeSteps
        evaluations = steps * (solver.GetNumberOfStages() + 1)
    else:
        evaluations = solver.it.newtonStepsCount + solver.it.currentStepIndex
    return Steps(times, np.hstack((positions, velocities)), accelerations, evaluations)


def _settings(start: float, end: float, integrator: str, step: float, tolerance: float) -> Any:
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 0.0  # at every step
    options = settings.timeIntegration
    options.verboseMode = 0
    options.startTime, options.endTime = start, end
    options.numberOfSteps = max(1, math.ceil((end - start) / step * (1.0 - 1e-12)))
    options.solverType = getattr(exu.DynamicSolverType, integrator)
    if integrator in EXPLICIT:
        # Exudyn 1.13 weighs the error with absolute + relative·y for y of either sign: with both tolerances alike
        # the step would collapse wherever a coordinate passes −1.
        options.absoluteTolerance, options.relativeTolerance = tolerance, 0.0
        options.initialStepSize = min(1e-6, end - start) if integrator == "DOPRI5" else 0.0
    else:
        options.newton.relativeTolerance, options.newton.absoluteTolerance = 1e-12, tolerance
        options.newton.useModifiedNewton = False
        trapezoidal = integrator == "TrapezoidalIndex2"
        options.generalizedAlpha.useNewmark = options.generalizedAlpha.useIndex2Constraints = trapezoidal
    return settings


def _initial_acceleration(model: Model, start: float) -> FloatArray:
    """Return the accelerations at the start in m/s², rad/s², shape (d,).

    Explicit solvers of Exudyn report zero there; the implicit ones compute it.
    """
    span = 1e-9 * max(1.0, abs(start))
    settings = _settings(start, start + span, "GeneralizedAlpha", span, math.inf)
    solver: Any = exu.MainSolverImplicitSecondOrder()
    if not solver.SolveSystem(model.mbs, settings):
        raise SimulationError(advice("GeneralizedAlpha", start, "no initial acceleration"))
    return np.array(model.mbs.GetSensorStoredData(model.sensors[2]))[0, 1 : 1 + model.size]


@contextmanager
def after_every_step(mbs: Any, function: Callable[[Any, float], bool]) -> Iterator[None]:
    """Call ``function`` after every step, besides what the model itself calls there; False ends the run."""
    before = mbs.GetPostStepUserFunction()
    own: Any = before["function"] if before else 0

    def both(mbs: Any, t: float) -> bool:
        return function(mbs, t) and bool(own(mbs, t))

    mbs.SetPostStepUserFunction(both if own else function)
    try:
        yield
    finally:
        mbs.SetPostStepUserFunction(own)


def raise_interrupt(error: exu.ExudynError) -> None:
    """Raise the ``KeyboardInterrupt`` that arrived while Exudyn was in a user function, if ``error`` is that."""
    if "KeyboardInterrupt" in str(error):
        raise KeyboardInterrupt from error


@contextmanager
def quiet() -> Iterator[None]:
    """Keep Exudyn from printing, and from warnings that Python functions allocate memory."""
    before = exu.config.printToConsole, exu.config.suppressWarnings
    exu.config.printToConsole, exu.config.suppressWarnings = False, True
    try:
        yield
    finally:
        exu.config.printToConsole, exu.config.suppressWarnings = before


def advice(integrator: str, time: float, what: str) -> str:
    """Return a sentence on a run that failed at ``time`` (s after its start)."""
    return (
        f"Exudyn's {integrator} failed {time:.9g} s after the start: {what}; "
        "take a smaller step, a larger tolerance or a larger regularisation, or the other solver"
    )
