"""The power balance closes for the right motion, with the stated order, and for no wrong motion."""

import math
from dataclasses import replace

import numpy as np
import pytest
from disc_equations import STICKY
from plain_engines import integrate, stuck_state

from reference_model import PinOnDisc, plain, power_balance, simulate
from reference_model.contact.contact_law import ThreeTermRing
from reference_model.formulas import pin as formulas
from reference_model.trajectory import Phase, Trajectory

FIG_5 = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=1.5, offset=0.1)
CENTRED = replace(FIG_5, offset=0.0)
TO_WHIRL = [0.1, 0.0, 0.03, 0.0]  # a start of Fig. 5
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


def test_terms_of_the_balance_of_the_whirl_11_have_their_closed_forms():
    # The drive supplies ω·μN·ρ, the dampers take β(kρ)² and friction μN(ω − k)ρ, with μN = βkρ.
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


@pytest.mark.parametrize("samples", [12, 200])
def test_phases_without_samples_are_integrated_between_their_bounds(samples):
    trajectory = simulate(FIG_5, TO_WHIRL, np.linspace(0.0, 20.0, samples))
    balance = power_balance(trajectory)
    bounds = [phase.start for phase in trajectory.phases]
    assert set(bounds) <= set(balance.times)
    spacing = trajectory.times[1] - trajectory.times[0]
    for omitted in set(trajectory.times) - set(balance.times):
        assert np.min(np.abs(np.array(bounds) - omitted)) <= 0.05 * spacing
    assert np.all(np.diff(balance.friction_heat) > -1e-3)
    assert np.all(np.isfinite(balance.residual))
    assert np.all(np.diff(balance.times) >= 0.0)


@pytest.mark.parametrize("epsilon", [2.0])  # slip stays below ε, because a kink would spoil the spline
def test_motion_with_smooth_friction_balances_with_the_heat_of_smooth_friction(epsilon):
    times = np.linspace(0.0, 20.0, 4001)
    start = [0.7, 0.1, 0.0, 0.5]
    trajectory = integrate(FIG_5, start, times, viscous_below(FIG_5, epsilon), epsilon)
    assert relative_residual(trajectory) < 1e-9
    # It does not balance with the heat of exact friction, μN·∫|w|dt.
    solution = replace(trajectory.solution, regularisation=0.0)
    exact = Trajectory(FIG_5, trajectory.times.copy(), trajectory.states.copy(), trajectory.phases, solution)
    assert relative_residual(exact) > 0.1


def viscous_below(pin, slip_speed):
    return lambda slip: -pin.friction_force * slip / max(math.hypot(*slip), slip_speed)


def test_creep_of_an_engine_in_stick_produces_the_heat_of_holding_force_and_moment():
    disc = replace(
        STICKY,
        friction_force=0.3,
        disc_speed=0.7,
        offset=0.05,
        shaft_speed=0.6,
        shaft_damping=0.05,
        contact_points=6,
    )
    times = np.linspace(0.0, 5.0, 501)
    creeping = plain.simulate(disc, stuck_state(disc, 0.03, 0.02), times, tolerance=1e-4)
    stick = Phase("stick", 0.0, 5.0, creeping.states[0])
    claimed = Trajectory(disc, times, creeping.states.copy(), (stick,), creeping.solution)
    balance = power_balance(claimed)
    assert np.abs(balance.residual).max() < 1e-2 * balance.friction_heat[-1]


SLIPPING = [0.5, 0.3, 0.0, 0.0, 0.15, 0.4]


def test_motion_under_another_law_balances_only_with_this_law():
    law = ThreeTermRing(0.12)
    trajectory = simulate(STICKY, SLIPPING, np.linspace(0.0, 5.0, 1001), contact=law)
    balance = power_balance(trajectory, contact=law)
    assert np.abs(balance.residual).max() < 1e-9 * balance.turned_over
    assert relative_residual(trajectory) > 1e-4


def test_terms_of_the_balance_of_a_disc_spinning_at_the_axis_have_their_closed_forms():
    # The moment of friction is μN·R, so the drive supplies ω·μN·R and the shaft Ω·b(φ̇ − Ω), with b(φ̇ − Ω) = μN·R.
    moment = 0.09 * 0.12
    disc = replace(STICKY, offset=0.0, shaft_damping=2.0 * moment / 0.25)
    times = np.linspace(0.0, 10.0, 201)
    balance = power_balance(simulate(disc, [0.0, 0.0, 0.0, 0.0, 0.0, 1.375], times))
    assert balance.drive_work == pytest.approx(1.5 * moment * times, abs=1e-10)
    assert balance.shaft_work == pytest.approx(1.25 * moment * times, abs=1e-10)
    assert balance.friction_heat == pytest.approx(0.125 * moment * times, abs=1e-10)
    assert balance.damper_heat == pytest.approx(0.125 * moment * times, abs=1e-10)


OUTSIDE = [0.6, 0.0, 0.0, 0.7]
STOP = replace(FIG_5, stop_gap=0.15, stop_stiffness=20.0)
WRONG = [
    (FIG_5, ON_WHIRL, 1e-9, 8e-4, ("damping", "friction_force", "stiffness", "mass", "offset")),
    (replace(FIG_5, hardening=3.0), OUTSIDE, 2e-6, 1e-3, ("hardening",)),
    (STOP, OUTSIDE, 2e-6, 1e-3, ("stop_gap", "stop_stiffness")),
    (
        STICKY, SLIPPING, 1e-9, 1e-5,
        ("shaft_damping", "shaft_speed", "polar_inertia", "contact_radius", "friction_force", "damping", "offset"),
    ),
]  # fmt: skip


@pytest.mark.parametrize(("system", "start", "residual_of_right", "least_of_wrong", "names"), WRONG)
def test_motion_with_a_parameter_wrong_by_a_hundredth_does_not_balance(
    system, start, residual_of_right, least_of_wrong, names
):
    times = np.linspace(0.0, 5.0, 2001)
    assert relative_residual(simulate(system, start, times, tolerance=1e-11)) < residual_of_right
    for name in names:
        wrong = simulate(
            replace(system, **{name: 1.01 * getattr(system, name)}), start, times, tolerance=1e-11
        )
        claimed = Trajectory(system, wrong.times.copy(), wrong.states.copy(), wrong.phases, wrong.solution)
        assert relative_residual(claimed) > least_of_wrong, name
