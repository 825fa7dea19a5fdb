"""Explicit steps while contacts stick: models lose energy above the reported limit, but not below it."""

import itertools
import math
import warnings

import exudyn as exu
import numpy as np
import pytest
from free_bodies import (
    all_states,
    coordinate,
    drive,
    items,
    new_model,
    node_sensor,
    planar_body,
    rate_of,
    rotor,
    settings_of,
    spatial_body,
)

from exudyn_models import (
    add_energy_balance,
    add_radial_support,
    add_ring_friction,
    largest_stable_step,
    solve_dynamic,
)
from exudyn_models.forces.friction_laws import (
    CONTINUOUS,
    NONE_HELD,
    friction_of,
)
from exudyn_models.forces.laws.places import point_regularisation, ring_places, table_of
from exudyn_models.forces.stick_dampers import slip_dampers
from exudyn_models.solver.checks.step_limit import INTERVALS

SOLVERS = exu.DynamicSolverType

INERTIA, MASS, RADIUS, FRICTION, EPSILON = 0.01, 0.8, 0.1, 100.0, 1e-2
CONTACT = {"friction_coefficient": 1.0, "normal_load": FRICTION, "regularisation": EPSILON}
RING = CONTACT | {"contact_radius": RADIUS}
WITHOUT_NEIGHBOURS = INTERVALS["RK44"] * INERTIA * EPSILON / (FRICTION * RADIUS**2)
"""The limit in s of RK44 that would hold if the inertia of one rotor alone counted."""


def settings(step, steps):
    return settings_of(step * steps, steps)


def swing(t):
    return math.sin(2.0 * math.pi * 10.0 * t)


def row_of_rotors(count, **contact):
    """Return a model of equal rotors with equal speeds, each with friction on the next, and its contacts."""
    mbs = new_model()
    nodes = [rotor(mbs, INERTIA, 10.0) for _ in range(count)]
    contacts = [add_ring_friction(mbs, *pair, **RING | contact) for pair in itertools.pairwise(nodes)]
    drive(mbs, nodes[0], swing)  # moves the first one slightly relative to the others
    return mbs, nodes, contacts


def lost_energy(mbs, nodes, contacts, step):
    """Return the residual of the energy balance after 0.2 s, divided by the turnover."""
    read = add_energy_balance(
        mbs,
        gains={"torque": lambda mbs, t: swing(t) * rate_of(mbs, nodes[0])},
        losses={f"contact {i}": contact.power for i, contact in enumerate(contacts)},
    )
    mbs.Assemble()
    mbs.SolveDynamic(settings(step, math.ceil(0.2 / step)), SOLVERS.RK44)
    balance = read()
    return np.max(np.abs(balance.residual)) / balance.turnover


@pytest.mark.parametrize("count", [2, 4])
@pytest.mark.filterwarnings("ignore:the energy balance is off")  # the steps are too long on purpose
def test_rotors_in_a_row_lose_energy_beyond_the_limit_and_none_below(count):
    """As in a chain of masses, the fastest decay of equal inertias in a row is (μN/ε)·(R²/J)·(2 + 2cos(π/n))."""
    limit = largest_stable_step(row_of_rotors(count)[0], SOLVERS.RK44)
    assert limit == pytest.approx(WITHOUT_NEIGHBOURS / (2.0 + 2.0 * math.cos(math.pi / count)), rel=1e-9)
    below, beyond = (lost_energy(*row_of_rotors(count), share * limit) for share in (0.97, 1.03))
    assert below < 1e-9
    assert beyond > 0.1


def motion_of(mbs, node, solver, step, steps):
    """Return all velocities of ``node``, and its coordinates, at the start and after each of ``steps``."""
    variables = exu.OutputVariableType.Coordinates_t, exu.OutputVariableType.Coordinates
    sensors = [node_sensor(mbs, node, variable) for variable in variables]
    mbs.Assemble()
    given = settings(step, steps)
    given.solution.sensors.writePeriod = step
    mbs.SolveDynamic(given, solver)
    return [mbs.GetSensorStoredData(sensor)[:, 1:] for sensor in sensors]


@pytest.mark.parametrize("solver", INTERVALS)
def test_each_solver_decays_up_to_its_interval_and_not_beyond(solver):
    for share, decays in ((0.98, True), (1.02, False)):
        mbs = new_model()
        node = rotor(mbs, 1.0, 1.0)
        markers = [coordinate(mbs, None), coordinate(mbs, node)]
        mbs.AddObject(items.ObjectConnectorCoordinateSpringDamper(markerNumbers=markers, damping=1.0))
        speeds = motion_of(mbs, node, getattr(SOLVERS, solver), share * INTERVALS[solver], 200)[0]
        change = np.abs(speeds[150:]).max() / np.abs(speeds[100:150]).max()
        assert change < 0.5 if decays else change > 2.0


def two_discs(place, velocity, **contact):
    """Return a planar master at rest, a planar disc at ``place`` from it and their friction."""
    mbs = new_model()
    master = planar_body(mbs, 2.0 * MASS, 3.0 * INERTIA, [0.0] * 3, [0.0] * 3)
    disc = planar_body(mbs, MASS, INERTIA, [*place, 0.3], velocity)
    return mbs, disc, add_ring_friction(mbs, master, disc, **RING | contact)


@pytest.mark.parametrize(
    ("contact", "by_hand"),
    [
        ({"contact_radius": 0.05}, 1.5 / MASS),
        ({"contact_radius": 0.15, "contact_points": 24}, 4.0 / 3.0 * 0.15**2 / INERTIA),
        # The moment of a full disc is that of a ring at 2/3 of its radius.
        ({"contact_radius": None, "inner_radius": 0.0, "outer_radius": 0.3}, 4.0 / 3.0 * 0.2**2 / INERTIA),
    ],
    ids=["small ring", "points", "annulus"],
)
def test_the_limit_of_two_discs_depends_on_the_inertias_along_the_contact(contact, by_hand):
    for velocity in ([0.0, 0.0, 0.0], [0.3, -0.2, 5.0]):  # stuck or slipping
        mbs, _, _ = two_discs([0.0, 0.0], velocity, **contact)
        expected = INTERVALS["RK44"] / (FRICTION / EPSILON * by_hand)
        assert largest_stable_step(mbs, SOLVERS.RK44) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("kind", [items.NodeRigidBodyRotVecLG, items.NodeRigidBodyRxyz])
def test_spatial_and_planar_bodies_have_the_same_limit(kind):
    """The master turns about its own axis at the distance d, which adds d²/J to 1/m across that distance."""
    place, velocity = [0.06, -0.08], [0.2, 0.1, 3.0]
    flat = largest_stable_step(two_discs(place, velocity)[0], SOLVERS.RK67)
    mbs = new_model()
    inertia, flat_place = np.array([INERTIA] * 3), [*place, 0.0, 0.0, 0.0, 0.3]
    master = spatial_body(mbs, kind, 2.0 * MASS, (inertia * [1.0, 1.0, 3.0]).tolist(), [0.0] * 6, [0.0] * 6)
    disc = spatial_body(mbs, kind, MASS, inertia.tolist(), flat_place, [0.2, 0.1, 0.0, 0.0, 0.0, 3.0])
    add_ring_friction(mbs, master, disc, **RING)
    assert largest_stable_step(mbs, SOLVERS.RK67) == pytest.approx(flat, rel=1e-6)
    assert flat < 0.9 * largest_stable_step(two_discs([0.0, 0.0], velocity)[0], SOLVERS.RK67)


def test_a_shaft_with_its_damper_adds_to_the_contact():
    mbs, disc, _ = two_discs([0.0, 0.0], [0.0] * 3, contact_radius=0.0)
    add_radial_support(mbs, None, disc, stiffness=1e3, damping=3000.0)
    d, b = FRICTION / EPSILON, 3000.0
    by_hand = np.linalg.eigvals(np.diag([0.5 / MASS, 1.0 / MASS]) @ [[d, -d], [-d, d + b]]).max()
    assert largest_stable_step(mbs, SOLVERS.RK33) == pytest.approx(INTERVALS["RK33"] / by_hand, rel=1e-9)


def test_a_disc_that_pivots_about_a_point_has_the_limit_of_that_point():
    """The point rests with less than its share of friction, while the others slip at 100·ε."""
    points, inertia = 3, MASS * RADIUS**2
    delta = point_regularisation(EPSILON, ring_places(RADIUS, points))
    stuck = FRICTION / points / delta * (1.0 / MASS + RADIUS**2 / inertia)
    for factor, rests in ((0.9, True), (1.2, False)):
        mbs = new_model()
        master = rotor(mbs, 1e9, 0.0)
        spin = 100.0 * EPSILON / RADIUS
        # Point 0 of the disc is at (R, 0); the disc turns about it.
        disc = planar_body(mbs, MASS, inertia, [0.0] * 3, [1e-3 * EPSILON, -spin * RADIUS, spin])
        add_ring_friction(mbs, master, disc, **RING | {"contact_points": points})
        mbs.Assemble()
        limit = largest_stable_step(mbs, SOLVERS.RK44)
        assert limit == pytest.approx(INTERVALS["RK44"] / stuck, rel=1e-6)
        (vx, vy, spin), (_, _, angle) = (
            part.T for part in motion_of(mbs, disc, SOLVERS.RK44, factor * limit, 100)
        )
        slip = np.hypot(vx - spin * RADIUS * np.sin(angle), vy + spin * RADIUS * np.cos(angle))
        # Creep falls as the disc becomes slower; chatter as large as friction would show as a jump at every step.
        jumps = np.abs(np.diff(slip[20:])) / delta
        assert jumps.max() < 0.005 if rests else jumps.mean() > 0.03


def warned(mbs, *arguments):
    """Return the warnings of a run."""
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        solve_dynamic(mbs, *arguments)
    return [str(warning.message) for warning in told]


@pytest.mark.parametrize("solver", ["ExplicitEuler", "RK44", "VelocityVerlet"])
def test_only_a_step_beyond_the_limit_causes_a_warning_before_the_run(solver):
    limit = INTERVALS[solver] / INTERVALS["RK44"] * WITHOUT_NEIGHBOURS / 2.0
    kind = getattr(SOLVERS, solver)
    assert not warned(row_of_rotors(2)[0], settings(0.9995 * limit, 1000), kind)
    (told,) = warned(row_of_rotors(2)[0], settings(1.0005 * limit, 1000), kind)
    assert told.startswith(f"{solver} with steps of {1.0005 * limit:.3g} s is unstable while the contacts")
    assert f"t = 0 s the limit is {limit:.3g} s: use numberOfSteps >= 1,001, a larger" in told
    assert not warned(row_of_rotors(2)[0], settings(limit * 1000 / 1001, 1001), kind)


@pytest.mark.parametrize("solver", ["DOPRI5", "GeneralizedAlpha", "TrapezoidalIndex2"])
def test_a_solver_or_a_model_without_that_limit_is_left_alone(solver):
    mbs, _, _ = row_of_rotors(2)
    assert not warned(mbs, settings(10.0 * WITHOUT_NEIGHBOURS, 10), getattr(SOLVERS, solver))
    message = f"solver_type = {solver}: it must be explicit with a fixed step: ExplicitEuler"
    with pytest.raises(ValueError, match=message):
        largest_stable_step(mbs, getattr(SOLVERS, solver))
    alone = new_model()
    rotor(alone, 1.0, 1.0)
    assert largest_stable_step(alone, SOLVERS.RK44) == math.inf
    assert not warned(alone, settings(1.0, 10), SOLVERS.RK44)


@pytest.mark.parametrize("what", ["normal_load", "friction_coefficient"])
def test_a_growing_load_or_coefficient_causes_a_warning_at_the_limit(what):
    """The warning comes within 1 % of the run; the limit at time 0 would be four times the step."""
    step = WITHOUT_NEIGHBOURS / 2.0
    growing = {what: lambda time: CONTACT[what] * (0.25 + time / (1000.0 * step))}
    (told,) = warned(row_of_rotors(2, **growing)[0], settings(step, 1000), SOLVERS.RK44)
    assert 0.75 <= float(told.split("t = ")[1].split(" s")[0]) / (1000.0 * step) <= 0.765
    assert not warned(row_of_rotors(2, **growing)[0], settings(0.75 * step, 1000), SOLVERS.RK44)


@pytest.mark.parametrize(
    "load", [FRICTION, lambda time: FRICTION * (time > 0.0)], ids=["before", "in the run"]
)
def test_a_warning_turned_into_an_error_ends_the_run_unchanged(load):
    mbs, _, _ = row_of_rotors(2, normal_load=load)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(RuntimeWarning, match=r"RK44 with steps of .* is unstable"):
            solve_dynamic(mbs, settings(WITHOUT_NEIGHBOURS, 100), SOLVERS.RK44)


def test_the_look_at_a_model_leaves_its_run_and_its_sensors_as_they_are():
    stored = []
    for solve in (exu.MainSystem.SolveDynamic, solve_dynamic):
        mbs, _, (contact,) = row_of_rotors(2, normal_load=lambda time: FRICTION * (1.0 + time))
        sensor = contact.add_sensor("heat")
        mbs.Assemble()
        solve(mbs, settings(0.4 * WITHOUT_NEIGHBOURS, 500), SOLVERS.RK44)
        stored.append((mbs.GetSensorStoredData(sensor).tolist(), all_states(mbs).tolist()))
    assert stored[0] == stored[1]


@pytest.mark.parametrize(
    ("points", "inner", "held"),
    [(CONTINUOUS, inner, NONE_HELD) for inner in (1.0, 0.7, 0.0)]
    + [(points, None, held) for points in (1, 2, 3, 6) for held in (NONE_HELD, 1)[: 1 if points < 3 else 2]],
)
def test_a_damper_of_the_limit_takes_no_less_power_than_friction_and_hardly_more(points, inner, held):
    last = table_of(ring_places(1.0, points)) if points > CONTINUOUS else inner
    contact, angle, rng = (1.0, points, 1.0, 1.0, held, last), 0.4, np.random.default_rng(1)
    damper, shares = slip_dampers(contact, angle)[0], []
    for size, ratio in zip(
        10.0 ** rng.uniform(-6.0, 0.0, 400), 10.0 ** rng.uniform(-2.0, 2.0, 400), strict=True
    ):
        slip = size * rng.normal(size=3) * [1.0, 1.0, ratio]
        power = -np.dot(friction_of(*slip.tolist(), angle, contact), slip)
        shares.append(power / (slip @ damper @ slip))
    assert 0.8 < max(shares) <= 1.0 + 1e-12
