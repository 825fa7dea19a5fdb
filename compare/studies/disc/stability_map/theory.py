"""Curves of the stability map, and eigenvalues that check them."""

import functools
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from typing import Any, NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from compare.claims import Data, Measured, Study, answers_of, asked
from compare.claims.linearised_flow import ComplexArray, eigenvalues_with_rounding
from compare.claims.parameters import FIG11, at_each
from compare.engines import Simulate
from compare.studies.toolkit.fig11 import KINDS, LAWS, PLANES, curves_in
from reference_model.contact.contact_law import IsotropicContact
from reference_model.formulas.disc import whirl_at
from reference_model.steady import stability
from reference_model.steady.bifurcation_curves import Boundary, Kind
from reference_model.steady.steady_states import whirls
from reference_model.systems import DiscOnDisc, FloatArray

DISC = FIG11
K = DISC.natural_frequency

SOURCE = "Fig. 11 with X0 = 0; the ranges of the map are our choice"


def at(**changes: Any) -> DiscOnDisc:
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


def critical_eigenvalues(
    disc: DiscOnDisc, state: FloatArray, law: IsotropicContact
) -> tuple[ComplexArray, float]:
    """Return the eigenvalues of a whirl without the phase's, the critical first, and their rounding error (1/s).

    The error includes the error of the state, because friction's slopes depend on small differences of U and W.
    """
    # The spin computed from α has a relative rounding error of about 4 eps.
    neighbour = state * (1.0 + 4.0 * np.finfo(float).eps * (np.arange(6) == 5))
    values, shifted = (
        np.array(sorted(stability.whirl_eigenvalues(disc, which, law)[1:], key=lambda value: abs(value.real)))
        for which in (state, neighbour)
    )
    found, rounding = eigenvalues_with_rounding(stability.turning_frame_jacobian(disc, state, law))
    error = rounding[np.argmin(np.abs(found - values[0]))]
    return values, float(error + np.min(np.abs(shifted - values[0])))


def spectra(wanted: Kind, curves: Traced) -> list[tuple[ComplexArray, float]]:
    found = []
    for (plane, law, kind), branches in curves.items():
        for curve in branches if kind == wanted else ():
            for values, alpha in zip(curve.parameters, curve.alpha.tolist(), strict=True):
                disc = PLANES[plane].at(values)
                found.append(critical_eigenvalues(disc, state_at(disc, alpha, LAWS[law]), LAWS[law]))
    return found


def crossed(curves: Sequence[Boundary], value: float) -> FloatArray:
    """Return the second parameter, in increasing order, where the curves cross a value of the first."""
    found = []
    for curve in curves:
        steps = np.diff(curve.parameters / np.max(np.abs(curve.parameters), axis=0), axis=0)
        along = np.concatenate(([0.0], np.cumsum(np.linalg.norm(steps, axis=1))))
        first, second = (CubicSpline(along, column) for column in curve.parameters.T)
        found.extend(second(first.solve(value, extrapolate=False)))
    return np.sort(found)


def growth_of_rotation(disc: DiscOnDisc, law: IsotropicContact = LAWS["ring"]) -> float:
    """Return the largest real part (1/s) of the eigenvalues of the centred rotation."""
    against = disc.disc_speed - disc.shaft_speed
    # The shaft overcomes friction.
    slip = against - math.copysign(disc.friction_force * disc.contact_radius / disc.shaft_damping, against)
    state = np.array([0.0, 0.0, 0.0, 0.0, 0.0, disc.disc_speed - slip])
    return stability.equilibrium_eigenvalues(disc, state, law)[0].real


def change_of_stability(name: str, near: float, law: IsotropicContact) -> tuple[float, float]:
    """Return the value where a pair of the whirl crosses the imaginary axis, NaN if beyond 0.1 %, and its error."""

    def crossing_pair(value: float) -> tuple[float, float]:
        disc = at(**{name: value})
        pairs = (critical_eigenvalues(disc, whirl.state, law) for whirl in whirls(disc, law))
        return min(((values[0].real, error) for values, error in pairs), key=lambda pair: abs(pair[0]))

    low, high = near * (1.0 - 1e-3), near * (1.0 + 1e-3)
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
    points = {
        f"{plane}/{law}/{kind}/{i}": np.column_stack((curve.parameters, curve.alpha))
        for (plane, law, kind), found in traced().items()
        for i, curve in enumerate(found)
    }
    return points | section()


def section() -> Data:
    data: Data = {}
    alphas = np.linspace(0.45, np.pi / 2.0 - 1e-3, 240)
    for name, law in LAWS.items():
        rows = []
        for alpha in alphas.tolist():
            load, radius, _ = whirl_at(DISC, alpha, law)
            disc = at(friction_force=load)
            values = stability.whirl_eigenvalues(disc, state_at(disc, alpha, law), law)
            rows.append((load, radius, values[1].real))
        data[f"section/{name}"] = np.array(rows)
    return data


SETTLED, WATCHED, SLOWLY_SETTLED = 600.0, 350.0, 2400.0
"""Time until motions have settled, length of the evaluated end, and settling time just outside the range of a cycle,
where disturbances decay at less than 0.01 1/s; in s.
"""

SETTLING_TOLERANCE = 1e-5

AXIS, MODULATED = 1e-3, 0.05
"""Largest radius of rotation about the axis as a share of R, and smallest (largest − smallest)/(largest + smallest)
radius of a modulated motion.
"""


ENDS = ("rotation", "whirl", "modulated cycle", "sticking")
"""Kinds of final motion; figures' data contain their indices."""


class Start(NamedTuple):
    """A disc, its initial state, the expected final motion (in ``ENDS``) and the duration (s)."""

    disc: DiscOnDisc
    state: tuple[float, ...]
    end: str
    duration: float = SETTLED


def kind_of_end(
    simulate: Simulate, start: Start, tolerance: float = SETTLING_TOLERANCE
) -> tuple[str, float, float]:
    """Return the kind of final motion, and its smallest and largest radius (m)."""
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
    differing = asdict(disc).items() - asdict(DISC).items()
    return ", ".join(f"{name} = {value:.4g}" for name, value in sorted(differing)) or "Fig. 11"


def border(name: str, unit: str, digits: int = 3) -> str:
    """Return a template that quotes a border, such as "lower friction_force", and its distance from Fig. 11 in %."""
    here = getattr(DISC, name.split()[1])
    return f"{{{name}, {digits} digits}} {unit} ({{{name}, % from {here!r}, 2 digits}} %)"


def borders(parameter: str, unit: str, digits: int = 3) -> str:
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
