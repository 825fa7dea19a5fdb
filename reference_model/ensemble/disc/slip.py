"""Slip of a disc in lanes: eq. 19 to 21 in stretched time.

The unknowns are x, y, u, r and φ of :mod:`reference_model.core.forces.rates`, and η = R/κ. In the stretched time
dτ = dt·(s + s₀)/s, s² = |u|² + r², the equations are smooth and not stiff down to s = 0.
"""

import math

from reference_model.ensemble.core.contact_shares import LEAST, ring_shares
from reference_model.ensemble.core.jit import inlined, scalar
from reference_model.ensemble.core.laws import DiscLaw, points_friction, ring_friction
from reference_model.ensemble.core.stepping.runge_kutta import Tuple

HALVINGS = 60
"""Number of bisections of an interval of order one, down to rounding."""


@inlined
def _rates(y: Tuple, law: DiscLaw, friction: tuple[float, float, float, float]) -> Tuple:
    x, y_, ux, uy, r, _ = y
    fx, fy, fr, power = friction
    s = math.sqrt(ux * ux + uy * uy + r * r)
    share = (s + law.free) / (s + law.stretching)
    g, spin = law.friction, law.disc_speed + law.curling * r
    vx, vy = ux - law.disc_speed * y_, uy + law.disc_speed * x
    ax = -law.stiffness * (x - law.offset) - law.damping * vx + law.disc_speed * vy + g * fx
    ay = -law.stiffness * y_ - law.damping * vy - law.disc_speed * vx + g * fy
    ar = -law.shaft_rate * (r + law.lag) + g * fr
    return share * vx, share * vy, share * ax, share * ay, share * ar, share * spin, share, share * power


@inlined
def ring_rates(y: Tuple, law: DiscLaw) -> Tuple:
    """Return the rates of the unknowns in stretched time, then dt/dτ and P·dt/dτ."""
    return _rates(y, law, ring_friction(y[2], y[3], y[4], y[5], law))


@inlined
def points_rates(y: Tuple, law: DiscLaw) -> Tuple:
    return _rates(y, law, points_friction(y[2], y[3], y[4], y[5], law))


@inlined
def ring_edge(y: Tuple, rates: Tuple, law: DiscLaw) -> tuple[float, float]:
    """Return U − η|r| and its rate; at zero a point of the ring rests and friction has infinite slopes."""
    _, _, ux, uy, r, _ = y
    u, w = math.sqrt(ux * ux + uy * uy), abs(r)
    rate = (ux * rates[2] + uy * rates[3]) / max(u, LEAST) - law.leverage * r * rates[4] / max(w, LEAST)
    return u - law.leverage * w, rate


@inlined
def no_edge(y: Tuple, rates: Tuple, law: DiscLaw) -> tuple[float, float]:
    """Return a constant edge, for friction that is smooth except at rest."""
    return 1.0, 0.0


@scalar
def held_friction(law: DiscLaw) -> float:
    """Return the force that friction of a ring can hold with the shaft's moment, or -1."""
    needed = law.shaft_rate * abs(law.lag)
    most = law.friction * law.leverage
    if needed > most:
        return -1.0
    low, high = 0.0, 0.5 * math.pi
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if most * ring_shares(math.cos(middle), math.sin(middle))[1] < needed:
            low = middle
        else:
            high = middle
    share: float = law.friction * ring_shares(math.cos(high), math.sin(high))[0]
    return share
