"""Claims."""

from __future__ import annotations

import functools
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

import compare.studies.pin.whirl_stability.theory as theory
from compare.claims import TIGHTEST, WORKING, Measured, Measurement, Study, answers_of, refined
from compare.claims.linearised_flow import eigenvalues_with_rounding, matched, real_and_imaginary
from compare.engines import Engine
from compare.studies.pin.whirl_stability.theory import K, linear_deviation
from compare.studies.toolkit.deviations import PARTS, Rates, measured_rates, settled
from reference_model.formulas.pin import (
    characteristic_coefficients,
    coefficient_margins,
    lower_branch_margin,
    upper_branch_margin,
    variational_matrix,
    whirl_radius,
)
from reference_model.steady.stability import turning_frame_jacobian, whirl_eigenvalues
from reference_model.systems import FloatArray
from reference_model.trajectory import Trajectory

STUDY = Study.beside(
    __file__,
    "whirl-stability",
    source=theory.SOURCE,
    system=theory.PIN,
    seconds=2.5,
    quick=True,
    contact=True,
)
STUDY.provides(curves=theory.curves)


# --- Eq. 12 to 16 compared with each other

BoolArray = NDArray[np.bool_]


@STUDY.claim(
    "The corrected (13), the matrix of (12) and the Jacobian of (1) have the same eigenvalues",
    equation="(12), (13)",
    unit="1/s",
    resolution=1e-9 * K,
    note="All three eigenvalues of (12), and all four of the Jacobian in the frame that turns with the whirl, "
    "including the zero of the phase. Error: rounding, from the condition number of each eigenvalue.",
    swept=("disc_speed", "damping"),
)
def same_eigenvalues() -> Measured:
    pins = [
        theory.pin_at(float(speed), float(damping))
        for speed in K * (1.0 + np.geomspace(0.02, 9.0, 15))
        for damping in np.geomspace(0.03, 3.0, 9)
    ]
    companion = np.zeros((len(pins), 3, 3))
    companion[:, 1:, :2] = np.eye(2)
    companion[:, :, 2] = [[-value for value in characteristic_coefficients(pin)[:0:-1]] for pin in pins]
    roots, roots_error = eigenvalues_with_rounding(companion)
    of_12, of_12_error = eigenvalues_with_rounding([variational_matrix(pin) for pin in pins])
    of_1, of_1_error = eigenvalues_with_rounding([turning_frame_jacobian(pin) for pin in pins])
    predicted, measured, errors = [], [], []
    for i in range(len(pins)):
        predicted.append([*roots[i], *matched([0.0, *roots[i]], of_1[i])])
        measured.append([*matched(of_12[i], roots[i]), *of_1[i]])
        errors.append(np.max(roots_error[i]) + max(np.max(of_12_error[i]), np.max(of_1_error[i])))
    numbers = real_and_imaginary(measured)
    return Measured(
        predicted=real_and_imaginary(predicted),
        value=numbers,
        error=np.broadcast_to(np.array(errors)[:, np.newaxis, np.newaxis], numbers.shape),
        components=PARTS,
        source="Fig. 4 with X0 = 0; a grid of ω/k = 1.02 … 10 and β = 0.03 … 3 N s/m",
    )


def counted(margins: ArrayLike, errors: ArrayLike = 0.0) -> Measured:
    """Return the answers of a statement for all points of the grid; one in a thousand may be open."""
    return answers_of(
        margins,
        errors,
        may_be_open=len(theory.DAMPINGS) * len(theory.RATIOS) // 1000,
        source=f"assumption: a grid of {len(theory.RATIOS)} values of ω/k = {theory.RATIOS[0]:g} … "
        f"{theory.RATIOS[-1]:g} and {len(theory.DAMPINGS)} of β/(mk) = {theory.DAMPINGS[0]:g} … "
        f"{theory.DAMPINGS[-1]:g}",
    )


def in_14() -> BoolArray:
    """Return whether (14) holds, at each point of the grid."""
    return np.array([min(coefficient_margins(pin)) > 0.0 for pin in theory.grid()])


def in_16() -> BoolArray:
    """Return whether (16) holds, at each point of the grid."""
    return np.array([upper_branch_margin(pin) > 0.0 for pin in theory.grid()])


@STUDY.claim(
    "All roots of (13) have negative real parts exactly where (16) holds",
    equation="(16)",
    note="Do the condition and the eigenvalues of (12) agree at each grid point? Rounding may leave one in a "
    "thousand open. Below k, this only concerns the matrix, because no whirl exists there.",
    swept=("disc_speed", "damping"),
)
def hurwitz() -> Measured:
    largest, error = theory.largest_real_parts()
    return counted(np.where(in_16(), -largest, largest), error)


@STUDY.claim(
    "Where (16) holds, (14) holds too",
    equation="(14), (16)",
    note="At each grid point. With q = 4k²m²/β² the bound of (16) is −q/(1 + q + √(1 + q²)), which is above −1 and "
    "above −q.",
    swept=("disc_speed", "damping"),
)
def implied() -> Measured:
    return counted(~in_16() | in_14())


@STUDY.claim(
    "(14) and (15) never hold together",
    equation="(14), (15)",
    note="At each grid point. With q = 4k²m²/β² the bound of (15) is −(1 + q + √(1 + q²))/2, which is below "
    "−min(1, q), where (14) fails.",
    swept=("disc_speed", "damping"),
)
def incompatible() -> Measured:
    in_15 = np.array([lower_branch_margin(pin) > 0.0 for pin in theory.grid()])
    return counted(~(in_14() & in_15))


# --- Eq. 11 and 12

SETTLING = (
    f"Starts on a circle {theory.DISPLACED:g} times as large; state after {theory.DURATION:g} s. Error: the "
    "change at a smaller tolerance, and the remaining transient according to its change in the last "
    f"{theory.DELAY:g} s."
)


def turning_speed(states: FloatArray) -> FloatArray:
    """Return ψ̇ in rad/s of ``states``, shape (..., 4)."""
    x, y, vx, vy = np.moveaxis(states, -1, 0)
    return np.asarray((x * vy - y * vx) / (x**2 + y**2))


@functools.lru_cache(maxsize=2)
def whirls(engine: Engine, speeds: Sequence[float]) -> Measurement:
    """Return radius in m and frequency in rad/s at the end of long simulations, shape (n, 2)."""

    def track(speed: float, times: list[float], tolerance: float) -> FloatArray:
        pin = theory.pin_at(speed)
        run = engine.simulate(pin, theory.on_circle(pin, theory.DISPLACED), times, tolerance=tolerance)
        return np.column_stack((run.radius, turning_speed(run.states)))[1:]

    ends = [
        settled(
            functools.partial(track, speed),
            duration=theory.DURATION,
            delay=theory.DELAY,
            period=np.pi / K,  # approximate period of deviations in the frame that turns with the whirl
            rate=-whirl_eigenvalues(theory.pin_at(speed))[1].real,
            tolerance=theory.TOLERANCE,
        )
        for speed in speeds
    ]
    return Measurement(
        np.array([end.value for end in ends]), np.array([end.error + end.left for end in ends])
    )


@STUDY.claim(
    "A pin that starts near the whirl approaches its radius μN/(βk) if ω > k",
    equation="(11)",
    unit="m",
    resolution=1e-9 * whirl_radius(theory.PIN),
    note=SETTLING,
    swept=("disc_speed",),
    duration=1.3e4,
)
def radius(engine: Engine, speeds: Sequence[float] = theory.SPEEDS) -> Measured:
    found = whirls(engine, speeds)
    return Measured(
        predicted=np.full(len(speeds), whirl_radius(theory.PIN)),
        value=found.value[:, 0],
        error=found.error[:, 0],
        at={"ω in rad/s": speeds},
    )


@STUDY.claim(
    "A pin that starts near the whirl approaches its frequency k if ω > k",
    equation="(11)",
    unit="rad/s",
    resolution=1e-9 * K,
    note=SETTLING,
    swept=("disc_speed",),
    duration=1.3e4,
)
def frequency(engine: Engine, speeds: Sequence[float] = theory.SPEEDS) -> Measured:
    found = whirls(engine, speeds)
    return Measured(
        predicted=np.full(len(speeds), K),
        value=found.value[:, 1],
        error=found.error[:, 1],
        at={"ω in rad/s": speeds},
    )


@STUDY.claim(
    "On the circle (11), friction and damping cancel if ω > k, and brake equally if ω < k",
    equation="(11)",
    resolution=1e-5,
    note="Rate of change of the angular momentum over μN·ρ_c, from a one-sided difference. By (10) it is "
    "sign(ω − k) − 1. According to the paper, (11) always exists: see the errata. Error: the change at a smaller "
    "tolerance and at a larger interval.",
    swept=("disc_speed",),
)
def balance(engine: Engine, starts: Sequence[float] = theory.STARTS) -> Measured | None:
    if engine.contact_only:
        return None

    def rates_of(interval: float, tolerance: float) -> FloatArray:
        pins = [theory.pin_at(speed) for speed in starts]
        runs = engine.simulate_many(
            [(pin, theory.on_circle(pin), interval * np.arange(5)) for pin in pins], tolerance=tolerance
        )
        found = []
        for pin, run in zip(pins, runs, strict=True):
            x, y, vx, vy = run.states.T
            moment = theory.FORWARD @ (pin.mass * (x * vy - y * vx)) / interval
            found.append(moment / (pin.friction_force * theory.on_circle(pin)[0]))
        return np.array(found)

    found = refined(functools.partial(rates_of, theory.INTERVAL), 10.0 * TIGHTEST)
    wide = np.abs(rates_of(2.0 * theory.INTERVAL, 10.0 * TIGHTEST) - found.value)
    rounding = 8.0 * np.finfo(float).eps * theory.PIN.mass * K / (theory.PIN.damping * theory.INTERVAL)
    return Measured(
        predicted=[0.0 if speed > K else -2.0 for speed in starts],
        value=found.value,
        error=np.full(len(starts), found.largest + np.max(wide) + rounding),
        at={"ω in rad/s": starts},
    )


@STUDY.claim(
    "If ω < k, a pin that starts on the circle (11) leaves it and finally turns with the disc",
    equation="(11)",
    resolution=1e-3,
    note=f"Angular speed of the pin after {theory.CAUGHT:g} s, over ω.",
    swept=("disc_speed",),
)
def caught(engine: Engine, starts: Sequence[float] = theory.STARTS) -> Measured | None:
    if engine.contact_only:
        return None
    below = [speed for speed in starts if speed < K]

    def ends(tolerance: float) -> list[FloatArray]:
        return [
            turning_speed(_leave(engine, speed, [0.0, theory.CAUGHT], tolerance).at_end) / speed
            for speed in below
        ]

    found = refined(ends, theory.CAUGHT_TOLERANCE)
    times = np.linspace(0.0, theory.CAUGHT, 181)
    return Measured(
        predicted=np.ones(len(below)),
        value=found.value,
        error=np.full(len(below), found.largest),
        at={"ω in rad/s": below},
        data={
            "start": starts,
            "leaving_time": times,
            "leaving": [_leave(engine, speed, times, theory.CAUGHT_TOLERANCE).radius for speed in starts],
        },
    )


def _leave(engine: Engine, speed: float, times: ArrayLike, tolerance: float) -> Trajectory:
    """Return the motion of a pin that starts on the circle (11)."""
    pin = theory.pin_at(speed)
    return engine.simulate(pin, theory.on_circle(pin), times, tolerance=tolerance)


@functools.lru_cache(maxsize=2)
def rates(engine: Engine, points: Sequence[tuple[float, float]]) -> Rates:
    """Return the eigenvalues of the whirl at ``points``, ω in rad/s and β in N s/m."""
    pins = [theory.pin_at(*point) for point in points]
    return measured_rates(
        engine,
        [(pin, theory.on_circle(pin)) for pin in pins],
        [whirl_eigenvalues(pin) for pin in pins],
        duration=theory.FLOW_DURATION,
        frame_speed=K,
    )


@STUDY.claim(
    "Small deviations from the whirl evolve with the eigenvalues of (12), plus a zero for the phase",
    equation="(12)",
    unit="1/s",
    resolution=1e-6 * K,
    note=f"Central differences of the motion over {theory.FLOW_DURATION:g} s, in the frame that turns with the "
    "whirl, extrapolated to zero. Error: the change with larger differences, and at a smaller tolerance.",
    swept=("disc_speed", "damping"),
    duration=2.7e3,
)
def eigenvalues(engine: Engine, points: Sequence[tuple[float, float]] = theory.POINTS) -> Measured | None:
    if engine.contact_only:
        return None
    found = rates(engine, points)
    return found.compared(
        {"(ω, β)": [f"({speed:g} rad/s, {damping:g} N s/m)" for speed, damping in points]},
        source=f"{theory.SOURCE}; β too if it is not {theory.PIN.damping:g}",
        data={"point": points, "eigenvalue": real_and_imaginary(found.measured)},
    )


@STUDY.claim(
    "The whirl is stable if ω > k",
    equation="(16)",
    note="Is the real part of each measured eigenvalue below zero, except for the one that belongs to the phase?",
    implied_by=eigenvalues,
    swept=("disc_speed", "damping"),
    duration=2.7e3,
)
def stable(engine: Engine, points: Sequence[tuple[float, float]] = theory.POINTS) -> Measured | None:
    if engine.contact_only:
        return None
    return rates(engine, points).decaying(
        but=1, source=f"{theory.SOURCE}; β too if it is not {theory.PIN.damping:g}"
    )


@STUDY.claim(
    "A small deviation of the radius decays as the linear equations (12) predict",
    equation="(12)",
    resolution=1e-4,
    note=f"Starts with ξ = ±a, ξ̇ = ±ka, η = 0 and a = {theory.DEVIATION:g}·ρ_c; half the difference of the "
    "radii over a. Model error: the change at twice the amplitude a, which is three times the next order of the "
    "deviation.",
    duration=2e3,
)
def history(engine: Engine) -> Measured | None:
    if engine.contact_only:
        return None
    circle = whirl_radius(theory.PIN)
    shift = np.array([circle, 0.0, K * circle, K * circle])

    def deviation(amplitude: float, tolerance: float) -> FloatArray:
        starts = (theory.on_circle(theory.PIN) + sign * amplitude * shift for sign in (1.0, -1.0))
        runs = engine.simulate_many(
            [(theory.PIN, start, theory.DEVIATION_TIMES) for start in starts], tolerance=tolerance
        )
        outwards, inwards = (run.radius for run in runs)
        return np.asarray((outwards - inwards) / (2.0 * amplitude * circle))

    found = refined(functools.partial(deviation, theory.DEVIATION), WORKING / 10)
    nonlinear = np.abs(deviation(2.0 * theory.DEVIATION, WORKING / 10) - found.value)
    return Measured(
        predicted=linear_deviation(theory.DEVIATION_TIMES),
        value=found.value,
        error=np.full(len(theory.DEVIATION_TIMES), found.largest),
        model=float(np.max(nonlinear)),
        at={"t in s": theory.DEVIATION_TIMES},
        data={"history_time": theory.DEVIATION_TIMES, "history": found.value},
    )
