"""Periodic orbits by shooting, with any engine's ``simulate``.

The angle of a disc drops out on an isotropic contact: what comes back after a period are place, velocity and
spin. Without offset everything looks the same from all directions, and a motion may come back turned about the axis.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.optimize import minimize_scalar

from reference_model.contact.contact_law import isotropic_contact_of, require_whole
from reference_model.simulation import simulate as reference_simulate
from reference_model.steady.steady_states import Whirl, whirls, why_no_whirl
from reference_model.systems import (
    ANGLE,
    DiscOnDisc,
    FloatArray,
    System,
    checked_state,
    finite_number,
    require_system,
)
from reference_model.trajectory import Trajectory

Simulate = Callable[..., Trajectory]

X, Y, VX, VY, SPIN = range(5)
"""Places in the part of the state that an orbit is about; a pin has no spin."""

PERIOD, LOAD, TURN = -3, -2, -1
"""Places behind that part in the unknowns of shooting: T, μN, and the angle θ of a turn about the axis."""

CENTRAL = 3e-4
"""Relative step of the central differences of fourth order that give multipliers.

Measured against the exponentials of the turning frame's eigenvalues and against the variational equations: the noise
of the flow over the step, and its fourth power, are alike here for the whirl of Fig. 11 with an offset, the worst
case. Multipliers are right to 1e-11 for the pin, 1e-9 for the disc without offset; with one to 1e-7 by the reference,
and to 1e-5 by an engine of which a tolerance of 1e-12 leaves more noise.
"""

BRANCH_STEP = 0.08
"""Relative step in x along the branch of whirls."""

MOST_ITERATIONS = 25

CONVERGED = 1e-9
"""Largest relative miss of an orbit; Newton's method goes on below it until rounding stops it."""

SLOW = 0.3
"""Part of the miss that may be left after an iteration; with more, the derivatives are taken anew."""

FARTHEST_PERIOD = 0.5
"""Relative change of the period beyond which an orbit is no longer near to the guess."""

COLLAPSED = 1e-6
"""Size relative to the guess below which an orbit is no longer near to it: a pin that sticks on the axis has none."""

RECURRENCE = 0.05
"""Largest relative difference of two states between which a motion is taken to have come round."""

LEAST_MODULATION = 1e-6
"""Swing of the radius, as a fraction of it, that tells a modulated cycle from a whirl found to ``CONVERGED``."""


@dataclass(frozen=True)
class Flow:
    """The return map of an engine, and its derivatives, over unknowns (x, y, vx, vy, spin of a disc, T, μN, θ)."""

    simulate: Simulate
    system: System
    tolerance: float

    def unknowns(self, state: FloatArray, period: float, load: float, turn: float) -> FloatArray:
        """Return the unknowns of the motion that starts from ``state``, shape (4,) or (6,)."""
        return np.array([*_without_angle(state), period, load, turn])

    def start(self, unknowns: FloatArray) -> FloatArray:
        """Return the state, shape (4,) or (6,), from which the motion of ``unknowns`` starts; its angle is zero."""
        part = unknowns[:PERIOD]
        return np.insert(part, 2, 0.0) if isinstance(self.system, DiscOnDisc) else part.copy()

    def miss(self, unknowns: FloatArray) -> FloatArray:
        """Return Φ_T(state), turned back by θ, less the state, shape (4,) or (5,)."""
        system = replace(self.system, friction_force=float(unknowns[LOAD]))
        times = [0.0, float(unknowns[PERIOD])]
        end = self.simulate(system, self.start(unknowns), times, tolerance=self.tolerance).at_end
        return _turned(_without_angle(end), -float(unknowns[TURN])) - unknowns[:PERIOD]

    def slopes(self, unknowns: FloatArray, miss: FloatArray, sought: list[int]) -> FloatArray:
        """Return the derivatives of ``miss`` by the ``sought`` unknowns, by forward differences."""
        step = math.sqrt(self.tolerance)  # balances the curvature of the map against its noise
        columns = []
        for i in sought:
            shifted = unknowns.copy()
            shifted[i] += step * self.size(unknowns)[i]
            columns.append((self.miss(shifted) - miss) / (shifted[i] - unknowns[i]))
        return np.column_stack(columns)

    def monodromy(self, unknowns: FloatArray) -> FloatArray:
        """Return the linearised return map, shape (4, 4) or (5, 5), by central differences of fourth order."""
        n = len(unknowns[:PERIOD])
        steps = np.zeros((n, len(unknowns)))
        steps[:, :n] = CENTRAL * np.diag(self.size(unknowns)[:n])
        near, far = (
            np.column_stack(
                [self.miss(unknowns + step) - self.miss(unknowns - step) for step in reach * steps]
            )
            / (2.0 * reach * np.diag(steps))
            for reach in (1.0, 2.0)
        )
        return near + (near - far) / 3.0 + np.eye(n)

    def size(self, unknowns: FloatArray) -> FloatArray:
        """Return by what deviations of the unknowns are to be judged."""
        size = np.abs(unknowns)
        size[:PERIOD] = _size(self.system, unknowns[:PERIOD])
        if size[TURN] > 0.0:  # many turns in a period: one of them counts
            size[PERIOD] /= size[TURN]
            size[TURN] = 1.0
        return size


@dataclass(frozen=True, eq=False)
class Orbit:
    """A periodic motion.

    Parameters
    ----------
    system : PinOnDisc or DiscOnDisc
        The parameters.
    state : array of shape (4,) or (6,)
        Where the orbit starts: it crosses the x axis there, y = 0, unless it was found from a guess that starts
        elsewhere. The angle of a disc is zero.
    period : float
        In s.
    residual : float
        Distance by which the orbit misses its start, relative to its size.
    trajectory : Trajectory
        One period at equally spaced times, both ends included.
    flow : Flow
        The return map that it was found with.
    turn : float
        Angle in rad by which the motion has turned about the axis after a period, whole turns included; 0 where
        it comes back to the very same place.

    """

    system: System
    state: FloatArray
    period: float
    residual: float
    trajectory: Trajectory
    flow: Flow
    turn: float = 0.0

    @property
    def frequency(self) -> float:
        """2π/period in rad/s."""
        return 2.0 * math.pi / self.period

    @property
    def carrier(self) -> float:
        """Mean speed in rad/s at which a motion that comes back turned goes about the axis."""
        return self.turn / self.period

    @property
    def mean(self) -> FloatArray:
        """Time mean of x and y in m, shape (2,); for a period the trapezoidal rule is exact to rounding."""
        return np.asarray(self.trajectory.states[:-1, :2].mean(axis=0))

    def from_the_right(self) -> Orbit:
        """Return the same orbit, started at the sample where x is greatest.

        As a guess for the next one it serves whether or not they cross the x axis: it crosses its own y at a right
        angle there.
        """
        states = self.trajectory.states
        state = self.flow.start(np.array([*_without_angle(states[np.argmax(states[:, 0])]), 0.0, 0.0, 0.0]))
        trajectory = self.flow.simulate(
            self.system, state, self.trajectory.times, tolerance=self.flow.tolerance
        )
        return replace(self, state=state, trajectory=trajectory)

    @cached_property
    def monodromy(self) -> FloatArray:
        """The linearised return map, shape (4, 4) or (5, 5), over x, y, vx, vy and the spin of a disc."""
        unknowns = self.flow.unknowns(self.state, self.period, self.system.friction_force, self.turn)
        return self.flow.monodromy(unknowns)

    @cached_property
    def multipliers(self) -> tuple[complex, ...]:
        """Eigenvalues of the linearised return map (Floquet multipliers), largest first.

        One of them is 1, that of a shift in time; if the motion comes back turned, a turn is another.
        """
        multipliers = np.linalg.eigvals(self.monodromy)
        return tuple(complex(multiplier) for multiplier in sorted(multipliers, key=abs, reverse=True))

    @property
    def stable(self) -> bool:
        """Whether all small deviations die out but for a shift in time and a turn about the axis."""
        shifts = 1 if self.turn == 0.0 else 2
        nearest_to_one = sorted(self.multipliers, key=lambda multiplier: abs(multiplier - 1.0))
        return all(abs(multiplier) < 1.0 for multiplier in nearest_to_one[shifts:])


def whirl_orbit(
    system: System,
    *,
    simulate: Simulate = reference_simulate,
    guess: Orbit | Whirl | None = None,
    at_crossing: float | None = None,
    tolerance: float = 1e-12,
    samples: int = 256,
) -> Orbit:
    """Return the whirl of a pin or disc with an offset, a periodic orbit near to a circle, by shooting.

    Newton's method on x, vx, vy, the spin of a disc and the period T for Φ_T(x, y, vx, vy) = (x, y, vx, vy), with
    the derivatives of the flow Φ from differences. The phase is fixed by y, which stays that of the guess: 0 unless
    the guess starts elsewhere. Orbits with stick phases are found as well: nothing but ``simulate`` is asked for.

    Parameters
    ----------
    system : PinOnDisc or DiscOnDisc
        The parameters, with a whirl without offset: |ω| > k on a linear support.
    simulate : callable
        The engine; of the reference unless told otherwise. ``functools.partial(simulate, contact=...)`` is that
        of a disc under another law.
    guess : Orbit or Whirl, optional
        Where to start, such as the orbit for a nearby load; unless told otherwise, the largest circle that there
        is without offset. With a large offset the whirl of a disc no longer crosses the x axis: then it takes that
        of a nearby offset, :meth:`Orbit.from_the_right`.
    at_crossing : float, optional
        If given, x at y = 0 is held at this value in m and the load μN is sought in its place. This goes round the
        folds of the branch, where two whirls of the same load meet.
    tolerance : float
        Handed to ``simulate``.
    samples : int
        Intervals of the returned trajectory.

    Raises
    ------
    ValueError
        If there is no circle to start from, or if a disc rests on single points.
    RuntimeError
        If Newton's method does not converge: there is no such orbit near the guess.

    """
    _check(system, guess, (Orbit, Whirl, type(None)), at_crossing, samples)
    if guess is None:
        guess = _largest_circle(replace(system, offset=0.0))
    period = guess.period if isinstance(guess, Orbit) else 2.0 * math.pi / abs(guess.frequency)
    flow = Flow(simulate, system, tolerance)
    unknowns = flow.unknowns(guess.state, period, system.friction_force, 0.0)
    sought = [X, *range(VX, len(unknowns[:PERIOD])), PERIOD]
    if at_crossing is not None:
        _hold_crossing(at_crossing, guess, unknowns, sought)
    return _shoot(flow, unknowns, sought, samples, "whirl")


def modulated_cycle(
    system: System,
    guess: Trajectory | Orbit,
    *,
    simulate: Simulate = reference_simulate,
    at_crossing: float | None = None,
    tolerance: float = 1e-12,
    samples: int = 1024,
) -> Orbit:
    """Return the cycle of a whirl whose radius swells and shrinks, X0 = 0 only, by shooting (Fig. 11).

    Two frequencies are in it, that of the modulation and the carrier. But without offset it is periodic but for a
    turn: after the period T of the modulation all is the same turned about the axis by an angle θ. The orbit starts
    where the radius is largest or smallest, y = 0 and vx = 0, and Newton's method solves for x, vy, spin, T and θ.

    Parameters
    ----------
    system : PinOnDisc or DiscOnDisc
        The parameters.
    guess : Trajectory or Orbit
        Where to start: a simulation that has come near to the cycle in its end, over more than a period of the
        modulation and at times close enough to resolve a turn; or the cycle of nearby parameters.
    simulate, at_crossing, tolerance, samples
        As in :func:`whirl_orbit`.

    Raises
    ------
    ValueError
        If the offset is not zero, if a disc rests on single points, or if ``guess`` does not come round.
    RuntimeError
        If Newton's method does not converge, or finds a whirl of constant radius: there is no such cycle near the
        guess.

    """
    _check(system, guess, (Orbit, Trajectory), at_crossing, samples)
    if system.offset != 0.0:
        raise ValueError(
            f"offset = {system.offset:g} m: a modulated cycle comes back turned about the axis, which takes an "
            "offset of 0"
        )
    if isinstance(guess, Trajectory):
        state, period, turn = _recurrence(guess)
    else:
        state, period, turn = guess.state, guess.period, guess.turn
    flow = Flow(simulate, system, tolerance)
    unknowns = flow.unknowns(state, period, system.friction_force, turn)
    unknowns[[Y, VX]] = 0.0
    sought = [X, *range(VY, len(unknowns[:PERIOD])), PERIOD, TURN]
    if at_crossing is not None:
        _hold_crossing(at_crossing, guess, unknowns, sought)
    orbit = _shoot(flow, unknowns, sought, samples, "modulated cycle")
    radius = orbit.trajectory.radius
    if np.ptp(radius) < LEAST_MODULATION * np.max(radius):
        raise RuntimeError(
            f"no modulated cycle near the guess for friction_force = {system.friction_force:g} N: shooting found a "
            f"whirl of constant radius {radius[0]:g} m"
        )
    return orbit


def _shoot(flow: Flow, unknowns: FloatArray, sought: list[int], samples: int, what: str) -> Orbit:
    """Solve for the ``sought`` unknowns by Newton's method, or Broyden's where it will do; return the orbit."""
    scale, period = flow.size(unknowns)[:PERIOD], float(unknowns[PERIOD])
    best, smallest = unknowns, math.inf
    units = flow.size(unknowns)[sought]
    step: FloatArray = np.zeros(len(sought))
    slopes: FloatArray | None = None
    last = math.inf
    for _ in range(MOST_ITERATIONS):
        near = abs(unknowns[PERIOD] / period - 1.0) < FARTHEST_PERIOD
        near = near and np.max(np.abs(unknowns[:PERIOD]) / scale) > COLLAPSED
        if not (near and unknowns[LOAD] > 0.0 and np.all(np.isfinite(unknowns))):
            break
        miss = flow.miss(unknowns)
        size = float(np.max(np.abs(miss) / scale))
        if smallest < CONVERGED and size >= 0.5 * smallest:
            break  # rounding is reached
        if size < smallest:
            best, smallest = unknowns, size
        if slopes is None or size > SLOW * last:
            slopes = flow.slopes(unknowns, miss, sought)
        else:  # Broyden's update: the last step should have brought the miss to zero
            slopes += np.outer(miss, step / units) / float(step @ step)
        units = flow.size(unknowns)[sought]
        try:
            step = np.asarray(-np.linalg.solve(slopes * units, miss))
        except np.linalg.LinAlgError:
            break  # no direction to go on in
        last, unknowns = size, unknowns.copy()
        unknowns[sought] += units * step
    if not smallest < CONVERGED:
        raise RuntimeError(
            f"no {what} near the guess for friction_force = {unknowns[LOAD]:g} N, disc_speed = "
            f"{flow.system.disc_speed:g} rad/s: shooting stopped at a relative miss of {smallest:.1e}; "
            "start from the orbit of a nearby load; one that does not cross "
            f"y = {unknowns[Y]:g} m takes a guess that starts elsewhere"
        )
    period, load, turn = (float(value) for value in best[PERIOD:])
    system, state = replace(flow.system, friction_force=load), flow.start(best)
    trajectory = flow.simulate(system, state, np.linspace(0.0, period, samples + 1), tolerance=flow.tolerance)
    return Orbit(system, state, period, smallest, trajectory, flow, turn)


def _hold_crossing(x: float, guess: object, unknowns: FloatArray, sought: list[int]) -> None:
    """Hold x at y = 0 and seek the load in its place, from that of a ``guess`` that is an orbit."""
    unknowns[[X, Y]] = x, 0.0
    sought[sought.index(X)] = LOAD
    if isinstance(guess, Orbit):
        unknowns[LOAD] = guess.system.friction_force


def _check(
    system: System, guess: object, guesses: tuple[type, ...], at_crossing: float | None, samples: int
) -> None:
    """Refuse what shooting can't start from."""
    require_system(system)
    if isinstance(system, DiscOnDisc):
        isotropic_contact_of(system, None, "periodic orbits")
    require_whole("samples", samples, least=1)
    if at_crossing is not None:
        finite_number("at_crossing", at_crossing)
    if not isinstance(guess, guesses):
        names = " or ".join("None" if kind is type(None) else kind.__name__ for kind in guesses)
        raise ValueError(f"guess = {guess!r}: it must be of {names}")
    if isinstance(guess, Orbit | Whirl):
        checked_state(system, guess.state)
    elif isinstance(guess, Trajectory):
        checked_state(system, guess.at_end)


def _largest_circle(system: System) -> Whirl:
    found = whirls(system)
    if not found:
        raise ValueError(why_no_whirl(system))
    return found[0]


def _recurrence(trajectory: Trajectory) -> tuple[FloatArray, float, float]:
    """Return state, period and turn of the last round between two like maxima of the radius.

    The state is turned so that the centre lies on the x axis. Raises ``ValueError`` if there is no such round.
    """
    states, times = trajectory.states, trajectory.times
    velocities = trajectory.system.state_size // 2
    z = states[:, 0] + 1j * states[:, 1]
    v = states[:, velocities] + 1j * states[:, velocities + 1]
    outward = (z.conjugate() * v).real
    maxima = np.flatnonzero((outward[:-1] > 0.0) & (outward[1:] <= 0.0))
    angles = np.unwrap(np.angle(z))
    if len(maxima):
        last = _turned(_without_angle(states[maxima[-1]]), -float(angles[maxima[-1]]))
        for i in maxima[-2::-1]:
            before = _turned(_without_angle(states[i]), -float(angles[i]))
            if np.all(np.abs(last - before) < RECURRENCE * _size(trajectory.system, last)):
                period = float(times[maxima[-1]] - times[i])
                state = np.insert(last, 2, 0.0) if len(last) > SPIN else last
                return state, period, float(angles[maxima[-1]] - angles[i])
    raise ValueError(
        f"the trajectory does not come round by t = {times[-1]:g} s: no two of {len(maxima)} maxima of its radius "
        "are alike; simulate longer, or start nearer to the cycle"
    )


def _without_angle(state: FloatArray) -> FloatArray:
    """Return x, y, vx, vy and the spin of a disc."""
    return np.delete(state, ANGLE) if len(state) == DiscOnDisc.state_size else np.array(state)


def _size(system: System, part: FloatArray) -> FloatArray:
    """Return by what deviations of the state without an angle are to be judged, of the same shape."""
    size = np.full(len(part), np.max(np.abs(part[:SPIN])))
    if isinstance(system, DiscOnDisc):  # the speed of the rim counts like that of the centre
        size[SPIN] /= system.contact_radius
    return size


def _turned(part: FloatArray, angle: float) -> FloatArray:
    """Return the state without an angle, turned about the axis by ``angle`` in rad."""
    z, v = (complex(part[i], part[i + 1]) * cmath.exp(1j * angle) for i in (X, VX))
    return np.array([z.real, z.imag, v.real, v.imag, *part[SPIN:]])


def whirl_branch(
    orbit: Orbit, until: float, *, step: float = BRANCH_STEP, samples: int = 64
) -> Iterator[Orbit]:
    """Yield ``orbit``, a whirl or a modulated cycle, and those of other loads that continue it, by decreasing x.

    x is where they cross the axis. Each is sought from the line through the two before it, for a fall in x by the
    fraction ``step``; where Newton's method fails, half of that is tried. The load rises or falls along the
    branch as it will, and stick phases may come in.

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
    seek = whirl_orbit if orbit.turn == 0.0 else modulated_cycle
    before, last = None, orbit
    yield last
    fraction = step
    while last.state[0] > until:
        x = max(until, last.state[0] * (1.0 - fraction))
        try:
            found = seek(
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
        turn=last.turn + ahead * (last.turn - before.turn),
    )


def last_whirl(
    system: System,
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
