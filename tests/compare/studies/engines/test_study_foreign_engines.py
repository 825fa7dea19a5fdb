import importlib.util
import json
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import compare.foreign
from compare.claims.claim import Verdict
from compare.claims.parameters import FIG11
from compare.engines import UnsupportedSystemError, engines
from compare.engines.live import setting
from compare.foreign import CASES, CHANGE, COLUMNS, ERROR, SECONDS, STEPS, estimate, recordings
from compare.output.figures import paper_style
from compare.report.write import write_report
from compare.run.runner import run
from compare.studies import STUDIES
from compare.studies.engines.foreign_engines import study as foreign_engines
from compare.studies.engines.foreign_engines import theory
from compare.studies.engines.foreign_engines.study import STUDY
from compare.studies.engines.foreign_engines.theory import (
    BY_AXIS,
    FIRST_ORDER,
    halvings,
    recorded_claims,
    recorded_settings,
    time_to,
)
from reference_model import simulate

BUILDERS = Path(__file__).parents[4] / "builders"
OURS = {"reference", "exudyn", "exudyn-native"}
NAMES = {case.sentence: name for name, case in CASES.items()}
PINS_ONLY = {"Rapier", "Jolt"}


def verdicts(claims):
    """Return the verdict of each claim by the name of its function."""
    return {claim.identity.partition("/")[2]: claim.verdict for claim in claims}


def recorded_verdicts():
    """Return the verdict of each case by (engine, setting)."""
    return {
        (found.engine, found.setting): {NAMES[claim.sentence]: claim.verdict for claim in found.claims}
        for found in recorded_settings()
    }


def differing(case):
    """Return the names of all that differ in a case."""
    return {
        f"{engine}, {setting}" if setting else engine
        for (engine, setting), said in recorded_verdicts().items()
        if said.get(case) is Verdict.DIFFERS
    }


def builder(name, monkeypatch):
    """Import a module of ``builders``, which is no package."""
    spec = importlib.util.spec_from_file_location(name, BUILDERS / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(sys.modules, name, module)  # where a dataclass looks for itself
    spec.loader.exec_module(module)
    return module


def test_foreign_engines_and_all_of_ours_are_recorded_in_every_case_that_they_simulate():
    found = recordings()
    theirs = {"MuJoCo", "Bullet", "Drake", "DART", "Chipmunk", "Box2D", *PINS_ONLY}
    assert {recording.engine for recording in found} == OURS | theirs
    assert len([recording for recording in found if recording.engine not in OURS]) == 22
    assert all(
        set(CASES) - set(recording.runs) == ({"disc"} if recording.engine in PINS_ONLY else set())
        for recording in found
    )
    assert all(recording.says for recording in found if recording.engine not in OURS)


def test_orders_of_all_settings_are_as_their_method_says():
    claims = STUDY.measure_theory().claims
    found = {claim.sentence: (claim.measured, claim.budget.total) for claim in claims}
    assert set(verdicts(claims).values()) == {Verdict.AGREES}, found


@pytest.mark.parametrize("case", ["slip", "stick-slip", "whirl", "release"])
def test_only_settings_without_a_cone_have_another_law_for_the_pin(case):
    assert differing(case) == set(BY_AXIS)


def test_bullets_cone_and_chipmunks_have_another_law_for_the_disc():
    assert differing("disc") == {"Bullet, cone", "Chipmunk, pivot joint", *BY_AXIS}


def test_a_stuck_pin_comes_to_turn_with_the_disc_by_every_setting():
    assert not differing("stuck")


def test_our_engines_agree_in_every_case():
    found = recorded_verdicts()
    assert all(set(found[name, ""].values()) == {Verdict.AGREES} for name in OURS)


def test_a_cone_in_place_of_the_box_lets_go_in_time_and_is_found_out(monkeypatch):
    def cone(slip, epsilon):
        return -slip / max(abs(slip), epsilon)

    monkeypatch.setattr(foreign_engines, "box", cone)
    (claim,) = STUDY.measure_theory(only=("holds_longer",)).claims
    assert claim.verdict is Verdict.DIFFERS
    late, _ = claim.measured
    assert abs(late) < claim.budget.total[0]  # the integration finds the root of (7) for Coulomb's own law


@pytest.mark.parametrize("case", [case for case in CASES if case != "stuck"])
def test_another_law_would_show_ten_times_over_the_resolution(case):
    errors = [found.runs[case][-1, ERROR] for found in recordings() if found.name in BY_AXIS]
    assert min(errors) >= 10.0 * CASES[case].resolution


def test_the_pin_of_the_stuck_case_never_slips():
    case = CASES["stuck"]
    pin, (x, *_) = case.system, case.start
    inertia = pin.stiffness - pin.mass * pin.disc_speed**2
    assert x * abs(complex(inertia, pin.damping * pin.disc_speed)) < pin.friction_force  # (7)
    assert case.exact()[0] == x
    assert np.allclose(abs(case.exact()), x, rtol=1e-15)


def test_the_pin_of_the_release_case_sticks_for_a_second_and_a_half():
    case = CASES["release"]
    first, second = simulate(case.system, case.start, case.times, tolerance=1e-10).phases
    assert (first.kind, second.kind) == ("stick", "slip")
    assert first.end == pytest.approx(1.48, abs=0.01)


def test_where_the_cone_lets_go_a_box_still_holds_and_a_pyramid_never_did():
    case = CASES["release"]
    pin, times = case.system, np.linspace(0.0, 4.0, 400001)
    places = complex(*case.start[:2]) * np.exp(1j * pin.disc_speed * times)
    inertia = pin.stiffness - pin.mass * pin.disc_speed**2
    pull = complex(inertia, pin.damping * pin.disc_speed) * places - pin.stiffness * pin.offset  # (7)
    x, y = np.abs(pull.real), np.abs(pull.imag)
    cone, box, pyramid = (
        times[np.argmax(hold > pin.friction_force)] for hold in (np.abs(pull), np.maximum(x, y), x + y)
    )
    assert cone == pytest.approx(1.478, abs=1e-3)
    assert box - cone == pytest.approx(0.17, abs=0.005)
    assert pyramid == 0.0


@pytest.mark.parametrize("case", CASES)
def test_recorded_errors_of_the_reference_are_those_of_a_run_today(case):
    (recording,) = [recording for recording in recordings() if recording.name == "reference"]
    it = CASES[case]
    runs = recording.runs[case]
    tolerance, _, error, *_ = runs[min(2, len(runs) - 1)]
    found = engines(["reference"])[0].simulate(it.system, it.start, it.times, tolerance=tolerance)
    assert np.max(np.abs(it.quantity(found) - it.exact())) == pytest.approx(error, rel=1e-2, abs=1e-16)


# --- ladders that are known


HALVED = 2.0 ** np.arange(4, 10)


def runs_of(found, exact=0.0, steps=HALVED):
    """Return what is recorded of an engine that yields ``found`` at each of ``steps`` per second."""
    rows = np.full((len(steps), len(COLUMNS)), np.nan)
    rows[:, STEPS], rows[:, ERROR] = steps, np.abs(found - exact)
    rows[1:, CHANGE] = np.abs(np.diff(found))
    rows[:, SECONDS] = 1e-3 * steps
    return rows


def recorded_as(runs):
    """Return the claim of the sliding pin from such runs."""
    made = replace(recordings()[0], runs=dict.fromkeys(CASES, runs))
    return recorded_claims(made).claims[0]


@pytest.mark.parametrize("order", [0.5, 1.0, 2.0, 5.0])
def test_an_engine_that_converges_agrees(order):
    runs = runs_of(0.01 * HALVED**-order)
    assert recorded_as(runs).verdict is Verdict.AGREES
    assert estimate(runs) == pytest.approx((4.0**order - 1.0) * runs[-1, ERROR])


def test_an_engine_that_converges_too_slowly_to_tell_shows_nothing():
    runs = runs_of(HALVED**-0.5)
    assert recorded_as(runs).verdict is Verdict.INCONCLUSIVE


def test_an_engine_that_converges_to_something_else_differs():
    claim = recorded_as(runs_of(0.2 + 0.1 / HALVED))
    assert claim.verdict is Verdict.DIFFERS
    assert claim.measured == pytest.approx(0.2, rel=1e-2)


def test_one_run_has_an_error_of_rounding():
    runs = runs_of(np.array([1e-15]), steps=np.array([10.0]))
    assert recorded_as(runs).verdict is Verdict.AGREES
    assert recorded_as(runs_of(np.array([1e-12]), steps=np.array([10.0]))).verdict is Verdict.DIFFERS


def test_time_to_an_error_lies_between_the_runs_by_powers():
    runs = runs_of(1.0 / HALVED)
    assert float(time_to(1.0 / 50.0, runs)) == pytest.approx(50.0)
    assert time_to(1.0, runs) == "≤ 16"
    assert time_to(1e-9, runs) == "not reached"


def test_only_runs_with_halved_steps_give_an_order():
    runs = runs_of(np.ones(6), steps=np.array([3.0, 10.0, 20.0, 40.1, 80.0, 90.0]))
    assert halvings(runs)[:, STEPS].tolist() == [10.0, 20.0, 40.1, 80.0]


def spoilt(change):
    """Return a copy of the recordings in which ``change(error)`` stands for each column of errors."""
    found = []
    for recording in recordings():
        runs = {case: rows.copy() for case, rows in recording.runs.items()}
        for rows in runs.values():
            rows[:, ERROR] = change(rows[:, ERROR])
        found.append(replace(recording, runs=runs))
    return tuple(found)


def test_errors_that_stay_differ_from_first_order(monkeypatch):
    monkeypatch.setattr(theory, "recorded", lambda: spoilt(lambda error: error + 0.3))
    monkeypatch.setattr(theory, "recorded", theory.recorded)
    found = verdicts(STUDY.measure_theory().claims)
    agreeing = {name for name, said in found.items() if said is Verdict.AGREES}
    assert agreeing == {"axes-stay-off", "disc-stays-off", "holds-longer"}
    assert all(set(said.values()) == {Verdict.DIFFERS} for said in recorded_verdicts().values())


def test_errors_that_fall_differ_from_another_law(monkeypatch):
    halving = lambda error: error[0] * 0.5 ** np.arange(len(error))  # noqa: E731
    monkeypatch.setattr(theory, "recorded", lambda: spoilt(halving))
    found = verdicts(STUDY.measure_theory().claims)
    assert found["axes-stay-off"] is found["disc-stays-off"] is Verdict.DIFFERS


def test_creep_other_than_along_tangents_differs(monkeypatch):
    monkeypatch.setattr(theory, "recorded", lambda: spoilt(lambda error: 1.01 * error))
    assert verdicts(STUDY.measure_theory().claims)["creeps"] is Verdict.DIFFERS


# --- files, figures, page


def test_columns_of_a_file_that_are_others_are_refused(tmp_path, monkeypatch):
    (tmp_path / "odd.json").write_text(json.dumps({"columns": ["tolerance"]}), encoding="utf-8")
    monkeypatch.setattr(compare.foreign, "FOLDER", tmp_path)
    with pytest.raises(ValueError, match=r"odd.json: columns = \['tolerance'\]: they must be"):
        recordings()


def test_figures_show_every_recording():
    with paper_style():
        figures = STUDY.draw({"theory": STUDY.measure_theory().data})
        assert STUDY.draw({}) == {}
    assert set(figures) == set(STUDY.figures)
    for name, figure in figures.items():
        (legend,) = figure.legends
        shown = {text.get_text().strip() for text in legend.get_texts()} - {""}
        pins_only = PINS_ONLY if name == "foreign-engines-disc" else set()
        assert shown == {found.name for found in recordings() if found.engine not in pins_only}


def test_tables_stand_on_the_page(tmp_path):
    assert STUDY in STUDIES
    undrawn = replace(STUDY, provided={"tables": STUDY.provided["tables"]})
    write_report(run((undrawn,), (), folder=tmp_path), tmp_path)
    page = (tmp_path / "index.html").read_text(encoding="utf-8")
    assert page.count('class="evidence words"') == 3
    assert all(name in page for name in FIRST_ORDER)


# --- what the adapters share, without any of the engines


@pytest.fixture
def common():
    return setting


@pytest.fixture
def record(monkeypatch):
    return builder("record", monkeypatch)


def euler(common):
    """Return an engine of semi-implicit Euler steps with our law, built as the foreign ones are."""

    class Euler(common.Model):
        engine = "Euler"

        def __init__(self, system, state, _):
            self.system, self.state, self.arms = system, state.copy(), common.contact_arms("Euler", system)

        def advance(self, h, number):
            system, half = self.system, len(self.state) // 2
            self.epsilon = h * common.mobility(system) * system.friction_force
            inertia = [system.mass, system.mass, common.inertia_of(system)][:half]
            for _ in range(number):
                q, v = np.split(self.state, 2)
                force = np.array(common.our_friction(system, self.arms, self.state.tolist(), self.epsilon))
                force[:2] -= system.stiffness * (q[:2] - (system.offset, 0.0)) + system.damping * v[:2]
                if half > 2:
                    force[2] += system.shaft_damping * (system.shaft_speed - v[2])
                v = v + h * force / inertia
                self.state = np.concatenate((q + h * v, v))
            self.steps += number
            return self.state

    return common.Setting("our force", "by Euler steps", Euler)


@pytest.mark.parametrize("case", ["slip", "disc"])
def test_our_law_by_the_builders_steps_is_of_first_order(common, case):
    it = CASES[case]
    times = it.times[:11]
    errors = [
        np.max(np.abs(it.quantity(euler(common)(it.system, it.start, times, tolerance=t)) - it.exact()[:11]))
        for t in (8e-4, 1e-4)
    ]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(1.0, abs=0.1)


def test_a_ring_too_many_points_and_a_support_that_hardens_are_refused(common):
    engine = euler(common)
    for disc, sentence in (
        (FIG11, "Euler does not simulate a disc on a continuous ring"),
        (replace(FIG11, contact_points=3, hardening=1.0), "Euler does not simulate a nonlinear support"),
    ):
        with pytest.raises(UnsupportedSystemError, match=sentence):
            engine(disc, np.zeros(6), [0.0, 1.0])
    with pytest.raises(UnsupportedSystemError, match=r"contact_points = 7: Euler .* on more than 6"):
        common.contact_arms("Euler", replace(FIG11, contact_points=7), 6)


def test_a_ladder_has_no_run_that_is_no_better_than_the_one_before(record, common):
    known = {}

    def clamped(system, start, times, *, tolerance):
        asked = len(times), max(tolerance, 1e-3)
        if asked not in known:
            known[asked] = euler(common)(system, start, times, tolerance=asked[1])
        return known[asked]

    rows = record.ladder(clamped, CASES["disc"])
    assert len(rows) == 3  # at 1e-2, 1.25e-3, and 1.56e-4 in whose place is 1e-3
    assert rows[0][CHANGE] is None
    assert rows[1][CHANGE] > 0.0


def test_an_engine_that_is_not_installed_is_skipped_with_a_message(record, monkeypatch, capsys, tmp_path):
    monkeypatch.setitem(sys.modules, "pydrake.geometry", None)
    monkeypatch.delitem(sys.modules, "compare.engines.live.drake_engine", raising=False)
    monkeypatch.setattr(record, "FOLDER", tmp_path)
    monkeypatch.setattr(sys, "argv", ["record.py", "drake"])
    record.main()
    said = capsys.readouterr().err
    assert "drake skipped: engine 'drake': Drake is not installed" in said
    assert "pip install drake" in said
    assert "none for Windows" in said
    assert not list(tmp_path.iterdir())


def test_rows_of_numbers_stand_on_a_line_each(record):
    text = record.written({"a": ["x"], "rows": [[1.0, None, 2.5], [3.0, 4.0, 5.0]]})
    assert "[1.0, null, 2.5]" in text
    assert json.loads(text) == {"a": ["x"], "rows": [[1.0, None, 2.5], [3.0, 4.0, 5.0]]}
