"""The branches of Fig. 6: equilibria and sticking by formulas, whirls and cycles followed by the reference."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.optimize import brentq

from compare.claims.study import Data
from compare.studies.pin.fig06.parameters import (
    CYCLE_LOAD,
    FIG6,
    INNERMOST,
    LIMIT,
    ON_THE_WAY,
    WHIRL_LOADS,
    with_load,
)
from compare.studies.toolkit.whirls import extent
from reference_model import Orbit, PinOnDisc, sticking_radius, whirl_branch, whirl_orbit
from reference_model.formulas.pin import equilibrium_radius
from reference_model.systems import FloatArray


def curves(innermost: float = INNERMOST, step: float = 0.14) -> Data:
    """Follow the branch of whirls through its folds with the reference, and evaluate (3) and (9).

    The branch is followed to the crossing ``innermost`` in m, in relative steps of ``step``.
    """
    outermost = whirl_orbit(with_load(WHIRL_LOADS[-1]), tolerance=ON_THE_WAY)
    branch = list(whirl_branch(outermost, innermost, step=step))
    loads = LIMIT * np.sin(np.linspace(0.0, 0.5 * np.pi, 101))[:-1]  # closer where (3) is steep
    sticking = np.linspace(LIMIT, WHIRL_LOADS[-1], 101)[1:]
    return {
        "branch load": np.array([orbit.system.friction_force for orbit in branch]),
        "branch extent": np.array([extent(orbit) for orbit in branch]),
        "branch sticks": np.array([float(len(orbit.trajectory.stick_phases) > 0) for orbit in branch]),
        "equilibrium load": loads,
        "equilibrium radius": _along(loads, equilibrium_radius),
        "sticking load": sticking,
        "sticking radius": _along(sticking, sticking_radius),
    }


def _along(loads: FloatArray, formula: Callable[[PinOnDisc], float]) -> FloatArray:
    return np.array([float(formula(with_load(load))) for load in loads])


UNIT_MULTIPLIER_ERROR = 1e-5
"""Error of a multiplier from central differences with the relative step ``orbits.CENTRAL``, near a fold.

There two multipliers meet, so that it is the root of that of the return map: 3e-6 was seen.
"""


@functools.cache
def load_of_unit_multiplier() -> float:
    """Return the friction force in N at which a second multiplier of the reference's whirl passes 1."""
    orbit = whirl_orbit(with_load(0.08))

    def excess(x: float) -> float:
        nonlocal orbit
        orbit = whirl_orbit(FIG6, guess=orbit, at_crossing=x, samples=2)
        real = sorted(orbit.multipliers, key=lambda multiplier: abs(multiplier - 1.0))
        return float(real[1].real) - 1.0

    x = float(orbit.state[0])
    brentq(excess, 0.85 * x, x, xtol=1e-5 * x)
    return orbit.system.friction_force


@functools.cache
def cycle() -> Orbit:
    """Return the stable stick–slip cycle at ``CYCLE_LOAD``, reached along the branch of whirls."""
    start = whirl_orbit(with_load(0.08), tolerance=ON_THE_WAY)
    *_, orbit = whirl_branch(start, 0.06, step=0.4, samples=2)
    return whirl_orbit(replace(FIG6, friction_force=CYCLE_LOAD), guess=orbit)
