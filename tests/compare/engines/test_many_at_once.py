"""Engines that simulate batches of motions receive batches, with the same results as single runs."""

import sys
from dataclasses import replace

import numpy as np
import pytest

import reference_model
from compare.claims.parameters import FIG5, FIG5_STARTS, FIG11
from compare.engines import BadTrajectoryError, Engine, UnsupportedSystemError, engines
from compare.studies import studies

MOTIONS = [
    (FIG5, FIG5_STARTS["whirl"], np.linspace(0.0, 6.0, 7)),
    (replace(FIG5, disc_speed=2.0), (0.3, 0.0, 0.0, 0.1), [0.0, 1.0]),
]


class OneByOne:
    """The reference, which counts its single runs."""

    def __init__(self):
        self.alone = 0

    def __call__(self, system, initial_state, times, *, tolerance):
        self.alone += 1
        found = reference_model.simulate(system, initial_state, times, tolerance=tolerance)
        return reference_model.Trajectory(system, found.times, found.states)


class AtOnce(OneByOne):
    """The reference with batches; ``returns`` may spoil their result."""

    def __init__(self, returns=list):
        super().__init__()
        self.many, self.returns = [], returns

    def simulate_many(self, systems, initial_states, times, *, tolerance):
        self.many.append(len(systems))
        runs = [
            OneByOne()(*motion, tolerance=tolerance)
            for motion in zip(systems, initial_states, times, strict=True)
        ]
        return self.returns(runs)


@pytest.mark.parametrize("promise", [{}, {"phases": False}, {"precision": 1e-6}])
def test_a_batch_equals_single_runs_to_the_last_bit(promise):
    at_once = AtOnce()
    found = Engine("mine", at_once, **promise).simulate_many(MOTIONS, tolerance=1e-7)
    assert (at_once.many, at_once.alone) == ([2], 0)
    alone = Engine("mine", OneByOne(), **promise)
    for run, motion in zip(found, MOTIONS, strict=True):
        expected = alone.simulate(*motion, tolerance=1e-7)
        np.testing.assert_array_equal(run.states, expected.states)
        np.testing.assert_array_equal(run.stick_times, expected.stick_times)


def test_a_study_uses_batches_and_finds_the_same():
    (block,) = studies(["block"])
    at_once, alone = AtOnce(), OneByOne()
    found, expected = (
        block.measure(Engine("mine", function, ("block",), phases=False), only=("slows", "holds"))
        for function in (at_once, alone)
    )
    assert max(at_once.many) >= 4
    assert at_once.alone < alone.alone / 2
    for claim, other in zip(found.claims, expected.claims, strict=True):
        assert claim.verdict is other.verdict
        np.testing.assert_array_equal(claim.measured, other.measured)
        np.testing.assert_array_equal(claim.budget.numerical, other.budget.numerical)


@pytest.mark.parametrize(
    ("returns", "error", "sentence"),
    [
        (lambda runs: runs[:1], BadTrajectoryError, "simulate_many() returned 1 trajectories: expected 2"),
        (lambda runs: None, TypeError, "simulate_many() returned None: it must be a list of trajectories"),
        (
            lambda runs: runs[::-1],
            BadTrajectoryError,
            "motion 1 of 2: the trajectory's times have shape (2,)",
        ),
    ],
)
def test_an_invalid_result_of_a_batch_is_rejected(returns, error, sentence):
    with pytest.raises(error) as raised:
        Engine("mine", AtOnce(returns)).simulate_many(MOTIONS)
    assert sentence in str(raised.value)


def test_an_unsupported_motion_rejects_its_batch_before_it_runs():
    at_once = AtOnce()
    with pytest.raises(UnsupportedSystemError, match="mine does not simulate a disc on a continuous ring"):
        Engine("mine", at_once).simulate_many([*MOTIONS, (FIG11, np.zeros(6), [0.0, 1.0])])
    assert at_once.many == []


def test_simulate_many_may_be_an_attribute_of_a_function_of_a_module(tmp_path, monkeypatch):
    (tmp_path / "many_of_mine.py").write_text(
        "def simulate(system, initial_state, times, *, step): raise AssertionError\n"
        "simulate.simulate_many, simulate.step = lambda *motions, step: [step], 1e-3\n"
    )
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", list(sys.path))
    (engine,) = engines(["many_of_mine:simulate"])
    with pytest.raises(TypeError, match=r"simulate\(\) returned 0.001: it must be a Trajectory"):
        engine.simulate_many(MOTIONS[:1])
