"""Planes of two parameters about the disc of Fig. 11, and the curves that bound its motions there."""

from __future__ import annotations

from compare.claims.parameters import FIG11
from reference_model.contact.contact_law import IsotropicContact, Ring, ThreeTermRing
from reference_model.steady.bifurcation_curves import Boundary, Kind, ParameterPlane, boundaries

LAWS: dict[str, IsotropicContact] = {
    "ring": Ring(FIG11.contact_radius),
    "(23)": ThreeTermRing(FIG11.contact_radius),
}

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
    """Return the curves of a kind in one of ``PLANES``, by one of ``LAWS``."""
    return boundaries(PLANES[plane], kind, LAWS[law], step=step)
