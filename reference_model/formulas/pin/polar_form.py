"""Eq. 10, the motion of a slipping pin in polar coordinates: a second formulation."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from scipy.integrate import solve_ivp

from reference_model.support import require_linear_support
from reference_model.systems import FloatArray, PinOnDisc


def simulate_polar_form(
    pin: PinOnDisc, initial_state: FloatArray, times: FloatArray, *, tolerance: float = 3e-14
) -> FloatArray:
    """Integrate eq. 10, the polar form of eq. 1, through pure slip; return x, y, vx, vy, shape (n, 4).

    It cannot stick, and it is singular at the centre. Raises ``ValueError`` if the support is not linear, and
    ``RuntimeError`` if the integrator fails.
    """
    require_linear_support(pin)
    x, y, vx, vy = initial_state
    rho = math.hypot(x, y)
    start = (rho, math.atan2(y, x), (x * vx + y * vy) / rho, (x * vy - y * vx) / rho**2)
    solution = solve_ivp(
        _polar_rates(pin),
        (times[0], times[-1]),
        start,
        method="DOP853",
        t_eval=times,
        rtol=tolerance,
        atol=tolerance * rho,
    )
    if not solution.success:
        raise RuntimeError(f"eq. 10 in polar form: {solution.message}")
    rho, psi, rho_dot, psi_dot = solution.y
    z = rho * np.exp(1j * psi)
    v = (rho_dot + 1j * rho * psi_dot) * np.exp(1j * psi)
    return np.column_stack((z.real, z.imag, v.real, v.imag))


def _polar_rates(pin: PinOnDisc) -> Callable[[float, FloatArray], tuple[float, float, float, float]]:
    m, stiffness, beta = pin.mass, pin.stiffness, pin.damping

    def eq10(_: float, state: FloatArray) -> tuple[float, float, float, float]:
        rho, psi, rho_dot, psi_dot = state.tolist()
        tangential_slip = rho * (pin.disc_speed - psi_dot)
        friction = pin.friction_force / math.hypot(rho_dot, tangential_slip)
        spring = stiffness * pin.offset
        radial = (
            m * rho * psi_dot**2
            - beta * rho_dot
            - stiffness * rho
            + spring * math.cos(psi)
            - friction * rho_dot
        )
        tangential = (
            -2.0 * m * rho_dot * psi_dot
            - beta * rho * psi_dot
            - spring * math.sin(psi)
            + friction * tangential_slip
        )
        return rho_dot, psi_dot, radial / m, tangential / (m * rho)

    return eq10
