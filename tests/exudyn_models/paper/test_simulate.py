import os
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from plain_slip import slide
from scipy.linalg import expm

import reference_model
from exudyn_models import add_ring_friction, simulate, simulate_fixed_step
from exudyn_models.paper.alternating_solvers import Friction
from exudyn_models.paper.creep import RegularisedContact
from reference_model import SimulationError
from reference_model.systems import PinOnDisc

PIN = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=1.5, offset=0.1)
STICKING_START = [0.1, 0.0, 0.03, 0.0]  # Fig. 5, second start
SLIPPING_START = [1.3, 0.0, 0.0, -1.3]  # never comes to rest


def slip_motion(pin, start, times):
    """States while the pin slips, by an integrator that has nothing to do with Exudyn."""
    return slide(pin, start, times).y.T


def free_motion(pin, start, times):
    """The damped oscillator in closed form: a matrix exponential."""
    matrix = np.block(
        [
            [np.zeros((2, 2)), np.eye(2)],
            [-pin.stiffness / pin.mass * np.eye(2), -pin.damping / pin.mass * np.eye(2)],
        ]
    )
    # Without a spring the pin has no place of rest, but then its offset has no effect either.
    rest = np.array([pin.offset, 0.0, 0.0, 0.0])
    return np.array([rest + expm(matrix * (t - times[0])) @ (start - rest) for t in times])


@pytest.fixture(scope="module")
def slip_times():
    return np.linspace(0.0, 100.0, 501)


@pytest.fixture(scope="module")
def slip_solution(slip_times):
    return slip_motion(PIN, SLIPPING_START, slip_times)


@pytest.fixture(scope="module")
def sticking_reference():
    return reference_model.simulate(PIN, STICKING_START, [0.0, 60.0], tolerance=1e-11)


def test_slip_agrees_with_an_independent_integrator_at_every_output_time(slip_times, slip_solution):
    trajectory = simulate(PIN, SLIPPING_START, slip_times)
    np.testing.assert_allclose(trajectory.states, slip_solution, rtol=0.0, atol=2e-10)
    assert [phase.kind for phase in trajectory.phases] == ["slip"]


def test_error_while_slipping_falls_with_the_tolerance(slip_times, slip_solution):
    errors = [
        np.abs(simulate(PIN, SLIPPING_START, slip_times, tolerance=tolerance).states - slip_solution).max()
        for tolerance in (1e-5, 1e-7, 1e-9, 1e-11)
    ]
    assert np.all(np.diff(errors) < 0.0), errors
    assert errors[-1] < 5e-12


@pytest.mark.parametrize(
    ("integrator", "order", "steps"),
    [
        ("RK44", 4, (0.1, 0.05)),
        ("RK67", 6, (0.2, 0.1)),
        ("GeneralizedAlpha", 2, (0.1, 0.05)),
        ("TrapezoidalIndex2", 2, (0.1, 0.05)),
    ],
)
def test_integrators_converge_at_their_order(integrator, order, steps, slip_times, slip_solution):
    errors = [
        np.abs(
            simulate_fixed_step(PIN, SLIPPING_START, [0.0, 100.0], integrator=integrator, step=step).at_end
            - slip_solution[-1]
        ).max()
        for step in steps
    ]
    observed = np.log2(errors[0] / errors[1])
    assert abs(observed - order) < 0.3, f"observed order {observed:.2f}, errors {errors}"


def test_implicit_solver_has_an_error_of_first_order_in_the_tolerance(slip_times, slip_solution):
    errors = [
        np.abs(
            simulate(PIN, SLIPPING_START, slip_times[:51], tolerance=tolerance, solver="implicit").states
            - slip_solution[:51]
        ).max()
        for tolerance in (1e-6, 1e-8)
    ]
    observed = np.log(errors[0] / errors[1]) / np.log(100.0)
    assert abs(observed - 1.0) < 0.05, f"observed order {observed:.3f}, errors {errors}"
    assert errors[1] < 1e-4


@pytest.mark.parametrize("solver", ["explicit", "implicit"])
def test_both_solvers_pass_through_sticking(solver, sticking_reference):
    trajectory = simulate(PIN, STICKING_START, [0.0, 12.0], tolerance=1e-9, solver=solver)
    exact = sticking_reference.stick_phases[:2]
    assert [phase.kind for phase in trajectory.phases] == ["slip", "stick", "slip", "stick", "slip"]
    for found, expected in zip(trajectory.stick_phases, exact, strict=True):
        assert found.start == pytest.approx(expected.start, abs=1e-4)
        assert found.end == pytest.approx(expected.end, abs=1e-4)


def test_times_of_stick_and_release_are_of_first_order_in_the_regularisation(sticking_reference):
    exact = np.array([(phase.start, phase.end) for phase in sticking_reference.stick_phases])
    regularisations = (1e-5, 1e-6, 1e-7)
    errors = []
    for regularisation in regularisations:
        trajectory = simulate(
            PIN, STICKING_START, [0.0, 60.0], tolerance=1e-10, regularisation=regularisation
        )
        found = np.array([(phase.start, phase.end) for phase in trajectory.stick_phases])
        assert found.shape == exact.shape == (9, 2)
        errors.append(np.abs(found - exact))
    # The first touch comes before any creep; all later times carry the creep that went before.
    orders = np.log10(np.array(errors[:-1]) / np.array(errors[1:])).reshape(2, -1)[:, 1:]
    assert np.all(np.abs(orders - 1.0) < 0.1), f"observed orders {orders}"
    assert errors[-1][0, 0] < 1e-10
    assert errors[-1].max() < 2e-4


def test_phases_follow_each_other_without_gaps_and_stick_phases_turn_with_the_disc():
    trajectory = simulate(PIN, STICKING_START, np.linspace(0.0, 30.0, 31))
    assert trajectory.phases[0].start == 0.0
    assert trajectory.phases[-1].end == 30.0
    for before, after in zip(trajectory.phases[:-1], trajectory.phases[1:], strict=True):
        assert before.end == after.start
        assert before.kind != after.kind
    for phase in trajectory.stick_phases:
        x, y, vx, vy = phase.initial_state
        assert np.hypot(vx + PIN.disc_speed * y, vy - PIN.disc_speed * x) < trajectory.solution.regularisation


def test_a_pin_that_starts_stuck_stays_so_until_friction_can_not_hold_it():
    start = [-0.06, -0.015, 0.0225, -0.09]
    exact = reference_model.simulate(PIN, start, [0.0, 3.0])
    found = simulate(PIN, start, [0.0, 3.0])
    assert [phase.kind for phase in found.phases] == [phase.kind for phase in exact.phases]
    assert found.phases[0].kind == "stick"
    assert found.phases[0].end == pytest.approx(exact.phases[0].end, abs=1e-6)


def test_a_pin_on_a_resting_disc_comes_to_rest_for_good_and_never_gains_energy():
    pin = replace(PIN, disc_speed=0.0, damping=0.0)
    times = np.linspace(0.0, 30.0, 3001)
    trajectory = simulate(pin, [0.9, 0.1, 0.0, -0.4], times)
    x, y, vx, vy = trajectory.states.T
    energy = 0.5 * (vx**2 + vy**2) + 0.5 * ((x - pin.offset) ** 2 + y**2)
    assert np.all(np.diff(energy) <= 1e-12)
    assert trajectory.phases[-1].kind == "stick"
    assert trajectory.slip_speed[-1] < trajectory.solution.regularisation


@pytest.mark.parametrize(
    "change",
    [{}, {"disc_speed": 0.0}, {"damping": 0.0}, {"stiffness": 0.0}, {"stiffness": 0.0, "damping": 0.0}],
)
@pytest.mark.parametrize("solver", ["explicit", "implicit"])
def test_without_friction_the_pin_is_a_damped_oscillator(change, solver):
    pin = replace(PIN, friction_force=0.0, **change)
    times = np.linspace(0.0, 10.0, 21)
    start = np.array([0.3, -0.2, 0.1, 0.4])
    found = simulate(pin, start, times, solver=solver)
    accuracy = 1e-10 if solver == "explicit" else 1e-5
    np.testing.assert_allclose(found.states, free_motion(pin, start, times), rtol=0.0, atol=accuracy)


def test_mirrored_disc_speed_gives_the_mirrored_motion():
    times = np.linspace(0.0, 12.0, 25)
    mirror = np.array([1.0, -1.0, 1.0, -1.0])
    one = simulate(PIN, STICKING_START, times)
    other = simulate(replace(PIN, disc_speed=-PIN.disc_speed), mirror * STICKING_START, times)
    np.testing.assert_allclose(other.states, one.states * mirror, rtol=0.0, atol=1e-10)


def test_states_do_not_depend_on_which_other_times_are_asked_for():
    coarse = simulate(PIN, STICKING_START, np.linspace(0.0, 12.0, 13))
    fine = simulate(PIN, STICKING_START, np.linspace(0.0, 12.0, 1201))
    np.testing.assert_array_equal(fine.states[::100], coarse.states)
    assert fine.solution.evaluations == coarse.solution.evaluations


def test_states_between_steps_are_as_good_as_those_at_a_step():
    times = np.linspace(0.0, 8.0, 17)  # past one stick phase
    together = simulate(PIN, STICKING_START, times).states
    apart = np.array([simulate(PIN, STICKING_START, [0.0, t]).at_end for t in times[1:]])
    slipping = times[1:] < 4.6
    np.testing.assert_allclose(together[1:][slipping], apart[slipping], rtol=0.0, atol=1e-11)
    # The steps through a stick phase divide the time that is left, which makes a few per cent of ε.
    np.testing.assert_allclose(together[1:], apart, rtol=0.0, atol=5e-9)


def test_states_within_the_first_step_are_as_good_as_later_ones():
    times = [0.0, 0.05, 0.1, 0.15, 0.2]
    found = simulate_fixed_step(PIN, SLIPPING_START, times, integrator="RK67", step=0.1).states
    np.testing.assert_allclose(found, slip_motion(PIN, SLIPPING_START, times), rtol=0.0, atol=1e-7)


def test_motion_does_not_depend_on_the_origin_of_time():
    one = simulate(PIN, STICKING_START, [0.0, 4.0, 8.0])
    later = simulate(PIN, STICKING_START, [1000.0, 1004.0, 1008.0])
    np.testing.assert_allclose(later.states, one.states, rtol=0.0, atol=1e-9)
    np.testing.assert_array_equal(later.states[0], STICKING_START)


def test_one_time_gives_the_initial_state():
    trajectory = simulate(PIN, STICKING_START, [2.0])
    np.testing.assert_array_equal(trajectory.states, [STICKING_START])
    assert len(trajectory.phases) == 1
    assert trajectory.phases[0].start == trajectory.phases[0].end == 2.0


def friction_with(change):
    """Friction whose force function is replaced by what ``change`` makes of it."""

    def add(mbs, *nodes, **contact):
        connector = add_ring_friction(mbs, *nodes, **contact)
        force = mbs.GetObject(connector.item)["forceUserFunction"]["function"]
        mbs.SetObjectParameter(connector.item, "forceUserFunction", change(force))
        return connector

    return Friction(add, RegularisedContact.creeping)


@pytest.mark.parametrize("solver", ["explicit", "implicit"])
def test_evaluations_are_those_that_were_made(solver):
    calls = 0

    def counted(force):
        def function(*arguments):
            nonlocal calls
            calls += 1
            return force(*arguments)

        return function

    trajectory = simulate(
        PIN, STICKING_START, [0.0, 12.0], tolerance=1e-7, solver=solver, friction=friction_with(counted)
    )
    assert trajectory.solution.evaluations == pytest.approx(calls, rel=0.01)


def test_a_force_that_is_not_a_number_raises_and_tells_when():
    def broken(force):
        def function(mbs, t, item, q, q_t):
            return force(mbs, t, item, q, q_t) if q[1] > 0.0 else [float("nan")] * 4

        return function

    exact = slip_motion(PIN, [0.1, 0.0, 0.03, 0.0], np.linspace(0.0, 4.0, 4001))
    crossing = np.argmax(exact[:, 0] < 0.0) * 1e-3
    for solver in ("explicit", "implicit"):
        with pytest.raises(
            SimulationError, match=r"failed (\d+\.?\d*) s after the start: .*; take a smaller"
        ) as caught:
            simulate(PIN, STICKING_START, [0.0, 10.0], solver=solver, friction=friction_with(broken))
        time = float(str(caught.value).split("failed ")[1].split(" s")[0])
        assert time == pytest.approx(crossing, abs=0.1)


@pytest.mark.parametrize("solver", ["explicit", "implicit"])
@pytest.mark.parametrize(
    ("raised", "seen"), [(KeyboardInterrupt, KeyboardInterrupt), (ZeroDivisionError, SimulationError)]
)
def test_what_is_raised_inside_of_a_run_comes_out_of_it(solver, raised, seen):
    def interrupted(force):
        def function(*arguments):
            raise raised

        return function

    with pytest.raises(seen):
        simulate(PIN, STICKING_START, [0.0, 10.0], solver=solver, friction=friction_with(interrupted))


def test_an_explicit_step_too_large_for_sticking_raises_instead_of_returning_infinity():
    # RK44 is unstable for steps above 2.8·mε/μN; a stiff spring makes it blow up.
    stiff = replace(PIN, stiffness=1e6)
    with pytest.raises(SimulationError, match="not finite"):
        simulate_fixed_step(stiff, STICKING_START, [0.0, 1000.0], integrator="RK44", step=0.1)


def test_nothing_is_printed_and_no_file_is_written(tmp_path):
    code = (
        "from exudyn_models import simulate, simulate_fixed_step\n"
        "from reference_model import SimulationError\n"
        "from reference_model.systems import PinOnDisc\n"
        f"pin = {PIN!r}\n"
        "for solver in ('explicit', 'implicit'):\n"
        "    simulate(pin, [0.1, 0, 0.03, 0], [0, 12], tolerance=1e-7, solver=solver)\n"
        "import dataclasses\n"
        "try:\n"
        "    simulate_fixed_step(dataclasses.replace(pin, stiffness=1e6), [0.1, 0, 0, 0], [0, 1e3], step=0.1)\n"
        "except SimulationError:\n"
        "    pass\n"
        "else:\n"
        "    raise SystemExit('no error')\n"
    )
    path = os.pathsep.join(os.path.abspath(p) for p in sys.path if p)
    run = subprocess.run(
        [sys.executable, "-c", code],
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": os.pathsep.join((os.getcwd(), path))},
        capture_output=True,
        text=True,
        check=False,
    )
    assert (run.returncode, run.stdout, run.stderr) == (0, "", "")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"initial_state": [0.0, 0.0, 0.0]}, "initial_state has shape"),
        ({"initial_state": [0.0, np.nan, 0.0, 0.0]}, r"initial_state\[1\] = nan"),
        ({"times": [1.0, 0.0]}, "times must increase"),
        ({"times": []}, "at least one time"),
        ({"tolerance": 0.0}, "tolerance = 0"),
        ({"regularisation": 0.0}, "regularisation = 0 m/s"),
        ({"regularisation": -1e-6}, "regularisation = -1e-06 m/s"),
        ({"regularisation": np.inf}, "regularisation = inf"),
        ({"solver": "magic"}, "solver = 'magic': it must be 'explicit' or 'implicit'"),
    ],
)
def test_bad_input_is_refused_in_a_sentence(change, message):
    arguments = {"initial_state": STICKING_START, "times": [0.0, 1.0]} | change
    with pytest.raises(ValueError, match=message):
        simulate(PIN, **arguments)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"integrator": "Euler"}, "integrator = 'Euler': it must be one of RK44, RK67"),
        ({"step": 0.0}, "step = 0 s: it must be > 0"),
        ({"step": np.nan}, "step = nan"),
    ],
)
def test_bad_fixed_step_input_is_refused_in_a_sentence(change, message):
    with pytest.raises(ValueError, match=message):
        simulate_fixed_step(PIN, STICKING_START, [0.0, 1.0], **({"step": 0.1} | change))


def test_sticking_with_nearly_all_of_the_friction_needs_few_steps():
    # Held with 0.92 μN for good: the creep is 0.92 ε all the time.
    pin = replace(PIN, disc_speed=0.0, friction_force=1.0)
    trajectory = simulate(pin, [1.02, 0.0, 0.0, 0.0], [0.0, 30.0])
    assert [phase.kind for phase in trajectory.phases] == ["stick"]
    assert trajectory.solution.steps < 10_000
    # Released from rest the exact pin does not move at all; the creep is 0.92 ε·t.
    assert trajectory.at_end[0] == pytest.approx(
        1.02 - 0.92 * 30.0 * trajectory.solution.regularisation, abs=1e-7
    )


def test_a_coordinate_that_passes_minus_one_does_not_stop_the_solver():
    """Exudyn's error weight, absolute + relative·y, is zero at y = −1 if both tolerances are the same."""
    pin = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.12, disc_speed=1.5)
    for tolerance in (1e-10, 1e-11, 1e-12):
        start = [1.0, 0.0, 0.0, 1.0]  # inside of the whirl of radius 1.2: x and y pass −1 in every turn
        trajectory = simulate(pin, start, [0.0, 50.0], tolerance=tolerance)
        assert trajectory.at_end == pytest.approx(
            reference_model.simulate(pin, start, [0.0, 50.0], tolerance=1e-13).at_end, abs=1e-9
        )
