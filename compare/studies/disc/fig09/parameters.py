"""The disc of Figs. 9 and 10, its motions that are measured, and the ranges in which they are followed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from compare.claims.error_estimates import WORKING
from compare.claims.paper_parameters import FIG9
from reference_model.contact.contact_law import ThreeTermRing
from reference_model.systems import DiscOnDisc

RING = FIG9
CENTRED = replace(FIG9, offset=0.0)
"""Without offset, so that the whirl is a circle."""

PAPER_LAW = ThreeTermRing(FIG9.contact_radius)
"""(23)."""

SOURCE = (
    'Fig. 9; β and b as in Fig. 8 ("the same parameter values as above"); X0 = 0.1 m as in Figs. 4 to 6 and μN '
    "are our choice, the paper leaves them out"
)

SOURCE_CENTRED = f"{SOURCE}; X0 = 0 here"

CIRCLES: tuple[tuple[float, int], ...] = ((3e-4, 0), (3e-4, 1), (5e-4, 0), (1e-3, 0), (2e-3, 0), (0.2, 0))
"""μN in N, and which of the whirls without offset, the largest first: the second one is unstable."""

ORDERS = slice(2, 5)
"""Those among them whose friction force doubles, far from the fold."""

REST_LOADS = (0.01, 0.05, 0.09)
ORBITS = ((0.0015, 0), (0.0015, 1), (0.02, 0), (0.2, 0))
"""μN in N, and which of the whirls with the offset, the outer one first."""

HALVED_OFFSETS = (0.2, 0.1, 0.05)
OFFSET_LOAD = 0.02
"""X0 in m, and μN in N of the whirls that show how they depend on it."""

STICK_LOADS = (0.12, 0.2)
INSIDE = 0.98
OUTSIDE = (1.02, 1.5)
"""μN in N and radii, in units of (9), of discs that stick at the start."""

LATEST = 1.1
"""How long a disc outside is watched, in units of the time that (7) predicts."""

DECAY = (0.02, 60.0)
GROWTHS = ((0.01, 100.0), (0.05, 100.0), (0.09, 60.0))
"""μN in N, and how long deviations from the whirl, and from the equilibrium, are followed in s."""

DISPLACED = 1e-4
"""Of a deviation at its start, in units of the distance from the axis."""

ORBIT_TOLERANCE = WORKING / 10
"""Of periodic motions; those of the reference that they are compared with have a hundredth of it."""

TOLERANCE = 3e-8
"""Of motions that stick: moderate, since a regularised law costs the more the closer it comes to Coulomb's."""

LARGEST_LOAD = 0.2
"""End of the axis in N: twice the friction force C·X0 about which sticking begins. The paper prints no range."""

BRANCH_START = 0.1
BRANCH_END = 1.0
BRANCH_STEP = 0.24
"""μN of the first whirl of the branch in units of C·X0, its last crossing of the x axis in those of X0, and by which
fraction the crossings fall."""

OUTER_LOADS = (0.2, 0.1, 0.05, 0.02)
"""μN in N of whirls before the branch."""

FOLD_START, LEAST_FOLD_START = 0.016, 4.5e-4
"""Friction force a little above that of the fold, in units of C·X0, and in N where that is larger."""

FOLD_STEP = 0.12
"""Of the steps to the fold."""

FOLD_OFFSETS = (0.008, 0.012, 0.016, 0.02, 0.024, 0.03, 0.04, 0.06, 0.1, 0.15, 0.25)
OFFSETS = np.geomspace(0.004, 0.25, 40)
"""X0 in m for which the end of the whirl, and those of the other motions, are computed."""

DAMPINGS = FIG9.damping / 2.0 ** np.arange(3, 7)


def on_six_points(disc: DiscOnDisc) -> DiscOnDisc:
    """Return ``disc`` on six points, as the paper simulated it."""
    return replace(disc, contact_points=6)
