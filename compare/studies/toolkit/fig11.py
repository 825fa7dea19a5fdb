"""Disc of Fig. 11: initial state, (19) as plain equations, and parameter planes."""

import functools
from dataclasses import replace

import numpy as np
from scipy.integrate import solve_ivp

from compare.claims.parameters import FIG11
from reference_model import plain
from reference_model.contact.contact_law import IsotropicContact, Ring, ThreeTermRing, contact_of
from reference_model.steady.bifurcation_curves import Boundary, Kind, ParameterPlane, boundaries
from reference_model.systems import DiscOnDisc, FloatArray

RING, SIX = FIG11, replace(FIG11, contact_points=6)
DISCS = {"the continuous ring": RING, "six points": SIX}

START = (0.0389, 0.0, 0.0, 0.0, 0.0389, 1.38664)
"""x, y, angle, vx, vy, spin at the largest radius of the modulated cycle for X0 = 0, rounded."""

SOURCE = "Fig. 11, which omits X0"


def rates(disc: DiscOnDisc, state: FloatArray) -> list[float]:
    """Return the right-hand side of (19) with (20) or (21), shape (6,)."""
    return plain.rates(disc, plain.by_law(disc.friction_force, contact_of(disc)), state)


@functools.cache
def integrated(
    disc: DiscOnDisc, start: tuple[float, ...], until: float, samples: int, tolerance: float
) -> FloatArray:
    """Return the states of a disc that always slides, by (19) without ``simulate``, shape (samples, 6)."""
    friction, times = plain.by_law(disc.friction_force, contact_of(disc)), np.linspace(0.0, until, samples)
    accuracy = {"method": "DOP853", "rtol": tolerance, "atol": tolerance}
    run = solve_ivp(
        lambda _, state: plain.rates(disc, friction, state), (0.0, until), start, t_eval=times, **accuracy
    )
    return np.asarray(run.y.T)


R = FIG11.contact_radius
LAWS: dict[str, IsotropicContact] = {"ring": Ring(R), "(23)": ThreeTermRing(R)}

PLANES = {
    "load": ParameterPlane(FIG11, ("disc_speed", "friction_force"), (1.005, 5e-4), (3.0, 0.08)),
    "dampers": ParameterPlane(FIG11, ("damping", "shaft_damping"), (0.2, 0.002), (2.0, 0.03)),
    "speeds": ParameterPlane(FIG11, ("disc_speed", "shaft_speed"), (1.005, 0.7), (2.2, 2.2)),
    "inertia": ParameterPlane(FIG11, ("polar_inertia", "shaft_damping"), (0.05, 0.008), (4.0, 0.024)),
}

KINDS: tuple[Kind, ...] = ("onset", "Hopf", "fold")

FINE = 0.04
"""Largest distance between the points of a curve, in units of the ranges."""


def curves_in(plane: str, kind: Kind, law: str, step: float = FINE) -> tuple[Boundary, ...]:
    return boundaries(PLANES[plane], kind, LAWS[law], step=step)
