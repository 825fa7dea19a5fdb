"""Error estimates of engines with low precision."""

import numpy as np
import pytest

import reference_model
from compare.claims.error_estimates import COARSENING, refined
from compare.claims.parameters import FIG5, FIG5_STARTS
from compare.engines import Engine, reference
from compare.engines.precision import SINGLE, are_single, blurred_start
from reference_model import Trajectory, whirl_orbit

SLIDES = ((0.9, 0.0, 0.0, 0.9), (0.0, 5.0, 10.0, 15.0))
"""A start of Fig. 5 near its whirl, and times in s."""


def in_single_precision(system, start, times, *, tolerance=1e-9):
    """Return the reference's motion rounded to single precision at every tolerance."""
    start = np.asarray(start, dtype=np.float32).astype(float)
    run = reference_model.simulate(system, start, times, tolerance=tolerance)
    return Trajectory(system, run.times, run.states.astype(np.float32).astype(float))


def engine(precision=1e-6):
    return Engine("single", in_single_precision, phases=False, precision=precision)


def energy(engine, tolerance):
    states = engine.simulate(FIG5, *SLIDES, tolerance=tolerance).states[1:]
    return 0.5 * np.sum(states**2, axis=1)


def test_a_declared_precision_enters_the_error_estimate():
    exact = energy(reference, 1e-13)
    rounded = [
        0.5 * np.sum(in_single_precision(FIG5, *SLIDES, tolerance=tolerance).states[1:] ** 2, axis=1)
        for tolerance in (1e-9, 1e-9 / COARSENING)
    ]
    said = refined(lambda tolerance: energy(engine(), tolerance))
    assert np.array_equal(*rounded)  # rounding is the same at both tolerances
    assert np.any(rounded[0] != exact)
    assert np.all(np.abs(said.value - exact) <= said.error)
    assert np.all(said.error < 1e-4)


def test_single_precision_is_recognised_by_its_numbers():
    exact = energy(reference, 1e-13)
    undeclared = engine(0.0)
    found = refined(lambda tolerance: energy(undeclared, tolerance))
    assert undeclared.noise == SINGLE
    assert np.all(np.abs(found.value - exact) <= found.error)


@pytest.mark.parametrize(
    "states",
    [
        np.zeros((5, 4)),
        np.arange(20.0).reshape(5, 4) / 8.0,  # short numbers fit into any precision
        np.sqrt(np.arange(20.0)).reshape(5, 4),
        np.repeat([[0.1, 0.2, 0.3, 0.4]], 5, axis=0).astype(np.float32).astype(float),  # nothing moves
    ],
)
def test_other_numbers_are_not_taken_for_single_precision(states):
    assert not are_single(states)


def test_the_estimate_covers_noise_of_either_sign():
    """The mean of |noise| changes with the size of the noise, its sum with the sign."""
    for quantity in (np.sum, lambda deviations: np.sum(np.abs(deviations))):
        exact = reference_model.simulate(FIG5, *SLIDES, tolerance=1e-13).states[1:]

        def deviation(tolerance, quantity=quantity, exact=exact):
            return quantity(engine(1e-4).simulate(FIG5, *SLIDES, tolerance=tolerance).states[1:] - exact)

        found = refined(deviation)
        assert abs(found.value) <= found.error


def test_the_noise_is_reproducible():
    one, other, finer = (
        engine().simulate(FIG5, *SLIDES, tolerance=tolerance).states
        for tolerance in (1e-9, 1e-9, 1e-9 / COARSENING)
    )

    assert np.array_equal(one, other)
    assert not np.array_equal(one[1:], finer[1:])
    assert np.array_equal(one[0], SLIDES[0])


def test_noise_moves_a_start_without_changing_its_slip():
    start = np.array([0.05, 0.02, 0.3, -0.1])
    moved = blurred_start(FIG5, start, 1e-3, 1e-9)
    assert np.all(moved[:2] != start[:2])
    before, after = (
        state[2:] - FIG5.disc_speed * np.array([-state[1], state[0]]) for state in (start, moved)
    )
    assert after == pytest.approx(before, abs=1e-15)


def test_stick_is_found_in_noise():
    motion = FIG5, FIG5_STARTS["whirl"], [0.0, 15.0]
    exact, found = (one.simulate(*motion).phases for one in (reference, engine(1e-6)))
    assert len(exact) > 4
    assert [phase.kind for phase in found] == [phase.kind for phase in exact]
    assert np.allclose([phase.start for phase in found], [phase.start for phase in exact], atol=1e-3)


def test_an_orbit_is_found_to_the_precision_of_its_engine():
    exact = whirl_orbit(FIG5)

    with pytest.raises(RuntimeError, match="relative residual"):
        whirl_orbit(FIG5, simulate=engine().simulate, tolerance=1e-9, precision=1e-9)
    found = whirl_orbit(FIG5, simulate=engine().simulate, tolerance=1e-9, precision=1e-6)
    assert found.mean == pytest.approx(exact.mean, abs=1e-5)


@pytest.mark.parametrize("precision", [-1e-6, 0.1, float("nan")])
def test_an_invalid_precision_is_rejected(precision):
    with pytest.raises(ValueError, match="precision = "):
        engine(precision)
