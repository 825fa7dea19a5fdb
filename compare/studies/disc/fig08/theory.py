"""Steady states by eqs. (24) to (26) and by (23), and the curves of Fig. 8."""

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
    positions_by_26,
    reduced_parameters,
    shaft_torque,
    speed_difference_at,
    squared_distance,
)
from reference_model.systems import DiscOnDisc, FloatArray

# --- Parameters

RING = FIG8
"""Disc of Fig. 8 on the continuous ring (20)."""

SIX = replace(RING, contact_points=6)
"""Disc of the paper's simulations."""

PAPER_LAW = ThreeTermRing(FIG8.contact_radius)
"""Contact law (23)."""

SOURCE = "Fig. 8; X0 = 0.1 m as in Figs. 4 to 6, which the paper omits; the friction forces are our choice"

SOURCE_OF_GRID = "Fig. 8; friction forces and X0 are our choice, the paper omits X0"

LOADS = (0.01, 0.035, 0.065, 0.095, 0.104)
"""Friction forces in N. The paper does not print a range; the equilibrium ends slightly above C·X0 = 0.1 N."""

DECAYS = ((0.05, (700.0, 1000.0)), (0.095, (250.0, 400.0)))
"""Friction force in N, and the time span in s of the measured decay, late enough for small deviations."""

END_LOADS = (0.1015, 0.1025, 0.1035, 0.1044, 0.1049, 0.1052)
"""Friction forces in N close to the end of the equilibrium, where its distance from the axis falls linearly."""

STICKING_RATIOS = (0.98, 1.02, 1.05)
"""Friction forces in units of the largest one with an equilibrium."""

STICKING_TIME = 80.0
"""Time in s within which friction can accelerate a disc from 95 % to the speed of the master disc."""

OFFSETS = (0.02, 0.05, 0.1, 0.2)
"""Offsets X0 in m; the paper does not print X0, 0.1 m is the value of Figs. 4 to 6."""

TOLERANCE = WORKING / 10
"""Tolerance of motions to a position of rest, which the claims resolve to 1e-9."""

BALANCED = 1e-9
"""Largest residual force over μN due to rounding; (26) as printed leaves far more."""

RESOLUTION = 1e-9
"""Resolution of positions in m and spins in rad/s on the continuous ring."""


def place_and_spin(disc: DiscOnDisc, contact: IsotropicContact | None = None) -> FloatArray:
    """Return x and y in m and spin in rad/s of the self-centred equilibrium."""
    equilibrium = equilibrium_of(disc, contact)
    return np.array([equilibrium.x, equilibrium.y, equilibrium.spin])


def grid() -> list[DiscOnDisc]:
    """Return discs with all ``OFFSETS`` and friction forces up to the largest one by (23), to check (26)."""
    fractions = np.linspace(0.0, 1.0, 13)[1:-1]
    return [
        with_load(disc, fraction * last_load(disc, PAPER_LAW))
        for disc in (replace(RING, offset=offset) for offset in OFFSETS)
        for fraction in fractions
    ]


def by_26(disc: DiscOnDisc) -> FloatArray:
    """Return x and y in m and spin in rad/s by the corrected (26)."""
    (place,) = positions_by_26(disc)
    return np.array(place)


def unbalanced(disc: DiscOnDisc, as_printed: bool) -> float:
    """Return the residual force of springs and friction (23) over μN, at the position by (26)."""
    place, *_ = positions_by_26(disc, as_printed=as_printed)
    z, omega = complex(place.x, place.y), disc.disc_speed
    friction, _ = PAPER_LAW.force_and_moment(-1j * omega * z, omega - place.spin, 0.0)
    return abs(disc.stiffness * (disc.offset - z) / disc.friction_force + friction)


def last_load_by_26(disc: DiscOnDisc) -> float:
    """Return the friction force in N where A of (26) becomes zero."""
    difference = reduced_parameters(disc).speed_difference

    def miss(unknowns: FloatArray) -> FloatArray:
        load, alpha = unknowns
        loaded = with_load(disc, load)
        squared, first_line = squared_distance(loaded, alpha), speed_difference_at(loaded, 0.0, alpha)
        return np.array([squared / disc.offset**2, first_line - difference])

    start = disc.stiffness * disc.offset + shaft_torque(disc) / disc.contact_radius
    return float(root(miss, [start, math.pi / 4.0], options={"xtol": ROUNDING}).x[0])


def curves(count: int = 121) -> Data:
    """Return spins and positions over ``count`` values of μN, and their ends over X0."""
    data: Data = {"offset": np.array(OFFSETS)}
    for offset in OFFSETS:
        disc = replace(RING, offset=offset)
        for name, law in (("ring", None), ("corrected", PAPER_LAW)):
            # Denser towards the end, where the spin rises steeply.
            loads = last_load(disc, law) * np.sin(np.linspace(0.0, 0.5 * np.pi, count))[:-1]
            data[f"{name} load {offset:g}"] = loads
            data[f"{name} {offset:g}"] = np.array(
                [place_and_spin(with_load(disc, load), law) for load in loads]
            )
    loads = np.linspace(0.0, 1.08 * last_load(RING), count)
    data["printed load"] = loads
    data["printed"] = np.array([positions_by_26(with_load(RING, load), as_printed=True)[0] for load in loads])
    shared = np.array(
        [load for load in data[f"ring load {RING.offset:g}"] if load < last_load(RING, PAPER_LAW)]
    )
    ring = np.array([place_and_spin(with_load(RING, load)) for load in shared])
    corrected = np.array([place_and_spin(with_load(RING, load), PAPER_LAW) for load in shared])
    printed = np.array([positions_by_26(with_load(RING, load), as_printed=True)[0] for load in shared])
    data |= {
        "distance load": shared,
        "distance corrected": np.abs(corrected - ring),
        "distance printed": np.abs(printed - ring),
    }
    data["end offset"] = np.geomspace(0.002, 0.5, 61)
    data["end"] = np.array([last_load(replace(RING, offset=offset)) for offset in data["end offset"]])
    return data
