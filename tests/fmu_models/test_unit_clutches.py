"""Clutch units in drivetrains: conservation laws, heat, and CoupledClutches of Modelica."""

import itertools

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from compare.studies.drivetrain.coupled_clutches import theory as modelica
from compare.studies.drivetrain.coupled_clutches.theory import exact

INERTIA_A, INERTIA_B = 0.3, 0.2


def free_bodies(unit):
    """Return the rates of (ω_a, ω_b, φ_b) and of the states of the unit, for two free rotors and a free disc."""

    def rates(time, state):
        unit.set(speed_a=state[0], speed_b=state[1], angle_b=state[2])
        unit.state = state[3:]
        speeds = unit["torque_a"] / INERTIA_A, unit["torque_b"] / INERTIA_B, state[1]
        return np.concatenate((speeds, unit.rates))

    return rates


@pytest.mark.parametrize(
    "contact", [{"inner_radius": 0.08}, {"contact_points": 5.0}], ids=["annulus", "points"]
)
def test_free_rotors_and_disc_conserve_angular_momentum_and_energy(instance, contact):
    mass = 0.7
    unit = instance(
        "clutch", mass=mass, stiffness=0.0, damping=0.0, plates=2.0, normal_load=1.5, friction_coefficient=0.3,
        regularisation=1e-4, **({"inner_radius": 0.12, "outer_radius": 0.12} | contact),
    ).started()  # fmt: skip
    start = np.array([12.0, -5.0, 0.3, 0.02, -0.01, 0.03, 0.2, 0.0])
    run = solve_ivp(free_bodies(unit), (0.0, 0.3), start, "DOP853", rtol=1e-13, atol=1e-15)
    a, b, _, x, y, vx, vy, heat = run.y
    momentum = INERTIA_A * a + INERTIA_B * b + mass * (x * vy - y * vx)
    energy = 0.5 * (INERTIA_A * a**2 + INERTIA_B * b**2 + mass * (vx**2 + vy**2))
    assert heat[-1] > 0.4
    assert np.max(np.abs(momentum - momentum[0])) <= 1e-12
    assert np.max(np.abs(energy + heat - energy[0])) <= 1e-11


def test_coupled_clutches_of_three_units_agree_with_the_exact_solution(instance):
    units = [
        instance(
            "clutch", inner_radius=modelica.RADIUS, outer_radius=modelica.RADIUS,
            friction_coefficient=modelica.COEFFICIENT, static_ratio=modelica.STATIC_RATIO, regularisation=1e-5,
        ).started()
        for _ in modelica.LOADS
    ]  # fmt: skip
    inertias = np.array(modelica.INERTIAS)

    def rates(time, speeds):
        torques = np.array([modelica.torque(time), 0.0, 0.0, 0.0])
        for i, unit in enumerate(units):
            unit.set(speed_a=speeds[i], speed_b=speeds[i + 1], normal_load=modelica.LOADS[i](time))
            torques[i : i + 2] += unit["torque_a"], unit["torque_b"]
        return torques / inertias

    state, parts, times = np.array([modelica.SPEED, 0.0, 0.0, 0.0]), [], []
    breaks = [0.0, *modelica.BREAKS, modelica.UNTIL]
    for begin, end in itertools.pairwise(breaks):
        shown = modelica.SHOWN[(begin + 1e-6 < modelica.SHOWN) & (end - 1e-6 > modelica.SHOWN)]
        times.append(shown)
        run = solve_ivp(rates, (begin, end), state, "Radau", np.append(shown, end), rtol=1e-7, atol=1e-8)
        assert run.success
        state = run.y[:, -1]
        parts.append(run.y[:, :-1])
    difference = np.hstack(parts).T - exact().states(np.hstack(times))[1]
    assert np.max(np.abs(difference)) <= 5e-4
