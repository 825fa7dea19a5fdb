"""Discs on a plane at rest, how they are thrown, and what friction takes of each motion, in closed form."""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from reference_model.systems import DiscOnDisc, FloatArray

SOURCE = "assumption: a disc of 1 kg and 0.1 m with friction of 1 N"

MASS, RADIUS, FRICTION = 1.0, 0.1, 1.0
"""m in kg, R in m and μN in N."""

DECELERATION = FRICTION / MASS
"""g in m/s²."""

SPEED = 1.0
"""At the start in m/s, of the centre or the rim, or of each."""

HEADING = 0.7
"""Direction of the throw in rad from the x axis."""


@dataclass(frozen=True)
class Throw:
    """A throw that friction slows down evenly.

    Parameters
    ----------
    name : str
        In words.
    inertia : float
        J/(mR²).
    sliding, rim : float
        U and W at the start in m/s, the latter with the sign of the spin.
    force, moment : float
        Of friction, over μN and μNR, as long as the disc moves.

    """

    name: str
    inertia: float
    sliding: float
    rim: float
    force: float = 0.0
    moment: float = 0.0

    def disc(self, contact_points: int | None = None) -> DiscOnDisc:
        """Return the parameters."""
        return DiscOnDisc(
            mass=MASS,
            polar_inertia=self.inertia * MASS * RADIUS**2,
            stiffness=0.0,
            damping=0.0,
            friction_force=FRICTION,
            disc_speed=0.0,
            contact_radius=RADIUS,
            shaft_damping=0.0,
            shaft_speed=0.0,
            contact_points=contact_points,
        )

    @property
    def state(self) -> FloatArray:
        """The state at the start, shape (6,)."""
        velocity = cmath.rect(self.sliding, HEADING)
        return np.array([0.0, 0.0, 0.0, velocity.real, velocity.imag, self.rim / RADIUS])

    @property
    def time(self) -> float:
        """When it stops, in s."""
        if self.sliding > 0.0:
            return self.sliding / (DECELERATION * self.force)
        return abs(self.rim) * self.inertia / (DECELERATION * self.moment)

    def seen_at(self, shares: FloatArray) -> FloatArray:
        """Return ways along, across and of the rim in m, and their speeds, at ``shares`` (n,) of ``time``: (n, 6)."""
        share = np.minimum(shares, 1.0)[:, np.newaxis]
        start = np.array([self.sliding, 0.0, self.rim])
        return np.hstack((start * self.time * (share - 0.5 * share**2), start * (1.0 - share)))


RING = (
    Throw("slides", 0.5, SPEED, 0.0, force=1.0),
    Throw("spins", 0.5, 0.0, -SPEED, moment=1.0),
    Throw("both", 1.0, SPEED, SPEED, force=2.0 / math.pi, moment=2.0 / math.pi),
)
"""Where U = W, the point at χ slips with 2U·|cos χ/2| and by |cos χ/2| of that along U: in the mean by 2/π."""

POINTS: Mapping[int, tuple[Throw, ...]] = {3: RING[:2], 6: RING[:2]}
"""By the number of points, on which there is no closed form for both motions."""

FULL = (
    Throw("slides", 0.5, SPEED, 0.0, force=1.0),
    Throw("spins", 0.5, 0.0, -SPEED, moment=2.0 / 3.0),
    Throw("both", 1.0 / 3.0, SPEED, SPEED, force=8.0 / (3.0 * math.pi), moment=8.0 / (9.0 * math.pi)),
)
"""The force is (4/3π)·((1 + ε²)·E − (1 − ε²)·K)/ε, ε = U/W the modulus of E and K (Farkas et al. 2003), 8/3π at 1."""

TO_REST = np.array([0.0, 0.5, 1.25])
"""When a throw is looked at, as fractions of the time in which it stops."""

WHILE_SLIDING = np.array([0.0, 0.5, 0.9])
"""The same for a full disc, which a smoothed law need not bring to rest."""
