"""A launch of the passenger car against closed forms: slip up to lock-up, and creep during stick."""

import math
from dataclasses import replace

import numpy as np
import pytest

from exudyn_models import PASSENGER_CAR, build_drivetrain, four_cylinder

CENTRED = replace(PASSENGER_CAR, offset=0.0, unbalance=0.0)
ENGINE_SPEED, TORQUE, RATE = 210.0, 100.0, 225.0
"""Speed in rad/s, torque in N m, and growth rate of the clutch's capacity in N m/s."""


def full_slip(car, until, tolerance=1e-9):
    model = build_drivetrain(
        car,
        normal_load=lambda time: car.normal_load(RATE * time),
        regularisation=0.05,
        engine_speed=ENGINE_SPEED,
        gearbox_speed=0.0,
        engine_torque=four_cylinder(TORQUE, 0.0),
    )
    return model.run(until, sample_every=until / 10, largest_step=0.01, tolerance=tolerance)


@pytest.mark.parametrize("stiffness", [1000.0, 1500.0])
def test_a_slipping_clutch_moves_and_heats_by_the_closed_form(stiffness):
    """A constant torque and a clutch moment of RATE·t give parabolas, apart from the wind-up of the spring.

    The twist θ obeys J_r·θ'' + d·θ' + k·θ = g·RATE·t with g = J_v/(J_d + J_v), and the disc leads the rigid
    drivetrain by the speed g·θ'. The first oscillation has decayed and adds (d²/k − J_r)·g·RATE/k² to ∫θ dt.
    """
    car = replace(CENTRED, torsional_stiffness=stiffness)
    until = 0.95
    motion = full_slip(car, until)
    assert 5.0 < motion.slip[-1] < 60.0  # near lock-up
    both, k, d = car.disc_inertia + car.vehicle_inertia, car.torsional_stiffness, car.torsional_damping
    given, g = RATE * until**2 / 2.0, car.vehicle_inertia / both
    wind_up = g * g * RATE / k
    speeds = (
        ENGINE_SPEED + (TORQUE * until - given) / car.engine_inertia,
        given / both + wind_up,
        given / both - wind_up * car.disc_inertia / car.vehicle_inertia,
    )
    found = motion.engine_speed[-1], motion.disc_velocity[-1, 2], motion.vehicle_speed[-1]
    np.testing.assert_allclose(found, speeds, rtol=1e-7)
    ramp = g * RATE / k
    area = ramp * (until**2 / 2.0 - d / k * until + (d**2 / k - car.disc_inertia * g) / k)
    rigid = (
        ENGINE_SPEED * until**2 / 2.0
        + TORQUE / car.engine_inertia * until**3 / 3.0
        - RATE * (1.0 / car.engine_inertia + 1.0 / both) / 2.0 * until**4 / 4.0
    )
    heat = RATE * (rigid - g * (until * ramp * (until - d / k) - area))
    assert motion.energy.losses["friction"][-1] == pytest.approx(heat, rel=1e-7)


def test_an_unbalanced_disc_and_both_rotors_gain_the_impulse_of_the_engine():
    """The undamped support at the origin exerts no moment about the engine's axis."""
    car = replace(PASSENGER_CAR, offset=0.0, radial_damping=0.0, unbalance=1e-3)
    motion = full_slip(car, 0.7)
    (x, y, angle), (vx, vy, spin) = motion.disc[-1], motion.disc_velocity[-1]
    arm = car.unbalance * np.exp(1j * angle)
    centre, velocity = complex(x, y) + arm, complex(vx, vy) + 1j * spin * arm
    found = (
        car.disc_mass * (centre.conjugate() * velocity).imag
        + car.disc_inertia * spin
        + car.engine_inertia * motion.engine_speed[-1]
        + car.vehicle_inertia * motion.vehicle_speed[-1]
    )
    # A tighter bound is needed because the unbalance has only 1e-6 of the momentum.
    assert found == pytest.approx(car.engine_inertia * ENGINE_SPEED + TORQUE * 0.7, rel=1e-9)


@pytest.mark.parametrize(("epsilon", "resistance"), [(0.1, 60.0), (0.4, 0.0)])
def test_a_clutch_that_holds_creeps_in_proportion_to_the_torque_it_transmits(epsilon, resistance):
    """Below ε the moment is capacity·(R·slip/ε), and engine, disc and vehicle accelerate as one body."""
    ring = replace(CENTRED, inner_radius=0.1, outer_radius=0.1, torsional_damping=20.0)
    capacity = 180.0
    model = build_drivetrain(
        ring,
        normal_load=ring.normal_load(capacity),
        regularisation=epsilon,
        engine_speed=150.0,
        gearbox_speed=150.0,
        engine_torque=four_cylinder(TORQUE, 0.0),
        vehicle_torque=lambda time, angle, speed: -resistance,
    )
    motion = model.run(0.5, sample_every=0.5, largest_step=0.01, tolerance=1e-9)
    inertia = ring.engine_inertia + ring.disc_inertia + ring.vehicle_inertia
    transmitted = TORQUE - ring.engine_inertia * (TORQUE - resistance) / inertia
    creep = transmitted / capacity * epsilon / 0.1
    assert motion.slip[-1] == pytest.approx(creep, rel=1e-6)
    assert math.isclose(motion.engine_speed[-1] - motion.vehicle_speed[-1], creep, rel_tol=1e-5)
