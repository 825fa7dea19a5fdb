"""Equations of motion of the pin on the rotating disc: eq. 1, and eq. 10 as a second formulation.

The plane is complex, z = x + iy. A point of the disc moves with iωz, so the slip velocity is w = ż − iωz.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.integrate import solve_ivp

from reference_model.support import Support, require_linear_support
from reference_model.systems import FloatArray, PinOnDisc, System


@dataclass(frozen=True)
class SlipMotion:
    """Eq. 1 for the slip velocity: ẇ = a(z, w) − g·w/|w|, ż = w + iωz.

    ``damping`` is β/m in 1/s, ``support`` the support divided by the mass, with k² = C/m in 1/s² and X0 in m,
    ``friction`` g = μN/m in m/s², and ``disc_speed`` ω in rad/s.
    """

    damping: float
    support: Support
    friction: float
    disc_speed: float

    @classmethod
    def of(cls, system: System) -> SlipMotion:
        return cls(
            system.damping / system.mass,
            Support.of(system).scaled(1.0 / system.mass),
            system.friction_force / system.mass,
            system.disc_speed,
        )

    def pull(self, z: complex, w: complex) -> complex:
        """Return a(z, w), the acceleration by support and damper minus d(iωz)/dt = iωż, in m/s²."""
        carried, drag = self._factors
        return self.support.force(z) - drag * (w + carried * z)

    @cached_property
    def _factors(self) -> tuple[complex, complex]:
        return 1j * self.disc_speed, self.damping + 1j * self.disc_speed


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
