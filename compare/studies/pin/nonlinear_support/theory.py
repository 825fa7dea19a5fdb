"""Whirls and growth on nonlinear supports: closed forms and orbits of the reference."""

from __future__ import annotations

import functools
import math
from dataclasses import replace

import numpy as np

from compare.claims import TRUTH, WORKING, Data
from compare.claims.parameters import CENTRED, FIG5, FIG9
from compare.engines import Engine
from compare.studies.toolkit.pins import whirl_of
from reference_model import Orbit, simulate
from reference_model.formulas.pin import whirl_radius
from reference_model.systems import PinOnDisc

# --- Pins and a disc on supports that harden or have a stop, and their starts

HARDENING = replace(CENTRED, hardening=0.5)
STOP = replace(CENTRED, stop_gap=0.6, stop_stiffness=2.0)
PINS = {"hardening": HARDENING, "stop": STOP}
"""Fig. 4 without its offset. At all friction forces below, the whirl of each pin turns slower than the disc."""

LAWS = (
    f"C₃ = {HARDENING.hardening:g} N/m³ without a stop, and C_s = {STOP.stop_stiffness:g} N/m beyond "
    f"{STOP.stop_gap:g} m without C₃"
)

SOURCE = "Fig. 4, with β, μN and X0 as stated; C₃, C_s and the gap are our choice, the paper names no law"

LOADS = (0.04, 0.1, 0.2)
"""μN in N; at the smallest one, the pin does not reach the stop."""

OFFSET = 0.1
"""X0 in m of the orbits, as in Fig. 4."""

OFFSETS = (0.004, 0.005, 0.0063, 0.008, 0.01)
"""X0 in m for the order of the harmonic balance; at the largest, the next term is 5 % of the first."""

RESTING = {"offset": 0.8, "friction_force": 0.9}
"""Offset in m and friction force in N that put the equilibrium into the nonlinear range of either law."""

BESIDE = 0.005
"""Distance in m of the starts from the equilibrium."""

REST_TIMES = np.concatenate(([0.0], np.linspace(270.0, 280.0, 11)))
"""In s, after the pins have come to rest."""

SLIDING_START = (0.3, 0.0, 0.0, 0.2)
SLIDING_TIMES = np.linspace(0.0, 50.0, 51)

STICKING = replace(
    FIG5,
    friction_force=0.2,
    disc_speed=1.0,
    offset=0.15,
    hardening=5.0,
    stop_gap=0.1,
    stop_stiffness=1.0,
)
TOLERANCE = 10 * WORKING
"""Tolerance of motions whose error is then only a hundredth of the resolution."""

STICKS_BY = 2.0
"""Duration in s; the pin of Fig. 5's second start has then stuck and been released."""

DISC = replace(FIG9, damping=0.1, friction_force=0.12, offset=0.0, hardening=HARDENING.hardening)

GROWING_LOADS = (0.12, 0.06, 0.03)
"""μN in N of pins without damping. The effect of friction on their final radius falls with it."""

AMPLIFIED = 6.0
"""Sum of the absolute weights 1/3, −2 and 8/3 of the radii in the parabola's value at 0, rounded up."""

GROWING_FROM = 0.3
"""Initial radius in m; closer to the axis, the largest of these friction forces holds a pin on the disc."""

FOLLOWED_ON = 0.2
"""Duration in s after a pin without damping has stuck."""

GROWN = 1e-6
"""Tolerance of growing motions; the claim only needs their ends."""


def curves() -> Data:
    loads = np.linspace(0.0, max(LOADS), 101)[1:]
    data = {"load": loads}
    for name, pin in {"linear": CENTRED, **PINS}.items():
        data[f"{name} radius"] = np.array([whirl_radius(replace(pin, friction_force=load)) for load in loads])
    for name, pin in PINS.items():
        data[f"{name} end"] = np.array(end_of_growth(pin))
    # On a slowly growing circle with the linear spring: d(mkρ²)/dt = μNρ
    speed = GROWING_LOADS[-1] / (2.0 * CENTRED.mass * CENTRED.natural_frequency)
    times = np.linspace(0.0, 1.4 * max(end_of_growth(pin) for pin in PINS.values()) / speed, 2)
    data["linear growth"] = np.column_stack((times, GROWING_FROM + speed * times))
    return data


@functools.cache
def exact_whirl(pin: PinOnDisc) -> Orbit:
    """Return the whirl of ``pin`` by shooting with the reference."""
    return whirl_of(Engine("reference", simulate), pin, 3.0 * TRUTH)


def radius_and_frequency(orbit: Orbit) -> tuple[float, float]:
    """Return the amplitude in m of the first harmonic of x + iy, and its frequency in rad/s."""
    x, y = orbit.trajectory.states[:-1, :2].T
    return float(np.abs(np.fft.fft(x + 1j * y)[1])) / len(x), 2.0 * math.pi / orbit.period


def end_of_growth(pin: PinOnDisc) -> float:
    """Return the radius in m where the support turns the pin as fast as the disc turns, Cρ + ... = mω²ρ."""
    excess = pin.mass * pin.disc_speed**2 - pin.stiffness
    if pin.hardening > 0.0:
        return math.sqrt(excess / pin.hardening)
    return pin.stop_stiffness * pin.stop_gap / (pin.stop_stiffness - excess)


def first_circle(pin: PinOnDisc) -> tuple[float, float, float, float]:
    return GROWING_FROM, 0.0, 0.0, pin.natural_frequency * GROWING_FROM


@functools.cache
def growing_time(pin: PinOnDisc) -> float:
    """Return the time in s until a pin without damping sticks, plus ``FOLLOWED_ON``.

    Its angular momentum grows by μNρ, and its radius is at least ``GROWING_FROM``.
    """
    end = end_of_growth(pin)
    longest = pin.mass * end**2 * pin.disc_speed / (pin.friction_force * GROWING_FROM)
    trajectory = simulate(pin, first_circle(pin), [0.0, longest], tolerance=GROWN)
    return trajectory.stick_phases[0].start + FOLLOWED_ON
