import cmath
import functools
import math
from dataclasses import replace
from functools import partial

import exudyn as exu
import numpy as np
import pytest
from free_bodies import coordinates, items, momenta, planar_body, rotor, run_explicitly
from plain_slip import slide

import reference_model
from compare.claims.paper_parameters import FIG5, FIG11
from exudyn_models import add_native_friction, simulate_with_native_contact
from exudyn_models.forces.friction_laws import point_regularisation
from exudyn_models.paper.models import build as models
from exudyn_models.parts import native_contact
from reference_model import plain
from reference_model.systems import DiscOnDisc

SLIPPING_PIN = [1.3, 0.0, 0.0, -1.3]  # never comes to rest
STICKING_PIN = [0.1, 0.0, 0.03, 0.0]  # Fig. 5, second start
DISC = replace(FIG11, contact_points=6)
TABLE_DISC = replace(
    DISC,
    polar_inertia=0.0144,
    stiffness=0.0,
    damping=0.0,
    friction_force=0.3,
    disc_speed=0.0,
    shaft_damping=0.0,
)
THROWN = [0.0, 0.0, 0.0, 0.5, 0.2, 3.0]  # turns about one of its points before it comes to rest
CONTACT = {
    "contact_radius": 0.0,
    "friction_coefficient": 1.0,
    "normal_load": 1.0,
    "regularisation": 1e-3,
    "contact_points": 1,
}
CAUGHT_DISC = replace(DISC, friction_force=0.2, offset=0.1)
CAUGHT = [0.1, 0.0, 0.0, 0.0, 0.1, 1.5]  # is carried along with the master disc for a while
CARRIED_ALONG = [
    0.03087753517369676, -0.12311233141527689, 5.686215448933846,
    0.18466849712291533, 0.04631630276054514, 1.5,
]  # fmt: skip
"""Where it is at 3.8 s, shortly before it is let go: rest is dear to simulate."""
RESTING = {
    "thrown": (TABLE_DISC, THROWN, 5.0),
    "caught": (CAUGHT_DISC, CAUGHT, 3.1),
    "let go": (CAUGHT_DISC, CARRIED_ALONG, 0.2),
}
"""System, start and span in s of motions in which points of a disc come to rest, or do so no more."""
SLIPPING_DISC = [0.05, 0.0, 0.0, 0.0, 0.05, 1.3]
TOLERANCES = (1e-6, 1e-7, 1e-8, 1e-9, 1e-10)


def viscous(disc, smallest):
    """Friction that is viscous where a point slips with less than ``smallest`` m/s."""
    return plain.on_ring(disc.friction_force, disc.contact_radius, disc.contact_points, smallest)


def errors_over_tolerances(system, start, times, expected):
    return np.array(
        [
            np.abs(
                simulate_with_native_contact(system, start, times, tolerance=tolerance).at_end - expected
            ).max()
            for tolerance in TOLERANCES
        ]
    )


def observed_order(errors):
    """Exponent of the tolerance, down to 1e-9: below that rounding counts, of angles of more than 100 rad at that."""
    count = min(len(errors), 4)
    return np.polyfit(np.log(TOLERANCES[:count]), np.log(errors[:count]), 1)[0]


@pytest.mark.parametrize("planar_master", [False, True])
@pytest.mark.parametrize(("radius", "points"), [(0.0, 1), (0.12, 6), (0.3, 3)])
@pytest.mark.parametrize(
    "regularisation", [1e-4, 1.5, 1e3]
)  # Coulomb friction, some of each, viscous friction
def test_forces_and_moments_of_both_bodies_are_those_of_the_law(
    planar_master, radius, points, regularisation
):
    rng = np.random.default_rng(1)
    for _ in range(10):
        mbs = exu.SystemContainer().AddSystem()
        motion = rng.normal(size=3).tolist(), rng.normal(size=3).tolist()
        master = planar_body(mbs, 2.0, 0.7, *motion) if planar_master else rotor(mbs, 0.7, motion[1][2])
        disc = planar_body(mbs, 1.0, 0.02, rng.normal(size=3).tolist(), rng.normal(size=3).tolist())
        add_native_friction(
            mbs,
            master,
            disc,
            friction_coefficient=0.25,
            normal_load=2.0,
            regularisation=regularisation,
            contact_radius=radius,
            contact_points=points,
            reach=10.0,
        )
        (x, y, angle), (vx, vy, spin) = at_start(mbs, disc)
        place, velocity = at_start(mbs, master)
        middle = complex(*place[:2]) if planar_master else 0j
        middle_velocity = complex(*velocity[:2]) if planar_master else 0j
        force, moment, master_moment = 0j, 0.0, 0.0
        for i in range(points):
            arm = radius * cmath.exp(1j * (angle + 2.0 * math.pi * i / points))
            point = complex(x, y) + arm - middle
            slip = complex(vx, vy) + 1j * spin * arm - middle_velocity - 1j * velocity[-1] * point
            friction = -0.5 / points * slip / max(abs(slip), regularisation)
            force += friction
            moment += (arm.conjugate() * friction).imag
            master_moment -= (point.conjugate() * friction).imag
        expected = [force.real / 1.0, force.imag / 1.0, moment / 0.02]
        expected_of_master = [master_moment / 0.7]
        if planar_master:
            expected_of_master = [-force.real / 2.0, -force.imag / 2.0, *expected_of_master]
        found, found_of_master = accelerations_at_start(mbs, disc, master)
        np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-11)
        np.testing.assert_allclose(found_of_master, expected_of_master, rtol=0.0, atol=1e-11)


def at_start(mbs, node):
    position, velocity = (
        mbs.GetNodeParameter(node, name) for name in ("initialCoordinates", "initialVelocities")
    )
    return position + mbs.GetNodeParameter(node, "referenceCoordinates"), velocity


def accelerations_at_start(mbs, *nodes):
    sensors = [
        mbs.AddSensor(
            items.SensorNode(
                nodeNumber=node,
                outputVariableType=exu.OutputVariableType.Coordinates_tt,
                storeInternal=True,
                writeToFile=False,
            )
        )
        for node in nodes
    ]
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = 1e-9, 1
    settings.timeIntegration.verboseMode = 0
    assert exu.MainSolverImplicitSecondOrder().SolveSystem(mbs, settings)
    return [mbs.GetSensorStoredData(sensor)[0, 1:] for sensor in sensors]


def test_two_free_discs_keep_their_momentum_and_angular_momentum_under_a_constant_normal_force():
    mbs = exu.SystemContainer().AddSystem()
    master = planar_body(mbs, 2.0, 0.7, [0.3, -0.2, 0.1], [0.1, 0.05, 2.0])
    disc = planar_body(mbs, 1.0, 0.02, [0.5, 0.1, 0.4], [-0.2, 0.3, -1.0])
    contacts = add_native_friction(
        mbs,
        master,
        disc,
        friction_coefficient=0.25,
        normal_load=2.0,
        regularisation=1e-3,
        contact_radius=0.12,
        contact_points=6,
        reach=10.0,
    )
    sensors = [
        mbs.AddSensor(
            items.SensorObject(
                objectNumber=contact,
                outputVariableType=exu.OutputVariableType.Force,
                storeInternal=True,
                writeToFile=False,
            )
        )
        for contact in contacts
    ]
    mbs.Assemble()
    bodies = [(master, 2.0, 0.7), (disc, 1.0, 0.02)]
    before, (_, velocity_before) = momenta(mbs, bodies), coordinates(mbs, master)
    run_explicitly(mbs, 3.0)
    _, velocity_after = coordinates(mbs, master)
    assert np.linalg.norm(velocity_after - velocity_before) > 0.1  # the contact did act
    np.testing.assert_allclose(momenta(mbs, bodies), before, rtol=1e-12, atol=1e-13)
    for sensor in sensors:
        forces = mbs.GetSensorStoredData(sensor)[1:, 1:]
        np.testing.assert_allclose(forces[:, 2], native_contact.NORMAL_FORCE / 6.0, rtol=1e-13)
        np.testing.assert_allclose(np.hypot(*forces.T[:2]), 0.5 / 6.0, rtol=1e-13)


def test_error_of_a_slipping_pin_falls_with_the_tolerance_and_stays_below_it():
    expected = reference_model.simulate(FIG5, SLIPPING_PIN, [0.0, 100.0], tolerance=1e-13).at_end
    errors = errors_over_tolerances(FIG5, SLIPPING_PIN, [0.0, 100.0], expected)
    assert np.all(errors < TOLERANCES), errors
    assert observed_order(errors) == pytest.approx(1.0, abs=0.1), errors


def test_error_of_a_slipping_disc_on_six_points_falls_with_the_tolerance_and_stays_below_it():
    exact = slide(DISC, SLIPPING_DISC, [0.0, 100.0]).y[:, -1]
    errors = errors_over_tolerances(DISC, SLIPPING_DISC, [0.0, 100.0], exact)
    assert np.all(errors < TOLERANCES), errors
    assert observed_order(errors) == pytest.approx(1.0, abs=0.1), errors


def test_stick_phases_of_a_pin_have_errors_of_first_order_in_the_regularisation():
    exact = reference_model.simulate(FIG5, STICKING_PIN, [0.0, 14.0], tolerance=1e-12)
    assert len(exact.stick_phases) == 2
    errors = []
    for tolerance in TOLERANCES[:4]:
        found = simulate_with_native_contact(FIG5, STICKING_PIN, [0.0, 14.0], tolerance=tolerance)
        assert [phase.kind for phase in found.phases] == [phase.kind for phase in exact.phases]
        errors.append(np.abs(found.stick_times - exact.stick_times))
    # The first touch comes before any creep; all later times carry the creep that went before.
    assert errors[-1][0] < 1e-9
    for order in (observed_order([error[i] for error in errors]) for i in (1, 2, 3)):
        assert order == pytest.approx(1.0, abs=0.1), errors


@functools.cache
def coming_to_rest(name, tolerance):
    disc, start, span = RESTING[name]
    return simulate_with_native_contact(disc, start, [0.0, span], tolerance=tolerance)


@pytest.mark.parametrize(("name", "tolerance"), [("thrown", 1e-7), ("caught", 1e-7), ("let go", 1e-6)])
def test_resting_points_of_a_disc_creep_as_an_integrator_for_stiff_equations_has_it(name, tolerance):
    found = coming_to_rest(name, tolerance)
    disc, start, span = RESTING[name]
    epsilon = found.solution.regularisation
    friction = viscous(disc, point_regularisation(epsilon, 6))
    run = slide(disc, start, [0.0, span], friction, method="Radau", rtol=1e-10, atol=1e-12)
    creeping = run.y[:, -1]
    # The steps make an error of one per cent of the creep, which is ε·t.
    assert found.at_end == pytest.approx(creeping, abs=0.01 * epsilon * span)


@pytest.mark.parametrize(
    ("name", "kinds", "least", "most"),
    [
        ("thrown", ["slip", "pivot", "stick"], 0.9, 1.1),
        ("caught", ["slip", "pivot", "slip", "stick"], 0.9, math.inf),
        # Single points hold on to Coulomb friction to the last: the slip after it grows like t² up to ε.
        ("let go", ["stick", "slip"], 0.35, 0.55),
    ],
)
def test_a_disc_comes_to_rest_and_is_let_go_with_errors_of_first_order_but_for_the_time_of_its_release(
    name, kinds, least, most
):
    disc, start, span = RESTING[name]
    exact = reference_model.simulate(disc, start, [0.0, span], tolerance=1e-11)
    assert [phase.kind for phase in exact.phases] == kinds
    states, times = [], []
    for tolerance in TOLERANCES[:2]:
        found = coming_to_rest(name, tolerance)
        assert [phase.kind for phase in found.phases] == kinds
        states.append(np.abs(found.at_end - exact.at_end).max())
        times.append(np.abs(found.stick_times - exact.stick_times).max())
    assert observed_order(states) == pytest.approx(1.0, abs=0.1), states
    assert least < observed_order(times) < most, times


@pytest.mark.parametrize(
    ("system", "span", "distance"),
    [
        # All on a table at rest, started from the middle straight towards an edge of the triangle with 1 m/s: a pin
        # without a spring after v·t − ½(μN/m)t², a pin on a spring just before it turns, a disc that does not spin.
        (replace(FIG5, stiffness=0.0), 10.0, 10.0 - 0.5 * 0.01 * 10.0**2),
        (FIG5, 1.5, math.sin(1.5) - 0.01 * (1.0 - math.cos(1.5))),
        (replace(DISC, stiffness=0.0, contact_radius=0.5), 1.0, 1.0 - 0.5 * 0.01),
    ],
)
def test_the_contact_holds_however_far_a_body_goes(system, span, distance):
    system = replace(system, friction_force=0.01, damping=0.0, disc_speed=0.0, offset=0.0)
    start = [0.0, 0.0, -1.0, 0.0]
    if isinstance(system, DiscOnDisc):
        system, start = replace(system, shaft_damping=0.0), [0.0, 0.0, 0.0, -1.0, 0.0, 0.0]
    found = simulate_with_native_contact(system, start, [0.0, span])
    assert found.at_end[:2] == pytest.approx([-distance, 0.0], abs=1e-9)


def test_a_friction_coefficient_that_is_wrong_by_1e_8_is_seen(monkeypatch):
    expected = reference_model.simulate(FIG5, SLIPPING_PIN, [0.0, 100.0], tolerance=1e-13).at_end
    contact = items.ObjectContactSphereTriangle

    def wrong(**arguments):
        return contact(**arguments | {"dynamicFriction": (1.0 + 1e-8) * arguments["dynamicFriction"]})

    monkeypatch.setattr(native_contact.items, "ObjectContactSphereTriangle", wrong)
    found = simulate_with_native_contact(FIG5, SLIPPING_PIN, [0.0, 100.0], tolerance=1e-10)
    assert np.abs(found.at_end - expected).max() > 10.0 * 1e-10


@pytest.mark.parametrize(
    ("system", "state"), [(FIG5, np.array(SLIPPING_PIN)), (DISC, np.array(SLIPPING_DISC))]
)
def test_no_user_function_takes_part_in_the_friction(system, state):
    friction = partial(add_native_friction, reach=10.0)
    model = models.build(system, state, regularisation=1e-7, friction=friction)
    mbs = model.mbs
    objects = [mbs.GetObject(i) for i in range(mbs.systemData.NumberOfObjects())]
    assert sum("trianglePoints" in item for item in objects) == (1 if system is FIG5 else 6)
    for item in objects:
        assert not any(value for name, value in item.items() if "UserFunction" in name), item


def test_the_solution_names_the_contact_and_its_regularisation():
    solution = simulate_with_native_contact(FIG5, SLIPPING_PIN, [0.0, 1.0], tolerance=1e-8).solution
    assert solution.method == "Exudyn DOPRI5, generalised-α while sticking, built-in contact"
    assert solution.tolerance == 1e-8
    assert solution.regularisation == pytest.approx(1e-6 * FIG5.disc_speed * SLIPPING_PIN[0])


@pytest.mark.parametrize(
    ("system", "start"), [(FIG5, [0.1, 0.0, 0.0, 0.0]), (FIG5, [0.0] * 4), (DISC, [0.0] * 6)]
)
def test_one_time_gives_the_initial_state(system, start):
    trajectory = simulate_with_native_contact(replace(system, offset=0.0), start, [2.0])
    np.testing.assert_array_equal(trajectory.states, [start])


def test_states_within_a_step_of_the_start_are_those_of_the_reference():
    # The branch of the law at the start is that of the initial slip: here friction is viscous there.
    start = [-0.06, -0.015, 0.0225, -0.09]
    times = np.linspace(0.0, 1e-3, 11)
    expected = reference_model.simulate(FIG5, start, times).states
    found = simulate_with_native_contact(FIG5, start, times, tolerance=1e-10)
    assert [phase.kind for phase in found.phases] == ["stick"]
    np.testing.assert_allclose(found.states, expected, rtol=0.0, atol=found.solution.regularisation)


@pytest.mark.parametrize(
    ("system", "change", "message"),
    [
        (
            replace(DISC, contact_points=None),
            {},
            "contact_points = None: Exudyn's built-in contact has single",
        ),
        (FIG5, {"initial_state": [0.0, 0.0, 0.0]}, "initial_state has shape"),
        (FIG5, {"initial_state": [0.0, np.nan, 0.0, 0.0]}, r"initial_state\[1\] = nan"),
        (FIG5, {"times": [1.0, 0.0]}, "times must increase"),
        (FIG5, {"times": []}, "at least one time"),
        (FIG5, {"tolerance": 0.0}, "tolerance = 0"),
    ],
)
def test_bad_input_is_refused_in_a_sentence(system, change, message):
    start = SLIPPING_PIN if system is FIG5 else SLIPPING_DISC
    arguments = {"initial_state": start, "times": [0.0, 1.0]} | change
    with pytest.raises(ValueError, match=message):
        simulate_with_native_contact(system, **arguments)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"friction_coefficient": -1.0}, "friction_coefficient = -1: it must be >= 0"),
        ({"normal_load": -1.0}, "normal_load = -1 N: it must be >= 0"),
        ({"contact_radius": -0.1}, "contact_radius = -0.1 m"),
        ({"contact_points": 2.5}, "contact_points = 2.5"),
        ({"contact_points": None, "contact_radius": 0.1}, "contact_points = None"),
        ({"regularisation": 0.0}, "regularisation = 0 m/s"),
        ({"reach": 0.0}, "reach = 0 m: it must be > 0"),
        ({"reach": math.nan}, "reach = nan"),
    ],
)
def test_nonsense_is_refused_with_its_name_and_value(change, message):
    mbs = exu.SystemContainer().AddSystem()
    master, disc = rotor(mbs, 1.0, 0.0), planar_body(mbs, 1.0, 1.0, [0.0] * 3, [0.0] * 3)
    arguments = CONTACT | {"reach": 1.0} | change
    with pytest.raises(ValueError, match=message):
        add_native_friction(mbs, master, disc, **arguments)


def test_a_node_of_the_wrong_kind_is_refused_with_the_kinds_that_serve():
    mbs = exu.SystemContainer().AddSystem()
    master = rotor(mbs, 1.0, 0.0)
    with pytest.raises(ValueError, match="disc_node 0 is a Node1D: it must be a NodeRigidBody2D"):
        add_native_friction(mbs, master, master, **CONTACT, reach=1.0)
