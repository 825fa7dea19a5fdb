"""The pin of Fig. 3, for which the paper prints no parameters, and how it is measured."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from compare.claims.error_estimates import WORKING
from reference_model.formulas.pin import largest_load_with_equilibrium
from reference_model.systems import PinOnDisc

PIN = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.05, disc_speed=0.8, offset=0.1)
SOURCE = "assumption: the paper prints no parameters for Fig. 3; support as in Fig. 4, ω below k"

LIMIT = largest_load_with_equilibrium(PIN)
"""(5) in N."""

START = (0.1, 0.05, 0.0, 0.0)
"""x, y, vx, vy in m and m/s: at rest, displaced from every equilibrium."""

LOADS = (0.0, 0.04, 0.08, 0.095, 0.098)
"""μN in N, within (5)."""

DURATION = 520.0
"""In s: the slowest transient, exp(−βt/2m), falls to 5e-12 of its beginning."""

DELAY = 60.0
"""In s: from how long before the end the remaining transient is inferred."""

TOLERANCE = 0.03 * WORKING
"""The claims on the rest resolve 1e-9 of X0."""

SHARES = (0.98, 0.999, 1.05, 1.2)
"""Friction forces about the limit (5), in units of it."""

SETTLING = 300.0
"""In s: from the axis to the equilibrium, for friction forces below the limit."""

REVOLUTION = 2.0 * np.pi / PIN.disc_speed
"""Of the disc, in s."""

REVOLUTIONS = 2.0
"""For friction forces above the limit, where the pin is caught at once."""

FLOW_DURATION = 0.3
"""In s, of the simulations that give eigenvalues: short enough for the strongly damped ones to be seen."""

GRID_SHARES = np.array([0.01, *np.linspace(0.05, 0.95, 19), 0.99, 0.999])
GRID_SPEEDS = np.geomspace(0.05, 5.0, 25)
GRID_DAMPINGS = np.geomspace(0.01, 3.0, 12)
"""Friction forces in units of the limit (5), ω in rad/s and β in N s/m at which the linearised (1) is looked at."""


def with_load(load: float) -> PinOnDisc:
    """Return the pin of this study under μN = ``load`` in N."""
    return replace(PIN, friction_force=load)
