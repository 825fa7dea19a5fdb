import numpy as np
import pytest
from studies_under_test import AGREES, DIFFERS, theory_of

from compare.studies.disc.contact_laws import theory
from compare.studies.disc.contact_laws.study import STUDY
from reference_model.contact.annulus import Annulus
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


@pytest.mark.parametrize(
    "broken",
    [
        lambda slip, rim: mean_directions(slip, rim)[::-1],
        lambda slip, rim: tuple(np.array(mean_directions(slip, rim)) * (1.0 + 1e-9)),
    ],
)
def test_a_wrong_closed_form_differs(broken, monkeypatch):
    monkeypatch.setattr("reference_model.contact.contact_law.mean_directions", broken)
    assert theory_of(STUDY, "closed_form") == {"closed_form": DIFFERS}


def test_a_wrong_expansion_differs(monkeypatch, fresh):
    def two_terms(self, slip_speed, relative_spin):
        _, c, s = self._polar(slip_speed, relative_spin)
        return Shares(c * (1.0 - 0.5 * s**2), self.radius * s * (1.0 - 0.5 * c**2))

    monkeypatch.setattr("reference_model.contact.contact_law.ThreeTermRing.shares", two_terms)
    found = theory_of(STUDY, "error_of_expansion", "place_of_expansion_error")
    assert set(found.values()) == {DIFFERS}


def test_contact_points_at_wrong_angles_differ(monkeypatch, fresh):
    def uneven(radius, points):
        arms = radius * np.exp(2j * np.pi * np.arange(points) / (points + 1))
        return Points([(arm.real, arm.imag, 1.0 / points) for arm in arms])

    monkeypatch.setattr(theory, "PointsOnRing", uneven)
    functions = ("error_of_points", "place_of_points_error")
    found = theory_of(STUDY, *functions, few={name: {"numbers": (6,)} for name in functions})
    assert DIFFERS in found.values()


def test_an_annulus_that_is_not_split_at_its_resting_radius_does_not_agree(monkeypatch):
    monkeypatch.setattr(Annulus, "_resting_radius", lambda self, slip, spin: self.outer_radius)
    assert AGREES not in theory_of(STUDY, "annulus_converges", "slopes_converge").values()


def test_an_annulus_with_a_wrong_load_distribution_differs(monkeypatch):
    monkeypatch.setattr(Annulus, "_pressure_at", lambda self, radius: radius)
    assert theory_of(STUDY, "in_place") == {"in_place": DIFFERS}
    monkeypatch.setattr(Annulus, "_resting_radius", lambda self, slip, spin: self.inner_radius)
    monkeypatch.setattr(Annulus, "_loads", lambda self, centre: [(self.outer_radius, 1.0)])
    assert theory_of(STUDY, "thin_annulus") == {"thin_annulus": DIFFERS}


def test_the_top_of_a_parabola_is_found():
    place, size, error = theory.top(lambda ratio: 2.0 - (ratio - 0.9) ** 2, 1e-12)
    assert place == pytest.approx(0.9, abs=error)
    assert size == pytest.approx(2.0)
    assert error == pytest.approx(2e-6, rel=0.01)
