import math
import re
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
    register,
)
from compare.studies import studies
from reference_model.trajectory import Phase, Solution, Trajectory


@pytest.mark.parametrize(("name", "method"), [("plain", "Radau")])
def test_an_engine_on_request_takes_part_only_if_named(name, method):
    assert name not in [engine.name for engine in engines()]
    (engine,) = engines([name])
    found, exact = (
        one.simulate(FIG11, [0.1, 0.0, 0.0, 0.03, 0.0, 1.0], [0.0, 2.0], tolerance=1e-7)
        for one in (engine, *engines(["reference"]))
    )
    assert found.solution.method.startswith(method)
    np.testing.assert_allclose(found.at_end, exact.at_end, atol=1e-5)


def test_an_engine_without_nonlinear_supports_rejects_them():
    linear = Engine("linear", len, EVERY_KIND, nonlinear=False)
    hard = replace(FIG5, hardening=2.0), replace(FIG5, stop_stiffness=1.0)
    assert [linear.simulates(system) for system in (FIG5, FIG11, *hard)] == [True, True, False, False]
    assert linear.lacking([FIG5, *hard]) == "linear does not simulate a pin on a nonlinear support"
    with pytest.raises(UnsupportedSystemError, match="nonlinear support"):
        linear.simulate(hard[0], [0.1, 0.0, 0.0, 0.0], [0.0, 1.0])


@pytest.fixture
def module(tmp_path, monkeypatch):
    """Return a function that writes a module with ``simulate`` and more code, and returns its engine."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", list(sys.path))
    monkeypatch.delitem(sys.modules, "of_mine", raising=False)

    def engine(code):
        (tmp_path / "of_mine.py").write_text(f"def simulate(*motion, **accuracy): return 42\n{code}\n")
        (found,) = engines(["of_mine:simulate"])
        return found

    yield engine
    sys.modules.pop("of_mine", None)


@pytest.mark.parametrize(
    ("code", "kinds"),
    [
        ("", ("pin",)),
        ("simulate.kinds = ('pin', 'ring')", ("pin", "ring")),
    ],
)
def test_a_users_engine_is_named_module_function_and_declares_its_kinds(code, kinds, module):
    engine = module(code)
    assert (engine.name, engine.kinds) == ("of_mine:simulate", kinds)
    assert engine.function(FIG5, None, None) == 42


@pytest.mark.parametrize(
    ("code", "reason"),
    [
        ("1 / 0", " cannot be imported: ZeroDivisionError: division by zero"),
        ("simulate.kinds = ('rings',)", ", attribute kinds = … did you mean 'ring'"),
        ("simulate.kinds = ()", ", attribute kinds = …it must contain at least one of"),
        ("simulate.kinds = 7", ", attribute kinds = …7: it must be a tuple or a list"),
        ("simulate.sticks = 'no'", ", attribute …sticks = 'no': it must be True or False"),
        ("simulate.step = 1e-300", ", attribute …step = 1e-300 s: it must be at least 1e-09 s"),
    ],
)
def test_an_invalid_module_is_rejected(code, reason, module):
    pattern = ".*".join(map(re.escape, reason.split("…")))
    with pytest.raises(ValueError, match=f"^engine 'of_mine:simulate'{pattern}"):
        module(code)


@pytest.mark.parametrize("name", ["reference", "theory"])
def test_a_registered_name_cannot_be_used_again(name):
    with pytest.raises(ValueError, match="the name is taken"):
        register(Engine(name, fake_studies.straight))


BLOCK = replace(FIG5, disc_speed=0.0)
SYSTEMS = {"pin": FIG5, "block": BLOCK, "ring": FIG11, "points": replace(FIG11, contact_points=6)}


@pytest.mark.parametrize(
    ("kinds", "lacking"),
    [
        (("pin",), "mine does not simulate a disc on a continuous ring or a disc on single points"),
        (("points", "ring"), "mine does not simulate a pin or a block on a plane at rest"),
        (("block", "points", "ring"), "mine does not simulate a pin"),
        (EVERY_KIND, ""),
    ],
)
def test_an_engine_simulates_the_kinds_that_it_declares_and_blocks_as_pins(kinds, lacking):
    engine = Engine("mine", fake_studies.straight, kinds, nonlinear=False)
    assert engine.lacking([*SYSTEMS.values(), FIG11]) == lacking
    for kind, system in SYSTEMS.items():
        state = [0.0] * system.state_size
        known = kind in kinds or (kind == "block" and "pin" in kinds)
        assert engine.simulates(system) == known
        if known:
            assert engine.lacking([replace(system, hardening=2.0)]).endswith(" on a nonlinear support")
            assert engine.simulate(system, state, [0.0, 1.0], tolerance=1e-3).solution.tolerance == 1e-3
        else:
            with pytest.raises(UnsupportedSystemError, match=r"^mine does not simulate a "):
                engine.simulate(system, state, [0.0, 1.0])


def test_an_installed_package_registers_its_engine_by_an_entry_point(tmp_path, monkeypatch):
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
    assert "solver" not in [engine.name for engine in engines()]  # only on request
    with pytest.raises(ValueError, match="did you mean 'solver'"):
        engines(["sovler"])


TIMES = np.linspace(0.0, 1.0, 5)


def changed(**changes):
    """Return an engine whose trajectory is valid except for ``changes``."""
    return Engine("mine", lambda *motion, **accuracy: replace(fake_studies.straight(*motion), **changes))


def spans(*spans, kind="slip"):
    return {"phases": tuple(Phase(kind, start, end, np.zeros(4)) for start, end in spans)}


NO_NUMBERS = "must have finite times and 4 finite numbers as its initial_state"
NO_PHASE = "it must be a Phase of a kind in ('slip', 'pivot', 'stick')"
IN_ORDER = "phases must follow each other between 0 and 1 s"
NOT_REAL = "they must be real numbers"
BROKEN_STATES = np.zeros((5, 4))
BROKEN_STATES[3, 2] = np.inf

NO_ANSWERS = [
    ({"times": TIMES[:-1]}, "the trajectory's times have shape (4,): expected (5,)"),
    ({"times": TIMES + 1e-9}, "the trajectory's times[0] = 1e-09 s: expected 0.0 s"),
    ({"times": TIMES * np.nan}, "the trajectory's times[0] = nan s: expected 0.0 s"),
    ({"times": TIMES + 0j}, f"the trajectory's times have the type complex128: {NOT_REAL}"),
    ({"states": np.zeros((5, 6))}, "the trajectory's states have shape (5, 6): expected (5, 4)"),
    ({"states": BROKEN_STATES}, "the state at t = 0.75 s is not finite: [0.0, 0.0, inf, 0.0]"),
    ({"states": np.full((5, 4), True)}, f"the trajectory's states have the type bool: {NOT_REAL}"),
    (spans((0.0, 1.0), kind="glide"), f"phases[0] is 'glide': {NO_PHASE}"),
    ({"phases": ("slip",)}, f"phases[0] is 'slip': {NO_PHASE}"),
    ({"phases": (Phase("slip", True, 1.0, np.zeros(3)),)}, f"phases[0] {NO_NUMBERS}"),
    (spans((0.0, np.nan)), f"phases[0] {NO_NUMBERS}"),
    (spans((-1.0, 1.0)), f"phases[0] lasts from -1 to 1 s: {IN_ORDER}"),
    (spans((0.5, 1.0), (0.0, 0.5)), f"phases[1] lasts from 0 to 0.5 s: {IN_ORDER}"),
    (spans((0.0, 0.5), (0.5, 2.0)), f"phases[1] lasts from 0.5 to 2 s: {IN_ORDER}"),
    (spans((0.5, 0.0)), f"phases[0] lasts from 0.5 to 0 s: {IN_ORDER}"),
]


@pytest.mark.parametrize(("changes", "sentence"), NO_ANSWERS, ids=[sentence for _, sentence in NO_ANSWERS])
def test_an_invalid_trajectory_is_rejected(changes, sentence):
    with pytest.raises(BadTrajectoryError) as error:
        changed(**changes).simulate(FIG5, [0.0] * 4, TIMES)
    assert str(error.value) == sentence


def test_a_result_that_is_not_a_trajectory_is_rejected():
    with pytest.raises(TypeError, match=r"^simulate\(\) returned 42: it must be a Trajectory$"):
        Engine("mine", lambda *_, **__: 42).simulate(FIG5, [0.0] * 4, TIMES)


BUFFER = np.zeros((2, 8))


@pytest.mark.parametrize(
    "form",
    [
        np.ndarray.tolist,
        np.ndarray.astype,
        lambda states: (
            BUFFER[:, ::2].__setitem__(..., states) or BUFFER[:, ::2]
        ),  # a view that the next call fills
    ],
    ids=["lists", "integers", "reused"],
)
def test_states_may_be_lists_integers_and_reused_arrays(form):
    def still(system, state, times, *, tolerance):
        states = np.array([state, state])
        return Trajectory(
            system, list(times), form(states, int) if form is np.ndarray.astype else form(states)
        )

    engine = Engine("still", still)
    first, _ = (engine.simulate(FIG5, np.full(4, start), (0.0, 1.0)) for start in (1.0, 2.0))
    assert first.states.dtype == float
    assert first.states.tolist() == np.ones((2, 4)).tolist()


def test_times_may_deviate_by_rounding():
    added_up = np.cumsum(np.full(1000, 0.1)) - 0.1
    asked = 0.1 * np.arange(1000)
    assert not np.array_equal(added_up, asked)
    changed(times=added_up, states=np.zeros((1000, 4))).simulate(FIG5, [0.0] * 4, asked)


CENTRE = FIG5.stiffness * FIG5.offset / (FIG5.stiffness - FIG5.mass * FIG5.disc_speed**2)
LET_GO = replace(BLOCK, friction_force=0.01)


@pytest.mark.parametrize(
    ("system", "start", "slides"),
    [
        (FIG5, [CENTRE, 0.0, 0.0, CENTRE * FIG5.disc_speed], False),  # at the centre of the sticking domain
        (FIG5, [0.9, 0.0, 0.0, 0.9], True),
        (LET_GO, [0.2, 0.0, 0.0, 0.0], False),  # slips at once, but its direction is undefined at zero slip
        (LET_GO, [0.2, 0.0, -1e-3, 0.0], True),
    ],
)
def test_an_engine_without_stick_rejects_starts_in_stick_or_at_rest(system, start, slides):
    engine = Engine("mine", fake_studies.straight, sticks=False)
    assert replace(engine, sticks=True).simulate(system, start, TIMES).times is not None
    if slides:
        assert engine.simulate(system, start, TIMES).times is not None
        return
    with pytest.raises(UnsupportedSystemError, match=r"^mine does not simulate stick$"):
        engine.simulate(system, start, TIMES)


def test_a_fixed_step_is_proportional_to_the_root_of_the_tolerance():
    taken = []

    def simulate(*motion, step):
        taken.append(step)
        return fake_studies.straight(*motion)

    engine = Engine("mine", simulate, step=1e-2)
    for tolerance in (1e-9, 1e-11, 1e-7):
        engine.simulate(FIG5, [0.0] * 4, TIMES, tolerance=tolerance)
    assert taken == pytest.approx([1e-2, 1e-3, 1e-1])


@pytest.mark.parametrize("order", [1, 2, 4])
def test_the_error_estimate_covers_fixed_steps_of_any_order(order):
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


def test_studies_are_returned_in_report_order():
    among = fake_studies.ALL
    assert [study.name for study in studies(["agreement", "verdicts"], among)] == ["verdicts", "agreement"]
    assert studies([], among) == among
