"""A change of units changes neither the motion nor its accuracy nor the number of steps."""

from dataclasses import replace

import numpy as np
import pytest

import reference_model
from compare.claims.error_estimates import refined
from compare.claims.parameters import FIG5, FIG11
from compare.studies.engines.clutch_scale import Scale
from exudyn_models import simulate, simulate_with_native_contact
from exudyn_models.paper.model import build_model
from exudyn_models.paper.recording import Axes, Recording
from exudyn_models.paper.scales import Units
from exudyn_models.solver.solver_run import solve
from reference_model import SimulationError

RING = replace(FIG11, polar_inertia=0.0072, damping=0.1, friction_force=0.09, offset=0.1)
CASES = {
    "pin": (FIG5, [0.1, 0.0, 0.03, 0.0]),
    "ring": (RING, [0.1, 0.0, 0.0, 0.03, 0.0, 1.2]),
    "six points": (replace(RING, contact_points=6), [0.1, 0.0, 0.0, 0.03, 0.0, 1.2]),
}
TOLERANCE = 1e-8
SCALES = Scale(3e-8, 2e-5, 4e5), Scale(2e5, 7e3, 5e-7), Scale(1e-4, 1e-3, 2.0)
TIMES = np.array([0.0, 4.0, 6.0])  # past the first stick phase of each


@pytest.mark.parametrize(
    ("name", "engine"), [*((name, simulate) for name in CASES), ("pin", simulate_with_native_contact)]
)
def test_changes_of_unit_leave_the_dimensionless_motion_the_same_at_the_same_cost(name, engine):
    system, start = CASES[name]
    states, error = refined(
        lambda tolerance: engine(system, start, TIMES, tolerance=tolerance).states, TOLERANCE
    )
    steps = engine(system, start, TIMES, tolerance=TOLERANCE).solution.steps
    for scale in SCALES:
        found = engine(scale.system(system), scale.states(start), TIMES * scale.time, tolerance=TOLERANCE)
        assert [phase.kind for phase in found.phases].count("stick") == 1
        assert np.abs(found.states / scale.states(np.ones(system.state_size)) - states).max() < error.max()
        assert 0.5 < found.solution.steps / steps < 2.0


def test_the_regularisation_is_reported_in_metres_per_second():
    scale = Scale(1e-3, 5e-3, 0.5)
    one = simulate(FIG5, CASES["pin"][1], [0.0, 1.0])
    other = simulate(scale.system(FIG5), scale.states(CASES["pin"][1]), [0.0, scale.time])
    speed = FIG5.offset * FIG5.disc_speed  # of the start and of the disc
    assert one.solution.regularisation == pytest.approx(1e-7 * speed)
    assert other.solution.regularisation == pytest.approx(1e-7 * speed * scale.length / scale.time)


def test_dampers_set_the_unit_of_time_without_springs_and_rotation():
    disc = replace(FIG11, stiffness=0.0, disc_speed=0.0, damping=1.0, polar_inertia=0.01, shaft_damping=0.2)
    assert Units.of(disc, np.zeros(6)).time == 0.05


def test_a_pin_that_sticks_at_300_rad_per_second_takes_few_steps():
    omega, stiff = 300.0, 1.7e5  # the natural frequency exceeds ω and does not matter either
    pin = reference_model.PinOnDisc(
        mass=1.0, stiffness=stiff, damping=10.0, friction_force=100.0, disc_speed=omega, offset=1e-4
    )
    found = simulate(pin, [1e-4, 0.0, 0.0, omega * 1e-4], [0.0, 0.1, 0.2])
    assert [phase.kind for phase in found.phases] == ["stick"]
    assert found.solution.steps <= 500
    turned = 1e-4 * np.exp(1j * omega * found.times)
    np.testing.assert_allclose(found.states[:, 0] + 1j * found.states[:, 1], turned, rtol=0.0, atol=1e-9)


def test_steps_for_a_hardening_spring_are_as_short_as_its_largest_stiffness_requires():
    pin = replace(FIG5, hardening=1e3)
    assert simulate(pin, [1.0, 0.0, 0.0, -1.0], [0.0, 1.0]).solution.steps < 1100  # 1838 for the smallest one


@pytest.mark.parametrize(
    ("system", "start"),
    [
        (replace(FIG5, hardening=0.3), [1.3, 0.0, 0.0, -1.3]),
        (replace(FIG11, offset=0.1), [0.6, 0.0, 0.4, 0.0, 0.6, 1.3]),
        (replace(FIG11, offset=0.1, contact_points=6), [0.6, 0.0, 0.4, 0.0, 0.6, 1.3]),
    ],
)
@pytest.mark.parametrize("speed", [1.5, -0.7])
def test_motion_in_turning_axes_is_that_in_fixed_ones(system, start, speed):
    """This covers everything that turning axes change: Coriolis and centrifugal force, ground, damper and shaft."""
    axes, start = Axes(speed), np.array(start)
    options = {"integrator": "DOPRI5", "step": 0.1, "tolerance": 1e-12}
    fixed = solve(build_model(system, start, regularisation=1e-7), 0.0, 5.0, **options)
    turning = solve(
        build_model(system, axes.start(start), regularisation=1e-7, axes_speed=speed), 0.0, 5.0, **options
    )
    seen = axes.fixed_steps(turning)
    np.testing.assert_allclose(seen.states[-1], fixed.states[-1], rtol=0.0, atol=2e-11)
    np.testing.assert_allclose(seen.accelerations[-1], fixed.accelerations[-1], rtol=0.0, atol=2e-11)


def test_only_requested_states_are_kept_and_the_phases_are_the_same(monkeypatch):
    arguments = FIG5, CASES["pin"][1], [0.0, 30.0]
    whole = simulate(*arguments)
    kept = []
    add = Recording.add

    def adding(recording, run, axes):
        add(recording, run, axes)
        kept.append(sum(len(part.times) for part in recording._kept))

    monkeypatch.setattr("exudyn_models.paper.recording.MOST_KEPT", 1000)
    monkeypatch.setattr(Recording, "add", adding)
    thinned = simulate(*arguments)
    assert max(kept) < whole.solution.steps / 2
    assert [(p.kind, p.start, p.end) for p in thinned.phases] == [
        (p.kind, p.start, p.end) for p in whole.phases
    ]
    np.testing.assert_array_equal(thinned.states, whole.states)


def test_a_long_run_goes_on_from_part_to_part_as_if_it_were_one(monkeypatch):
    start, times = [1.3, 0.0, 0.0, -1.3], [0.0, 50.0, 100.0]
    whole = simulate(FIG5, start, times)
    monkeypatch.setattr("exudyn_models.paper.alternating_solvers.LOOK_BACK", 200)
    parts = simulate(FIG5, start, times)
    np.testing.assert_allclose(parts.states, whole.states, rtol=0.0, atol=1e-9)
    assert parts.solution.steps < 1.2 * whole.solution.steps


@pytest.mark.parametrize("end", [1e9, 1e15])
def test_a_run_of_far_too_many_steps_says_so_early(end, monkeypatch):
    monkeypatch.setattr("reference_model.trajectory.LOOK_BACK", 500)
    with pytest.raises(SimulationError, match=r"further steps are needed .*simulate it in parts"):
        simulate(FIG5, [1.3, 0.0, 0.0, -1.3], [0.0, end])
