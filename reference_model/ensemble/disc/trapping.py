"""Trapping regions of a disc's equilibria and whirls: a motion that enters one is decided.

Near a motion whose eigenvalues λ all decay, V = Σ |amplitude of a mode|² falls like 2·Re λ along the linear motion. A
fan of directions shows how far out it falls along the true motion. If motions cross a sphere of V and every smaller
one inwards, they tend to the centre. A disc on points oscillates, so only spheres down to INNER of the size count.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import ellipe, ellipkm1

from reference_model.ensemble.core.records import layout
from reference_model.ensemble.disc.lanes import Region
from reference_model.steady.steady_states import self_centred_equilibria, whirls
from reference_model.systems import ComplexArray, DiscOnDisc, FloatArray

DIRECTIONS, LEVELS = 4000, 60
SMALLEST, LARGEST = 1e-4, 30.0
"""Smallest and largest deviations tried, in units of the motion."""

APART = 1e-6
"""Differences for the linearisation, in units of the motion."""

INNER = 0.3
"""Share of a region's size where a disc on points finally remains."""

GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)
"""Golden ratio, whose multiples are spread evenly over [0, 1]."""

SAFE = 0.5
"""Share of the fan's V that is used, because the fan has gaps."""


@lru_cache(maxsize=64)
def trapping_regions(disc: DiscOnDisc) -> NDArray[Any]:
    """Return the known trapping regions of ``disc``, ``Region`` of shape (m,)."""
    ring = replace(disc, contact_points=None)
    regions = []
    try:
        for point in self_centred_equilibria(ring):
            if point.stable:
                centre = np.array(
                    [point.x, point.y, 0.0, 0.0, _gyration(disc) * (point.spin - disc.disc_speed)]
                )
                radius = math.hypot(point.x, point.y)
                regions.append(_region(disc, False, centre, radius, _at_rest))
        for whirl in whirls(ring) if disc.offset == 0.0 else ():
            if whirl.stable:
                turning = _gyration(disc) * (whirl.spin - disc.disc_speed)
                centre = np.array([whirl.radius, 0.0, whirl.frequency * whirl.radius, turning])
                regions.append(_region(disc, True, centre, whirl.radius, _turning))
    except ValueError:
        return no_regions()  # friction has no derivative there
    known = [region for region in regions if region["level"] > 0.0]
    return np.array(known, dtype=layout(Region))


def no_regions() -> NDArray[Any]:
    return np.zeros(0, layout(Region))


def _gyration(disc: DiscOnDisc) -> float:
    return math.sqrt(disc.polar_inertia / disc.mass)


def _accelerations(
    disc: DiscOnDisc, z: ComplexArray, v: ComplexArray, r: FloatArray
) -> tuple[ComplexArray, FloatArray, FloatArray]:
    """Return v̇, ṙ and the mean slip speed by eq. 19 and 20, with contact points at other angles in each row."""
    kappa, g = _gyration(disc), disc.friction_force / disc.mass
    u, w = v - 1j * disc.disc_speed * z, disc.contact_radius / kappa * r
    if disc.contact_points is None:
        tiny = 1e-12 * (np.max(np.abs(u)) + np.max(np.abs(w)) + 1e-300)
        U, W = np.maximum(np.abs(u), tiny), np.maximum(np.abs(w), tiny)
        rest = np.maximum(((U - W) / (U + W)) ** 2, 1e-30)
        E, K = ellipe(1.0 - rest), ellipkm1(rest)
        force = ((U + W) * E + (U - W) * K) / (math.pi * U) * u / U
        moment = ((U + W) * E - (U - W) * K) / (math.pi * W) * np.sign(w)
    else:
        places = np.arange(disc.contact_points) + GOLDEN * np.arange(len(u))[:, np.newaxis]
        arms = np.exp(2j * math.pi / disc.contact_points * places)
        slip = u[:, np.newaxis] + 1j * w[:, np.newaxis] * arms
        directions = slip / np.maximum(np.abs(slip), 1e-300)
        force, moment = directions.mean(axis=1), (arms.conj() * directions).imag.mean(axis=1)
    a = -disc.stiffness / disc.mass * (z - disc.offset) - disc.damping / disc.mass * v - g * force
    lag = kappa * (disc.disc_speed - disc.shaft_speed)
    spin_up = -disc.shaft_damping / disc.polar_inertia * (r + lag) - g * disc.contact_radius / kappa * moment
    return a, spin_up, (force.conj() * u).real + moment * w


def _at_rest(disc: DiscOnDisc, states: FloatArray) -> FloatArray:
    v = states[:, 2] + 1j * states[:, 3]
    a, spin_up, _ = _accelerations(disc, states[:, 0] + 1j * states[:, 1], v, states[:, 4])
    return np.column_stack((v.real, v.imag, a.real, a.imag, spin_up))


def _turning(disc: DiscOnDisc, states: FloatArray) -> FloatArray:
    radius, along, across, r = states.T
    a, spin_up, _ = _accelerations(disc, radius + 0j, along + 1j * across, r)
    return np.column_stack((along, a.real + across**2 / radius, a.imag - along * across / radius, spin_up))


def _region(
    disc: DiscOnDisc,
    circle: bool,
    centre: FloatArray,
    radius: float,
    rates: Callable[[DiscOnDisc, FloatArray], FloatArray],
) -> Any:
    """Return the region about a stable motion; its level is 0 if there is none."""
    d, k = len(centre), disc.natural_frequency
    length = max(radius, disc.friction_force / disc.stiffness) or disc.contact_radius
    scale = np.array([length, *[length * k] * 3] if circle else [length] * 2 + [length * k] * 3)

    steps, ring = APART * scale, replace(disc, contact_points=None)
    moved = rates(ring, np.concatenate((centre + np.diag(steps), centre - np.diag(steps))))
    slopes = ((moved[:d] - moved[d:]) / (2.0 * steps[:, np.newaxis])).T / scale[:, np.newaxis] * scale
    modes = np.linalg.inv(np.linalg.eig(slopes)[1])
    form = (modes.conj().T @ modes).real

    directions = np.random.default_rng(0).standard_normal((DIRECTIONS, d))
    directions /= np.sqrt(_values(form, directions, directions))[:, np.newaxis]
    largest = math.sqrt(float(np.max(np.linalg.eigvalsh(form))))
    size = inner = 0.0
    for trial in np.geomspace(SMALLEST, LARGEST, LEVELS):
        deviations = trial * directions / largest
        states = centre + deviations * scale
        if circle and np.any(states[:, 0] <= 0.0):
            break
        if np.all(_values(form, deviations, rates(disc, states) / scale) < 0.0):
            size = trial
        elif disc.contact_points is None or size > 0.0:
            break
        else:
            inner = trial
    if inner > INNER * size:
        size = 0.0

    region = np.zeros((), layout(Region))
    region["circle"], region["centre"][:d] = circle, centre
    matrix = np.zeros((5, 5))
    matrix[:d, :d] = form / np.outer(scale, scale)
    region["form"] = matrix[np.triu_indices(5)]
    region["level"] = SAFE * (size / largest) ** 2
    z, v = (centre[0], 1j * centre[2]) if circle else (complex(*centre[:2]), 0j)
    slip = _accelerations(ring, np.array([z]), np.array([v]), centre[d - 1 :])[2][0]
    region["measures"] = radius, radius, slip
    return region


def _values(form: FloatArray, left: FloatArray, right: FloatArray) -> FloatArray:
    return np.asarray(np.einsum("ni,ij,nj->n", left, form, right))
