"""Section 3 of the paper: the stability of the whirl, (12) to (16)."""

from __future__ import annotations

import math

import numpy as np

from reference_model.formulas.pin.conditions import require_positive, speed_ratio
from reference_model.systems import FloatArray, PinOnDisc


def variational_matrix(pin: PinOnDisc) -> FloatArray:
    """Return the matrix of (12), shape (3, 3): its product with (ξ, ξ̇, η) is the time derivative of (ξ, ξ̇, η).

    ξ is the deviation of the radius in m, and η the deviation of the angular velocity in the sense of ω, in rad/s.

    Raises ``ValueError`` if |ω| = k, if damping or friction force is zero, or if the support is not linear.
    """
    require_positive(pin, "damping", "friction_force")
    rate, k = pin.damping / pin.mass, pin.natural_frequency
    coupling = pin.damping * k**2 / pin.friction_force
    return np.array(
        [
            [0.0, 1.0, 0.0],
            [0.0, -rate * speed_ratio(pin), 2.0 * pin.friction_force / pin.damping],
            [-coupling * rate, -2.0 * coupling, -rate],
        ]
    )


def characteristic_coefficients(pin: PinOnDisc) -> tuple[float, float, float, float]:
    """Return the coefficients of λ³, λ², λ and 1 of the characteristic equation of (12): (13) corrected.

    Their units are 1, 1/s, 1/s² and 1/s³. Raises ``ValueError`` if |ω| = k.
    """
    rate, k, ratio = pin.damping / pin.mass, pin.natural_frequency, speed_ratio(pin)
    return 1.0, rate * (1.0 + ratio), rate**2 * ratio + 4.0 * k**2, 2.0 * k**2 * rate


def characteristic_coefficients_as_printed(pin: PinOnDisc) -> tuple[float, float, float, float]:
    """Return the coefficients of (13) as printed, which are wrong, for comparison.

    The coefficient of λ² is printed as 1 + (β/m)·ω/(ω − k), which adds a number to a rate. The determinant of (12)
    gives (β/m)·(1 + ω/(ω − k)), see :func:`characteristic_coefficients`. Raises ``ValueError`` if |ω| = k.
    """
    _, _, linear, constant = characteristic_coefficients(pin)
    return 1.0, 1.0 + pin.damping / pin.mass * speed_ratio(pin), linear, constant


def coefficient_margins(pin: PinOnDisc) -> tuple[float, float]:
    """Return left side minus right side of the two conditions (14): both > 0 if the coefficients of (13) are.

    Raises ``ValueError`` if |ω| = k or if the damping is zero.
    """
    ratio = speed_ratio(pin)
    return ratio + 1.0, ratio + _stiffness_to_damping(pin)


def lower_branch_margin(pin: PinOnDisc) -> float:
    """Return right side minus left side of (15): > 0 if it holds, which excludes (14).

    Raises ``ValueError`` if |ω| = k or if the damping is zero.
    """
    q = _stiffness_to_damping(pin)
    return -0.5 * (1.0 + q + math.hypot(1.0, q)) - speed_ratio(pin)


def upper_branch_margin(pin: PinOnDisc) -> float:
    """Return left side minus right side of (16): > 0 exactly if all roots of (13) have negative real parts.

    Raises ``ValueError`` if |ω| = k or if the damping is zero.
    """
    q = _stiffness_to_damping(pin)
    # q − √(1 + q²) without cancellation for weak damping
    return speed_ratio(pin) + 0.5 * (1.0 - 1.0 / (q + math.hypot(1.0, q)))


def _stiffness_to_damping(pin: PinOnDisc) -> float:
    require_positive(pin, "damping")
    ratio = 2.0 * pin.natural_frequency * pin.mass / pin.damping
    return ratio * ratio
