"""Thresholds, records, and steps of a running simulation."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, NamedTuple

import numpy as np
from scipy.integrate import DenseOutput, OdeSolution
from scipy.optimize import brentq, minimize_scalar

from reference_model.numerics.collocation import Radau, RatesAt, Scales
from reference_model.numerics.explicit import TIGHTEST, Explicit, Rates, Tolerated
from reference_model.systems import FloatArray
from reference_model.trajectory import SimulationError, StepCount

Kind = Literal["slip", "pivot", "stick"]
Sampler = Callable[[FloatArray], FloatArray]
"""Takes times (n,) and returns the motion, shape (unknowns, n)."""

STABLE = 3.0
"""Product of step and largest decay rate where stability begins to limit DOP853; the limit is 6."""

STIFF, APART = 0.25, 5.0
"""Bounds for stiff steps limited by accuracy: step times decay rate, and its ratio to the change of slip."""

SHORT = 0.02
"""A step is short if relative change of slip plus scaled time are below this."""

PATIENCE = 15
"""Number of stiff explicit steps before an implicit method is tried; doubled if it does not pay."""

SLOW_SPRINGS = 0.1
"""Natural frequency in 1/T below which steps become more accurate: position errors are velocity errors divided by
it."""

LAST_TERM = 1e-3
"""Error of DOP853's interpolant as a share of its last term, as measured."""

AS_GOOD = 20.0
"""Largest error of the interpolant, in local tolerances, within the requested tolerance."""

INTERPOLANT_ORDER = 7

MOST_PARTS = 8
"""Largest number of shorter steps in place of one; stability requires no more."""

SPOILT = 1.5
"""Stiffness of a step above which fast decay may spoil the interpolant, whatever its last term."""


class StepError(SimulationError):
    """An integrator could not take a step."""


@dataclass(frozen=True)
class Thresholds:
    """Thresholds between descriptions of the motion; results do not depend on them (tested).

    Parameters
    ----------
    slow_slip
        Upper limit of slow slip, which uses slip-polar coordinates, in units of g·T with the unit T of time.
    stretching
        s₀ of the stretched time as a multiple of ``slow_slip``.
    rest_time
        Largest error in T of the closed form for the time of coming to rest.
    reversal_slip
        Scaled slip speed below which slip that friction cannot hold counts as reversed.
    common_rest
        Scaled slip speed below which all points of a disc rest together. A point slips from rest only if it can gain
        this speed before the disc rests.
    series
        Size of the last terms of the initial series of slip.
    safety
        The integrator's tolerance as a fraction of the requested one.

    """

    slow_slip: float = 0.5
    stretching: float = 2.0
    rest_time: float = 1e-12
    reversal_slip: float = 1e-13
    common_rest: float = 1e-11
    series: float = 1e-12
    safety: float = 0.05


@dataclass
class Run:
    """A simulation from t = 0 on, in scaled times and unknowns, half of them relative velocities.

    ``times``, shape (n,), are the requested times, the first of them 0. ``seconds`` converts a scaled time to s, and
    ``springs`` is the natural frequency in 1/T. The run ends if a slip phase lasts for ``slipping``.
    """

    times: FloatArray
    unknowns: int
    seconds: Callable[[float], float]
    thresholds: Thresholds
    tolerance: float
    springs: float
    slipping: float = math.inf
    motion: FloatArray = field(init=False)
    phases: list[tuple[Kind, float, FloatArray]] = field(default_factory=list)
    evaluations: int = 0
    patience: int = PATIENCE
    recorded: int = 0

    def __post_init__(self) -> None:
        self.motion = np.empty((len(self.times), self.unknowns))
        share = self.thresholds.safety * min(1.0, self.springs / SLOW_SPRINGS)
        self.local_tolerance = max(share * self.tolerance, TIGHTEST)
        self.end = float(self.times[-1])
        self._count = StepCount(self.end)

    @property
    def steps(self) -> int:
        return self._count.steps

    def enter(self, kind: Kind, t: float, y: Sequence[float] | FloatArray) -> None:
        """Begin a phase unless it is of the current kind."""
        if not self.phases or self.phases[-1][0] != kind:
            self.phases.append((kind, t, np.array(y)))
            self.end = min(t + (self.slipping if kind == "slip" else math.inf), float(self.times[-1]))

    def step(self, solver: Explicit | Radau, since: float) -> None:
        """Take one step; raise ``StepError`` with the time reached if it fails."""
        evaluations = solver.nfev
        message = solver.step()
        self.evaluations += solver.nfev - evaluations
        self.count_step(since)
        if solver.status == "failed" or not all(map(math.isfinite, solver.y.tolist())):
            raise StepError(
                f"the integrator failed after t = {self.seconds(since):g} s: "
                f"{message or 'the state is not finite'}; try a larger tolerance than {self.tolerance:g}"
            )

    def count_step(self, since: float) -> None:
        if too_many := self._count.count(since):
            raise SimulationError(
                f"stopped at t = {self.seconds(since):g} s because {too_many}: the parameters are very stiff, or the "
                "motion is very long; simulate it in parts, or with a larger tolerance"
            )

    def pending(self, t: float) -> bool:
        return self.recorded < len(self.times) and bool(self.times[self.recorded] <= t)

    def record(self, until: float, sample: Sampler) -> None:
        stop = int(np.searchsorted(self.times, until, side="right"))
        if stop > self.recorded:
            self.motion[self.recorded : stop] = sample(self.times[self.recorded : stop]).T
            self.recorded = stop


class SwitchingSurface(NamedTuple):
    """A surface where the rates are continuous but not smooth.

    ``value`` changes sign on the surface. ``trend`` takes the unknowns and their rates and returns the sign of the
    rate of ``value``, which detects steps that cross the surface and come back.
    """

    value: Callable[[list[float]], float]
    trend: Callable[[list[float], list[float]], float] | None = None

    def seen_by(self, unknowns: Callable[[list[float]], list[float]]) -> SwitchingSurface:
        """Return the surface for other unknowns, which ``unknowns`` converts to these; x and y come first in both."""
        return SwitchingSurface(lambda other: self.value(unknowns(other)), self.trend)


class Stepper:
    """Steps of a Runge-Kutta method that end on ``surfaces`` where the rates are not smooth.

    A step across such a surface has an unreliable error estimate and is repeated up to it. ``rates`` are vectorised
    for collocation only. ``tolerated`` returns the allowed errors of a step. ``implicit`` contains the scales of the
    unknowns and the first step to try.
    """

    def __init__(
        self,
        run: Run,
        rates: Rates | RatesAt,
        y: Sequence[float],
        span: tuple[float, float],
        tolerated: Tolerated,
        surfaces: Sequence[SwitchingSurface] = (),
        implicit: tuple[Scales, float] | None = None,
    ) -> None:
        self._run, self._surfaces = run, surfaces
        self._rates: Callable[..., Any] = rates
        self._scales = None if implicit is None else implicit[0]
        first_step = None if implicit is None else implicit[1]
        self._dense: DenseOutput | OdeSolution | None = None
        self._solver: Explicit | Radau
        self._stiff_steps = 0
        self._tolerated = tolerated
        self._end = span[1]
        self._landed: tuple[SwitchingSurface, float] | None = None  # surface at the state, and sign beyond it
        self._usual_step = math.inf
        self._since = 0.0
        self._start(span[0], np.array(y), self._end, first_step)

    @property
    def t(self) -> float:
        return float(self._solver.t)

    @property
    def y(self) -> FloatArray:
        return np.asarray(self._solver.y)

    @property
    def rates(self) -> FloatArray:
        return np.asarray(self._solver.f)

    @property
    def settled(self) -> bool:
        return isinstance(self._solver, Radau) and self._solver.settled

    def stiff_for_long(self, change: float) -> bool:
        """Return whether the explicit method has taken many stiff steps; ``change`` is the relative change of slip.

        Stiff steps are limited by stability, or by accuracy because something decays much faster than slip changes.
        """
        stiffness = self.stiffness
        stiff = stiffness > STABLE or stiffness > max(STIFF, APART * change) or change < SHORT
        self._stiff_steps = max(0, self._stiff_steps + (1 if stiff else -1))
        return self._stiff_steps >= self._run.patience

    @property
    def stiffness(self) -> float:
        """Length of the last step times the largest decay rate."""
        return self._solver.stiffness

    def dense_output(self) -> DenseOutput | OdeSolution:
        """Return the interpolant of the last step, as accurate as its end."""
        if self._dense is None:
            solver = self._solver
            self._dense = solver.dense_output() if isinstance(solver, Radau) else self._interpolant(solver)
        return self._dense

    def _interpolant(self, solver: Explicit) -> DenseOutput | OdeSolution:
        evaluations = solver.nfev
        dense = solver.dense_output()
        self._run.evaluations += solver.nfev - evaluations
        tolerated = self._tolerated(solver.y)
        error, stiffness = LAST_TERM * float(np.max(abs(dense.F[-1]) / tolerated)), solver.stiffness
        if error > AS_GOOD or stiffness > SPOILT:
            error = self._defect(dense, tolerated)
        if error <= AS_GOOD:
            return dense
        parts = 1 + math.ceil(min(max(error ** (1.0 / INTERPOLANT_ORDER), stiffness), MOST_PARTS))
        return self._finer(solver, parts)

    def _defect(self, dense: DenseOutput, tolerated: FloatArray) -> float:
        """Return the error of the interpolant over half a step, in tolerances, by its defect in the middle."""
        first, last = dense.t_old, dense.t
        middle, little = 0.5 * (first + last), 1e-3 * (last - first)
        slope = (dense(middle + little) - dense(middle - little)) / (2.0 * little)
        self._run.evaluations += 1
        lacks = slope - np.array(self._rates(dense(middle).tolist()))
        return float(0.5 * (last - first) * np.max(abs(lacks) / tolerated))

    def _finer(self, done: Explicit, parts: int) -> OdeSolution:
        """Return the motion in the last step by ``parts`` shorter steps, each with an accurate interpolant."""
        first, last = done.t_old, done.t
        solver = self._explicit(first, done.y_old, last, (last - first) / parts, (last - first) / parts)
        times, pieces = [first], []
        while solver.status == "running":
            self._run.step(solver, self._since)
            times.append(solver.t)
            pieces.append(self._interpolant(solver))
        return OdeSolution(times, pieces)

    def step(self, since: float) -> None:
        """Take one step; ``since`` is the time for the message if it fails."""
        if self._solver.status == "finished" and self.t < self._end:
            self._start(self.t, self.y, self._end, self._usual_step)
        self._dense, self._since = None, since
        solver = self._solver
        t, y, rates = solver.t, solver.y, solver.f
        self._run.step(solver, since)
        if not self._surfaces or solver.t_bound != self._end:
            return
        landed, self._landed = self._landed, None
        crossings = []
        for surface in self._surfaces:
            side = landed[1] if landed is not None and landed[0] is surface else None
            crossing = self._crossing(surface, side, t, y.tolist(), rates.tolist())
            if crossing is not None and t < crossing[0] < solver.t:
                crossings.append((*crossing, surface))
        if crossings:
            place, beyond, surface = min(crossings, key=lambda crossing: crossing[0])
            self._landed = surface, beyond
            self._usual_step = float(solver.t - t)
            self._start(t, y, place, place - t)
            self._run.step(self._solver, since)

    def _crossing(
        self, surface: SwitchingSurface, side: float | None, t: float, y: list[float], rates: list[float]
    ) -> tuple[float, float] | None:
        """Return where the last step, from ``t`` on, crossed a surface, and the sign of its value beyond; or None.

        ``side`` is the sign at ``t`` if the step began on the surface, where the value is only rounding error.
        """
        on_surface = side is not None
        if on_surface and surface.trend is None:
            return None  # after one step it is on one side again
        if side is None:
            side = math.copysign(1.0, surface.value(y))
        crossed = side * surface.value(self.y.tolist()) < 0.0
        dips = surface.trend is not None and side * surface.trend(y, rates) < 0.0 < side * surface.trend(
            self.y.tolist(), self.rates.tolist()
        )
        if not crossed and not dips:
            return None
        dense = self.dense_output()

        def inside(tau: float) -> float:
            return side * surface.value(dense(tau).tolist())

        first, last = t, self.t
        if not crossed or on_surface:
            sign = -1.0 if crossed else 1.0  # away from the surface and back, or towards it and back
            span = {"bounds": (t, self.t), "method": "bounded", "options": {"xatol": 1e-9 * (last - first)}}
            extreme = float(minimize_scalar(lambda tau: sign * inside(tau), **span).x)
            first, last = (extreme, last) if crossed else (first, extreme)
        if not inside(first) > 0.0 > inside(last):
            return None
        return float(brentq(inside, first, last, rtol=TIGHTEST)), -side

    def _start(self, t: float, y: FloatArray, end: float, first_step: float | None = None) -> None:
        first_step = None if first_step is None else min(first_step, end - t)
        self._dense = None
        if self._scales is not None:
            self._solver = Radau(self._rates, t, y, end, first_step or end - t, self._tolerated, self._scales)
            return
        self._solver = self._explicit(t, y, end, first_step)

    def _explicit(
        self, t: float, y: FloatArray, end: float, first_step: float | None, most: float = math.inf
    ) -> Explicit:
        solver = Explicit(self._rates, t, y, end, first_step, self._tolerated, most)
        self._run.evaluations += solver.nfev
        return solver
