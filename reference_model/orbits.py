"""Periodic orbits by shooting, with any engine's ``simulate``."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.optimize import minimize_scalar

from reference_model.integrate import simulate as reference_simulate
from reference_model.pin_formulas import whirl_frequency, whirl_radius
from reference_model.systems import FloatArray, PinOnDisc
from reference_model.trajectory import Trajectory

Simulate = Callable[..., Trajectory]

DIFFERENCE = 1e-5
"""Relative step of the differences from which the linearised return map is built."""

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

    def derivatives(self, unknowns: FloatArray) -> FloatArray:
        """Return the derivatives of the miss, shape (4, 6), by central differences."""
        size = np.abs(unknowns)
        size[:4] = np.max(size[:4])
        columns = []
        for i, step in enumerate(DIFFERENCE * size):
            shift = np.zeros(6)
            shift[i] = step
            columns.append((self.miss(unknowns + shift) - self.miss(unknowns - shift)) / (2.0 * step))
        return np.column_stack(columns)


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
        multipliers = np.linalg.eigvals(self.flow.derivatives(unknowns)[:, :4] + np.eye(4))
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
    of the flow Φ from central differences. Orbits with stick phases are found as well: nothing but
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
    derivatives = None
    for _ in range(MOST_ITERATIONS):
        if not (unknowns[4] > 0.0 and unknowns[5] > 0.0 and np.all(np.isfinite(unknowns))):
            break
        miss = flow.miss(unknowns)
        size = float(np.max(np.abs(miss))) / scale
        if smallest < CONVERGED and size > 0.5 * smallest:
            break  # rounding is reached
        if size < smallest:
            best, smallest = unknowns, size
        if derivatives is None or size > FRESH:
            derivatives = flow.derivatives(unknowns)
        unknowns = unknowns.copy()
        unknowns[sought] -= np.linalg.solve(derivatives[:, sought], miss)
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


def last_whirl(
    system: PinOnDisc, *, simulate: Simulate = reference_simulate, tolerance: float = 1e-12
) -> Orbit:
    """Return the whirl at the smallest load for which there is one: the fold of the branch.

    There the whirl meets the unstable one that separates it from the other motions, and below it neither
    exists. The paper does not give this load. The branch is followed from the load of ``system`` downwards;
    its fold is the minimum of the load over the crossing x.

    Raises
    ------
    RuntimeError
        If the branch has no fold between the load of ``system`` and zero slip.

    """
    orbit = whirl_orbit(system, simulate=simulate, tolerance=tolerance, samples=2)

    def at(x: float) -> Orbit:
        nonlocal orbit
        orbit = whirl_orbit(
            system, simulate=simulate, guess=orbit, at_crossing=x, tolerance=tolerance, samples=2
        )
        return orbit

    x = [float(orbit.state[0])]
    loads = [orbit.system.friction_force]
    while len(loads) < 2 or loads[-1] < loads[-2]:
        x.append(x[-1] * (1.0 - BRANCH_STEP))
        loads.append(at(x[-1]).system.friction_force)
    # Where the branch folds at once, in its first step, the bracket is the step itself.
    bracket = tuple(x[-3:]) if len(x) > 2 else (2.0 * x[0] - x[1], x[0], x[1])
    best = minimize_scalar(lambda crossing: at(crossing).system.friction_force, bracket=bracket, tol=1e-5)
    return whirl_orbit(system, simulate=simulate, guess=orbit, at_crossing=float(best.x), tolerance=tolerance)
