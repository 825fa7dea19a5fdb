"""The drivetrain against closed forms of its parts: rotors, torsional spring, unbalanced disc, slipping clutch."""

import math
from dataclasses import replace

import numpy as np
import pytest

from exudyn_models import PASSENGER_CAR, build_drivetrain, four_cylinder
from exudyn_models.drivetrain.picture import draw_drivetrain
from exudyn_models.solver.linear.matrices import state_matrix

CENTRED = replace(PASSENGER_CAR, offset=0.0, unbalance=0.0)
EPSILON = 1e-3
SPEED, SLIP, TORQUE = 200.0, 20.0, 60.0


def slipping(car=CENTRED, **options):
    options = {
        "normal_load": car.normal_load(TORQUE),
        "regularisation": EPSILON,
        "engine_speed": SPEED,
        "gearbox_speed": SPEED - SLIP,
    } | options
    return build_drivetrain(car, **options)


@pytest.mark.parametrize("inner", [0.0, 0.05, CENTRED.outer_radius], ids=["full", "facings", "ring"])
def test_a_centred_clutch_transmits_its_torque_and_turns_slip_into_heat(inner):
    """No other moment acts on the engine: J·Δω = −M·t until slip ends, and the heat is M·∫slip dt."""
    car = replace(CENTRED, inner_radius=inner)
    motion = slipping(car, shaft_torque=TORQUE).run(0.04, sample_every=1e-3)
    assert motion.slip[-1] > 3.0
    expected = SPEED - TORQUE * motion.times / CENTRED.engine_inertia
    np.testing.assert_allclose(motion.engine_speed, expected, rtol=1e-9)
    turned = motion.engine_angle - motion.disc[:, 2]
    np.testing.assert_allclose(motion.energy.losses["friction"][1:], TORQUE * turned[1:], rtol=1e-8)
    assert np.max(np.abs(motion.disc[:, :2])) == 0.0


def test_engine_disc_and_vehicle_keep_their_angular_momentum_and_the_disc_starts_at_rest_on_its_shaft():
    motion = slipping(shaft_torque=30.0).run(0.04, sample_every=1e-2)
    momentum = (
        CENTRED.engine_inertia * motion.engine_speed
        + CENTRED.disc_inertia * motion.disc_velocity[:, 2]
        + CENTRED.vehicle_inertia * motion.vehicle_speed
    )
    np.testing.assert_allclose(momentum, momentum[0], rtol=1e-10)
    motion = slipping(PASSENGER_CAR).run(1e-5, sample_every=1e-5)
    assert motion.disc[0].tolist() == [PASSENGER_CAR.offset, 0.0, 0.0]
    assert motion.disc_velocity[0].tolist() == [0.0, 0.0, SPEED - SLIP]
    assert motion.slip[0] == SLIP


@pytest.mark.parametrize("unbalance", [0.0, 0.02])
def test_the_torsional_spring_swings_at_its_frequency(unbalance):
    """Two rotors on a spring: λ² + (c/J)λ + k/J = 0 with 1/J = 1/J_d + 1/J_v, J_d about the centre of mass."""
    car = replace(CENTRED, unbalance=unbalance, radial_stiffness=0.0, radial_damping=0.0)
    inertia = 1.0 / (1.0 / car.disc_inertia + 1.0 / car.vehicle_inertia)
    expected = np.roots([inertia, car.torsional_damping, car.torsional_stiffness])
    found = np.linalg.eigvals(state_matrix(slipping(car, normal_load=0.0, gearbox_speed=0.0).mbs))
    for value in expected:
        assert np.min(np.abs(found - value)) < 1e-9 * abs(value)


def test_the_initial_twist_carries_the_torque_of_the_shaft():
    motion = slipping(normal_load=0.0, shaft_torque=30.0).run(1e-6, sample_every=1e-7, largest_step=1e-7)
    gained = CENTRED.vehicle_inertia * (motion.vehicle_speed - motion.vehicle_speed[0])
    np.testing.assert_allclose(gained[1:], 30.0 * motion.times[1:], rtol=1e-3)


def test_an_unbalanced_disc_whirls_as_jeffcotts_rotor_on_a_hardening_shaft():
    """m·z̈ + β·ż + (C + C₃·|z|²)·z = m·e·s²·exp(ist) in the steady whirl at the spin s."""
    car = replace(CENTRED, unbalance=1.5e-5, hardening=1e13, stop_stiffness=0.0, vehicle_inertia=1e9)
    spin = 250.0
    decay = car.radial_damping / (2.0 * car.disc_mass)
    model = slipping(car, normal_load=0.0, gearbox_speed=spin)
    motion = model.run(16.0 / decay, sample_every=1e-3, tolerance=1e-10)
    radius = np.hypot(*motion.disc[motion.times > 15.0 / decay, :2].T)
    stiffness = car.radial_stiffness + car.hardening * radius**2
    impedance = stiffness - car.disc_mass * spin**2 + 1j * car.radial_damping * spin
    np.testing.assert_allclose(np.abs(impedance) * radius, car.disc_mass * car.unbalance * spin**2, rtol=1e-5)
    assert stiffness.min() > 1.05 * car.radial_stiffness


def test_a_load_that_reads_the_slip_holds_it():
    torque = CENTRED.vehicle_inertia / (CENTRED.vehicle_inertia + CENTRED.engine_inertia) * TORQUE
    model = slipping(engine_torque=four_cylinder(TORQUE, 0.0), shaft_torque=torque)
    needed = CENTRED.normal_load(torque)
    model.friction.change(normal_load=lambda time: max(0.0, needed * (1.0 + 0.2 * (model.slip() - 5.0))))
    motion = model.run(1.0, sample_every=1e-2)
    # The feed-forward neglects the disc's inertia, 1 % of the vehicle's.
    assert motion.slip[-1] == pytest.approx(5.0, abs=0.1)
    assert motion.energy.gains["engine"][-1] > 0.0
    assert np.max(np.abs(motion.energy.residual)) < 1e-6 * motion.energy.turnover


def test_four_cylinders_fire_twice_a_turn():
    torque = four_cylinder(100.0, 0.8)
    angles = 2.0 * math.pi * np.arange(64) / 64
    amplitudes = np.abs(np.fft.rfft([torque(0.0, angle, 300.0) for angle in angles])) / 64
    assert amplitudes[0] == pytest.approx(100.0)
    assert 2.0 * amplitudes[2] == pytest.approx(80.0)
    assert np.max(np.delete(amplitudes, [0, 2])) < 1e-12


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"offset": math.nan}, "offset = nan: it must be finite"),
        ({"engine_inertia": 0.0}, "engine_inertia = 0: it must be > 0"),
        ({"disc_mass": -1.0}, "disc_mass = -1: it must be > 0"),
        ({"outer_radius": 0.0}, "outer_radius = 0: it must be > 0"),
        ({"stop_gap": -1.0}, "stop_gap = -1: it must be >= 0"),
        ({"faces": 1.5}, r"faces = 1\.5: it must be a whole number >= 1"),
    ],
)
def test_invalid_drivetrains_are_refused(change, message):
    with pytest.raises(ValueError, match=message):
        replace(PASSENGER_CAR, **change)


def test_facings_inside_out_and_an_invalid_ripple_are_refused():
    with pytest.raises(ValueError, match="outer_radius"):
        slipping(replace(CENTRED, inner_radius=0.2))
    with pytest.raises(ValueError, match="ripple = nan: it must be finite"):
        four_cylinder(100.0, math.nan)


def test_the_picture_shows_the_disc_where_it_is():
    """The mean position of the orange facing follows the disc, but does not move without magnification."""

    def facing(x, magnification):
        image = draw_drivetrain(
            CENTRED, engine_angle=0.7, disc=(x, 0.0, 0.0), magnification=magnification, size=(160, 120)
        ).astype(int)
        orange = (image[..., 0] - image[..., 2] > 80) & (image[..., 1] < 120)
        assert 300 < np.count_nonzero(orange) < 8000
        return np.argwhere(orange).mean(axis=0)

    assert facing(1e-3, 0.0) == pytest.approx(facing(-1e-3, 0.0), abs=1e-12)
    assert facing(1e-3, 20.0)[1] - facing(-1e-3, 20.0)[1] > 2.0


@pytest.mark.parametrize("value", [float("nan"), True, "1_0", 1j, np.timedelta64(5, "ms")])
@pytest.mark.parametrize(
    "name", ["engine_speed", "gearbox_speed", "shaft_torque", "engine_torque", "vehicle_torque"]
)
def test_drivetrain_refuses_wrong_speeds_and_torques(name, value):
    arguments = {"normal_load": 1.0, "regularisation": 1e-3, "engine_speed": 1.0, "gearbox_speed": 0.0}
    with pytest.raises(ValueError, match=f"^{name}.* = .*: it must be"):
        build_drivetrain(PASSENGER_CAR, **(arguments | {name: value}))


@pytest.mark.parametrize("value", [float("inf"), 0.0, -1.0, True, None, "1"])
@pytest.mark.parametrize("name", ["until", "sample_every", "largest_step", "tolerance"])
def test_run_refuses_what_is_not_positive(name, value):
    model = build_drivetrain(
        PASSENGER_CAR, normal_load=1.0, regularisation=1e-3, engine_speed=1.0, gearbox_speed=0.0
    )
    with pytest.raises(ValueError, match=f"^{name} = .*: it must "):
        model.run(**({"until": 1e-3, "sample_every": 1e-3} | {name: value}))
