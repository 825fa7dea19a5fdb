"""The motions at the paper's scale, with which those of the clutch are compared."""

from __future__ import annotations

import functools

import numpy as np

from compare.claims.error_estimates import TRUTH
from compare.claims.paper_parameters import FIG5
from compare.claims.study import Data
from compare.studies.engines.clutch_scale.parameters import SAMPLES, TO_REST, UNTIL, WHIRLING
from reference_model import Orbit, Trajectory, simulate, whirl_orbit
from reference_model.formulas.pin import equilibrium_position


@functools.cache
def exact_motion() -> Trajectory:
    """Return the motion to rest, from the reference at its tightest."""
    return simulate(FIG5, TO_REST, np.linspace(0.0, UNTIL, SAMPLES), tolerance=TRUTH)


@functools.cache
def exact_whirl() -> Orbit:
    """Return the whirl of Fig. 6, by shooting with the reference."""
    return whirl_orbit(WHIRLING)


def curves() -> Data:
    """Return the motion to rest, at the times of the engines and between them."""
    exact = exact_motion()
    path = simulate(FIG5, TO_REST, np.linspace(0.0, UNTIL, 10 * SAMPLES))
    return {
        "states": exact.states,
        "path": path.states[:, :2],
        "sticks": exact.stick_times,
        "rest": np.array(equilibrium_position(FIG5)),
    }
