"""What the parts of the study of Fig. 11 share: its start, its source, and (19) as plain equations."""

from __future__ import annotations

import functools
from dataclasses import replace

import numpy as np
from scipy.integrate import solve_ivp

from compare.claims.parameters import FIG11
from reference_model import plain
from reference_model.contact.contact_law import contact_of
from reference_model.systems import DiscOnDisc, FloatArray

RING = FIG11

SIX = replace(FIG11, contact_points=6)

DISCS = {"the continuous ring": RING, "six points": SIX}

START = (0.0389, 0.0, 0.0, 0.0, 0.0389, 1.38664)
"""x, y, angle, vx, vy, spin where the radius is largest on the modulated cycle of X0 = 0, to these digits."""

SOURCE = "Fig. 11, which leaves out X0"


def rates(disc: DiscOnDisc, state: FloatArray) -> list[float]:
    """Return the right side of (19) with (20) or (21) at ``state``, shape (6,)."""
    return plain.rates(disc, plain.by_law(disc.friction_force, contact_of(disc)), state)


@functools.cache
def integrated(
    disc: DiscOnDisc, start: tuple[float, ...], until: float, samples: int, tolerance: float
) -> FloatArray:
    """Return the states at so many times up to ``until`` s, shape (samples, 6), from (19) as it stands.

    For a disc that slides all the time. Nothing of ``simulate`` is used.
    """
    friction = plain.by_law(disc.friction_force, contact_of(disc))
    run = solve_ivp(
        lambda _, state: plain.rates(disc, friction, state),
        (0.0, until),
        start,
        method="DOP853",
        t_eval=np.linspace(0.0, until, samples),
        rtol=tolerance,
        atol=tolerance,
    )
    return np.asarray(run.y.T)
