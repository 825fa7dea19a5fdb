"""What the motions of Fig. 11 start from, how they are followed, and the offsets that the paper leaves open."""

from __future__ import annotations

import numpy as np

from compare.claims import WORKING, Study
from compare.claims.parameters import FIG8, FIG11
from compare.studies.toolkit.fig11 import RING, SOURCE, START
from reference_model.contact.contact_law import ThreeTermRing
from reference_model.systems import ANGLE

EXPANSION = ThreeTermRing(RING.contact_radius)
"""(23)."""

CENTRED = f"{SOURCE}: 0 here"

FROM_THE_CYCLE = f"{CENTRED}; start {START}"

COMPONENTS = ("x in m", "y in m", "angle in rad", "vx in m/s", "vy in m/s", "spin in rad/s")

EXTREMES = ("least radius in m", "greatest radius in m", "least spin in rad/s", "greatest spin in rad/s")

SLIDING_START = (0.02, 0.0, 0.0, 0.0, 0.02, 1.39)
"""From here no point of the contact comes to rest for 100 s (our choice)."""

SLIDING = np.linspace(0.0, 100.0, 101)

UNTIL = 700.0
"""In s: three periods of the modulation."""

TIMES = np.linspace(0.0, UNTIL, 2801)

ROUND = np.linspace(0.0, 300.0, 1201)
"""In s: one period of the modulation and more."""

OF_CYCLE = 10 * WORKING
"""Tolerance of the motion that settles on the modulated cycle."""

OF_RESTS = 200 * WORKING
"""Tolerance of the motions of which it is asked when single points rest."""

AMPLITUDE = 1e-4
"""Of the deviation at its start, in units of the whirl's radius."""

DURATION = 200.0
"""In s: about a period of the modulation, in which the deviation grows by a factor of ten."""

TOLERANCE = 2000 * WORKING
"""Its error must be small beside a deviation that grows from ``AMPLITUDE``."""

FOLLOWED = 900.0
"""In s: by then a deviation has grown to the modulated cycle."""

STEP = 1e-4
"""Of the differences that give its linearised return map, in units of the whirl's radius."""

TRIED = (0.0072, 0.00725, 0.0073)
"""X0 in m of the whirls between which the critical one is interpolated."""

OFFSETS = (0.0, 0.004, 0.007, 0.009, 0.018, 0.022, FIG8.offset)
"""X0 in m of the long simulations; the last one is that of the other figures."""

ENDS_UNTIL = 720.0
"""Their length in s."""

LOOKED_AT = 240.0
"""In s, at their end: a period of the modulation."""

SAMPLES_A_TURN = 16

ENDS_TOLERANCE = 1e-4
"""Of the long simulations."""

SWING = 0.005
"""In rad/s: the least swing of the spin, averaged over a turn, of a modulated motion; a tenth of that at X0 = 0."""

ORBITS_EXTENT = 1e-4
"""In m: the least swing of the radius of a motion that is none of rest."""

BOTH_STABLE = 0.0073
"""X0 in m, a little above the critical one."""

MODULATED_THERE = (0.01608, -0.00617, 0.0, 0.00943, 0.01375, 1.39531)
"""A state near the modulated motion at that offset, found by simulation while X0 was raised in small steps."""

BRANCH = np.array(
    [*np.linspace(0.0, 0.015, 11), 0.016, 0.0166, 0.0175, 0.0185, 0.0192, 0.0196, 0.0198, 0.0199, 0.01993]
)
"""X0 in m of the whirls in the figure: up to the fold at 0.019930 m, beyond where the equilibrium becomes stable."""

KINDS = ("rest", "whirl", "modulated")

WITHOUT_ANGLE = [i for i in range(FIG11.state_size) if i != ANGLE]


# --- The study of Fig. 11, to which the modules beside this one add its claims.

STUDY = Study.beside(
    __file__,
    "fig11",
    source=FROM_THE_CYCLE,
    system=RING,
    seconds=5.0,
    words={"both_stable": f"{BOTH_STABLE:g}", "other_offset": f"{FIG8.offset:g}"},
)
