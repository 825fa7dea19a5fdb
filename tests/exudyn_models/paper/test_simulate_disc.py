from dataclasses import replace

import numpy as np
import pytest
from plain_slip import slide

import exudyn_models
import reference_model
from compare.claims.paper_parameters import FIG11
from exudyn_models import simulate, simulate_fixed_step

START = [0.05, 0.0, 0.4, 0.0, 0.05, 1.3]
RING = replace(  # of J = mR², on a table at rest
    FIG11,
    polar_inertia=0.0144,
    stiffness=0.0,
    damping=0.0,
    friction_force=0.09,
    disc_speed=0.0,
    shaft_damping=0.0,
    shaft_speed=0.0,
)
THROWN = [0.0, 0.0, 0.3, 0.3, 0.1, 2.0]
STICKING = replace(FIG11, polar_inertia=0.0072, damping=0.1, friction_force=0.09, offset=0.1)
STICKING_START = [0.1, 0.0, 0.0, 0.03, 0.0, 1.2]


def slip_motion(disc, start, times):
    """States while the disc slips, by an integrator that has nothing to do with Exudyn."""
    return slide(disc, start, times).y.T


def kinds(trajectory):
    return [phase.kind for phase in trajectory.phases]


@pytest.mark.parametrize("points", [None, 6])
@pytest.mark.parametrize("offset", [0.0, 0.1])
def test_slip_agrees_with_an_independent_integrator_at_every_output_time(points, offset):
    disc = replace(FIG11, contact_points=points, offset=offset)
    times = np.linspace(0.0, 100.0, 201)
    found = simulate(disc, START, times)
    np.testing.assert_allclose(found.states, slip_motion(disc, START, times), rtol=0.0, atol=1e-8)
    assert kinds(found) == ["slip"]


@pytest.mark.parametrize("points", [None, 6])
def test_error_while_slipping_falls_with_the_tolerance(points):
    disc = replace(FIG11, contact_points=points)
    times = np.linspace(0.0, 40.0, 41)
    expected = slip_motion(disc, START, times)
    errors = [
        np.abs(simulate(disc, START, times, tolerance=tolerance).states - expected).max()
        for tolerance in (1e-5, 1e-7, 1e-9)
    ]
    assert np.all(np.diff(errors) < 0.0), errors
    assert errors[-1] < 5e-9


@pytest.mark.parametrize("points", [None, 6])
@pytest.mark.parametrize(
    ("integrator", "order", "steps"),
    [
        ("RK44", 4, (0.1, 0.05)),
        ("RK67", 6, (0.2, 0.1)),
        ("GeneralizedAlpha", 2, (0.1, 0.05)),
        ("TrapezoidalIndex2", 2, (0.1, 0.05)),
    ],
)
def test_integrators_converge_at_their_order(points, integrator, order, steps):
    disc = replace(FIG11, contact_points=points)
    start = [0.6, 0.0, 0.4, 0.0, 0.6, 1.3]  # slips so fast that all is smooth, U > W throughout
    times = [0.0, 3.0]
    expected = slip_motion(disc, start, times)[-1]
    errors = [
        np.abs(
            simulate_fixed_step(disc, start, times, integrator=integrator, step=step).at_end - expected
        ).max()
        for step in steps
    ]
    observed = np.log2(errors[0] / errors[1])
    assert abs(observed - order) < 0.3, f"observed order {observed:.2f}, errors {errors}"


@pytest.mark.parametrize("points", [None, 6])
def test_implicit_solver_has_an_error_of_first_order_in_the_tolerance(points):
    disc = replace(FIG11, contact_points=points)
    times = np.linspace(0.0, 5.0, 11)
    expected = slip_motion(disc, START, times)
    errors = [
        np.abs(simulate(disc, START, times, tolerance=tolerance, solver="implicit").states - expected).max()
        for tolerance in (1e-6, 1e-8)
    ]
    observed = np.log(errors[0] / errors[1]) / np.log(100.0)
    assert abs(observed - 1.0) < 0.15, f"observed order {observed:.3f}, errors {errors}"
    assert errors[1] < 1e-6


@pytest.mark.parametrize("points", [None, 3, 6])
def test_stick_phases_have_errors_of_first_order_in_the_regularisation(points):
    disc = replace(STICKING, contact_points=points)
    exact = reference_model.simulate(disc, STICKING_START, [0.0, 12.0], tolerance=1e-11)
    expected = [kind for kind in kinds(exact) if kind != "pivot"]  # which are short at each release
    errors = []
    for regularisation in (1e-5, 1e-6, 1e-7):
        found = simulate(disc, STICKING_START, [0.0, 12.0], tolerance=1e-9, regularisation=regularisation)
        assert [kind for kind in kinds(found) if kind != "pivot"] == expected
        errors.append(
            [*np.abs(found.stick_times - exact.stick_times), np.abs(found.at_end - exact.at_end).max()]
        )
    errors = np.array(errors)
    # A first touch without a pivot comes before any creep; all later times carry the creep that went before.
    touches_first = exact.phases[1].kind == "stick"
    if touches_first:
        assert errors[-1, 0] < 1e-8
        errors = errors[:, 1:]
    orders = np.log10(errors[:-1] / errors[1:])
    assert np.all(np.abs(orders - 1.0) < 0.1), f"observed orders {orders}, errors {errors}"
    assert errors[-1].max() < 1e-4


@pytest.mark.parametrize("solver", ["explicit", "implicit"])
@pytest.mark.parametrize("points", [None, 6])
def test_both_solvers_pass_through_sticking(points, solver):
    disc = replace(STICKING, contact_points=points)
    found = simulate(disc, STICKING_START, [0.0, 12.0], tolerance=1e-7, solver=solver)
    exact = reference_model.simulate(disc, STICKING_START, [0.0, 12.0], tolerance=1e-9)
    assert len(found.stick_phases) == 2
    np.testing.assert_allclose(found.stick_times, exact.stick_times, rtol=0.0, atol=1e-3)


def test_a_stuck_disc_turns_with_the_master_disc():
    times = np.linspace(0.0, 12.0, 1201)
    found = simulate(STICKING, STICKING_START, times, tolerance=1e-8)
    omega, epsilon = STICKING.disc_speed, found.solution.regularisation
    for phase in found.stick_phases:
        stuck = (times > phase.start + 1e-3) & (times < phase.end - 1e-3)
        assert stuck.sum() > 10
        assert found.slip_speed[stuck].max() < 2.0 * epsilon
        assert np.abs(found.states[stuck, 5] - omega).max() < 2.0 * epsilon / STICKING.contact_radius


def test_a_shaft_too_strong_for_the_friction_keeps_the_disc_slipping():
    # b(ω − Ω) > μN·R: no moment of the contact can hold the disc, wherever its centre is.
    disc = replace(STICKING, shaft_damping=0.1, shaft_speed=0.3, offset=0.0)
    assert (
        disc.shaft_damping * (disc.disc_speed - disc.shaft_speed) > disc.friction_force * disc.contact_radius
    )
    assert kinds(simulate(disc, [0.0, 0.0, 0.0, 0.0, 0.0, 1.5], [0.0, 5.0])) == ["slip"]


@pytest.mark.parametrize("change", [{}, {"damping": 0.2}, {"stiffness": 1.0}, {"shaft_damping": 0.001}])
@pytest.mark.parametrize("points", [None, 6])
def test_a_ring_thrown_on_a_resting_table_comes_to_rest_for_good_and_never_gains_energy(points, change):
    ring = replace(RING, contact_points=points, friction_force=0.3, **change)
    times = np.linspace(0.0, 6.0, 601)
    found = simulate(ring, THROWN, times)
    x, y, _, vx, vy, spin = found.states.T
    energy = 0.5 * ring.mass * (vx**2 + vy**2) + 0.5 * ring.polar_inertia * spin**2
    energy += 0.5 * ring.stiffness * (x**2 + y**2)
    assert np.all(np.diff(energy) <= 1e-12)
    assert found.phases[-1].kind == "stick"
    assert abs(found.at_end[5]) * ring.contact_radius < found.solution.regularisation


def test_a_thrown_ring_stops_sliding_and_spinning_together_in_the_ratio_one():
    # Farkas, Bartels, Unger, Wolf 2003: for J = mR² the ratio of sliding to rim speed tends to 1.
    found = simulate(RING, THROWN, [0.0, 10.0])
    stop = found.phases[1].start
    assert kinds(found) == ["slip", "stick"]
    times = np.concatenate(([0.0], stop - np.array([3.0, 1.0, 0.3, 0.1]), [10.0]))
    _, _, _, vx, vy, spin = simulate(RING, THROWN, times).states.T
    ratios = np.hypot(vx, vy) / (RING.contact_radius * np.abs(spin))
    away = np.abs(ratios[:-1] - 1.0)
    assert np.all(np.diff(away[away > 1e-9]) < 0.0), ratios  # the last are 1 to within the tolerance
    assert abs(ratios[0] - 1.0) > 0.3
    assert abs(ratios[-2] - 1.0) < 1e-9


@pytest.mark.parametrize("tolerance", [1e-7, 1e-9])
def test_a_disc_on_points_pivots_about_one_of_them_before_it_rests(tolerance):
    ring = replace(RING, contact_points=6)
    exact = reference_model.simulate(ring, THROWN, [0.0, 10.0], tolerance=1e-11)
    found = simulate(ring, THROWN, [0.0, 10.0], tolerance=tolerance)
    assert kinds(found) == kinds(exact) == ["slip", "pivot", "stick"]
    epsilon = found.solution.regularisation
    for one, other in zip(found.phases[1:], exact.phases[1:], strict=True):
        assert one.start == pytest.approx(other.start, abs=epsilon)
    np.testing.assert_allclose(found.at_end[:3], exact.at_end[:3], rtol=0.0, atol=epsilon)


def test_long_pivots_have_errors_of_first_order_in_the_regularisation():
    # Fig. 11's disc on six points, near the centre of its modulated motion.
    disc = replace(FIG11, contact_points=6)
    start = [0.01, 0.0, 0.0, 0.0, 0.01, 1.45]
    exact = reference_model.simulate(disc, start, [0.0, 100.0], tolerance=1e-11)
    assert kinds(exact).count("pivot") == 2
    errors = []
    for tolerance in (1e-8, 1e-9):
        found = simulate(disc, start, [0.0, 100.0], tolerance=tolerance)
        assert kinds(found) == kinds(exact)
        errors.append(np.abs(found.at_end - exact.at_end).max())
    assert np.log10(errors[0] / errors[1]) == pytest.approx(1.0, abs=0.1), errors
    assert errors[-1] < 2e-6


@pytest.mark.parametrize("points", [None, 6])
@pytest.mark.parametrize(
    "change",
    [
        {},
        {"disc_speed": 0.0},
        {"damping": 0.0},
        {"stiffness": 0.0, "damping": 0.0},
        {"shaft_damping": 0.0},
        {"stiffness": 0.0, "damping": 0.0, "shaft_damping": 0.0, "disc_speed": 0.0, "shaft_speed": 0.0},
    ],
)
@pytest.mark.parametrize("solver", ["explicit", "implicit"])
def test_without_friction_centre_and_spin_are_two_free_decays(points, change, solver):
    disc = replace(FIG11, friction_force=0.0, contact_points=points, **change)
    times = np.linspace(0.0, 10.0, 21)
    found = simulate(disc, START, times, solver=solver)
    accuracy = 1e-10 if solver == "explicit" else 1e-5
    rate = disc.shaft_damping / disc.polar_inertia
    drive = START[5] - disc.shaft_speed if rate > 0.0 else START[5]
    spin = (disc.shaft_speed if rate > 0.0 else 0.0) + drive * np.exp(-rate * times)
    np.testing.assert_allclose(found.states[:, 5], spin, rtol=0.0, atol=accuracy)
    centre = slip_motion(disc, START, times)
    np.testing.assert_allclose(found.states, centre, rtol=0.0, atol=accuracy)
    assert kinds(found) == ["slip"]


@pytest.mark.parametrize("points", [None, 6])
def test_mirrored_speeds_give_the_mirrored_motion(points):
    disc = replace(STICKING, contact_points=points)
    other = replace(disc, disc_speed=-disc.disc_speed, shaft_speed=-disc.shaft_speed)
    mirror = np.array([1.0, -1.0, -1.0, 1.0, -1.0, -1.0])
    times = np.linspace(0.0, 6.0, 13)
    one = simulate(disc, STICKING_START, times, tolerance=1e-8)
    two = simulate(other, mirror * STICKING_START, times, tolerance=1e-8)
    np.testing.assert_allclose(two.states, one.states * mirror, rtol=0.0, atol=1e-8)
    assert kinds(one) == kinds(two)


def test_another_point_in_the_place_of_the_first_gives_the_same_motion():
    disc = replace(STICKING, contact_points=6)
    turned = STICKING_START + np.pi / 3.0 * np.eye(6)[2]
    times = np.linspace(0.0, 6.0, 13)
    one = simulate(disc, STICKING_START, times, tolerance=1e-8).states
    two = simulate(disc, turned, times, tolerance=1e-8).states
    np.testing.assert_allclose(two - one, np.eye(6)[2] * np.pi / 3.0 * np.ones((13, 1)), rtol=0.0, atol=1e-8)


def test_a_large_angle_does_not_stop_the_solver():
    start = START + 1e6 * np.eye(6)[2]
    found, expected = simulate(FIG11, start, [0.0, 20.0]), simulate(FIG11, START, [0.0, 20.0])
    np.testing.assert_allclose(found.at_end - expected.at_end, [0.0, 0.0, 1e6, 0.0, 0.0, 0.0], atol=1e-8)
    assert found.solution.steps < 2 * expected.solution.steps


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"initial_state": [0.0] * 4}, "DiscOnDisc takes 6 numbers"),
        ({"initial_state": [0.0, 0.0, np.inf, 0.0, 0.0, 0.0]}, r"initial_state\[2\] = inf"),
        ({"regularisation": 0.0}, "regularisation = 0 m/s"),
        ({"solver": "magic"}, "solver = 'magic': it must be 'explicit' or 'implicit'"),
    ],
)
def test_bad_input_is_refused_in_a_sentence(change, message):
    arguments = {"initial_state": START, "times": [0.0, 1.0]} | change
    with pytest.raises(ValueError, match=message):
        simulate(FIG11, **arguments)


@pytest.mark.parametrize("start", [-5.0, 1e6])
@pytest.mark.parametrize("simulate", [exudyn_models.simulate, exudyn_models.simulate_with_native_contact])
def test_the_clock_at_the_start_does_not_matter(simulate, start):
    disc = replace(STICKING, contact_points=6)
    delays = np.linspace(0.0, 3.0, 7)
    moved = simulate(disc, STICKING_START, start + delays)
    expected = simulate(disc, STICKING_START, delays)
    # A second is known to 1e-10 of itself on a clock that shows a million of them.
    assert moved.states == pytest.approx(expected.states, abs=1e-9)
    assert [phase.kind for phase in moved.phases] == [phase.kind for phase in expected.phases]
    ends = [(phase.start, phase.end) for phase in moved.phases]
    assert (ends[0][0], ends[-1][1]) == (start, start + 3.0)
    assert np.ravel(ends) - start == pytest.approx(
        np.ravel([(phase.start, phase.end) for phase in expected.phases]), abs=1e-9
    )
