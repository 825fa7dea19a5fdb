"""Whirls and growth on nonlinear supports: closed forms, and the reference's orbits."""

from __future__ import annotations

import functools
import math
from dataclasses import replace

import numpy as np

from compare.claims.error_estimates import TRUTH
from compare.claims.paper_parameters import CENTRED
from compare.claims.study import Data
from compare.engines import Engine
from compare.studies.pin.nonlinear_support.parameters import (
    FOLLOWED_ON,
    GROWING_FROM,
    GROWING_LOADS,
    GROWN,
    LOADS,
    PINS,
)
from compare.studies.toolkit.whirls import whirl_of
from reference_model import Orbit, simulate
from reference_model.formulas.pin import whirl_radius
from reference_model.systems import PinOnDisc


def curves() -> Data:
    """Evaluate the closed forms of the whirl, and follow the linear pin's growth without damping."""
    loads = np.linspace(0.0, max(LOADS), 101)[1:]
    data = {"load": loads}
    for name, pin in {"linear": CENTRED, **PINS}.items():
        data[f"{name} radius"] = np.array([whirl_radius(replace(pin, friction_force=load)) for load in loads])
    for name, pin in PINS.items():
        data[f"{name} end"] = np.array(end_of_growth(pin))
    # On a slowly growing circle of the linear spring d(mkρ²)/dt = μNρ.
    speed = GROWING_LOADS[-1] / (2.0 * CENTRED.mass * CENTRED.natural_frequency)
    times = np.linspace(0.0, 1.4 * max(end_of_growth(pin) for pin in PINS.values()) / speed, 2)
    data["linear growth"] = np.column_stack((times, GROWING_FROM + speed * times))
    return data


@functools.cache
def exact_whirl(pin: PinOnDisc) -> Orbit:
    """Return the whirl of ``pin``, found by shooting with the reference."""
    return whirl_of(Engine("reference", simulate), pin, 3.0 * TRUTH)


def radius_and_frequency(orbit: Orbit) -> tuple[float, float]:
    """Return the amplitude in m of the first harmonic of x + iy, and its frequency in rad/s."""
    x, y = orbit.trajectory.states[:-1, :2].T
    return float(np.abs(np.fft.fft(x + 1j * y)[1])) / len(x), 2.0 * math.pi / orbit.period


def end_of_growth(pin: PinOnDisc) -> float:
    """Return the radius in m at which the support turns the pin as fast as the disc turns, Cρ + ... = mω²ρ."""
    excess = pin.mass * pin.disc_speed**2 - pin.stiffness
    if pin.hardening > 0.0:
        return math.sqrt(excess / pin.hardening)
    return pin.stop_stiffness * pin.stop_gap / (pin.stop_stiffness - excess)


def first_circle(pin: PinOnDisc) -> tuple[float, float, float, float]:
    """Return a state on the circle on which the linear spring carries the pin."""
    return GROWING_FROM, 0.0, 0.0, pin.natural_frequency * GROWING_FROM


@functools.cache
def growing_time(pin: PinOnDisc) -> float:
    """Return the time in s until a pin without damping sticks, and a little more.

    Its angular momentum grows with μNρ, from a radius that is at least ``GROWING_FROM``.
    """
    end = end_of_growth(pin)
    longest = pin.mass * end**2 * pin.disc_speed / (pin.friction_force * GROWING_FROM)
    trajectory = simulate(pin, first_circle(pin), [0.0, longest], tolerance=GROWN)
    return trajectory.stick_phases[0].start + FOLLOWED_ON
