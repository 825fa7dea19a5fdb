"""One call of an Exudyn solver: quiet, without files, and checked."""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from typing import Any

import exudyn as exu
import numpy as np
from numpy.typing import NDArray

from exudyn_models.solver.repeated_steps import changed, restored_accelerations, user_function
from reference_model import trajectory
from reference_model.systems import FloatArray
from reference_model.trajectory import SimulationError

EXPLICIT = ("RK44", "RK67", "DOPRI5")
FIXED_STEP = ("RK44", "RK67", "GeneralizedAlpha", "TrapezoidalIndex2")


@dataclass(frozen=True)
class Model:
    """Assembled model of a system, with sensors for the state of one body.

    ``container`` owns ``mbs`` and must live as long as ``mbs``. The body has ``size`` coordinates of ``mbs`` from
    ``first`` on, which ``sensors`` record with their first and second time derivatives.
    """

    container: Any
    mbs: Any
    first: int
    size: int
    sensors: tuple[Any, Any, Any]


@dataclass(frozen=True)
class Steps:
    """States at the start and after every step of a solver.

    ``times``, shape (n,), in s; ``states``, shape (n, 2d), with d coordinates (m, rad) and their velocities; and
    their ``accelerations``, shape (n, d). ``evaluations`` counts evaluations of the equations of motion.
    """

    times: FloatArray
    states: FloatArray
    accelerations: FloatArray
    evaluations: int

    def only(self, chosen: NDArray[Any]) -> Steps:
        """Return the steps ``chosen`` by an array of indices or booleans."""
        return replace(
            self,
            times=self.times[chosen],
            states=self.states[chosen],
            accelerations=self.accelerations[chosen],
        )


NOT_FINITE = "the state is not finite any more"
"""Message for a state that is not finite; Exudyn would report success."""

FIRST_STEP = 1e-6
"""First step of DOPRI5, in the model's unit of time; later steps are automatic.

Runs with Exudyn's built-in contact fail if they start with the largest step. A thousandth and a thousand times this
step give the same results.
"""


@dataclass
class StepCount(trajectory.StepCount):
    """Counts the steps of a motion from 0 to ``end``; the unit of time is ``seconds``."""

    seconds: float = 1.0

    def expect(self, start: float, steps: float) -> None:
        """Raise ``SimulationError`` if the ``steps`` expected from the time ``start`` on are too many."""
        if steps > trajectory.MOST_AHEAD:
            raise SimulationError(
                self._sentence(f"more than {trajectory.MOST_AHEAD:,} further steps are needed", start)
            )

    def count(self, t: float) -> str:
        """Count one more step, which ends at ``t``; return a message if there are or will be too many, else ""."""
        too_many = super().count(t)
        return self._sentence(too_many, t) if too_many else ""

    def _sentence(self, too_many: str, t: float) -> str:
        return (
            f"{too_many} at {t * self.seconds:g} s after the start: the parameters are very stiff, or the motion is "
            "very long; simulate it in parts, or with a larger tolerance or regularisation"
        )


Watch = Callable[[float, list[float]], bool]
"""Called with time (s) and state after every step; returns False to end the run."""


def solve(
    model: Model,
    start: float,
    end: float,
    *,
    integrator: str,
    step: float,
    tolerance: float,
    watch: Watch | None = None,
    first_step: float = FIRST_STEP,
    quasi_static: bool = False,
    balanced: bool = False,
    count: StepCount | None = None,
) -> Steps:
    """Run ``model`` from its initial values at ``start`` (s) to ``end``, or until ``watch`` ends it.

    ``integrator`` is one of ``EXPLICIT`` or ``FIXED_STEP``. ``step``, in s, is the largest step of DOPRI5, and
    ``first_step`` its first. ``tolerance`` is the absolute local error of DOPRI5, or the residual force in N of the
    implicit solvers. A ``quasi_static`` run of generalised-α neglects inertia: forces balance at the end of each
    step, and accelerations are derivatives of the velocities; the first is 0 or, if ``balanced``, follows from the
    forces. ``count`` counts the steps of the whole motion and gives the unit of time.

    Raises ``SimulationError`` if a state is not finite, Newton's method fails, the step falls below the resolution of
    time, or there are too many steps.
    """
    if start == end:
        return _no_steps(model, start)
    count = StepCount(end) if count is None else count
    count.expect(start, (end - start) / step)
    look = _Look(model, start, end, watch, count)
    settings = _settings(start, end, integrator, step, tolerance, first_step, quasi_static, balanced)
    settings.timeIntegration.minimumStepSize = look.smallest_step
    solver, first_acceleration = _run_solver(model, integrator, settings, look)
    times, states, accelerations = _recorded(model, None if look.stopped else end, quasi_static)
    if first_acceleration is not None:
        accelerations[0] = first_acceleration
    return Steps(times, states, accelerations, _evaluations(solver, integrator in EXPLICIT))


def _no_steps(model: Model, time: float) -> Steps:
    data, own = model.mbs.systemData, slice(model.first, model.first + model.size)
    initial = [
        values(configuration=exu.ConfigurationType.Initial)[own]
        for values in (data.GetODE2Coordinates, data.GetODE2Coordinates_t)
    ]
    return Steps(np.array([time]), np.hstack(initial)[None, :], np.zeros((1, model.size)), 0)


def _run_solver(model: Model, integrator: str, settings: Any, look: _Look) -> tuple[Any, FloatArray | None]:
    explicit = integrator in EXPLICIT
    solver: Any = exu.MainSolverExplicit() if explicit else exu.MainSolverImplicitSecondOrder()
    first_acceleration = None
    with quiet():
        try:
            if explicit:
                first_acceleration = _initial_acceleration(model, settings.timeIntegration.startTime)
            alpha = integrator == "GeneralizedAlpha"
            with (
                after_every_step(model.mbs, look),
                restored_accelerations(model.mbs) if alpha else nullcontext(),
            ):
                success = solver.SolveSystem(model.mbs, settings)
        except exu.ExudynError as error:
            raise_interrupt(error)
            time = solver.it.currentTime * look.count.seconds
            raise SimulationError(advice(integrator, time, str(error))) from error
    if look.too_many:
        raise SimulationError(look.too_many)
    if look.failure or not success:
        time = solver.it.currentTime * look.count.seconds
        raise SimulationError(advice(integrator, time, look.failure or "the solver failed"))
    return solver, first_acceleration


class _Look:
    """Ends a run if a state is invalid or ``watch`` returns False."""

    def __init__(self, model: Model, start: float, end: float, watch: Watch | None, count: StepCount) -> None:
        data, self._own = model.mbs.systemData, slice(model.first, model.first + model.size)
        self._positions, self._velocities = data.GetODE2Coordinates, data.GetODE2Coordinates_t
        self._start, self._end, self._watch, self.count = start, end, watch, count
        self._previous = start
        #: Smallest step in s that still changes the time.
        self.smallest_step = 8.0 * float(np.spacing(max(abs(start), abs(end))))
        self.failure = self.too_many = ""
        self.stopped = False

    def __call__(self, mbs: Any, t: float) -> bool:
        own, watch = self._own, self._watch  # runs after every step, so every call counts
        state = self._positions().tolist()[own] + self._velocities().tolist()[own]
        if not math.isfinite(sum(state)):
            self.failure = NOT_FINITE
        elif t - self._previous <= self.smallest_step and self._start < t < self._end:
            self.failure = f"the step fell to {(t - self._previous) * self.count.seconds:.1g} s"
        self._previous = t
        self.too_many = self.count.count(t)
        if self.failure or self.too_many or (watch is not None and not watch(t, state)):
            self.stopped = True
        return not self.stopped


def _recorded(
    model: Model, end: float | None, quasi_static: bool
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return times, shape (n,), states (n, 2d) and accelerations (n, d) of all steps; the last time is ``end``."""
    stored = [np.array(model.mbs.GetSensorStoredData(sensor)) for sensor in model.sensors]
    positions, velocities, accelerations = (values[:, 1 : 1 + model.size] for values in stored)
    times = stored[0][:, 0]
    if end is not None:
        times[-1] = end
    if quasi_static:
        accelerations = np.gradient(velocities, times, axis=0, edge_order=1 if len(times) == 2 else 2)
    return times, np.hstack((positions, velocities)), accelerations


def _evaluations(solver: Any, explicit: bool) -> int:
    if not explicit:
        found = solver.it.discontinuousIterationsCount
        # Each failed iteration leads to one repetition, see restored_accelerations.
        failed = found - solver.it.currentStepIndex
        return int(solver.it.newtonStepsCount + found + failed)
    steps = solver.it.currentStepIndex - 1 + solver.it.rejectedAutomaticStepSizeSteps
    return int(steps * (solver.GetNumberOfStages() + 1))


def _settings(
    start: float,
    end: float,
    integrator: str,
    step: float,
    tolerance: float,
    first_step: float = FIRST_STEP,
    quasi_static: bool = False,
    balanced: bool = False,
) -> Any:
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 0.0
    options = settings.timeIntegration
    options.verboseMode = 0
    options.startTime, options.endTime = start, end
    options.numberOfSteps = max(1, math.ceil((end - start) / step * (1.0 - 1e-12)))
    options.solverType = getattr(exu.DynamicSolverType, integrator)
    if integrator in EXPLICIT:
        # Exudyn 1.13 scales the error with absolute + relative·y of either sign: with equal tolerances the step
        # would collapse wherever a coordinate passes −1.
        options.absoluteTolerance, options.relativeTolerance = tolerance, 0.0
        options.initialStepSize = min(first_step, end - start) if integrator == "DOPRI5" else 0.0
    else:
        options.newton.relativeTolerance, options.newton.absoluteTolerance = 1e-12, tolerance
        options.newton.useModifiedNewton = False
        trapezoidal = integrator == "TrapezoidalIndex2"
        options.generalizedAlpha.useNewmark = options.generalizedAlpha.useIndex2Constraints = trapezoidal
    if quasi_static:
        options.generalizedAlpha.spectralRadius = 0.0
        options.generalizedAlpha.computeInitialAccelerations = balanced
    return settings


def _initial_acceleration(model: Model, start: float) -> FloatArray:
    """Return the initial accelerations by an implicit solver; explicit ones report zero."""
    span = 1e-9 * max(1.0, abs(start))
    settings = _settings(start, start + span, "GeneralizedAlpha", span, math.inf)
    solver: Any = exu.MainSolverImplicitSecondOrder()
    if not solver.SolveSystem(model.mbs, settings):
        raise SimulationError(advice("GeneralizedAlpha", start, "no initial acceleration"))
    return np.array(model.mbs.GetSensorStoredData(model.sensors[2]))[0, 1 : 1 + model.size]


def after_every_step(mbs: Any, function: Callable[[Any, float], bool]) -> AbstractContextManager[None]:
    """Call ``function`` and the model's own function after every step; False ends the run."""
    return user_function(mbs, "PostStep", lambda own: lambda mbs, t: function(mbs, t) and bool(own(mbs, t)))


def raise_interrupt(error: exu.ExudynError) -> None:
    """Raise ``KeyboardInterrupt`` if ``error`` is one that arrived in a user function."""
    if "KeyboardInterrupt" in str(error):
        raise KeyboardInterrupt from error


def quiet() -> AbstractContextManager[None]:
    """Suppress Exudyn's output, and its warnings about memory that Python functions allocate."""
    return changed(exu.config, printToConsole=False, suppressWarnings=True)


def advice(integrator: str, time: float, what: str) -> str:
    """Return a message about a run that failed at ``time`` (s)."""
    other = "TrapezoidalIndex2" if integrator == "GeneralizedAlpha" else "another solver"
    return (
        f"Exudyn's {integrator} failed {time:.9g} s after the start: {what}; "
        f"use a smaller step, a larger tolerance or a larger regularisation, or {other}"
    )
