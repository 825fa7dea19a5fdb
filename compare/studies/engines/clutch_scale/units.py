"""The paper's systems at the scale of a clutch: the same dimensionless numbers in other units."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from reference_model.systems import DiscOnDisc, FloatArray, System


@dataclass(frozen=True)
class Scale:
    """What a metre, a second and a kilogram of a system become, in m, s and kg."""

    length: float
    time: float
    mass: float

    def system(self, system: System) -> System:
        """Return ``system`` with its lengths, times and masses changed: the same by all dimensionless numbers."""
        length, time, mass = self.length, self.time, self.mass
        changes: dict[str, Any] = {
            "mass": mass * system.mass,
            "stiffness": mass / time**2 * system.stiffness,
            "damping": mass / time * system.damping,
            "friction_force": mass * length / time**2 * system.friction_force,
            "disc_speed": system.disc_speed / time,
            "offset": length * system.offset,
        }
        if isinstance(system, DiscOnDisc):
            changes |= {
                "polar_inertia": mass * length**2 * system.polar_inertia,
                "contact_radius": length * system.contact_radius,
                "shaft_damping": mass * length**2 / time * system.shaft_damping,
                "shaft_speed": system.shaft_speed / time,
            }
        return replace(system, **changes)

    def states(self, states: ArrayLike) -> FloatArray:
        """Return ``states`` (shape (..., 4) of a pin, (..., 6) of a disc) changed alike; angles stay."""
        states = np.asarray(states, dtype=float)
        places = [self.length, self.length, 1.0][: states.shape[-1] // 2]
        return np.asarray(states * [*places, *(place / self.time for place in places)])


CLUTCH = Scale(length=1e-3, time=1.5 / 300.0, mass=0.5)
"""X0 = 0.1 m and ω = 1.5 rad/s become 0.1 mm and 300 rad/s, 1 kg a disc of half a kilogram."""
