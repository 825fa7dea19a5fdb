"""The drivetrain reduced to a disc agrees with the reference, and finds out parts that are wrong."""

import functools

import numpy as np
import pytest
from studies_under_test import findings_of, sentences, verdicts

from compare.claims.claim import Verdict
from compare.studies.drivetrain.reduced import claims as study
from exudyn_models.drivetrain import model as drivetrain

SENTENCES = {name: study.SENTENCE.format(name) for name in study.CASES}
FIG8, CYCLE, OFFSET, FACING, HARDENING, STOP = study.CASES


def measured(*names, inertias=()):
    cases = {name: study.CASES[name] for name in names}
    return findings_of(study, "exudyn", {"cases": cases, "inertias": np.array(inertias)})


@functools.cache
def everything():
    return findings_of(study, "exudyn", {})


def test_every_statement_holds():
    assert verdicts(everything()) == dict.fromkeys([*SENTENCES.values(), study.ORDER], Verdict.AGREES)


def test_the_figure_is_drawn_of_what_there_is():
    (figure,) = study.draw({"exudyn": everything().data}).values()
    figure.canvas.draw()
    assert set(study.draw({"exudyn": everything().data})) == set(study.STUDY.figures)
    assert study.draw({}) == {}


def test_the_cases_have_what_their_names_say():
    data = everything().data

    def radii(name):
        return np.hypot(*data[f"{name}: states"][:, :2].T)

    assert np.ptp(radii(CYCLE)) > 0.01  # modulated
    assert radii(STOP).max() > study.CASES[STOP].disc.stop_gap
    for name in (OFFSET, FACING, HARDENING, STOP):
        assert np.abs(data[f"{name}: states"][-1] - data[f"{CYCLE}: states"][-1]).max() > 1e-3, name


@pytest.mark.parametrize(
    ("part", "name", "factor", "cases"),
    [
        ("add_ring_friction", "normal_load", 1.0 + 1e-6, {CYCLE, FACING}),
        ("add_ring_friction", "outer_radius", 1.0 + 1e-6, {FACING}),
        ("add_radial_support", "stiffness", 1.0 + 1e-6, {CYCLE, OFFSET}),
        ("add_radial_support", "damping", 1.0 + 1e-6, {CYCLE}),
        ("add_radial_support", "hardening", 1.0 + 1e-5, {HARDENING}),
        ("add_radial_support", "stop_stiffness", 1.0 + 1e-5, {STOP}),
        ("add_radial_support", "stop_gap", 1.0 + 1e-6, {STOP}),
    ],
)
def test_a_part_that_is_off_by_a_millionth_is_found_out(monkeypatch, part, name, factor, cases):
    add = getattr(drivetrain, part)

    def off(*nodes, **parameters):
        return add(*nodes, **parameters | {name: factor * parameters[name]})

    monkeypatch.setattr(drivetrain, part, off)
    found = sentences(measured(*cases), Verdict.DIFFERS)
    assert found == {SENTENCES[case] for case in cases}


def test_a_shaft_on_the_wrong_axis_is_found_out(monkeypatch):
    add = drivetrain.add_radial_support
    monkeypatch.setattr(
        drivetrain,
        "add_radial_support",
        lambda *nodes, **parameters: add(*nodes, **parameters | {"offset": (0.0, parameters["offset"][0])}),
    )
    found = verdicts(measured(CYCLE, OFFSET))
    assert found == {SENTENCES[CYCLE]: Verdict.AGREES, SENTENCES[OFFSET]: Verdict.DIFFERS}


@pytest.mark.parametrize(
    "change", [lambda inertia: 0.0, lambda inertia: 1e-4, lambda inertia: 100.0 * inertia**-2.0]
)
def test_an_influence_of_the_inertia_of_another_order_is_found_out(monkeypatch, change):
    motion = study.drivetrain_motion
    data = functools.cache(lambda tolerance: motion(study.CYCLE, tolerance))

    def of_another_order(case, tolerance, inertia=study.ENDLESS):
        times, states = data(tolerance)
        return times, states + (change(inertia) if inertia < study.ENDLESS else 0.0)

    monkeypatch.setattr(study, "drivetrain_motion", of_another_order)
    findings = findings_of(study, "exudyn", {"cases": {}, "inertias": study.INERTIAS})
    assert verdicts(findings) == {study.ORDER: Verdict.DIFFERS}
