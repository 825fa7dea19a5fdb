"""The whirl of a pin on a hardening support with an offset, by harmonic balance of mean and first harmonic.

With z = z_m + ρ·exp(iψ), ψ̇ = κ, the deflection of the support is q + ρ·exp(iψ), q = z_m − X0, and the slip is (ω −
κ)·ρ·exp(iψ) + ω·z_m turned by −i. For ω > κ > 0 the two balances are::

    mean             C·q + C₃·(|q|² + 2ρ²)·q = iμN·∂P/∂V·z_m/|z_m|
    first harmonic   m·κ² = C + C₃·(ρ² + 2|q|²),   βκρ = μN·∂P/∂U

with the mean slip speed P of a ring, U = (ω − κ)ρ and V = ω|z_m|.

The omitted second harmonic is proportional to X0, so the error of the mean is of order X0. Equation (18), which is
this balance for C₃ = 0 to first order, has the same error. ρ and κ do not depend on the sign of X0, so their errors
are of order X0².
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import root

from reference_model.contact.elliptic import mean_directions
from reference_model.formulas.pin import whirl_frequency, whirl_radius
from reference_model.systems import FloatArray, PinOnDisc


@dataclass(frozen=True, kw_only=True)
class BalancedWhirl:
    """A whirl z = mean + radius·exp(i·frequency·t).

    ``radius`` is ρ in m, ``frequency`` κ in rad/s, negative if clockwise, and ``mean`` z_m in m.
    """

    radius: float
    frequency: float
    mean: complex


def whirl_by_harmonic_balance(pin: PinOnDisc) -> BalancedWhirl:
    """Return the whirl of ``pin``, without a stop, by harmonic balance of its mean and its first harmonic.

    Raises ``ValueError`` if there is a stop, or no whirl without offset to start from; ``RuntimeError`` if Newton's
    method does not converge, because the offset is too large.
    """
    if pin.stop_stiffness > 0.0:
        raise ValueError(
            f"stop_stiffness = {pin.stop_stiffness:g} N/m: harmonic balance needs a support without a stop"
        )
    without_offset, frequency = whirl_radius(pin), abs(whirl_frequency(pin))
    speed, force = abs(pin.disc_speed), pin.friction_force

    def whirl(unknowns: FloatArray) -> tuple[float, float, complex]:
        radius, turning, x, y = unknowns.tolist()
        return radius * without_offset, turning * frequency, complex(x, y) * without_offset

    def residuals(unknowns: FloatArray) -> FloatArray:
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
            f"offset = {pin.offset:g} m: too large for harmonic balance, which starts from the whirl of radius "
            f"{without_offset:g} m without offset"
        )
    clockwise = pin.disc_speed < 0.0
    return BalancedWhirl(
        radius=radius,
        frequency=-turning if clockwise else turning,
        mean=mean.conjugate() if clockwise else mean,
    )


CONVERGED = 1e-11
"""Largest residual of a balance, as a share of friction."""
