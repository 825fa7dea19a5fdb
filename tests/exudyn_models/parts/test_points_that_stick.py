"""One contact at several points that stick exactly: its loads, sensors, modes and refusals."""

import exudyn as exu
import numpy as np
import pytest
from free_bodies import ball, coordinate, items, new_model, planar_body, settings_of
from scipy.integrate import solve_ivp
from test_orientations import ACROSS, AXES, REVERSED

from exudyn_models import add_ring_friction, solve_dynamic
from exudyn_models.solver.items import IN_MEMORY
from reference_model import Points
from reference_model.contact import largest_wrench

SOLVER = exu.DynamicSolverType.TrapezoidalIndex2
GENERALISED = exu.DynamicSolverType.GeneralizedAlpha
FEET = [(0.05, 0.0, 0.5), (-0.03, 0.04, 0.2), (-0.02, -0.05, 0.3)]
TWO_FEET = [(0.06, 0.0, 0.7), (0.0, 0.02, 0.3)]
MASS, INERTIA, FRICTION = 1.0, 2e-3, 2.0
LAW = {"friction_coefficient": 0.2, "contact_points": FEET}
SENSORS = "transmitted_moment", "radial_force", "power", "mode", "capacity_share", "centre_slip"
REST = [0.0] * 3


def body_on_feet(velocity=REST, angle=0.0, **options):
    """Return a model of a body on feet, its node and its contact."""
    mbs = new_model()
    node = planar_body(mbs, MASS, INERTIA, [0.0, 0.0, angle], velocity)
    return mbs, node, add_ring_friction(mbs, None, node, **LAW | {"normal_load": 10.0} | options)


def push(mbs, node, load, size):
    """Push the body with ``size`` (time) times a force (N) and a moment (N m)."""
    for place, share in enumerate(load):
        marker = coordinate(mbs, node, place)
        mbs.AddLoad(
            items.LoadCoordinate(
                markerNumber=marker, loadUserFunction=lambda mbs, t, _, share=share: share * size(t)
            )
        )


def run(mbs, end, steps=100, **options):
    return solve_dynamic(mbs, settings_of(end, steps), SOLVER, **options)


@pytest.mark.parametrize(
    ("load", "plates"), [([1.0, 0.0, 0.01], 1), ([0.3, -0.4, -0.05], 2), ([0.0, 0.0, 0.1], 1)]
)
def test_feet_hold_a_load_up_to_their_limit_surface(load, plates):
    """The sensors show the load and its share of the capacity. Beyond static friction the body slides."""
    angle, ratio = 0.7, 1.25
    on_feet = complex(*load[:2]) * np.exp(-1j * angle)
    force, moment = largest_wrench(Points(FEET), on_feet, load[2])
    largest = np.linalg.norm([force.real, force.imag, moment]) / np.linalg.norm(load)
    size = FRICTION * plates * largest
    mbs, node, contact = body_on_feet(angle=angle, static_ratio=ratio, plates=plates)
    sensors = [contact.add_sensor(one) for one in ("transmitted_moment", "radial_force", "capacity_share")]
    push(mbs, node, load, lambda t: size * t)
    assert run(mbs, 1.0, 50, updateInitialValues=True) == []
    held, pushed, share = (mbs.GetSensorValues(sensor) for sensor in sensors)
    assert [*pushed[:2], float(held)] == pytest.approx(-size * np.array(load), abs=1e-12)
    assert float(share) == pytest.approx(1.0 / ratio, rel=1e-6)
    changes = solve_dynamic(mbs, settings_of(1.5, 25, start=1.0), SOLVER)
    assert len(changes) > 1
    first, second, *_ = (
        change.time for change in changes
    )  # the body may pivot about the third foot for a while
    assert [first, second] == pytest.approx([ratio, ratio], abs=1e-6)
    assert {change.contact for change in changes} == {int(contact.item)}


@pytest.mark.parametrize("spin", [6.0, -1e-6])  # the second changes its sign
def test_sensors_of_sliding_points_show_the_sums_and_follow_a_changed_load(spin):
    shown = []
    for epsilon in (None, 1e-9):
        mbs, node, contact = body_on_feet([0.4, 0.2, spin], regularisation=epsilon)
        push(mbs, node, [0.0, 0.0, 1.0], lambda t: 1.0)
        sensors = [contact.add_sensor(one) for one in SENSORS]
        contact.change(normal_load=20.0)
        run(mbs, 1e-6, 1)
        shown.append(np.concatenate([np.atleast_1d(mbs.GetSensorValues(sensor)) for sensor in sensors]))
    np.testing.assert_allclose(*shown, rtol=1e-9, atol=1e-12)


def test_points_without_load_use_no_share_of_their_capacity():
    mbs, _, contact = body_on_feet(normal_load=0.0)
    share = contact.add_sensor("capacity_share")
    run(mbs, 1e-6, 1)
    assert mbs.GetSensorValues(share) == 0.0


def test_sensors_show_modes_and_heat_of_a_body_that_slides_pivots_and_rests():
    motion = [0.2, 0.3, -4.0]
    mbs, _, contact = body_on_feet(motion)
    mode, share, heat = (contact.add_sensor(one) for one in ("mode", "capacity_share", "heat"))
    first, *others = run(mbs, 0.4, 400)
    times, modes = mbs.GetSensorStoredData(mode).T
    assert (first.point, first.time) == (1, pytest.approx(0.1131, abs=1e-4))
    assert (modes[times < others[-1].time - 1e-9] == -1).all()  # it pivots after the first change
    assert modes[-1] == 0
    shares = mbs.GetSensorStoredData(share)[:, 1]
    np.testing.assert_allclose(shares[times < others[-1].time - 1e-9], 1.0)
    assert shares[-1] == pytest.approx(0.0, abs=1e-9)
    energy = MASS * (motion[0] ** 2 + motion[1] ** 2) / 2.0 + INERTIA * motion[2] ** 2 / 2.0
    assert float(mbs.GetSensorValues(heat)) == pytest.approx(energy, rel=1e-5)


@pytest.mark.parametrize("axes", [AXES[0], REVERSED, ACROSS, AXES[9]])
def test_points_lie_where_the_regularised_contact_has_them_for_any_axes_of_the_disc(axes):
    ends = []
    for epsilon in (None, 1e-7):
        mbs = new_model()
        disc = ball(
            mbs, exu.NodeType.RotationRxyz, MASS, INERTIA, REST, [0.4, 0.2, 0.0], [0.0, 0.0, 6.0], axes
        )
        add_ring_friction(mbs, None, disc, normal_load=10.0, regularisation=epsilon, **LAW)
        run(mbs, 0.05)
        ends.append(mbs.systemData.GetODE2Coordinates_t())
    np.testing.assert_allclose(*ends, rtol=0.0, atol=1e-8)


@pytest.mark.parametrize(("feet", "solver"), [(FEET, SOLVER), (TWO_FEET, GENERALISED)])
def test_points_under_the_reaction_of_the_joint_on_their_axis_stick_and_slide_together(feet, solver):
    """The net force of the points loads the joint, whose reaction loads the points."""
    weight, coefficient, inertia, spin, rate = 40.0, 0.4, 0.02, 3.0, 3.0
    arms, shares = np.array([complex(x, y) for x, y, _ in feet]), np.array([share for *_, share in feet])
    mbs = new_model()
    node = planar_body(mbs, 4.0, inertia, REST, [0.0, 0.0, spin])
    ends = [
        mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=body))
        for body in (mbs.AddObject(items.ObjectGround()), exu.ObjectIndex(0))
    ]
    joint = mbs.AddObject(items.GenericJoint(markerNumbers=ends, constrainedAxes=[1, 1, 0, 0, 0, 0]))
    force = exu.OutputVariableType.ForceLocal
    reaction = mbs.AddSensor(items.SensorObject(objectNumber=joint, outputVariableType=force, **IN_MEMORY))
    contact = add_ring_friction(
        mbs,
        *ends,
        contact_points=feet,
        friction_coefficient=coefficient,
        normal_load=lambda: float(np.linalg.norm(mbs.GetSensorValues(reaction))),
    )
    shown = [contact.add_sensor(one) for one in ("transmitted_moment", "radial_force", "capacity_share")]
    push(mbs, node, [weight, 0.0, 0.0], lambda t: 1.0)
    push(mbs, node, [0.0, 0.0, rate], lambda t: max(0.0, t - 0.5))

    def friction(angle):
        """Return force and moment under the load N = |W − μN·q|, with q the mean direction of slip."""
        slip = shares @ (1j * arms / abs(arms)) * np.exp(1j * angle)
        squares = 1.0 - abs(coefficient * slip) ** 2, 2.0 * weight * coefficient * slip.real, -(weight**2)
        return -coefficient * max(np.roots(squares)) * np.array([slip.real, slip.imag, shares @ abs(arms)])

    def stop(t, motion):
        return motion[1]

    stop.terminal = True
    motion = solve_ivp(
        lambda t, motion: [motion[1], friction(motion[0])[2] / inertia],
        (0.0, 0.5),
        [0.0, spin],
        rtol=1e-10,
        atol=1e-12,
        events=stop,
    )
    largest = friction(motion.y[0, -1])
    changes = solve_dynamic(mbs, settings_of(0.49, 490), solver, updateInitialValues=True)
    assert mbs.GetSensorValues(shown[2]) == pytest.approx(0.0, abs=1e-9)
    end = 0.5 - largest[2] / rate
    changes += solve_dynamic(mbs, settings_of(end + 1e-3, 490, start=0.49), solver)
    assert [(change.time, change.after, change.point) for change in changes] == [
        (pytest.approx(motion.t[-1], abs=1e-6), 0, None),
        (pytest.approx(end, abs=1e-6), 1, None),
    ]
    moment, force = (mbs.GetSensorValues(sensor) for sensor in shown[:2])
    assert [*force[:2], float(moment)] == pytest.approx(largest, rel=1e-4)


def test_points_that_begin_to_slide_together_keep_their_directions():
    """Nearly regularised friction in SciPy has the motion of a body that loads on its centre set in motion."""
    start, rates = np.array([1.4985, 1.2097, -0.0414]), np.array([19.345, 11.409, 1.6084])
    mbs, inertia = new_model(), 0.02
    node = planar_body(mbs, MASS, inertia, REST, REST)
    add_ring_friction(mbs, None, node, normal_load=10.0, **LAW)
    for load, growth in ((start, lambda t: 1.0), (rates, lambda t: t)):
        push(mbs, node, load, growth)

    def accelerations(t, motion):
        load = start + rates * t
        for x, y, share in FEET:
            arm = complex(x, y) * np.exp(1j * motion[2])
            slip = complex(*motion[3:5]) + 1j * motion[5] * arm
            force = -FRICTION * share * slip / np.hypot(abs(slip), 1e-9)
            load = load + np.array([force.real, force.imag, (arm.conjugate() * force).imag])
        return [*motion[3:], *load / [MASS, MASS, inertia]]

    exact = solve_ivp(accelerations, (0.0, 0.01), np.zeros(6), "Radau", rtol=1e-8, atol=1e-12).y[3:, -1]
    assert run(mbs, 0.01, 20) == []
    assert mbs.systemData.GetODE2Coordinates_t() == pytest.approx(exact, abs=1e-6)


def test_a_deleted_contact_releases_all_points():
    mbs, node, contact = body_on_feet()
    push(mbs, node, [1.0, 0.0, 0.0], lambda t: 1.0)
    assert run(mbs, 0.1) == []
    mbs.DeleteObject(contact.item, deleteDependentItems=False)
    run(mbs, 0.1)
    assert mbs.systemData.GetODE2Coordinates_t() == pytest.approx([0.1 / MASS, 0.0, 0.0])


def test_a_single_point_off_the_centre_sticks_there():
    """A body that swings about its only point keeps its spin, because a point exerts no moment about itself."""
    mbs = new_model()
    node = planar_body(mbs, MASS, INERTIA, REST, [0.0, -0.3, 3.0])
    law = {"contact_radius": 0.1, "contact_points": 1, "friction_coefficient": 1.0}
    add_ring_friction(mbs, None, node, normal_load=10.0, **law)
    assert run(mbs, 0.4, 400) == []
    vx, vy, spin = mbs.systemData.GetODE2Coordinates_t()
    assert spin == pytest.approx(3.0, rel=1e-5)
    assert [vx, vy] == pytest.approx([0.3 * np.sin(1.2), -0.3 * np.cos(1.2)], abs=1e-4)


def test_points_with_a_load_of_radius_or_with_one_that_is_held_are_refused():
    with pytest.raises(ValueError, match=r"contact_points = 3: .* need a regularisation"):
        body_on_feet(held=2)
    with pytest.raises(ValueError, match=r"contact_points = 3: .* need a regularisation"):
        body_on_feet(normal_load=lambda radius: 1.0 + radius)
    mbs, _, contact = body_on_feet([0.4, 0.2, 6.0])
    moment = contact.add_sensor("transmitted_moment")
    run(mbs, 1e-6, 1)
    before = float(mbs.GetSensorValues(moment))
    with pytest.raises(ValueError, match=r"contact_points = 3: .* need a regularisation"):
        contact.change(friction_coefficient=lambda radius: 0.3, normal_load=20.0)
    run(mbs, 1e-6, 1)
    assert float(mbs.GetSensorValues(moment)) == before


def test_all_points_of_a_body_begin_to_slide_from_rest_without_ever_smaller_steps():
    """Its points lose their first slips together, because the loss at one of them changes the slips of the others."""
    for seed in range(12, 22):
        random = np.random.default_rng(seed)
        load = [*random.normal(size=2), 0.03 * random.normal()]
        speeds = []
        for step in (1e-3, 5e-4):
            mbs, node, _ = body_on_feet()
            push(mbs, node, load, lambda t: 6.0 + t)
            solve_dynamic(mbs, settings_of(0.02, round(0.02 / step)), SOLVER)
            speeds.append(mbs.systemData.GetODE2Coordinates_t())
        assert speeds[0] == pytest.approx(speeds[1], abs=1e-5)
