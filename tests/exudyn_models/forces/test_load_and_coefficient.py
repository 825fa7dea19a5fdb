"""Loads and coefficients as functions of time, radius and slip, and the resulting sensor values."""

import math
from functools import partial

import exudyn as exu
import numpy as np
import pytest
from free_bodies import (
    coordinates,
    felt_accelerations,
    new_model,
    planar_body,
    rotor,
    run_explicitly,
    settings_of,
)

from exudyn_models import add_ring_friction
from exudyn_models.forces.friction_laws import CONTINUOUS, NONE_HELD
from exudyn_models.forces.load_and_coefficient import LoadAndCoefficient

INERTIA, MASTER_INERTIA, MASS, RADIUS, MU, LOAD = 0.02, 0.7, 1.5, 0.12, 0.25, 2.0
SPIN, MASTER_SPIN = -40.0, 60.0
CONTACT = {
    "contact_radius": RADIUS,
    "friction_coefficient": MU,
    "normal_load": LOAD,
    "regularisation": 1e-3,
    "contact_points": None,
}
RATE = (1.0 / INERTIA + 1.0 / MASTER_INERTIA) * RADIUS
"""Rate in 1/(N s²) at which friction changes S = φ̇ − ω."""


def spinning_disc(**contact):
    """Return a disc that spins on a rotor on the same axis: S = φ̇ − ω changes by −RATE·∫μN dt·sign(S)."""
    mbs = new_model()
    master = rotor(mbs, MASTER_INERTIA, MASTER_SPIN)
    disc = planar_body(mbs, MASS, INERTIA, [0.0] * 3, [0.0, 0.0, SPIN])
    return mbs, master, disc, add_ring_friction(mbs, master, disc, **CONTACT | contact)


def spins(mbs, master, disc):
    return float(np.squeeze(coordinates(mbs, disc)[1][-1])), float(np.squeeze(coordinates(mbs, master)[1]))


def expected_spins(impulse):
    """Return φ̇ and ω in rad/s after ∫μN dt in N s, while the disc is still slower."""
    return (
        pytest.approx(SPIN + RADIUS * impulse / INERTIA, rel=1e-11),
        pytest.approx(MASTER_SPIN - RADIUS * impulse / MASTER_INERTIA, rel=1e-11),
    )


def test_load_and_coefficient_can_be_changed_between_two_runs():
    mbs, *bodies, friction = spinning_disc()
    changes = [
        ({}, MU * LOAD),
        ({"normal_load": 3.0 * LOAD}, 3.0 * MU * LOAD),
        ({"friction_coefficient": 0.5 * MU}, 1.5 * MU * LOAD),
        ({"normal_load": lambda time: time}, 0.5 * MU * 3.5),
        ({"normal_load": lambda radius: LOAD}, 0.5 * MU * LOAD),
        ({"friction_coefficient": lambda slip_speed: MU}, MU * LOAD),
        ({"friction_coefficient": MU, "normal_load": LOAD}, MU * LOAD),
    ]
    mbs.Assemble()
    for i, (change, _) in enumerate(changes):
        friction.change(**change)
        mbs.SolveDynamic(settings_of(i + 1.0, 200, float(i)), exu.DynamicSolverType.RK67, True)
    assert spins(mbs, *bodies) == expected_spins(sum(added for _, added in changes))


def test_a_change_that_is_refused_leaves_the_friction_as_it_was():
    mbs, *bodies, friction = spinning_disc()
    mbs.Assemble()
    with pytest.raises(ValueError, match="normal_load = -1 N: it must be >= 0"):
        friction.change(friction_coefficient=2.0 * MU, normal_load=-1.0)
    friction.change()  # keeps both
    run_explicitly(mbs, 1.0, 100)
    assert spins(mbs, *bodies) == expected_spins(MU * LOAD)


class Ramp:
    def __call__(self, time):
        return 10.0 * time


@pytest.mark.parametrize(
    ("function", "expected"),
    [
        (lambda slip_speed, radius, time: 100.0 * slip_speed + 10.0 * radius + time, 532.0),
        (lambda *, radius, time: 10.0 * radius + time, 32.0),
        (lambda time, gain=4.0, radius=1.0: gain * time + radius, 11.0),
        (partial(lambda time, radius: time + radius, radius=0.5), 2.5),
        (lambda: 7.0, 7.0),
        (lambda relative_spin, time: 10.0 * time + relative_spin, 13.0),
        (Ramp(), 20.0),
        (lambda time: np.float64(3.0), 3.0),
    ],
)
def test_a_function_receives_the_arguments_that_it_names(function, expected):
    contact = (RADIUS, CONTINUOUS, 1.0, 1e-3, NONE_HELD, RADIUS)
    for factors in ((0.5, function), (function, 0.5)):
        assert LoadAndCoefficient(contact, *factors).friction_force(2.0, 3.0, 5.0, -7.0) == 0.5 * expected


def slip_under_control(disc_kind, steps):
    """Return the rim slip after 1 s under N = N₀ + K(|W| − W₁), and as d|W|/dt = −RATE·R·μN predicts it.

    Without ``steps`` the solver is explicit.
    """
    constant, gain, target, sensor = 2.0, 0.3, 11.0, None
    mbs = new_model()
    master = rotor(mbs, MASTER_INERTIA, MASTER_SPIN)
    planar = disc_kind == "planar"
    disc = (
        planar_body(mbs, MASS, INERTIA, [0.0] * 3, [0.0, 0.0, SPIN]) if planar else rotor(mbs, INERTIA, SPIN)
    )

    def load(time):
        return constant + gain * (abs(mbs.GetSensorValues(sensor)) - target)

    friction = add_ring_friction(mbs, master, disc, **CONTACT | {"normal_load": load})
    sensor = friction.add_sensor("rim_slip")
    mbs.Assemble()
    if steps is None:
        run_explicitly(mbs, 1.0, 400)
    else:
        settings = settings_of(1.0, steps, newton=1e-11)
        assert exu.MainSolverImplicitSecondOrder().SolveSystem(mbs, settings)
    spin, master_spin = spins(mbs, master, disc)
    end = target - constant / gain
    decay = math.exp(-RATE * RADIUS * MU * gain)
    return RADIUS * (master_spin - spin), end + (RADIUS * (MASTER_SPIN - SPIN) - end) * decay


@pytest.mark.parametrize("disc_kind", ["planar", "rotor"])
def test_a_controller_of_the_load_brings_the_slip_to_its_target_exponentially(disc_kind):
    slip, expected = slip_under_control(disc_kind, None)
    assert slip == pytest.approx(expected, rel=1e-11)
    errors = [np.subtract(*slip_under_control(disc_kind, steps)) for steps in (100, 200)]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.05)


@pytest.mark.parametrize(
    "quantity", ["power", "transmitted_moment", "radial_force", "capacity_share", "mode"]
)
def test_a_load_that_depends_on_its_own_friction_is_refused_in_the_run(quantity):
    sensor = None

    def load(time):
        return 1.0 + abs(np.sum(mbs.GetSensorValues(sensor)))

    mbs, *_, friction = spinning_disc(normal_load=load)
    sensor = friction.add_sensor(quantity)
    mbs.Assemble()
    message = f"depends on the sensor '{quantity}' of the same contact, which depends on them"
    with pytest.raises(exu.ExudynError, match=message):
        run_explicitly(mbs, 1.0, 10)


@pytest.mark.parametrize(
    ("coefficient", "load"),
    [(MU, LOAD), (lambda slip_speed: MU * math.exp(-slip_speed), lambda time: LOAD * (1.0 + time))],
)
def test_the_radial_force_sensor_shows_the_force_that_moves_the_disc(coefficient, load):
    mbs = new_model()
    master = planar_body(mbs, 2.0, MASTER_INERTIA, [0.3, -0.2, 0.1], [0.1, 0.05, 2.0])
    disc = planar_body(mbs, MASS, INERTIA, [0.5, 0.1, 0.4], [-0.2, 0.3, -1.0])
    contact = CONTACT | {"friction_coefficient": coefficient, "normal_load": load, "contact_points": 6}
    friction = add_ring_friction(mbs, master, disc, **contact)
    names = ("radial_force", "transmitted_moment", "centre_slip")
    sensors = [felt_accelerations(mbs, disc), *[friction.add_sensor(name) for name in names]]
    mbs.Assemble()
    run_explicitly(mbs, 0.1, 50)
    felt, force, moment, slip = (mbs.GetSensorValues(sensor) for sensor in sensors)
    np.testing.assert_allclose(force, [*(MASS * felt[:2]), 0.0], rtol=1e-11, atol=1e-12)
    assert moment == pytest.approx(INERTIA * felt[2], rel=1e-11)
    (z, v), (zm, vm) = (coordinates(mbs, node) for node in (disc, master))
    u = v[:2] - vm[:2] - vm[2] * np.array([zm[1] - z[1], z[0] - zm[0]])
    assert slip == pytest.approx(np.hypot(*u), rel=1e-12)


NONSENSE = [
    (
        "normal_load",
        lambda time: math.nan if time > 0.503 else LOAD,
        r"time = 0\.5(0[3-9]\d*|1) s\) = nan: it must",
    ),
    ("normal_load", lambda time: None, r"time = 0 s\) = None: it must be a number"),
    (
        "normal_load",
        lambda radius, time: 0.5 - radius - time,
        r"time = 0\.5\d* s, radius = 0 m\) = -\S+ N: it must be >= 0",
    ),
    ("normal_load", lambda radius: math.inf, r"time = 0 s, radius = 0 m\) = inf: it must be finite"),
    (
        "friction_coefficient",
        lambda slip_speed: -slip_speed,
        r"time = 0 s, slip_speed = 12 m/s\) = -12: it must be >= 0",
    ),
]


@pytest.mark.parametrize(("name", "function", "message"), NONSENSE)
@pytest.mark.parametrize("solver", ["RK44", "GeneralizedAlpha"])
def test_an_invalid_result_of_a_function_ends_the_run_with_its_arguments(name, function, message, solver):
    mbs, *_ = spinning_disc(**{name: function})
    mbs.Assemble()
    with pytest.raises(exu.ExudynError, match=rf"{name}\({message}") as raised:
        mbs.SolveDynamic(settings_of(2.0, 200), getattr(exu.DynamicSolverType, solver))
    assert isinstance(raised.value.__cause__, ValueError)
