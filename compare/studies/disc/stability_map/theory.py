"""The stability map in theory: its curves, the eigenvalues that they are checked by, and what the figures show."""

from __future__ import annotations

import functools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, replace
from typing import Any, NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from compare.claims import WORKING, Data, Measured, Study, answers_of, asked
from compare.claims.linearised_flow import ComplexArray, eigenvalues_with_rounding
from compare.claims.parameters import FIG11, at_each
from compare.engines import Simulate
from compare.studies.toolkit.fig11 import KINDS, LAWS, PLANES, curves_in
from reference_model.contact.contact_law import IsotropicContact
from reference_model.formulas.disc import whirl_at
from reference_model.steady.bifurcation_curves import Boundary, Kind
from reference_model.steady.stability import (
    equilibrium_eigenvalues,
    turning_frame_jacobian,
    whirl_eigenvalues,
)
from reference_model.steady.steady_states import whirls
from reference_model.systems import DiscOnDisc, FloatArray

# --- The disc whose surroundings are mapped, what is simulated there, and how closely the curves are looked at.

DISC = FIG11
K = DISC.natural_frequency

SOURCE = "Fig. 11 with X0 = 0; the ranges of the map are ours"
ONE_AT_A_TIME = "Fig. 11 with X0 = 0; one parameter at a time"

BOTH_LAWS = "(19), (20), (23)"
"""Equations of what is claimed of the ring and of (23)."""

LINES = (
    ("load", "disc_speed", 1.5),
    ("dampers", "damping", 0.8),
    ("speeds", "disc_speed", 1.3),
    ("inertia", "polar_inertia", 0.4),
)
"""Lines in planes on which both sides of the Hopf curves of the ring are simulated."""

ASIDE = 0.01
"""How far from the curves, relative."""

DEVIATION = 0.02
"""Of the whirl at the start, in units of the distance to where a point of the ring rests."""

FLOW_TOLERANCE = 100 * WORKING
"""Of the simulations that are subtracted from each other: their differences are small."""

STUCK = 60.0
"""In s, for which a disc that sticks on the axis is watched: nothing changes there, but for an engine's creep."""

OUTSIDE, BEYOND = 0.003, 0.02
"""How far from the Hopf curves, relative, the modulated cycle is beside the whirl, and is gone."""

BESIDE = (1.002, 1.0, 1.0, 1.0, 1.002, 1.0)
"""Factors on x, y, angle, vx, vy, spin of a whirl that lead a little off it."""

ON_CYCLE = (0.035, 0.0, 0.0, 0.0, 0.035, 1.385)
"""State x, y, angle, vx, vy, spin near to where the radius of the modulated cycle is largest."""

LOADS = (
    *(0.0195, 0.0208, 0.0211, 0.0214, 0.0217, 0.0221, 0.0225),
    *(0.0232, 0.024, 0.0247, 0.0251, 0.0255, 0.028),
)
"""In N, of the bifurcation diagram."""

SLOW_LOADS = (0.0208, 0.0211)
"""Those at which the whirl is stable, but disturbances of it fall slowly."""

FAR_FROM_KINK = 0.02
"""Of |U/W − 1|: nearer to where a point of the ring rests, the expansion about the whirl says nothing."""

ONSET_SPEEDS = (1.05, 1.2, 1.4, 1.5, 2.0, 3.0)
"""ω in rad/s at which the onset is found by its eigenvalues."""

NEAR = 1e-3
"""Relative distance from a border at which stability is that of either side."""

STATE_ROUNDING = 4.0 * np.finfo(float).eps
"""Relative, of the spin of a whirl that is given by its α."""

UNSTABLE_LOADS = (0.3, 0.7)
"""Friction forces between the fold and the Hopf point of (23), as fractions."""

BESIDE_LARGEST = ((1.1, 1.0, 1.0, 1.0, 1.1, 1.0), (1.5, 1.0, 1.0, 1.0, 1.5, 1.0))
"""Factors on the state of the larger whirl there."""


def at(**changes: Any) -> DiscOnDisc:
    """Return the disc of Fig. 11 with some other parameters."""
    return replace(DISC, **changes)


Traced = Mapping[tuple[str, str, Kind], tuple[Boundary, ...]]
"""Curves by plane, law and kind."""


@functools.cache
def traced() -> Traced:
    """Trace all curves of the map."""
    return {
        (plane, law, kind): curves_in(plane, kind, law) for plane in PLANES for law in LAWS for kind in KINDS
    }


def state_at(disc: DiscOnDisc, alpha: float, law: IsotropicContact) -> FloatArray:
    """Return the state of the whirl with tan α = R|ω − φ̇|/U, shape (6,)."""
    _, radius, spin = whirl_at(disc, alpha, law)
    return np.array([radius, 0.0, 0.0, 0.0, K * radius, spin])


def points_of(traced: Traced, kind: Kind) -> Iterator[tuple[str, DiscOnDisc, float]]:
    """Yield law, disc and α for every point of the curves of a kind."""
    for (plane, law, found), curves in traced.items():
        for curve in curves if found == kind else ():
            for values, alpha in zip(curve.parameters, curve.alpha.tolist(), strict=True):
                yield law, PLANES[plane].at(values), alpha


def critical_eigenvalues(
    disc: DiscOnDisc, state: FloatArray, law: IsotropicContact
) -> tuple[ComplexArray, float]:
    """Return the eigenvalues of a whirl but for the phase, the critical ones first, and the rounding of those in 1/s.

    That is the rounding of the matrix, by the condition of the eigenvalue, and that of the state: where U and W are
    nearly the same, the slopes of friction depend on what little differs.
    """
    neighbour = state * (1.0 + STATE_ROUNDING * (np.arange(6) == 5))
    values, shifted = (
        np.array(sorted(whirl_eigenvalues(disc, which, law)[1:], key=lambda value: abs(value.real)))
        for which in (state, neighbour)
    )
    found, rounding = eigenvalues_with_rounding(turning_frame_jacobian(disc, state, law))
    error = rounding[np.argmin(np.abs(found - values[0]))]
    return values, float(error + np.min(np.abs(shifted - values[0])))


def spectra(kind: Kind, curves: Traced) -> list[tuple[ComplexArray, float]]:
    """Return the eigenvalues of the whirls at all points of the curves of a kind."""
    return [
        critical_eigenvalues(disc, state_at(disc, alpha, LAWS[law]), LAWS[law])
        for law, disc, alpha in points_of(curves, kind)
    ]


def crossed(curves: Sequence[Boundary], value: float) -> FloatArray:
    """Return the second parameter where curves cross a value of the first, in increasing order."""
    found = []
    for curve in curves:
        steps = np.diff(curve.parameters / np.max(np.abs(curve.parameters), axis=0), axis=0)
        along = np.concatenate(([0.0], np.cumsum(np.linalg.norm(steps, axis=1))))
        first, second = (CubicSpline(along, column) for column in curve.parameters.T)
        found.extend(second(first.solve(value, extrapolate=False)))
    return np.sort(found)


def growth_of_rotation(disc: DiscOnDisc) -> float:
    """Return the largest real part in 1/s of the eigenvalues of the centred rotation on the ring."""
    return equilibrium_eigenvalues(disc, rotation(disc), LAWS["ring"])[0].real


def sticking_load(disc: DiscOnDisc) -> float:
    """Return b|ω − Ω|/R in N, from which on the centred disc sticks to the master disc for ever."""
    return disc.shaft_damping * abs(disc.disc_speed - disc.shaft_speed) / disc.contact_radius


def rotation(disc: DiscOnDisc) -> FloatArray:
    """Return the state of the centred rotation, shape (6,): the shaft overcomes the friction of the spinning ring."""
    against = disc.disc_speed - disc.shaft_speed
    relative_spin = against - math.copysign(
        disc.friction_force * disc.contact_radius / disc.shaft_damping, against
    )
    return np.array([0.0, 0.0, 0.0, 0.0, 0.0, disc.disc_speed - relative_spin])


def change_of_stability(name: str, near: float, law: IsotropicContact) -> tuple[float, float]:
    """Return the value of a parameter near which the pair of a whirl crosses the imaginary axis, and its error.

    Not a number where none does.
    """

    def crossing_pair(value: float) -> tuple[float, float]:
        disc = at(**{name: value})
        pairs = (critical_eigenvalues(disc, whirl.state, law) for whirl in whirls(disc, law))
        return min(((values[0].real, error) for values, error in pairs), key=lambda pair: abs(pair[0]))

    low, high = near * (1.0 - NEAR), near * (1.0 + NEAR)
    below, above = crossing_pair(low)[0], crossing_pair(high)[0]
    if below * above > 0.0:
        return math.nan, 0.0
    value = brentq(lambda value: crossing_pair(value)[0], low, high, xtol=1e-15)
    slope = abs(above - below) / (high - low)
    return value, 2.0 * crossing_pair(value)[1] / slope + 4.0 * np.finfo(float).eps * value


def nearest(values: Sequence[float], to: float) -> list[float]:
    """Return the largest of ``values`` below and the smallest above."""
    below, above = [value for value in values if value < to], [value for value in values if value > to]
    return [*below[-1:], *above[:1]]


def curves() -> Data:
    """Return the curves of the map, and the whirls at the speeds of Fig. 11."""
    data: Data = {}
    for (plane, law, kind), found in traced().items():
        for i, curve in enumerate(found):
            data[f"{plane}/{law}/{kind}/{i}"] = np.column_stack((curve.parameters, curve.alpha))
    return data | section()


def section() -> Data:
    """Return friction force, radius and largest real part of the whirls of Fig. 11 over their α, for each law."""
    data: Data = {}
    alphas = np.linspace(0.45, np.pi / 2.0 - 1e-3, 240)
    for name, law in LAWS.items():
        rows = []
        for alpha in alphas.tolist():
            load, radius, _ = whirl_at(DISC, alpha, law)
            disc = at(friction_force=load)
            rows.append((load, radius, whirl_eigenvalues(disc, state_at(disc, alpha, law), law)[1].real))
        data[f"section/{name}"] = np.array(rows)
    return data


# --- What motions of the centred disc end as.

SETTLED = 600.0
WATCHED = 350.0
"""In s: how long motions are given to settle, and over how long before the end they are looked at."""

SLOWLY_SETTLED = 2400.0
"""In s: what takes longer near to where a cycle has just gone, as disturbances fall at less than 0.01 1/s there."""

SETTLING_TOLERANCE = 1e-5

AXIS = 1e-3
"""Radius in units of R below which a motion counts as rotation about the axis."""

MODULATED = 0.05
"""Of (largest − smallest)/(largest + smallest) radius, above which a motion counts as modulated."""


ENDS = ("rotation", "whirl", "modulated cycle", "sticking")
"""What motions end as."""


class Start(NamedTuple):
    """A disc, the state from which it starts, what it is to end as, and after how many seconds."""

    disc: DiscOnDisc
    state: tuple[float, ...]
    end: str
    duration: float = SETTLED


def kind_of_end(
    simulate: Simulate, start: Start, tolerance: float = SETTLING_TOLERANCE
) -> tuple[str, float, float]:
    """Return what a motion ends as, and the smallest and the largest radius in m of its last part."""
    times = [0.0, *np.linspace(max(start.duration - WATCHED, 0.5 * start.duration), start.duration, 801)]
    run = simulate(start.disc, start.state, times, tolerance=tolerance)
    radius = run.radius[1:]
    low, high = float(np.min(radius)), float(np.max(radius))
    if run.phases[-1].kind == "stick" and run.phases[-1].start <= times[1]:
        return "sticking", low, high
    if high < AXIS * start.disc.contact_radius:
        return "rotation", low, high
    return "modulated cycle" if high - low > MODULATED * (high + low) else "whirl", low, high


def ends_of(simulate: Simulate, starts: Sequence[Start]) -> tuple[list[str], Measured]:
    """Return what motions end as, and in how many that is what they are said to."""
    ends: dict[float, list[str]] = {}

    def as_said(tolerance: float) -> list[bool]:
        ends[tolerance] = [kind_of_end(simulate, start, tolerance)[0] for start in starts]
        return [end == start.end for end, start in zip(ends[tolerance], starts, strict=True)]

    answers = asked(as_said, SETTLING_TOLERANCE)
    found = ends[SETTLING_TOLERANCE]
    differing = [
        f"{end} in place of {start.end} for {changes(start.disc)}"
        for end, start in zip(found, starts, strict=True)
        if end != start.end
    ]
    return found, answers_of(
        *answers,
        source="Fig. 11 with X0 = 0; one parameter at a time is another",
        note=f"Whether each motion ends as said after {at_each('t', sorted({one.duration for one in starts}))} s: "
        + ", ".join(f"{start.end} for {changes(start.disc)}" for start in starts)
        + f". {'; '.join(differing)}".rstrip("; "),
    )


def changes(disc: DiscOnDisc) -> str:
    """Return in words what of Fig. 11's parameters is different."""
    differing = [
        f"{name} = {value:.4g}" for name, value in asdict(disc).items() if value != getattr(DISC, name)
    ]
    return ", ".join(differing) or "Fig. 11"


# --- The study of the stability map, to which the modules beside this one add its claims.


def border(name: str, unit: str, digits: int = 3) -> str:
    """Return the quote of a border in one parameter, "lower friction_force", and how far that is from Fig. 11."""
    here = getattr(DISC, name.split()[1])
    return f"{{{name}, {digits} digits}} {unit} ({{{name}, % from {here!r}, 2 digits}} %)"


def borders(parameter: str, unit: str, digits: int = 3) -> str:
    """Return the quotes of both borders in one parameter."""
    return " and ".join(border(f"{side} {parameter}", unit, digits) for side in ("lower", "upper"))


STUDY = Study.beside(
    __file__,
    "stability-map",
    source=SOURCE,
    system=DISC,
    seconds=7.5,
    words={
        "borders_of_load": borders("friction_force", "N"),
        "borders_of_shaft_damping": borders("shaft_damping", "N m s/rad"),
        "borders_of_damping": borders("damping", "N s/m"),
        "borders_of_shaft_speed": borders("shaft_speed", "rad/s", 4),
        "border_of_inertia": border("lower polar_inertia", "kg m²", 2),
    },
)
STUDY.provides(curves=curves)
