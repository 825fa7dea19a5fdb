"""A body on three feet with unequal shares: Exudyn against the reference, which locates every rest and release."""

import exudyn as exu
import numpy as np
import pytest
from free_bodies import new_model, planar_body, settings_of

from exudyn_models import add_ring_friction, solve_dynamic
from reference_model import DiscOnDisc, Points, simulate

FEET = Points([(0.05, 0.0, 0.5), (-0.03, 0.04, 0.2), (-0.02, -0.05, 0.3)])
BODY = DiscOnDisc(
    mass=1.0, polar_inertia=2e-3, stiffness=0.0, damping=0.0, friction_force=2.0, disc_speed=0.0,
    contact_radius=0.05, shaft_damping=0.0, shaft_speed=0.0,
)  # fmt: skip
THROWN = [0.0, 0.0, 0.3, 0.4, 0.2, 6.0]
LAW = {"friction_coefficient": 1.0, "normal_load": BODY.friction_force, "contact_points": FEET}


def end_in_exudyn(epsilon, steps):
    """Return x, y and the angle of the body on the ground after 0.4 s, and the changes of mode."""
    mbs = new_model()
    node = planar_body(mbs, BODY.mass, BODY.polar_inertia, THROWN[:3], THROWN[3:])
    add_ring_friction(mbs, None, node, regularisation=epsilon, **LAW)
    changes = solve_dynamic(mbs, settings_of(0.4, steps), exu.DynamicSolverType.TrapezoidalIndex2)
    place = mbs.GetNodeOutput(node, exu.OutputVariableType.Coordinates)
    return place + mbs.GetNodeParameter(node, "referenceCoordinates"), changes


@pytest.fixture(scope="module")
def exact():
    found = simulate(BODY, THROWN, [0.0, 0.4], contact=FEET, tolerance=1e-11)
    assert [phase.kind for phase in found.phases] == ["slip", "pivot", "stick"]
    return found


def test_body_that_slides_and_pivots_rests_where_it_does_in_the_reference(exact):
    """The error is of first order in ε, so the smaller ε leaves a ninth of the change; the bound is a quarter."""
    coarse, fine = (end_in_exudyn(epsilon, 8_000)[0] for epsilon in (1e-4, 1e-5))
    error = np.abs(fine - exact.states[-1, :3])
    assert np.all(error <= 0.25 * np.abs(coarse - fine))
    assert error.max() < 1e-6


def test_points_that_stick_exactly_pivot_and_rest_as_in_the_reference(exact):
    """One foot rests first, and the body pivots about it until the others rest.

    The error of the position is of second order; that of the first rest falls more slowly, because friction turns and
    shortens some steps. The error of the last rest changes its sign near 150 steps, so it has no order there.
    """
    times = [phase.start for phase in exact.phases[1:]]
    errors = []
    for steps in (400, 800):
        found, changes = end_in_exudyn(None, steps)
        assert sorted(change.point for change in changes) == [1, 2, 3]
        assert {change.after for change in changes} == {0}
        late = np.abs(np.unique([change.time for change in changes]) - times)
        errors.append([np.abs(found - exact.states[-1, :3]).max(), *late])
    assert np.max(errors[1]) < 1e-5  # m, rad or s
    (place, first, last), (finer_place, finer_first, finer_last) = errors
    assert place > 3.5 * finer_place
    assert first > 2.5 * finer_first
    assert max(last, finer_last) < 2e-7
