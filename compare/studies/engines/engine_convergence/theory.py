"""The motions against which errors are measured, and how creep shifts a release."""

from __future__ import annotations

import cmath
import functools

import numpy as np

from compare.claims.error_estimates import TRUTH
from compare.claims.paper_parameters import FIG5, FIG5_STARTS
from compare.studies.engines.engine_convergence.parameters import (
    SLIDING_STARTS,
    SLIDING_TIMES,
    STICK_SLIP_TIMES,
)
from reference_model import Phase, PinOnDisc, simulate
from reference_model.motion.pin_equations import simulate_polar_form
from reference_model.systems import FloatArray


def root_mean_square(values: FloatArray) -> float:
    """Return √⟨values²⟩."""
    return float(np.sqrt(np.mean(values**2)))


@functools.cache
def sliding_truth() -> tuple[FloatArray, float]:
    """Return the states of the sliding pins by (10) in polar form, shape (start, time, 4), and their error."""

    def states(tolerance: float) -> FloatArray:
        return np.array(
            [
                simulate_polar_form(FIG5, np.array(start), SLIDING_TIMES, tolerance=tolerance)
                for start in SLIDING_STARTS
            ]
        )

    truth: FloatArray = states(3e-14)
    return truth, root_mean_square(truth - states(2e-13))


@functools.cache
def stick_slip_truth() -> FloatArray:
    """Return the states on Fig. 5's way to the whirl by the reference at its tightest, shape (time, 4)."""
    return simulate(FIG5, FIG5_STARTS["whirl"], STICK_SLIP_TIMES, tolerance=TRUTH).states


def release_shift_by_creep(pin: PinOnDisc, stick: Phase) -> float:
    """Return by how much creep shifts the end of a stick phase under exact friction, in s for each m/s of ε.

    A stuck pin under F = −μN·v/ε creeps with w = ε·a/g, where m·a is the force that friction has to balance (eq. 6)
    and g = μN/m. In the frame of the disc that moves it by (ε/g)·∫a·exp(−iωt)dt, in closed form since a is linear in
    z = z₀·exp(iωt). Release is where |a| = g (eq. 7): the shift is −d|a|/dε over d|a|/dt.
    """
    omega = 1j * pin.disc_speed
    spring = pin.stiffness / pin.mass
    slope = -(pin.damping / pin.mass + omega) * omega - spring
    held = stick.end - stick.start
    z = complex(*stick.initial_state[:2])
    turned = cmath.exp(omega * held)
    g = pin.friction_force / pin.mass
    creep = (slope * z * held + spring * pin.offset * (1.0 - 1.0 / turned) / omega) / g * turned
    pull = slope * z * turned + spring * pin.offset
    grows = (pull.conjugate() * slope * omega * z * turned).real
    return -(pull.conjugate() * slope * creep).real / grows
