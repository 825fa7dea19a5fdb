"""Runs across jumps of a load."""

import exudyn as exu
import numpy as np
import pytest
from free_bodies import new_model, rate_of, rotor, settings_of

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
