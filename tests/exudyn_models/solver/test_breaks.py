"""Runs across jumps of a load."""

import exudyn as exu
import numpy as np
import pytest
from free_bodies import coordinate, drive, items, new_model, rate_of, rotor, settings_of

from exudyn_models import add_ring_friction, solve_dynamic

SOLVERS = exu.DynamicSolverType
JUMPS = (0.4137, 0.9)


def brake():
    """Return a rotor on the ground that decelerates at R·μN/J = 0.25·N while it turns; N is 2 N, then 7 N, then 0."""
    mbs = new_model()
    wheel = rotor(mbs, 0.2, 10.0)
    law = {"contact_radius": 0.1, "friction_coefficient": lambda slip_speed: 0.5, "regularisation": 0.1}
    load = {"normal_load": lambda time: 2.0 if time < JUMPS[0] else 7.0 if time < JUMPS[1] else 0.0}
    sensor = add_ring_friction(mbs, None, wheel, **law, **load).add_sensor("relative_spin")
    mbs.Assemble()
    return mbs, wheel, sensor


def fixed_steps(steps, start=0.0, end=1.2):
    result = settings_of(end, steps, start)
    result.timeIntegration.adaptiveStep = False
    return result


def exact(t):
    edges = np.array([0.0, *JUMPS, np.inf])
    return 10.0 - 0.25 * float(np.array([2.0, 7.0, 0.0]) @ np.clip(t - edges[:-1], 0.0, np.diff(edges)))


@pytest.mark.parametrize(
    "solver", [SOLVERS.GeneralizedAlpha, SOLVERS.TrapezoidalIndex2, SOLVERS.RK44, SOLVERS.ExplicitEuler]
)
@pytest.mark.parametrize("steps", [1, 40])
def test_a_run_that_breaks_at_the_jumps_is_exact_and_one_that_does_not_is_wrong_by_its_step(solver, steps):
    errors = []
    for breaks in (JUMPS, ()):
        mbs, wheel, _ = brake()
        solve_dynamic(mbs, fixed_steps(steps), solver, breaks=breaks)
        errors.append(abs(rate_of(mbs, wheel) - exact(1.2)))
    assert errors[0] < 1e-11
    assert errors[1] > 1e-3


def test_sensors_hold_all_parts_and_settings_and_initial_values_are_as_before():
    mbs, _, sensor = brake()
    settings = fixed_steps(12)
    settings.solution.sensors.writePeriod = 0.1
    for _ in range(2):
        solve_dynamic(mbs, settings, SOLVERS.GeneralizedAlpha, breaks=JUMPS)
        times, spins = mbs.GetSensorStoredData(sensor).T
        assert (times[0], times[-1]) == (0.0, pytest.approx(1.2))
        assert (np.diff(times) > 0.0).all()
        assert np.diff(times).max() < 0.2  # due values are written at the next step
        np.testing.assert_allclose(spins, [exact(t) for t in times], rtol=1e-11)
    mbs.SetPostStepUserFunction(lambda mbs, t: t < 0.5 or 1 / 0)
    with pytest.raises(exu.ExudynError, match="division by zero"):
        solve_dynamic(mbs, settings, SOLVERS.GeneralizedAlpha, breaks=JUMPS)
    options, outputs = settings.timeIntegration, settings.solution
    assert (options.startTime, options.endTime, options.numberOfSteps) == (0.0, 1.2, 12)
    assert (outputs.file.writeInitialValues, outputs.sensors.append) == (True, False)
    assert float(mbs.systemData.GetODE2Coordinates_t(exu.ConfigurationType.Initial)[0]) == 10.0


def test_the_next_run_goes_on_from_the_end_if_it_is_asked_to():
    mbs, wheel, _ = brake()
    for start, end, jump in ((0.0, 0.7, JUMPS[0]), (0.7, 1.2, JUMPS[1])):
        solve_dynamic(mbs, fixed_steps(6, start, end), SOLVERS.GeneralizedAlpha, True, breaks=[jump])
    assert rate_of(mbs, wheel) == pytest.approx(exact(1.2), rel=1e-12)


@pytest.mark.parametrize(
    ("breaks", "message"),
    [
        ([0.4, 1.2], r"breaks\[1\] = 1.2 s: it must be within the run, from 0 to 1.2 s"),
        ([0.0], r"breaks\[0\] = 0 s: it must be within the run"),
        ([0.5, 0.5], r"breaks\[1\] = 0.5 s: it must be later than 0.5 s"),
        ([float("nan")], r"breaks\[0\] = nan"),
        (["0.4 s"], r"breaks = \['0.4 s'\]: it must contain only numbers"),
    ],
)
def test_invalid_breaks_are_refused(breaks, message):
    with pytest.raises(ValueError, match=message):
        solve_dynamic(brake()[0], fixed_steps(6), breaks=breaks)


@pytest.mark.parametrize("solver", [SOLVERS.TrapezoidalIndex2, SOLVERS.GeneralizedAlpha, SOLVERS.RK44])
def test_controllers_act_once_at_each_sample_and_hold_their_loads_between(solver):
    """A wheel of 2 kg m² with −3·ω N m from samples of 20 ms, and a brake of 1 N m in every other sample of 50 ms."""
    mbs = new_model()
    wheel = rotor(mbs, 2.0, 5.0)
    load, brake = (
        mbs.AddLoad(items.LoadCoordinate(markerNumber=coordinate(mbs, wheel), load=0.0)) for _ in range(2)
    )
    calls = []

    def control(mbs, t):
        calls.append(t)
        mbs.SetLoadParameter(load, "load", -3.0 * rate_of(mbs, wheel))

    def toggle(mbs, t):
        mbs.SetLoadParameter(brake, "load", -1.0 * (round(t / 0.05) % 2))

    solve_dynamic(mbs, settings_of(0.2, 200), solver, sampled={0.02: control, 0.05: toggle})
    assert calls == pytest.approx(np.arange(10) * 0.02, abs=1e-12)
    speed = 5.0
    for k in range(10):
        braked = max(0.0, min(0.1, 0.02 * k + 0.02) - max(0.05, 0.02 * k))
        braked += max(0.0, 0.02 * k + 0.02 - max(0.15, 0.02 * k))
        speed -= (3.0 * speed * 0.02 + braked) / 2.0
    assert rate_of(mbs, wheel) == pytest.approx(speed, rel=1e-9)


def test_a_controller_releases_a_locked_clutch_at_its_sample():
    mbs = new_model()
    wheel = rotor(mbs, 1.0, 0.0)
    brake = add_ring_friction(
        mbs, None, wheel, contact_radius=1.0, friction_coefficient=1.0, normal_load=10.0
    )
    drive(mbs, wheel, 4.0)
    loads = iter([10.0, 10.0, 3.0, 3.0])
    changes = solve_dynamic(
        mbs,
        settings_of(0.4, 400),
        SOLVERS.TrapezoidalIndex2,
        sampled={0.1: lambda mbs, t: brake.change(normal_load=next(loads))},
    )
    assert [(change.time, int(change.after)) for change in changes] == [(pytest.approx(0.2, abs=1e-9), 1)]
    assert rate_of(mbs, wheel) == pytest.approx(0.2, rel=1e-9)


def test_invalid_samples_are_refused():
    mbs = new_model()
    rotor(mbs, 1.0, 0.0)
    for sampled, message in (
        ({0.0: lambda mbs, t: None}, "sampled = 0"),
        ({1e-9: lambda mbs, t: None}, r"sampled = 1e-09 s: the run would take 1e\+08 samples"),
        ({0.1: 3}, r"sampled\[0.1\]"),
    ):
        with pytest.raises(ValueError, match=message):
            solve_dynamic(mbs, settings_of(0.1, 10), SOLVERS.RK44, sampled=sampled)
