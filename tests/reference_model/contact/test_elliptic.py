"""Friction on the ring, in closed form and in compiled code, against arbitrary precision."""

import math

import mpmath
import numpy as np
import pytest

from reference_model.contact.elliptic import SMALL, mean_curvatures, mean_directions
from reference_model.ensemble.core.contact_shares import ring_shares

EPS = np.finfo(float).eps
ROUNDING = 1e-13

# (U + W)·E and (U − W)·K cancel up to (W/U)² of their size, and E by another factor of two.
DIGITS = 90


def exact_directions(slip, rim):
    """Return ∂P/∂U and ∂P/∂W from the modulus 4UW/(U + W)², which the code does not use."""
    with mpmath.workdps(DIGITS):
        U, W = mpmath.mpf(slip), mpmath.mpf(rim)
        m = 4 * U * W / (U + W) ** 2
        even, odd = (U + W) * mpmath.ellipe(m), (U - W) * mpmath.ellipk(m) if U != W else mpmath.mpf(0)
        return float((even + odd) / (mpmath.pi * U)), float((even - odd) / (mpmath.pi * W))


def exact_curvatures(slip, rim):
    """Return the second derivatives of P by differences in arbitrary precision."""

    def speed(U, W):
        return 2 / mpmath.pi * (U + W) * mpmath.ellipe(4 * U * W / (U + W) ** 2)

    with mpmath.workdps(DIGITS):
        at = (mpmath.mpf(slip), mpmath.mpf(rim))
        h = min(*at, abs(at[0] - at[1])) * mpmath.mpf(10) ** -20
        return [float(mpmath.diff(speed, at, orders, h=h)) for orders in ((2, 0), (1, 1), (0, 2))]


def random_arguments(count, seed=20):
    """Return pairs (U, W), half of them with a ratio from 1e-16 to 1e16, half with a ratio near 1."""
    rng = np.random.default_rng(seed)
    slip = 10.0 ** rng.uniform(-3.0, 3.0, count)
    ratio = 10.0 ** rng.uniform(-16.0, 16.0, count)
    near = rng.random(count) < 0.5
    ratio[near] = 1.0 + rng.choice([-1.0, 1.0], near.sum()) * 10.0 ** rng.uniform(-16.0, -0.1, near.sum())
    return [(u, u * k) for u, k in zip(slip.tolist(), ratio.tolist(), strict=True)]


# Both sides of the point where the series replaces the closed form.
AROUND_SERIES = [math.sqrt(SMALL) * (1.0 + step) for step in (-1e-9, 1e-9)]
EDGES = [1.0, 1.0 - 2.0**-53, 1.0 - 1e-12, 1.0 - 1e-7, 0.0099, 0.0101, 1e-7, *AROUND_SERIES]
EDGES += [1.0 / ratio for ratio in EDGES]


@pytest.mark.parametrize(
    ("friction", "error", "nearest", "error_near_rest"),
    [
        (mean_directions, ROUNDING, 1e-12, 1e-9),
        (ring_shares, 12.0 * EPS, 1e-9, 5.0 * EPS * math.log(4.0 / EPS)),  # a logarithm where a point rests
    ],
    ids=["closed form", "compiled"],
)
def test_friction_of_the_ring_is_accurate_at_random_ratios_and_at_edge_cases(
    friction, error, nearest, error_near_rest
):
    edges = [(slip, slip * ratio) for slip in (1e-150, 0.7, 1e150) for ratio in EDGES]
    for slip, rim in random_arguments(200) + edges:
        allowed = error_near_rest if abs(slip - rim) <= nearest * max(slip, rim) else error
        assert friction(slip, rim) == pytest.approx(exact_directions(slip, rim), rel=allowed, abs=0.0), (
            slip,
            rim,
        )
    assert friction(0.0, 0.3) == (0.0, 1.0)
    assert friction(0.3, 0.0) == (1.0, 0.0)


@pytest.mark.parametrize("speed", [5e-324, 1.7e308])
def test_friction_does_not_underflow_or_overflow(speed):
    assert mean_directions(speed, 0.0) == (1.0, 0.0)
    assert mean_directions(speed, speed) == pytest.approx([2.0 / math.pi] * 2, rel=1e-15)
    assert mean_directions(1e-300, 1e300) == (0.0, 1.0)


def test_curvatures_are_the_second_derivatives():
    arguments = [pair for pair in random_arguments(30, seed=21) if pair[0] != pair[1]]
    arguments += [(1.0, ratio) for ratio in AROUND_SERIES]
    for slip, rim in arguments:
        exact = exact_curvatures(slip, rim)
        assert mean_curvatures(slip, rim) == pytest.approx(exact, rel=ROUNDING, abs=0.0), (slip, rim)
    assert mean_curvatures(0.0, 0.4) == pytest.approx((1.25, 0.0, 0.0), rel=1e-15)
    assert mean_curvatures(0.4, 0.0) == pytest.approx((0.0, 0.0, 1.25), rel=1e-15)
