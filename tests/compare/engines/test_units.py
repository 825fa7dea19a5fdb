"""Motions in other units are equal, and show mistakes at other masses and speeds."""

from dataclasses import fields, replace

import numpy as np
import pytest

from compare.claims.claim import Verdict
from compare.claims.parameters import FIG5, FIG5_STARTS, FIG11
from compare.engines import Engine, exudyn, reference
from compare.engines.units import DIMENSIONS, InOtherUnits
from compare.studies.pin.fig03 import STUDY as FIG03
from reference_model.systems import DiscOnDisc

MOTIONS = {
    "pin": (replace(FIG5, hardening=0.5, stop_gap=0.4, stop_stiffness=3.0), FIG5_STARTS["whirl"]),
    "ring": (FIG11, (0.05, 0.0, 0.0, 0.0, 0.05, 1.3)),
    "points": (replace(FIG11, contact_points=6), (0.05, 0.0, 0.0, 0.0, 0.05, 1.3)),
}
TIMES = np.linspace(1.0, 11.0, 11)


@pytest.mark.parametrize("name", MOTIONS)
@pytest.mark.parametrize("engine", [reference, exudyn], ids=lambda engine: engine.name)
def test_an_engine_without_absolute_constants_returns_the_same_digits(engine, name):
    """Runs are therefore reproducible, which tests of studies need because they keep trajectories."""
    system, start = MOTIONS[name]
    usual = engine.simulate(system, start, TIMES)
    for seed in range(2):
        found = replace(engine, seed=seed).simulate(system, start, TIMES)
        np.testing.assert_array_equal(found.states, usual.states)
        assert found.system == system
        assert [(phase.kind, phase.start, phase.end) for phase in found.phases] == [
            (phase.kind, phase.start, phase.end) for phase in usual.phases
        ]
        assert found.solution.regularisation == usual.solution.regularisation


def asked(seed, system, start, **accuracy):
    """Return the system, the start and the step that an engine receives."""
    received = []
    InOtherUnits(lambda *motion, **accuracy: received.extend((*motion, accuracy)), seed)(
        system, start, TIMES, **accuracy
    )
    return received


def test_every_parameter_has_a_dimension():
    assert set(DIMENSIONS) == {field.name for field in fields(DiscOnDisc)} - {"contact_points"}


def test_masses_loads_and_speeds_fill_three_decades():
    found = [asked(seed, FIG5, (0.0, 0.0, 1.0, 0.0)) for seed in range(300)]
    factors = np.array([(it.mass, it.friction_force, start[2], it.disc_speed) for it, start, *_ in found])
    for values in factors.T:
        assert np.max(values) / np.min(values) == 2.0**10
    assert asked(7, FIG5, FIG5_STARTS["whirl"])[0] != asked(8, FIG5, FIG5_STARTS["whirl"])[0]


def test_an_engine_that_is_right_for_the_studies_own_parameters_only_is_caught_in_drawn_units():
    def cheat(system, start, times, *, tolerance):
        known = system.mass == 1.0
        asked = system if known else replace(system, friction_force=1.1 * system.friction_force)
        return replace(reference.function(asked, start, times, tolerance=tolerance), system=system)

    engine = Engine("cheat", cheat, ("pin",))
    for seed, verdict in ((None, Verdict.AGREES), (7, Verdict.DIFFERS), (8, Verdict.DIFFERS)):
        (claim,) = FIG03.measure(replace(engine, seed=seed), {"rests": {"loads": (0.02,)}}, ("rests",)).claims
        assert claim.verdict is verdict


def test_a_fixed_step_is_in_the_same_unit_of_time_so_the_number_of_steps_is_the_same():
    steps = set()
    for seed in range(9):
        system, *_, accuracy = asked(seed, FIG5, FIG5_STARTS["whirl"], step=1e-3)
        assert accuracy["step"] * system.disc_speed == 1e-3 * FIG5.disc_speed
        steps.add(accuracy["step"])
    assert len(steps) > 3


@pytest.mark.parametrize("step", [None, 1e-3])
def test_an_engine_that_simulates_many_receives_all_in_other_units(step):
    """One call has one step, so with a fixed step all motions have one unit of time."""

    def simulate(system, start, times, **accuracy):
        raise AssertionError("all at once")

    received = []

    def simulate_many(systems, starts, times, **accuracy):
        received.extend(systems)
        return [reference.function(*motion) for motion in zip(systems, starts, times, strict=True)]

    simulate.simulate_many = simulate_many
    motions = [(*MOTIONS[name], TIMES) for name in ("pin", "ring")]
    engine = Engine("many", simulate, reference.kinds, seed=1, step=step)
    found = engine.simulate_many(motions)
    for run, motion in zip(found, motions, strict=True):
        np.testing.assert_array_equal(run.states, reference.simulate(*motion).states)
    factors = [
        there.disc_speed / system.disc_speed for there, (system, *_) in zip(received, motions, strict=True)
    ]
    assert all(there != system for there, (system, *_) in zip(received, motions, strict=True))
    assert (factors[0] == factors[1]) == (step is not None)
