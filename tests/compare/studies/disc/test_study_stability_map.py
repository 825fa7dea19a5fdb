"""The study of the stability map: its text contains its results."""

from dataclasses import replace

import numpy as np
from tested_studies import STABILITY_MAP

from compare.claims.claim import Verdict
from compare.report.numbers import with_digits
from compare.report.quotes import filled
from compare.studies.disc.stability_map import STUDY, borders, theory
from compare.studies.disc.stability_map.theory import DISC
from compare.studies.toolkit.fig11 import LAWS, PLANES, curves_in
from reference_model.steady.bifurcation_curves import crossings


def test_a_slightly_shifted_curve_differs():
    (curve,) = curves_in("inertia", "Hopf", "(23)", step=0.2)
    shifted = replace(curve, alpha=curve.alpha + 1e-7)
    for points, verdict in ((curve, Verdict.AGREES), (shifted, Verdict.DIFFERS)):
        few = {"marginal": {"curves": {("inertia", "(23)", "Hopf"): (points,)}}}
        (found,) = STUDY.measure_theory(few, only=("marginal",)).claims
        assert found.verdict is verdict


def test_slightly_wrong_damping_of_the_rotation_changes_the_remedies(monkeypatch):
    growth = borders.growth_of_rotation
    monkeypatch.setattr(
        borders,
        "growth_of_rotation",
        lambda disc: growth(replace(disc, damping=(1.0 + 1e-9) * disc.damping)),
    )
    (claim,) = STUDY.measure_theory(only=("remedies",)).claims
    assert claim.verdict is Verdict.DIFFERS
    assert np.all(claim.difference > claim.budget.total)


def test_a_change_of_stability_needs_a_border():
    value, _ = theory.change_of_stability("friction_force", 0.024, LAWS["ring"])
    assert np.isnan(value)


def test_the_text_contains_the_numbers_of_the_map():
    """Compare the advice to engineers with the curves."""
    disc, ring = DISC, LAWS["ring"]
    text = filled(STUDY.prose.paper, STABILITY_MAP.found("theory").claims)

    def borders(plane, name, kind="Hopf", law=ring):
        fixed = next(other for other in PLANES[plane].names if other != name)
        return crossings(PLANES[plane], kind, fixed, getattr(disc, fixed), law)

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
    near = theory.nearest(borders("speeds", "shaft_speed"), disc.shaft_speed)
    for value in near:
        assert f"{value:.3f}" in text
    (inertia,) = borders("inertia", "polar_inertia")
    assert f"{inertia:.2f} kg m² ({percent(inertia, disc.polar_inertia)} %)" in text

    (damping,) = borders("dampers", "damping", "onset")
    (shaft_damping,) = borders("dampers", "shaft_damping", "onset")
    (load,) = borders("load", "friction_force", "onset")
    shaft_speed = min(borders("speeds", "shaft_speed", "onset"))
    slip = (disc.disc_speed - shaft_speed) / (disc.disc_speed - disc.shaft_speed)
    remedies = (
        shaft_damping / disc.shaft_damping,
        slip,
        damping / disc.damping,
        load / disc.friction_force,
    )
    words = "{} % of shaft damping on, {} % of slip speed ω − Ω, {} % of damping of the springs, "
    words += "or {} % of friction force"
    assert words.format(*(percent(ratio, 1.0, 3) for ratio in remedies)) in text

    three = LAWS["(23)"]
    limits = [borders("load", "friction_force", kind, three)[0] for kind in ("fold", "Hopf", "onset")]
    assert [f"{value:.4f}" for value in limits] == ["0.0197", "0.0202", "0.0205"]
    assert "only between 0.0197 and 0.0202 N, below the onset at 0.0205 N" in text
