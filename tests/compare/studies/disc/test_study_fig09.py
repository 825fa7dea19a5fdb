"""The study of Figs. 9 and 10 agrees for every sound engine, and each of its claims fails for broken ones."""

import functools
from dataclasses import replace

import numpy as np
import pytest
from studies_under_test import altered, verdicts

from compare.claims.claim import Verdict
from compare.engines import Engine, engines
from compare.studies.disc.fig09 import claims as study
from compare.studies.disc.fig09 import theory
from reference_model import simulate
from reference_model.contact.contact_law import Ring, Shares, Slopes
from reference_model.formulas.pin import first_order_whirl_shift


class OtherMoment(Ring):
    """A ring whose moment is 1 % too large."""

    def shares(self, slip_speed, relative_spin):
        resistance, moment = super().shares(slip_speed, relative_spin)
        return Shares(resistance, 1.01 * moment)

    def slopes(self, slip_speed, relative_spin):
        f_u, f_s, m_u, m_s = super().slopes(slip_speed, relative_spin)
        return Slopes(f_u, f_s, 1.01 * m_u, 1.01 * m_s)


def other_moment(system, state, times, *, tolerance=1e-9):
    return simulate(system, state, times, tolerance=tolerance, contact=OtherMoment(system.contact_radius))


def five_points(system, state, times, *, tolerance=1e-9):
    return simulate(replace(system, contact_points=5), state, times, tolerance=tolerance)


FEW = {"orbits": ((0.0015, 0), (0.0015, 1)), "rest_loads": (0.05,), "stick_loads": (0.2,)}

OF_SIX = {study.SIX_CIRCLE, study.SIX_RESTS, study.SIX_LETS_GO}
OF_CIRCLE = {study.CIRCLE, study.BY_23, study.LARGE}
OF_RING = OF_CIRCLE | {
    study.ORBIT,
    study.SHIFTED,
    study.SHRUNK,
    study.RESTS,
    study.GROWS,
    study.DECAYS,
    study.STAYS,
    study.LETS_GO,
    study.COEXIST,
}

BALANCES = OF_CIRCLE | {study.ORBIT, study.SHRUNK, study.GROWS, study.LETS_GO}
"""What every wrong force or moment changes."""

FAULTS = {
    "friction 0.1 % off": (altered(friction_force=1.001), BALANCES | {study.RESTS} | OF_SIX),
    # Damping does not move what rests, and to first order the shift by the offset follows from it alone.
    "damping 0.1 % off": (
        altered(damping=1.001),
        BALANCES | {study.SHIFTED, study.DECAYS, study.SIX_CIRCLE, study.SIX_LETS_GO},
    ),
    "inertia 10 % off": (altered(polar_inertia=1.1), {study.ORBIT, study.GROWS, study.SIX_LETS_GO}),
    "moment 1 % off": (Engine("other moment", other_moment, ("ring",)), BALANCES | {study.RESTS}),
    "five points for six": (Engine("five points", five_points, ("points",)), OF_SIX),
}
"""Engines with a fault, and the statements that see it."""


QUICK = {
    study.ORBIT: lambda engine: study.orbit_claim(engine, ((0.0015, 1),)),
    study.RESTS: lambda engine: study.rest_claim(
        engine, (0.05,), *study.measured_rests(engine, study.RING, (0.05,))
    ),
    study.GROWS: study.growth_claim,
    study.STAYS: lambda engine: study.stays_claim(engine, (0.2,))[0],
    study.LETS_GO: lambda engine: study.release_claim(engine, (0.2,)),
    study.COEXIST: study.coexistence_claim,
}
QUICK_OF_SIX = {
    study.SIX_RESTS: lambda engine: study.six_rest_claim(
        engine, (0.05,), *study.measured_rests(engine, study.on_six(study.RING), (0.05,))
    ),
    study.SIX_LETS_GO: lambda engine: study.six_release_claim(engine, (0.2,)),
}


@functools.cache
def measured():
    """Measure a part of the study with the reference, once for all tests."""
    return study.measure(engines(["reference"])[0], **FEW)


@functools.cache
def found_by_theory():
    return study.theory()


def test_every_statement_holds_in_the_reference():
    assert verdicts(measured()) == dict.fromkeys(OF_RING | OF_SIX, Verdict.AGREES)


@pytest.mark.parametrize(
    ("name", "sentence"),
    [("exudyn", sentence) for sentence in QUICK | QUICK_OF_SIX]
    + [("exudyn-native", sentence) for sentence in QUICK_OF_SIX],
)
def test_the_quick_statements_hold_in_exudyn(name, sentence):
    claim = (QUICK | QUICK_OF_SIX)[sentence](engines([name])[0])
    assert claim.sentence == sentence
    assert claim.verdict is Verdict.AGREES


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_is_seen_by_the_statements_that_it_concerns_and_by_no_others(fault):
    engine, seen = FAULTS[fault]
    found = verdicts(study.measure(engine, **FEW))
    assert found == dict.fromkeys(found, Verdict.AGREES) | dict.fromkeys(seen, Verdict.DIFFERS)


def test_a_disc_with_half_the_friction_does_not_stick_where_it_should():
    half = altered(friction_force=0.5)
    assert study.stays_claim(half, (0.12, 0.2))[0].verdict is Verdict.DIFFERS
    assert study.coexistence_claim(half).verdict is Verdict.DIFFERS


def test_an_engine_of_points_only_measures_the_rows_of_six_points():
    points = study.measure(Engine("points", simulate, ("points",)), **FEW)
    assert set(verdicts(points)) == OF_SIX
    assert "continuous ring" in points.not_simulated


def test_the_theory_holds():
    assert verdicts(found_by_theory()) == dict.fromkeys(
        (theory.FOLD, theory.WEAK, theory.MERGES), Verdict.AGREES
    )


def test_the_spin_of_the_whirl_tends_to_a_limit_that_does_not_depend_on_the_load():
    far = [theory.whirl_at(theory.RING, alpha) for alpha in (1e-4, 1e-6)]
    assert far[1].load == pytest.approx(100.0 * far[0].load, rel=1e-6)
    # The next term of M : R²S/(2U) is of the order α².
    for whirl, alpha in zip(far, (1e-4, 1e-6), strict=True):
        assert whirl.spin == pytest.approx(theory.spin_of_large_whirl(theory.RING), abs=alpha**2 + 1e-14)


def test_the_shift_of_a_small_disc_is_that_of_a_pin():
    small = replace(theory.RING, contact_radius=1e-5, shaft_damping=1e-9, damping=0.1, friction_force=0.12)
    shift = theory.first_order_shift(small)
    pin = first_order_whirl_shift(theory.pin_of(small))
    assert [shift.real, shift.imag] == pytest.approx(pin, rel=1e-9)


@pytest.mark.parametrize(("load", "stable"), [(0.02, True), (0.022, False), (0.1, False)])
def test_the_equilibrium_is_stable_up_to_a_load_far_below_the_one_at_which_sticking_begins(load, stable):
    assert study.rest_of(load).stable is stable
    assert theory.last_stable_load(theory.RING) < 0.25 * theory.last_load(theory.RING)


def test_a_wrong_formula_for_the_loss_of_stability_is_seen(monkeypatch):
    right = theory.weak_damping_load
    monkeypatch.setattr(theory, "weak_damping_load", lambda disc: 1.1 * right(disc))
    assert theory.weak_damping_claim(theory.RING).verdict is Verdict.DIFFERS


def test_whirls_that_shrink_onto_another_place_are_seen(monkeypatch):
    orbits = theory.orbits()
    end = theory.last_stable_load(theory.RING)
    monkeypatch.setattr(theory, "last_stable_load", lambda disc: 1.001 * end)
    assert theory.merging_claim(orbits).verdict is Verdict.DIFFERS


def test_a_wrong_smallest_load_is_seen(monkeypatch):
    right = theory.smallest_load_with_whirl
    monkeypatch.setattr(theory, "smallest_load_with_whirl", lambda *which: 1.001 * right(*which))
    assert theory.fold_claim().verdict is Verdict.DIFFERS


def test_the_curve_of_the_whirls_goes_from_the_largest_load_to_the_equilibrium():
    load, least, greatest, spin = found_by_theory().data["orbits"].T
    rest = study.rest_of(load[-1])
    assert load[0] == pytest.approx(theory.LARGEST_LOAD)
    assert load[-1] == pytest.approx(theory.last_stable_load(theory.RING))
    assert least[-1] == pytest.approx(np.hypot(rest.x, rest.y))
    assert greatest[-1] == pytest.approx(least[-1])
    assert spin[-1] == pytest.approx(rest.spin)
    assert np.all(least <= greatest)


def test_figures_are_drawn_whatever_is_there():
    found = measured().data
    of_six = {name: found[name] for name in ("circle load", "rest load", "six circle", "six rest")}
    data = {"reference": found, "points": of_six, "theory": found_by_theory().data}
    assert set(study.draw(data)) == set(study.STUDY.figures)
    for name in data:
        assert set(study.draw({name: data[name]})) <= set(study.STUDY.figures)
