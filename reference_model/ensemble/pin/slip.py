"""Slip of a pin in lanes: eq. 1 in stretched time, the time to rest, and the start of slip.

The position z = x + iy and the slip velocity w satisfy ż = w + iωz and ẇ = a(z, w) − g·w/|w|. In the stretched time
dτ = dt·(s + s₀)/s, s = |w|, these equations are smooth and not stiff down to s = 0.
"""

import math
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from reference_model.ensemble.core.jit import inlined, scalar, written_out
from reference_model.ensemble.core.laws import CREEP, PinLaw, pull
from reference_model.ensemble.core.stepping.runge_kutta import Tuple
from reference_model.systems import ComplexArray, FloatArray

Number = TypeVar("Number", np.float64, np.complex128)

TERMS, MOST_TERMS = 8, 20
"""Number of terms of the series of incipient slip, usually and where slip stays slow."""

STIFF = 100.0
"""Time, in units of slip speed over g, that slip normally needs to become fast.

Otherwise a longer series replaces many stiff steps.
"""

SLAVED = 0.02
"""Largest ratio of the rate of other changes to the rate g/s of friction, which aligns slip with the pull."""

PLACES = 8
"""Smallest number of points for checking whether the series reaches the end of slip."""


@inlined
def pin_rates(y: Tuple, law: PinLaw) -> Tuple:
    """Return the rates of x, y and the slip velocity in stretched time τ, dt/dτ, and dt/dτ times the slip speed."""
    x, y_, wx, wy = y
    s = math.sqrt(wx * wx + wy * wy)
    pace = 1.0 / (s + law.stretching)
    share = (s + law.free) * pace
    vx = wx - law.disc_speed * y_
    vy = wy + law.disc_speed * x
    ax = -law.stiffness * (x - law.offset) - law.damping * vx + law.disc_speed * vy
    ay = -law.stiffness * y_ - law.damping * vy - law.disc_speed * vx
    f = law.friction * pace
    return share * vx, share * vy, share * ax - f * wx, share * ay - f * wy, share, share * s


@scalar
def time_to_rest(z: complex, w: complex, law: PinLaw, tolerance: float) -> float:
    """Return the time to the end of slip, or inf if it is not yet known to ``tolerance``.

    While a is constant, d(g·s + Re(ā·w))/dt = |a|² − g². So slip ends after (g·s + Re(ā·w))/(g² − |a|²). The change
    of a meanwhile adds ȧ·t²/2 to w.
    """
    g, s = law.friction, abs(w)
    a = pull(z, w, law)
    excess = (g - abs(a)) * (g + abs(a))
    if excess <= 0.0:
        return math.inf
    left = (g * s + (a.conjugate() * w).real) / excess
    v = w + 1j * law.disc_speed * z
    acceleration = a - g * w / s + 1j * law.disc_speed * v
    change = abs((law.damping + 1j * law.disc_speed) * acceleration + law.stiffness * v)
    turn = abs(a) * s  # rotation of the position if the direction of slip reverses
    return left if left * left * (change + turn / s) < tolerance else math.inf


@scalar
def turns_steadily(law: PinLaw) -> bool:
    """Return whether the pull of a pin at rest only rotates with the disc."""
    return law.offset == 0.0 or law.disc_speed == 0.0


@scalar
def creeps_steadily(z: complex, w: complex, law: PinLaw) -> bool:
    """Return whether the slow slip of a pin decays forever without rest; requires :func:`turns_steadily`.

    Its speed s is along the turning pull, whose excess over g at rest is e. They satisfy s' = e − c·s and e' = −K·s,
    K = k² − ω²: a damped oscillator. If it is overdamped and e >= c·s/2 the speed never reaches zero.
    """
    inward = law.stiffness - law.disc_speed**2
    excess = abs(pull(z, 0j, law)) - law.friction
    overdamped = inward > 0.0 and law.damping**2 >= 4.0 * inward
    return overdamped and turns_steadily(law) and 0.5 * law.damping * abs(w) <= excess <= CREEP * law.friction


@scalar
def creeps_slaved(z: complex, w: complex, law: PinLaw) -> bool:
    """Return whether slip is so close to the direction of the holding force that it decays like slow slip.

    Friction draws the direction of slip to the pull at the rate g/s, far above all other rates. The oscillator of
    :func:`creeps_steadily` keeps s > 0 forever if e >= μ·s with μ = (c − √(c² − 4K))/2, which e >= c·s/2 implies.
    """
    a, s, turning = pull(z, 0j, law), abs(w), law.damping + 2.0 * abs(law.disc_speed)
    across = abs((a.conjugate() * w).imag) / (abs(a) * s) if s > 0.0 else 1.0
    slow = s * turning <= SLAVED * law.friction and abs(a) - law.friction <= SLAVED * law.friction
    return slow and across <= SLAVED and (a.conjugate() * w).real > 0.0 and creeps_steadily(z, w, law)


@scalar
def creeping_ends(z: complex, law: PinLaw) -> complex:
    """Return where on the disc a pin that :func:`creeps_steadily` from ``z`` ends."""
    a = pull(z, 0j, law)
    return z + (abs(a) - law.friction) / (law.stiffness - law.disc_speed**2) * a / abs(a)


@written_out
def begin_slip(
    z: complex, law: PinLaw, tolerance: float, longest: float, work: ComplexArray
) -> tuple[complex, complex, float, float]:
    """Return position, slip velocity, duration and distance of slip from rest at ``z``; the slip is 0 if it ends.

    It follows a power series in time while the last terms stay below ``tolerance``. ``work`` is
    complex, of shape (6, MOST_TERMS + 2).
    """
    terms = TERMS
    duration = _series(z, law, 1, terms, tolerance, longest, work)
    if law.friction * duration > STIFF * work[5, 2].imag * duration**2 and duration < longest:
        duration = _series(z, law, terms + 1, MOST_TERMS, tolerance, longest, work)
        terms = MOST_TERMS
    return _along(work[0], work[3], work[5].imag, terms, duration)


@scalar
def _series(
    z: complex, law: PinLaw, first: int, terms: int, tolerance: float, longest: float, work: ComplexArray
) -> float:
    """Write the terms from ``first`` on to ``work``; return the valid duration."""
    position, velocity, acceleration, slip, direction = work[0], work[1], work[2], work[3], work[4]
    theta, speed = work[5].real, work[5].imag
    omega = 1j * law.disc_speed
    strength = abs(pull(z, 0j, law))
    if first == 1:
        position[0], velocity[0], acceleration[0] = z, omega * z, pull(z, 0j, law)
        direction[0] = acceleration[0] / strength
        slip[0], theta[0], speed[0], speed[1] = 0.0, 0.0, 0.0, strength - law.friction
    for k in range(first, terms + 1):
        position[k] = velocity[k - 1] / k
        total = 0j
        for j in range(1, k + 1):
            total += speed[j] * direction[k - j]
        slip[k] = total
        velocity[k] = total + omega * position[k]
        acceleration[k] = -(law.damping + omega) * velocity[k] - law.stiffness * position[k]
        total = 0j
        for j in range(1, k):
            total += j * theta[j] * direction[k - j]
        direction[k] = 1j * total / k
        b = 0j
        for j in range(k + 1):
            b += acceleration[j] * direction[k - j].conjugate()
        turning = 0.0
        for j in range(2, k + 1):
            turning += speed[j] * (k + 1 - j) * theta[k + 1 - j]
        theta[k] = (b.imag - turning) / (strength + k * speed[1])
        direction[k] += 1j * theta[k] * direction[0]
        speed[k + 1] = b.real / (k + 1)
    last = max(abs(slip[terms]), abs(slip[terms - 1]))
    return min(longest, (tolerance / last) ** (1.0 / terms)) if last > 0.0 else longest


@scalar
def _along(
    position: ComplexArray, slip: ComplexArray, speed: FloatArray, terms: int, duration: float
) -> tuple[complex, complex, float, float]:
    """Return position, slip velocity, duration and distance at the end of the series or of slip."""
    rest, ends, risen = duration, False, False
    spacing, before, last = duration / PLACES, 0.0, False
    a, b, c = speed[1], speed[2], speed[3]
    if a > 0.0 > b:  # slip may end as soon as it has begun
        spacing = min(spacing, -0.5 * a / b)
    if c < 0.0 < b * b - 4.0 * a * c:
        soon = (b + math.sqrt(b * b - 4.0 * a * c)) / (-2.0 * c)
        spacing = min(spacing, 0.5 * soon) if soon > 0.0 else spacing
    while not last and not ends:
        last = before + 1.5 * spacing > duration
        t = duration if last else before + spacing
        if _sum(speed, 1, terms, t) > 0.0:
            risen, before = True, t
        elif risen or last:
            for _ in range(60):
                middle = 0.5 * (before + t)
                if _sum(speed, 1, terms, middle) > 0.0:
                    before = middle
                else:
                    t = middle
            rest, ends = t, True
        else:
            before = t
    way = 0.0
    for k in range(terms, 0, -1):
        way = (way + speed[k] / (k + 1)) * rest
    w = 0j if ends else _sum(slip, 0, terms, rest)
    return _sum(position, 0, terms, rest), w, rest, way * rest


@inlined
def _sum(coefficients: NDArray[Number], first: int, terms: int, t: float) -> Number:
    total: Number = coefficients[terms]
    for k in range(terms - 1, first - 1, -1):
        total = total * t + coefficients[k]
    return total
