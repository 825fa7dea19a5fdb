"""The matrix names the friction law of an engine and reports no other deviations."""

import functools
import json
import math
from dataclasses import replace

import numpy as np
import pytest
from stepping import box, cone, engine, pyramid

from compare.diagnosis import run
from compare.diagnosis.findings import (
    MOTIONS,
    RUNGS,
    Ladder,
    Motion,
    creep,
    friction,
    lag,
    motion,
    tolerances,
)
from compare.diagnosis.laws import CONE, Friction, fitted
from compare.diagnosis.row import Row, write_picture, write_rows
from compare.diagnosis.run import recorded_rows
from compare.engines import COARSENING, USUAL_TOLERANCE, Engine, plain, reference
from compare.run.workers import Workers
from reference_model import Trajectory

RIGHT = engine("right")

NAMED = {
    "box": (engine("box", law=box), "Friction is a box with a separate limit for each axis, accurate to"),
    "nearest axis": (
        engine("nearest", law=functools.partial(pyramid, sides=4)),
        "Friction is a pyramid with 4 sides that acts along the nearest axis, accurate to",
    ),
    "eight sides": (
        engine("eight", law=functools.partial(pyramid, sides=8, tilt=math.pi / 8)),
        "Friction is a pyramid with 8 sides inside the cone, with a side across the x axis, accurate to",
    ),
    "0.1 % too much": (
        engine("more", law=functools.partial(cone, factor=1.001)),
        "Friction is Coulomb's cone, but μ is 0.10 % too large",
    ),
    "one degree off": (
        engine("turned", law=functools.partial(cone, turn=math.radians(1.0))),
        "Friction is Coulomb's cone, but its force is rotated by 1.0° (±",
    ),
}


def sentences(engine):
    row = Row(
        engine.name, step=engine.step or math.nan, law=friction(engine), creep=creep(engine), lag=lag(engine)
    )
    return row, " ".join(row.sentences)


@pytest.mark.parametrize("wrong", NAMED)
def test_a_wrong_law_is_named(wrong):
    made, said = NAMED[wrong]
    row, found = sentences(made)
    assert found.startswith(said)
    assert row.wrong


@pytest.mark.parametrize("made", [RIGHT, reference], ids=lambda made: made.name)
def test_coulombs_law_is_named_and_nothing_else(made):
    row, found = sentences(made)
    assert found.startswith("Friction is Coulomb's cone, accurate to ")
    assert found.endswith("A block loaded below μN stays at rest.")
    assert not row.wrong


def test_an_initial_impulse_is_not_attributed_to_friction():
    """MuJoCo's ellipse with Runge-Kutta steps has an impulse of 5e-7 m/s per m/s; μ seemed 0.0025 % too large."""

    def simulate(pin, start, times, *, tolerance):
        found = reference.simulate(
            pin, (*start[:2], *np.multiply(start[2:], 1.0 - 5e-7)), times, tolerance=tolerance
        )
        return replace(found, states=np.vstack((start, found.states[1:])))

    assert sentences(replace(reference, function=simulate))[1].startswith(
        "Friction is Coulomb's cone, accurate to "
    )


@pytest.mark.parametrize(
    ("error", "misfit", "sure"), [(11.0, 0.0, False), (1e-7, 0.5, False), (1e-7, 0.0, True)]
)
def test_forces_are_relative_to_the_limit_of_friction(error, misfit, sure):
    (said,) = Row("any", law=Friction(CONE, 1.0, 0.0, error, misfit, sure)).sentences
    assert " times μN" in said


def test_a_law_is_uncertain_if_another_fits_equally_well():
    """A pyramid with corners on the axes is the cone for slip along the axes."""
    slips = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]])
    assert not fitted(np.hstack((-slips, slips)), 1e-9).sure
    slips = np.vstack((slips, [0.6, 0.8]))
    found = fitted(np.hstack((-slips, slips)), 1e-9)
    assert (found.shape, found.sure) == (CONE, True)


def test_a_fixed_regularisation_is_distinguished_from_one_that_falls_with_the_step():
    fixed, said = sentences(engine("fixed", smooth=1e-2))
    # Smoothing acts on the slip before the step, which is larger by the change during the step.
    assert "regularised as min(v/ε, 1) with ε = 0.00" in said
    assert said.endswith("m/s, independent of the step.")
    assert fixed.wrong


def test_a_lag_of_one_step_is_reported_but_is_not_wrong():
    row, said = sentences(engine("previous", lagging=True))
    assert "Friction lags the slip by 1.0 steps." in said or "0.9" in said.split("slip by ")[1]
    assert not row.wrong


def test_every_engine_runs_at_the_same_number_of_tolerances():
    stepped, adaptive = tolerances(RIGHT), tolerances(reference)
    assert len(stepped) == len(adaptive) == RUNGS
    assert stepped[-1] == adaptive[-1] == USUAL_TOLERANCE
    assert RIGHT.step_at(stepped[0]) / RIGHT.step_at(stepped[-1]) == pytest.approx(2.0 ** (RUNGS - 1))
    assert adaptive[0] / adaptive[1] == pytest.approx(COARSENING)
    fourth = replace(RIGHT, order=4.0)
    assert fourth.step_at(tolerances(fourth)[0]) == pytest.approx(8.0 * fourth.step)


def test_a_converging_motion_has_its_order_and_a_valid_error_estimate():
    found = motion(RIGHT, "release")
    assert found.converges
    assert found.order == pytest.approx(1.0, abs=0.4)
    assert found.error <= found.estimate
    assert not motion(engine("box", law=box), "release").converges


@pytest.mark.parametrize("order", [0.5, 1.0, 2.0])
def test_the_estimate_covers_errors_of_order_one_half_and_higher(order):
    """A smoothed law may converge that slowly without being another law."""
    ladder = Ladder.of(RIGHT, lambda tolerance: 1.0 + RIGHT.step_at(tolerance) ** order)
    off = abs(ladder.finest - 1.0)
    assert off <= ladder.error <= 50.0 * off

    def shifted(system, start, times, *, step):
        run = reference.simulate(system, start, times, tolerance=1e-12)
        return Trajectory(system, run.times, run.states + np.array([[step**order, 0.0, 0.0, 0.0]]))

    found = motion(replace(RIGHT, function=shifted), "slip")
    assert found.order == pytest.approx(order, abs=0.01)
    assert found.converges


def test_an_engine_that_ignores_the_tolerance_is_reported():
    deaf = Motion((1e-3,) * RUNGS, 1e-12, 0.0, 0.025, 0.1)
    row = Row("deaf", motions={"slip": deaf})
    told = "Results do not change with the tolerance, so an error cannot be distinguished from another law."
    assert row.sentences == (told,)
    assert row.wrong


def test_an_engine_without_stick_is_not_probed_for_creep():
    assert run.measured(plain, "creep") == "plain does not simulate stick"
    row = run._with(Row("plain"), "creep", "plain does not simulate stick", 0.1)
    assert row.not_simulated == ("creep",)
    assert not row.wrong


def raises(system, start, times, *, tolerance):
    raise RuntimeError("out of order")


def test_a_failed_probe_is_named_and_the_others_remain():
    broken = Engine("broken", raises, ("block",))
    (row,) = run.diagnosed((broken,), limit=60.0)
    assert set(row.gaps) == {"law", "creep"}
    assert row.sentences[0].startswith("No result for law, creep: out of order")
    assert set(run._probed(broken, Workers(1)).gaps) == {"law"}


def test_recorded_engines_have_rows_like_the_others(tmp_path):
    rows = recorded_rows()
    by_name = {row.engine: row for row in rows}
    assert by_name["Bullet, box"].wrong
    assert by_name["Bullet, box"].sentences[0].startswith("Friction is a box with a separate limit")
    nearest = "Friction is a pyramid with 4 sides that acts along the nearest axis"
    assert by_name["MuJoCo, pyramidal cone"].sentences[0].startswith(nearest)
    assert by_name["MuJoCo, elliptic cone"].sentences[0].startswith("Friction is Coulomb's cone")
    assert not by_name["Drake, TAMSI"].wrong
    assert set(by_name["Drake, TAMSI"].motions) <= set(MOTIONS)
    mine = Row("mine", motions={"slip": Motion((1e-2, 5e-3, 2e-3, 1e-3), 3e-3, 1.0, 0.025, 0.1)})
    write_rows([*rows, mine], tmp_path)
    content = json.loads((tmp_path / "matrix.json").read_text(encoding="utf-8"))
    assert content[-1]["motions"]["slip"]["errors"] == [1e-2, 5e-3, 2e-3, 1e-3]
    assert content[-1]["sentences"] == ["Errors are of order 1.0 in the tolerance."]
    write_picture([*rows, mine], tmp_path)
    assert (tmp_path / "matrix.png").stat().st_size > 10_000
