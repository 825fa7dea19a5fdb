"""Predictions that share code with their measurement, compared with values found another way.

If both sides of a claim read a number by the same code, its errors cancel. Here other means find the number: SciPy's
integration of the plain equations with events, the return map of releases, or samples without a polynomial.
``CHECKED`` lists these claims.
"""

from dataclasses import replace
from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest
from plain_slip import slide
from scipy.optimize import brentq, root
from studies_under_test import engine_named

from compare.claims.error_estimates import TIGHTEST, TRUTH
from compare.claims.linearised_flow import matched, rotated
from compare.claims.parameters import FIG5, FIG5_STARTS
from compare.studies import STUDIES
from compare.studies.disc.fig08 import study as fig08
from compare.studies.disc.fig09 import growth_and_stick, steady_motions, theory
from compare.studies.disc.fig11 import offsets
from compare.studies.disc.fig11 import theory as fig11
from compare.studies.disc.free_ring import theory as free_ring
from compare.studies.drivetrain.frozen import theory as frozen
from compare.studies.drivetrain.frozen import whirls
from compare.studies.engines import clutch_scale, power_balance
from compare.studies.engines.trajectories import theory as trajectories
from compare.studies.pin import fig06, nonlinear_support
from compare.studies.pin.fig05 import study as fig05
from compare.studies.plane.pushes import forward
from compare.studies.plane.pushes import theory as pushes
from compare.studies.plane.pushes.reduction import reduced_pushes
from compare.studies.toolkit import measuring
from compare.studies.toolkit.drivetrain_bench import centred_car
from compare.studies.toolkit.fig11 import RING, SIX, START
from compare.studies.toolkit.pins import exact_whirl, extent, sizes_of
from compare.studies.toolkit.steady_motion import equilibrium_of, steady_motion, with_load
from reference_model import plain, simulate
from reference_model.contact.contact_law import contact_of
from reference_model.contact.elliptic import mean_directions
from reference_model.ensemble import EndState, simulate_ensemble
from reference_model.orbits.release_map import ReleaseMap, stick_slip_orbits
from reference_model.systems import ANGLE, DiscOnDisc

CHECKED = {
    "fig06/whirls": (
        "shooting, extremes between samples",
        "events of SciPy's DOP853: crossing of the axis, zero radial velocity, zero angular acceleration",
    ),
    "nonlinear-support/orbit": (
        "shooting, extremes between samples",
        "events of SciPy's DOP853: crossing of the axis, zero radial velocity, zero angular acceleration",
    ),
    "fig09/orbits": (
        "shooting, extremes between samples",
        "events of SciPy's DOP853: crossing of the axis, zero radial velocity, zero angular acceleration",
    ),
    "fig06/whirl-ends": ("shooting", "minimum of the load over a return map by DOP853"),
    "fig06/cycle-exists": ("shooting", "period and multiplier by the map of releases"),
    "fig06/cycle-attracts": ("shooting", "period and multiplier by the map of releases"),
    "fig05/critical": ("search for the dividing velocity, rule for the end", "saddle of the map of releases"),
    "clutch-scale/ends": (
        "search for the dividing velocity, rule for the end",
        "saddle of the map of releases",
    ),
    "fig08/six-points": (
        "fixed points of the flow, means of 12 samples",
        "DOP853 over a period, means of 600 samples",
    ),
    "fig09/six-circles": (
        "fixed points of the flow, means of 12 samples",
        "DOP853 over a period, means of 600 samples",
    ),
    "fig09/six-rests": (
        "fixed points of the flow, means of 12 samples",
        "DOP853 over a period, means of 600 samples",
    ),
    "fig09/six-releases": ("slip in axes that turn", "plain equations with regularised friction (Radau)"),
    "fig11/period-and-turn": ("splines through samples", "events of DOP853"),
    "fig11/extremes": ("splines through samples", "events of DOP853"),
    "fig11/shooting": ("splines through samples", "events of DOP853"),
    "fig11/extremes-on-six-points": ("extremes between samples", "samples at 2.5 ms"),
    "clutch-scale/shares": ("compiled ensemble", "single runs"),
    "trajectories/phases": ("choice of lasting stick phases", "event on the slip of (1), then (7)"),
    "power-balance/pin": ("quadrature", "zero residual of an exact motion, to 5e-12"),
    "power-balance/disc": ("quadrature", "zero residual of an exact motion, to 5e-12"),
    "foreign-engines/box-whirls": (
        "time window of the radius",
        "mean over a revolution after 300 s, by another integrator",
    ),
    "foreign-engines/pyramid-whirls": (
        "time window of the radius",
        "mean over a revolution after 300 s, by another integrator",
    ),
    "drivetrain-frozen/linearised": (
        "the whirl, and eigenvalues in axes that turn",
        "differences of the plain equations with friction summed over points",
    ),
    "drivetrain-frozen/border": (
        "the whirl, and eigenvalues in axes that turn",
        "differences of the plain equations with friction summed over points",
    ),
    "free-ring/heat": ("power of a sliding and spinning ring", "mean slip of 20,000 points"),
    "pushes/final-poses": ("path of the hand", "a known motion in fixed axes"),
    "tosses/under-load": (
        "tilt of the load, reading of turn and spin",
        "power law of a slow spin and its curl; moments of the load, in test_study_tosses.py",
    ),
}
"""Code that both sides of a claim share, and the independent value, by claim."""

BY_SCIPY = {"rtol": 1e-13, "atol": 1e-14, "t_eval": None}


def outward(_, state):
    half = len(state) // 2
    return state[0] * state[half] + state[1] * state[half + 1]


def crosses_axis(_, state):
    return state[1]


crosses_axis.direction = 1.0


def extremes_in_a_turn(orbit):
    """Return period and extremes of radius and, for a disc, spin: where their rates vanish in SciPy's solution."""
    law = plain.by_law(orbit.system.friction_force, contact_of(orbit.system))
    spins = (lambda _, state: plain.rates(orbit.system, law, state)[-1],)
    events = (crosses_axis, outward, *(spins if isinstance(orbit.system, DiscOnDisc) else ()))
    run = slide(orbit.system, orbit.state, (0.0, 1.1 * orbit.period), events=events, **BY_SCIPY)
    period, end = next(
        found for found in zip(run.t_events[0], run.y_events[0], strict=True) if found[0] > 0.1
    )
    back = end - orbit.state
    back[ANGLE : len(back) - 3] = 0.0  # the angle of a disc does not recur
    assert back == pytest.approx(0.0, abs=1e-9)
    radius = np.hypot(*run.y_events[1][:, :2].T)
    spin = [function(states[:, -1]) for states in run.y_events[2:] for function in (np.min, np.max)]
    return [period, radius.min(), radius.max(), *spin]


WHIRLS = {f"fig06/whirls, {load:g} N": fig06.with_load(load) for load in fig06.WHIRL_LOADS} | {
    f"nonlinear-support/orbit, {pin.hardening:g} N/m³": pin for pin in nonlinear_support.SHIFTED
}


def assert_read_within_its_error(read, expected):
    """Compare with the larger error of both extremes, which claims count, plus the tolerance of SciPy."""
    assert read.largest < 1e-8
    assert read.value == pytest.approx(expected, rel=0.0, abs=read.largest + 2e-11)


@pytest.mark.parametrize("pin", WHIRLS.values(), ids=WHIRLS)
def test_period_and_radii_of_whirls_of_pins(pin):
    orbit = exact_whirl(pin)
    period, *radii = extremes_in_a_turn(orbit)
    assert sizes_of(orbit)[0] == pytest.approx(period, rel=1e-12)
    assert_read_within_its_error(extent(orbit), radii)


@pytest.mark.parametrize("whirl", theory.ORBITS)
def test_period_radii_and_spins_of_whirls_of_discs(whirl):
    orbit = theory.orbit_of_reference(*whirl)
    period, *extremes = extremes_in_a_turn(orbit)
    assert steady_motions.sizes_and_spins(orbit)[0] == pytest.approx(period, rel=1e-12)
    assert_read_within_its_error(extent(orbit), extremes[:2])
    assert_read_within_its_error(steady_motions.spins_of(orbit), extremes[2:])


def test_the_extremes_of_fig_6_are_those_of_an_audit():
    """The largest of 64 samples was 1.2e-4 m too small, with an error bar of 2e-8 m."""
    assert extent(exact_whirl(fig06.with_load(0.09))).value[1] == pytest.approx(0.86903136, abs=5e-9)
    assert extent(exact_whirl(nonlinear_support.SHIFTED[1])).value[0] == pytest.approx(0.74288972, abs=5e-9)
    inner = theory.orbit_of_reference(*theory.ORBITS[1])
    assert extent(inner).value[1] == pytest.approx(0.33051946, abs=5e-9)


def test_the_least_load_of_a_whirl_by_a_return_map_of_scipy():
    fold = fig06.load_of_unit_multiplier()
    x, y, *velocity = fig06.last_whirl(fig06.with_load(0.08)).state
    assert y == 0.0

    def load_at(x):
        def miss(unknowns):
            start = np.array([x, 0.0, *unknowns[:2]])
            pin = fig06.with_load(unknowns[2])
            run = slide(pin, start, (0.0, 9.0), events=crosses_axis, **(BY_SCIPY | {"rtol": 1e-12}))
            return next(end for t, end in zip(run.t_events[0], run.y_events[0], strict=True) if t > 1.0)[
                [0, 2, 3]
            ] - [x, *unknowns[:2]]

        return root(miss, [*velocity, fold], tol=1e-12).x[2]

    away = x * np.array([-3e-3, 0.0, 3e-3])
    square, linear, constant = np.polyfit(away, [load_at(x + one) for one in away], 2)
    assert fold == pytest.approx(constant - linear**2 / (4.0 * square), abs=1e-10)


def test_the_stick_slip_cycle_by_the_map_of_releases():
    orbit = fig06.cycle()
    (stable,) = (one for one in stick_slip_orbits(orbit.system) if one.stable)
    assert orbit.period == pytest.approx(stable.period, rel=1e-12)
    assert abs(orbit.multipliers[1]) == pytest.approx(stable.multiplier, abs=1e-8)


def test_the_dividing_velocity_leads_to_the_saddle_of_the_map_of_releases():
    (saddle,) = (one for one in stick_slip_orbits(FIG5) if not one.stable)
    releases = ReleaseMap(FIG5, TIGHTEST)

    def beyond(velocity):
        run = simulate(FIG5, (0.1, 0.0, velocity, 0.0), [0.0, 15.0], tolerance=TIGHTEST)
        return next(releases.along(run)).angle - saddle.release_angle

    expected = brentq(beyond, *(start[2] for start in FIG5_STARTS.values()), xtol=1e-13)
    assert fig05.critical_velocity(engine_named("reference"), TIGHTEST) == pytest.approx(expected, abs=1e-11)
    ends = [float(velocity > expected) for velocity in clutch_scale.VELOCITIES]
    (claim,) = clutch_scale.STUDY.measure(engine_named("reference"), only=("ends",)).claims
    assert claim.predicted.tolist() == ends


SIX_POINTS = (
    {
        f"fig09/six-circles, {load:g} N, {i}": (theory.disc_of(load, i, 6), (load, i))
        for load, i in theory.CIRCLES
    }
    | {
        f"fig09/six-rests, {load:g} N": (theory.disc_of(load, None, 6), (load, None))
        for load in theory.REST_LOADS
    }
    | {f"fig08/six-points, {load:g} N": (with_load(fig08.SIX, load), None) for load in fig08.LOADS}
)


@pytest.mark.parametrize(("disc", "near"), SIX_POINTS.values(), ids=SIX_POINTS)
def test_means_of_steady_motions_on_six_points(disc, near):
    near = theory.exact_motion(*near) if near else equilibrium_of(replace(disc, contact_points=None))
    motion = steady_motion(engine_named("reference"), disc, near.state, TIGHTEST)
    times = np.linspace(0.0, motion.period, 601)
    states = rotated(slide(disc, motion.state, times, rtol=1e-11, atol=1e-12).y.T, -motion.frequency * times)
    size = float(np.max(np.abs(states[0])))
    assert np.delete(states[-1] - states[0], ANGLE) == pytest.approx(0.0, abs=1e-11 * size)
    assert motion.mean == pytest.approx(states[:-1, :2].mean(axis=0), abs=1e-9 * size)
    assert motion.spin == pytest.approx(states[-1, ANGLE] / motion.period + motion.frequency, abs=1e-12)


@pytest.mark.parametrize("load", theory.STICK_LOADS)
def test_a_released_disc_on_six_points_slips_as_by_the_plain_equations(load):
    expected = growth_and_stick._slipped_in_reference(load)
    found = growth_and_stick._slipped(SimpleNamespace(simulate=plain.simulate), load, 1e-7)
    assert found == pytest.approx(expected, abs=1e-4)


def test_the_modulated_cycle_by_events_of_scipy():
    law = plain.by_law(RING.friction_force, contact_of(RING))

    def spinning_up(_, state):
        return plain.rates(RING, law, state)[-1]

    options = BY_SCIPY | {"rtol": 1e-12, "atol": 1e-12, "dense_output": True}
    run = slide(RING, START, (0.0, fig11.UNTIL), events=(outward, spinning_up), **options)
    states = [
        found[times > fig11.UNTIL / 4.0] for times, found in zip(run.t_events, run.y_events, strict=True)
    ]
    radii = np.hypot(*run.y_events[0][:, :2].T)
    start, end = run.t_events[0][radii > 0.5 * radii.max()][-2:]
    radius, spin = np.hypot(*states[0][:, :2].T), states[1][:, -1]
    x, y, *_ = run.sol(np.linspace(start, end, 4001))
    turn = np.unwrap(np.arctan2(y, x))[[0, -1]] @ [-1.0, 1.0]
    expected = [end - start, turn, radius.min(), radius.max(), spin.min(), spin.max()]
    found, error = fig11.predicted_modulation()
    assert np.all(np.abs(found - expected) <= error)


def test_extremes_on_six_points_by_a_hundred_times_as_many_samples():
    dense = simulate(SIX, START, np.linspace(0.0, offsets.ROUND[-1], 120001), tolerance=1e-11)
    spin = dense.states[:, -1]
    expected = [dense.radius.min(), dense.radius.max(), spin.min(), spin.max()]
    assert_read_within_its_error(fig11.extremes_of(offsets._reference()), expected)
    assert expected[2] == pytest.approx(1.3635137, abs=5e-8)


def test_ends_of_the_ensemble_at_the_scale_of_a_clutch_by_single_runs():
    drawn = np.random.default_rng(1).uniform(-0.3, 0.3, (6, 4))
    pin, starts = clutch_scale.scaled(FIG5), clutch_scale.CLUTCH.states(drawn)
    duration = clutch_scale.CLUTCH.time * clutch_scale.ENSEMBLE_UNTIL
    whirls = simulate_ensemble(pin, starts, duration=duration).end == EndState.WHIRL
    ends = [simulate(pin, start, [0.0, duration]).at_end for start in starts]
    assert [np.hypot(*end[:2]) > 2.0 * pin.offset for end in ends] == whirls.tolist()


def test_lasting_stick_phases_begin_with_the_events_of_the_plain_equations():
    (motion,) = trajectories.PINS_THAT_STICK.values()
    first = trajectories.stick_times(trajectories.by_reference(motion))[:2]
    assert first == pytest.approx(fig05.first_stick_and_release("whirl", 4e-13), abs=1e-9)


@pytest.mark.parametrize("name", power_balance.all_motions())
def test_the_quadrature_closes_the_power_balance_of_an_exact_motion(name):
    run = power_balance._run(engine_named("reference"), power_balance.all_motions()[name], TRUTH)
    assert power_balance._relative_residual(power_balance.power_balance(run)) < 5e-12


def rates_in_turning_axes(car, whirl, state):
    """Return the rates of x, y, φ − ψ, θ̇, ψ̇, ẋ, ẏ, φ̇ by summing Coulomb friction over points of the facings."""
    x, y, twist, engine, vehicle, vx, vy, spin = state
    z, velocity = x + 1j * y, vx + 1j * vy
    nodes, weights = np.polynomial.legendre.leggauss(40)
    radii = 0.5 * (car.inner_radius + car.outer_radius + (car.outer_radius - car.inner_radius) * nodes)
    points = radii[:, np.newaxis] * np.exp(2j * np.pi * np.arange(256) / 256)
    slip = velocity - 1j * engine * z + 1j * (spin - engine) * points
    pressed = (weights * radii / np.sum(weights * radii) / 256)[:, np.newaxis]
    forces = -whirl.friction_force * pressed * slip / np.abs(slip)
    force, distance = np.sum(forces), abs(z)
    contact = car.stop_stiffness * max(0.0, distance - car.stop_gap) / distance
    spring = car.radial_stiffness + car.hardening * distance**2 + contact
    held = whirl.torque + car.torsional_stiffness * twist + car.torsional_damping * (spin - vehicle)
    acceleration = (force - spring * z - car.radial_damping * velocity) / car.disc_mass
    moving = velocity - 1j * whirl.frequency * z
    turning = acceleration - 1j * whirl.frequency * velocity
    on_engine = whirl.engine_torque - np.sum(np.conj(z + points) * forces).imag
    on_disc = np.sum(np.conj(points) * forces).imag - held
    return np.array(
        [
            moving.real,
            moving.imag,
            spin - vehicle,
            on_engine / car.engine_inertia,
            (held - whirl.torque) / car.vehicle_inertia,
            turning.real,
            turning.imag,
            on_disc / car.disc_inertia,
        ]
    )


def modulation_by_differences(car, whirl):
    """Return the six eigenvalues of the plain equations, linearised by differences, at a whirl that they confirm."""
    spin = whirl.engine_speed - whirl.slip
    speed = whirl.frequency * whirl.radius
    state = np.array([whirl.radius, 0.0, 0.0, whirl.engine_speed, spin, 0.0, speed, spin])
    scale = np.array([whirl.radius] * 2 + [1e-3] + [whirl.slip] * 2 + [speed] * 2 + [whirl.slip])
    assert np.abs(rates_in_turning_axes(car, whirl, state)) == pytest.approx(
        0.0, abs=1e-8 * speed * whirl.frequency
    )
    steps = 1e-5 * np.diag(scale)
    columns = [
        (rates_in_turning_axes(car, whirl, state + step) - rates_in_turning_axes(car, whirl, state - step))
        / 2.0
        for step in steps
    ]
    values = np.linalg.eigvals(np.transpose(columns) / np.diag(steps))
    return values[np.argsort(np.abs(values))[2:]]


@pytest.mark.parametrize("i", range(len(frozen.WHIRLS)))
def test_eigenvalues_of_a_whirl_of_the_clutch_by_differences_of_the_plain_equations(i):
    car = centred_car()
    whirl = frozen.whirls_of(car)[i]
    speed, torque, surplus = frozen.WHIRLS[i]
    assert whirl.engine_speed * 30.0 / np.pi == pytest.approx(speed)
    assert whirl.friction_force * car.friction_radius == pytest.approx(torque * (1.0 + surplus))
    expected = modulation_by_differences(car, whirl)
    size = np.max(np.abs(expected))  # differences are exact to about 1e-10 of the largest rate
    assert matched(frozen.modulation(car, whirl), expected) == pytest.approx(
        expected, rel=0.0, abs=1e-8 * size
    )


@pytest.mark.parametrize("torque", frozen.BORDER_TORQUES)
def test_the_border_of_modulation_by_differences_of_the_plain_equations(torque):
    car = centred_car()

    def growth(speed):
        whirl = frozen.whirl_under_surplus(car, speed * np.pi / 30.0, torque, frozen.BORDER_SURPLUS)
        return modulation_by_differences(car, whirl).real.max()

    found, _ = whirls._border(car, partial(frozen.state_matrix_of, car), torque, frozen.BETWEEN)
    assert found == pytest.approx(brentq(growth, *frozen.BETWEEN, xtol=1e-6), abs=1e-3)


@pytest.mark.parametrize("throw", free_ring.RINGS)
def test_the_power_of_a_sliding_and_spinning_ring_by_the_mean_slip_of_its_points(throw):
    """The heat of a ring integrates its power, which the same closed form gives on both sides of the balance."""
    run = free_ring.thrown(engine_named("reference"), throw, free_ring.TOLERANCE)
    sliding, rim = free_ring.speeds_at(run, free_ring.uniform_times(engine_named("reference"), throw)[:-20])
    points = np.exp(2j * np.pi * (np.arange(20000) + 0.5) / 20000)
    for u, w in zip(sliding, rim, strict=True):
        assert np.dot([u, w], mean_directions(u, w)) == pytest.approx(np.abs(u + w * points).mean(), rel=1e-7)


def test_the_path_of_a_hand_that_pushes_a_known_motion():
    """Both simulations of a push use this path: the hand in the first pose of the body, about its centre of mass."""
    begin, end, hand = (30.0 - 20.0j, 0.4), (36.0 - 11.0j, 0.7), (33.0 + 1.0j, 40.0 + 9.0j)
    halfway = np.exp(-0.55j)
    shift = (end[0] - begin[0]) * halfway
    first, last = (
        (one - place) * np.exp(-1j * angle) for one, (place, angle) in zip(hand, (begin, end), strict=True)
    )
    columns = {"x": shift.real, "y": shift.imag, "turn": 0.3, "start_x": first.real, "start_y": first.imag}
    push = replace(reduced_pushes()[0], **columns, end_x=last.real, end_y=last.imag)
    about = begin[0] + pushes.CENTRE * np.exp(0.4j)
    in_first_pose = [(one - about) * np.exp(-0.4j) * 1e-3 for one in hand]
    assert list(forward.path_of(push)[:2]) == pytest.approx(in_first_pose)
    moved = end[0] + pushes.CENTRE * np.exp(0.7j) - about
    assert forward.measured_motion(push) == pytest.approx((moved * np.exp(-0.4j) * 1e-3, 0.3))


def test_the_listed_claims_exist():
    known = {one.identity(study.name, "") for study in STUDIES for one in study.declared}
    assert CHECKED.keys() <= known


@pytest.mark.parametrize("periodic", [False, True])
@pytest.mark.parametrize("wave", [1.0, 3.0, 7.0])
def test_extremes_of_a_curve_between_its_samples(wave, periodic):
    """The faulty code, the extreme samples alone, is off by many error bars."""
    angle = np.linspace(0.0, 2.0 * np.pi, 129) + 0.3
    curve = np.sin(wave * angle) + 0.3 * np.cos(wave * angle)
    read = measuring.extremes(curve, periodic=periodic)
    size = np.hypot(1.0, 0.3)
    assert np.all(np.abs(read.value - [-size, size]) <= read.error + 1e-15)
    assert read.largest < 1e-3 * wave**6 * (angle[1] - angle[0]) ** 6 + 1e-15
    assert np.min(np.abs([curve.min(), curve.max()] - read.value)) > 5.0 * read.largest


def test_the_ends_of_a_curve_count_and_a_constant_has_no_error():
    assert measuring.extremes(np.linspace(2.0, 5.0, 20)).value == pytest.approx([2.0, 5.0])
    assert measuring.extremes(np.full(30, 2.0)).largest < 1e-14
