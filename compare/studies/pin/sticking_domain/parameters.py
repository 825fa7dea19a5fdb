"""The pin of Fig. 4, and the starts from which it sticks, or is let go."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from compare.claims.paper_parameters import FIG4
from reference_model.formulas.pin import resonant_disc_speed
from reference_model.systems import PinOnDisc

PIN = FIG4
SOURCE = "Fig. 4, whose friction force is above C·X0; the values of ω are ours"
RESONANCE = resonant_disc_speed(PIN)

SPEEDS = (0.4, 0.7, RESONANCE, 1.4, 2.5)
"""ω in rad/s of the starts inside and outside of the radius (9)."""

INSIDE = 0.98
OUTSIDE = (1.02, 1.5)
"""Radii of the starts, in units of (9)."""

CREEP = 1e-2
"""Relative displacement of a stuck pin from which on it is not known whether it sticks."""

CREEP_AT_EDGE = 0.05 * (OUTSIDE[0] - 1.0)
"""The same for a pin just outside: creep of that share of its distance to the edge may hold it for too long."""

LATEST = 1.1
"""How long a pin outside is watched, in units of the time that (7) predicts."""

REVOLUTIONS = 2.0
"""For which a pin inside is watched: what it must be held with has the period of a revolution."""

SEARCHED = (0.9, 1.0, 1.1, 0.4, 2.0)
"""ω in rad/s at which the largest sticking radius is searched; the first three are about the resonance."""

BRACKET = (0.03, 4.0)
"""Where the search begins, in units of X0: without regard to (9), so that it can't lead to it."""

PRECISION = 6e-5
"""Relative, of that search."""

SEARCH_TOLERANCE = 1e-7

TOLERANCE = 3e-8
"""Moderate, since a regularised law costs the more in stick the closer it comes to Coulomb's."""

DAMPINGS = np.geomspace(0.01, 1.3, 15)
"""β in N s/m at which the largest radius (9) is looked for."""

FAST = (10.0, 30.0, 100.0)
"""ω in rad/s far above the resonance."""


def pin_at(speed: float) -> PinOnDisc:
    """Return the pin of this study at another disc speed in rad/s."""
    return replace(PIN, disc_speed=speed)
