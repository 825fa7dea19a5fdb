"""Simulations in the regions of the map and next to its borders."""

import functools
import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

import compare.studies.disc.stability_map.theory as theory
from compare.claims import WORKING, Data, Measured, answers_of, refined
from compare.claims.linearised_flow import real_and_imaginary
from compare.engines import Engine
from compare.studies.disc.stability_map.theory import DISC, STUDY, Start, at
from compare.studies.toolkit.deviations import PARTS
from compare.studies.toolkit.fig11 import PLANES
from compare.studies.toolkit.steady_motion import mode_growth
from reference_model.steady.bifurcation_curves import crossings
from reference_model.steady.stability import turning_frame_jacobian
from reference_model.steady.steady_states import SpinningWhirl, whirls
from reference_model.systems import ANGLE, DiscOnDisc, FloatArray

LINES = (
    ("load", "disc_speed", 1.5),
    ("dampers", "damping", 0.8),
    ("speeds", "disc_speed", 1.3),
    ("inertia", "polar_inertia", 0.4),
)
"""Lines across the ring's Hopf curves: plane, fixed parameter, its value."""

ASIDE, DEVIATION, FLOW_TOLERANCE = 0.01, 0.02, 100 * WORKING
"""Relative distance of discs from the curves, deviation as a share of the distance to U = W, and tolerance."""

ON_CYCLE = (0.035, 0.0, 0.0, 0.0, 0.035, 1.385)
"""x, y, angle, vx, vy, spin near the largest radius of the modulated cycle."""

LOADS = (
    *(0.0195, 0.0208, 0.0211, 0.0214, 0.0217, 0.0221, 0.0225),
    *(0.0232, 0.024, 0.0247, 0.0251, 0.0255, 0.028),
)
"""μN in N in the bifurcation diagram."""


# --- Small deviations next to the Hopf curves

Lines = Sequence[tuple[str, str, float]]
"""Plane, fixed parameter and its value."""

BESIDE_CURVES = (
    f"Discs {100.0 * ASIDE:g} % away from the curves on either side. Starts on the whirl, and slightly off it "
    "in the plane of the pair in both directions."
)


class Deviation(NamedTuple):
    """A disc in a plane, and λ (1/s) of its whirl's slow pair: by the Jacobian, as measured, and the error."""

    plane: str
    disc: DiscOnDisc
    predicted: complex
    measured: complex
    error: float


@STUDY.claim(
    "Near the Hopf curves, small deviations from the whirl grow and oscillate with the eigenvalue pair of the map",
    equation="(19), (20)",
    unit="1/s",
    resolution=1e-4 * theory.K,
    note=f"{BESIDE_CURVES} Error: the change at a smaller tolerance and with twice the deviation.",
    basis="reference",
)
def rates(engine: Engine, lines: Lines = LINES) -> Measured:
    found = deviations(engine, lines)
    return Measured(
        predicted=real_and_imaginary([one.predicted for one in found]),
        value=real_and_imaginary([one.measured for one in found]),
        error=np.repeat([one.error for one in found], 2).reshape(-1, 2),
        at={"disc": [_place(one) for one in found]},
        components=PARTS,
    )


@STUDY.claim(
    "Small deviations from the whirl grow on one side of the Hopf curves and decay on the other, as mapped",
    equation="(19), (20)",
    note=BESIDE_CURVES,
    basis="reference",
    implied_by=rates,
)
def sides(engine: Engine, lines: Lines = LINES) -> Measured:
    found = deviations(engine, lines)
    rows: dict[str, list[tuple[float, ...]]] = {}
    for one in found:
        place = (getattr(one.disc, name) for name in PLANES[one.plane].names)
        rows.setdefault(f"sides/{one.plane}", []).append((*place, one.measured.real))
    return answers_of(
        [one.measured.real * np.sign(one.predicted.real) for one in found],
        [one.error for one in found],
        data=rows,
    )


def _place(one: Deviation) -> str:
    return ", ".join(f"{name} {getattr(one.disc, name):.4g}" for name in PLANES[one.plane].names)


@functools.lru_cache(maxsize=4)
def deviations(engine: Engine, lines: Lines) -> list[Deviation]:
    found = []
    for plane, disc in discs_beside(lines):
        whirl = min(whirls(disc), key=lambda whirl: abs(whirl.eigenvalues[1].real))
        found.append(Deviation(plane, disc, whirl.eigenvalues[1], *pair_of_deviation(engine, disc, whirl)))
    return found


def discs_beside(lines: Lines) -> Iterator[tuple[str, DiscOnDisc]]:
    """Yield plane and disc on both sides of the ring's Hopf curves on each line."""
    for name, fixed, value in lines:
        plane = PLANES[name]
        along = plane.names[1 - plane.names.index(fixed)]
        for crossing in crossings(plane, "Hopf", fixed, value):
            for side in (1.0 - ASIDE, 1.0 + ASIDE):
                yield name, at(**{fixed: value, along: side * crossing})


def pair_of_deviation(engine: Engine, disc: DiscOnDisc, whirl: SpinningWhirl) -> tuple[complex, float]:
    """Return the growth rate λ (1/s) of a small deviation in the plane of the slow pair, and its error."""
    values, vectors = np.linalg.eig(turning_frame_jacobian(disc, whirl.state))
    mode = vectors[:, np.argmin(np.abs(values - whirl.eigenvalues[1]))]
    slip = (disc.disc_speed - theory.K) * whirl.radius
    gap = abs(disc.contact_radius * abs(disc.disc_speed - whirl.spin) - slip)
    deviation = np.insert(gap / np.max(np.abs(mode)) * mode.real, ANGLE, 0.0)
    duration = 1.0 / abs(whirl.eigenvalues[1].imag)

    def rate(size: float, tolerance: float) -> complex:
        return mode_growth(engine, disc, whirl, size * deviation, duration, tolerance)

    parts, error = refined(lambda tolerance: real_and_imaginary(rate(DEVIATION, tolerance)), FLOW_TOLERANCE)
    found = complex(*parts)
    return found, math.hypot(*error) + abs(rate(2.0 * DEVIATION, FLOW_TOLERANCE) - found)


# --- Final motions


@STUDY.claim(
    "In each region of the map, motions end as the map predicts", equation="(19), (20)", basis="reference"
)
def regions(engine: Engine, starts: Sequence[Start] | None = None) -> Measured:
    starts = starts_in_regions() if starts is None else starts
    ends, measured = theory.ends_of(engine.simulate, starts)
    return replace(measured, data=lambda: ends_by_plane(starts, ends))


@STUDY.claim(
    "Just outside the Hopf curves, whirl and modulated cycle coexist; 2 % outside, only the whirl remains",
    equation="(19), (20)",
    basis="reference",
)
def coexist(
    engine: Engine, starts: Sequence[Start] | None = None, loads: Sequence[float] = LOADS
) -> Measured:
    """Draw motions at ``loads`` (N) in the bifurcation diagram."""
    _, measured = theory.ends_of(engine.simulate, coexisting() if starts is None else starts)
    return replace(measured, data=lambda: {"section": long_motions(engine, loads)})


def starts_in_regions() -> tuple[Start, ...]:
    at_rest = (0.0, 0.0, 0.0, 0.0, 0.0, DISC.disc_speed)  # turns with the master disc
    outside = (0.03, 0.0, 0.0, 0.0, 0.03, 1.38)
    near_axis = (1e-3, 0.0, 0.0, 0.0, 1e-3, 1.41)

    return (
        Start(at(friction_force=0.018), outside, "rotation"),
        Start(at(friction_force=0.0211), near_axis, "whirl", theory.SLOWLY_SETTLED),
        Start(DISC, near_axis, "modulated cycle"),
        Start(DISC, outside, "modulated cycle"),
        Start(at(friction_force=0.028), near_axis, "whirl"),
        Start(at(friction_force=0.034), outside, "whirl"),
        Start(at(friction_force=0.034), at_rest, "sticking", 60.0),  # only creep changes it
        Start(at(shaft_damping=0.011), near_axis, "whirl"),
        Start(at(shaft_damping=0.02), outside, "rotation"),
        Start(at(polar_inertia=0.4), outside, "whirl", theory.SLOWLY_SETTLED),
        Start(at(polar_inertia=2.0), outside, "modulated cycle"),
        Start(at(damping=0.35), outside, "whirl"),
        Start(at(damping=0.8), outside, "rotation"),
        Start(at(shaft_speed=1.15), outside, "rotation"),
        Start(at(shaft_speed=1.3), near_axis, "whirl"),
    )


def coexisting() -> tuple[Start, ...]:
    """Return motions 0.3 % outside both Hopf curves, from whirl and cycle, and 2 % outside, where no cycle exists."""
    lower, upper = crossings(PLANES["load"], "Hopf", "disc_speed", DISC.disc_speed)
    starts = []
    for border, outward, settled in ((lower, -1.0, theory.SLOWLY_SETTLED), (upper, 1.0, theory.SETTLED)):
        near, far = (at(friction_force=border * (1.0 + outward * share)) for share in (0.003, 0.02))
        (whirl,) = whirls(near)
        beside_whirl = whirl.state * (1.002, 1.0, 1.0, 1.0, 1.002, 1.0)
        starts += [
            Start(near, tuple(beside_whirl.tolist()), "whirl"),
            Start(near, ON_CYCLE, "modulated cycle"),
            Start(far, ON_CYCLE, "whirl", settled),
        ]
    return tuple(starts)


def ends_by_plane(starts: Sequence[Start], ends: Sequence[str]) -> Data:
    """Return both parameters and the index in ``ENDS`` of each motion, by plane, shape (n, 3)."""
    rows: dict[str, list[tuple[float, float, float]]] = {}
    for name, plane in PLANES.items():
        for start, end in zip(starts, ends, strict=True):
            first, second = (getattr(start.disc, parameter) for parameter in plane.names)
            if plane.at((first, second)) == start.disc:
                rows.setdefault(f"ends/{name}", []).append((first, second, float(theory.ENDS.index(end))))
    return {name: np.array(found) for name, found in rows.items()}


def long_motions(engine: Engine, loads: Sequence[float]) -> FloatArray:
    """Return μN (N) and smallest and largest final radius (m), shape (n, 3)."""
    rows = []
    for load in loads:
        slow = load in (0.0208, 0.0211)  # disturbances of the stable whirl decay slowly
        duration = theory.SLOWLY_SETTLED if slow else theory.SETTLED
        start = Start(at(friction_force=load), ON_CYCLE, "", duration)
        rows.append((load, *theory.kind_of_end(engine.simulate, start)[1:]))
    return np.array(rows)
