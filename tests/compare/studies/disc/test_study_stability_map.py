from dataclasses import replace

import numpy as np

from compare.claims.claim import Verdict
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


def test_the_text_contains_the_limits_of_the_expansion_in_the_load():
    """Check numbers that are not quoted from claims."""
    limits = [
        crossings(PLANES["load"], kind, "disc_speed", DISC.disc_speed, LAWS["(23)"])[0]
        for kind in ("fold", "Hopf", "onset")
    ]
    assert [f"{value:.4f}" for value in limits] == ["0.0197", "0.0202", "0.0205"]
    words = "only between 0.0197 and 0.0202 N. This is below the onset at 0.0205 N"
    assert words in STUDY.prose.paper.replace("\n", " ")
