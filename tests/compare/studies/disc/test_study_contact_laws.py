"""The study of the laws of contact: what its claims see, of engines and of laws that are broken on purpose."""

import math
from dataclasses import replace

import numpy as np
import pytest
from plain_slip import slide
from study_harness import BLIND, SEES, StudyTests, engine_named

from compare.claims.claim import Verdict
from compare.engines import EVERY_KIND, Engine
from compare.studies.disc.contact_laws import theory
from compare.studies.disc.contact_laws.study import STUDY
from reference_model import plain
from reference_model.contact.annulus import Annulus
from reference_model.contact.contact_law import Shares
from reference_model.contact.elliptic import mean_directions
from reference_model.trajectory import Phase, Solution, Trajectory


def many_points(disc):
    """As many as make the ring: within U/W <= 0.8 their error is below 0.8^400."""
    return disc.contact_points or 400


def disc_engine(name, *, number=many_points, radius=1.0, moment=1.0, force=lambda f: f, kinds=EVERY_KIND):
    """An engine of the plain equations, with what a fault changes as its arguments."""

    def simulate(disc, initial_state, times, *, tolerance=1e-9):
        friction = plain.on_ring(disc.friction_force, radius * disc.contact_radius, number(disc), 0.0)

        def broken(*slip):
            *right, turning = friction(*slip)
            return *force(right), moment * turning

        run = slide(disc, initial_state, times, broken, rtol=0.1 * max(tolerance, 3e-13), atol=1e-14)
        phase = Phase("slip", float(times[0]), float(times[-1]), np.array(initial_state, dtype=float))
        solution = Solution("DOP853", tolerance, run.nfev, 0, 0.0)
        return Trajectory(disc, np.array(times), run.y.T.copy(), (phase,), solution)

    return Engine(name, simulate, kinds)


def naive_directions(slip, rim):
    """The modulus 4UW/(U + W)² in double precision, which cancels at extreme ratios."""
    from scipy.special import ellipe, ellipk

    m = 4.0 * slip * rim / (slip + rim) ** 2
    even = (slip + rim) * ellipe(m)
    odd = (slip - rim) * ellipk(m) if slip != rim else 0.0
    return float(even + odd) / (math.pi * slip), float(even - odd) / (math.pi * rim)


class TestContactLaws(StudyTests):
    study = STUDY
    sound = ("reference", "exudyn")
    few = {name: {"ratios": (0.3, 0.8, 1.25)} for name in ("on_ring", "on_six_points")}
    faults = {
        "six points": disc_engine("broken", number=lambda disc: 6),
        "twelve points": disc_engine("broken", number=lambda disc: 12),
        "400 points": disc_engine("broken", number=lambda disc: 400),
        "radius 0.01 % off": disc_engine("broken", radius=1.0001),
        "moment of the wrong sign": disc_engine("broken", moment=-1.0),
        "moment 0.01 % off": disc_engine("broken", moment=1.0001),
        "x and y of the force exchanged": disc_engine("broken", force=lambda f: f[::-1]),
        "force 0.01 % off": disc_engine("broken", force=lambda f: 1.0001 * np.array(f)),
    }
    columns = ("on_ring", "on_six_points")
    table = {
        "six points": (SEES, BLIND),
        "twelve points": (SEES, SEES),
        "400 points": (BLIND, SEES),
        "radius 0.01 % off": (SEES, SEES),
        "moment of the wrong sign": (SEES, SEES),
        "moment 0.01 % off": (SEES, SEES),
        "x and y of the force exchanged": (SEES, SEES),
        "force 0.01 % off": (SEES, SEES),
    }

    def test_every_claim_holds_in_an_engine_that_shares_nothing(self):
        findings = STUDY.measure(disc_engine("intact"), self.few)
        assert [claim.verdict for claim in findings.claims] == [Verdict.AGREES] * 2
        assert findings.not_simulated == ""

    def test_what_an_engine_does_not_simulate_is_left_out_and_said(self):
        points_only = STUDY.measure(disc_engine("discrete", kinds=("pin", "points")), self.few)
        assert [claim.identity for claim in points_only.claims] == ["contact-laws/on-six-points"]
        assert points_only.not_simulated == "discrete does not simulate a disc on a continuous ring"
        pin_only = STUDY.measure(disc_engine("plain", kinds=("pin",)), self.few)
        assert pin_only.claims == ()
        assert pin_only.not_simulated

    def test_figures_are_drawn_without_the_ring_and_of_nothing(self):
        engine = replace(engine_named("exudyn"), kinds=("pin", "points"))
        for data in ({"discrete": STUDY.measure(engine, self.few).data}, {}):
            assert set(STUDY.draw(data)) == set(STUDY.figures)


# ---------------------------------------------------------------- laws broken on purpose


@pytest.fixture
def fresh():
    """Forget what was found of the laws before, and afterwards what was found of broken ones."""
    searches = theory.greatest_errors_of_expansion, theory.greatest_errors_of_points
    for search in searches:
        search.cache_clear()
    yield
    for search in searches:
        search.cache_clear()


def verdicts_of(*functions, **few):
    """Return the verdicts of theory's claims, by the functions that make them."""
    return [claim.verdict for claim in STUDY.measure_theory(few, only=functions).claims]


@pytest.mark.parametrize(
    "broken",
    [
        naive_directions,
        lambda slip, rim: mean_directions(slip, rim)[::-1],
        lambda slip, rim: tuple(np.array(mean_directions(slip, rim)) * (1.0 + 1e-9)),
    ],
)
def test_a_wrong_closed_form_is_found_out(broken, monkeypatch):
    monkeypatch.setattr("reference_model.contact.contact_law.mean_directions", broken)
    assert verdicts_of("closed_form") == [Verdict.DIFFERS]


def test_a_wrong_expansion_is_found_out(monkeypatch, fresh):
    def two_terms(self, slip_speed, relative_spin):
        _, c, s = self._polar(slip_speed, relative_spin)
        return Shares(c * (1.0 - 0.5 * s**2), self.radius * s * (1.0 - 0.5 * c**2))

    monkeypatch.setattr("reference_model.contact.contact_law.ThreeTermRing.shares", two_terms)
    assert verdicts_of("error_of_expansion", "place_of_expansion_error") == [Verdict.DIFFERS] * 2


def test_points_in_the_wrong_places_are_found_out(monkeypatch, fresh):
    def uneven(self, angle):
        return [
            self.radius * np.exp(1j * (angle + 2.0 * np.pi * i / (self.points + 1)))
            for i in range(self.points)
        ]

    monkeypatch.setattr("reference_model.contact.contact_law.PointsOnRing.arms", uneven)
    functions = ("error_of_points", "place_of_points_error")
    assert Verdict.DIFFERS in verdicts_of(*functions, **{key: {"numbers": (6,)} for key in functions})


def test_an_annulus_that_is_not_split_at_its_kink_is_found_out(monkeypatch):
    monkeypatch.setattr(Annulus, "_resting_radius", lambda self, slip, spin: self.outer_radius)
    found = verdicts_of("annulus_converges", "slopes_converge")
    assert len(found) == 2
    assert Verdict.AGREES not in found


def test_an_annulus_with_all_its_load_outside_is_found_out(monkeypatch):
    monkeypatch.setattr(Annulus, "_pressure_at", lambda self, radius: radius)
    assert verdicts_of("in_place") == [Verdict.DIFFERS]
    monkeypatch.setattr(Annulus, "_resting_radius", lambda self, slip, spin: self.inner_radius)
    monkeypatch.setattr(Annulus, "_loads", lambda self, centre: [(self.outer_radius, 1.0)])
    assert verdicts_of("thin_annulus") == [Verdict.DIFFERS]


def test_the_top_of_a_parabola_is_found():
    place, size, error = theory.top(lambda ratio: 2.0 - (ratio - 0.9) ** 2, 1e-12)
    assert place == pytest.approx(0.9, abs=error)
    assert size == pytest.approx(2.0)
    assert error == pytest.approx(2e-6, rel=0.01)
