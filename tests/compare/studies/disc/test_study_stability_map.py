"""The study of the stability map agrees for every sound engine, fails for broken ones, and says what it finds."""

import functools
from dataclasses import replace

import numpy as np
import pytest
from studies_under_test import sentences, verdicts

import reference_model
from compare.claims.claim import Verdict
from compare.engines import EVERY_KIND, Engine, engines
from compare.report.numbers import with_digits
from compare.report.quotes import filled
from compare.studies.disc.stability_map import claims as study
from compare.studies.disc.stability_map import theory as of_theory
from reference_model.contact.contact_law import ThreeTermRing
from reference_model.steady.bifurcation_curves import crossings

FEW = {
    "lines": (("load", "disc_speed", 1.5),),
    "regions": study.starts_in_regions()[1:4],
    "beside": study.coexisting()[:2],
    "loads": (0.0221,),
}
ALL = {study.SIDES, study.RATES, study.REGIONS, study.COEXIST}

theory = functools.cache(of_theory.theory)


def with_three_terms(system, initial_state, times, *, tolerance=1e-9):
    """Simulate (23) in place of the ring."""
    law = ThreeTermRing(system.contact_radius)
    return reference_model.simulate(system, initial_state, times, tolerance=tolerance, contact=law)


def with_more_of(name, factor, system, initial_state, times, *, tolerance=1e-9):
    """Simulate a system of which one parameter is not as it should be."""
    system = replace(system, **{name: factor * getattr(system, name)})
    return reference_model.simulate(system, initial_state, times, tolerance=tolerance)


BROKEN = {
    "(23)": (with_three_terms, ALL),
    "4 % more inertia": (functools.partial(with_more_of, "polar_inertia", 1.04), {study.RATES}),
    # So much more shaft damping that the whirl of Fig. 11 is stable.
    "8 % more shaft damping": (functools.partial(with_more_of, "shaft_damping", 1.08), ALL),
}


@pytest.mark.parametrize("name", ["reference", "exudyn"])
def test_every_statement_holds_in_a_sound_engine(name):
    (engine,) = engines([name])
    assert verdicts(study.measure(engine, **FEW)) == dict.fromkeys(ALL, Verdict.AGREES)


@pytest.mark.parametrize("fault", BROKEN)
def test_a_broken_engine_is_found_out(fault):
    simulate, seen = BROKEN[fault]
    findings = study.measure(Engine(fault, simulate, EVERY_KIND), **FEW)
    assert sentences(findings, Verdict.DIFFERS) >= seen


def test_an_engine_for_pins_only_is_neither_passed_nor_failed():
    findings = study.measure(Engine("pins", reference_model.simulate), **FEW)
    assert not findings.claims
    assert "continuous ring" in findings.not_simulated


def test_the_theory_holds():
    found = verdicts(theory())
    assert len(found) == 12
    assert set(found.values()) == {Verdict.AGREES}


def test_a_curve_that_is_a_little_off_does_not_pass():
    plane, law = "inertia", "(23)"
    (curve,), folds = (
        of_theory.boundaries(of_theory.PLANES[plane], kind, of_theory.LAWS[law], step=0.2)
        for kind in ("Hopf", "fold")
    )
    shifted = replace(curve, alpha=curve.alpha + 1e-7)
    for points, verdict in ((curve, Verdict.AGREES), (shifted, Verdict.DIFFERS)):
        traced = {(plane, law, "Hopf"): (points,), (plane, law, "fold"): folds}
        found = next(
            claim for claim in of_theory.marginal_claims(traced) if claim.sentence == of_theory.MARGINAL
        )
        assert found.verdict is verdict


def test_a_rotation_that_is_damped_a_little_more_needs_another_remedy(monkeypatch):
    rotation = of_theory.growth_of_rotation
    monkeypatch.setattr(
        of_theory,
        "growth_of_rotation",
        lambda disc: rotation(replace(disc, damping=(1.0 + 1e-9) * disc.damping)),
    )
    claim = of_theory.remedies_claim()
    assert claim.verdict is Verdict.DIFFERS
    assert np.all(claim.difference > claim.budget.total)


def test_without_a_border_there_is_no_change_of_stability():
    value, _ = of_theory.change_of_stability("friction_force", 0.024, of_theory.LAWS["ring"])
    assert np.isnan(value)


def test_the_text_gives_the_numbers_of_the_map():
    """What is said to an engineer, from the curves."""
    disc, ring = of_theory.DISC, of_theory.LAWS["ring"]
    text = filled(study.STUDY.paper, theory().claims)

    def borders(plane, name, kind="Hopf", law=ring):
        fixed = next(other for other in of_theory.PLANES[plane].names if other != name)
        return crossings(of_theory.PLANES[plane], kind, fixed, getattr(disc, fixed), law)

    def percent(value, of, digits=2):
        change = 100.0 * (value / of - 1.0)
        return "+" * (change > 0.0) + with_digits(change, digits)

    for plane, name, digits in (
        ("load", "friction_force", 4),
        ("dampers", "shaft_damping", 4),
        ("dampers", "damping", 3),
    ):
        here = getattr(disc, name)
        for value in borders(plane, name):
            assert f"{value:.{digits}f}" in text
            assert f"({percent(value, here)} %)" in text
    near = of_theory.nearest(borders("speeds", "shaft_speed"), disc.shaft_speed)
    for value in near:
        assert f"{value:.3f}" in text
    (inertia,) = borders("inertia", "polar_inertia")
    assert f"{inertia:.2f} kg m² ({percent(inertia, disc.polar_inertia)} %)" in text

    (damping,) = borders("dampers", "damping", "onset")
    (shaft_damping,) = borders("dampers", "shaft_damping", "onset")
    (load,) = borders("load", "friction_force", "onset")
    shaft_speed = min(borders("speeds", "shaft_speed", "onset"))
    slip = (disc.disc_speed - shaft_speed) / (disc.disc_speed - disc.shaft_speed)
    remedies = (shaft_damping / disc.shaft_damping, slip, damping / disc.damping, load / disc.friction_force)
    words = (
        "{} % of shaft damping on, {} % of slip speed ω − Ω, {} % of damping of the springs, or {} % of load"
    )
    assert words.format(*(percent(ratio, 1.0, 3) for ratio in remedies)) in text

    three = of_theory.LAWS["(23)"]
    limits = [borders("load", "friction_force", kind, three)[0] for kind in ("fold", "Hopf", "onset")]
    assert [f"{value:.4f}" for value in limits] == ["0.0197", "0.0202", "0.0205"]
    assert "only between 0.0197 and 0.0202 N, below the onset at 0.0205 N" in text


def test_figures_are_drawn_whatever_is_there():
    data = {"reference": study.measure(engines(["reference"])[0], **FEW).data, "theory": theory().data}
    assert set(study.draw(data)) == set(study.STUDY.figures)
    for part in ({}, {"theory": data["theory"]}, {"reference": data["reference"]}):
        assert set(study.draw(part)) <= set(study.STUDY.figures)
