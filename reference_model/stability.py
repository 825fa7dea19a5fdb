"""Linear stability of sliding motions of the pin, from analytic Jacobians of eq. 1.

Eigenvalues are in 1/s and come as tuples of complex numbers, the one that decays slowest first.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike

from reference_model.pin_formulas import equilibrium_radius, whirl_frequency, whirl_radius
from reference_model.systems import FloatArray, PinOnDisc, checked_state

QUARTER_TURN = np.array([[0.0, -1.0], [1.0, 0.0]])


def sliding_jacobian(pin: PinOnDisc, state: ArrayLike) -> FloatArray:
    """Return the derivative of the right side of eq. 1 by the state, shape (4, 4), for a pin that slides.

    Parameters
    ----------
    pin : PinOnDisc
        The parameters.
    state : array of shape (4,)
        x, y in m and vx, vy in m/s.

    Raises
    ------
    ValueError
        If the slip speed is zero, where Coulomb friction has no derivative, or if the state is none.

    """
    x, y, vx, vy = checked_state(pin, state)
    m, omega = pin.mass, pin.disc_speed
    by_position = -pin.stiffness * np.eye(2)
    by_velocity = -pin.damping * np.eye(2)
    if pin.friction_force > 0.0:
        slip = np.array([vx + omega * y, vy - omega * x])
        slip_speed = math.hypot(*slip)
        if slip_speed == 0.0:
            raise ValueError(f"x = {x:g} m, y = {y:g} m: the pin does not slide there, it has no Jacobian")
        # Only slip across the present direction of slip changes the force: that turns it.
        across = QUARTER_TURN @ (slip / slip_speed)
        by_slip = -pin.friction_force / slip_speed * np.outer(across, across)
        by_position = by_position + by_slip @ (-omega * QUARTER_TURN)
        by_velocity = by_velocity + by_slip
    return np.block([[np.zeros((2, 2)), np.eye(2)], [by_position / m, by_velocity / m]])


def equilibrium_eigenvalues(pin: PinOnDisc) -> tuple[complex, ...]:
    """Eigenvalues of the self-centred equilibrium (3): the four of :func:`sliding_jacobian`, in closed form.

    The pin at rest slips along the circumference, so friction resists its radial velocity like a damper
    μN/(|ω|ρ*) and its tangential velocity not at all. The tangential motion also drives the radial one, but
    not the other way round: the eigenvalues are the roots of mλ² + βλ + C and mλ² + (β + μN/(|ω|ρ*))λ + C.
    That is why the equilibrium is always stable, as the paper says below (5), provided that β > 0.

    Raises
    ------
    ValueError
        If there is no such equilibrium, or it is on the axis, where the pin does not slide.

    """
    radius = equilibrium_radius(pin)
    friction_damping = 0.0
    if pin.friction_force > 0.0:
        if radius == 0.0:
            raise ValueError(
                f"friction_force = {pin.friction_force:g} N = stiffness·|offset|: the equilibrium is on the "
                "axis, where the pin does not slide"
            )
        friction_damping = pin.friction_force / (abs(pin.disc_speed) * radius)
    return slowest_first(
        root
        for damping in (pin.damping, pin.damping + friction_damping)
        for root in _oscillator_eigenvalues(pin.mass, damping, pin.stiffness)
    )


def turning_frame_jacobian(pin: PinOnDisc) -> FloatArray:
    """Jacobian of the whirl (11) in the axes that turn with it, shape (4, 4).

    The state is the position in m and the velocity in m/s (that of the frame at rest), both along the turning
    axes. Without offset eq. 1 looks the same from all directions, so the whirl is a fixed point there:
    p' = v − κ×p, v' = a(p, v) − κ×v.

    Raises
    ------
    ValueError
        If there is no whirl.

    """
    radius, frequency = whirl_radius(pin), whirl_frequency(pin)
    jacobian = sliding_jacobian(pin, [radius, 0.0, 0.0, frequency * radius])
    return jacobian - frequency * np.kron(np.eye(2), QUARTER_TURN)


def whirl_eigenvalues(pin: PinOnDisc) -> tuple[complex, ...]:
    """Eigenvalues of the whirl (11) in the frame that turns with it: an exact zero first, then three more.

    The zero belongs to the phase, which is free; the other three are the roots of the corrected (13).

    Raises
    ------
    ValueError
        If there is no whirl.

    """
    jacobian = turning_frame_jacobian(pin)
    # A turn of the whole motion is its free phase: (0, 1) in position, (−κ, 0) in velocity. Taking that
    # direction out of the matrix leaves the other eigenvalues free of the rounding of a zero among them.
    phase = np.array([0.0, 1.0, -whirl_frequency(pin), 0.0])
    others = [0, 2, 3]
    reduced = jacobian[np.ix_(others, others)] - np.outer(phase[others], jacobian[1, others])
    return (0j, *slowest_first(np.linalg.eigvals(reduced)))


def slowest_first(eigenvalues: Iterable[complex]) -> tuple[complex, ...]:
    """Sort by decreasing real part, conjugates with the positive imaginary part first."""
    return tuple(sorted((complex(value) for value in eigenvalues), key=lambda v: (-v.real, -v.imag)))


def _oscillator_eigenvalues(mass: float, damping: float, stiffness: float) -> tuple[complex, complex]:
    """Both roots of mλ² + βλ + C = 0 for C > 0."""
    discriminant = damping**2 - 4.0 * mass * stiffness
    if discriminant < 0.0:
        oscillating = complex(-damping, math.sqrt(-discriminant)) / (2.0 * mass)
        return oscillating, oscillating.conjugate()
    faster = -(damping + math.sqrt(discriminant)) / 2.0
    # From the product of the roots: the difference would cancel where the damping is strong.
    return complex(stiffness / faster), complex(faster / mass)
