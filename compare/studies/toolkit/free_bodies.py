"""Discs that slide and spin freely until they rest.

Let U be the slip of the centre, W = R|φ̇| the rim speed, g = μN/m and c = J/(mR²). Then (19) without springs, dampers
and shaft is

    U' = −g·F,  W' = −g·G/c,  F = ∂P/∂U, G = ∂P/∂W,

and F and G depend only on ε = U/W. So δ = ln ε obeys W·δ' = −g·q(δ), q = F/ε − G/c. The zero δ* of q, which exists
for 1/2 < c < 2, is attracting, and ln W, time and distance are integrals over u = ln|δ − δ*|.

Near δ*, δ counts as constant. Then N = ε*·U + c·W decreases at the rate g·P(ε*, 1), so the remaining time is N/(g·P).
Its error is of second order because F and G are derivatives of one function.

Units are m and s; g = 1.
"""

import itertools
import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from reference_model.contact.elliptic import mean_directions
from reference_model.systems import DiscOnDisc, FloatArray

NEAR = 1e-7
"""|δ − δ*| below which δ counts as constant; its square is the relative error of the remaining time."""

LARGEST = 40.0
"""Largest |δ| in the search for δ*."""


class Stop(NamedTuple):
    """Stopping time, distance slid, distance turned at the rim, and duration of the final phase with constant δ."""

    time: float
    slid: float
    turned: float
    left: float


@dataclass(frozen=True)
class Slowing:
    """Deceleration of a free ring with the inertia c = J/(mR²), between 1/2 and 2."""

    inertia: float

    def unevenness(self, delta: float) -> float:
        """Return q(δ), which is zero if both speeds decrease in proportion."""
        along_slip, along_rim = mean_directions(math.exp(delta), 1.0)
        return along_slip * math.exp(-delta) - along_rim / self.inertia

    @cached_property
    def terminal(self) -> float:
        """δ*, the logarithm of the final ratio U/W."""
        if self.inertia == 1.0:
            return 0.0
        return float(brentq(self.unevenness, -LARGEST, LARGEST, xtol=1e-15))

    def stop(self, sliding: float, rim: float, near: float = NEAR) -> Stop:
        """Return the stopping time and distances, from initial U > 0 and W > 0 (m/s)."""
        begin = math.log(sliding / rim)
        side = math.copysign(1.0, begin - self.terminal)
        first, last = math.log(abs(begin - self.terminal)), math.log(near)

        def at(u: float) -> tuple[float, float]:
            """Return ε and −(g/W)·dt/du."""
            away = side * math.exp(u)
            delta = self.terminal + away
            return math.exp(delta), away / self.unevenness(delta)

        def rates(u: float, passed: FloatArray) -> tuple[float, float, float, float]:
            """Return the derivatives of ln W, time and both distances by u."""
            (ratio, duration), rim = at(u), math.exp(passed[0])
            along_rim = mean_directions(ratio, 1.0)[1]
            time = -rim * duration
            return along_rim / self.inertia * duration, time, time * ratio * rim, time * rim

        # Friction has infinite slopes at equal speeds, so the integration is split there.
        edges = [first, *([math.log(abs(self.terminal))] if begin * self.terminal < 0.0 else []), last]
        passed = np.array([math.log(rim), 0.0, 0.0, 0.0])
        for span in itertools.pairwise(edges):
            passed = solve_ivp(rates, span, passed, method="LSODA", rtol=1e-13, atol=1e-15).y[:, -1]
        rim, total = math.exp(passed[0]), passed[1:]
        # The final phase has the terminal ratio of speeds and the same N.
        terminal = math.exp(self.terminal)
        _, along_rim = mean_directions(terminal, 1.0)
        rim *= (terminal * at(last)[0] + self.inertia) / (terminal**2 + self.inertia)
        left = self.inertia * rim / along_rim
        total = total + left * np.array([1.0, 0.5 * terminal * rim, 0.5 * rim])
        time, slid, turned = total.tolist()
        return Stop(time, slid, turned, left)


def on_a_table(
    mass: float, inertia: float, radius: float, friction: float, points: int | None = None
) -> DiscOnDisc:
    """Return a disc without springs, dampers and shaft on a master disc at rest; ``inertia`` is J/(mR²)."""
    return DiscOnDisc(
        mass=mass,
        polar_inertia=inertia * mass * radius**2,
        stiffness=0.0,
        damping=0.0,
        friction_force=friction,
        disc_speed=0.0,
        contact_radius=radius,
        shaft_damping=0.0,
        shaft_speed=0.0,
        contact_points=points,
    )
