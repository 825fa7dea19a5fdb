import numpy as np
import pytest
from studies_under_test import DIFFERS, theory_of

from compare.studies.disc.contact_laws import theory
from compare.studies.disc.contact_laws.study import STUDY
from reference_model.contact.contact_law import Shares
from reference_model.contact.elliptic import mean_directions
from reference_model.contact.points import Points


@pytest.fixture
def fresh():
    """Clear the caches of the theory before and after the test."""
    searches = theory.greatest_errors_of_expansion, theory.greatest_errors_of_points
    for search in searches:
        search.cache_clear()
    yield
    for search in searches:
        search.cache_clear()


def two_terms(self, slip_speed, relative_spin):
    _, c, s = self._polar(slip_speed, relative_spin)
    return Shares(c * (1.0 - 0.5 * s**2), self.radius * s * (1.0 - 0.5 * c**2))


def uneven(radius, points):
    arms = radius * np.exp(2j * np.pi * np.arange(points) / (points + 1))
    return Points([(arm.real, arm.imag, 1.0 / points) for arm in arms])


def slightly_larger(slip, rim):
    return tuple(np.array(mean_directions(slip, rim)) * (1.0 + 1e-9))


LAWS = "reference_model.contact"


@pytest.mark.parametrize(
    ("target", "broken", "functions"),
    [
        (f"{LAWS}.contact_law.mean_directions", slightly_larger, ("closed_form",)),
        (
            f"{LAWS}.contact_law.ThreeTermRing.shares",
            two_terms,
            ("error_of_expansion", "place_of_expansion_error"),
        ),
        (f"{theory.__name__}.PointsOnRing", uneven, ("error_of_points",)),
        (f"{LAWS}.annulus.Annulus._pressure_at", lambda self, radius: radius, ("in_place",)),
        (
            f"{LAWS}.annulus.Annulus._loads",
            lambda self, centre: [(self.outer_radius, 1.0)],
            ("thin_annulus",),
        ),
        # without a split at the radius that rests, the quadrature does not converge
        (
            f"{LAWS}.annulus.Annulus._resting_radius",
            lambda self, slip, spin: self.outer_radius,
            ("annulus_converges", "slopes_converge"),
        ),
    ],
)
def test_a_wrong_contact_law_differs(target, broken, functions, monkeypatch, fresh):
    monkeypatch.setattr(target, broken)
    few = {"error_of_points": {"numbers": (6,)}}
    assert set(theory_of(STUDY, *functions, few=few).values()) == {DIFFERS}
