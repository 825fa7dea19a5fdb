"""The stability map in theory: its curves, the eigenvalues that they are checked by, and what the figures show."""

from __future__ import annotations

import functools
import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from compare.claims.linearised_flow import ComplexArray, eigenvalues_with_rounding
from compare.claims.study import Data
from compare.studies.disc.stability_map.parameters import DISC, NEAR, STATE_ROUNDING, K, at
from compare.studies.toolkit.fig11_planes import KINDS, LAWS, PLANES, curves_in
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
