"""Co-simulation of the units: slip, stick and creep against the reference, and directional derivatives."""

import ctypes
from dataclasses import asdict, replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import reference_model
from compare.claims.parameters import FIG5, FIG5_STARTS, FIG11
from reference_model.formulas.pin import squared_holding_force
from reference_model.systems import COLUMNS, DiscOnDisc, PinOnDisc

SLIPS, STICKS, LEAVES = range(3)
MODEL = {PinOnDisc: "pin", DiscOnDisc: "disc"}
SIX = replace(FIG11, contact_points=6)
PIVOTING = (0.0389, 0.0, 0.0, 0.0, 0.0389, 1.38664)
RESTING = replace(FIG11, mass=1.0, polar_inertia=0.02, stiffness=1.0, damping=0.1, friction_force=0.4)
RESTING = replace(RESTING, disc_speed=1.2, offset=0.1, shaft_damping=0.005, shaft_speed=0.0)
WHIRL = FIG5_STARTS["whirl"]


def started(instance, system, start, **more):
    parameters = {name: value for name, value in asdict(system).items() if value is not None}
    states = dict(zip([name for name, _ in COLUMNS[type(system)]], start, strict=True))
    return instance(MODEL[type(system)], **parameters, **states, **more).started()


@pytest.mark.parametrize(
    ("system", "start", "until", "changes"),
    [
        (FIG11, (0.02, 0.0, 0.0, 0.0, 0.0, 1.3), 50.0, 0),
        (SIX, (0.02, 0.0, 0.0, 0.0, 0.0, 1.3), 50.0, 0),
        (FIG5, WHIRL, 100.0, 18),
        (RESTING, (0.1, 0.0, 0.0, 0.0, 0.0, 0.0), 12.0, 1),
    ],
    ids=["slipping ring", "slipping points", "sticking pin", "resting ring"],
)
def test_motion_and_stick_times_agree_with_the_reference(instance, system, start, until, changes):
    unit = started(instance, system, start)
    unit.to(until)
    reference = reference_model.simulate(system, start, [0.0, until], tolerance=1e-12)
    expected = [phase.start for phase in reference.phases[1:]]
    assert len(expected) == changes
    times, modes = unit.changes
    np.testing.assert_allclose(times[modes != SLIPS], expected, rtol=0.0, atol=1e-7)
    np.testing.assert_allclose(
        unit.state, reference.at_end, rtol=0.0, atol=1e-7 if system is RESTING else 1e-8
    )
    if system is RESTING:
        carried = system.shaft_damping * (system.disc_speed - system.shaft_speed)
        assert unit["friction_moment"] == pytest.approx(carried, rel=1e-12)


@pytest.mark.parametrize(
    ("system", "start", "until", "epsilons", "more"),
    [
        (FIG5, WHIRL, 15.0, (4e-5, 1e-5), {"exact": 0.0, "tolerance": 1e-9}),
        # A step control by the mean slip alone would miss the direction of a slow point.
        (SIX, PIVOTING, 40.0, (1e-7, 1e-8), {"tolerance": 1e-9}),
        # Explicit steps would be 8e-5 s long, or 8e-7 s.
        (replace(RESTING, contact_points=3), (0.3, 0.1, 0.0, 0.2, 0.3, 0.4), 30.0, (1e-5, 1e-7), {}),
    ],
    ids=["pin", "points that pivot", "points that rest"],
)
def test_error_of_creep_is_of_first_order_in_epsilon_at_constant_cost(
    instance, system, start, until, epsilons, more
):
    reference, errors = reference_model.simulate(system, start, [0.0, until], tolerance=1e-12).at_end, []
    for epsilon in epsilons:
        unit = started(instance, system, start, regularisation=epsilon, **more)
        unit.to(until)
        assert unit.steps() < (15_000 if until == 30.0 else 150_000)
        errors.append(np.max(np.abs(unit.state - reference)))
    order = np.log(errors[0] / errors[1]) / np.log(epsilons[0] / epsilons[1])
    assert order == pytest.approx(1.0, abs=0.25 if system is FIG5 else 0.1), errors


def test_a_held_pin_creeps_by_default_at_the_share_of_its_capacity_in_micrometres_per_second(instance):
    """At 0.9 of the capacity that is 3.2 mm per hour."""
    share = 0.9
    pin = instance("pin", exact=0.0, damping=0.0, disc_speed=0.0, offset=0.0, x=share * 0.09, vx=0.0, vy=0.0)
    pin.started().to(10.0)
    assert pin["slip_speed"] == pytest.approx(share * 1e-6, rel=1e-3)
    assert share * 0.09 - pin["x"] == pytest.approx(share * 1e-5, rel=1e-3)


@pytest.mark.parametrize(
    "contact", [{"inner_radius": 0.06}, {"contact_points": 5.0}], ids=["annulus", "points"]
)
def test_holding_clutch_agrees_with_another_solver(instance, contact):
    held = {"speed_a": 100.0, "speed_b": 99.999, "offset": 1e-4, "static_ratio": 1.2, "regularisation": 1e-5}
    unit, other = (instance("clutch", **held, **contact).started() for _ in range(2))

    def rates(time, state):
        other.state = state
        return other.rates

    def jacobian(time, state):
        other.state = state
        columns = [other.along(**{one.name: 1.0}) for one in other.model.states]
        return np.array([[column[one.name] for column in columns] for one in other.model.derivatives])

    run = solve_ivp(rates, (0.0, 0.01), unit.state, "Radau", [0.01], rtol=1e-9, atol=1e-13, jac=jacobian)
    unit.to(0.01)
    x, y, vx, vy, heat = np.abs(unit.state - run.y[:, -1])
    assert max(x, y) < 1e-13
    assert max(vx, vy) < 1e-11
    assert heat < 1e-9
    assert unit["slip_speed"] > 1e-5
    assert unit.steps() < 1000


def test_point_sticks_and_is_released_at_the_slip_speed_epsilon(instance):
    unit = started(instance, SIX, PIVOTING, regularisation=1e-6)
    for until, resting, count in ((33.0, 0, 0), (33.15, 1, 1), (34.0, 0, 2)):
        unit.to(until)
        assert (unit["resting_points"], unit["rest_count"]) == (resting, count)
        if count:
            x, y, angle, vx, vy, spin = unit.values(*(f"rest_{name}" for name, _ in COLUMNS[DiscOnDisc]))
            arms = SIX.contact_radius * np.exp(1j * (angle + np.pi / 3.0 * np.arange(6)))
            slips = complex(vx, vy) + 1j * spin * arms - 1j * SIX.disc_speed * (complex(x, y) + arms)
            assert np.min(np.abs(slips)) == pytest.approx(1e-6, rel=1e-6)


def test_pin_on_a_plane_stops_at_the_exact_time_at_a_coarse_tolerance(instance):
    plane = replace(
        FIG5, mass=1.0, disc_speed=0.0, stiffness=0.0, damping=0.0, offset=0.0, friction_force=0.1
    )
    unit = started(instance, plane, (0.0, 0.0, 0.3, 0.0), tolerance=1e-6)
    unit.to(4.0)
    assert unit["stick_time"] == pytest.approx(3.0, abs=1e-8)
    assert unit["x"] == pytest.approx(0.45, abs=1e-12)


def test_late_parameters_and_invalid_steps_are_refused(instance):
    unit = started(instance, FIG5, WHIRL)
    assert unit.set(mass=2.0) == [1]
    assert unit.sentence == "mass cannot be set after initialisation"
    for until in (np.nan, np.inf, -1.0):
        assert unit.advance(ctypes.c_double(until)) == 1
        assert unit.sentence == f"step from t = 0 s to {until:g} s: it must be finite and must not go back"


def inside(unit, mode):
    """Simulate the pin of Fig. 5 to a time shortly after 5.3 s when it is in ``mode``."""
    for time in 5.3 + 1e-4 * np.arange(60):
        unit.to(time)
        if unit.mode() == mode:
            return unit
    raise AssertionError(f"the unit never reaches mode {mode}")


POINTS = {"x": 0.05, "y": -0.02, "angle": 0.3, "contact_points": 5.0, "regularisation": 1.2e-3}
CLUTCH = {
    "speed_a": 20.0,
    "x": 1e-3,
    "y": -2e-3,
    "vx": 0.05,
    "vy": 0.03,
    "stiffness": 100.0,
    "engagement": 0.9,
}
CLUTCH |= {"regularisation": 0.1, "static_ratio": 1.2, "plates": 3.0}
FACES = {"inner_radius": 0.07, "pressure_outer": 0.5}
CASES = {
    "pin slips": lambda instance: started(instance, replace(FIG5, hardening=3.0), (0.3, -0.2, 0.03, 0.1)),
    "pin sticks": lambda instance: inside(started(instance, FIG5, WHIRL), STICKS),
    "pin leaves": lambda instance: inside(started(instance, FIG5, WHIRL), LEAVES),
} | {
    name: lambda instance, model=model, values=values: instance(model, **values).started()
    for name, model, values in (
        ("disc slips", "disc", {"x": 0.05, "y": -0.02, "spin": 1.6, "stop_gap": 0.01, "stop_stiffness": 5.0}),
        ("points slip", "disc", POINTS | {"vx": 0.03, "spin": 1.6}),
        # Two points slip, and three are below regularisation.
        ("points creep", "disc", POINTS | {"vx": 0.0302, "vy": 0.075, "spin": 1.51}),
        ("clutch slips", "clutch", CLUTCH | FACES | {"speed_b": 30.0}),
        ("clutch falls from its peak", "clutch", CLUTCH | FACES | {"speed_b": 21.5}),
        ("clutch creeps", "clutch", CLUTCH | FACES | {"speed_b": 20.01, "wear": 1.0}),
        ("clutch points", "clutch", CLUTCH | {"speed_b": 21.5, "contact_points": 5.0, "angle_b": 0.3}),
    )
}


@pytest.mark.parametrize("case", CASES)
def test_directional_derivatives_are_derivatives(instance, case):
    unit = CASES[case](instance)
    model = unit.model
    knowns = [one.name for one in model.having("state", "input") if one.name != "heat"]
    unknowns = [one.name for one in model.having("derivative", "output") if one.type == "real"]
    at, slip = unit.values(*knowns), unit["slip_speed"]
    for i, known in enumerate(knowns):
        step = 1e-3 * slip if case == "pin leaves" else 1e-6 * max(abs(at[i]), 1e-2)
        found, sides = unit.along(**{known: 1.0}), []
        for sign in (1.0, -1.0):
            put(unit, dict(zip(knowns, at + sign * step * np.eye(len(at))[i], strict=True)))
            sides.append(unit.values(*unknowns))
        put(unit, dict(zip(knowns, at, strict=True)))
        expected = (sides[0] - sides[1]) / (2.0 * step)
        rounding = np.maximum(np.abs(sides[0]), 1.0) / step * 2e-15
        allowed = np.maximum(rounding, 1e-5 * np.maximum(np.abs(expected), 1e-2))
        difference = np.abs([found[one] for one in unknowns] - expected)
        assert np.all(difference <= allowed), (known, expected, difference)


def put(unit, values):
    states = {one.name for one in unit.model.states}
    unit.set(**{name: value for name, value in values.items() if name not in states})
    unit.state = [values.get(one.name, 0.0) for one in unit.model.states]


@pytest.mark.parametrize("lacking", [1e-5, 1e-9])
def test_pin_is_released_briefly_if_friction_is_slightly_too_small(instance, lacking):
    """Friction is smaller than the maximum of (7) in a turn by a small share."""
    radius, angles = 0.1, np.linspace(0.0, 2.0 * np.pi, 20_001)
    squared = squared_holding_force(FIG5, radius, angles)
    pin = replace(FIG5, friction_force=(1.0 - lacking) * np.sqrt(squared.max()))
    start = radius * np.exp(1j * (angles[np.argmax(squared)] - 0.5))
    carried = 1j * pin.disc_speed * start
    unit = started(instance, pin, (start.real, start.imag, carried.real, carried.imag))
    until = 1.0 / pin.disc_speed  # half a radian past the maximum
    unit.to(until)
    modes = unit.changes[1].tolist()
    assert modes in ([STICKS, LEAVES, STICKS], [STICKS, LEAVES, SLIPS, STICKS])
    end = start * np.exp(1j * pin.disc_speed * until)
    np.testing.assert_allclose(unit.state[:2], [end.real, end.imag], rtol=0.0, atol=lacking * radius)
    assert unit["slip_speed"] == 0.0
