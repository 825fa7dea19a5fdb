"""Periodic orbits by shooting, with any engine's ``simulate``.

With an isotropic contact the angle of a disc drops out: position, velocity and spin recur after a period, without
offset up to a rotation about the axis.

Newton's method is written out, because ``scipy.optimize.root`` fails only after 51 to 63 simulations, compared with
10 to 16 here.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from reference_model.contact.contact_law import isotropic_contact_of
from reference_model.simulation import simulate
from reference_model.steady.steady_states import Whirl
from reference_model.systems import (
    ANGLE,
    DiscOnDisc,
    FloatArray,
    System,
    checked_state,
    checked_tolerance,
    finite_number,
    require_callable,
    require_system,
    require_whole,
)
from reference_model.trajectory import Trajectory

Simulate = Callable[..., Trajectory]

REFERENCE: Simulate = simulate
"""Default engine, compiled because an orbit takes up to about a hundred simulations."""

X, Y, VX, VY, SPIN = range(5)
"""Indices of the state without angle; a pin lacks the spin."""

PERIOD, LOAD, TURN = -3, -2, -1
"""Indices of the other unknowns of shooting: T, μN, and the angle θ of a rotation about the axis."""

CENTRAL = 3e-4
"""Relative step of the central differences for multipliers.

The measured error is 1e-11 for the pin, 1e-9 for the disc without offset and 1e-7 with an offset.
"""

MOST_ITERATIONS = 25

CONVERGED = 1e-9
"""Largest relative residual of an orbit; Newton's method continues until rounding stops it."""

SMOOTH = 0.1
"""Largest residual as a multiple of the tolerance, because adaptive steps depend on the start in jumps."""

ABOVE_NOISE = 10.0
"""Largest residual as a multiple of the engine's precision, which enters a residual several times."""

SLOW = 0.3
"""Share of the residual that may remain after an iteration before new derivatives are needed."""

FARTHEST_PERIOD = 0.5
"""Largest relative change of the period of an orbit near the guess."""

UNRESOLVED = 1e-6
"""Largest amplitude of the harmonics beyond a third of the number of samples, relative to the largest amplitude.

The harmonic with the number of the samples, which the trapezoidal rule takes for a mean, is smaller.
"""

COLLAPSED = 1e-6
"""Smallest size relative to the guess, below which the pin has collapsed onto the axis."""


MOST_NOISE = 1e-2
"""Largest relative noise of the states with an orbit that can still be found."""


@dataclass(frozen=True)
class ShootingProblem:
    """The return map of an engine and its derivatives for the unknowns (x, y, vx, vy, spin of a disc, T, μN, θ).

    ``precision`` is the relative noise of the states.
    """

    simulate: Simulate
    system: System
    tolerance: float
    precision: float = 0.0

    def __post_init__(self) -> None:
        require_callable("simulate", self.simulate, "system", "initial_state", "times", named=["tolerance"])
        checked_tolerance(self.tolerance)
        if not 0.0 <= finite_number("precision", self.precision) <= MOST_NOISE:
            raise ValueError(f"precision = {self.precision:g}: it must lie between 0 and {MOST_NOISE:g}")

    @property
    def converged(self) -> float:
        """Largest relative residual of an orbit."""
        return max(CONVERGED, SMOOTH * self.tolerance, ABOVE_NOISE * self.precision)

    def unknowns(self, state: FloatArray, period: float, load: float, turn: float) -> FloatArray:
        """Return the unknowns of the motion from ``state``, shape (4,) or (6,)."""
        return np.array([*without_angle(state), period, load, turn])

    def start(self, unknowns: FloatArray) -> FloatArray:
        """Return the initial state, shape (4,) or (6,), with the angle zero."""
        part = unknowns[:PERIOD]
        return np.insert(part, 2, 0.0) if isinstance(self.system, DiscOnDisc) else part.copy()

    def miss(self, unknowns: FloatArray) -> FloatArray:
        """Return the residual Φ_T(state), rotated back by θ, minus the state, shape (4,) or (5,)."""
        system = replace(self.system, friction_force=float(unknowns[LOAD]))
        times = [0.0, float(unknowns[PERIOD])]
        end = self.simulate(system, self.start(unknowns), times, tolerance=self.tolerance).at_end
        return rotated(without_angle(end), -float(unknowns[TURN])) - unknowns[:PERIOD]

    def slopes(self, unknowns: FloatArray, miss: FloatArray, sought: list[int]) -> FloatArray:
        """Return the derivatives of ``miss`` with respect to the ``sought`` unknowns."""
        step = math.sqrt(max(self.tolerance, self.precision))  # balances curvature and noise
        columns = []
        for i in sought:
            shifted = unknowns.copy()
            shifted[i] += step * self.size(unknowns)[i]
            columns.append((self.miss(shifted) - miss) / (shifted[i] - unknowns[i]))
        return np.column_stack(columns)

    def monodromy(self, unknowns: FloatArray) -> FloatArray:
        """Return the linearised return map, shape (4, 4) or (5, 5), by fourth-order central differences."""
        n = len(unknowns[:PERIOD])
        steps = np.zeros((n, len(unknowns)))
        steps[:, :n] = max(CENTRAL, self.precision**0.2) * np.diag(self.size(unknowns)[:n])
        near, far = (
            np.column_stack(
                [self.miss(unknowns + step) - self.miss(unknowns - step) for step in reach * steps]
            )
            / (2.0 * reach * np.diag(steps))
            for reach in (1.0, 2.0)
        )
        return near + (near - far) / 3.0 + np.eye(n)

    def size(self, unknowns: FloatArray) -> FloatArray:
        """Return the scales of the unknowns."""
        size = np.abs(unknowns)
        size[:PERIOD] = size_of(self.system, unknowns[:PERIOD])
        if size[TURN] > 0.0:  # one turn sets the scale of many
            size[PERIOD] /= size[TURN]
            size[TURN] = 1.0
        return size


@dataclass(frozen=True, eq=False)
class Orbit:
    """A periodic motion; its ``trajectory`` is one period at equally spaced times, both ends included.

    ``state``, shape (4,) or (6,), is the initial state, with the angle zero. ``period`` is in s. ``residual`` is the
    distance between start and end relative to the size of the orbit. ``turn`` is the rotation about the axis in a
    period, in
    rad, including whole turns; 0 if the motion recurs without rotation.
    """

    system: System
    state: FloatArray
    period: float
    residual: float
    trajectory: Trajectory
    problem: ShootingProblem
    turn: float = 0.0

    @property
    def frequency(self) -> float:
        """2π/period in rad/s."""
        return 2.0 * math.pi / self.period

    @property
    def carrier(self) -> float:
        """Mean angular velocity about the axis in rad/s of a motion that recurs up to a rotation."""
        return self.turn / self.period

    @property
    def mean(self) -> FloatArray:
        """Time mean of x and y in m, shape (2,), by the trapezoidal rule over the samples of a period.

        The error is below a millionth of the orbit's size, and at most rounding for a smooth orbit with many samples.
        For a coarse engine it is below the root of the tolerance, because the samples show single steps.
        Raises ``ValueError`` if there are too few samples, or if the orbit recurs only after a rotation.
        """
        if self.turn != 0.0:
            raise ValueError(
                f"turn = {self.turn:g} rad: the mean needs an orbit that recurs without rotation"
            )
        x, y = self.trajectory.states[:-1, :2].T
        size = np.abs(np.fft.fft(x + 1j * y))
        high = np.abs(np.fft.fftfreq(len(x))) >= 1.0 / 3.0
        rough = max(UNRESOLVED, math.sqrt(self.problem.tolerance), ABOVE_NOISE * self.problem.precision)
        if len(x) < 3 or np.max(size[high]) > rough * np.max(size):
            raise ValueError(f"samples = {len(x)}: too few for the mean of this orbit; increase samples")
        return np.array([x.mean(), y.mean()])

    def from_the_right(self) -> Orbit:
        """Return the same orbit, started at the sample with the largest x.

        It crosses its own y at a right angle there, so it is a guess for the next orbit even away from the x axis.
        """
        states = self.trajectory.states
        state = self.problem.start(np.array([*without_angle(states[np.argmax(states[:, 0])]), 0.0, 0.0, 0.0]))
        trajectory = self.problem.simulate(
            self.system, state, self.trajectory.times, tolerance=self.problem.tolerance
        )
        return replace(self, state=state, trajectory=trajectory)

    @cached_property
    def monodromy(self) -> FloatArray:
        """The linearised return map, shape (4, 4) or (5, 5), in x, y, vx, vy and the spin of a disc."""
        unknowns = self.problem.unknowns(self.state, self.period, self.system.friction_force, self.turn)
        return self.problem.monodromy(unknowns)

    @cached_property
    def multipliers(self) -> tuple[complex, ...]:
        """Floquet multipliers, largest first.

        One multiplier is 1, for a shift in time; a second is 1 if the motion recurs up to a rotation.
        """
        multipliers = np.linalg.eigvals(self.monodromy)
        return tuple(complex(multiplier) for multiplier in sorted(multipliers, key=abs, reverse=True))

    @property
    def stable(self) -> bool:
        """True if all small deviations decay, apart from a shift in time and a rotation about the axis."""
        shifts = 1 if self.turn == 0.0 else 2
        nearest_to_one = sorted(self.multipliers, key=lambda multiplier: abs(multiplier - 1.0))
        return all(abs(multiplier) < 1.0 for multiplier in nearest_to_one[shifts:])


class NoOrbitError(RuntimeError):
    """Shooting found no periodic orbit near its guess.

    ``residual`` is the smallest relative miss, infinite if the unknowns left the neighbourhood of the guess.
    """

    def __init__(self, message: str, residual: float = math.inf) -> None:
        super().__init__(message)
        self.residual = residual


def shoot(
    problem: ShootingProblem, unknowns: FloatArray, sought: list[int], samples: int, what: str
) -> Orbit:
    """Solve for the ``sought`` unknowns by Newton's method with Broyden updates; return the orbit.

    Raises ``NoOrbitError`` if it does not converge.
    """
    scale, period = problem.size(unknowns)[:PERIOD], float(unknowns[PERIOD])
    best, smallest = unknowns, math.inf
    units = problem.size(unknowns)[sought]
    step: FloatArray = np.zeros(len(sought))
    slopes: FloatArray | None = None
    last, left = math.inf, False
    for _ in range(MOST_ITERATIONS):
        near = abs(unknowns[PERIOD] / period - 1.0) < FARTHEST_PERIOD
        near = near and np.max(np.abs(unknowns[:PERIOD]) / scale) > COLLAPSED
        left = not (near and unknowns[LOAD] > 0.0 and np.all(np.isfinite(unknowns)))
        if left:
            break
        miss = problem.miss(unknowns)
        size = float(np.max(np.abs(miss) / scale))
        if smallest < problem.converged and size >= 0.5 * smallest:
            break
        if size < smallest:
            best, smallest = unknowns, size
        if slopes is None or size > SLOW * last:
            slopes = problem.slopes(unknowns, miss, sought)
        else:  # Broyden's update: the last step should have made the residual zero
            slopes += np.outer(miss, step / units) / float(step @ step)
        units = problem.size(unknowns)[sought]
        try:
            step = np.asarray(-np.linalg.solve(slopes * units, miss))
        except np.linalg.LinAlgError:
            break  # no descent direction
        last, unknowns = size, unknowns.copy()
        unknowns[sought] += units * step
    if not smallest < problem.converged:
        raise NoOrbitError(
            f"no {what} near the guess for friction_force = {unknowns[LOAD]:g} N, disc_speed = "
            f"{problem.system.disc_speed:g} rad/s: shooting stopped at a relative residual of {smallest:.1e}; "
            "start from the orbit of a nearby load; if it does not cross "
            f"y = {unknowns[Y]:g} m, from one that starts elsewhere",
            math.inf if left else smallest,
        )
    period, load, turn = (float(value) for value in best[PERIOD:])
    system, state = replace(problem.system, friction_force=load), problem.start(best)
    trajectory = problem.simulate(
        system, state, np.linspace(0.0, period, samples + 1), tolerance=problem.tolerance
    )
    return Orbit(system, state, period, smallest, trajectory, problem, turn)


def hold_crossing(x: float, guess: object, unknowns: FloatArray, sought: list[int]) -> None:
    """Fix x at y = 0 and make the load unknown, starting from the load of the orbit ``guess``."""
    unknowns[[X, Y]] = x, 0.0
    sought[sought.index(X)] = LOAD
    if isinstance(guess, Orbit):
        unknowns[LOAD] = guess.system.friction_force


def require_start(
    system: System, guess: object, guesses: tuple[type, ...], at_crossing: float | None, samples: int
) -> None:
    """Raise ``ValueError`` for an unsuitable system or guess."""
    require_system(system)
    if isinstance(system, DiscOnDisc):
        isotropic_contact_of(system, None, "periodic orbits")
    require_whole("samples", samples, least=1)
    if at_crossing is not None:
        finite_number("at_crossing", at_crossing)
    if not isinstance(guess, guesses):
        names = " or ".join("None" if kind is type(None) else kind.__name__ for kind in guesses)
        raise ValueError(f"guess = {guess!r}: it must be {names}")
    if isinstance(guess, Orbit | Whirl):
        checked_state(system, guess.state, "guess")
    elif isinstance(guess, Trajectory):
        checked_state(system, guess.at_end, "guess")


def without_angle(state: FloatArray) -> FloatArray:
    """Return x, y, vx, vy and, for a disc, the spin."""
    return np.delete(state, ANGLE) if len(state) == DiscOnDisc.state_size else np.array(state)


def size_of(system: System, part: FloatArray) -> FloatArray:
    """Return the scales of the state without angle, of the same shape."""
    size = np.full(len(part), np.max(np.abs(part[:SPIN])))
    if isinstance(system, DiscOnDisc):  # the speed of the rim counts like the speed of the centre
        size[SPIN] /= system.contact_radius
    return size


def rotated(part: FloatArray, angle: float) -> FloatArray:
    """Return the state without angle, rotated by ``angle`` in rad."""
    z, v = (complex(part[i], part[i + 1]) * cmath.exp(1j * angle) for i in (X, VX))
    return np.array([z.real, z.imag, v.real, v.imag, *part[SPIN:]])
