import sys

import fake_studies
import pytest

from compare.engines import Engine, engines, known, register
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
    assert engine.simulate(None, None, None) == 42


@pytest.mark.parametrize("name", ["no_such_module:simulate", "math:no_such_function", ":simulate", "math:pi"])
def test_an_engine_that_is_none_is_refused_in_a_sentence(name):
    with pytest.raises(ValueError, match=f"^engine '{name}' "):
        engines([name])


def test_studies_come_in_report_order_whatever_the_order_of_their_names():
    among = fake_studies.ALL
    assert [study.name for study in studies(["agreement", "verdicts"], among)] == ["verdicts", "agreement"]
    assert studies([], among) == among
    assert known("study", "verdicts", [study.name for study in among]) == "verdicts"
    with pytest.raises(ValueError, match="unknown study 'verdict': did you mean 'verdicts'"):
        studies(["verdict"], among)
