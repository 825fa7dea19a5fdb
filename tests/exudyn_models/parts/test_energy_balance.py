"""Energy balances of models, against closed forms and with missing parts."""

import math

import exudyn as exu
import numpy as np
import pytest
from free_bodies import (
    coordinate,
    drive,
    items,
    new_model,
    rate_of,
    rotor,
    run_explicitly,
    settings_of,
)

from exudyn_models import add_energy_balance, solve_dynamic, spring_energy
from exudyn_models.parts.energy_balance import EnergyBalance

INERTIA, STIFFNESS, DAMPING, TORQUE, SPEED, UNTIL = 2.0, 18.0, 0.4, 3.0, 1.5, 2.0


def driven_oscillator(unit=1.0, **left_out):
    """Return the balance of a rotor on a spring and a damper under a constant torque, after a run."""
    mbs = new_model()
    node = rotor(mbs, INERTIA, SPEED)
    markers = [coordinate(mbs, None), coordinate(mbs, node)]
    spring = mbs.AddObject(
        items.ObjectConnectorCoordinateSpringDamper(
            markerNumbers=markers, stiffness=STIFFNESS, damping=DAMPING
        )
    )
    drive(mbs, node, TORQUE)
    parts = {
        "gains": {"drive": lambda mbs, t: TORQUE * rate_of(mbs, node)},
        "losses": {"damper": lambda mbs, t: DAMPING * rate_of(mbs, node) ** 2},
        "stored": [spring_energy(spring)],
    }
    read = add_energy_balance(mbs, **parts | left_out, unit=unit)
    run_explicitly(mbs, UNTIL, 400)
    return read()


def angle_and_speed(t):
    """Return the oscillator's motion in closed form."""
    decay, rest = DAMPING / (2.0 * INERTIA), TORQUE / STIFFNESS
    w = math.sqrt(STIFFNESS / INERTIA - decay**2)
    b = (SPEED - decay * rest) / w
    swing = np.exp(-decay * t)
    angle = rest + swing * (-rest * np.cos(w * t) + b * np.sin(w * t))
    speed = swing * ((b * w + decay * rest) * np.cos(w * t) + (rest * w - decay * b) * np.sin(w * t))
    return angle, speed


@pytest.mark.parametrize("unit", [1.0, 1e3])
def test_works_and_energy_match_the_closed_form_and_the_residual_shows_missing_parts(unit):
    balance = driven_oscillator(unit)
    angle, speed = angle_and_speed(balance.times)
    stored = (INERTIA * speed**2 + STIFFNESS * angle**2) / 2.0
    put_in = TORQUE * angle
    lost = put_in - (stored - stored[0])
    # 400 steps of RK67 with ωh = 0.015: an error of some (ωh)⁷ = 2e-13.
    np.testing.assert_allclose(balance.stored, stored, atol=1e-12)
    np.testing.assert_allclose(balance.gains["drive"], put_in, atol=1e-12)
    np.testing.assert_allclose(balance.losses["damper"], lost, atol=1e-12)
    np.testing.assert_allclose(balance.residual, 0.0, atol=1e-12)
    assert balance.imbalance == ""
    assert balance.turnover == pytest.approx(
        max(abs(work).max() for work in (put_in, lost, stored - stored[0]))
    )
    for part, empty, missing in (
        ("gains", {}, -put_in),
        ("losses", {}, lost),
        ("stored", [], STIFFNESS * angle**2 / 2.0),
    ):
        assert np.abs(missing).max() > 0.1
        with pytest.warns(RuntimeWarning, match=r"off by .* J at t = .* of the energy turned over"):
            balance = driven_oscillator(unit, **{part: empty})
        np.testing.assert_allclose(balance.residual, missing, atol=1e-12)


@pytest.mark.parametrize(("share", "is_off"), [(0.9e-6, False), (1.1e-6, True)])
def test_a_millionth_of_the_turnover_is_an_imbalance(share, is_off):
    times, stored = np.array([0.0, 1.0]), np.array([0.0, 5.0 * (1.0 - share)])
    balance = EnergyBalance(times, {"drive": np.array([0.0, 5.0])}, {}, stored)
    assert bool(balance.imbalance) == is_off


def test_rounding_of_a_heavy_flywheel_is_not_an_imbalance():
    stored = np.array([1e18, 1e18 + 128.0])
    heavy = EnergyBalance(np.array([0.0, 1.0]), {"drive": np.array([0.0, 1.0])}, {}, stored)
    assert heavy.imbalance == ""
    assert EnergyBalance(heavy.times, {"drive": np.array([0.0, 1e5])}, {}, stored).imbalance != ""
    light = EnergyBalance(heavy.times, heavy.gains, {}, stored - 1e18)
    assert "off by 1.3e+02 J at t = 1 s" in light.imbalance


@pytest.mark.parametrize("solver", ["TrapezoidalIndex2", "GeneralizedAlpha"])
def test_implicit_steps_evaluate_powers_at_their_ends_only(solver):
    """Works are those of the trapezoidal rule, here of 3 t² over steps h: 1 + h²/2 J."""
    mbs, calls = new_model(), []
    rotor(mbs, 1.0, 0.0)

    def power(mbs, t):
        calls.append(t)
        return 3.0 * t * t

    read = add_energy_balance(mbs, gains={"motor": power}, losses={})
    solve_dynamic(mbs, settings_of(1.0, 100), getattr(exu.DynamicSolverType, solver))
    with pytest.warns(RuntimeWarning, match="energy balance is off"):
        balance = read()
    assert balance.gains["motor"][-1] == pytest.approx(1.0 + 0.5e-4, abs=1e-12)
    assert len(calls) < 110
