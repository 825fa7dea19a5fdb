"""Linear stability of sliding motions of pin and disc, from analytic Jacobians of eq. 1 and 19.

Eigenvalues are in 1/s, slowest decay first. With an isotropic contact nothing depends on the angle of a disc, so
steady motions have five states without it. ``contact`` None means the law of the parameters. All functions but
:func:`sliding_jacobian` raise ``ValueError`` for a disc on single points.
"""

import math
from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike

from reference_model.contact.contact_law import Contact, IsotropicContact, contact_of, isotropic_contact_of
from reference_model.formulas.pin import (
    equilibrium_position,
    equilibrium_radius,
    largest_load_in_words,
    whirl_frequency,
    whirl_radius,
)
from reference_model.support import Support
from reference_model.systems import ANGLE, DiscOnDisc, FloatArray, PinOnDisc, System, checked_state

QUARTER_TURN = np.array([[0.0, -1.0], [1.0, 0.0]])


def sliding_jacobian(system: System, state: ArrayLike, contact: Contact | None = None) -> FloatArray:
    """Return the Jacobian of the right side of eq. 1 or 19 in the state for a sliding contact, (4, 4) or (6, 6).

    Raises ``ValueError`` if a point of the contact is at rest, where Coulomb friction has no derivative; if the state
    is invalid or exactly at the stop of the support; or if a contact is given for a pin.
    """
    state = checked_state(system, state, "state")
    size = system.state_size // 2
    x, y = state[:2]
    vx, vy = state[size : size + 2]
    angle, spin = 0.0, 0.0
    inertia, damping = (np.full(size, value) for value in (system.mass, system.damping))
    if isinstance(system, DiscOnDisc):
        angle, spin = state[ANGLE], state[-1]
        inertia[ANGLE], damping[ANGLE] = system.polar_inertia, system.shaft_damping

    by_place, by_rates = np.zeros((size, size)), -np.diag(damping)
    by_place[:2, :2] = -Support.of(system).stiffness_matrix(complex(x, y))
    law = contact_of(system, contact)
    if system.friction_force > 0.0:
        omega = system.disc_speed
        slip = complex(vx + omega * y, vy - omega * x)
        friction = system.friction_force * law.jacobian(slip, omega - spin, angle)
        # Derivatives of u_x, u_y, S and φ with respect to x, y, φ and their rates.
        with_place = np.array([[0.0, omega, 0.0], [-omega, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
        with_rates = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0], [0.0, 0.0, 0.0]])
        by_place += (friction @ with_place)[:size, :size]
        by_rates += (friction @ with_rates)[:size, :size]
    by_state = np.hstack((by_place, by_rates)) / inertia[:, np.newaxis]
    return np.vstack((np.eye(size, 2 * size, size), by_state))


def jacobian_without_angle(
    system: System, state: ArrayLike, contact: IsotropicContact | None = None
) -> FloatArray:
    """Return :func:`sliding_jacobian` without the angle: shape (4, 4) for a pin, (5, 5) for a disc."""
    if isinstance(system, PinOnDisc):
        return sliding_jacobian(system, state, contact)
    law = isotropic_contact_of(system, contact, "steady motions")
    jacobian = sliding_jacobian(system, state, law)
    return np.delete(np.delete(jacobian, ANGLE, axis=0), ANGLE, axis=1)


def equilibrium_eigenvalues(
    system: System, state: ArrayLike | None = None, contact: IsotropicContact | None = None
) -> tuple[complex, ...]:
    """Return the eigenvalues of an equilibrium in space with a sliding contact: four for a pin, five for a disc.

    Friction resists only the radial velocity of a pin, like a damper μN/(|ω|ρ*). So its eigenvalues are the roots of
    mλ² + βλ + C and mλ² + (β + μN/(|ω|ρ*))λ + C, and (3) is always stable if β > 0, as the paper says below (5). For
    a disc, and on a nonlinear support, they belong to :func:`jacobian_without_angle`.

    ``state``, shape (6,), describes a disc with its centre at rest, see
    :func:`reference_model.self_centred_equilibria`. Raises ``ValueError`` as :func:`sliding_jacobian`, and if a pin
    has no such equilibrium or has it on the axis, where it does not slide.
    """
    if isinstance(system, DiscOnDisc):
        if state is None:
            raise ValueError("state = None: a disc needs a state, see self_centred_equilibria()")
        return slowest_first(np.linalg.eigvals(jacobian_without_angle(system, state, contact)))
    radius = equilibrium_radius(system)
    friction_damping = 0.0
    if system.friction_force > 0.0:
        if radius == 0.0:
            raise ValueError(
                f"friction_force = {system.friction_force:g} N = {largest_load_in_words(system)}: the equilibrium is "
                "on the axis, where the pin does not slide"
            )
        friction_damping = system.friction_force / (abs(system.disc_speed) * radius)
    if not system.linear_support:
        return slowest_first(
            np.linalg.eigvals(sliding_jacobian(system, [*equilibrium_position(system), 0, 0]))
        )
    return slowest_first(
        root
        for damping in (system.damping, system.damping + friction_damping)
        for root in _oscillator_eigenvalues(system.mass, damping, system.stiffness)
    )


def turning_frame_jacobian(
    system: System, state: ArrayLike | None = None, contact: IsotropicContact | None = None
) -> FloatArray:
    """Return the Jacobian of a whirl in the axes that turn with it, shape (4, 4) for a pin, (5, 5) for a disc.

    The unknowns are position in m and absolute velocity in m/s, in components along the turning axes, and the spin of
    a disc in rad/s. Without offset the whirl is a fixed point there: p' = v − κ×p, v' = a(p, v) − κ×v. ``state`` of a
    disc lies on the whirl, with the centre on the x axis. Raises ``ValueError`` as :func:`sliding_jacobian`, and if a
    pin has no whirl or the state cannot lie on a whirl.
    """
    state = _state_on_whirl(system, state)
    jacobian = jacobian_without_angle(system, state, contact)
    turn = np.zeros_like(jacobian)
    turn[:4, :4] = np.kron(np.eye(2), QUARTER_TURN)
    return jacobian - _frequency(system, state) * turn


def whirl_eigenvalues(
    system: System, state: ArrayLike | None = None, contact: IsotropicContact | None = None
) -> tuple[complex, ...]:
    """Return the eigenvalues of a whirl in the frame that turns with it: an exact zero, then three or four more.

    The zero belongs to the free phase. For a pin the others are the roots of the corrected (13). Parameters and
    errors are the same as in :func:`turning_frame_jacobian`.
    """
    state = _state_on_whirl(system, state)
    jacobian = turning_frame_jacobian(system, state, contact)
    # A rotation of the whole motion is the free phase: (0, 1) in position, (−κ, 0) in velocity. Deflation keeps the
    # rounding error of its zero eigenvalue out of the others.
    phase = np.zeros(len(jacobian))
    phase[1], phase[2] = 1.0, -_frequency(system, state)
    others = [i for i in range(len(jacobian)) if i != 1]
    reduced = jacobian[np.ix_(others, others)] - np.outer(phase[others], jacobian[1, others])
    return (0j, *slowest_first(np.linalg.eigvals(reduced)))


def onset_load(disc: DiscOnDisc, contact: IsotropicContact | None = None) -> float:
    """Return the largest μN in N for a stable rotation of a centred disc about the axis.

    With the centre on the axis b(ω − Ω − S) = μN·M sign S, where M is the moment of pure spin (R for a ring). Against
    a small slip u of the centre friction is a damper μN·g/|S| that turns with the master disc, g/|S| = ∂F/∂U at U = 0
    (1/(2R|S|) for a ring). With the stiffness C for small deflections::

        mz̈ + (β + μN·g/|S|)·ż + (C − iω·μN·g/|S|)·z = 0

    A motion z ~ exp(±ikt) in the sense of ω neither grows nor decays if μN·g(|ω| − k) = βk|S|, which is linear in μN.
    The instability ends at the load b|ω − Ω| = μN·M, above which the disc sticks.

    Raises ``ValueError`` if there is an offset; if |ω| <= k, where the rotation is always stable; or if b = 0 or Ω =
    ω, where the disc may stick at every load.
    """
    law = isotropic_contact_of(disc, contact, "the onset")
    speed, k = abs(disc.disc_speed), math.sqrt(Support.of(disc).tangent(0.0) / disc.mass)
    if disc.offset != 0.0:
        raise ValueError(
            f"offset = {disc.offset:g} m: it must be 0, because otherwise the centre does not rest on the axis"
        )
    if speed <= k:
        raise ValueError(
            f"disc_speed = {disc.disc_speed:g} rad/s: the centred rotation is stable at every load unless "
            f"|disc_speed| exceeds the natural frequency {k:g} rad/s"
        )
    if disc.shaft_damping == 0.0 or disc.disc_speed == disc.shaft_speed:
        raise ValueError(
            f"shaft_damping = {disc.shaft_damping:g} N m s/rad, disc_speed - shaft_speed = "
            f"{disc.disc_speed - disc.shaft_speed:g} rad/s: the shaft exerts no moment, so the disc may stick at "
            "every load"
        )
    torque = disc.shaft_damping * abs(disc.disc_speed - disc.shaft_speed)
    against_slip = disc.shaft_damping * law.slopes(0.0, 1.0).resistance_by_slip * (speed - k)
    damped = disc.damping * k
    return damped * torque / (against_slip + damped * law.shares(0.0, 1.0).moment)


def slowest_first(eigenvalues: Iterable[complex]) -> tuple[complex, ...]:
    """Return the eigenvalues by decreasing real part, then imaginary part."""
    return tuple(sorted((complex(value) for value in eigenvalues), key=lambda v: (-v.real, -v.imag)))


def _state_on_whirl(system: System, state: ArrayLike | None) -> FloatArray:
    if state is None:
        if isinstance(system, DiscOnDisc):
            raise ValueError(
                "state = None: a disc may have several whirls; pass a state on one, see whirls()"
            )
        radius = whirl_radius(system)
        return np.array([radius, 0.0, 0.0, whirl_frequency(system) * radius])
    state = checked_state(system, state, "state")
    x, y, vx = state[0], state[1], state[system.state_size // 2]
    if x == 0.0 or y != 0.0 or vx != 0.0:
        raise ValueError(
            f"x = {x:g} m, y = {y:g} m, vx = {vx:g} m/s: a state on a whirl with its centre on the x axis has "
            "x != 0 and y = vx = 0"
        )
    return state


def _frequency(system: System, state: FloatArray) -> float:
    return float(state[system.state_size // 2 + 1] / state[0])


def _oscillator_eigenvalues(mass: float, damping: float, stiffness: float) -> tuple[complex, complex]:
    discriminant = damping**2 - 4.0 * mass * stiffness
    if discriminant < 0.0:
        oscillating = complex(-damping, math.sqrt(-discriminant)) / (2.0 * mass)
        return oscillating, oscillating.conjugate()
    faster = -(damping + math.sqrt(discriminant)) / 2.0
    # From the product of the roots, because the difference cancels for strong damping.
    return complex(stiffness / faster), complex(faster / mass)
