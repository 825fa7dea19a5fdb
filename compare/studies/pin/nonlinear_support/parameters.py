"""Pins and a disc on supports that harden or have a stop, and how they are started."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from compare.claims.error_estimates import WORKING
from compare.claims.paper_parameters import CENTRED, FIG5, FIG9

HARDENING = replace(CENTRED, hardening=0.5)
STOP = replace(CENTRED, stop_gap=0.6, stop_stiffness=2.0)
PINS = {"hardening": HARDENING, "stop": STOP}
"""Fig. 4 without its offset. The circle of each turns slower than the disc at all friction forces below."""

LAWS = (
    f"C₃ = {HARDENING.hardening:g} N/m³ without a stop, and C_s = {STOP.stop_stiffness:g} N/m beyond "
    f"{STOP.stop_gap:g} m without C₃"
)

SOURCE = "Fig. 4, with β, μN and X0 as stated; C₃, C_s and the gap are our choice, the paper names no law"

LOADS = (0.04, 0.1, 0.2)
"""μN in N; at the smallest one the pin does not reach the stop."""

OFFSET = 0.1
"""X0 in m of the orbits, that of Fig. 4."""

OFFSETS = (0.004, 0.005, 0.0063, 0.008, 0.01)
"""X0 in m for the order of the harmonic balance: its next term reaches 5 % of the first at the largest."""

RESTING = {"offset": 0.8, "friction_force": 0.9}
"""At which support and friction balance in the bend of either law."""

BESIDE = 0.005
"""In m: how far from there pins are started."""

REST_TIMES = np.concatenate(([0.0], np.linspace(270.0, 280.0, 11)))
"""In s: they have come to rest by then."""

SLIDING_START = (0.3, 0.0, 0.0, 0.2)
SLIDING_TIMES = np.linspace(0.0, 50.0, 51)

STICKING = replace(
    FIG5,
    friction_force=0.2,
    disc_speed=1.0,
    offset=0.15,
    hardening=5.0,
    stop_gap=0.1,
    stop_stiffness=1.0,
)
TOLERANCE = 10 * WORKING
"""Of the motions whose error is but a hundredth of the resolution then."""

STICKS_BY = 2.0
"""In s, after which the pin of Fig. 5's second start has stuck and let go again."""

DISC = replace(FIG9, damping=0.1, friction_force=0.12, offset=0.0, hardening=HARDENING.hardening)

GROWING_LOADS = (0.12, 0.06, 0.03)
"""μN in N of pins without damping; what friction alone makes of the radius where they end falls with it."""

AMPLIFIED = 6.0
"""Sum of the sizes of the weights 1/3, −2 and 8/3 of the parabola through the radii for them at 0, rounded up."""

GROWING_FROM = 0.3
"""In m: further in, the largest of these friction forces holds a pin on the disc."""

FOLLOWED_ON = 0.2
"""In s: after a pin without damping has stuck."""

GROWN = 1e-6
"""Tolerance of what grows to a motion of its own: only where that ends is asked."""
