"""The study of Fig. 11: what its claims see, and that its theory holds together."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from faults.reference import simulate
from study_harness import LEFT_OUT, OPEN, SEES, StudyTests, engine_named

from compare.claims.claim import Verdict
from compare.engines import EVERY_KIND, Engine
from compare.studies.disc.fig11 import STUDY, pictures, theory, whirl
from compare.studies.disc.fig11.parameters import EXPANSION, TIMES, UNTIL
from compare.studies.toolkit.fig11 import DISCS, RING
from reference_model import Trajectory, self_centred_equilibria, whirl_orbit, whirls

NO_PASS = (SEES, OPEN)
"""A motion beside the whirl is not small, which may leave its growth inconclusive."""


def changed(name, kinds=EVERY_KIND, factors=None, **values):
    """Return an engine that computes with other parameters than it is asked for."""

    def simulated(system, initial_state, times, *, tolerance=1e-9):
        other = {key: factor * getattr(system, key) for key, factor in (factors or {}).items()}
        run = simulate(replace(system, **(values | other)), initial_state, times, tolerance=tolerance)
        return replace(run, system=system)

    return Engine(name, simulated, kinds)


def by_23(system, initial_state, times, *, tolerance=1e-9):
    """A disc with Fig. 11's law replaced by (23)."""
    return simulate(system, initial_state, times, tolerance=tolerance, contact=EXPANSION)


def states_of(z):
    """Return states whose centre moves like the complex ``z``."""
    return np.column_stack((z.real, z.imag, *np.zeros((4, len(z)))))


class TestFig11(StudyTests):
    study = STUDY
    sound = ("reference",)
    few = {
        "ends": {"offsets": (0.006, 0.009, 0.022)},  # on all three sides of the critical ones
        "curves": {"whirling": (0.0, 0.005, 0.01, 0.015)},
    }
    faults = {
        "friction 0.1 % off": changed("friction", ("ring",), factors={"friction_force": 1.001}),
        "no offset": changed("no offset", ("ring",), offset=0.0),
        "five points for six": changed("five points", ("points",), contact_points=5),
        "(23)": Engine("(23)", by_23, ("ring",)),
    }
    columns = (
        "slides",
        "rate_of_growth",
        "frequency_of_growth",
        "period_and_turn",
        "extremes",
        "critical",
        "ends",
        "points_rest",
        "extremes_on_six_points",
    )
    table = {
        "friction 0.1 % off": (*[NO_PASS] * 6, *[LEFT_OUT] * 3),
        "no offset": (*[LEFT_OUT] * 5, NO_PASS, NO_PASS, *[LEFT_OUT] * 2),
        "five points for six": (*[NO_PASS] * 3, *[LEFT_OUT] * 4, NO_PASS, NO_PASS),
        "(23)": (*[NO_PASS] * 3, *[LEFT_OUT] * 6),
    }

    @pytest.mark.parametrize(
        ("kind", "lacking"), [("ring", "a disc on single points"), ("points", "a disc on a continuous ring")]
    )
    def test_an_engine_of_one_kind_of_contact_is_measured_by_what_it_simulates(self, kind, lacking):
        engine = replace(engine_named("reference"), name=f"only {kind}", kinds=(kind,))
        findings = STUDY.measure(engine, self.few)
        own = {claim.sentence for claim in self.found("reference").claims if self.kind_of(claim) == kind}
        assert {claim.sentence: claim.verdict for claim in findings.claims} == dict.fromkeys(
            own, Verdict.AGREES
        )
        assert findings.not_simulated == f"only {kind} does not simulate {lacking}"
        for data in ({kind: findings.data}, {kind: findings.data, "theory": self.found("theory").data}):
            assert set(STUDY.draw(data)) <= set(STUDY.figures)

    @pytest.mark.parametrize("claim", ["slides", "period_and_turn"])
    def test_the_quick_claims_hold_in_exudyn(self, claim):
        found = STUDY.measure(engine_named("exudyn"), only=(claim,)).claims
        assert {one.verdict for one in found} == {Verdict.AGREES}

    @staticmethod
    def kind_of(claim):
        return "ring" if claim.parameters["contact_points"] == "continuous ring" else "points"

    def test_all_figures_are_drawn_of_all_that_is_there(self):
        data = {name: self.found(name).data for name in ("reference", "theory")}
        assert set(STUDY.draw(data)) == set(STUDY.figures)
        assert STUDY.draw({}) == {}

    def test_many_points_lose_their_stability_like_the_ring(self):
        """Points are a quadrature of the ring, which converges faster than any power while no point comes to rest."""
        exact = theory.steady_whirl(RING).eigenvalue
        errors = [
            abs(theory.steady_whirl(replace(RING, contact_points=points)).eigenvalue - exact)
            for points in (6, 12, 24)
        ]
        # If the error fell like a power, each doubling would divide it by the same number.
        assert errors[0] / errors[1] < errors[1] / errors[2]
        assert errors[2] < 1e-3 * abs(exact)

    def test_modes_of_the_whirl_are_eigenvectors_of_its_growth(self):
        """The share of the pair in a deviation along the mode is a half, and not that of the conjugate."""
        for disc in DISCS.values():
            one = theory.steady_whirl(disc)
            assert one.projection @ one.mode == pytest.approx(1.0, abs=1e-9)
            assert abs(one.projection @ one.mode.conj()) < 1e-5

    def test_the_growth_of_an_exponential_is_found_with_its_scatter(self):
        times = np.linspace(0.0, 200.0, 33)
        share = 0.7j * np.exp((0.01 + 0.03j) * times)
        slopes, scatter = whirl.fitted(times, share)
        assert slopes == pytest.approx([0.01, 0.03], abs=1e-12)
        assert np.all(scatter < 1e-12)
        noise = 1e-4 * np.random.default_rng(3).standard_normal(len(times))
        slopes, scatter = whirl.fitted(times, share * (1.0 + noise))
        assert 0.0 < abs(slopes[0] - 0.01) < 2.0 * scatter[0] < 1e-5

    def test_multipliers_by_variation_are_the_exponentials_of_the_eigenvalues_of_the_circle(self):
        circle = whirl_orbit(RING, tolerance=1e-10, samples=2)
        multipliers = theory.multipliers_by_variation(RING, circle)
        exact = np.exp(np.array(whirls(RING)[0].eigenvalues) * 2.0 * math.pi / RING.natural_frequency)
        assert sorted(np.abs(multipliers)) == pytest.approx(sorted(np.abs(exact)), abs=1e-8)

    def test_the_whirl_ends_where_a_pair_of_eigenvalues_of_the_equilibrium_crosses_the_axis(self):
        below, above = (
            self_centred_equilibria(theory.disc_at(theory.rest_offset() + shift))[0]
            for shift in (-1e-5, 1e-5)
        )
        assert above.stable
        assert not below.stable
        assert abs(below.eigenvalues[0].imag) == pytest.approx(RING.natural_frequency, rel=0.01)

    def test_lines_of_a_known_modulation_are_its_side_bands(self):
        """A carrier whose size swings by a cosine has one side band on each side, with half of the swing."""
        period, carrier = 230.0, 1.002
        size = 0.02 + 0.01 * np.cos(2.0 * math.pi * TIMES / period)
        states = states_of(size * np.exp(1j * carrier * TIMES))
        heights = pictures.harmonics(states, period, carrier)
        expected = np.zeros(2 * pictures.SIDE_BANDS + 1)
        expected[pictures.SIDE_BANDS - 1 : pictures.SIDE_BANDS + 2] = 0.005, 0.02, 0.005
        # A cubic spline's error, of a function with derivatives below 0.03.
        assert heights == pytest.approx(expected, abs=0.03 * TIMES[1] ** 4 / 384.0)
        frequency, amplitude = pictures.spectrum(states)
        assert frequency[np.argmax(amplitude)] == pytest.approx(carrier, abs=math.pi / UNTIL)
        assert np.max(amplitude) == pytest.approx(0.02, rel=0.05)

    def test_a_motion_without_a_modulation_has_none(self):
        last, change = theory.last_modulation(states_of(0.02 * np.exp(1j * TIMES)))
        assert last.shape == change.shape == (6,)


def test_an_engine_that_tells_no_phases_is_not_asked_when_single_points_rest():
    def at_rest(system, initial_state, times, *, tolerance=1e-9):
        return Trajectory(system, np.array(times), np.zeros((len(times), system.state_size)))

    found = STUDY.measure(Engine("mine", at_rest, EVERY_KIND, phases=False), only=("points_rest",))
    assert (found.claims, found.not_simulated) == ((), "mine does not tell when single points rest")
