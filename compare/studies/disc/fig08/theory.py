"""Eq. 24 to 26 against the steady states of (23), and the curves of Fig. 8."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from scipy.optimize import root

from compare.claims import ROUNDING, WORKING, Data
from compare.claims.parameters import FIG8
from compare.studies.toolkit.steady_motion import equilibrium_of, last_load, with_load
from reference_model.contact.contact_law import IsotropicContact, ThreeTermRing
from reference_model.formulas.disc import (
    places_by_26,
    reduced_parameters,
    shaft_torque,
    speed_difference_at,
    squared_distance,
)
from reference_model.systems import DiscOnDisc, FloatArray

# --- The disc of Fig. 8, the friction forces at which it is measured, and the offsets that the paper leaves open.

RING = FIG8
"""Fig. 8 on the continuous ring of (20)."""

SIX = replace(RING, contact_points=6)
"""What the paper simulated."""

PAPER_LAW = ThreeTermRing(FIG8.contact_radius)
"""(23)."""

SOURCE = (
    "Fig. 8; X0 = 0.1 m as in Figs. 4 to 6, which the paper leaves out; the friction forces are our choice"
)

SOURCE_OF_GRID = "Fig. 8; friction forces and X0 are our choice, the paper leaves out X0"

LOADS = (0.01, 0.035, 0.065, 0.095, 0.104)
"""μN in N. The paper prints no range; the equilibrium ends a little above C·X0 = 0.1 N."""

DECAYS = ((0.05, (700.0, 1000.0)), (0.095, (250.0, 400.0)))
"""μN in N, and in s the span in which the decay is measured: late enough for small deviations."""

END_LOADS = (0.1015, 0.1025, 0.1035, 0.1044, 0.1049, 0.1052)
"""μN in N, near to where the equilibrium ends; there the distance from the axis falls to zero linearly."""

STICKING_RATIOS = (0.98, 1.02, 1.05)
"""Friction forces about the last one with an equilibrium, in units of it."""

STICKING_TIME = 80.0
"""In s: in that time friction takes a disc with 95 % of the speed of the master disc along, where it can."""

OFFSETS = (0.02, 0.05, 0.1, 0.2)
"""X0 in m, which the paper leaves out; 0.1 is that of Figs. 4 to 6."""

TOLERANCE = WORKING / 10
"""Of the motions to a rest, of which the claims resolve 1e-9."""

BALANCED = 1e-9
"""Of μN: a force below is rounding, and the bracket of (26) as printed leaves far more."""

RESOLUTION = 1e-9
"""Of places in m and spins in rad/s on the continuous ring."""


def place_and_spin(disc: DiscOnDisc, contact: IsotropicContact | None = None) -> FloatArray:
    """Return x and y in m and spin in rad/s of the self-centred equilibrium."""
    equilibrium = equilibrium_of(disc, contact)
    return np.array([equilibrium.x, equilibrium.y, equilibrium.spin])


def grid() -> list[DiscOnDisc]:
    """Return discs on which (26) is tried: all of ``OFFSETS`` under friction forces up to the last one by (23)."""
    fractions = np.linspace(0.0, 1.0, 13)[1:-1]
    return [
        with_load(disc, fraction * last_load(disc, PAPER_LAW))
        for disc in (replace(RING, offset=offset) for offset in OFFSETS)
        for fraction in fractions
    ]


def by_26(disc: DiscOnDisc) -> FloatArray:
    """Return x and y in m and spin in rad/s of the corrected (26)."""
    (place,) = places_by_26(disc)
    return np.array(place)


def unbalanced(disc: DiscOnDisc, as_printed: bool) -> float:
    """Return the force over μN that springs and friction (23) leave at the place of (26)."""
    place, *_ = places_by_26(disc, as_printed=as_printed)
    z, omega = complex(place.x, place.y), disc.disc_speed
    friction, _ = PAPER_LAW.force_and_moment(-1j * omega * z, omega - place.spin, 0.0)
    return abs(disc.stiffness * (disc.offset - z) / disc.friction_force + friction)


def last_load_by_26(disc: DiscOnDisc) -> float:
    """Return the friction force in N at which A of (26) becomes zero."""
    difference = reduced_parameters(disc).speed_difference

    def miss(unknowns: FloatArray) -> FloatArray:
        load, alpha = unknowns
        loaded = with_load(disc, load)
        squared, first_line = squared_distance(loaded, alpha), speed_difference_at(loaded, 0.0, alpha)
        return np.array([squared / disc.offset**2, first_line - difference])

    start = disc.stiffness * disc.offset + shaft_torque(disc) / disc.contact_radius
    return float(root(miss, [start, math.pi / 4.0], options={"xtol": ROUNDING}).x[0])


def curves(count: int = 121) -> Data:
    """Return spins and places over ``count`` values of μN, for Fig. 8 and all offsets, and their ends over X0."""
    data: Data = {"offset": np.array(OFFSETS)}
    for offset in OFFSETS:
        disc = replace(RING, offset=offset)
        for name, law in (("ring", None), ("corrected", PAPER_LAW)):
            # Closer to each other towards the end, where the spin rises steeply.
            loads = last_load(disc, law) * np.sin(np.linspace(0.0, 0.5 * np.pi, count))[:-1]
            data[f"{name} load {offset:g}"] = loads
            data[f"{name} {offset:g}"] = np.array(
                [place_and_spin(with_load(disc, load), law) for load in loads]
            )
    loads = np.linspace(0.0, 1.08 * last_load(RING), count)
    data["printed load"] = loads
    data["printed"] = np.array([places_by_26(with_load(RING, load), as_printed=True)[0] for load in loads])
    shared = np.array(
        [load for load in data[f"ring load {RING.offset:g}"] if load < last_load(RING, PAPER_LAW)]
    )
    ring = np.array([place_and_spin(with_load(RING, load)) for load in shared])
    corrected = np.array([place_and_spin(with_load(RING, load), PAPER_LAW) for load in shared])
    printed = np.array([places_by_26(with_load(RING, load), as_printed=True)[0] for load in shared])
    data |= {
        "distance load": shared,
        "distance corrected": np.abs(corrected - ring),
        "distance printed": np.abs(printed - ring),
    }
    data["end offset"] = np.geomspace(0.002, 0.5, 61)
    data["end"] = np.array([last_load(replace(RING, offset=offset)) for offset in data["end offset"]])
    return data
