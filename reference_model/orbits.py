"""Periodic orbits by shooting, with any engine's ``simulate``."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.optimize import minimize_scalar

from reference_model.integrate import simulate as reference_simulate
from reference_model.pin_formulas import whirl_frequency, whirl_radius
from reference_model.systems import FloatArray, PinOnDisc
from reference_model.trajectory import Trajectory

Simulate = Callable[..., Trajectory]

CENTRAL = 1e-5
"""Relative step of the central differences that give multipliers."""

BRANCH_STEP = 0.08
"""Relative step in x along the branch of whirls."""

MOST_ITERATIONS = 25

CONVERGED = 1e-9
"""Largest relative miss of an orbit; Newton's method goes on below it until rounding stops it."""

FRESH = 1e-6
"""Relative miss below which the derivatives are good enough to be used again."""


@dataclass(frozen=True)
class Flow:
    """The return map of an engine, and its derivatives, over unknowns (x, y, vx, vy, T, μN)."""

    simulate: Simulate
    system: PinOnDisc
    tolerance: float

    def miss(self, unknowns: FloatArray) -> FloatArray:
        """Return Φ_T(state) − state, shape (4,)."""
        system = replace(self.system, friction_force=float(unknowns[5]))
        times = [0.0, float(unknowns[4])]
        return self.simulate(system, unknowns[:4], times, tolerance=self.tolerance).at_end - unknowns[:4]

    def slopes(self, unknowns: FloatArray, miss: FloatArray, sought: list[int]) -> FloatArray:
        """Return the derivatives of ``miss`` by the ``sought`` unknowns, shape (4, 4), by forward differences."""
        step = math.sqrt(self.tolerance)  # balances the curvature of the map against its noise
        columns = []
        for i in sought:
            shifted = unknowns.copy()
            shifted[i] += step * self._size(unknowns)[i]
            columns.append((self.miss(shifted) - miss) / (shifted[i] - unknowns[i]))
        return np.column_stack(columns)

    def monodromy(self, unknowns: FloatArray) -> FloatArray:
        """Return the linearised return map, shape (4, 4), by central differences."""
        columns = []
        for i in range(4):
            shift = np.zeros(6)
            shift[i] = CENTRAL * self._size(unknowns)[i]
            columns.append((self.miss(unknowns + shift) - self.miss(unknowns - shift)) / (2.0 * shift[i]))
        return np.column_stack(columns) + np.eye(4)

    @staticmethod
    def _size(unknowns: FloatArray) -> FloatArray:
        size = np.abs(unknowns)
        size[:4] = np.max(size[:4])
        return size


@dataclass(frozen=True, eq=False)
class Orbit:
    """A periodic motion.

    Parameters
    ----------
    system : PinOnDisc
        The parameters.
    state : array of shape (4,)
        x, y = 0, vx, vy where the orbit crosses the x axis.
    period : float
        In s.
    residual : float
        Distance by which the orbit misses its start, relative to its size.
    trajectory : Trajectory
        One period at equally spaced times, both ends included.
    flow : Flow
        The return map that it was found with.

    """

    system: PinOnDisc
    state: FloatArray
    period: float
    residual: float
    trajectory: Trajectory
    flow: Flow

    @property
    def frequency(self) -> float:
        """2π/period in rad/s."""
        return 2.0 * math.pi / self.period

    @property
    def mean(self) -> FloatArray:
        """Time mean of x and y in m, shape (2,); for a period the trapezoidal rule is exact to rounding."""
        return np.asarray(self.trajectory.states[:-1, :2].mean(axis=0))

    @cached_property
    def multipliers(self) -> tuple[complex, ...]:
        """Eigenvalues of the linearised return map (Floquet multipliers), largest first; one of them is 1."""
        unknowns = np.array([*self.state, self.period, self.system.friction_force])
        multipliers = np.linalg.eigvals(self.flow.monodromy(unknowns))
        return tuple(complex(multiplier) for multiplier in sorted(multipliers, key=abs, reverse=True))

    @property
    def stable(self) -> bool:
        """Whether all small deviations die out but for a shift in phase."""
        shift = min(self.multipliers, key=lambda multiplier: abs(multiplier - 1.0))
        return all(abs(multiplier) < 1.0 for multiplier in self.multipliers if multiplier is not shift)


def whirl_orbit(
    system: PinOnDisc,
    *,
    simulate: Simulate = reference_simulate,
    guess: Orbit | None = None,
    at_crossing: float | None = None,
    tolerance: float = 1e-12,
    samples: int = 256,
) -> Orbit:
    """Return the whirl of a pin with an offset, a periodic orbit near to the circle of eq. 11, by shooting.

    Newton's method on x, vx, vy and the period T for Φ_T(x, 0, vx, vy) = (x, 0, vx, vy), with the derivatives
    of the flow Φ from differences. Orbits with stick phases are found as well: nothing but
    ``simulate`` is asked for.

    Parameters
    ----------
    system : PinOnDisc
        The parameters, with |ω| > k.
    simulate : callable
        The engine; of the reference unless told otherwise.
    guess : Orbit, optional
        Where to start, such as the orbit for a nearby load; the circle of eq. 11 unless told otherwise.
    at_crossing : float, optional
        If given, x is held at this value in m and the load μN is sought in its place. This goes round the
        folds of the branch, where two whirls of the same load meet.
    tolerance : float
        Handed to ``simulate``.
    samples : int
        Intervals of the returned trajectory.

    Raises
    ------
    ValueError
        If eq. 11 gives no whirl to start from.
    RuntimeError
        If Newton's method does not converge: there is no such orbit near the guess.

    """
    if guess is None:
        radius, frequency = whirl_radius(system), whirl_frequency(system)
        state = np.array([radius, 0.0, 0.0, radius * frequency])
        period, load = 2.0 * math.pi / abs(frequency), system.friction_force
    else:
        state, period = guess.state, guess.period
        load = system.friction_force if at_crossing is None else guess.system.friction_force
    unknowns = np.array([*state, period, load])
    sought = [0, 2, 3, 4]  # x, vx, vy, T
    if at_crossing is not None:
        unknowns[0], sought = at_crossing, [2, 3, 4, 5]  # vx, vy, T, μN
    flow = Flow(simulate, system, tolerance)

    scale = float(np.max(np.abs(state)))
    best, smallest = unknowns, math.inf
    slopes = None
    for _ in range(MOST_ITERATIONS):
        if not (unknowns[4] > 0.0 and unknowns[5] > 0.0 and np.all(np.isfinite(unknowns))):
            break
        miss = flow.miss(unknowns)
        size = float(np.max(np.abs(miss))) / scale
        if smallest < CONVERGED and size > 0.5 * smallest:
            break  # rounding is reached
        if size < smallest:
            best, smallest = unknowns, size
        if slopes is None or size > FRESH:
            slopes = flow.slopes(unknowns, miss, sought)
        unknowns = unknowns.copy()
        try:
            unknowns[sought] -= np.linalg.solve(slopes, miss)
        except np.linalg.LinAlgError:
            break  # no direction to go on in
    if not smallest < CONVERGED:
        raise RuntimeError(
            f"no whirl near the guess for friction_force = {unknowns[5]:g} N, disc_speed = "
            f"{system.disc_speed:g} rad/s: shooting stopped at a relative miss of {smallest:.1e}; "
            "start from the orbit of a nearby load"
        )

    system = replace(system, friction_force=float(best[5]))
    times = np.linspace(0.0, best[4], samples + 1)
    return Orbit(
        system,
        best[:4],
        float(best[4]),
        smallest,
        simulate(system, best[:4], times, tolerance=tolerance),
        flow,
    )


def whirl_branch(
    orbit: Orbit, until: float, *, step: float = BRANCH_STEP, samples: int = 64
) -> Iterator[Orbit]:
    """Yield ``orbit`` and the whirls of other loads that continue it, by decreasing crossing x.

    Each is sought from the line through the two before it, for a fall in x by the fraction ``step``; where
    Newton's method fails, half of that is tried. The load rises or falls along the branch as it will, and
    stick phases may come in.

    Parameters
    ----------
    orbit : Orbit
        Where to start; its engine and tolerance are used for all.
    until : float
        Smallest crossing x in m to go to, > 0.
    step : float
        Largest fraction of x between neighbours.
    samples : int
        Intervals of each trajectory.

    Raises
    ------
    RuntimeError
        If the branch breaks off: if not even a step of ``step``/64 finds an orbit.

    """
    before, last = None, orbit
    yield last
    fraction = step
    while last.state[0] > until:
        x = max(until, last.state[0] * (1.0 - fraction))
        try:
            found = whirl_orbit(
                last.system,
                simulate=last.flow.simulate,
                guess=last if before is None else _extrapolated(before, last, x),
                at_crossing=x,
                tolerance=last.flow.tolerance,
                samples=samples,
            )
        except RuntimeError:
            if fraction < step / 64.0:
                raise
            fraction /= 2.0
            continue
        before, last, fraction = last, found, min(step, 2.0 * fraction)
        yield last


def _extrapolated(before: Orbit, last: Orbit, x: float) -> Orbit:
    """Return a guess for the orbit at the crossing ``x`` on the line through two others."""
    ahead = (x - last.state[0]) / (last.state[0] - before.state[0])
    load = last.system.friction_force + ahead * (last.system.friction_force - before.system.friction_force)
    return replace(
        last,
        system=replace(last.system, friction_force=float(load)),
        state=last.state + ahead * (last.state - before.state),
        period=last.period + ahead * (last.period - before.period),
    )


def last_whirl(
    system: PinOnDisc,
    *,
    simulate: Simulate = reference_simulate,
    guess: Orbit | None = None,
    tolerance: float = 1e-12,
) -> Orbit:
    """Return the whirl at the smallest load for which there is one: the fold of the branch.

    There the whirl meets the unstable one that separates it from the other motions, and below it neither
    exists. The paper does not give this load. The branch is followed from the load of ``system``, or from
    ``guess``, towards the axis; the fold is the minimum of the load over the crossing x.

    Raises
    ------
    ValueError, RuntimeError
        As ``whirl_orbit``: if there is no whirl to start from, or if the branch ends before it folds.

    """
    orbit = guess or whirl_orbit(system, simulate=simulate, tolerance=tolerance, samples=2)

    def load(x: float) -> float:
        nonlocal orbit
        orbit = whirl_orbit(
            system, simulate=simulate, guess=orbit, at_crossing=x, tolerance=tolerance, samples=2
        )
        return orbit.system.friction_force

    first = float(orbit.state[0])
    x, loads = [first * (1.0 + BRANCH_STEP)], [math.inf]
    for follower in whirl_branch(orbit, 0.0, samples=2):
        orbit = follower
        x.append(float(orbit.state[0]))
        loads.append(orbit.system.friction_force)
        if loads[-1] > loads[-2]:
            break
    best = minimize_scalar(load, bracket=tuple(x[-3:]), tol=1e-5)
    return whirl_orbit(system, simulate=simulate, guess=orbit, at_crossing=float(best.x), tolerance=tolerance)
