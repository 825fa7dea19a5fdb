"""Exact motion of a joint with dry friction: closed forms between events.

While the joint turns one way, friction is constant, and the applied moment is linear in time between its points. With
γ = β/2J and κ = C/J, the motion is a combination of g₁, the response of the spin to a unit impulse, and its integrals
g₂ and g₃.
"""

import bisect
import itertools
import math
import time
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from reference_model.numerics.roots import zero_between
from reference_model.systems import (
    MOST,
    FloatArray,
    checked_times,
    checked_tolerance,
    finite_numbers,
)
from reference_model.systems.joint import FrictionJoint
from reference_model.trajectory import MOST_STEPS, Kind, SimulationError, Solution, Trajectory, phases_of

SMALL, TERMS = 1.0, 24
"""Largest 2γτ and √κ·τ for the power series of the responses, and its number of terms: the next is below 1e-20."""

APART = 2.0
"""Ratio of γ² to κ above which the two decay rates differ enough for divided differences."""


def simulate_joint(
    joint: FrictionJoint, initial_state: ArrayLike, times: ArrayLike, tolerance: float
) -> Trajectory:
    """Return the motion of a joint, which is exact at any ``tolerance``; see :func:`reference_model.simulate`."""
    state, moments = finite_numbers("initial_state", initial_state), checked_times(times)
    if state.shape != (2,) or np.any(abs(state) > MOST):
        raise ValueError(
            f"initial_state = {state.tolist()}: a joint takes an angle and a spin, of a size up to {MOST:g}"
        )
    began, (angle, spin) = time.perf_counter(), state.tolist()
    run = _Run(joint, float(moments[0]), angle, spin, float(moments[-1]))
    states = run.states(moments)
    solution = Solution(
        "closed form", checked_tolerance(tolerance), 0, len(run.pieces), time.perf_counter() - began
    )
    return Trajectory(joint, moments, states, phases_of(run.begun(), float(moments[-1])), solution)


class _Responses(NamedTuple):
    """g₁ and its integrals g₂, g₃, where J·g₁'' + β·g₁' + C·g₁ = 0 with g₁(0) = 0 and g₁'(0) = 1."""

    first: FloatArray
    second: FloatArray
    third: FloatArray


def _responses(gamma: float, kappa: float, times: FloatArray) -> _Responses:
    small = np.maximum(2.0 * gamma, math.sqrt(kappa)) * times <= SMALL
    found = np.empty((3, len(times)))
    found[:, small] = _series(gamma, kappa, times[small])
    late = times[~small]
    if gamma**2 > APART * kappa:
        fast = -gamma - math.sqrt(gamma**2 - kappa)
        slow = kappa / fast
        found[:, ~small] = (_integrals(slow, late) - _integrals(fast, late)) / (slow - fast)
    else:
        first, turned = _waves(gamma, kappa, late)
        second = (1.0 - turned - gamma * first) / kappa
        found[:, ~small] = first, second, (late - first - 2.0 * gamma * second) / kappa
    return _Responses(*found)


def _waves(gamma: float, kappa: float, times: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return exp(−γt)·sin(wt)/w and exp(−γt)·cos(wt) with w² = κ − γ² of either sign."""
    square = kappa - gamma**2
    wave = math.sqrt(abs(square))
    if square >= 0.0:
        decay = np.exp(-gamma * times)
        return decay * times * np.sinc(wave * times / math.pi), decay * np.cos(wave * times)
    slow, apart = np.exp(-kappa / (gamma + wave) * times), -2.0 * wave * times
    return -slow * np.expm1(apart) / (2.0 * wave), 0.5 * slow * (1.0 + np.exp(apart))


def _series(gamma: float, kappa: float, times: FloatArray) -> FloatArray:
    """Return g₁, g₂, g₃ by their power series, shape (3, n)."""
    term, before = times.copy(), np.zeros_like(times)
    found = np.zeros((3, len(times)))
    for n in range(1, TERMS):
        found += term * np.array([np.ones_like(times), times / (n + 1), times**2 / ((n + 1) * (n + 2))])
        # n·(n + 1)·aₙ₊₁ = −2γ·n·aₙ − κ·aₙ₋₁
        term, before = -(2.0 * gamma * n * term * times + kappa * before * times**2) / (n * (n + 1)), term
    return found


def _integrals(rate: float, times: FloatArray) -> FloatArray:
    """Return exp(rate·t) and its first two integrals, shape (3, n), for rate <= 0 of any size."""
    x = rate * times
    once, twice = np.ones_like(x), np.full_like(x, 0.5)
    np.divide(np.expm1(x), x, out=once, where=x != 0.0)
    near = abs(x) < 0.5
    np.divide(once - 1.0, x, out=twice, where=~near)
    twice[near] = sum(x[near] ** n / math.factorial(n + 2) for n in range(14))
    return np.array([np.exp(x), times * once, times**2 * twice])


@dataclass(frozen=True)
class _Piece:
    """Motion from ``start`` (s) on with friction of constant direction (0: stick) and a linear applied moment."""

    joint: FrictionJoint
    start: float
    angle: float
    spin: float
    direction: int
    acceleration: float = 0.0
    rate: float = 0.0  # of the applied moment, in N m/s

    @property
    def _rates(self) -> tuple[float, float]:
        return self.joint.damping / (2.0 * self.joint.inertia), self.joint.stiffness / self.joint.inertia

    def states(self, times: FloatArray) -> FloatArray:
        """Return angle and spin, shape (n, 2)."""
        if self.direction == 0:
            return np.tile((self.angle, 0.0), (len(times), 1))
        (gamma, kappa), push = self._rates, self.rate / self.joint.inertia
        g = _responses(gamma, kappa, times - self.start)
        way = self.spin * (g.first + 2.0 * gamma * g.second)
        way += self.acceleration * g.second + push * g.third
        spin = self.spin * (1.0 - kappa * g.second) + self.acceleration * g.first + push * g.second
        return np.column_stack((self.angle + way, spin))

    def stop(self, end: float) -> float:
        """Return the time in s when the spin first reaches zero, or infinity if that is later than ``end``.

        Between the zeros of the acceleration, the spin is monotone. Its first minimum is the lowest, because nothing
        excites the oscillation about the linear part.
        """

        def spin(time: float) -> float:
            return self.direction * float(self.states(np.array([time]))[0, 1])

        turns = [self.start + time for time in self._turns() if self.start + time < end]
        speeds_up = self.direction * (self.acceleration or self._jerk) > 0.0
        nodes = [*(turns if speeds_up else [self.start, *turns]), end]
        for before, after in itertools.pairwise(nodes):
            if spin(before) > 0.0 >= spin(after):
                return zero_between(spin, before, after)
        return math.inf

    @property
    def _jerk(self) -> float:
        """Initial rate of the acceleration in rad/s³."""
        gamma, kappa = self._rates
        return self.rate / self.joint.inertia - kappa * self.spin - 2.0 * gamma * self.acceleration

    def _turns(self) -> list[float]:
        """Return the first zeros of the acceleration, at most two, in s after the start.

        It is exp(−γt)·(a·cos wt + b·sin wt/w) with w² = κ − γ².
        """
        gamma, kappa = self._rates
        a, drive = self.acceleration, self.rate / self.joint.inertia - kappa * self.spin
        square = kappa - gamma**2
        wave = math.sqrt(abs(square))
        if square > 0.0:
            first = math.atan2(-a * wave, drive - gamma * a) % math.pi / wave
            return [time for n in range(3) if (time := first + n * math.pi / wave) > 0.0][:2]
        # the part that decays most slowly, without cancellation
        slow = drive - (a * kappa / (gamma + wave) if gamma > 0.0 else 0.0)
        if a * slow >= 0.0:
            return []
        slope = -a / slow
        return [math.log1p(2.0 * slope * wave) / (2.0 * wave) if wave > 0.0 else slope]


class _Run:
    """Pieces of the motion of a joint from ``start`` to ``end`` (s)."""

    def __init__(self, joint: FrictionJoint, start: float, angle: float, spin: float, end: float) -> None:
        self.joint, self.end = joint, end
        self.pieces: list[_Piece] = []
        bends = [point for point, _ in joint.moment if start < point < end]
        at, direction, gone = start, int(np.sign(spin)), False
        for bend in [*bends, end]:
            while at < bend:
                if len(self.pieces) >= MOST_STEPS:
                    raise SimulationError(f"more than {MOST_STEPS:,} events up to t = {at:g} s")
                at, angle, spin, direction, gone = self._piece(at, angle, spin, direction, gone, bend)
        if not self.pieces:  # a single time
            self.pieces.append(_Piece(joint, start, angle, spin, direction))

    def _piece(
        self, at: float, angle: float, spin: float, direction: int, gone: bool, bend: float
    ) -> tuple[float, float, float, int, bool]:
        """Append a piece that begins ``at`` (s); return its end in s, the state there, and ``gone``.

        ``gone`` is True if the joint has just been released, so that rounding cannot hold it again.
        """
        joint = self.joint
        applied, later = joint.applied(at), joint.applied(bend)
        rate = (later - applied) / (bend - at)
        load = applied - joint.stiffness * (angle - joint.offset)
        limit = joint.breakaway_moment
        if direction == 0 and not gone and abs(load) <= limit:
            self.pieces.append(_Piece(joint, at, angle, 0.0, 0))
            sign = math.copysign(1.0, rate)
            if sign * (load + rate * (bend - at)) <= limit:
                return bend, angle, 0.0, 0, False
            release = at + (limit - sign * load) / abs(rate)
            return (release, angle, 0.0, 0, True) if release < bend else (bend, angle, 0.0, 0, False)
        if direction == 0:
            direction = int(math.copysign(1.0, rate if gone else load))
            load = direction * max(direction * load, limit)
        acceleration = (load - direction * joint.friction_moment - joint.damping * spin) / joint.inertia
        piece = _Piece(joint, at, angle, spin, direction, acceleration, rate)
        self.pieces.append(piece)
        stop = piece.stop(bend)
        ((angle, spin),) = piece.states(np.array([min(stop, bend)])).tolist()
        return (stop, angle, 0.0, 0, False) if stop <= bend else (bend, angle, spin, direction, False)

    def states(self, times: FloatArray) -> FloatArray:
        """Return angle and spin, shape (n, 2)."""
        starts = [piece.start for piece in self.pieces]
        owners = np.array([bisect.bisect_right(starts, time) - 1 for time in times.tolist()])
        found = np.empty((len(times), 2))
        for i in np.unique(owners).tolist():
            found[owners == i] = self.pieces[i].states(times[owners == i])
        return found

    def begun(self) -> list[tuple[Kind, float, FloatArray]]:
        """Return kind, start and first state of each phase; a reversal does not end a phase."""
        found: list[tuple[Kind, float, FloatArray]] = []
        for piece in self.pieces:
            kind: Kind = "slip" if piece.direction else "stick"
            if not found or found[-1][0] != kind:
                found.append((kind, piece.start, np.array([piece.angle, piece.spin])))
        return found
