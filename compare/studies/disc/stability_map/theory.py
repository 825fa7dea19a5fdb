"""Curves of the stability map, eigenvalues that check them, and data for the figures."""

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

# --- Parameters

DISC = FIG11
K = DISC.natural_frequency

SOURCE = "Fig. 11 with X0 = 0; the ranges of the map are our choice"
ONE_AT_A_TIME = "Fig. 11 with X0 = 0; one parameter at a time"

BOTH_LAWS = "(19), (20), (23)"
"""Equations of claims on both the ring and (23)."""

LINES = (
    ("load", "disc_speed", 1.5),
    ("dampers", "damping", 0.8),
    ("speeds", "disc_speed", 1.3),
    ("inertia", "polar_inertia", 0.4),
)
"""Lines of simulated discs on both sides of the ring's Hopf curves: plane, fixed parameter, its value."""

ASIDE = 0.01
"""Relative distance of these simulations from the curves."""

DEVIATION = 0.02
"""Initial deviation from the whirl, as a share of the distance to U = W, where a point of the ring comes to rest."""

FLOW_TOLERANCE = 100 * WORKING
"""Tolerance of simulations whose small differences are evaluated."""

STUCK = 60.0
"""Duration in s of the simulation of a disc that sticks on the axis, where nothing changes except by creep."""

OUTSIDE, BEYOND = 0.003, 0.02
"""Relative distances outside the Hopf curves where the modulated cycle coexists with the whirl, and is gone."""

BESIDE = (1.002, 1.0, 1.0, 1.0, 1.002, 1.0)
"""Factors on x, y, angle, vx, vy, spin of a whirl for a state close to it."""

ON_CYCLE = (0.035, 0.0, 0.0, 0.0, 0.035, 1.385)
"""State x, y, angle, vx, vy, spin close to the largest radius of the modulated cycle."""

LOADS = (
    *(0.0195, 0.0208, 0.0211, 0.0214, 0.0217, 0.0221, 0.0225),
    *(0.0232, 0.024, 0.0247, 0.0251, 0.0255, 0.028),
)
"""Friction forces in N in the bifurcation diagram."""

SLOW_LOADS = (0.0208, 0.0211)
"""Friction forces in N where the whirl is stable but disturbances decay slowly."""

FAR_FROM_KINK = 0.02
"""Smallest |U/W − 1| for the expansion about the whirl, which is invalid close to U = W."""

ONSET_SPEEDS = (1.05, 1.2, 1.4, 1.5, 2.0, 3.0)
"""Speeds ω in rad/s of the onsets by eigenvalues."""

NEAR = 1e-3
"""Relative distance from a border where the whirl has the stability of that side."""

STATE_ROUNDING = 4.0 * np.finfo(float).eps
"""Relative rounding error of the spin of a whirl computed from its α."""

UNSTABLE_LOADS = (0.3, 0.7)
"""Friction forces as fractions of the interval from the fold to the Hopf point of (23)."""

BESIDE_LARGEST = ((1.1, 1.0, 1.0, 1.0, 1.1, 1.0), (1.5, 1.0, 1.0, 1.0, 1.5, 1.0))
"""Factors on the state of the larger whirl at these forces."""


def at(**changes: Any) -> DiscOnDisc:
    """Return the disc of Fig. 11 with some parameters changed."""
    return replace(DISC, **changes)


Traced = Mapping[tuple[str, str, Kind], tuple[Boundary, ...]]
"""Curves by plane, law and kind."""


@functools.cache
def traced() -> Traced:
    return {
        (plane, law, kind): curves_in(plane, kind, law) for plane in PLANES for law in LAWS for kind in KINDS
    }


def state_at(disc: DiscOnDisc, alpha: float, law: IsotropicContact) -> FloatArray:
    """Return the state of the whirl with tan α = R|ω − φ̇|/U, shape (6,)."""
    _, radius, spin = whirl_at(disc, alpha, law)
    return np.array([radius, 0.0, 0.0, 0.0, K * radius, spin])


def points_of(traced: Traced, kind: Kind) -> Iterator[tuple[str, DiscOnDisc, float]]:
    """Yield law, disc and α for every point of the curves of one kind."""
    for (plane, law, found), curves in traced.items():
        for curve in curves if found == kind else ():
            for values, alpha in zip(curve.parameters, curve.alpha.tolist(), strict=True):
                yield law, PLANES[plane].at(values), alpha


def critical_eigenvalues(
    disc: DiscOnDisc, state: FloatArray, law: IsotropicContact
) -> tuple[ComplexArray, float]:
    """Return the eigenvalues of a whirl except the phase's, critical ones first, and their rounding error in 1/s.

    The error is that of the matrix, by the condition of the eigenvalue, plus that of the state: if U and W are nearly
    equal, the slopes of friction depend on their small difference.
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
    """Return the ``critical_eigenvalues`` of the whirls at all points of the curves of one kind."""
    return [
        critical_eigenvalues(disc, state_at(disc, alpha, LAWS[law]), LAWS[law])
        for law, disc, alpha in points_of(curves, kind)
    ]


def crossed(curves: Sequence[Boundary], value: float) -> FloatArray:
    """Return the second parameter, in increasing order, where the curves cross a value of the first."""
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
    """Return b|ω − Ω|/R, the smallest μN in N that lets the centred disc stick permanently."""
    return disc.shaft_damping * abs(disc.disc_speed - disc.shaft_speed) / disc.contact_radius


def rotation(disc: DiscOnDisc) -> FloatArray:
    """Return the state of the centred rotation, where the shaft overcomes friction, shape (6,)."""
    against = disc.disc_speed - disc.shaft_speed
    relative_spin = against - math.copysign(
        disc.friction_force * disc.contact_radius / disc.shaft_damping, against
    )
    return np.array([0.0, 0.0, 0.0, 0.0, 0.0, disc.disc_speed - relative_spin])


def change_of_stability(name: str, near: float, law: IsotropicContact) -> tuple[float, float]:
    """Return the parameter value where a pair of the whirl crosses the imaginary axis, and its error.

    The value is NaN if no pair crosses within ``NEAR`` (relative) of ``near``.
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
    """Return the largest of ``values`` below ``to`` and the smallest above it, if they exist."""
    below, above = [value for value in values if value < to], [value for value in values if value > to]
    return [*below[-1:], *above[:1]]


def curves() -> Data:
    data: Data = {}
    for (plane, law, kind), found in traced().items():
        for i, curve in enumerate(found):
            data[f"{plane}/{law}/{kind}/{i}"] = np.column_stack((curve.parameters, curve.alpha))
    return data | section()


def section() -> Data:
    """Return friction force in N, radius in m and growth rate in 1/s of Fig. 11's whirls over α, for each law."""
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


# --- Final motions of the centred disc

SETTLED = 600.0
WATCHED = 350.0
"""Time in s until motions have settled, and length in s of the final interval that is evaluated."""

SLOWLY_SETTLED = 2400.0
"""Settling time in s just outside the range of a cycle, where disturbances decay at less than 0.01 1/s."""

SETTLING_TOLERANCE = 1e-5

AXIS = 1e-3
"""Radius in units of R below which a motion counts as rotation about the axis."""

MODULATED = 0.05
"""Smallest (largest − smallest)/(largest + smallest) radius of a motion that counts as modulated."""


ENDS = ("rotation", "whirl", "modulated cycle", "sticking")
"""Kinds of final motion; figures' data contain their indices."""


class Start(NamedTuple):
    """A disc, its initial state, the expected final motion (in ``ENDS``) and the duration in s."""

    disc: DiscOnDisc
    state: tuple[float, ...]
    end: str
    duration: float = SETTLED


def kind_of_end(
    simulate: Simulate, start: Start, tolerance: float = SETTLING_TOLERANCE
) -> tuple[str, float, float]:
    """Return the kind of final motion, and its smallest and largest radius in m."""
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
    """Return the kinds of final motion, and answers whether they are the expected ones."""
    ends: dict[float, list[str]] = {}

    def as_said(tolerance: float) -> list[bool]:
        ends[tolerance] = [kind_of_end(simulate, start, tolerance)[0] for start in starts]
        return [end == start.end for end, start in zip(ends[tolerance], starts, strict=True)]

    answers = asked(as_said, SETTLING_TOLERANCE)
    found = ends[SETTLING_TOLERANCE]
    differing = [
        f"{end} instead of {start.end} for {changes(start.disc)}"
        for end, start in zip(found, starts, strict=True)
        if end != start.end
    ]
    return found, answers_of(
        *answers,
        source="Fig. 11 with X0 = 0; one parameter at a time differs",
        note=f"Predicted ends of the motions after {at_each('t', sorted({one.duration for one in starts}))} s: "
        + ", ".join(f"{start.end} for {changes(start.disc)}" for start in starts)
        + f". {'; '.join(differing)}".rstrip("; "),
    )


def changes(disc: DiscOnDisc) -> str:
    """Return the parameters that differ from those of Fig. 11, as text."""
    differing = [
        f"{name} = {value:.4g}" for name, value in asdict(disc).items() if value != getattr(DISC, name)
    ]
    return ", ".join(differing) or "Fig. 11"


# --- The study


def border(name: str, unit: str, digits: int = 3) -> str:
    """Return a template that quotes a border, such as "lower friction_force", and its distance from Fig. 11 in %."""
    here = getattr(DISC, name.split()[1])
    return f"{{{name}, {digits} digits}} {unit} ({{{name}, % from {here!r}, 2 digits}} %)"


def borders(parameter: str, unit: str, digits: int = 3) -> str:
    """Return templates that quote both borders in one parameter."""
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
