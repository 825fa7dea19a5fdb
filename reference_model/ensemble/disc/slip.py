"""Slip of a disc in lanes: eq. 19 to 21 in stretched time, and its end, rest and beginning.

The unknowns are x, y, u, r and φ of :mod:`reference_model.core.forces.rates`, and η = R/κ. In the stretched time
dτ = dt·(s + s₀)/s, s² = |u|² + r², the equations are smooth and not stiff down to s = 0.
"""

import math

import numpy as np

from reference_model.core.steps.collocation import NODES
from reference_model.core.stiff import FIRST_SPAN, LEAST_SPAN, RISING
from reference_model.ensemble.core.contact_shares import LEAST, ring_shares
from reference_model.ensemble.core.jit import inlined, scalar
from reference_model.ensemble.core.laws import (
    DiscLaw,
    PinLaw,
    points_friction,
    pull,
    release_delay,
    ring_friction,
)
from reference_model.ensemble.core.stepping.implicit import (
    INTEGRAL,
    PLACES,
    SERIES,
    collocate_ring,
    position_after,
)
from reference_model.ensemble.core.stepping.linear import length_of, zeros
from reference_model.ensemble.core.stepping.runge_kutta import Tuple
from reference_model.systems import FloatArray

HALVINGS = 60
"""Number of bisections of an interval of order one, down to rounding."""

ANGLES = 64
"""Number of angles in the search for the direction of slip."""


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


@scalar
def stuck_for(z: complex, held: float, law: DiscLaw) -> float:
    """Return how long a disc on a ring rests at ``z`` if friction can hold the force ``held``."""
    if held < 0.0 or abs(pull(z, 0j, law)) > held:
        return 0.0
    return release_delay(z, centre_of(law, held))


@inlined
def centre_of(law: DiscLaw, held: float) -> PinLaw:
    """Return the pin with the friction ``held`` that sticks where the disc on a ring does."""
    return PinLaw(law.stiffness, law.damping, held, law.disc_speed, law.offset, 0.0, 0.0)


@scalar
def direction(z: complex, law: DiscLaw) -> tuple[complex, float, float, float]:
    """Return the direction (n_u, n_r) of incipient slip, its growth rate, and the share lost to friction."""
    towards = pull(z, 0j, law)
    strength = abs(towards)
    best, fastest = 0.0, -math.inf
    for i in range(ANGLES + 1):
        beta = math.pi * (i / ANGLES - 0.5)
        along = _growth(beta, strength, law)[0]
        if along > fastest:
            best, fastest = beta, along
    low, high = max(best - math.pi / ANGLES, -0.5 * math.pi), min(best + math.pi / ANGLES, 0.5 * math.pi)
    if _growth(low, strength, law)[1] > 0.0 > _growth(high, strength, law)[1]:
        for _ in range(HALVINGS):
            best = 0.5 * (low + high)
            if _growth(best, strength, law)[1] > 0.0:
                low = best
            else:
                high = best
    along, _, taken = _growth(best, strength, law)
    if strength == 0.0:
        return complex(math.cos(best)), math.sin(best), along, taken
    return (math.cos(best) / strength) * towards, math.sin(best), along, taken


@scalar
def _growth(beta: float, strength: float, law: DiscLaw) -> tuple[float, float, float]:
    """Return the components of a − g∇P along and across n = (cos β along the pull, sin β), and g·P(n)."""
    c, s = math.cos(beta), math.sin(beta)
    fx, _, fr, power = ring_friction(c, 0.0, s, 0.0, law)
    force = strength + law.friction * fx
    moment = -law.shaft_rate * law.lag + law.friction * fr
    return force * c + moment * s, moment * c - force * s, law.friction * power


# --- Slip from rest, as in :mod:`reference_model.core.stiff`

ACCURACY = 1e-12
"""Allowed scaled contribution of the last terms of the polynomials."""


@scalar
def grown(
    z: complex, n: complex, turning: float, first: float, longest: float, law: DiscLaw
) -> tuple[complex, complex, float, float, float, float]:
    """Return position, slip, rotation, duration and work of slip that begins at ``z`` along (``n``, ``turning``).

    It ends where an explicit method can continue, or after ``longest``. ``first`` is the initial rate of slip. The
    rotation is relative to the master disc, times κ; the work is that of friction per newton. The duration is zero if
    the motion could not be resolved.
    """
    carried = 1j * law.disc_speed
    change = -(law.stiffness + (law.damping + carried) * carried) * carried * z
    gain = (n.conjugate() * change).real
    along = np.array((n.real, n.imag, turning))
    start, rate = zeros(3), zeros(3)
    for k in range(3):
        rate[k] = first * along[k]
    w, f, power = zeros(NODES * 3).reshape(NODES, 3), zeros(NODES * 3).reshape(NODES, 3), zeros(NODES)
    t = turn = work = outward = 0.0
    step = FIRST_SPAN
    while t < longest:
        step = min(step, longest - t)
        for i in range(NODES):
            delay = step * PLACES[i]
            for k in range(3):
                w[i, k] = start[k] + delay * (rate[k] + 0.5 * delay * gain * along[k])
        stiffness = collocate_ring(z, 0.0, start, step, law, w, f, power)
        error = step * _last_terms(f) if stiffness >= 0.0 else math.inf
        if not error < ACCURACY:
            step *= max(0.25, 0.8 * (ACCURACY / error) ** (1.0 / NODES))
            if step < LEAST_SPAN:
                return z, 0j, 0.0, 0.0, 0.0, 0.0
            continue
        there = position_after(z, w, step, law)
        goes = (complex(w[-1, 0], w[-1, 1]) * there.conjugate()).real
        if goes * outward < 0.0:
            break  # at an extreme of the radius, which must be recorded
        z, outward = there, goes
        for j in range(NODES):
            turn += step * INTEGRAL[-1, j] * w[j, 2]
            work += step * INTEGRAL[-1, j] * power[j]
        t += step
        s, rising = length_of(w[-1]), 0.0
        for k in range(3):
            start[k], rate[k], along[k] = w[-1, k], f[-1, k], w[-1, k] / s
            rising += along[k] * rate[k]
        if rising <= 0.0 or step * stiffness < RISING:
            break
        step *= min(4.0, 0.8 * (ACCURACY / max(error, 1e-30)) ** (1.0 / NODES))
    return z, complex(start[0], start[1]), start[2], t, turn, work


@scalar
def _last_terms(f: FloatArray) -> float:
    largest = 0.0
    for row in (NODES - 2, NODES - 1):
        for k in range(3):
            term = 0.0
            for j in range(NODES):
                term += SERIES[row, j] * f[j, k]
            largest = max(largest, abs(term))
    return largest
