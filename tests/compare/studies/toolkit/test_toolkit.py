"""Shared code of the studies: parameters in words, rotated states, eigenvalues from simulations."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from compare.claims.error_estimates import TIGHTEST
from compare.claims.linearised_flow import measured_eigenvalues, rotated
from compare.claims.parameters import FIG5, FIG11, parameters_of
from compare.studies.toolkit.deviations import remaining_transient
from reference_model.steady.steady_states import self_centred_equilibria


def test_parameters_of_a_claim_name_the_ring_in_words_and_omit_what_is_absent():
    ring = parameters_of(FIG11, without=("offset",), friction_force=0.5)
    assert ring["contact_points"] == "continuous ring"
    assert ring["friction_force"] == 0.5
    assert "offset" not in ring
    assert parameters_of(replace(FIG11, contact_points=6))["contact_points"] == 6
    hard = parameters_of(replace(FIG5, hardening=2.0, stop_stiffness=3.0))
    assert hard == parameters_of(FIG5) | {"hardening": 2.0, "stop_stiffness": 3.0}


@pytest.mark.parametrize("angle", [0.7, -2.0, 100.0])
def test_rotating_a_state(angle):
    pin, disc = np.array([1.0, 2.0, 3.0, -4.0]), np.array([1.0, 2.0, 0.5, 3.0, -4.0, 7.0])
    c, s = np.cos(angle), np.sin(angle)
    expected = [c - 2.0 * s, s + 2.0 * c, 3.0 * c + 4.0 * s, 3.0 * s - 4.0 * c]
    assert rotated(pin, angle) == pytest.approx(expected)
    assert rotated(disc, angle) == pytest.approx([*expected[:2], 0.5 + angle, *expected[2:], 7.0])
    assert rotated(rotated(disc, angle), -angle) == pytest.approx(disc)
    assert disc[2] == 0.5  # the argument is unchanged


def test_rotating_states_by_one_angle_or_one_each():
    discs, angles = np.arange(18.0).reshape(3, 6), np.array([0.1, 0.2, 0.3])
    assert rotated(discs, angles) == pytest.approx(np.array(list(map(rotated, discs, angles))))
    assert rotated(discs[0], angles)[2] == pytest.approx(rotated(discs[0], 0.3))
    assert rotated(discs, 0.1)[2] == pytest.approx(rotated(discs[2], 0.1))


def test_the_remaining_transient_is_the_deviation_of_an_exponential_decay():
    left, rest, rate, delay = 1e-3, 5.0, 0.5, 4.0
    earlier = rest + left * np.exp(rate * np.array([delay, 0.5 * delay, 0.0]))
    assert remaining_transient(earlier, rest + left, rate, delay) == pytest.approx(left, rel=1e-9)


def test_the_error_of_eigenvalues_covers_a_nonlinear_flow():
    """Two steps eliminate the cubic term of this flow, and the error covers the next term."""
    (rest,) = self_centred_equilibria(FIG5)
    rates, slip = np.array([-0.1, -0.2, -1.0, -2.0]), FIG5.disc_speed * np.hypot(rest.x, rest.y)

    def simulate_many(tasks, *, tolerance):
        shares = [(state - rest.state) / slip for _, state, _ in tasks]
        return [
            SimpleNamespace(at_end=rest.state + slip * np.exp(rates * times[-1]) * (share + 1e4 * share**5))
            for share, (_, _, times) in zip(shares, tasks, strict=True)
        ]

    found, error = measured_eigenvalues(
        SimpleNamespace(simulate_many=simulate_many), FIG5, rest.state, duration=1.5
    )
    off = np.max(np.abs(np.sort(found.real) - np.sort(rates)))
    assert 1e-7 < off < error < 30.0 * off


def test_the_error_of_eigenvalues_contains_the_tolerance():
    """The estimate contains errors below the tolerance, although this engine has none."""
    (rest,) = self_centred_equilibria(FIG5)
    slow, fast, duration = -0.1, -2.0, 1.5
    rates = np.array([slow, slow, fast, fast])

    def simulate_many(tasks, *, tolerance):
        return [
            SimpleNamespace(at_end=rest.state + np.exp(rates * times[-1]) * (state - rest.state))
            for _, state, times in tasks
        ]

    engine = SimpleNamespace(simulate_many=simulate_many)
    found, error = measured_eigenvalues(engine, FIG5, rest.state, duration=duration)
    assert sorted(found.real) == pytest.approx(sorted(rates), abs=1e-9)
    # A deviation of 0.004 times the slip, in m/s or in m, decays by exp(fast·duration).
    slip = FIG5.disc_speed * np.hypot(rest.x, rest.y)
    smallest = 4e-3 * min(slip, slip / FIG5.disc_speed)
    within_tolerance = 10.0 * TIGHTEST * np.abs(rest.state).max() / smallest
    assert error == pytest.approx(within_tolerance / (np.exp(fast * duration) * duration), rel=0.01)
