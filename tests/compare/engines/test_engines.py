import math
import pickle
import sys
from dataclasses import replace

import fake_studies
import numpy as np
import pytest

from compare.claims.error_estimates import refined
from compare.claims.parameters import FIG5, FIG11
from compare.engines import (
    EVERY_KIND,
    BadTrajectoryError,
    Engine,
    UnsupportedSystemError,
    engines,
    one_of,
    register,
)
from compare.studies import studies
from reference_model.trajectory import Phase, Solution, Trajectory


def test_the_two_engines_of_the_project_are_registered():
    assert [engine.name for engine in engines()][:2] == ["reference", "exudyn"]


def test_compiled_runs_take_part_only_where_they_are_named():
    assert "compiled" not in [engine.name for engine in engines()]
    (compiled,) = engines(["compiled"])
    found = compiled.simulate(FIG5, [0.1, 0.0, 0.03, 0.0], [0.0, 5.0])
    assert found.solution.method.startswith("compiled")
    plain = engines(["reference"])[0].simulate(FIG5, [0.1, 0.0, 0.03, 0.0], [0.0, 5.0])
    np.testing.assert_allclose(found.at_end, plain.at_end, atol=1e-8)


def test_the_plain_equations_take_part_only_where_they_are_named_and_tell_no_stick():
    assert "plain" not in [engine.name for engine in engines()]
    (plain,) = engines(["plain"])
    found = plain.simulate(FIG11, [0.1, 0.0, 0.0, 0.03, 0.0, 1.0], [0.0, 2.0], tolerance=1e-6)
    assert found.solution.method == "Radau"
    with pytest.raises(UnsupportedSystemError, match="plain does not simulate stick"):
        plain.simulate(replace(FIG5, friction_force=0.2), [0.0] * 4, [0.0, 1.0])


def test_an_engine_of_linear_supports_says_so_of_each_system():
    (compiled,) = engines(["compiled"])
    hard = replace(FIG5, hardening=2.0), replace(FIG5, stop_stiffness=1.0)
    assert [compiled.simulates(system) for system in (FIG5, FIG11, *hard)] == [True, True, False, False]
    assert compiled.lacking([FIG5, *hard]) == "compiled does not simulate a pin on a nonlinear support"
    with pytest.raises(UnsupportedSystemError, match="nonlinear support"):
        compiled.simulate(hard[0], [0.1, 0.0, 0.0, 0.0], [0.0, 1.0])
    pins_only = Engine("mine", fake_studies.straight, nonlinear=False)
    assert pins_only.lacking([FIG11]) == "mine does not simulate a disc on a continuous ring"


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
    assert engine.function(FIG5, None, None) == 42
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
BLOCK = replace(FIG5, disc_speed=0.0)


@pytest.mark.parametrize(
    ("kinds", "lacking"),
    [
        (("pin", "block"), "mine does not simulate a disc on a continuous ring or a disc on single points"),
        (("pin", "block", "points"), "mine does not simulate a disc on a continuous ring"),
        (("points", "ring"), "mine does not simulate a pin or a block on a plane at rest"),
        (("block", "points", "ring"), "mine does not simulate a pin"),
        (EVERY_KIND, ""),
    ],
)
def test_an_engine_simulates_what_it_promises_and_says_what_it_lacks(kinds, lacking):
    engine = Engine("mine", fake_studies.straight, kinds)
    systems = {"pin": FIG5, "block": BLOCK, "ring": RING, "points": POINTS}
    assert engine.lacking([*systems.values(), RING]) == lacking
    for kind, system in systems.items():
        state = [0.0] * system.state_size
        assert engine.simulates(system) == (kind in kinds)
        if kind in kinds:
            assert engine.simulate(system, state, [0.0, 1.0], tolerance=1e-3).solution.tolerance == 1e-3
        else:
            with pytest.raises(UnsupportedSystemError, match=r"^mine does not simulate a "):
                engine.simulate(system, state, [0.0, 1.0])


def test_who_simulates_pins_simulates_blocks_on_a_plane_at_rest_too():
    pins, blocks = (
        Engine("mine", fake_studies.straight, (kind,), nonlinear=False) for kind in ("pin", "block")
    )
    hard = replace(BLOCK, hardening=2.0)
    assert [pins.simulates(one) for one in (FIG5, BLOCK, hard)] == [True, True, False]
    assert [blocks.simulates(one) for one in (FIG5, BLOCK, hard)] == [False, True, False]
    sentence = "mine does not simulate a block on a plane at rest on a nonlinear support"
    assert pins.lacking([hard]) == blocks.lacking([hard]) == sentence


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


@pytest.mark.parametrize(
    ("declaration", "sentence"),
    [
        ("sticks = 'no'", "sticks = 'no': it must be True or False"),
        ("nonlinear = 1", "nonlinear = 1: it must be True or False"),
        ("step = 0.0", "step = 0 s: it must be at least 1e-09 s"),
        ("step = 1e-300", "step = 1e-300 s: it must be at least 1e-09 s"),
        ("step = 'small'", "step = 'small': it must be a number"),
    ],
)
def test_a_declaration_that_says_nothing_is_refused(declaration, sentence, tmp_path, monkeypatch):
    (tmp_path / "declaring.py").write_text(f"def simulate(): pass\nsimulate.{declaration}\n")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", list(sys.path))
    monkeypatch.delitem(sys.modules, "declaring", raising=False)
    with pytest.raises(ValueError, match=r"^engine 'declaring:simulate', attribute ") as error:
        engines(["declaring:simulate"])
    assert sentence in str(error.value)


def test_an_engine_of_an_installed_package_is_known_by_its_entry_point(tmp_path, monkeypatch):
    package = tmp_path / "installed_solver-1.0.dist-info"
    package.mkdir()
    (package / "METADATA").write_text("Metadata-Version: 2.1\nName: installed-solver\nVersion: 1.0\n")
    (package / "entry_points.txt").write_text(
        "[friction_discs.engines]\nsolver = installed_solver:simulate\n"
    )
    (tmp_path / "installed_solver.py").write_text("def simulate(): pass\nsimulate.kinds = ['ring']\n")
    monkeypatch.syspath_prepend(tmp_path)
    (engine,) = engines(["solver"])
    assert (engine.name, engine.kinds) == ("solver", ("ring",))
    assert "solver" not in [engine.name for engine in engines()]  # only where it is asked for
    with pytest.raises(ValueError, match="did you mean 'solver'"):
        engines(["sovler"])


TIMES = np.linspace(0.0, 1.0, 5)


def resting(system, state, times, **accuracy):
    states = np.tile(np.asarray(state, dtype=float), (len(times), 1))
    return Trajectory(system, np.array(times), states, (), Solution("none", 0.0, 0, 0, 0.0))


def changed(**changes):
    """Return an engine whose trajectory is right but for ``changes``."""
    return Engine("mine", lambda *motion, **accuracy: replace(resting(*motion), **changes))


def phases(*spans):
    return tuple(Phase("slip", start, end, REST) for start, end in spans)


REST = np.zeros(4)
NO_NUMBERS = "must have finite times and 4 finite numbers as its initial_state"
IN_ORDER = "phases must follow each other between 0 and 1 s"
BROKEN_STATES = np.zeros((5, 4))
BROKEN_STATES[3, 2] = np.inf


@pytest.mark.parametrize(
    ("engine", "sentence"),
    [
        (changed(times=TIMES[:-1]), "the trajectory's times have shape (4,): (5,) were asked for"),
        (changed(times=TIMES + 1e-9), "the trajectory's times[0] = 1e-09 s: 0.0 s was asked for"),
        (changed(times=TIMES * np.nan), "the trajectory's times[0] = nan s: 0.0 s was asked for"),
        (
            changed(states=np.zeros((5, 6))),
            "the trajectory's states have shape (5, 6): they must have (5, 4)",
        ),
        (changed(states=BROKEN_STATES), "the state at t = 0.75 s is not finite: [0.0, 0.0, inf, 0.0]"),
        (
            changed(states=np.full((5, 4), "1")),
            "the trajectory's states are of the type <U1: they must be real numbers",
        ),
        (
            changed(states=np.full((5, 4), True)),
            "the trajectory's states are of the type bool: they must be real numbers",
        ),
        (
            changed(times=TIMES + 0j),
            "the trajectory's times are of the type complex128: they must be real numbers",
        ),
        (
            changed(phases=(Phase("glide", 0.0, 1.0, REST),)),
            "phases[0] is 'glide': it must be a Phase of a kind in ('slip', 'pivot', 'stick')",
        ),
        (
            changed(phases=("slip",)),
            "phases[0] is 'slip': it must be a Phase of a kind in ('slip', 'pivot', 'stick')",
        ),
        (changed(phases=(Phase("slip", True, 1.0, np.zeros(3)),)), f"phases[0] {NO_NUMBERS}"),
        (changed(phases=(Phase("slip", 0.0, np.nan, REST),)), f"phases[0] {NO_NUMBERS}"),
        (changed(phases=phases((-1.0, 1.0))), f"phases[0] lasts from -1 to 1 s: {IN_ORDER}"),
        (changed(phases=phases((0.5, 1.0), (0.0, 0.5))), f"phases[1] lasts from 0 to 0.5 s: {IN_ORDER}"),
        (changed(phases=phases((0.0, 0.5), (0.5, 2.0))), f"phases[1] lasts from 0.5 to 2 s: {IN_ORDER}"),
        (changed(phases=phases((0.5, 0.0))), f"phases[0] lasts from 0.5 to 0 s: {IN_ORDER}"),
    ],
)
def test_what_is_no_answer_is_refused_before_a_study_sees_it(engine, sentence):
    with pytest.raises(BadTrajectoryError) as error:
        engine.simulate(FIG5, [0.0] * 4, TIMES)
    assert str(error.value) == sentence


def test_what_is_no_trajectory_is_refused_before_a_study_sees_it():
    engine = Engine("mine", lambda *_, **__: 42)
    with pytest.raises(TypeError, match=r"^simulate\(\) returned 42: it must be a Trajectory$"):
        engine.simulate(FIG5, [0.0] * 4, TIMES)


def test_times_that_were_added_up_in_another_order_are_those_asked_for():
    added_up = np.cumsum(np.full(1000, 0.1)) - 0.1
    asked = 0.1 * np.arange(1000)
    assert not np.array_equal(added_up, asked)
    changed(times=added_up, states=np.zeros((1000, 4))).simulate(FIG5, [0.0] * 4, asked)


def test_an_engine_that_only_slides_is_asked_for_no_motion_that_sticks():
    engine = Engine("mine", resting, sticks=False)
    centre = FIG5.stiffness * FIG5.offset / (FIG5.stiffness - FIG5.mass * FIG5.disc_speed**2)
    turning = [centre, 0.0, 0.0, centre * FIG5.disc_speed]  # in the midst of the sticking domain
    with pytest.raises(UnsupportedSystemError, match=r"^mine does not simulate stick$"):
        engine.simulate(FIG5, turning, TIMES)
    whirling = [0.9, 0.0, 0.0, 0.9]
    assert engine.simulate(FIG5, whirling, TIMES).times is not None
    assert replace(engine, sticks=True).simulate(FIG5, turning, TIMES).times is not None


@pytest.mark.parametrize(("velocity", "asked"), [(0.0, False), (1e-3, True)])
def test_an_engine_that_only_slides_is_asked_for_no_motion_that_starts_at_rest(velocity, asked):
    """A block that is let go slips from the first, but no slip says in which direction."""
    engine = Engine("mine", resting, sticks=False)
    motion = replace(BLOCK, friction_force=0.01), [0.2, 0.0, -velocity, 0.0], TIMES
    if asked:
        assert engine.simulate(*motion).times is not None
        return
    with pytest.raises(UnsupportedSystemError, match=r"^mine does not simulate stick$"):
        engine.simulate(*motion)


def test_a_fixed_step_takes_the_place_of_the_tolerance_and_goes_with_its_root():
    taken = []

    def simulate(*motion, step):
        taken.append(step)
        return resting(*motion)

    engine = Engine("mine", simulate, step=1e-2)
    for tolerance in (1e-9, 1e-11, 1e-7):
        engine.simulate(FIG5, [0.0] * 4, TIMES, tolerance=tolerance)
    assert taken == pytest.approx([1e-2, 1e-3, 1e-1])


@pytest.mark.parametrize("order", [1, 2, 4])
def test_the_estimate_covers_the_error_of_a_fixed_step_from_first_order_on(order):
    def simulate(system, state, times, *, step):
        steps = math.ceil(1.0 / step)
        end = sum((1j / steps) ** k / math.factorial(k) for k in range(order + 1)) ** steps  # of ż = iz
        states = np.array([[1.0, 0.0, 0.0, 0.0], [end.real, end.imag, 0.0, 0.0]])
        return Trajectory(system, np.array(times), states, (), Solution("Taylor", 0.0, 0, 0, 0.0))

    engine = Engine("mine", simulate, step=0.01)
    end, estimate = refined(
        lambda tol: engine.simulate(FIG5, [1.0, 0, 0, 0], [0.0, 1.0], tolerance=tol).at_end
    )
    error = np.linalg.norm(end[:2] - [math.cos(1.0), math.sin(1.0)])
    assert error <= np.linalg.norm(estimate)


def test_studies_come_in_report_order_whatever_the_order_of_their_names():
    among = fake_studies.ALL
    assert [study.name for study in studies(["agreement", "verdicts"], among)] == ["verdicts", "agreement"]
    assert studies([], among) == among
    assert one_of("study", "verdicts", [study.name for study in among]) == "verdicts"
    with pytest.raises(ValueError, match="unknown study 'verdict': did you mean 'verdicts'"):
        studies(["verdict"], among)


STICKING_PIN = (FIG5, (0.1, 0.0, 0.03, 0.0))
TURNING_RING = (RING, (0.1, 0.0, 0.0, 0.0, 0.1, 1.0))
TURNING_POINTS = (POINTS, (0.1, 0.0, 0.0, 0.0, 0.1, 1.0))


@pytest.mark.parametrize(
    ("name", "system", "start"),
    [
        ("reference", *STICKING_PIN),
        ("reference", *TURNING_RING),
        ("reference", *TURNING_POINTS),
        ("exudyn", *STICKING_PIN),
        ("exudyn", *TURNING_RING),
        ("exudyn", *TURNING_POINTS),
        ("exudyn-native", *STICKING_PIN),
        ("exudyn-native", *TURNING_POINTS),
    ],
)
def test_the_same_motion_is_the_same_to_the_last_bit_however_often_it_is_asked_for(name, system, start):
    """Tests of the studies keep what the reference has simulated."""
    (engine,) = engines([name])
    one, other = (engine.simulate(system, start, (0.0, 5.0, 10.0), tolerance=1e-7) for _ in range(2))
    np.testing.assert_array_equal(one.states, other.states)
    assert one.stick_times.tolist() == other.stick_times.tolist()
