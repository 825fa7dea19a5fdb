"""The whirl of a pin on a hardening support with an offset, by balance of one harmonic and the mean.

With z = z_m + ρ·exp(iψ), ψ̇ = κ, the support deflects by q + ρ·exp(iψ), q = z_m − X0, and of the two harmonics of its
cubic force and of friction, whose slip is (ω − κ)·ρ·exp(iψ) + ω·z_m turned by −i, remain::

    mean             C·q + C₃·(|q|² + 2ρ²)·q = iμN·∂P/∂V·z_m/|z_m|
    first harmonic   m·κ² = C + C₃·(ρ² + 2|q|²),   βκρ = μN·∂P/∂U

for ω > κ > 0, with the mean P of |U + V·exp(iψ)| over ψ, U = (ω − κ)ρ and V = ω|z_m|: that of a ring.

*Order of the error.* The offset excites the mean and the second harmonic, both in proportion to X0, and the balance
leaves out the second, which friction and hardening couple to the mean. So the mean is wrong by a fraction that does
not vanish, an error of the order X0, as that of (18), which is this balance for C₃ = 0 to first order. But ρ and κ do
not know the sign of X0 (the orbit for −X0 is that for X0, turned by half a turn): they are even in it, and what is
left out changes them by products of two small harmonics, an error of the order X0². For X0 = 0 the ansatz is the
motion.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import root

from reference_model.contact.elliptic import mean_directions
from reference_model.formulas.pin import whirl_frequency, whirl_radius
from reference_model.systems import FloatArray, PinOnDisc


@dataclass(frozen=True, kw_only=True)
class BalancedWhirl:
    """A whirl z = mean + radius·exp(i·frequency·t).

    Parameters
    ----------
    radius : float
        ρ in m.
    frequency : float
        κ in rad/s, negative where the pin turns clockwise.
    mean : complex
        z_m in m.

    """

    radius: float
    frequency: float
    mean: complex


def whirl_by_harmonic_balance(pin: PinOnDisc) -> BalancedWhirl:
    """Return the whirl by balance of its mean and its first harmonic.

    Errors: of radius and frequency of the order X0², of the mean of the order X0; none for X0 = 0.

    Parameters
    ----------
    pin : PinOnDisc
        The parameters, without a stop.

    Raises
    ------
    ValueError
        If there is a stop, whose force is no polynomial; if there is no whirl without offset to start from.
    RuntimeError
        If Newton's method finds no balance near to that: the offset is too large.

    """
    if pin.stop_stiffness > 0.0:
        raise ValueError(
            f"stop_stiffness = {pin.stop_stiffness:g} N/m: the harmonic balance is for a support without a stop"
        )
    without_offset, frequency = whirl_radius(pin), abs(whirl_frequency(pin))
    speed, force = abs(pin.disc_speed), pin.friction_force

    def whirl(unknowns: FloatArray) -> tuple[float, float, complex]:
        radius, turning, x, y = unknowns.tolist()
        return radius * without_offset, turning * frequency, complex(x, y) * without_offset

    def residuals(unknowns: FloatArray) -> FloatArray:
        """Return both balances, as shares of friction."""
        radius, turning, mean = whirl(unknowns)
        q = mean - pin.offset
        slip, carried = abs(speed - turning) * radius, speed * abs(mean)
        of_slip, of_mean = mean_directions(slip, carried)
        friction = 1j * of_mean * mean / abs(mean) if mean != 0.0 else 0j
        constant = (pin.stiffness + pin.hardening * (abs(q) ** 2 + 2.0 * radius**2)) * q / force - friction
        stiffness = pin.stiffness + pin.hardening * (radius**2 + 2.0 * abs(q) ** 2)
        return np.array(
            [
                constant.real,
                constant.imag,
                (stiffness - pin.mass * turning**2) * radius / force,
                pin.damping * turning * radius / force - of_slip,
            ]
        )

    found = root(residuals, [1.0, 1.0, pin.offset / without_offset, 0.0], tol=1e-14)
    radius, turning, mean = whirl(found.x)
    if np.max(np.abs(residuals(found.x))) > CONVERGED or not 0.0 < turning < speed or radius <= 0.0:
        raise RuntimeError(
            f"offset = {pin.offset:g} m: no balance of one harmonic near the whirl without offset, of the radius "
            f"{without_offset:g} m"
        )
    clockwise = pin.disc_speed < 0.0
    return BalancedWhirl(
        radius=radius,
        frequency=-turning if clockwise else turning,
        mean=mean.conjugate() if clockwise else mean,
    )


CONVERGED = 1e-11
"""Largest residual of a balance, as a share of friction."""
