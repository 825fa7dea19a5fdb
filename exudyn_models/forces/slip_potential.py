"""The slip potential P of circular contacts: a ring in closed form, and an annulus as an average of rings.

A circle of radius r whose centre slips with U and whose relative spin is S has the rim speed W = r·|S|. Its mean slip
speed P(U, W) is a complete elliptic integral, computed by an arithmetic-geometric mean without cancellation.

For an annulus P is the mean over its rings, weighted by the pressure, by Gauss's rule over the radius. The slopes of
P have a kink (r − r₀)·ln|r − r₀| at r₀ = U/|S|, where a point is at rest. The rule is split there, and a substitution
r = r₀ + (r₁ − r₀)·t³ on either side clusters its rings at r₀. The error of n rings per side falls like n^(−12), and
the error of the curvatures like n^(−6). With 12 rings the errors are 4e-10 and 5e-7 of the largest values. If r₀ is
outside the annulus the error is 1e-14, and it is larger only within a thousandth of the edge.
"""

import math

import numpy as np

from exudyn_models.forces.jit import compiled
from exudyn_models.forces.laws.pressures import share_of_ring
from reference_model.systems import FloatArray

NEAREST = 1e-15
"""Relative distance from U = W below which the slope of the ring's friction stays constant.

The slope is infinite at U = W, like a logarithm, so it becomes a secant over an interval that no step resolves.
"""

RINGS = 12
"""Number of rings of an annulus on either side of r₀."""

CLUSTERING = 3

FARTHEST = 4.0
"""Largest ratio of r₀ to the outer radius; beyond it the position of r₀ makes no difference."""

_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(RINGS)


@compiled
def slip_potential_gradient(
    speed: float, spin: float, inner: float, outer: float, density: int
) -> tuple[float, float]:
    """Return ∂P/∂U and ∂P/∂|S| (in m) of a contact between the radii ``inner`` <= ``outer`` (m), equal for a ring.

    U >= 0 in m/s and |S| >= 0 in rad/s are not both zero. ``density`` is the code of ``density_of``.
    """
    if inner == outer:
        by_speed, by_rim = ring_potential_slopes(speed, outer * spin)
        return by_speed, outer * by_rim
    resting = _resting_radius(speed, spin, outer)
    by_speed = by_spin = 0.0
    for start, length in _sides(resting, inner, outer):
        if length != 0.0:
            for i in range(RINGS):
                radius, width = _ring(i, resting, start, length)
                share = radius if density == 0 else share_of_ring(density, radius, inner, outer)
                weight = width * share
                along_slip, along_rim = ring_potential_slopes(speed, radius * spin)
                by_speed += weight * along_slip
                by_spin += weight * radius * along_rim
    total = (outer - inner) * (outer + inner) / 2.0 if density == 0 else 1.0
    return by_speed / total, by_spin / total


@compiled
def slip_potential_hessian(
    speed: float, spin: float, inner: float, outer: float, density: int
) -> tuple[float, float, float]:
    """Return ∂²P/∂U², ∂²P/∂U∂|S| and ∂²P/∂|S|² for the arguments of ``slip_potential_gradient``."""
    if inner == outer:
        twice, mixed, by_rim_twice = ring_potential_curvatures(speed, outer * spin)
        return twice, outer * mixed, outer * outer * by_rim_twice
    resting = _resting_radius(speed, spin, outer)
    by_speed_twice = mixed = by_spin_twice = 0.0
    for start, length in _sides(resting, inner, outer):
        if length != 0.0:
            for i in range(RINGS):
                radius, width = _ring(i, resting, start, length)
                share = radius if density == 0 else share_of_ring(density, radius, inner, outer)
                weight = width * share
                along_slip, across, along_rim = ring_potential_curvatures(speed, radius * spin)
                by_speed_twice += weight * along_slip
                mixed += weight * radius * across
                by_spin_twice += weight * radius * radius * along_rim
    total = (outer - inner) * (outer + inner) / 2.0 if density == 0 else 1.0
    return by_speed_twice / total, mixed / total, by_spin_twice / total


@compiled
def _resting_radius(speed: float, spin: float, outer: float) -> float:
    """Return r₀ = U/|S| in m, at most ``FARTHEST`` outer radii."""
    farthest = FARTHEST * outer
    return speed / spin if speed < farthest * spin else farthest


@compiled
def _sides(resting: float, inner: float, outer: float) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return t at the start, and the other end minus r₀ (0 if empty), inside and outside r₀."""
    below, above = inner - resting, outer - resting
    inside = (0.0, 0.0) if below >= 0.0 else (max(0.0, above / below) ** (1.0 / CLUSTERING), below)
    outside = (0.0, 0.0) if above <= 0.0 else (max(0.0, below / above) ** (1.0 / CLUSTERING), above)
    return inside, outside


@compiled
def _ring(i: int, resting: float, start: float, length: float) -> tuple[float, float]:
    t = start + (1.0 - start) * (0.5 + 0.5 * _POINTS[i])
    width = 0.5 * (1.0 - start) * _WEIGHTS[i] * CLUSTERING * t ** (CLUSTERING - 1)
    return resting + length * t**CLUSTERING, abs(length) * width


@compiled
def ring_potential_slopes(speed: float, rim: float) -> tuple[float, float]:
    """Return ∂P/∂U and ∂P/∂W of a ring with the centre slip U >= 0 and the rim speed W >= 0, not both zero.

    With k = W/U <= 1, a₀ = 1, b₀ = √(1 − k²) and c₀ = k, the arithmetic-geometric mean A and T = Σ 2^(n−1)·c_n²/k²
    over n >= 1 give the complete elliptic integrals (DLMF 19.8.6), and with them::

        ∂P/∂U = [(1/2 − T) + (1 − k²)(1/2 + T)]/A,   ∂P/∂W = k(1/2 − T)/A,   ∂²P/∂W² = (1/2 + T)/(A·U)

    The case W > U follows from the symmetry of P in U and W.
    """
    if speed >= rim:
        return _slopes(speed, rim)
    by_larger, by_smaller = _slopes(rim, speed)
    return by_smaller, by_larger


@compiled
def ring_potential_curvatures(speed: float, rim: float) -> tuple[float, float, float]:
    """Return ∂²P/∂U², ∂²P/∂U∂W and ∂²P/∂W² for U, W >= 0, not both zero; ``NEAREST`` bounds them at U = W."""
    larger, smaller = max(speed, rim), min(speed, rim)
    ratio = smaller / larger
    complement = max((larger - smaller) / larger, NEAREST) * (1.0 + ratio)
    mean, t = _mean(ratio, complement)
    curvature = (0.5 + t) / (mean * larger)
    mixed = -ratio * curvature  # the slopes are of degree 0
    by_larger = ratio * ratio * curvature
    if speed >= rim:
        return by_larger, mixed, curvature
    return curvature, mixed, by_larger


@compiled
def _slopes(larger: float, smaller: float) -> tuple[float, float]:
    ratio = smaller / larger
    complement = (larger - smaller) / larger * (1.0 + ratio)  # 1 − k² without cancellation
    if complement == 0.0:
        return 2.0 / math.pi, 2.0 / math.pi
    mean, t = _mean(ratio, complement)
    scale = 1.0 / mean
    return (0.5 - t + complement * (0.5 + t)) * scale, ratio * (0.5 - t) * scale


@compiled
def _mean(ratio: float, complement: float) -> tuple[float, float]:
    m = ratio * ratio
    b = math.sqrt(complement)
    a = 0.5 * (1.0 + b)
    b = math.sqrt(b)
    share = 0.25 / a
    c = m * share  # (1 − b₀)/2 without cancellation
    t = c * share
    if c > 1e-5:  # the next c is at most this c²
        weight, total = 1.0, 0.0
        while c > 1e-5:
            c = 0.5 * (a - b)  # small rounding error compared with the earlier terms
            a, b = 0.5 * (a + b), math.sqrt(a * b)
            weight *= 2.0
            total += weight * c * c
        t += total / m
    return 0.5 * (a + b), t


@compiled
def slip_potential_of_circles(speed: float, spin: float, inner: float, outer: float, density: int) -> float:
    """Return P in m/s for the arguments of ``slip_potential_gradient``, which may both be zero here."""
    if speed == 0.0 and spin == 0.0:
        return 0.0
    by_speed, by_spin = slip_potential_gradient(speed, spin, inner, outer, density)
    return by_speed * speed + by_spin * spin


@compiled
def ring_potentials(speeds: FloatArray, rims: FloatArray) -> FloatArray:
    """Return P(U, |W|) of a ring in m/s for ``speeds`` U >= 0 and ``rims`` W of either sign, shape (n,)."""
    result = np.zeros(len(speeds))
    for i in range(len(speeds)):
        result[i] = slip_potential_of_circles(speeds[i], abs(rims[i]), 1.0, 1.0, 0)
    return result
