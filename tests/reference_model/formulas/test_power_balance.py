"""The power balance closes for the right motion, at the order it states, and for no other."""

import math
from dataclasses import replace

import numpy as np
import pytest
from plain_engines import coulomb, integrate, stuck_state

from reference_model import PinOnDisc, power_balance, simulate
from reference_model.contact.contact_law import ThreeTermRing
from reference_model.formulas import pin as formulas
from reference_model.systems import DiscOnDisc
from reference_model.trajectory import Phase, Solution, Trajectory

FIG_5 = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=1.5, offset=0.1)
CENTRED = replace(FIG_5, offset=0.0)
TO_EQUILIBRIUM, TO_WHIRL = [0.1, 0.0, 0.0, 0.0], [0.1, 0.0, 0.03, 0.0]  # the starts of Fig. 5
ON_WHIRL = [0.9, 0.0, 0.0, 0.9]


def relative_residual(trajectory):
    balance = power_balance(trajectory)
    return np.abs(balance.residual).max() / balance.turned_over


def test_error_of_the_balance_falls_with_the_sixth_power_of_the_sample_distance():
    samples = (101, 201, 401)
    errors = [
        relative_residual(simulate(FIG_5, ON_WHIRL, np.linspace(0.0, 12.0, n), tolerance=1e-14))
        for n in samples
    ]
    orders = -np.diff(np.log2(errors))
    assert orders == pytest.approx([6.0, 6.0], abs=0.5), errors


def test_balance_of_the_whirl_is_that_of_11():
    # On the circle: drive ω·μN·ρ, dampers β(kρ)², friction μN(ω − k)ρ, with μN = βkρ.
    times = np.linspace(1.0, 21.0, 201)
    balance = power_balance(simulate(CENTRED, ON_WHIRL, times, tolerance=1e-12))
    friction, omega, k = CENTRED.friction_force, CENTRED.disc_speed, 1.0
    rho = formulas.whirl_radius(CENTRED)
    elapsed = balance.times - 1.0
    assert balance.drive_work == pytest.approx(omega * friction * rho * elapsed, abs=1e-9)
    assert balance.friction_heat == pytest.approx(friction * (omega - k) * rho * elapsed, abs=1e-9)
    assert balance.damper_heat == pytest.approx(0.1 * (k * rho) ** 2 * elapsed, abs=1e-9)
    assert balance.stored_energy == pytest.approx(np.full(201, 0.81), abs=1e-9)
    assert balance.drive_power == pytest.approx(omega * friction * rho, rel=1e-9)
    heat = (friction * (omega - k) * rho + 0.081) * 20.0
    assert balance.turned_over == pytest.approx(heat + 0.81, rel=1e-9)


def test_stuck_pin_takes_from_the_drive_what_its_dampers_turn_into_heat():
    pin = replace(FIG_5, friction_force=0.12, disc_speed=1.2)
    radius = 0.9 * formulas.sticking_radius(pin)
    turn = 2.0 * math.pi / 1.2
    trajectory = simulate(pin, stuck_state(pin, radius, 0.0), np.linspace(0.0, turn, 201))
    assert [phase.kind for phase in trajectory.phases] == ["stick"]
    balance = power_balance(trajectory)
    assert np.abs(balance.friction_heat).max() < 1e-15
    assert balance.damper_heat[-1] == pytest.approx(0.1 * (1.2 * radius) ** 2 * turn, rel=1e-12)
    assert balance.drive_work[-1] == pytest.approx(balance.damper_heat[-1], rel=1e-9)
    assert relative_residual(trajectory) < 1e-9


@pytest.mark.parametrize("samples", [2, 3, 4, 5, 6, 7])
def test_phases_of_few_samples_are_integrated_as_well_as_those_allow(samples):
    # 0.02 s in slip: even the trapezoidal rule is right to h²/12 of the rates' relative change in h².
    trajectory = simulate(FIG_5, ON_WHIRL, np.linspace(0.0, 0.02, samples), tolerance=1e-13)
    balance = power_balance(trajectory)
    assert len(balance.times) == samples
    assert np.abs(balance.residual).max() < 0.02**3


@pytest.mark.parametrize("samples", [12, 40, 200])
def test_phases_with_hardly_a_sample_inside_take_their_bounds(samples):
    trajectory = simulate(FIG_5, TO_WHIRL, np.linspace(0.0, 20.0, samples))
    balance = power_balance(trajectory)
    bounds = [phase.start for phase in trajectory.phases]
    assert set(bounds) <= set(balance.times)
    assert np.all(np.diff(balance.friction_heat) > -1e-3)
    assert np.all(np.isfinite(balance.residual))
    assert np.all(np.diff(balance.times) >= 0.0)


@pytest.mark.parametrize("epsilon", [2.0, 5.0])  # slip stays below: a kink would spoil the spline
def test_smoothed_friction_is_balanced_with_its_own_heat(epsilon):
    times = np.linspace(0.0, 20.0, 4001)
    start = [0.7, 0.1, 0.0, 0.5]
    trajectory = integrate(FIG_5, start, times, viscous_below(FIG_5, epsilon), epsilon)
    assert relative_residual(trajectory) < 1e-9
    # By the heat of exact friction, μN·∫|w|dt, it would not be.
    solution = replace(trajectory.solution, regularisation=0.0)
    exact = Trajectory(FIG_5, trajectory.times.copy(), trajectory.states.copy(), trajectory.phases, solution)
    assert relative_residual(exact) > 0.1


def viscous_below(pin, slip_speed):
    return lambda slip: -pin.friction_force * slip / max(math.hypot(*slip), slip_speed)


def square(pin):
    """Friction of each axis for itself: a box in place of the circle."""
    return lambda slip: -pin.friction_force * np.tanh(slip / 1e-3)


def without_friction_across(pin):
    return lambda slip: -pin.friction_force * np.array([slip[0] / math.hypot(*slip), 0.0])


BROKEN = {
    "half the damping": (replace(FIG_5, damping=0.05), coulomb),
    "friction along the slip": (FIG_5, lambda pin: lambda slip: -coulomb(pin)(slip)),
    "friction square": (FIG_5, square),
    "friction along x only": (FIG_5, without_friction_across),
    "one per cent more friction": (replace(FIG_5, friction_force=1.01 * 0.09), coulomb),
    "one per cent softer springs": (replace(FIG_5, stiffness=0.99), coulomb),
    "one per cent more mass": (replace(FIG_5, mass=1.01), coulomb),
    "springs relaxed elsewhere": (replace(FIG_5, offset=0.11), coulomb),
}


@pytest.mark.parametrize("fault", BROKEN)
def test_broken_engine_does_not_balance(fault):
    broken, law = BROKEN[fault]
    times = np.linspace(0.0, 10.0, 2001)
    right = integrate(FIG_5, ON_WHIRL, times, coulomb(FIG_5))
    wrong = integrate(broken, ON_WHIRL, times, law(broken), tolerance=1e-9)
    claimed = Trajectory(FIG_5, wrong.times.copy(), wrong.states.copy(), wrong.phases, wrong.solution)
    assert relative_residual(right) < 1e-9
    assert relative_residual(claimed) > 1e-3, fault


def test_integrator_that_loses_energy_does_not_balance():
    # Explicit Euler with steps of 1 ms makes energy at a rate of h·k² relative to that stored.
    h, steps = 1e-3, 10_000
    states = np.empty((steps + 1, 4))
    states[0] = ON_WHIRL
    for i in range(steps):
        x, y, vx, vy = states[i]
        wx, wy = vx + 1.5 * y, vy - 1.5 * x
        w = math.hypot(wx, wy)
        ax, ay = -(x - 0.1) - 0.1 * vx - 0.09 * wx / w, -y - 0.1 * vy - 0.09 * wy / w
        states[i + 1] = x + h * vx, y + h * vy, vx + h * ax, vy + h * ay
    times = h * np.arange(steps + 1)
    phase = Phase("slip", 0.0, float(times[-1]), states[0].copy())
    euler = Trajectory(FIG_5, times, states, (phase,), Solution("Euler", h, steps, steps, 0.0))
    assert relative_residual(euler) > 1e-4


# ---------------------------------------------------------------- the friction disc

DISC = DiscOnDisc(
    mass=1.0, polar_inertia=0.02, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=1.5, offset=0.1,
    contact_radius=0.12, shaft_damping=0.005, shaft_speed=1.25,
)  # fmt: skip
SLIPPING = [0.5, 0.3, 0.0, 0.0, 0.15, 0.4]


def test_power_of_another_law_is_balanced_with_that_law_only():
    law = ThreeTermRing(0.12)
    trajectory = simulate(DISC, SLIPPING, np.linspace(0.0, 5.0, 1001), contact=law)
    balance = power_balance(trajectory, contact=law)
    assert np.abs(balance.residual).max() < 1e-9 * balance.turned_over
    assert relative_residual(trajectory) > 1e-4


def test_spinning_disc_at_the_axis_passes_on_the_power_of_friction_to_its_shaft():
    # At the axis the moment is μN·R as long as it slips: drive ω·μN·R, shaft Ω·b(φ̇ − Ω), with b(φ̇ − Ω) = μN·R.
    moment = 0.09 * 0.12
    disc = replace(DISC, offset=0.0, shaft_damping=2.0 * moment / 0.25)
    times = np.linspace(0.0, 10.0, 201)
    balance = power_balance(simulate(disc, [0.0, 0.0, 0.0, 0.0, 0.0, 1.375], times))
    assert balance.drive_work == pytest.approx(1.5 * moment * times, abs=1e-10)
    assert balance.shaft_work == pytest.approx(1.25 * moment * times, abs=1e-10)
    assert balance.friction_heat == pytest.approx(0.125 * moment * times, abs=1e-10)
    assert balance.damper_heat == pytest.approx(0.125 * moment * times, abs=1e-10)


@pytest.mark.parametrize(
    "fault",
    [
        {"shaft_damping": 0.006}, {"shaft_speed": 1.26}, {"polar_inertia": 0.0202}, {"contact_radius": 0.1212},
        {"friction_force": 0.0909}, {"damping": 0.11}, {"offset": 0.11},
    ],
    ids=lambda fault: next(iter(fault)),
)  # fmt: skip
def test_disc_with_a_wrong_parameter_does_not_balance(fault):
    wrong = simulate(replace(DISC, **fault), SLIPPING, np.linspace(0.0, 5.0, 1001))
    claimed = Trajectory(DISC, wrong.times.copy(), wrong.states.copy(), wrong.phases, wrong.solution)
    assert relative_residual(wrong) < 1e-9
    assert relative_residual(claimed) > 1e-5
