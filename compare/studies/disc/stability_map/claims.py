"""Where steady motions of the centred disc are stable, and where the modulated cycle of Fig. 11 takes their place."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from compare.claims.answers import holds
from compare.claims.claim import Claim, ErrorBudget
from compare.claims.error_estimates import refined
from compare.claims.linearised_flow import real_and_imaginary, rotated
from compare.claims.parameters import parameters_of
from compare.claims.study import Data, Findings, Study
from compare.engines import Engine, Simulate
from compare.studies.disc.stability_map.ends import ENDS, SLOWLY_SETTLED, Start, ends_of, kind_of_end
from compare.studies.disc.stability_map.pictures import draw
from compare.studies.disc.stability_map.theory import DISC, PLANES, SOURCE, K, at, theory
from reference_model.steady.bifurcation_curves import crossings
from reference_model.steady.stability import turning_frame_jacobian
from reference_model.steady.steady_states import SpinningWhirl, whirls
from reference_model.systems import DiscOnDisc, FloatArray

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

FLOW_TOLERANCE = 1e-10

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

SIDES = (
    "Small deviations from the whirl grow on one side of the Hopf curves and die out on the other, as mapped"
)
RATES = "Beside the Hopf curves small deviations from the whirl grow with the pair of eigenvalues that the map is of"
REGIONS = "In each region of the map motions end as it says"
COEXIST = "Just outside of the Hopf curves whirl and modulated cycle coexist, and 2 % outside only the whirl is left"


def measure(
    engine: Engine,
    lines: Sequence[tuple[str, str, float]] = LINES,
    regions: Sequence[Start] | None = None,
    beside: Sequence[Start] | None = None,
    loads: Sequence[float] = LOADS,
) -> Findings:
    """Measure all statements with ``engine``.

    ``lines`` are those across which both sides of the Hopf curves are simulated, ``regions`` the motions that are
    to end as the map says, ``beside`` those outside of the Hopf curves (None for :func:`starts_in_regions` and
    :func:`coexisting`), ``loads`` those in N of the motions that are drawn over the load.
    """
    if not engine.simulates(DISC):
        return Findings(not_simulated=engine.lacking([DISC]))
    sides, side_claims = side_claims_of(engine, list(discs_beside(lines)))
    regions = starts_in_regions() if regions is None else regions
    ends, region_claim = ends_of(engine.simulate, engine.name, REGIONS, regions)
    beside = coexisting() if beside is None else beside
    _, coexistence_claim = ends_of(engine.simulate, engine.name, COEXIST, beside)
    return Findings(
        (*side_claims, region_claim, coexistence_claim),
        sides | ends_by_plane(regions, ends) | {"section": long_motions(engine.simulate, loads)},
    )


def discs_beside(lines: Sequence[tuple[str, str, float]]) -> Iterator[tuple[str, DiscOnDisc]]:
    """Yield plane and disc on both sides of the Hopf curves of the ring that the lines cross."""
    for name, fixed, value in lines:
        plane = PLANES[name]
        along = plane.names[1 - plane.names.index(fixed)]
        for crossing in crossings(plane, "Hopf", fixed, value):
            for side in (1.0 - ASIDE, 1.0 + ASIDE):
                yield name, at(**{fixed: value, along: side * crossing})


def side_claims_of(
    engine: Engine, discs: Sequence[tuple[str, DiscOnDisc]]
) -> tuple[Data, tuple[Claim, Claim]]:
    """Return where deviations were watched and how they grew, by plane, and the claims on sign and rate."""
    predicted, measured, errors = [], [], []
    rows: dict[str, list[tuple[float, float, float]]] = {}
    for name, disc in discs:
        whirl = min(whirls(disc), key=lambda whirl: abs(whirl.eigenvalues[1].real))
        rate, error = pair_of_deviation(engine, disc, whirl)
        predicted.append(whirl.eigenvalues[1])
        measured.append(rate)
        errors.append(error)
        first, second = (getattr(disc, parameter) for parameter in PLANES[name].names)
        rows.setdefault(f"sides/{name}", []).append((first, second, rate.real))
    as_mapped = np.real(measured) * np.sign(np.real(predicted))
    note = (
        f"{len(discs)} discs, {100.0 * ASIDE:g} % from the curves to either side. Start on the whirl and a little "
        "off it along the pair's plane, both ways."
    )
    common: dict[str, Any] = {
        "engine": engine.name,
        "parameters": parameters_of(DISC),
        "source": SOURCE,
        "basis": "reference",
    }
    return {plane: np.array(found) for plane, found in rows.items()}, (
        Claim(
            SIDES,
            equation="(19), (20)",
            **holds(as_mapped, errors),
            note=f"Whether each did so, of {note}",
            implied_by=RATES,
            **common,
        ),
        Claim(
            RATES,
            equation="(19), (20)",
            predicted=real_and_imaginary(predicted),
            measured=real_and_imaginary(measured),
            budget=ErrorBudget(np.repeat(errors, 2).reshape(-1, 2), resolution=1e-4 * K),
            unit="1/s",
            note=f"{note} Error: the change at a smaller tolerance and with twice the deviation.",
            **common,
        ),
    )


def pair_of_deviation(engine: Engine, disc: DiscOnDisc, whirl: SpinningWhirl) -> tuple[complex, float]:
    """Return λ in 1/s with which a small deviation in the plane of the slow pair grows, and its error.

    Half the difference of two motions that start on either side of the whirl, seen in the frame that turns with it,
    is multiplied by exp(λt) in that plane: its part there is told from the rest by the left eigenvector.
    """
    values, vectors = np.linalg.eig(turning_frame_jacobian(disc, whirl.state))
    which = int(np.argmin(np.abs(values - whirl.eigenvalues[1])))
    left = np.linalg.inv(vectors)[which]
    slip = (disc.disc_speed - K) * whirl.radius
    gap = abs(disc.contact_radius * abs(disc.disc_speed - whirl.spin) - slip)
    deviation = gap / np.max(np.abs(vectors[:, which])) * vectors[:, which].real
    duration = 1.0 / abs(values[which].imag)  # less than half a period: the logarithm is unique

    def rate(size: float, tolerance: float) -> complex:
        shift = np.insert(size * deviation, 2, 0.0)
        ends = [
            engine.simulate(disc, whirl.state + sign * shift, [0.0, duration], tolerance=tolerance).at_end
            for sign in (1.0, -1.0)
        ]
        end = np.delete(rotated((ends[0] - ends[1]) / 2.0, -whirl.frequency * duration), 2)
        return complex(np.log((left @ end) / (left @ (size * deviation))) / duration)

    parts, error = refined(lambda tolerance: real_and_imaginary(rate(DEVIATION, tolerance)), FLOW_TOLERANCE)
    found = complex(*parts)
    return found, math.hypot(*error) + abs(rate(2.0 * DEVIATION, FLOW_TOLERANCE) - found)


def starts_in_regions() -> tuple[Start, ...]:
    """Return motions in all regions of the map: what they are to end as, by the curves of the ring."""
    at_rest = (0.0, 0.0, 0.0, 0.0, 0.0, DISC.disc_speed)  # it turns with the master disc
    outside = (0.03, 0.0, 0.0, 0.0, 0.03, 1.38)
    near_axis = (1e-3, 0.0, 0.0, 0.0, 1e-3, 1.41)

    return (
        Start(at(friction_force=0.018), outside, "rotation"),
        Start(at(friction_force=0.0211), near_axis, "whirl"),
        Start(DISC, near_axis, "modulated cycle"),
        Start(DISC, outside, "modulated cycle"),
        Start(at(friction_force=0.028), near_axis, "whirl"),
        Start(at(friction_force=0.034), outside, "whirl"),
        Start(at(friction_force=0.034), at_rest, "sticking", STUCK),
        Start(at(shaft_damping=0.011), near_axis, "whirl"),
        Start(at(shaft_damping=0.02), outside, "rotation"),
        Start(at(polar_inertia=0.4), outside, "whirl"),
        Start(at(polar_inertia=2.0), outside, "modulated cycle"),
        Start(at(damping=0.35), outside, "whirl"),
        Start(at(damping=0.8), outside, "rotation"),
        Start(at(shaft_speed=1.15), outside, "rotation"),
        Start(at(shaft_speed=1.3), near_axis, "whirl"),
    )


def coexisting() -> tuple[Start, ...]:
    """Return motions outside of both Hopf curves: near to them one from whirl and cycle each, and farther off."""
    lower, upper = crossings(PLANES["load"], "Hopf", "disc_speed", DISC.disc_speed)
    starts = []
    for border, outward in ((lower, -1.0), (upper, 1.0)):
        near, far = (at(friction_force=border * (1.0 + outward * share)) for share in (OUTSIDE, BEYOND))
        (whirl,) = whirls(near)
        starts += [
            Start(near, tuple((whirl.state * BESIDE).tolist()), "whirl"),
            Start(near, ON_CYCLE, "modulated cycle"),
            Start(far, ON_CYCLE, "whirl", SLOWLY_SETTLED),
        ]
    return tuple(starts)


def ends_by_plane(starts: Sequence[Start], ends: Sequence[str]) -> Data:
    """Return the two parameters and the end, as its place in ``ENDS``, of all motions that a plane shows."""
    rows: dict[str, list[tuple[float, float, float]]] = {}
    for name, plane in PLANES.items():
        for start, end in zip(starts, ends, strict=True):
            first, second = (getattr(start.disc, parameter) for parameter in plane.names)
            if plane.at((first, second)) == start.disc:
                rows.setdefault(f"ends/{name}", []).append((first, second, float(ENDS.index(end))))
    return {name: np.array(found) for name, found in rows.items()}


def long_motions(simulate: Simulate, loads: Sequence[float]) -> FloatArray:
    """Return load in N, smallest and largest radius in m after a long time, shape (n, 3)."""
    starts = [Start(at(friction_force=load), ON_CYCLE, "") for load in loads]
    return np.array(
        [(load, *kind_of_end(simulate, start)[1:]) for load, start in zip(loads, starts, strict=True)]
    )


def border(name: str, unit: str, digits: int = 3) -> str:
    """Return the quote of a border in one parameter, "lower friction_force", and how far that is from Fig. 11."""
    here = getattr(DISC, name.split()[1])
    return f"{{{name}, {digits} digits}} {unit} ({{{name}, % from {here!r}, 2 digits}} %)"


def borders(parameter: str, unit: str, digits: int = 3) -> str:
    """Return the quotes of both borders in one parameter."""
    return " and ".join(border(f"{side} {parameter}", unit, digits) for side in ("lower", "upper"))


LOADS_OF_CYCLE = borders("friction_force", "N")

STUDY = Study(
    name="stability-map",
    title="Where the disc rotates, whirls, sticks, or whirls with a modulated amplitude",
    section="The friction disc",
    finding=(
        f"Over the load the whirl of Fig. 11 is unstable between {LOADS_OF_CYCLE}, and a modulated cycle takes its "
        "place, where centre and rim of the disc slip nearly equally fast. It needs the torsion: a pin's whirl "
        "is stable wherever it exists. The simplified equations (23) would not have found it: by them the whirl "
        "of Fig. 11 is stable."
    ),
    paper=(
        "Section 4 ends with the modulated cycle of Fig. 11, and says that its region of existence can be found by a "
        "stability analysis of the whirl like that of the pin, which would blow up the limits of the article. Here "
        "that analysis is done, for X0 = 0: deviations from the whirl obey a characteristic equation of fourth "
        "degree, (13) with the torsion beside it, and its borders are traced as curves.\n\n"
        "What the map teaches. A disc on the axis rotates steadily as long as friction, which acts on a small slip "
        "like a damper that turns with the master disc, is weaker than the dampers: below the onset. Beyond it the "
        "disc whirls, first on a small circle; at a higher load the whirl becomes unstable and its amplitude "
        "swells and shrinks; at a still higher load it is steady again, on a large circle; and from μN·R = b|ω − Ω| "
        "on the disc may stick as well.\n\n"
        f"The disc of Fig. 11 is near to the borders: at μN = {LOADS_OF_CYCLE}, at a shaft damping of "
        f"{borders('shaft_damping', 'N m s/rad')}, at a damping of the springs of {borders('damping', 'N s/m')}, and "
        f"at a shaft speed of {borders('shaft_speed', 'rad/s', 4)}. The surest remedy is one that leads below "
        "the onset, because then there is no whirl at all: from {shaft damping at the onset, % from 1, 3 digits} "
        "% of shaft damping on, {slip speed at the onset, % from 1, 3 digits} % of slip speed ω − Ω, "
        "{damping of the springs at the onset, % from 1, 3 digits} % of damping of the springs, or "
        "{load at the onset, % from 1, 3 digits} % of load. Less inertia ends the modulation too, but from "
        f"{border('lower polar_inertia', 'kg m²', 2)} on only, and leaves the whirl; below some 0.13 kg m² no "
        "shaft damping gives a modulation. The other way out, to a higher load or less slip speed, ends in a "
        "whirl that is steady but larger, 36 mm in place of 20 mm.\n\n"
        "On the continuous ring every border of the whirl is hard: the cycle is there with its full amplitude as "
        "soon as the whirl loses its stability, and it goes on a little beyond the border. At the speeds of Fig. 11 "
        "whirl and cycle exist side by side down to some 1 % below the lower and up to some 0.7 % above the upper "
        "load.\n\n"
        "Would (23) have found it? Not at the parameters of Fig. 11: there its whirl is stable (−0.027 ± 0.039i 1/s; "
        "on the ring +0.010 ± 0.032i). It has an unstable whirl too, but at these speeds only between 0.0197 and "
        "0.0202 N, below the onset at 0.0205 N, and there all ends in rotation about the axis, not in a cycle. The "
        "borders of the ring lie where centre and rim slip nearly equally fast, and there (23) is farthest from the "
        "ring. A pin has no such border: wherever its whirl exists (ω > k) it is stable."
    ),
    by_hand=measure,
    theory=theory,
    draw=draw,
    figures={
        "stability-map": (
            "The disc of Fig. 11 with two parameters at a time varied, X0 = 0. Shaded: where the whirl on the "
            "continuous ring is unstable and the modulated cycle takes its place. Between the onset and the shade "
            "lies a strip of steady small whirls. Dash-dotted: from there on the disc can stick to the master disc "
            "on the axis, as well as whirl. The map of ω and Ω is drawn over ω − Ω; it is the same for Ω > ω."
        ),
        "stability-map-load": (
            "Radius of the whirls at the speeds of Fig. 11 over the load, and the smallest and the largest radius "
            "that simulated motions have in the end, which start near to the largest radius of the cycle. Just below "
            "its lower end they are still settling on the small whirl."
        ),
    },
    seconds=7.0,
)
