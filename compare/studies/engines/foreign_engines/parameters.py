"""Which recorded settings share a law of friction or an order, and what is listed of all."""

from __future__ import annotations

FIRST_ORDER = (
    "MuJoCo, elliptic cone",
    "Bullet, cone",
    "Drake, TAMSI",
    "Drake, SAP",
    "Drake, lagged",
    "DART, NSGS",
    "DART, FBF",
    "Bullet, our force",
    "DART, our force",
    "Chipmunk, pivot joint",
    "Box2D, friction joint",
    "Rapier, contact",
    "Jolt, contact",
)
"""Settings whose steps are of order 1 where contact slides, and whose friction is Coulomb's, at least for a pin."""

SINGLE_PRECISION = ("Box2D, friction joint", "Rapier, contact", "Jolt, contact")
"""Settings whose rounding grows beyond the error of a step before that is halved often."""

OFF_FOR_DISCS = ("Bullet, cone", "Chipmunk, pivot joint")
"""Settings that know Coulomb's friction for a pin, and another law for a disc on several points."""

BOXES, PYRAMIDS = ("Bullet, box", "DART, Dantzig", "DART, PGS"), ("MuJoCo, pyramidal cone",)

BY_AXIS = PYRAMIDS + BOXES
"""Settings whose friction knows two axes of the world instead of a direction."""

STICKING = (
    *(name for name in FIRST_ORDER if name not in ("Drake, SAP", "Drake, lagged", *SINGLE_PRECISION)),
    "MuJoCo, elliptic cone, RK4",
    "MuJoCo, our force",
)
"""Settings with Coulomb friction and steps of a fixed length, that can be halved four times before errors grow."""

TANGENTS = (
    *("Bullet, cone", "Bullet, box", "DART, NSGS", "DART, FBF", "DART, Dantzig", "DART, PGS"),
    *("Chipmunk, pivot joint", "Box2D, friction joint"),
)
"""Settings that leave no slip at the end of a step in which contact sticks, and whose rounding does not show."""

WANTED = 1e-3
"""Error in m, the time to which is listed: the largest that shows in no picture of the paper."""

HALVED = 0.02
"""How far the quotient of two numbers of steps may be from 2, as steps divide the interval between output times."""
