"""Friction of rotors on Exudyn's own coordinate connectors equals the law of the general connector."""

from functools import partial

import exudyn as exu
import numpy as np
import pytest
from free_bodies import drive, new_model, rate_of, rotor, settings_of

from exudyn_models import add_ring_friction, largest_stable_step, solve_dynamic

SOLVERS = exu.DynamicSolverType
LOAD, EPSILON = 500.0, 1e-2
BUILT_IN, OF_TIME, USER_FUNCTION = (
    "ConnectorCoordinateSpringDamperExt",
    "ConnectorCoordinateSpringDamper",
    "GenericODE2",
)
RING = {"contact_radius": 0.12}
WORN = {"inner_radius": 0.05, "outer_radius": 0.12, "pressure": "wear"}


def in_python(time):
    """Return the same load, as a function."""
    return LOAD


def of_slip(slip_speed):
    """Return the same load, as a function of the motion."""
    return LOAD


def braked(load, grounded, spin=20.0, **contact):
    """Return a model of a rotor that another one or the ground brakes, the rotor and its contact."""
    mbs = new_model()
    master = None if grounded else rotor(mbs, 0.3, 1.5)
    disc = rotor(mbs, 0.9, spin if grounded else 1.5 + spin)
    facing = {"friction_coefficient": 0.3, "regularisation": EPSILON, "contact_radius": 0.12} | contact
    if "inner_radius" in facing:
        del facing["contact_radius"]
    return mbs, disc, add_ring_friction(mbs, master, disc, normal_load=load, **facing)


def kind_of(contact):
    return contact.mbs.GetObject(contact.item)["objectType"]


def end_of(load, grounded, solver, **contact):
    """Return the speeds and the heat of a run that ends in stick."""
    mbs, disc, friction = braked(load, grounded, -20.0 if grounded else 20.0, **contact)
    drive(mbs, disc, 3.0)
    heat = friction.add_sensor("heat")
    settings = settings_of(1.2, 1000, newton=1e-12)
    settings.timeIntegration.absoluteTolerance, settings.timeIntegration.relativeTolerance = 1e-9, 0.0
    solve_dynamic(mbs, settings, solver)
    return np.append(mbs.systemData.GetODE2Coordinates_t(), mbs.GetSensorValues(heat)), kind_of(friction)


@pytest.mark.parametrize(
    ("solver", "grounded", "geometry"),
    [
        ("RK44", True, RING),
        ("DOPRI5", False, WORN),
        ("TrapezoidalIndex2", True, WORN),
        ("GeneralizedAlpha", False, RING),
    ],
)
def test_motion_and_heat_equal_the_user_function_to_rounding(solver, grounded, geometry):
    ends, kinds = zip(
        *(
            end_of(load, grounded, getattr(SOLVERS, solver), plates=2, **geometry)
            for load in (LOAD, in_python, of_slip)
        ),
        strict=True,
    )
    assert kinds == (BUILT_IN, OF_TIME, USER_FUNCTION)
    np.testing.assert_allclose(ends[:2], [ends[2]] * 2, rtol=1e-11, atol=1e-11)


@pytest.mark.parametrize(
    "contact",
    [
        {"static_ratio": 1.2},
        {"friction_coefficient": [[0.0, 0.3], [1.0, 0.2]]},
        {"friction_coefficient": lambda slip_speed: 0.3},
        {"regularisation": None},
        {"contact_radius": 0.0},
    ],
    ids=["static friction", "table", "function", "exact stick", "pin"],
)
def test_any_other_law_keeps_its_user_function(contact):
    assert kind_of(braked(LOAD, False, **contact)[2]) == USER_FUNCTION


def test_the_load_may_become_a_function_and_a_number_again():
    mbs, _, contact = braked(LOAD, False, speed := 200.0)
    spin = contact.add_sensor("relative_spin")
    settings = settings_of(0.1, 400)
    rate = 0.3 * LOAD * 0.12 * (1.0 / 0.3 + 1.0 / 0.9)  # rad/s²
    for part, (load, expected) in enumerate(
        (
            (LOAD, lambda speed: speed - 0.1 * rate),
            (lambda time: 2.0 * LOAD, lambda speed: speed - 0.2 * rate),
            (lambda slip_speed: LOAD * slip_speed, lambda speed: speed * np.exp(-0.1 * rate * 0.12)),
            (3.0 * LOAD, lambda speed: speed - 0.3 * rate),
        )
    ):
        contact.change(normal_load=load)
        settings.timeIntegration.startTime, settings.timeIntegration.endTime = 0.1 * part, 0.1 * (part + 1)
        solve_dynamic(mbs, settings, SOLVERS.RK44, updateInitialValues=True)
        speed = expected(speed)
        assert mbs.GetSensorValues(spin) == pytest.approx(speed, rel=1e-11), part


@pytest.mark.parametrize("load", [LOAD, in_python], ids=["number", "function"])
@pytest.mark.parametrize("result", [-1.5, np.inf, np.nan, True, None, np.ones(1)], ids=str)
def test_an_invalid_load_after_a_change_is_reported_with_its_time(load, result):
    mbs, _, contact = braked(load, True)
    contact.change(normal_load=lambda time: result if time > 0.05 else 1.0)
    with pytest.raises(exu.ExudynError, match=r"normal_load\(time = 0.0[56].* s\) = ") as error:
        solve_dynamic(mbs, settings_of(0.1, 10), SOLVERS.RK44)
    assert str(result) in str(error.value)


@pytest.mark.parametrize(
    "load",
    [
        lambda *, time: LOAD * (1.0 + time),
        partial(lambda factor, time: factor * (1.0 + time), LOAD),
        partial(lambda time, factor: factor * (1.0 + time), factor=LOAD),
        lambda time: np.float64(LOAD * (1.0 + time)),
        lambda time: int(LOAD) + LOAD * time,
    ],
    ids=["by name", "first argument given", "second argument given", "NumPy", "sum"],
)
def test_any_function_of_time_may_be_a_load(load):
    mbs, disc, contact = braked(load, True, speed := 200.0)
    solve_dynamic(mbs, settings_of(0.1, 10), SOLVERS.RK44)
    assert kind_of(contact) == OF_TIME
    assert rate_of(mbs, disc) == pytest.approx(speed - 0.3 * LOAD * 0.12 * (0.1 + 0.005) / 0.9, rel=1e-12)


@pytest.mark.parametrize("spin", [0.0, 20.0, EPSILON / 0.12])
def test_the_largest_stable_step_does_not_depend_on_the_connector(spin):
    limits = [largest_stable_step(braked(load, False, spin)[0], SOLVERS.RK44) for load in (LOAD, in_python)]
    inertia = 1.0 / (1.0 / 0.3 + 1.0 / 0.9)
    assert limits == pytest.approx([2.7852935 * inertia * EPSILON / (0.3 * LOAD * 0.12**2)] * 2, rel=1e-9)


def test_the_step_limit_leaves_the_contact_active():
    mbs, disc, _ = braked(LOAD, True)
    largest_stable_step(mbs, SOLVERS.RK44)
    mbs.SolveDynamic(settings_of(0.1, 100), SOLVERS.RK44)
    assert rate_of(mbs, disc) < 19.0


def test_contacts_of_a_model_that_was_reset_are_forgotten():
    mbs, *_ = braked(LOAD, True, regularisation=None)
    mbs.Reset()
    disc = rotor(mbs, 0.9, 20.0)
    assert solve_dynamic(mbs, settings_of(0.1, 100), SOLVERS.RK44) == []
    assert rate_of(mbs, disc) == 20.0
    assert largest_stable_step(mbs, SOLVERS.RK44) == np.inf
