"""For which bodies there is a terminal ratio, and that of a disc, which is published."""

from __future__ import annotations

from scipy.optimize import brentq

from compare.claims.measured import Measured, answers_of
from compare.claims.parameters import at_each
from compare.studies.disc.free_ring.claims.study import STUDY
from compare.studies.disc.free_ring.parameters import INERTIAS
from compare.studies.toolkit.free_bodies import LARGEST, Slowing
from reference_model.contact.annulus import Annulus


@STUDY.claim(
    "Both speeds end in a finite ratio for mR²/2 < J < 2mR², and for no other J",
    equation="(20)",
    note="Whether the closed form of (20) has a balance of both decelerations, or has none, for "
    f"{at_each('J/mR²', INERTIAS)}.",
)
def ratio_exists() -> Measured:
    """Look for a balance of both decelerations."""

    def has_ratio(inertia: float) -> bool:
        slowing = Slowing(inertia)
        return slowing.unevenness(-LARGEST) < 0.0 < slowing.unevenness(LARGEST)

    return answers_of(
        [has_ratio(inertia) == (0.5 < inertia < 2.0) for inertia in INERTIAS],
        source="assumption: J/(mR²) from 0.1 to 10; limits as Goyal, Ruina and Papadopoulos 1991",
    )


@STUDY.claim(
    "On the whole face of a uniform disc the balance of both decelerations gives the published ratio",
    equation="(20)",
    resolution=1e-3,
    note="Sliding over rim speed in the end, by the mean of the closed form of (20) over all radii; J = mR²/2. Model "
    "error: half of the last digit that is published.",
)
def published_ratio() -> Measured:
    """Compare the balance of an annulus without a hole with the literature."""
    face = Annulus(0.0, 1.0, rings=16)

    def unevenness(ratio: float) -> float:
        """Return q for J = mR²/2."""
        resistance, moment = face.shares(ratio, 1.0)
        return resistance / ratio - moment / 0.5

    return Measured(
        predicted=0.653,
        value=brentq(unevenness, 0.1, 0.9, xtol=1e-12),
        error=1e-10,
        model=5e-4,  # the digits that are published
        source="Farkas, Bartels, Unger and Wolf 2003; Weidman and Malhotra 2007",
    )
