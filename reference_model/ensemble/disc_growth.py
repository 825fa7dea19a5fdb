"""How slip of a disc begins from rest at the limit of what friction holds, as :mod:`reference_model.growth` has it.

Slip grows like ½κt² with its direction slaved to the pull, which is stiff; but the motion is a smooth function of
time, and an implicit method through all nodes of a step at once (Radau IIA) follows it until an explicit one can.
Unknowns of Newton's method are the three components of slip at the nodes. They move the centre by t³ only, so that
its place goes by those of the last iteration.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from reference_model.collocation import INTEGRAL as RADAU
from reference_model.collocation import NODES, POINTS, TO_SERIES
from reference_model.ensemble.compiled import scalar
from reference_model.ensemble.disc_slip import pull, ring_friction
from reference_model.ensemble.linear import solve
from reference_model.growth import (
    FIRST_STEP,
    LEAST_STEP,
    MOST_ITERATIONS,
    STIFF,
)

INTEGRAL, LAST_TERMS, PLACES = np.array(RADAU), np.array(TO_SERIES[-2:]), 0.5 * (np.array(POINTS) + 1.0)
"""As in :mod:`reference_model.growth`, with the places of the nodes in 0..1."""

ACCURACY = 1e-12
"""Of what the last terms of the polynomials contribute, in units in which motion is of order one."""

APART = 1e-7
"""Change of slip, relative to it, by which friction is differentiated."""


@scalar
def grown(z: complex, n: complex, turning: float, first: float, longest: float, law: Any) -> Any:
    """Return place, slip, turn, duration and work of slip that begins at ``z`` along (``n``, ``turning``).

    Up to where an explicit method can go on, but for no longer than ``longest``. ``first`` is the rate at which slip
    begins; the turn is that beyond the one of the master disc, times κ; the work that of friction per newton. A
    duration of zero tells that the motion could not be resolved.
    """
    carried = 1j * law.disc_speed
    change = -(law.stiffness + (law.damping + carried) * carried) * carried * z  # of the pull, by time
    gain = (n.conjugate() * change).real
    along = np.array((n.real, n.imag, turning))
    start, rate = np.zeros(3), np.zeros(3)
    for k in range(3):
        rate[k] = first * along[k]
    w, f, power = np.zeros((NODES, 3)), np.zeros((NODES, 3)), np.zeros(NODES)
    t = turn = work = 0.0
    step = FIRST_STEP
    while t < longest:
        step = min(step, longest - t)
        for i in range(NODES):
            delay = step * PLACES[i]
            for k in range(3):
                w[i, k] = start[k] + delay * (rate[k] + 0.5 * delay * gain * along[k])
        stiffness = _collocate(z, start, step, law, w, f, power)
        error = step * _last_terms(f) if stiffness >= 0.0 else math.inf
        if not error < ACCURACY:
            step *= max(0.25, 0.8 * (ACCURACY / error) ** (1.0 / NODES))
            if step < LEAST_STEP:
                return z, 0j, 0.0, 0.0, 0.0, 0.0
            continue
        z = _place(z, w, step, NODES - 1, law)
        for j in range(NODES):
            turn += step * INTEGRAL[-1, j] * w[j, 2]
            work += step * INTEGRAL[-1, j] * power[j]
        t += step
        s, rising = _length(w[-1]), 0.0
        for k in range(3):
            start[k], rate[k], along[k] = w[-1, k], f[-1, k], w[-1, k] / s
            rising += along[k] * rate[k]
        if rising <= 0.0 or step * stiffness < STIFF:
            break
        step *= min(4.0, 0.8 * (ACCURACY / max(error, 1e-30)) ** (1.0 / NODES))
    return z, complex(start[0], start[1]), start[2], t, turn, work


@scalar
def _place(z: complex, w: Any, step: float, node: int, law: Any) -> complex:
    """Return where the centre is at a node: in the frame of the master disc it goes by the slip alone."""
    way = 0j
    for j in range(NODES):
        angle = law.disc_speed * step * (PLACES[node] - PLACES[j])
        way += INTEGRAL[node, j] * complex(math.cos(angle), math.sin(angle)) * complex(w[j, 0], w[j, 1])
    angle = law.disc_speed * step * PLACES[node]
    return complex(math.cos(angle), math.sin(angle)) * z + step * way


@scalar
def _acceleration(z: complex, ux: float, uy: float, r: float, law: Any) -> Any:
    """Return the rates of u_x, u_y and r, and the mean slip speed."""
    fx, fy, fr, power = ring_friction(ux, uy, r, 0.0, law)
    a = pull(z, complex(ux, uy), law) + law.friction * complex(fx, fy)
    return a.real, a.imag, -law.shaft_rate * (r + law.lag) + law.friction * fr, power


@scalar
def _collocate(z: complex, start: Any, step: float, law: Any, w: Any, f: Any, power: Any) -> float:
    """Solve for the slip ``w`` at the nodes, from a guess, for its rates ``f`` and the mean slip speed ``power``.

    Return how fast slip is drawn to its direction at the end, or -1 if there is no convergence.
    """
    size = 3 * NODES
    matrix, residual = np.empty((size, size)), np.empty(size)
    slopes = np.empty((NODES, 3, 3))
    for _ in range(MOST_ITERATIONS):
        for j in range(NODES):
            place = _place(z, w, step, j, law)
            ux, uy, r = w[j]
            s = math.sqrt(ux * ux + uy * uy + r * r)
            apart = APART * s
            f[j, 0], f[j, 1], f[j, 2], power[j] = _acceleration(place, ux, uy, r, law)
            for k in range(3):
                moved = _acceleration(
                    place, ux + apart * (k == 0), uy + apart * (k == 1), r + apart * (k == 2), law
                )
                for i in range(3):
                    slopes[j, i, k] = (moved[i] - f[j, i]) / apart
        for i in range(NODES):
            for a in range(3):
                rest = w[i, a] - start[a]
                for j in range(NODES):
                    rest -= step * INTEGRAL[i, j] * f[j, a]
                    for b in range(3):
                        same = 1.0 if i == j and a == b else 0.0
                        matrix[3 * i + a, 3 * j + b] = same - step * INTEGRAL[i, j] * slopes[j, a, b]
                residual[3 * i + a] = rest
        if not solve(matrix, residual):
            return -1.0
        converged = True
        for i in range(NODES):
            change = _length(residual[3 * i : 3 * i + 3])
            for k in range(3):
                w[i, k] -= residual[3 * i + k]
            s = _length(w[i])
            converged = converged and change < 1e-9 * s + 1e-15 * step and change < 1e-13 * (1.0 + s)
        if converged:
            return math.sqrt(
                _length(slopes[-1, 0]) ** 2 + _length(slopes[-1, 1]) ** 2 + _length(slopes[-1, 2]) ** 2
            )
    return -1.0


@scalar
def _length(vector: Any) -> float:
    return math.sqrt(vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2])


@scalar
def _last_terms(f: Any) -> float:
    """Return the largest of the last two coefficients of the polynomials through ``f``."""
    largest = 0.0
    for row in range(2):
        for k in range(3):
            term = 0.0
            for j in range(NODES):
                term += LAST_TERMS[row, j] * f[j, k]
            largest = max(largest, abs(term))
    return largest
