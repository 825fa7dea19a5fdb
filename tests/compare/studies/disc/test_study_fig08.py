"""The study of Fig. 8: what its claims see, and that its formulas are those of an independent solution."""

import functools
from dataclasses import replace

import numpy as np
import pytest
from faults.reference import simulate
from studies_under_test import altered, sentences
from study_harness import BLIND, LEFT_OUT, OPEN, SEES, StudyTests, engine_named

from compare.claims.claim import Verdict
from compare.engines import EVERY_KIND, Engine
from compare.studies.disc.fig08 import theory
from compare.studies.disc.fig08.study import STUDY
from compare.studies.disc.fig08.theory import RING
from compare.studies.toolkit.steady_motion import last_load, with_load
from reference_model.contact.contact_law import Ring, Shares
from reference_model.formulas.disc import places_by_26


class DrivingRing(Ring):
    """A ring whose friction turns the disc against the master disc."""

    def shares(self, slip_speed, relative_spin):
        resistance, moment = super().shares(slip_speed, relative_spin)
        return Shares(resistance, -moment)


def driving(system, state, times, *, tolerance=1e-9):
    contact = DrivingRing(system.contact_radius) if system.contact_points is None else None
    return simulate(system, state, times, tolerance=tolerance, contact=contact)


def on_five_points(system, state, times, *, tolerance=1e-9):
    disc = system if system.contact_points is None else replace(system, contact_points=5)
    return simulate(disc, state, times, tolerance=tolerance)


class TestFig08(StudyTests):
    study = STUDY
    sound = ("reference", "exudyn")
    few = {
        "rests": {"loads": (0.02, 0.08)},
        "on_semicircle": {"loads": (0.02, 0.08)},
        "decays": {"spans": ((0.05, (500.0, 700.0)),)},
        "sticks": {"ratios": (0.98, 1.05)},
        "six_points": {"loads": (0.02, 0.08)},
        "curves": {"count": 9},
    }
    faults = {
        "a thousandth more friction": altered(friction_force=1.001),
        "half the damping": altered(damping=0.5),
        "half the inertia": altered(polar_inertia=0.5),
        "five points for six": Engine("broken", on_five_points, EVERY_KIND),
        "a moment of the wrong sign": Engine("broken", driving, EVERY_KIND),
    }
    columns = ("rests", "on_semicircle", "decays", "ends", "sticks", "six_points")
    table = {
        # The semicircle and whether the disc sticks at 5 % more load do not depend on a thousandth of friction; and
        # the decay towards another place than the equilibrium is inconclusive.
        "a thousandth more friction": (SEES, BLIND, OPEN, SEES, BLIND, SEES),
        # Neither damping nor inertia moves an equilibrium; the motion that leads there depends on them.
        "half the damping": (LEFT_OUT, LEFT_OUT, SEES, LEFT_OUT, LEFT_OUT, LEFT_OUT),
        "half the inertia": (LEFT_OUT, LEFT_OUT, SEES, LEFT_OUT, LEFT_OUT, LEFT_OUT),
        "five points for six": (LEFT_OUT, LEFT_OUT, LEFT_OUT, LEFT_OUT, LEFT_OUT, SEES),
        "a moment of the wrong sign": (SEES, LEFT_OUT, LEFT_OUT, LEFT_OUT, LEFT_OUT, LEFT_OUT),
    }

    def test_a_moment_of_the_wrong_sign_leaves_no_equilibrium_at_the_larger_load(self):
        """It turns the disc against the master disc."""
        (rests,) = self.claims_of_fault("a moment of the wrong sign", "rests")
        assert np.all(np.isfinite(rests.measured[0]))
        assert np.all(np.isnan(rests.measured[1]))

    def test_an_engine_without_the_ring_is_judged_by_six_points_alone(self):
        engine = replace(engine_named("reference"), kinds=("points",))
        findings = STUDY.measure(engine, self.few)
        assert [(claim.identity, claim.verdict) for claim in findings.claims] == [
            ("fig08/six-points", Verdict.AGREES)
        ]
        assert "ring" not in findings.data
        assert "continuous ring" in findings.not_simulated

    def test_figures_are_drawn_without_the_ring(self):
        found = {name: values for name, values in self.found("reference").data.items() if name != "ring"}
        figures = STUDY.draw({"reference": found, "theory": self.found("theory").data})
        assert set(figures) == set(STUDY.figures)

    def test_an_uncorrected_26_is_found_out(self, monkeypatch):
        printed = functools.partial(places_by_26, as_printed=True)
        monkeypatch.setattr(theory, "places_by_26", lambda disc, as_printed=True: printed(disc))
        findings = STUDY.measure_theory(only=("corrected_26", "printed_26", "end_of_26"))
        assert sentences(findings, Verdict.DIFFERS) == {
            one.sentence for one in STUDY.declared if one.function.__name__ in ("corrected_26", "printed_26")
        }

    def test_the_spins_of_fig_8_are_those_of_an_independent_solution(self):
        """Radius and spin from the balances by bisection with quadrature of (20), at four loads."""
        known = {
            0.02: (0.09813, 0.54727, 0.55425),
            0.05: (0.08743, 0.60294, 0.61225),
            0.08: (0.06288, 0.66121, 0.67054),
            0.095: (0.03940, 0.70643, 0.71494),
        }
        for load, (radius, spin, by_26) in known.items():
            disc = with_load(RING, load)
            x, y, found = theory.place_and_spin(disc)
            (place,) = places_by_26(disc)
            assert (np.hypot(x, y), found, place.spin) == pytest.approx((radius, spin, by_26), abs=5.1e-6)

    def test_the_end_of_a_tiny_offset_is_that_of_the_moment_and_of_a_large_one_that_of_the_springs(self):
        moment = 0.003 / 0.12
        small, large = (last_load(replace(RING, offset=offset)) for offset in (1e-6, 10.0))
        assert small == pytest.approx(moment, rel=1e-6)
        assert large == pytest.approx(10.0, rel=1e-4)
