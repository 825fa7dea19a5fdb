"""Slip of a disc from rest, as in :mod:`reference_model.motion.slip.breakaway`."""

from __future__ import annotations

import math

import numpy as np

from reference_model.ensemble.core.jit import scalar
from reference_model.ensemble.core.laws import DiscLaw
from reference_model.ensemble.core.stepping.implicit import (
    INTEGRAL,
    PLACES,
    SERIES,
    collocate_ring,
    position_after,
)
from reference_model.ensemble.core.stepping.linear import length_of, zeros
from reference_model.motion.slip.breakaway import FIRST_STEP, LEAST_STEP, STIFF
from reference_model.numerics.collocation import NODES
from reference_model.systems import FloatArray

ACCURACY = 1e-12
"""Allowed scaled contribution of the last terms of the polynomials."""


@scalar
def grown(
    z: complex, n: complex, turning: float, first: float, longest: float, law: DiscLaw
) -> tuple[complex, complex, float, float, float, float]:
    """Return position, slip, rotation, duration and work of slip that begins at ``z`` along (``n``, ``turning``).

    It ends where an explicit method can continue, or after ``longest``. ``first`` is the initial rate of slip. The
    rotation is relative to the master disc, times κ; the work is that of friction per newton. The duration is zero if
    the motion could not be resolved.
    """
    carried = 1j * law.disc_speed
    change = -(law.stiffness + (law.damping + carried) * carried) * carried * z
    gain = (n.conjugate() * change).real
    along = np.array((n.real, n.imag, turning))
    start, rate = zeros(3), zeros(3)
    for k in range(3):
        rate[k] = first * along[k]
    w, f, power = zeros(NODES * 3).reshape(NODES, 3), zeros(NODES * 3).reshape(NODES, 3), zeros(NODES)
    t = turn = work = outward = 0.0
    step = FIRST_STEP
    while t < longest:
        step = min(step, longest - t)
        for i in range(NODES):
            delay = step * PLACES[i]
            for k in range(3):
                w[i, k] = start[k] + delay * (rate[k] + 0.5 * delay * gain * along[k])
        stiffness = collocate_ring(z, 0.0, start, step, law, w, f, power)
        error = step * _last_terms(f) if stiffness >= 0.0 else math.inf
        if not error < ACCURACY:
            step *= max(0.25, 0.8 * (ACCURACY / error) ** (1.0 / NODES))
            if step < LEAST_STEP:
                return z, 0j, 0.0, 0.0, 0.0, 0.0
            continue
        there = position_after(z, w, step, law)
        goes = (complex(w[-1, 0], w[-1, 1]) * there.conjugate()).real
        if goes * outward < 0.0:
            break  # at an extreme of the radius, which must be recorded
        z, outward = there, goes
        for j in range(NODES):
            turn += step * INTEGRAL[-1, j] * w[j, 2]
            work += step * INTEGRAL[-1, j] * power[j]
        t += step
        s, rising = length_of(w[-1]), 0.0
        for k in range(3):
            start[k], rate[k], along[k] = w[-1, k], f[-1, k], w[-1, k] / s
            rising += along[k] * rate[k]
        if rising <= 0.0 or step * stiffness < STIFF:
            break
        step *= min(4.0, 0.8 * (ACCURACY / max(error, 1e-30)) ** (1.0 / NODES))
    return z, complex(start[0], start[1]), start[2], t, turn, work


@scalar
def _last_terms(f: FloatArray) -> float:
    largest = 0.0
    for row in (NODES - 2, NODES - 1):
        for k in range(3):
            term = 0.0
            for j in range(NODES):
                term += SERIES[row, j] * f[j, k]
            largest = max(largest, abs(term))
    return largest
