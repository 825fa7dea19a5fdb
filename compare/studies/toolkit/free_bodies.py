"""Bodies that slide and spin freely until they rest: a ring thrown on a table, by integrals over another variable.

With slip U of the centre, rim speed W = R|φ̇|, g = μN/m and c = J/(mR²), (19) without springs, dampers and shaft is

    U' = −g·F,  W' = −g·G/c,  F = ∂P/∂U, G = ∂P/∂W,

and F and G depend on ε = U/W only. So δ = ln ε alone obeys W·δ' = −g·q(δ), q = F/ε − G/c: the zero δ* of q attracts,
and ln W, time and distance are integrals over δ. They are taken over u = ln|δ − δ*| down to where δ has come so near
to δ* that it may count as constant. The speed N = ε*·U + c·W, which falls with g·P(ε*, 1) then, does so with an error
of second order only, because F and G are derivatives of one function: N/(g·P) is the time that is left.

There is a δ* for 1/2 < c < 2.

Speeds are in m/s here, lengths in m, and g is 1 m/s²: times and distances are those for μN = m·g.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from reference_model.contact.elliptic import mean_directions
from reference_model.systems import FloatArray

NEAR = 1e-7
"""|δ − δ*| from which on δ counts as constant: the square of it is the error, as a fraction of the time left."""

LARGEST = 40.0
"""|δ| within which the terminal ratio is sought."""


class Stop(NamedTuple):
    """When a ring rests, how far it has slid and its rim has turned by then, and how long δ counted as constant."""

    time: float
    slid: float
    turned: float
    left: float


@dataclass(frozen=True)
class Slowing:
    """How a free ring slows down.

    Parameters
    ----------
    inertia : float
        c = J/(mR²), between 1/2 and 2.

    """

    inertia: float

    def unevenness(self, delta: float) -> float:
        """Return q(δ), zero where both speeds fall in the same proportion."""
        along_slip, along_rim = mean_directions(math.exp(delta), 1.0)
        return along_slip * math.exp(-delta) - along_rim / self.inertia

    @cached_property
    def terminal(self) -> float:
        """δ*, the logarithm of the ratio of sliding to rim speed in the end."""
        if self.inertia == 1.0:
            return 0.0
        return float(brentq(self.unevenness, -LARGEST, LARGEST, xtol=1e-15))

    def stop(self, sliding: float, rim: float, near: float = NEAR) -> Stop:
        """Return time and ways until the ring rests, from U > 0 and W > 0 in m/s at the start.

        ``near`` is the |δ − δ*| from which on δ counts as constant.
        """
        begin = math.log(sliding / rim)
        side = math.copysign(1.0, begin - self.terminal)
        first, last = math.log(abs(begin - self.terminal)), math.log(near)

        def at(u: float) -> tuple[float, float]:
            """Return ε and −g·dt/W : du."""
            away = side * math.exp(u)
            delta = self.terminal + away
            return math.exp(delta), away / self.unevenness(delta)

        def rates(u: float, passed: FloatArray) -> tuple[float, float, float, float]:
            """Return by du those of ln W, of the time and of both ways."""
            (ratio, duration), rim = at(u), math.exp(passed[0])
            along_rim = mean_directions(ratio, 1.0)[1]
            time = -rim * duration
            return along_rim / self.inertia * duration, time, time * ratio * rim, time * rim

        # Where both speeds are equal the slopes of friction are infinite: an edge of the integrals.
        edges = [first, *([math.log(abs(self.terminal))] if begin * self.terminal < 0.0 else []), last]
        passed = np.array([math.log(rim), 0.0, 0.0, 0.0])
        for span in itertools.pairwise(edges):
            passed = solve_ivp(rates, span, passed, method="LSODA", rtol=1e-13, atol=1e-15).y[:, -1]
        rim, total = math.exp(passed[0]), passed[1:]
        # From here on the speeds are as if in the terminal ratio, with the same N.
        terminal = math.exp(self.terminal)
        _, along_rim = mean_directions(terminal, 1.0)
        rim *= (terminal * at(last)[0] + self.inertia) / (terminal**2 + self.inertia)
        left = self.inertia * rim / along_rim
        total = total + left * np.array([1.0, 0.5 * terminal * rim, 0.5 * rim])
        time, slid, turned = total.tolist()
        return Stop(time, slid, turned, left)
