"""Coulomb friction of a pin, of points, of a ring and of an annulus, compiled for Exudyn's user functions.

All are gradients of a slip potential. With u the slip of the disc's centre and S = φ̇ − ω, a point at the radius R
and the angle α slips with u + S·R·(−sin α, cos α). The mean of its magnitude over the load is the potential P(u, S).
The friction on the disc is −μN·∂P/∂u, the moment −μN·∂P/∂S, so both dissipate the power μN·P.

Near rest the laws are regularised, but *exact* as soon as all slip reaches ε. With v/√(v²+ε²) every release would
leave an error of ε^0.8; here all errors are of first order in ε.

- *The contact as a whole* is viscous for P < ε: force and moment have their values for the same direction of (u, S)
  at P = ε, times P/ε. So a disc creeps with P < ε if and only if Coulomb friction could hold it.
- *One of several points* is regularised when it passes through rest, because its friction alone could jump. Below δ
  its own friction is viscous. While its slip v is below 4δ/3, the friction of the others belongs to a centre of
  rotation closer to the point: to their slip minus v if v < δ, and minus v·(4 − 3v/δ) beyond. So the force of the
  point grows from zero to its share of μN, while the others act as if the disc pivots about it. δ, see
  ``laws/places``, ensures that at P = ε no two points are slower than 4δ/3.
"""

import math

import numpy as np

from exudyn_models.forces.jit import KeptOnDisk, compiled
from exudyn_models.forces.laws.places import BEND, place_at, places_in, regularisation_at
from exudyn_models.forces.laws.pressures import mean_radius_of
from exudyn_models.forces.slip_potential import (
    slip_potential_gradient,
    slip_potential_hessian,
    slip_potential_of_circles,
)
from reference_model.systems import FloatArray

CONTINUOUS = 0
"""Number of contact points that stands for a continuous ring or annulus."""

NONE_HELD = -1
"""Index that stands for no point."""

Contact = tuple[float, int, float, float, int, float]
"""R in m, number of points, μN in N, ε in m/s, the held point or ``NONE_HELD``, and the inner radius in m.

For an annulus R is the outer radius, and the number of points is ``CONTINUOUS`` or, under a nonuniform pressure, the
negative result of ``density_of``. For points R is the largest distance from the centre, and the last number is the
result of ``table_of``.

The held point rests while the disc pivots about it. Its friction is viscous at any slip, because the kink of its law
at δ would disturb Newton's method.
"""

CONTACT_SIZE = 6
"""Number of components of a ``Contact``."""


def mean_radius(contact: Contact) -> float:
    """Return r = P/|S| in m of a disc that turns in place."""
    outer, points, _, _, _, inner = contact
    if points > CONTINUOUS:
        x, y, shares = places_in(inner).T
        return float(shares @ np.hypot(x, y))
    if points < CONTINUOUS:
        return mean_radius_of(points, inner, outer)
    return 2.0 / 3.0 * (outer * outer + outer * inner + inner * inner) / (outer + inner)


SECANT = 0.3
"""Share of the secant in the derivatives of points that creep as a whole.

There F = K·slip with the secant K, which depends on the direction only. Newton's method starts from the slip without
acceleration, thousands of times the creep. With the derivative alone it cycles for one load in ten on six points, and
for one in six on three points. With a share of 0.3 it converged for all loads, in 7 iterations. On three feet with
unequal shares 5 of 100 loads take more than 25 iterations, and on four feet in a line 13; the solver then takes a
smaller step.
"""


@compiled
def ring_friction(
    dx: float,
    dy: float,
    angle: float,
    dvx: float,
    dvy: float,
    master_spin: float,
    disc_spin: float,
    contact: Contact,
) -> tuple[float, float, float, float]:
    """Return force and moment on the disc and moment on the master: F_x, F_y (N), M, M_master (N m).

    ``dx, dy`` (m) and ``dvx, dvy`` (m/s) are position and velocity of the disc relative to the master's node,
    ``angle`` (rad) is φ, and the spins are in rad/s.
    """
    radius, _, friction, epsilon, _, _ = contact
    ux = dvx + master_spin * dy  # slip of the disc's centre
    uy = dvy - master_spin * dx
    if radius == 0.0:
        slip = math.sqrt(ux * ux + uy * uy)
        factor = -friction / (slip if slip > epsilon else epsilon)
        fx = factor * ux
        fy = factor * uy
        return fx, fy, 0.0, dy * fx - dx * fy
    fx, fy, moment = friction_of_slip(ux, uy, disc_spin - master_spin, angle, contact)
    return fx, fy, moment, dy * fx - dx * fy - moment


@compiled
def friction_of_slip(
    ux: float, uy: float, spin: float, angle: float, contact: Contact
) -> tuple[float, float, float]:
    """Return F_x, F_y (N) and M (N m) on the disc for the centre slip u (m/s) and the relative spin φ̇ − ω."""
    radius, points, friction, epsilon, _, inner = contact
    if points > CONTINUOUS:
        return _force_of_points(ux, uy, spin, angle, contact)
    fx = fy = moment = 0.0
    speed = math.sqrt(ux * ux + uy * uy)
    if speed > 0.0 or spin != 0.0:
        by_speed, by_spin = slip_potential_gradient(speed, abs(spin), inner, radius, points)
        mean = by_speed * speed + by_spin * abs(spin)
        factor = -friction * (1.0 if mean > epsilon else mean / epsilon)
        if speed > 0.0:
            push = factor * by_speed / speed
            fx = push * ux
            fy = push * uy
        moment = math.copysign(by_spin, spin) * factor
    return fx, fy, moment


@compiled
def slip_potential_of_contact(ux: float, uy: float, spin: float, angle: float, contact: Contact) -> float:
    """Return the slip potential P, the mean slip speed in m/s."""
    radius, points, _, _, _, inner = contact
    if points <= CONTINUOUS:
        return slip_potential_of_circles(math.sqrt(ux * ux + uy * uy), abs(spin), inner, radius, points)
    mean, turning = 0.0, 1j * spin * complex(math.cos(angle), math.sin(angle))
    for i in range(points):
        place, share = place_at(inner, i)
        mean += share * _length(complex(ux, uy) + turning * place)
    return mean


@compiled
def _force_of_points(
    ux: float, uy: float, spin: float, angle: float, contact: Contact
) -> tuple[float, float, float]:
    _, points, friction, epsilon, held, table = contact
    turn = complex(math.cos(angle), math.sin(angle))
    slip_of_centre, turning = complex(ux, uy), 1j * spin * turn
    force, moment, mean, slow, lowest = 0j, 0j, 0.0, 0, math.inf
    for i in range(points):
        place, share = place_at(table, i)
        slip = slip_of_centre + turning * place
        speed = _length(slip)
        push = slip * (-share / speed) if speed > 0.0 else 0j
        force += push
        moment += place.conjugate() * push
        mean += share * speed
        if speed < lowest:
            slow, lowest = i, speed
    delta = regularisation_at(table, epsilon)
    if held == NONE_HELD and mean >= epsilon and lowest >= BEND * delta:
        return friction * force.real, friction * force.imag, friction * (turn.conjugate() * moment).imag
    creep = min(1.0, mean / epsilon)
    slow = slow if held == NONE_HELD else held
    slow_slip = slip_of_centre + turning * place_at(table, slow)[0]
    drawn, viscous = _yielding(abs(slow_slip), delta * creep, held)
    force, moment = 0j, 0j
    for i in range(points):
        place, share = place_at(table, i)
        slip = slip_of_centre + turning * place - (drawn * slow_slip if i != slow else 0j)
        speed = _length(slip)
        if i == slow and viscous:
            push = slip * (-share / delta)
        else:
            push = slip * (-share * creep / speed) if speed > 0.0 else 0j
        force += push
        moment += place.conjugate() * push
    return friction * force.real, friction * force.imag, friction * (turn.conjugate() * moment).imag


@compiled
def _length(vector: complex) -> float:
    """Return |v| faster than abs(), without its overflow protection."""
    return math.sqrt(vector.real * vector.real + vector.imag * vector.imag)


@compiled
def _yielding(speed: float, delta: float, held: int) -> tuple[float, bool]:
    """Return the share of the slowest point's slip that the others lose, and whether its friction is viscous."""
    if held != NONE_HELD or speed <= delta:
        return 1.0, True
    return max(0.0, (BEND - speed / delta) / (BEND - 1.0)), False


@compiled
def ring_friction_derivatives(
    dx: float,
    dy: float,
    angle: float,
    dvx: float,
    dvy: float,
    master_spin: float,
    disc_spin: float,
    contact: Contact,
) -> FloatArray:
    """Return the derivatives of (F_x, F_y, M, M_master) with respect to the first seven arguments, shape (4, 7).

    If points creep as a whole, these contain a ``SECANT`` share, so Newton's method converges.
    """
    ux = dvx + master_spin * dy
    uy = dvy - master_spin * dx
    spin = disc_spin - master_spin
    fx, fy, by_slip = derivatives_by_slip(ux, uy, spin, angle, contact)
    result = np.zeros((4, 7))
    for i in range(3):
        by_ux, by_uy, by_spin, by_angle = by_slip[i]
        result[i, 0] = -master_spin * by_uy
        result[i, 1] = master_spin * by_ux
        result[i, 2] = by_angle
        result[i, 3] = by_ux
        result[i, 4] = by_uy
        result[i, 5] = dy * by_ux - dx * by_uy - by_spin
        result[i, 6] = by_spin
    for j in range(7):
        result[3, j] = dy * result[0, j] - dx * result[1, j] - result[2, j]
    result[3, 0] -= fy
    result[3, 1] += fx
    return result


@compiled
def derivatives_by_slip(
    ux: float, uy: float, spin: float, angle: float, contact: Contact
) -> tuple[float, float, FloatArray]:
    """Return F_x, F_y and the derivatives of (F_x, F_y, M) with respect to (u_x, u_y, φ̇ − ω, φ), shape (3, 4)."""
    if contact[1] <= CONTINUOUS:
        return _derivatives_of_circles(ux, uy, spin, contact)
    return _derivatives_of_points(ux, uy, spin, angle, contact)


@compiled
def _derivatives_of_points(
    ux: float, uy: float, spin: float, angle: float, contact: Contact
) -> tuple[float, float, FloatArray]:
    _, points, friction, epsilon, held, table = contact
    delta = regularisation_at(table, epsilon)
    mean, by_mean, slow = _potential_of_points(ux, uy, spin, angle, contact)
    creeps = mean < epsilon
    creep = mean / epsilon if creeps else 1.0
    _, _, slow_slip, by_slow = _slip_of_point(ux, uy, spin, angle, slow, table)
    drawn, viscous = _yielding(abs(slow_slip), delta * creep, held)
    loss = drawn * slow_slip
    by_loss = np.zeros(4, dtype=np.complex128)
    for j in range(4):
        by_loss[j] = drawn * by_slow[j]
        if 0.0 < drawn < 1.0:
            growth = (by_slow[j] * slow_slip.conjugate()).real / abs(slow_slip) ** 2
            if creeps:
                growth -= by_mean[j] / mean
            by_loss[j] -= abs(slow_slip) / (delta * creep) * growth / (BEND - 1.0) * slow_slip
    force = 0j
    result = np.zeros((3, 4))
    for i in range(points):
        arm, share, slip, by_arguments = _slip_of_point(ux, uy, spin, angle, i, table)
        share *= friction
        softly = (i == slow and viscous) or creep == 0.0
        resistance = share / delta if softly else share / max(abs(slip) / creep, delta)
        remaining = slip if i == slow else slip - loss
        speed = abs(remaining)
        if softly or speed == 0.0:
            direction, push = 0j, -share / delta * slip
        else:  # dF/dv = −(μN/n)·(1 − e⊗e)/|v|: only the direction changes
            direction = remaining / speed
            push = -share * creep * direction
        for j in range(4):
            if direction == 0.0:
                change = -share / delta * by_arguments[j]
            else:
                by_remaining = by_arguments[j] - (by_loss[j] if i != slow else 0.0)
                turning = (by_remaining * direction.conjugate()).imag * 1j * direction
                change = -share * creep / speed * turning
                if creeps:
                    change -= share * by_mean[j] / epsilon * direction
            if creeps and j < 3:
                change += SECANT * (-resistance * by_arguments[j] - change)
            result[0, j] += change.real
            result[1, j] += change.imag
            result[2, j] += (arm.conjugate() * change).imag
        result[2, 3] += ((1j * arm).conjugate() * push).imag  # the arm turns with the disc
        force += push
    return force.real, force.imag, result


@compiled
def _potential_of_points(
    ux: float, uy: float, spin: float, angle: float, contact: Contact
) -> tuple[float, FloatArray, int]:
    """Return P, its gradient in (u_x, u_y, φ̇ − ω, φ), and the held point, or the slowest point if none is held."""
    _, points, _, _, held, table = contact
    mean, lowest, slow = 0.0, math.inf, held
    by_mean = np.zeros(4)
    for i in range(points):
        _, share, slip, by_arguments = _slip_of_point(ux, uy, spin, angle, i, table)
        speed = abs(slip)
        mean += share * speed
        for j in range(4):
            by_mean[j] += share * (by_arguments[j] * slip.conjugate()).real / speed if speed > 0.0 else 0.0
        if held == NONE_HELD and speed < lowest:
            slow, lowest = i, speed
    return mean, by_mean, slow


@compiled
def _slip_of_point(
    ux: float, uy: float, spin: float, angle: float, point: int, table: float
) -> tuple[complex, float, complex, tuple[complex, complex, complex, complex]]:
    """Return arm, share and slip of a point, and the slip's gradient in (u_x, u_y, φ̇ − ω, φ)."""
    place, share = place_at(table, point)
    arm = place * complex(math.cos(angle), math.sin(angle))
    return arm, share, complex(ux, uy) + 1j * spin * arm, (1.0 + 0j, 1j, 1j * arm, -spin * arm)


@compiled
def _derivatives_of_circles(
    ux: float, uy: float, spin: float, contact: Contact
) -> tuple[float, float, FloatArray]:
    """Return the same as ``derivatives_by_slip``, for circles."""
    radius, density, friction, epsilon, _, inner = contact
    speed = math.sqrt(ux * ux + uy * uy)
    ex, ey = (ux / speed, uy / speed) if speed > 0.0 else (1.0, 0.0)
    # At rest the slope depends on the direction of the next slip; this slope assumes no rotation.
    size = speed if speed > 0.0 or spin != 0.0 else 1.0
    by_speed, by_spin = slip_potential_gradient(size, abs(spin), inner, radius, density)
    by_speed_twice, mixed, by_spin_twice = slip_potential_hessian(size, abs(spin), inner, radius, density)
    across = by_speed / size if size > 0.0 else by_speed_twice
    by_spin, mixed = math.copysign(by_spin, spin), math.copysign(mixed, -spin)
    mean = by_speed * speed + by_spin * spin
    sliding = mean > epsilon
    # The potential is P, or P²/(2ε) near rest.
    factor = 1.0 if sliding else by_speed * size / epsilon if mean == 0.0 else mean / epsilon
    tip = 0.0 if sliding else 1.0 / epsilon
    along = -friction * (factor * by_speed_twice + tip * by_speed * by_speed)
    turning = -friction * factor * across
    coupling = -friction * (factor * mixed + tip * by_speed * by_spin)
    result = np.zeros((3, 4))
    result[0, 0] = along * ex * ex + turning * ey * ey
    result[1, 1] = along * ey * ey + turning * ex * ex
    result[0, 1] = result[1, 0] = (along - turning) * ex * ey
    result[0, 2] = result[2, 0] = coupling * ex
    result[1, 2] = result[2, 1] = coupling * ey
    result[2, 2] = -friction * (factor * by_spin_twice + tip * by_spin * by_spin)
    push = -friction * (1.0 if sliding else mean / epsilon) * by_speed
    return push * ex, push * ey, result


friction_of, potential_of = KeptOnDisk(friction_of_slip), KeptOnDisk(slip_potential_of_contact)
