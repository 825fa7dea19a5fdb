from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import reference_model
from compare.claims.parameters import FIG5, FIG11
from compare.studies.pin.sticking_domain.study import pin_at
from compare.studies.toolkit.pins import safest_angle, stuck
from exudyn_models import simulate
from exudyn_models.forces.laws.places import point_regularisation, ring_places
from exudyn_models.paper.creep import RegularisedContact
from exudyn_models.paper.phase_detection import detected_phases
from exudyn_models.solver.solver_run import Steps
from reference_model.systems import PinOnDisc

EPSILON = 1e-6
PIN = replace(FIG5, disc_speed=0.0, offset=0.0)
CONTACT = RegularisedContact(PIN, EPSILON)
RING = replace(FIG11, polar_inertia=0.5)
SYSTEMS = [
    replace(PIN, disc_speed=1.5),
    RING,
    replace(RING, contact_points=3),
    replace(RING, contact_points=6),
]


@pytest.mark.parametrize("system", SYSTEMS)
def test_rates_of_the_slip_are_its_derivatives_along_the_motion(system):
    rng = np.random.default_rng(0)
    for _ in range(10):
        state, acceleration = rng.normal(size=system.state_size), rng.normal(size=system.state_size // 2)
        change = np.concatenate((state[len(acceleration) :], acceleration))
        later, before = (state + sign * 1e-6 * change for sign in (1.0, -1.0))
        ratios = RegularisedContact(system, EPSILON).slip_ratios(np.array([later, before]))
        expected = (ratios[0] - ratios[1]) / 2e-6
        found = RegularisedContact(system, EPSILON).slip_ratio_rates(state, acceleration)
        np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-6 / EPSILON)


def test_only_the_pivot_of_a_disc_creeps():
    disc, spin = replace(RING, contact_points=6, disc_speed=0.0), 0.7
    contact, delta = RegularisedContact(disc, EPSILON), point_regularisation(EPSILON, ring_places(0.12, 6))
    for i in range(6):
        arm = disc.contact_radius * np.exp(1j * (0.4 + np.pi / 3.0 * i))
        for share, creeps in ((0.99, 1 + i), (1.01, None)):
            v = -1j * spin * arm + share * delta
            assert contact.creeping([0.3, -0.2, 0.4, v.real, v.imag, spin]) == creeps


def motion_of_slip(speeds, durations):
    """Return the motion of a pin along x: slip ``speeds`` (in ε) on a resting disc after ``durations`` (s)."""
    times = np.concatenate(([0.0], np.cumsum(durations)))
    speeds = EPSILON * np.array(speeds)
    states = np.zeros((len(times), 4))
    states[:, 2] = speeds
    accelerations = np.zeros((len(times), 2))
    accelerations[:-1, 0] = np.diff(speeds) / durations
    return Steps(times, states, accelerations, 0)


SHORT, LONG = 0.1 * CONTACT.settling_time, 3.0 * CONTACT.settling_time
PAUSES_AT_THE_KINK = (
    [1e5, 3.0, 0.5, 0.5, 1.001, 0.999, 1.001, 0.998, 1.002, 3.0, 1e5],
    [1.0, SHORT, SHORT, 1.0, *[SHORT] * 5, 1.0],
)
SETTLES_AGAIN_BEFORE_IT_HAS_GROWN = (
    [1e5, 3.0, 0.5, 0.9, 1.1, 1.1, 0.9, 0.9, 1.1, 3.0, 1e5],
    [1.0, SHORT, LONG, SHORT, SHORT, SHORT, LONG, LONG, SHORT, 1.0],
)


@pytest.mark.parametrize(("speeds", "durations"), [PAUSES_AT_THE_KINK, SETTLES_AGAIN_BEFORE_IT_HAS_GROWN])
def test_slip_that_returns_to_creep_is_not_a_release(speeds, durations):
    found = detected_phases(CONTACT, motion_of_slip(speeds, durations))
    assert [phase.kind for phase in found] == ["slip", "stick", "slip"]
    assert all(before.end == after.start for before, after in pairwise(found))


def test_slip_that_only_passes_through_zero_is_not_stick():
    # The pull is twice the friction limit; the net force is 1 + v/ε limits against it, and 1 − v/ε along it.
    relaxation = PIN.mass * EPSILON / PIN.friction_force
    steps = motion_of_slip([1e5, 0.9, 0.1, 0.1, 0.9, 1e5], [1.0, relaxation, relaxation, relaxation, 1.0])
    growth = np.array([-3.0, -2.9, -2.1, 1.9, 1.1, 1.0])
    steps.accelerations[:, 0] = growth * PIN.friction_force / PIN.mass
    assert [phase.kind for phase in detected_phases(CONTACT, steps)] == ["slip"]


@pytest.mark.parametrize(("damping", "reached"), [(0.0, 1.0), (0.25 * PIN.friction_force / EPSILON, 0.8)])
def test_stick_starts_at_extrapolated_zero_slip_and_ends_at_the_limit_of_friction(damping, reached):
    contact = RegularisedContact(replace(PIN, damping=damping), EPSILON)
    steps = motion_of_slip([10.0, 2.0, 0.5, 0.5, 1.5, 10.0], [8e-3, 1e-3, 1.0, 1.0, 1.0])
    steps.accelerations[1, 0] = -2.0 * EPSILON / 4e-4  # zero 4e-4 s later
    found = detected_phases(contact, steps)
    assert [phase.kind for phase in found] == ["slip", "stick", "slip"]
    assert found[1].start == pytest.approx(8.4e-3, rel=1e-12)
    # The load is creep/ε and the damper's share, plus an inertia share of at most m·a/μN = 1e-4.
    assert found[1].end == pytest.approx(8e-3 + 1e-3 + 1.0 + reached - 0.5, abs=1e-4)


NEAR_ITS_LIMIT = PinOnDisc(
    mass=1.88, stiffness=1.3, damping=0.13, friction_force=0.175, disc_speed=0.143, offset=-0.1
)
"""A pin that starts in stick close to the friction limit, and is released after 0.6 s."""


def test_stick_up_to_a_release_has_an_error_of_first_order_in_the_tolerance():
    place = np.array([-0.0625, -0.1218])
    start = [*place, -NEAR_ITS_LIMIT.disc_speed * place[1], NEAR_ITS_LIMIT.disc_speed * place[0]]
    times = np.linspace(0.0, 3.0, 31)
    exact = reference_model.simulate(NEAR_ITS_LIMIT, start, times)
    assert [phase.kind for phase in exact.phases] == ["stick", "slip"]
    errors = [
        np.max(abs(simulate(NEAR_ITS_LIMIT, start, times, tolerance=tolerance).states - exact.states))
        for tolerance in (8e-9, 1e-9)
    ]
    np.testing.assert_allclose(np.log2(np.divide(errors[:-1], errors[1:])) / 3.0, 1.0, atol=0.1)


@pytest.mark.parametrize("tolerance", [1e-6, 1e-8])
def test_a_pin_is_released_by_a_load_that_exceeds_friction_by_a_thousandth_for_a_moment(tolerance):
    pin = pin_at(2.0)
    start = stuck(pin, 1.001 * reference_model.sticking_radius(pin), safest_angle(pin))
    run = simulate(pin, start, [0.0, 1.02 * np.pi / pin.disc_speed], tolerance=tolerance)
    assert [phase.kind for phase in run.phases][:2] == ["stick", "slip"]
