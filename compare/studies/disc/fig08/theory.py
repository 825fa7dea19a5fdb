"""Eq. 24 to 26 against the steady states of (23), and the curves of Fig. 8."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from scipy.optimize import root

from compare.claims.error_estimates import ROUNDING
from compare.claims.study import Data
from compare.studies.disc.fig08.parameters import OFFSETS, PAPER_LAW, RING
from compare.studies.toolkit.self_centred import equilibrium_of, last_load, with_load
from reference_model.contact.contact_law import IsotropicContact
from reference_model.formulas.disc import (
    places_by_26,
    reduced_parameters,
    shaft_torque,
    speed_difference_at,
    squared_distance,
)
from reference_model.systems import DiscOnDisc, FloatArray


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
