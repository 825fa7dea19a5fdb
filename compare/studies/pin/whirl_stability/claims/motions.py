"""Eq. 11 and 12: what engines show of the whirl without offset, and how deviations from it develop."""

from __future__ import annotations

import functools
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from compare.claims.error_estimates import TIGHTEST, WORKING, Measurement, refined
from compare.claims.linearised_flow import real_and_imaginary
from compare.claims.measured import Measured
from compare.engines import Engine
from compare.studies.pin.whirl_stability.claims.study import STUDY
from compare.studies.pin.whirl_stability.parameters import (
    CAUGHT,
    CAUGHT_TOLERANCE,
    DELAY,
    DEVIATION,
    DEVIATION_TIMES,
    DISPLACED,
    DURATION,
    FLOW_DURATION,
    FORWARD,
    INTERVAL,
    PIN,
    POINTS,
    SOURCE,
    SPEEDS,
    STARTS,
    TOLERANCE,
    K,
    on_circle,
    pin_at,
)
from compare.studies.pin.whirl_stability.theory import linear_deviation
from compare.studies.toolkit.deviations import Rates, measured_rates, settled
from reference_model.formulas.pin import whirl_radius
from reference_model.steady.stability import whirl_eigenvalues
from reference_model.systems import FloatArray
from reference_model.trajectory import Trajectory

SETTLING = (
    f"Starts on a circle {DISPLACED:g} times as large; state after {DURATION:g} s. Error: the change at a smaller "
    f"tolerance, and what is left of the transient by its change in the last {DELAY:g} s."
)


def turning_speed(states: FloatArray) -> FloatArray:
    """Return ψ̇ in rad/s of ``states``, shape (..., 4)."""
    x, y, vx, vy = np.moveaxis(states, -1, 0)
    return np.asarray((x * vy - y * vx) / (x**2 + y**2))


@functools.lru_cache(maxsize=2)
def whirls(engine: Engine, speeds: Sequence[float]) -> Measurement:
    """Return radius in m and frequency in rad/s in the end of long simulations, shape (n, 2)."""

    def track(speed: float, times: list[float], tolerance: float) -> FloatArray:
        pin = pin_at(speed)
        run = engine.simulate(pin, on_circle(pin, DISPLACED), times, tolerance=tolerance)
        return np.column_stack((run.radius, turning_speed(run.states)))[1:]

    ends = [
        settled(
            functools.partial(track, speed),
            duration=DURATION,
            delay=DELAY,
            period=np.pi / K,  # of the deviations in the frame that turns with the whirl, nearly
            rate=-whirl_eigenvalues(pin_at(speed))[1].real,
            tolerance=TOLERANCE,
        )
        for speed in speeds
    ]
    return Measurement(
        np.array([end.value for end in ends]), np.array([end.error + end.left for end in ends])
    )


@STUDY.claim(
    "A pin that starts beside the whirl comes to its radius μN/(βk) where ω > k",
    equation="(11)",
    unit="m",
    resolution=1e-9 * whirl_radius(PIN),
    note=SETTLING,
    swept=("disc_speed",),
)
def radius(engine: Engine, speeds: Sequence[float] = SPEEDS) -> Measured:
    """Compare the radius in the end with (11)."""
    found = whirls(engine, speeds)
    return Measured(
        predicted=np.full(len(speeds), whirl_radius(PIN)),
        value=found.value[:, 0],
        error=found.error[:, 0],
        at={"ω in rad/s": speeds},
    )


@STUDY.claim(
    "A pin that starts beside the whirl comes to its frequency k where ω > k",
    equation="(11)",
    unit="rad/s",
    resolution=1e-9 * K,
    note=SETTLING,
    swept=("disc_speed",),
)
def frequency(engine: Engine, speeds: Sequence[float] = SPEEDS) -> Measured:
    """Compare the frequency in the end with k."""
    found = whirls(engine, speeds)
    return Measured(
        predicted=np.full(len(speeds), K),
        value=found.value[:, 1],
        error=found.error[:, 1],
        at={"ω in rad/s": speeds},
    )


@STUDY.claim(
    "On the circle (11) friction and damping cancel where ω > k, and brake alike where ω < k",
    equation="(11)",
    resolution=1e-5,
    note="Change of the angular momentum in time over μN·ρ_c, from a one-sided difference. By (10) it is "
    "sign(ω − k) − 1. The paper says that (11) always exists: see the errata. Error: the change at a smaller "
    "tolerance and at a larger interval.",
    swept=("disc_speed",),
)
def balance(engine: Engine, starts: Sequence[float] = STARTS) -> Measured | None:
    """Measure at which rate the angular momentum of a pin put on the circle (11) changes."""
    if engine.contact_only:
        return None

    def rates_of(interval: float, tolerance: float) -> FloatArray:
        pins = [pin_at(speed) for speed in starts]
        runs = engine.simulate_many(
            [(pin, on_circle(pin), interval * np.arange(5)) for pin in pins], tolerance=tolerance
        )
        found = []
        for pin, run in zip(pins, runs, strict=True):
            x, y, vx, vy = run.states.T
            moment = FORWARD @ (pin.mass * (x * vy - y * vx)) / interval
            found.append(moment / (pin.friction_force * on_circle(pin)[0]))
        return np.array(found)

    found = refined(functools.partial(rates_of, INTERVAL), 10.0 * TIGHTEST)
    wide = np.abs(rates_of(2.0 * INTERVAL, 10.0 * TIGHTEST) - found.value)
    rounding = 8.0 * np.finfo(float).eps * PIN.mass * K / (PIN.damping * INTERVAL)
    return Measured(
        predicted=[0.0 if speed > K else -2.0 for speed in starts],
        value=found.value,
        error=np.full(len(starts), found.largest + np.max(wide) + rounding),
        at={"ω in rad/s": starts},
    )


@STUDY.claim(
    "Where ω < k a pin put on the circle (11) leaves it and ends turning with the disc",
    equation="(11)",
    resolution=1e-3,
    note=f"Speed at which it turns after {CAUGHT:g} s, over ω.",
    swept=("disc_speed",),
)
def caught(engine: Engine, starts: Sequence[float] = STARTS) -> Measured | None:
    """Measure how fast a pin that left the circle (11) below k turns in the end."""
    if engine.contact_only:
        return None
    below = [speed for speed in starts if speed < K]

    def ends(tolerance: float) -> list[FloatArray]:
        return [
            turning_speed(_leave(engine, speed, [0.0, CAUGHT], tolerance).at_end) / speed for speed in below
        ]

    found = refined(ends, CAUGHT_TOLERANCE)
    times = np.linspace(0.0, CAUGHT, 181)
    return Measured(
        predicted=np.ones(len(below)),
        value=found.value,
        error=np.full(len(below), found.largest),
        at={"ω in rad/s": below},
        data={
            "start": starts,
            "leaving_time": times,
            "leaving": [_leave(engine, speed, times, CAUGHT_TOLERANCE).radius for speed in starts],
        },
    )


def _leave(engine: Engine, speed: float, times: ArrayLike, tolerance: float) -> Trajectory:
    """Return the motion of a pin put on the circle (11)."""
    pin = pin_at(speed)
    return engine.simulate(pin, on_circle(pin), times, tolerance=tolerance)


@functools.lru_cache(maxsize=2)
def rates(engine: Engine, points: Sequence[tuple[float, float]]) -> Rates:
    """Return the eigenvalues of the whirl at ``points``, ω in rad/s and β in N s/m."""
    pins = [pin_at(*point) for point in points]
    return measured_rates(
        engine,
        [(pin, on_circle(pin)) for pin in pins],
        [whirl_eigenvalues(pin) for pin in pins],
        duration=FLOW_DURATION,
        frame_speed=K,
    )


@STUDY.claim(
    "Small deviations from the whirl develop with the eigenvalues of (12), and a zero for the phase",
    equation="(12)",
    unit="1/s",
    resolution=1e-6 * K,
    note=f"Central differences of the motion over {FLOW_DURATION:g} s, in the frame that turns with the whirl, "
    "extrapolated to zero. Error: the change with larger differences, and at a smaller tolerance.",
    swept=("disc_speed", "damping"),
)
def eigenvalues(engine: Engine, points: Sequence[tuple[float, float]] = POINTS) -> Measured | None:
    """Compare all four eigenvalues with those of (12) and zero."""
    if engine.contact_only:
        return None
    found = rates(engine, points)
    return found.compared(
        {"(ω, β)": [f"({speed:g} rad/s, {damping:g} N s/m)" for speed, damping in points]},
        source=f"{SOURCE}; β too where it is not {PIN.damping:g}",
        data={"point": points, "eigenvalue": real_and_imaginary(found.measured)},
    )


@STUDY.claim(
    "No small deviation from the whirl grows where ω > k",
    equation="(16)",
    note="Whether the real part of each measured eigenvalue is below zero, but for one at each point, which belongs "
    "to the phase.",
    implied_by=eigenvalues,
    swept=("disc_speed", "damping"),
)
def stable(engine: Engine, points: Sequence[tuple[float, float]] = POINTS) -> Measured | None:
    """See whether all measured deviations but that of the phase decay."""
    if engine.contact_only:
        return None
    return rates(engine, points).decaying(but=1, source=f"{SOURCE}; β too where it is not {PIN.damping:g}")


@STUDY.claim(
    "A small deviation of the radius decays over time as the linear equations (12) say",
    equation="(12)",
    resolution=1e-4,
    note=f"Starts with ξ = ±a, ξ̇ = ±ka, η = 0 and a = {DEVIATION:g}·ρ_c; half the difference of the radii over a. "
    "Model error: the change with a twice as large, three times what the next order of the deviation amounts to.",
)
def history(engine: Engine) -> Measured | None:
    """Follow a deviation of the radius in time."""
    if engine.contact_only:
        return None
    circle = whirl_radius(PIN)
    shift = np.array([circle, 0.0, K * circle, K * circle])

    def deviation(amplitude: float, tolerance: float) -> FloatArray:
        starts = (on_circle(PIN) + sign * amplitude * shift for sign in (1.0, -1.0))
        runs = engine.simulate_many([(PIN, start, DEVIATION_TIMES) for start in starts], tolerance=tolerance)
        outwards, inwards = (run.radius for run in runs)
        return np.asarray((outwards - inwards) / (2.0 * amplitude * circle))

    found = refined(functools.partial(deviation, DEVIATION), WORKING / 10)
    nonlinear = np.abs(deviation(2.0 * DEVIATION, WORKING / 10) - found.value)
    return Measured(
        predicted=linear_deviation(DEVIATION_TIMES),
        value=found.value,
        error=np.full(len(DEVIATION_TIMES), found.largest),
        model=float(np.max(nonlinear)),
        at={"t in s": DEVIATION_TIMES},
        data={"history_time": DEVIATION_TIMES, "history": found.value},
    )
