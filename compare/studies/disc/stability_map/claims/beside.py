"""Small deviations from the whirl on both sides of the Hopf curves."""

from __future__ import annotations

import functools
import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from compare.claims.error_estimates import refined
from compare.claims.linearised_flow import real_and_imaginary, rotated
from compare.claims.measured import Measured, answers_of
from compare.engines import Engine
from compare.studies.disc.stability_map.claims.study import STUDY
from compare.studies.disc.stability_map.theory import ASIDE, DEVIATION, FLOW_TOLERANCE, LINES, K, at
from compare.studies.toolkit.fig11_planes import PLANES
from reference_model.steady.bifurcation_curves import crossings
from reference_model.steady.stability import turning_frame_jacobian
from reference_model.steady.steady_states import SpinningWhirl, whirls
from reference_model.systems import DiscOnDisc

Lines = Sequence[tuple[str, str, float]]
"""Plane, the parameter that is fixed, and its value."""

BESIDE_CURVES = (
    f"Discs {100.0 * ASIDE:g} % from the curves to either side. Start on the whirl and a little off it along the "
    "pair's plane, both ways."
)


class Deviation(NamedTuple):
    """A disc in a plane, and λ in 1/s of the slow pair of its whirl: by the Jacobian, as measured, with its error."""

    plane: str
    disc: DiscOnDisc
    predicted: complex
    measured: complex
    error: float


@STUDY.claim(
    "Beside the Hopf curves small deviations from the whirl grow as the pair of eigenvalues says that the map traces",
    equation="(19), (20)",
    unit="1/s",
    resolution=1e-4 * K,
    note=f"{BESIDE_CURVES} Error: the change at a smaller tolerance and with twice the deviation.",
    basis="reference",
)
def rates(engine: Engine, lines: Lines = LINES) -> Measured:
    """Compare growth and frequency of deviations with the pair of eigenvalues."""
    found = deviations(engine, lines)
    return Measured(
        predicted=real_and_imaginary([one.predicted for one in found]),
        value=real_and_imaginary([one.measured for one in found]),
        error=np.repeat([one.error for one in found], 2).reshape(-1, 2),
        at={"disc": [_place(one) for one in found]},
        components=("real part", "imaginary part"),
    )


@STUDY.claim(
    "Small deviations from the whirl grow on one side of the Hopf curves and die out on the other, as mapped",
    equation="(19), (20)",
    note=BESIDE_CURVES,
    basis="reference",
    implied_by=rates,
)
def sides(engine: Engine, lines: Lines = LINES) -> Measured:
    """See on which side of the curves deviations grow."""
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
    """Follow a small deviation from the whirl on both sides of the Hopf curves of the ring that ``lines`` cross."""
    found = []
    for plane, disc in discs_beside(lines):
        whirl = min(whirls(disc), key=lambda whirl: abs(whirl.eigenvalues[1].real))
        found.append(Deviation(plane, disc, whirl.eigenvalues[1], *pair_of_deviation(engine, disc, whirl)))
    return found


def discs_beside(lines: Lines) -> Iterator[tuple[str, DiscOnDisc]]:
    """Yield plane and disc on both sides of the Hopf curves of the ring that the lines cross."""
    for name, fixed, value in lines:
        plane = PLANES[name]
        along = plane.names[1 - plane.names.index(fixed)]
        for crossing in crossings(plane, "Hopf", fixed, value):
            for side in (1.0 - ASIDE, 1.0 + ASIDE):
                yield name, at(**{fixed: value, along: side * crossing})


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
