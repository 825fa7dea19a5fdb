"""Motions with given parameters, and ranges of the random motions.

In the paper's parameters m, J and C are all one, so an engine that confuses two of them still moves correctly. Here
no two parameters are equal, so each has its own effect. A mistake may also occur only in a corner of the parameter
space, for a slow disc or for one that turns the other way. Therefore random motions cover the whole range.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from compare.claims import WORKING
from compare.claims.parameters import FIG5, FIG5_STARTS
from reference_model import DiscOnDisc, PinOnDisc
from reference_model.systems import System

PANEL = 0.25
"""Length in s of the integration intervals of forces."""

STICK_RESOLUTION = 5e-4
"""In s, to detect a millisecond. Approximate laws of stick release late, by about 1e-5 s at a tolerance of 1e-9."""

PIN = PinOnDisc(mass=1.3, stiffness=2.1, damping=0.17, friction_force=0.11, disc_speed=1.9, offset=0.07)

STIFFENING = replace(PIN, hardening=0.4, stop_gap=0.2, stop_stiffness=0.2)

DISC = DiscOnDisc(
    mass=1.3,
    polar_inertia=0.7,
    stiffness=2.1,
    damping=0.4,
    friction_force=0.055,
    disc_speed=1.9,
    offset=0.03,
    contact_radius=0.15,
    shaft_damping=0.02,
    shaft_speed=0.8,
)

SIX = replace(DISC, contact_points=6)

OTHER_WAY = replace(DISC, damping=0.15, disc_speed=-1.9, shaft_speed=-1.6)


@dataclass(frozen=True)
class Motion:
    """Parameters, initial state, duration in s, whether stick occurs, tolerance of the engine, resolution and source.

    The resolution is in SI units.
    """

    system: System
    start: tuple[float, ...]
    until: float
    sticks: bool = False
    tolerance: float = WORKING / 10
    resolution: float = 1e-7
    source: str = "no two parameters are equal, and nothing sticks after the start (our choice)"


DISC_START = (0.06, 0.01, 0.2, -0.01, 0.02, 0.9)

PINS = {
    "a pin": Motion(PIN, (0.6, 0.1, -0.2, 0.5), 20.0),
    "a pin inside the play of its stop, with the disc turning the other way": Motion(
        replace(PIN, disc_speed=-PIN.disc_speed, stop_gap=1.0, stop_stiffness=0.2),
        (0.6, 0.1, -0.1, -0.6),
        20.0,
    ),
    "a pin on a support that hardens, beyond its stop": Motion(STIFFENING, (0.6, 0.1, -0.2, 0.5), 20.0),
}

PINS_THAT_STICK = {
    "a pin that sticks on its way": Motion(
        FIG5,
        FIG5_STARTS["whirl"],
        15.0,
        sticks=True,
        tolerance=WORKING,
        resolution=1e-5,
        source="Fig. 5, second start",
    )
}

RINGS = {
    "a disc on the continuous ring": Motion(DISC, DISC_START, 20.0),
    "a disc on the continuous ring, all turning the other way": Motion(
        OTHER_WAY, (0.3, 0.1, 0.3, 0.05, -0.4, -1.7), 20.0
    ),
}

POINTS = {"a disc on six points": Motion(SIX, DISC_START, 20.0)}

MOTIONS = PINS | PINS_THAT_STICK | RINGS | POINTS
"""Only in the pin that sticks does a point of the contact come to rest, where friction has a kink."""

ONE_OF_EACH_KIND = tuple(next(iter(kind.values())) for kind in (PINS, PINS_THAT_STICK, POINTS))
"""Motions for an engine that differs from another one only in its contact."""

# --- Drawn from the whole range

SEED = 8

SPEEDS = ((0.1, 0.3), (0.4, 3.0), (4.1, 6.0))
"""Ranges of |ω| in rad/s: slow, near the natural frequency, and fast. The other studies use 0.15 to 5."""

UNTIL = 3.0
"""Duration in s."""

LEAST_SLIP = 0.15
"""Smallest slip relative to the largest, so nothing is almost at rest where forces are integrated."""

MOST_TURN = 2.0
"""Largest rotation in rad of a disc on points during a ``PANEL``, because its forces turn with it."""

STICKS_FOR = (0.2, 2.0)
"""Range of the duration in s of the initial stick phase."""

MOST_PHASES = 6

LEAST_SAMPLES = 4
"""Smallest number of samples in a stick phase, so (7) can be evaluated in its middle."""
