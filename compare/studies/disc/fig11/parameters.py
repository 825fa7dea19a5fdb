"""Initial states, durations, tolerances and offsets of the motions of Fig. 11; the paper does not print them."""

from __future__ import annotations

import numpy as np

from compare.claims import WORKING, Study
from compare.claims.parameters import FIG8, FIG11
from compare.studies.toolkit.fig11 import RING, SOURCE, START
from reference_model.contact.contact_law import ThreeTermRing
from reference_model.systems import ANGLE

EXPANSION = ThreeTermRing(RING.contact_radius)
"""Contact law (23)."""

CENTRED = f"{SOURCE}: 0 here"

FROM_THE_CYCLE = f"{CENTRED}; start {START}"

COMPONENTS = ("x in m", "y in m", "angle in rad", "vx in m/s", "vy in m/s", "spin in rad/s")

EXTREMES = ("smallest radius in m", "largest radius in m", "smallest spin in rad/s", "largest spin in rad/s")

SLIDING_START = (0.02, 0.0, 0.0, 0.0, 0.02, 1.39)
"""Initial state of a motion whose contact points all slip for 100 s (our choice)."""

SLIDING = np.linspace(0.0, 100.0, 101)

UNTIL = 700.0
"""Duration in s, three periods of the modulation."""

TIMES = np.linspace(0.0, UNTIL, 2801)

ROUND = np.linspace(0.0, 300.0, 1201)
"""Times in s, over more than one period of the modulation."""

OF_CYCLE = 10 * WORKING
"""Tolerance of the motion that settles on the modulated cycle."""

OF_RESTS = 200 * WORKING
"""Tolerance of the motions on six points, where single points come to rest."""

AMPLITUDE = 1e-4
"""Initial size of a deviation, in units of the whirl's radius."""

DURATION = 200.0
"""Duration in s, about a period of the modulation; the deviation grows tenfold."""

TOLERANCE = 2000 * WORKING
"""Tolerance for deviations, small compared with ``AMPLITUDE``."""

FOLLOWED = 900.0
"""Time in s until a deviation has grown to the modulated cycle."""

STEP = 1e-4
"""Finite-difference step for the linearised return map, in units of the whirl's radius."""

TRIED = (0.0072, 0.00725, 0.0073)
"""Offsets X0 in m between which the critical X0 is interpolated."""

OFFSETS = (0.0, 0.004, 0.007, 0.009, 0.018, 0.022, FIG8.offset)
"""Offsets X0 in m of the long simulations, the last one from the other figures."""

ENDS_UNTIL = 720.0
"""Duration in s of the long simulations."""

LOOKED_AT = 240.0
"""Length in s of their evaluated end, a period of the modulation."""

SAMPLES_A_TURN = 16

ENDS_TOLERANCE = 1e-4
"""Tolerance of the long simulations."""

SWING = 0.005
"""Smallest swing in rad/s of a modulated motion's spin, averaged over a turn; a tenth of the swing at X0 = 0."""

ORBITS_EXTENT = 1e-4
"""Smallest swing in m of the radius of a motion that counts as a whirl, not as rest."""

BOTH_STABLE = 0.0073
"""Offset X0 in m slightly above the critical one."""

MODULATED_THERE = (0.01608, -0.00617, 0.0, 0.00943, 0.01375, 1.39531)
"""State close to the modulated motion at that offset, found by raising X0 in small steps."""

BRANCH = np.array(
    [*np.linspace(0.0, 0.015, 11), 0.016, 0.0166, 0.0175, 0.0185, 0.0192, 0.0196, 0.0198, 0.0199, 0.01993]
)
"""Offsets X0 in m of the whirls in the figure, up to the fold at 0.019930 m; the equilibrium is stable there."""

KINDS = ("rest", "whirl", "modulated")

WITHOUT_ANGLE = [i for i in range(FIG11.state_size) if i != ANGLE]


# --- The study

STUDY = Study.beside(
    __file__,
    "fig11",
    source=FROM_THE_CYCLE,
    system=RING,
    seconds=5.0,
    words={"both_stable": f"{BOTH_STABLE:g}", "other_offset": f"{FIG8.offset:g}"},
)
