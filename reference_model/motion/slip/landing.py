"""How slip comes to rest where friction can hardly hold the body: polynomials in the slip speed, down to zero.

There slip s falls slowly, and its direction n is drawn much faster to where friction is opposite to what is left
of the pull. So n and the time are smooth functions of s, up to the end, which no method in ln s can reach and no
explicit one in long steps. So s is what is integrated over, by the same collocation as elsewhere
(:mod:`reference_model.numerics.collocation`), with s·dn/ds on the left side: at s = 0, the last node, n is where it
rests. Where slip falls as fast as n turns, n is no smooth function of s, and this is not for it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.polynomial import legendre

from reference_model.motion.slip.coordinates import LEAST_SLIP, Coordinates, Leave, Outcome
from reference_model.motion.stepper import Run
from reference_model.numerics.collocation import (
    CONVERGED,
    DERIVATIVE,
    FROM_START,
    NODES,
    POINTS,
    Polynomial,
    jacobians_at,
)
from reference_model.systems import FloatArray

SLAVED = 1.0
"""Change of the direction while slip falls to 1/e of it, up to which a polynomial may reach to the end."""

AGAIN = 0.25
"""Share of the slip speed at a trial that failed, at which there is another one."""

MOST_ITERATIONS = 8

DRAWN = 8.0
"""Friction over the rate at which slip falls, from which n is drawn to its limit so fast that it is seen as smooth.

What is left of any other direction falls like a power of s, with that less one as its exponent.
"""

FAR = 0.5
"""Change of the direction by an iteration, which begins with that at first, from which there is no hope."""

LOOSEST = 1e-3
"""The largest error of the direction, of which the time of the end depends in second order only."""

LEAST_SHARE = 0.3
"""Share of the slip by which a piece has to fall, to be worth what it costs."""


class Landings:
    """Trials to follow slip to its end at once, as it falls.

    Parameters
    ----------
    run : Run
        The simulation.
    motion : Coordinates
        Those of the slip.
    leave : callable
        Tells whether the motion is to be described in another way.

    """

    def __init__(self, run: Run, motion: Coordinates, leave: Leave) -> None:
        """Begin without a trial."""
        self._run, self._motion, self._leave = run, motion, leave
        self._below = math.inf

    def attempt(self, t: float, y: list[float]) -> Outcome | None:
        """Return where slip ends if that is next, or how far it could be followed; None if not at all from ``y``."""
        if not 0.0 < self._motion.speed(y) < min(self._below, self._motion.slow(y)):
            return None
        reached = None
        while (piece := self._piece(y)) is not None:
            run = self._run
            run.count_step(t)
            run.record(t + piece.duration, partial(piece.standard, t))
            t += piece.duration
            y = piece.unknowns(np.ones(1))[:, 0].tolist()
            if piece.share == 1.0:
                return Outcome(t, [*y[: -self._motion.slip], *[0.0] * self._motion.slip])
            reached = Outcome(t, y)
            if t >= run.end:
                break
        self._below = AGAIN * self._motion.speed(y)
        return reached

    def _piece(self, y: list[float]) -> _Piece | None:
        """Return how slip falls from ``y`` by as much as one polynomial can tell; None if that is too little."""
        s, d = self._motion.speed(y), self._motion.slip
        growth = self._motion.rates(y)[-d:]
        n = [part / s for part in y[-d:]]
        falling = -sum(a * b for a, b in zip(n, growth, strict=True))
        across = math.hypot(*(a + falling * b for a, b in zip(growth, n, strict=True)))
        if falling <= s * self._motion.pace or across > SLAVED * falling:
            return None  # slip may grow again, or its direction changes too much
        turned = self._motion.rates([*y[:-d], *[-part for part in y[-d:]]])[-d:]
        against = 0.5 * sum(a * (b - c) for a, b, c in zip(n, turned, growth, strict=True))
        if against < DRAWN * falling:
            return None
        share = 1.0
        while share >= LEAST_SHARE:
            piece = _collocate(self._run, self._motion, y, share)
            if piece is None:
                share *= 0.5
            elif piece.error > 1.0:
                share *= 0.8 * piece.error ** (-1.0 / NODES)
            else:
                return None if self._interrupted(y, piece) else piece
        return None

    def _interrupted(self, y: list[float], piece: _Piece) -> bool:
        """Tell whether slip is to be described in another way before it ends."""
        motion = self._motion
        sides = [math.copysign(1.0, surface.value(y)) for surface in motion.surfaces]
        for later in piece.unknowns(POINTS).T.tolist():
            beyond = any(
                side * surface.value(later) < 0.0
                for side, surface in zip(sides, motion.surfaces, strict=True)
            )
            if beyond or self._leave(later) or (motion.grip is not None and motion.grip(later) <= 0.0):
                return True
        return False


@dataclass(frozen=True, eq=False)
class _Piece:
    """Slip that falls by a share of itself; places are −1 where the piece begins and 1 where it ends.

    Parameters
    ----------
    motion : Coordinates
        Those of the slip.
    speed : float
        Of the slip where it begins.
    share : float
        By which it falls.
    error : float
        What the last terms of the polynomial contribute, over what is tolerated.
    polynomial : Polynomial
        Unknowns but for the slip, its direction, and the time since it began, over the places.

    """

    motion: Coordinates
    speed: float
    share: float
    error: float
    polynomial: Polynomial

    @property
    def duration(self) -> float:
        """Time to the end."""
        return float(self.polynomial(1.0)[-1])

    def unknowns(self, places: FloatArray) -> FloatArray:
        """Return the unknowns at places (n,), shape (unknowns, n)."""
        left = 1.0 - 0.5 * self.share * (1.0 + places)
        return _unknowns(self.polynomial(places), self.speed * left, self.motion.slip)

    def standard(self, begun: float, times: FloatArray) -> FloatArray:
        """Return the standard unknowns at times (n,) of the piece if it has ``begun`` then."""
        delays = times - begun
        coefficients = self.polynomial.coefficients[:, -1]
        slope = legendre.legder(coefficients)
        places = 2.0 * delays / self.duration - 1.0
        for _ in range(MOST_ITERATIONS):  # time grows with the place, almost in proportion
            late = legendre.legval(places, coefficients) - delays
            places = np.clip(places - late / legendre.legval(places, slope), -1.0, 1.0)
        return self.motion.standard(self.unknowns(places))


def _unknowns(landing: FloatArray, speeds: FloatArray, slip: int) -> FloatArray:
    """Return the unknowns for those of a landing, (n, k), and slip speeds (k,), shape (unknowns, k)."""
    n = landing[-1 - slip : -1]
    slips = np.maximum(speeds, LEAST_SLIP) * n / np.sqrt((n * n).sum(axis=0))
    return np.vstack((landing[: -1 - slip], slips))


@np.errstate(over="ignore", divide="ignore", invalid="ignore")  # of a trial, which is given up for that
def _collocate(run: Run, motion: Coordinates, y: list[float], share: float) -> _Piece | None:
    """Solve for the unknowns while slip falls by ``share`` by Newton's method; None if it does not converge."""
    d, speed = motion.slip, motion.speed(y)
    others = len(y) - d
    start = np.array([*y[:others], *[part / speed for part in y[others:]], 0.0])
    direction = slice(others, others + d)

    def changes_at(values: FloatArray) -> FloatArray:
        """Return the derivatives by the share that slip has lost, of n by ln s, for unknowns and share left."""
        landing, left = values[:-1], values[-1]
        rates = motion.rates_at(_unknowns(landing, speed * left, d))
        run.evaluations += values.shape[1]
        n = landing[direction]
        length = (n * n).sum(axis=0)
        growth = rates[others:]
        along = (growth * n).sum(axis=0) / length
        result = np.zeros_like(values)
        result[:others] = -speed * rates[:others] / along
        # Of n by ln s; its length is drawn to one, and stays there.
        result[direction] = (along * n - growth) / along - (length - 1.0) * n
        result[-2] = -speed / along
        return result

    lost = 0.5 * share * (1.0 + POINTS)
    nodes = np.column_stack((np.tile(start, (NODES, 1)), 1.0 - lost))
    values = start + np.outer(lost, changes_at(np.append(start, 1.0)[:, np.newaxis])[:-1, 0])
    weights = np.ones_like(values)  # of the derivatives
    weights[:, direction] = 1.0 - lost[:, np.newaxis]
    weights /= share
    tolerated = run.local_tolerance * (1.0 + abs(start))
    tolerated[direction] = min(run.local_tolerance / speed, LOOSEST)
    for _ in range(MOST_ITERATIONS):
        nodes[:, :-1] = values
        found = changes_at(nodes.T).T
        if not np.all(np.isfinite(found)):
            return None
        jacobians = jacobians_at(changes_at, nodes, found, motion.differences(nodes))[:, :-1, :-1]
        residual = weights * (DERIVATIVE @ np.vstack((start, values))) - found[:, :-1]
        matrix = np.einsum("ij,ik,kl->ikjl", DERIVATIVE[:, 1:], weights, np.eye(len(start)))
        matrix[range(NODES), :, range(NODES)] -= jacobians
        try:
            change = np.linalg.solve(matrix.reshape(values.size, -1), residual.ravel()).reshape(values.shape)
        except np.linalg.LinAlgError:
            return None
        values = values - change
        if np.max(abs(change[:, direction])) > FAR:
            return None
        if np.all(abs(change) < CONVERGED * tolerated):
            break
    else:
        return None
    if np.any(np.diff(values[:, -1]) <= 0.0):
        return None
    coefficients = FROM_START @ np.vstack((start, values))
    error = float(np.max(abs(coefficients[-2:]) / tolerated))
    return _Piece(motion, speed, share, error, Polynomial(-1.0, 1.0, coefficients))
