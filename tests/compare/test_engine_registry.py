import pickle
import sys
from dataclasses import replace

import fake_studies
import pytest

from compare.engines import EVERY_KIND, Engine, UnsupportedSystemError, engines, known, register
from compare.paper import FIG5, FIG11
from compare.studies import studies


def test_the_two_engines_of_the_project_are_registered():
    assert [engine.name for engine in engines()][:2] == ["reference", "exudyn"]


@pytest.mark.parametrize(
    ("name", "hint"),
    [("exudin", "did you mean 'exudyn'?"), ("zzz", "known are reference, exudyn")],
)
def test_an_unknown_engine_is_answered_with_the_nearest(name, hint):
    with pytest.raises(ValueError, match="unknown engine") as error:
        engines([name])
    assert hint in str(error.value)


@pytest.mark.parametrize("name", ["reference", "theory"])
def test_a_name_is_not_taken_twice(name):
    with pytest.raises(ValueError, match="the name is taken"):
        register(Engine(name, fake_studies.straight))


def test_an_engine_of_ones_own_is_named_by_module_and_function(tmp_path, monkeypatch):
    (tmp_path / "solver_of_mine.py").write_text(
        "def simulate(system, state, times, *, tolerance=1e-9): return 42\n"
    )
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", list(sys.path))
    (engine,) = engines(["solver_of_mine:simulate"])
    assert engine.name == "solver_of_mine:simulate"
    assert engine.simulate(FIG5, None, None) == 42
    assert engine.kinds == ("pin",)


@pytest.mark.parametrize(
    "name", ["no_such_module:simulate", "math:no_such_function", ":simulate", "math:pi", ".:simulate"]
)
def test_an_engine_that_is_none_is_refused_in_a_sentence(name):
    with pytest.raises(ValueError, match=f"^engine '{name}' "):
        engines([name])


@pytest.mark.parametrize(
    ("code", "reason"), [("1 / 0", "ZeroDivisionError: division by zero"), ("def (", "SyntaxError: ")]
)
def test_an_engine_whose_module_fails_is_refused_in_a_sentence(code, reason, tmp_path, monkeypatch):
    (tmp_path / "broken_module.py").write_text(code)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", list(sys.path))
    with pytest.raises(ValueError, match=f"^engine 'broken_module:simulate' can't be imported: {reason}"):
        engines(["broken_module:simulate"])


POINTS, RING = replace(FIG11, contact_points=6), FIG11


@pytest.mark.parametrize(
    ("kinds", "lacking"),
    [
        (("pin",), "mine does not simulate a disc on a continuous ring or a disc on single points"),
        (("pin", "points"), "mine does not simulate a disc on a continuous ring"),
        (("points", "ring"), "mine does not simulate a pin"),
        (EVERY_KIND, ""),
    ],
)
def test_an_engine_simulates_what_it_promises_and_says_what_it_lacks(kinds, lacking):
    engine = Engine("mine", fake_studies.straight, kinds)
    systems = {"pin": FIG5, "ring": RING, "points": POINTS}
    assert engine.lacking([*systems.values(), RING]) == lacking
    for kind, system in systems.items():
        state = [0.0] * system.state_size
        assert engine.simulates(system) == (kind in kinds)
        if kind in kinds:
            assert engine.simulate(system, state, [0.0, 1.0], tolerance=1e-3).solution.tolerance == 1e-3
        else:
            with pytest.raises(UnsupportedSystemError, match=r"^mine does not simulate a "):
                engine.simulate(system, state, [0.0, 1.0])


def test_an_engine_goes_to_other_processes_with_its_promise():
    engine = Engine("mine", fake_studies.straight, ("points",))
    simulate = pickle.loads(pickle.dumps(engine)).simulate
    with pytest.raises(UnsupportedSystemError):
        simulate(RING, [0.0] * 6, [0.0, 1.0])
    assert simulate(POINTS, [0.0] * 6, [0.0, 1.0]).system == POINTS


@pytest.mark.parametrize(
    ("kinds", "expected"), [('("pin", "ring")', ("pin", "ring")), ('["points"]', ("points",)), ("()", ())]
)
def test_a_function_of_ones_own_says_what_it_is_for(kinds, expected, tmp_path, monkeypatch):
    (tmp_path / "promising.py").write_text(f"def simulate(): pass\nsimulate.kinds = {kinds}\n")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", list(sys.path))
    monkeypatch.delitem(sys.modules, "promising", raising=False)
    (engine,) = engines(["promising:simulate"])
    assert engine.kinds == expected


@pytest.mark.parametrize(
    ("kinds", "hint"), [('("rings",)', "did you mean 'ring'"), ('"ring"', "'r'"), ("7", "not iterable")]
)
def test_a_promise_of_what_there_is_not_is_refused(kinds, hint, tmp_path, monkeypatch):
    (tmp_path / "overpromising.py").write_text(f"def simulate(): pass\nsimulate.kinds = {kinds}\n")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", list(sys.path))
    monkeypatch.delitem(sys.modules, "overpromising", raising=False)
    with pytest.raises(ValueError, match=r"^engine 'overpromising:simulate', attribute kinds = ") as error:
        engines(["overpromising:simulate"])
    assert hint in str(error.value)


def test_studies_come_in_report_order_whatever_the_order_of_their_names():
    among = fake_studies.ALL
    assert [study.name for study in studies(["agreement", "verdicts"], among)] == ["verdicts", "agreement"]
    assert studies([], among) == among
    assert known("study", "verdicts", [study.name for study in among]) == "verdicts"
    with pytest.raises(ValueError, match="unknown study 'verdict': did you mean 'verdicts'"):
        studies(["verdict"], among)
