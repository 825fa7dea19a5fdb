"""Eq. 24 to 26 against the steady states of (23), and the curves of Fig. 8."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.optimize import brentq, root

from compare.claims.answers import holds
from compare.claims.claim import Claim, ErrorBudget
from compare.claims.error_estimates import ROUNDING
from compare.claims.paper_parameters import FIG8
from compare.claims.parameters import at_each, parameters_of
from compare.claims.study import Data, Findings
from reference_model import self_centred_equilibria
from reference_model.contact.contact_law import IsotropicContact, ThreeTermRing
from reference_model.formulas.disc import (
    held_pin,
    places_by_26,
    reduced_parameters,
    shaft_torque,
    speed_difference_at,
    squared_distance,
)
from reference_model.steady.steady_states import SpinningEquilibrium
from reference_model.systems import DiscOnDisc, FloatArray

RING = FIG8
"""Fig. 8 on the continuous ring of (20)."""

PAPER_LAW = ThreeTermRing(FIG8.contact_radius)
"""(23)."""

OFFSETS = (0.02, 0.05, 0.1, 0.2)
"""X0 in m, which the paper leaves out; 0.1 is that of Figs. 4 to 6."""

BALANCED = 1e-9
"""Of μN: a force below is rounding, and the bracket of (26) as printed leaves far more."""

SOURCE_OF_GRID = "Fig. 8; loads and X0 are our choice, the paper leaves out X0"

CORRECTED = "The corrected (26) is the equilibrium of (23), at every load and offset"
PRINTED = "At none of the places of (26) as printed do springs and friction (23) balance"
END_BY_26 = (
    "The corrected (26) ends at the load at which friction (23) holds the disc against springs and shaft"
)


def with_load(disc: DiscOnDisc, load: float) -> DiscOnDisc:
    """Return ``disc`` under the load μN in N."""
    return replace(disc, friction_force=float(load))


def equilibrium_of(disc: DiscOnDisc, contact: IsotropicContact | None = None) -> SpinningEquilibrium:
    """Return the one self-centred equilibrium of a disc under an isotropic law."""
    (equilibrium,) = self_centred_equilibria(disc, contact)
    return equilibrium


def place_and_spin(disc: DiscOnDisc, contact: IsotropicContact | None = None) -> FloatArray:
    """Return x and y in m and spin in rad/s of :func:`equilibrium_of`."""
    equilibrium = equilibrium_of(disc, contact)
    return np.array([equilibrium.x, equilibrium.y, equilibrium.spin])


def last_load(disc: DiscOnDisc, contact: IsotropicContact | None = None) -> float:
    """Return the μN in N at which the self-centred equilibrium ends: (5) for a disc.

    From there on friction can give the force C·|X0|, which holds the disc on the axis, beside the moment b|ω − Ω| of
    the shaft. Both lie within the limit surface, which is convex, if C·|X0| + b|ω − Ω|/R <= μN.
    """
    springs, moment = disc.stiffness * abs(disc.offset), shaft_torque(disc) / disc.contact_radius

    def spare(load: float) -> float:
        return held_pin(with_load(disc, load), contact).friction_force - springs

    least = max(springs, moment * (1.0 + ROUNDING))  # what one of the two takes alone
    return float(brentq(spare, least, springs + moment, xtol=ROUNDING * springs, rtol=ROUNDING))


def theory(loads: int = 121) -> Findings:
    """Hold (26), corrected and as printed, against (23), and compute the curves at so many loads."""
    fractions = np.linspace(0.0, 1.0, 13)[1:-1]
    discs = [
        with_load(replace(RING, offset=offset), fraction * last_load(replace(RING, offset=offset), PAPER_LAW))
        for offset in OFFSETS
        for fraction in fractions
    ]
    return Findings((corrected_claim(discs), printed_claim(discs), end_by_26_claim()), curves(loads))


def corrected_claim(discs: Sequence[DiscOnDisc]) -> Claim:
    """Compare places and spins of (26) with the equilibria of (23)."""

    def by_26(disc: DiscOnDisc) -> FloatArray:
        (place,) = places_by_26(disc)
        return np.array(place)

    measured = np.array([by_26(disc) for disc in discs])
    moved = np.array([by_26(with_load(disc, disc.friction_force * (1.0 + ROUNDING))) for disc in discs])
    return Claim(
        CORRECTED,
        equation="(26)",
        engine="theory",
        predicted=[place_and_spin(disc, PAPER_LAW) for disc in discs],
        measured=measured,
        budget=ErrorBudget(np.abs(moved - measured) + ROUNDING * RING.offset, resolution=1e-12),
        parameters=parameters_of(RING, without=("friction_force", "offset")),
        source=SOURCE_OF_GRID,
        unit="m, rad/s",
        note=f"x, y and spin at {len(discs)} pairs of load and offset, {at_each('X0', OFFSETS)} m. Predicted: "
        "balance of forces and moments of (19) with (23). Error: that of rounded parameters.",
    )


def printed_claim(discs: Sequence[DiscOnDisc]) -> Claim:
    """Count the places of (26) at which the disc would rest."""
    left = {as_printed: [_unbalanced(disc, as_printed) for disc in discs] for as_printed in (False, True)}
    return Claim(
        PRINTED,
        equation="(26)",
        engine="theory",
        **holds([BALANCED - force for force in left[False]] + [force - BALANCED for force in left[True]]),
        parameters=parameters_of(RING, without=("friction_force", "offset")),
        source=SOURCE_OF_GRID,
        note=f"Whether the force that is left at a place is below {BALANCED:g}·μN by the corrected (26), and above "
        f"by the printed one, at {len(discs)} places each. By the corrected one it is at most "
        f"{max(left[False]):.1g}·μN, by the printed one {min(left[True]):.2g} to {max(left[True]):.2g}·μN.",
    )


def _unbalanced(disc: DiscOnDisc, as_printed: bool) -> float:
    """Return the force over μN that springs and friction (23) leave at the place of (26)."""
    place, *_ = places_by_26(disc, as_printed=as_printed)
    z, omega = complex(place.x, place.y), disc.disc_speed
    friction, _ = PAPER_LAW.force_and_moment(-1j * omega * z, omega - place.spin, 0.0)
    return abs(disc.stiffness * (disc.offset - z) / disc.friction_force + friction)


def end_by_26_claim() -> Claim:
    """Compare the load at which (26) ends with that at which friction (23) can hold the disc."""
    discs = [replace(RING, offset=offset) for offset in OFFSETS]
    predicted = [last_load(disc, PAPER_LAW) for disc in discs]
    return Claim(
        END_BY_26,
        equation="(5), (26)",
        engine="theory",
        predicted=predicted,
        measured=[_end_by_26(disc) for disc in discs],
        budget=ErrorBudget(2.0 * ROUNDING * np.array(predicted), resolution=1e-9),
        parameters=parameters_of(RING, without=("friction_force", "offset")),
        source=SOURCE_OF_GRID,
        unit="N",
        note=f"{at_each('X0', OFFSETS)} m. Measured: load and α at which the first two lines of (26) hold "
        "with A = 0.",
    )


def _end_by_26(disc: DiscOnDisc) -> float:
    """Return the load in N at which A of (26) becomes zero."""
    difference = reduced_parameters(disc).speed_difference

    def miss(unknowns: FloatArray) -> FloatArray:
        load, alpha = unknowns
        loaded = with_load(disc, load)
        squared, first_line = squared_distance(loaded, alpha), speed_difference_at(loaded, 0.0, alpha)
        return np.array([squared / disc.offset**2, first_line - difference])

    start = disc.stiffness * disc.offset + shaft_torque(disc) / disc.contact_radius
    return float(root(miss, [start, math.pi / 4.0], options={"xtol": ROUNDING}).x[0])


def curves(count: int) -> Data:
    """Return spins and places over the load, for Fig. 8 and for all offsets, and the ends over the offset."""
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
