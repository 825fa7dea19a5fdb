"""A ring thrown on a table: how it is thrown, and when it is looked at."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass, replace

import numpy as np

from compare.claims.error_estimates import WORKING
from compare.claims.paper_parameters import FIG8
from reference_model.systems import DiscOnDisc, FloatArray

TABLE = replace(
    FIG8,
    polar_inertia=FIG8.mass * FIG8.contact_radius**2,
    stiffness=0.0,
    damping=0.0,
    shaft_damping=0.0,
    friction_force=0.1,
    disc_speed=0.0,
    shaft_speed=0.0,
    offset=0.0,
)
"""The ring of Fig. 8 without springs, dampers and shaft on a master disc at rest, J = mR²."""

DECELERATION = TABLE.friction_force / TABLE.mass
"""g of a ring that only slides, in m/s²."""

SPEED = 0.3
"""√(U² + W²) at the start in m/s, U of the centre and W of the rim."""

HEADING = 0.7
"""Direction of the throw in rad from the x axis."""


@dataclass(frozen=True)
class Throw:
    """How a ring is thrown.

    Parameters
    ----------
    inertia : float
        c = J/(mR²).
    degrees : float
        atan(W/U) at the start: 0 only slides, 90 only spins; negative is a spin in the other sense.

    """

    inertia: float
    degrees: float

    @property
    def disc(self) -> DiscOnDisc:
        """The parameters."""
        return replace(TABLE, polar_inertia=self.inertia * TABLE.mass * TABLE.contact_radius**2)

    @property
    def sliding(self) -> float:
        """U at the start in m/s."""
        return 0.0 if abs(self.degrees) == 90.0 else SPEED * math.cos(math.radians(self.degrees))

    @property
    def rim(self) -> float:
        """W at the start in m/s, with its sign."""
        return SPEED * math.sin(math.radians(self.degrees))

    @property
    def state(self) -> FloatArray:
        """The state at the start, shape (6,)."""
        velocity = cmath.rect(self.sliding, HEADING)
        return np.array([0.0, 0.0, 0.0, velocity.real, velocity.imag, self.rim / TABLE.contact_radius])

    @property
    def name(self) -> str:
        """Both parameters in words."""
        return f"J/mR² = {self.inertia:g}, atan(W/U) = {self.degrees:g}°"


DEGREES = (8.0, -33.0, 57.0, -70.0)
RINGS = tuple(Throw(1.0, degrees) for degrees in DEGREES)

OTHERS = tuple(Throw(inertia, degrees) for inertia in (0.7, 1.4) for degrees in (15.0, -75.0))
"""Bodies on a ring of contact with a terminal ratio that is another than 1, from both sides of it."""

INTEGRATED = (*RINGS, *OTHERS)

LOPSIDED = tuple(Throw(inertia, degrees) for inertia in (0.3, 3.0) for degrees in (30.0, 60.0))
"""Beyond the limits of 1/2 and 2."""

INTERVALS = 400
"""Of the time to rest, for the heat and the figure."""

REMAINING = np.array([2e-4, 4e-4, 8e-4, 1.6e-3])
"""Remaining times at which the end is looked at, as fractions of the whole."""

NEARNESSES = (7.0, 9.0)
"""A/t at which the approach to the ratio 1 is looked at."""

ENDING = np.geomspace(1e-3, 3e-2, 10)
"""Remaining times of a power law, as fractions of the whole."""

TOLERANCE = WORKING / 10
"""Ratios at the end are of what is left of a motion, down to a thousandth of it."""

SOURCE = "assumption: the ring of Fig. 8 on a table at rest; friction force and starts are our choice"
CITED = "; Farkas et al. 2003, Weidman and Malhotra 2007"

INERTIAS = (0.1, 0.3, 0.45, 0.499, 0.501, 0.55, 0.7, 1.3, 1.7, 1.9, 1.99, 2.01, 2.2, 3.0, 10.0)
"""J/(mR²) for which it is asked whether there is a terminal ratio."""
