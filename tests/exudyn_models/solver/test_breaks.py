"""Runs across jumps of a load."""

import exudyn as exu
import numpy as np
import pytest
from free_bodies import coordinates, rotor

from exudyn_models import add_ring_friction, solve_dynamic

SOLVERS = exu.DynamicSolverType
JUMPS = (0.4137, 0.9)


def load(time):
    """N in N: 2, then 7, then none."""
    return 2.0 if time < JUMPS[0] else 7.0 if time < JUMPS[1] else 0.0


def brake():
    """A rotor on the ground that slows down by R·μN/J = 0.25·N while it turns."""
    mbs = exu.SystemContainer().AddSystem()
    wheel = rotor(mbs, 0.2, 10.0)
    friction = add_ring_friction(
        mbs,
        None,
        wheel,
        contact_radius=0.1,
        friction_coefficient=lambda slip_speed: 0.5,
        normal_load=load,
        regularisation=0.1,
    )
    sensor = friction.add_sensor("relative_spin")
    mbs.Assemble()
    return mbs, wheel, sensor


def settings(steps, start=0.0, end=1.2):
    result = exu.SimulationSettings()
    result.solution.file.write = False
    options = result.timeIntegration
    options.startTime, options.endTime, options.numberOfSteps, options.verboseMode = start, end, steps, 0
    options.adaptiveStep = False
    return result


def exact(t):
    loads = np.array([2.0, 7.0, 0.0])
    edges = np.array([0.0, *JUMPS, np.inf])
    return 10.0 - 0.25 * float(loads @ np.clip(t - edges[:-1], 0.0, np.diff(edges)))


@pytest.mark.parametrize(
    "solver", [SOLVERS.GeneralizedAlpha, SOLVERS.TrapezoidalIndex2, SOLVERS.RK44, SOLVERS.ExplicitEuler]
)
@pytest.mark.parametrize("steps", [1, 7, 40])
def test_a_run_that_breaks_at_the_jumps_is_exact_and_one_that_does_not_is_wrong_by_its_step(solver, steps):
    ends = []
    for breaks in (JUMPS, ()):
        mbs, wheel, _ = brake()
        solve_dynamic(mbs, settings(steps), solver, breaks=breaks)
        ends.append(coordinates(mbs, wheel)[1][0] - exact(1.2))
    assert abs(ends[0]) < 1e-11
    assert abs(ends[1]) > 1e-3


def test_sensors_hold_all_parts_and_settings_and_initial_values_are_as_before():
    mbs, _, sensor = brake()
    options = settings(12)
    options.solution.sensors.writePeriod = 0.1
    for _ in range(2):
        solve_dynamic(mbs, options, SOLVERS.GeneralizedAlpha, breaks=JUMPS)
        times, spins = mbs.GetSensorStoredData(sensor).T
        assert (times[0], times[-1]) == (0.0, pytest.approx(1.2))
        assert (np.diff(times) > 0.0).all()
        assert np.diff(times).max() < 0.2  # what is due is written at the step after it
        np.testing.assert_allclose(spins, [exact(t) for t in times], rtol=1e-11)
    part = options.timeIntegration
    assert (part.startTime, part.endTime, part.numberOfSteps) == (0.0, 1.2, 12)
    assert options.solution.file.writeInitialValues
    assert not options.solution.sensors.append


def test_the_next_run_goes_on_from_the_end_if_it_is_asked_to():
    mbs, wheel, _ = brake()
    solve_dynamic(mbs, settings(6, 0.0, 0.7), SOLVERS.GeneralizedAlpha, True, breaks=JUMPS[:1])
    solve_dynamic(mbs, settings(6, 0.7, 1.2), SOLVERS.GeneralizedAlpha, True, breaks=JUMPS[1:])
    assert coordinates(mbs, wheel)[1][0] == pytest.approx(exact(1.2), rel=1e-12)


def test_settings_are_as_before_when_a_part_fails():
    mbs, *_ = brake()
    options = settings(6)

    def fail(mbs, t):
        if t > 0.5:
            raise ZeroDivisionError("a word of its own")
        return True

    mbs.SetPostStepUserFunction(fail)
    with pytest.raises(exu.ExudynError, match="a word of its own"):
        solve_dynamic(mbs, options, SOLVERS.GeneralizedAlpha, breaks=JUMPS)
    part = options.timeIntegration
    assert (part.startTime, part.endTime, part.numberOfSteps) == (0.0, 1.2, 6)
    assert float(mbs.systemData.GetODE2Coordinates_t(exu.ConfigurationType.Initial)[0]) == 10.0


@pytest.mark.parametrize(
    ("breaks", "message"),
    [
        ([0.4, 1.2], r"breaks\[1\] = 1.2 s: it must be within the run, from 0 to 1.2 s"),
        ([0.0], r"breaks\[0\] = 0 s: it must be within the run"),
        ([0.5, 0.4], r"breaks\[1\] = 0.4 s: it must be later than 0.5 s"),
        ([0.5, 0.5], r"breaks\[1\] = 0.5 s: it must be later than 0.5 s"),
        ([float("nan")], r"breaks\[0\] = nan"),
        (["0.4 s"], r"breaks\[0\] = '0.4 s'"),
    ],
)
def test_what_are_no_breaks_is_refused(breaks, message):
    mbs, *_ = brake()
    with pytest.raises(ValueError, match=message):
        solve_dynamic(mbs, settings(6), breaks=breaks)
