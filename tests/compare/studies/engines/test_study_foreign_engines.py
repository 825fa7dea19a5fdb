import importlib.util
import json
import sys
from dataclasses import replace

import numpy as np
import pytest
from processes import ROOT
from scipy.integrate import solve_ivp

import compare.foreign
from compare.claims.claim import Verdict
from compare.claims.parameters import FIG11
from compare.diagnosis.causes.patch import law_of
from compare.diagnosis.run import row_of
from compare.engines import Engine, UnsupportedSystemError, engines
from compare.engines.live import setting
from compare.foreign import CASES, CHANGE, COLUMNS, ERROR, SECONDS, STEPS, estimate, recordings
from compare.output.figures import paper_style
from compare.report.write import write_report
from compare.run.runner import run
from compare.studies.engines.foreign_engines import study as foreign_engines
from compare.studies.engines.foreign_engines import theory
from compare.studies.engines.foreign_engines.study import STUDY
from compare.studies.engines.foreign_engines.theory import (
    BY_AXIS,
    recorded_claims,
    recorded_settings,
    time_to,
)
from reference_model import plain

OURS = {"reference", "exudyn", "exudyn-native"}
NAMES = {case.sentence: name for name, case in CASES.items()}
SEPARATE = (
    *("Bullet, spinning friction", "Chipmunk, pivot and gear joint", "Box2D, friction joint with torque"),
    *("Rapier, box", "Jolt, box"),
)
PINS_ONLY = {"Rapier", "Jolt", "PhysX", "Havok", "cannon-es", "planck"}


def verdicts(claims):
    """Return the verdict of each claim by the name of its function."""
    return {claim.identity.partition("/")[2]: claim.verdict for claim in claims}


def recorded_verdicts():
    """Return the verdict of each case by (engine, setting)."""
    return {
        (found.engine, found.setting): {NAMES[claim.sentence]: claim.verdict for claim in found.claims}
        for found in recorded_settings()
    }


def test_the_recordings_contain_every_engine_in_every_case_that_it_simulates():
    found = recordings()
    theirs = {"MuJoCo", "Bullet", "Drake", "DART", "Chipmunk", "Box2D", "ODE", *PINS_ONLY}
    assert {recording.engine for recording in found} == OURS | theirs
    assert len([recording for recording in found if recording.engine not in OURS]) == 52
    assert all(
        set(CASES) - set(recording.runs) == ({"disc"} if recording.engine in PINS_ONLY else set())
        for recording in theory.recorded()
    )
    assert all(recording.says for recording in found if recording.engine not in OURS)


CREEPING = {"MuJoCo, as shipped", "MuJoCo, cone=elliptic alone"}
"""Settings whose contact is soft."""

ALWAYS = {*BY_AXIS, "Bullet, as shipped", "DART, as shipped"}
PINS = ALWAYS | {"MuJoCo, as shipped", "PhysX, as shipped", "Jolt, as shipped", "cannon-es, contact"}
SLIDES = PINS | {"MuJoCo, cone=elliptic alone", "cannon-es, as shipped"}
STICKS = SLIDES | {"Havok, contact", "Havok, as shipped"}

DIFFERING = {
    "slip": SLIDES,
    "stick-slip": STICKS,
    "whirl": PINS,
    "release": STICKS,
    "disc": ALWAYS
    | {"Bullet, cone", "Chipmunk, pivot joint", "Chipmunk, as shipped"}
    | {"Box2D, friction joint", "Box2D, as shipped", "MuJoCo, cone=elliptic alone"},
    "stuck": CREEPING | {"Bullet, as shipped", "PhysX, contact", "PhysX, as shipped"},
}


@pytest.mark.parametrize("case", CASES)
def test_settings_without_a_cone_have_another_friction_law(case):
    found = recorded_verdicts()
    assert {
        f"{engine}, {setting}" if setting else engine
        for (engine, setting), said in found.items()
        if said.get(case) is Verdict.DIFFERS
    } == DIFFERING[case]
    assert all(found[name, ""][case] is Verdict.AGREES for name in OURS)


def test_the_claim_about_the_box_fails_if_the_box_is_a_cone(monkeypatch):
    def cone(slip, epsilon):
        return -slip / max(abs(slip), epsilon)

    monkeypatch.setattr(theory, "box", cone)
    (claim,) = STUDY.measure_theory(only=("holds_longer",)).claims
    assert claim.verdict is Verdict.DIFFERS
    late, _ = claim.measured
    assert abs(late) < claim.budget.total[0]  # the integration finds the root of (7) for Coulomb's own law


@pytest.mark.parametrize("case", CASES)
def test_the_recorded_errors_of_the_reference_are_reproduced(case):
    (recording,) = [recording for recording in recordings() if recording.name == "reference"]
    it = CASES[case]
    runs = recording.runs[case]
    tolerance, _, error, *_ = runs[min(2, len(runs) - 1)]
    found = engines(["reference"])[0].simulate(it.system, it.start, it.times, tolerance=tolerance)
    assert np.max(np.abs(it.quantity(found) - it.exact())) == pytest.approx(error, rel=1e-2, abs=1e-16)


# ---------------------------------------------------------------- runs with known convergence


HALVED = 2.0 ** np.arange(4, 10)


def runs_of(found, exact=0.0, steps=HALVED):
    """Return the recorded rows of an engine that yields ``found`` at each of ``steps`` per second."""
    rows = np.full((len(steps), len(COLUMNS)), np.nan)
    rows[:, STEPS], rows[:, ERROR] = steps, np.abs(found - exact)
    rows[1:, CHANGE] = np.abs(np.diff(found))
    rows[:, SECONDS] = 1e-3 * steps
    return rows


def recorded_as(runs):
    """Return the claim about the sliding pin of an engine with these runs."""
    made = replace(recordings()[0], runs=dict.fromkeys(CASES, runs))
    return recorded_claims(made).claims[0]


@pytest.mark.parametrize("order", [0.5, 1.0, 2.0, 5.0])
def test_convergence_to_the_exact_value_agrees(order):
    runs = runs_of(0.01 * HALVED**-order)
    assert recorded_as(runs).verdict is Verdict.AGREES
    assert estimate(runs) == pytest.approx(2.0 * runs[-1, ERROR])


@pytest.mark.parametrize("last", [1.03, 1.35, 8.0])
def test_steps_that_are_not_halved_enter_the_estimate(last):
    """As of an engine with a smallest step, or with a tolerance."""
    steps = 64.0 * np.append(2.0 ** np.arange(4), 8.0 * last)
    runs = runs_of(0.01 / steps, steps=steps)
    assert estimate(runs) == pytest.approx(2.0 * runs[-1, ERROR])


@pytest.mark.parametrize(
    ("name", "case", "verdict"),
    [
        ("Rapier, as shipped", "stick-slip", Verdict.INCONCLUSIVE),  # order 0.5
        ("Chipmunk, as shipped", "disc", Verdict.DIFFERS),  # tends to 0.6 mm
        ("Drake, cenic", "stuck", Verdict.AGREES),  # three times as many steps in each run
    ],
)
def test_recordings_with_unequal_ratios_of_steps_have_the_right_verdict(name, case, verdict):
    (recording,) = (one for one in recordings() if one.name == name)
    (claim,) = (one for one in recorded_claims(recording).claims if one.sentence == CASES[case].sentence)
    assert claim.verdict is verdict
    assert row_of(recording).motions[case].converges == (verdict is not Verdict.DIFFERS)


@pytest.mark.parametrize(
    ("found", "verdict"),
    [
        (HALVED**-0.5, Verdict.INCONCLUSIVE),
        (0.2 + 0.1 / HALVED, Verdict.DIFFERS),
        (np.array([1e-15]), Verdict.AGREES),  # a single run is judged by its rounding error
        (np.array([3e-3]), Verdict.DIFFERS),
    ],
)
def test_slow_convergence_is_open_and_another_value_differs(found, verdict):
    claim = recorded_as(runs_of(found, steps=HALVED[: len(found)]))
    assert claim.verdict is verdict
    assert claim.measured == found[-1]


def test_the_time_to_an_error_is_interpolated_by_powers():
    runs = runs_of(1.0 / HALVED)
    assert float(time_to(1.0 / 50.0, runs)) == pytest.approx(50.0)
    assert time_to(1.0, runs) == "≤ 16"
    assert time_to(1e-9, runs) == "not reached"


@pytest.mark.parametrize("finest", [0.0, 2e-3])
def test_fixed_steps_are_halved_down_to_the_smallest(record, finest):
    engine = Engine("stepped", lambda *motion, step: None, step=2e-3)
    wanted = record.accuracies(record.Setting(engine, engine.function, "", finest), CASES["release"])
    turns = 1.5 * np.array([accuracy["step"] for accuracy in wanted])
    assert turns[:-1] / turns[1:] == pytest.approx(2.0, rel=1e-12)
    assert (2e-3 <= turns[-1] < 3e-3) if finest else turns[-1] < 1e-4


def test_recorded_steps_are_halved():
    for recording in recordings():
        for case, runs in recording.runs.items():
            if recording.step is not None:
                ratios = runs[1:, STEPS] / runs[:-1, STEPS]
                assert ratios == pytest.approx(2.0, rel=1e-3), f"{recording.name}, {case}"  # four digits


def spoilt(change):
    """Return the recordings with ``change`` applied to their errors."""
    found = []
    for recording in filter(lambda one: one.runs, recordings()):
        runs = {case: rows.copy() for case, rows in recording.runs.items()}
        for rows in runs.values():
            rows[:, ERROR] = change(rows[:, ERROR])
        found.append(replace(recording, runs=runs))
    return tuple(found)


def test_all_cases_and_orders_differ_if_errors_do_not_fall(monkeypatch):
    monkeypatch.setattr(theory, "recorded", lambda: spoilt(lambda error: error + 0.3))
    found = verdicts(STUDY.measure_theory().claims)
    agreeing = {name for name, said in found.items() if said is Verdict.AGREES}
    assert agreeing == {"axes-stay-off", "disc-stays-off", "holds-longer"}
    assert all(set(said.values()) == {Verdict.DIFFERS} for said in recorded_verdicts().values())


@pytest.mark.parametrize(
    ("change", "functions"),
    [
        (lambda error: error[0] * 0.5 ** np.arange(len(error)), ("axes_stay_off", "disc_stays_off")),
        (lambda error: 1.01 * error, ("creeps",)),
    ],
)
def test_claims_about_another_law_differ_if_errors_are_others(change, functions, monkeypatch):
    monkeypatch.setattr(theory, "recorded", lambda: spoilt(change))
    assert {claim.verdict for claim in STUDY.measure_theory(only=functions).claims} == {Verdict.DIFFERS}


def test_errors_due_to_another_law_are_extrapolated_to_a_step_of_zero():
    """Three halves of the last recorded digit remain; the smallest step alone would add 6e-5 m."""
    found = foreign_engines._as_far_off_as(theory.pyramid, "whirl", theory.PYRAMIDS)
    assert np.abs(found.value - found.predicted).max() < 1.5e-5


@pytest.mark.parametrize(
    ("law", "wanted", "off"), [(theory.box, theory.BOXES, 0.2403), (theory.pyramid, theory.PYRAMIDS, 0.0937)]
)
def test_a_whirl_under_another_law_is_read_after_it_has_settled(law, wanted, off):
    """Over a whole revolution after 300 s, by another integrator; the recorded window gives 0.2374 and 0.0925 m."""
    pin = CASES["whirl"].system

    def friction(slip_x, slip_y, *_):
        force = pin.friction_force * law(complex(slip_x, slip_y), 1e-3)
        return force.real, force.imag, 0.0

    times = 300.0 + np.linspace(0.0, 2.0 * np.pi, 201)
    run = solve_ivp(
        lambda _, state: plain.rates(pin, friction, state), (0.0, times[-1]), CASES["whirl"].start,
        method="RK45", rtol=1e-6, atol=1e-8, max_step=0.02, t_eval=times,
    )  # fmt: skip
    expected = abs(np.mean(np.hypot(*run.y[:2, :-1])) - abs(CASES["whirl"].exact()[0]))
    found = foreign_engines._as_far_off_as(law, "whirl", wanted)
    assert expected == pytest.approx(off, abs=3e-4)
    assert np.asarray(found.predicted) == pytest.approx(off, abs=1e-4)
    assert np.asarray(found.value) == pytest.approx(off, abs=2e-4)


# ---------------------------------------------------------------- files, figures, page


@pytest.fixture(scope="module")
def laws_of_spin():
    return dict(theory.tables()[2].rows)


@pytest.mark.parametrize(
    ("name", "law"),
    [
        ("MuJoCo, elliptic cone", "is right to 0.051 % of μN"),
        ("MuJoCo, condim 4", "has the friction of an ellipsoid with the limits μN and 1·μNR"),
        ("MuJoCo, condim 4, as shipped", "has friction against the larger of slide and spin only, a pyramid"),
        ("Bullet, cone", "has friction along the impulse that would stop each of 6 points by axis"),
        ("Chipmunk, pivot joint", "has friction along the impulse that would stop each of 6 points alone"),
        ("Box2D, friction joint", "has friction along the impulse that would stop each of 6 points alone"),
        *((name, "has separate limits for slide and spin, μN and 1·μNR") for name in SEPARATE),
        ("Drake, hydroelastic", "has the friction of a ring of 0.667 times the radius"),
    ],
)
def test_the_law_of_slide_and_spin_of_each_engine_has_a_name(name, law, laws_of_spin):
    said = laws_of_spin[name]
    assert said.startswith(f"a disc that slides and spins {law}")


def test_a_disc_whose_friction_is_uncertain_is_not_called_right():
    (patch,) = (row_of(one).patch for one in recordings() if one.name == "MuJoCo, as shipped")
    assert law_of(patch, 1.0)[0].startswith("a disc that slides and spins is known only to 19 % of μN")


def test_a_recording_with_unknown_columns_is_rejected(tmp_path, monkeypatch):
    (tmp_path / "odd.json").write_text(json.dumps({"columns": ["tolerance"]}), encoding="utf-8")
    monkeypatch.setattr(compare.foreign, "FOLDER", tmp_path)
    with pytest.raises(ValueError, match=r"odd.json: columns = \['tolerance'\]: they must be"):
        recordings()


def test_figures_show_every_recording():
    with paper_style():
        figures = STUDY.draw({"theory": foreign_engines.curves()})
        assert STUDY.draw({}) == {}
    assert set(figures) == set(STUDY.figures)
    for name, figure in figures.items():
        shown = {line.get_label() for panel in figure.axes for line in panel.get_lines()}
        hidden = OURS | (PINS_ONLY if name == "foreign-engines-disc" else set())
        wanted = {found.name for found in theory.recorded() if found.engine not in hidden}
        assert {label for label in shown if not label.startswith("_")} == wanted
        said = {text.get_text() for panel in figure.axes for text in panel.texts}
        assert {"as shipped", "reference", "elliptic cone", "lagged (as shipped)"} <= said


def test_the_page_contains_the_tables(tmp_path):
    undrawn = replace(STUDY, declared=[], provided={"tables": STUDY.provided["tables"]})
    write_report(run((undrawn,), (), folder=tmp_path), tmp_path)
    page = (tmp_path / "index.html").read_text(encoding="utf-8")
    assert page.count('class="evidence words"') == 4
    assert all(recording.name in page for recording in recordings())


# ---------------------------------------------------------------- shared code of the adapters


@pytest.fixture
def record(monkeypatch):
    """Import ``builders/record.py``, which is not in a package."""
    spec = importlib.util.spec_from_file_location("record", ROOT / "builders" / "record.py")
    module = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(sys.modules, "record", module)  # its dataclasses look for their module there
    spec.loader.exec_module(module)
    return module


def euler():
    """Return an engine of semi-implicit Euler steps with our friction law, built like the foreign engines."""

    class Euler(setting.Model):
        engine = "Euler"

        def __init__(self, system, state, _):
            self.system, self.state, self.arms = system, state.copy(), setting.contact_arms("Euler", system)

        def advance(self, h, number):
            system, half = self.system, len(self.state) // 2
            self.epsilon = h * setting.mobility(system) * system.friction_force
            inertia = [system.mass, system.mass, setting.inertia_of(system)][:half]
            for _ in range(number):
                q, v = np.split(self.state, 2)
                force = np.array(setting.our_friction(system, self.arms, self.state.tolist(), self.epsilon))
                force[:2] -= system.stiffness * (q[:2] - (system.offset, 0.0)) + system.damping * v[:2]
                if half > 2:
                    force[2] += system.shaft_damping * (system.shaft_speed - v[2])
                v = v + h * force / inertia
                self.state = np.concatenate((q + h * v, v))
            return self.state

    return setting.Setting("our force", "by Euler steps", Euler)


@pytest.mark.parametrize("case", ["slip", "disc"])
def test_euler_steps_with_our_friction_law_converge_with_order_one(case):
    it = CASES[case]
    times = it.times[:11]
    errors = [
        np.max(np.abs(it.quantity(euler()(it.system, it.start, times, tolerance=t)) - it.exact()[:11]))
        for t in (8e-4, 1e-4)
    ]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(1.0, abs=0.1)


def test_systems_beyond_an_adapter_are_unsupported():
    engine = euler()
    for disc, sentence in (
        (FIG11, "Euler does not simulate a disc on a continuous ring"),
        (replace(FIG11, contact_points=3, hardening=1.0), "Euler does not simulate a nonlinear support"),
    ):
        with pytest.raises(UnsupportedSystemError, match=sentence):
            engine(disc, np.zeros(6), [0.0, 1.0])
    with pytest.raises(UnsupportedSystemError, match=r"contact_points = 7: Euler .* on more than 6"):
        setting.contact_arms("Euler", replace(FIG11, contact_points=7), 6)


def test_a_ladder_ends_at_the_smallest_step(record):
    known = {}

    def clamped(system, start, times, *, tolerance):
        asked = len(times), max(tolerance, 1e-3)
        if asked not in known:
            known[asked] = euler()(system, start, times, tolerance=asked[1])
        return known[asked]

    rows = record.ladder(record.Setting(Engine("clamped", clamped), clamped), CASES["disc"])
    assert len(rows) == 3  # at 1e-2, 1.25e-3 and 1e-3, which replaces 1.56e-4
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
