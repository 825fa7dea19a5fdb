"""Eq. 11 to 16: the whirl without offset, where it exists, and how deviations from it develop."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg import expm

from compare.claims.answers import holds
from compare.claims.claim import Claim, ErrorBudget
from compare.claims.error_estimates import refined
from compare.claims.linearised_flow import (
    ComplexArray,
    eigenvalues_with_rounding,
    matched,
    measured_eigenvalues,
    real_and_imaginary,
)
from compare.claims.paper_parameters import CENTRED
from compare.claims.parameters import at_each, parameters_of
from compare.claims.study import Findings, Study
from compare.engines import Engine
from compare.studies.pin.whirl_stability.pictures import draw
from compare.studies.toolkit.deviations import remaining_transient
from reference_model.formulas.pin import (
    characteristic_coefficients,
    coefficient_margins,
    lower_branch_margin,
    upper_branch_margin,
    variational_matrix,
    whirl_radius,
)
from reference_model.steady.stability import turning_frame_jacobian, whirl_eigenvalues
from reference_model.systems import FloatArray, PinOnDisc

PIN = CENTRED
SOURCE = "Fig. 4 with X0 = 0, as (11)–(16) assume; the values of ω are ours"
K = PIN.natural_frequency

SPEEDS = (1.1, 1.5, 4.0)
"""ω in rad/s of the long simulations."""

DISPLACED = 1.1
"""Radius at their start, in units of (11)."""

DURATION = 460.0
"""In s: the slowest deviation falls to 1e-10 of its beginning."""

DELAY = 40.0
"""In s: from how long before the end the remaining transient is inferred."""

TOLERANCE = 2e-10

STARTS = (0.5, 0.8, 0.9, 1.2, 1.5, 3.0)
"""ω in rad/s of the starts on the circle (11), below and above k."""

INTERVAL = 0.01
"""In s, between the states from which the change of the angular momentum is taken."""

FORWARD = np.array([-25.0, 48.0, -36.0, 16.0, -3.0]) / 12.0
"""Weights of the one-sided difference of fourth order."""

CAUGHT = 18.0
"""In s: by then a pin that left the circle below k sticks to the disc."""

POINTS = (
    *((speed, PIN.damping) for speed in (1.05, 1.1, 1.2, 1.5, 2.0, 3.0, 5.0)),
    *((1.5, damping) for damping in (0.5, 1.0, 2.0)),
)
"""ω in rad/s and β in N s/m at which eigenvalues are measured."""

FLOW_DURATION = 0.5
"""In s, of the simulations that give eigenvalues."""

DEVIATION = 1e-3
"""Amplitude of the decaying deviation, in units of the radius (11)."""

DEVIATION_TIMES = np.linspace(0.0, 60.0, 301)

RADIUS = "A pin that starts beside it settles on a whirl with the radius μN/(βk) where ω > k"
FREQUENCY = "A pin that starts beside it settles on a whirl with the frequency k where ω > k"
BALANCE = "On the circle (11) friction balances the damping where ω > k, and brakes as much as it where ω < k"
CAUGHT_BELOW = "Where ω < k a pin put on the circle (11) leaves it and ends turning with the disc"
EIGENVALUES = "Small deviations from the whirl develop with the eigenvalues of (12), and a zero for the phase"
STABLE = "No small deviation from the whirl grows where ω > k"
HISTORY = "A small deviation of the radius decays over time as the linear equations (12) say"
THREE_FORMS = "Corrected (13), the matrix of (12) and the Jacobian of (1) have the same eigenvalues"
HURWITZ = "All roots of (13) have negative real parts exactly where (16) holds"
IMPLIED = "Where (16) holds, (14) holds too"
INCOMPATIBLE = "(14) and (15) never hold together"


def pin_at(speed: float, damping: float = PIN.damping) -> PinOnDisc:
    """Return the pin of this study at another disc speed in rad/s and damping in N s/m."""
    return replace(PIN, disc_speed=speed, damping=damping)


def measure(
    engine: Engine,
    speeds: Sequence[float] = SPEEDS,
    starts: Sequence[float] = STARTS,
    points: Sequence[tuple[float, float]] = POINTS,
) -> Findings:
    """Measure all statements with ``engine``.

    ``speeds`` are those of the long simulations, ``starts`` those of the starts on the circle (11), both ω in
    rad/s; ``points`` are the ω and β at which eigenvalues are measured.
    """
    if engine.contact_only:
        return Findings(settling_claims(engine, speeds))
    values = [
        measured_eigenvalues(
            engine, pin_at(*point), on_circle(pin_at(*point)), duration=FLOW_DURATION, frame_speed=K
        )
        for point in points
    ]
    history, history_claim = decaying_deviation(engine)
    times = np.linspace(0.0, CAUGHT, 181)
    leaving = [
        engine.simulate(pin_at(speed), on_circle(pin_at(speed)), times, tolerance=1e-7).radius
        for speed in starts
    ]
    return Findings(
        (
            *settling_claims(engine, speeds),
            balance_claim(engine, starts),
            caught_claim(engine, [speed for speed in starts if speed < K]),
            *eigenvalue_claims(engine, points, values),
            history_claim,
        ),
        {
            "point": np.array(points),
            "eigenvalue": real_and_imaginary([found for found, _ in values]),
            "history_time": DEVIATION_TIMES,
            "history": history,
            "start": np.array(starts),
            "leaving_time": times,
            "leaving": np.array(leaving),
        },
    )


def on_circle(pin: PinOnDisc, scale: float = 1.0) -> FloatArray:
    """Return the state on the circle (11), ``scale`` times as large; for ω < k too, where it is no motion."""
    radius = scale * pin.friction_force / (pin.damping * K)
    return np.array([radius, 0.0, 0.0, K * radius])


def turning_speed(states: FloatArray) -> FloatArray:
    """Return ψ̇ in rad/s of ``states``, shape (..., 4)."""
    x, y, vx, vy = np.moveaxis(states, -1, 0)
    return np.asarray((x * vy - y * vx) / (x**2 + y**2))


def settling_claims(engine: Engine, speeds: Sequence[float]) -> tuple[Claim, Claim]:
    """Return radius and frequency of the whirl in the end of long simulations."""
    period = np.pi / K  # of the deviations in the frame that turns with the whirl, nearly
    times = [0.0, *np.linspace(DURATION - DELAY - period, DURATION - DELAY, 13), DURATION]

    def settle(pin: PinOnDisc, tolerance: float) -> FloatArray:
        run = engine.simulate(pin, on_circle(pin, DISPLACED), times, tolerance=tolerance)
        return np.column_stack((run.radius, turning_speed(run.states)))[1:]

    measured, errors = [], []
    for speed in speeds:
        pin = pin_at(speed)
        track, error = refined(functools.partial(settle, pin), TOLERANCE)
        decay = -whirl_eigenvalues(pin)[1].real
        measured.append(track[-1])
        # One instant may be right by chance.
        errors.append(np.max(error, axis=0) + remaining_transient(track[:-1], track[-1], decay, DELAY))
    values, error = np.array(measured), np.array(errors)
    pin_values = parameters_of(PIN, without=("disc_speed",))
    note = (
        f"Starts on a circle {DISPLACED:g} times as large; state after {DURATION:g} s, for "
        f"{at_each('ω', speeds)} rad/s. Error: the change at a smaller tolerance, and what is left of the "
        f"transient by its change in the last {DELAY:g} s."
    )
    radius, frequency = (
        Claim(
            sentence,
            equation="(11)",
            engine=engine.name,
            predicted=np.full(len(speeds), predicted),
            measured=values[:, column],
            budget=ErrorBudget(error[:, column], resolution=1e-9 * predicted),
            parameters=pin_values,
            source=SOURCE,
            unit=unit,
            note=note,
        )
        for column, (sentence, predicted, unit) in enumerate(
            ((RADIUS, whirl_radius(pin_at(speeds[0])), "m"), (FREQUENCY, K, "rad/s"))
        )
    )
    return radius, frequency


def balance_claim(engine: Engine, starts: Sequence[float]) -> Claim:
    """Return the rate at which the angular momentum of a pin put on the circle (11) changes."""

    def rates(interval: float, tolerance: float) -> FloatArray:
        found = []
        for speed in starts:
            pin = pin_at(speed)
            state = on_circle(pin)
            run = engine.simulate(pin, state, interval * np.arange(5), tolerance=tolerance)
            x, y, vx, vy = run.states.T
            moment = FORWARD @ (pin.mass * (x * vy - y * vx)) / interval
            found.append(moment / (pin.friction_force * state[0]))
        return np.array(found)

    measured, error = refined(functools.partial(rates, INTERVAL), 1e-11)
    difference = np.abs(rates(2.0 * INTERVAL, 1e-11) - measured)
    rounding = 8.0 * np.finfo(float).eps * PIN.mass * K / (PIN.damping * INTERVAL)
    pin_values = parameters_of(PIN, without=("disc_speed",))
    return Claim(
        BALANCE,
        equation="(11)",
        engine=engine.name,
        predicted=[0.0 if speed > K else -2.0 for speed in starts],
        measured=measured,
        budget=ErrorBudget(
            np.full(len(starts), np.max(error) + np.max(difference) + rounding), resolution=1e-5
        ),
        parameters=pin_values,
        source=SOURCE,
        note="Change of the angular momentum in time over μN·ρ_c, from a one-sided difference, for "
        f"{at_each('ω', starts)} rad/s. By (10) it is sign(ω − k) − 1. The paper says that (11) always "
        "exists: see the errata. Error: the change at a smaller tolerance and at a larger interval.",
    )


def caught_claim(engine: Engine, speeds: Sequence[float]) -> Claim:
    """Return how fast a pin that left the circle (11) below k turns in the end."""

    def ends(tolerance: float) -> FloatArray:
        pins = [pin_at(speed) for speed in speeds]
        states = [
            engine.simulate(pin, on_circle(pin), [0.0, CAUGHT], tolerance=tolerance).at_end for pin in pins
        ]
        return np.array(
            [turning_speed(state) / pin.disc_speed for state, pin in zip(states, pins, strict=True)]
        )

    measured, error = refined(ends, 1e-7)
    pin_values = parameters_of(PIN, without=("disc_speed",))
    return Claim(
        CAUGHT_BELOW,
        equation="(11)",
        engine=engine.name,
        predicted=np.ones(len(speeds)),
        measured=measured,
        budget=ErrorBudget(np.full(len(speeds), np.max(error)), resolution=1e-3),
        parameters=pin_values,
        source=SOURCE,
        note=f"Speed at which it turns after {CAUGHT:g} s, over ω, for {at_each('ω', speeds)} rad/s.",
    )


def eigenvalue_claims(
    engine: Engine,
    points: Sequence[tuple[float, float]],
    values: Sequence[tuple[ComplexArray, float]],
) -> tuple[Claim, Claim]:
    """Return how the measured eigenvalues compare with the predicted ones, and with zero."""
    predicted = [
        matched(whirl_eigenvalues(pin_at(*point)), found)
        for point, (found, _) in zip(points, values, strict=True)
    ]
    errors = np.array([error for _, error in values])
    measured = np.array([found for found, _ in values])
    but_phase = np.sort(measured.real, axis=1)[:, :3]
    pin_values = parameters_of(PIN, without=("disc_speed", "damping"))
    where = f"for (ω, β) = {', '.join(f'({speed:g}, {damping:g})' for speed, damping in points)}"
    return (
        Claim(
            EIGENVALUES,
            equation="(12)",
            engine=engine.name,
            predicted=real_and_imaginary(predicted),
            measured=real_and_imaginary(measured),
            budget=ErrorBudget(
                np.broadcast_to(errors[:, np.newaxis, np.newaxis], (len(points), 4, 2)), resolution=1e-6 * K
            ),
            parameters=pin_values,
            source=SOURCE + "; β too where it is not 0.1",
            unit="1/s",
            note=f"Real and imaginary parts of all four, {where}: central differences of the motion over "
            f"{FLOW_DURATION:g} s, in the frame that turns with the whirl, extrapolated to zero. Error: the "
            "change with larger differences, and at a smaller tolerance.",
        ),
        Claim(
            STABLE,
            equation="(16)",
            engine=engine.name,
            **holds(-but_phase, errors[:, np.newaxis]),
            parameters=pin_values,
            source=SOURCE + "; β too where it is not 0.1",
            note="Whether the real part of each measured eigenvalue is below zero, but for one at each point, which "
            "belongs to the phase.",
            implied_by=EIGENVALUES,
        ),
    )


def decaying_deviation(engine: Engine) -> tuple[FloatArray, Claim]:
    """Return the deviation of the radius over time, shape (n,), and the claim on it."""
    pin = PIN
    radius = whirl_radius(pin)
    shift = np.array([radius, 0.0, K * radius, K * radius])

    def deviation(amplitude: float, tolerance: float) -> FloatArray:
        outwards, inwards = (
            engine.simulate(
                pin, on_circle(pin) + sign * amplitude * shift, DEVIATION_TIMES, tolerance=tolerance
            ).radius
            for sign in (1.0, -1.0)
        )
        return np.asarray((outwards - inwards) / (2.0 * amplitude * radius))

    measured, error = refined(functools.partial(deviation, DEVIATION), 1e-10)
    nonlinear = np.abs(deviation(2.0 * DEVIATION, 1e-10) - measured)
    return measured, Claim(
        HISTORY,
        equation="(12)",
        engine=engine.name,
        predicted=linear_deviation(DEVIATION_TIMES),
        measured=measured,
        budget=ErrorBudget(
            np.full(len(measured), np.max(error)), model=float(np.max(nonlinear)), resolution=1e-4
        ),
        parameters=parameters_of(pin),
        source=SOURCE,
        note=f"Starts with ξ = ±a, ξ̇ = ±ka, η = 0 and a = {DEVIATION:g}·ρ_c; half the difference of the "
        f"radii over a, at {len(measured)} times up to {DEVIATION_TIMES[-1]:g} s. Model error: the change with "
        "a twice as large, three times what the next order of the deviation amounts to.",
    )


def linear_deviation(times: FloatArray) -> FloatArray:
    """Return ξ/a by (12), shape (n,), from the start ξ = a, ξ̇ = ka, η = 0."""
    start = np.array([1.0, K, 0.0])
    step = expm(variational_matrix(PIN) * (times[1] - times[0]))
    states = [start]
    for _ in times[1:]:
        states.append(step @ states[-1])
    return np.array(states)[:, 0]


def theory() -> Findings:
    """Check (12) to (16) against each other, and compute the curves of the formulas."""
    speeds = K * (1.0 + np.geomspace(0.01, 6.0, 240))
    curves = [whirl_eigenvalues(pin_at(speed))[1:] for speed in speeds]
    ratio, damping, largest, claims = hurwitz()
    return Findings(
        (three_forms_claim(), *claims),
        {
            "speed": speeds,
            "eigenvalue": real_and_imaginary(curves),
            "ratio": ratio,
            "damping": damping,
            "largest": largest,
            "deviation_time": DEVIATION_TIMES,
            "deviation": linear_deviation(DEVIATION_TIMES),
        },
    )


def three_forms_claim() -> Claim:
    """Return the roots of corrected (13) beside the eigenvalues of (12) and of the Jacobian of (1)."""
    pins = [
        pin_at(float(speed), float(damping))
        for speed in K * (1.0 + np.geomspace(0.02, 9.0, 15))
        for damping in np.geomspace(0.03, 3.0, 9)
    ]
    companion = np.zeros((len(pins), 3, 3))
    companion[:, 1:, :2] = np.eye(2)
    companion[:, :, 2] = [[-value for value in characteristic_coefficients(pin)[:0:-1]] for pin in pins]
    roots, roots_error = eigenvalues_with_rounding(companion)
    of_12, of_12_error = eigenvalues_with_rounding([variational_matrix(pin) for pin in pins])
    of_1, of_1_error = eigenvalues_with_rounding([turning_frame_jacobian(pin) for pin in pins])
    measured, predicted, errors = [], [], []
    for i in range(len(pins)):
        expected = matched([0.0, *roots[i]], of_1[i])
        measured.append([*matched(of_12[i], roots[i]), *of_1[i]])
        predicted.append([*roots[i], *expected])
        errors.append(np.max(roots_error[i]) + max(np.max(of_12_error[i]), np.max(of_1_error[i])))
    pin_values = parameters_of(PIN, without=("disc_speed", "damping"))
    return Claim(
        THREE_FORMS,
        equation="(12), (13)",
        engine="theory",
        predicted=real_and_imaginary(predicted),
        measured=real_and_imaginary(measured),
        budget=ErrorBudget(
            np.broadcast_to(np.array(errors)[:, np.newaxis, np.newaxis], (len(pins), 7, 2)),
            resolution=1e-9 * K,
        ),
        parameters=pin_values,
        source="Fig. 4 with X0 = 0; a grid of ω/k = 1.02 … 10 and β = 0.03 … 3 N s/m",
        unit="1/s",
        note="All three eigenvalues of (12), and all four of the Jacobian in the frame that turns with the "
        "whirl, one of which is the zero of the phase. Error: rounding, by the condition of each eigenvalue.",
    )


def hurwitz() -> tuple[FloatArray, FloatArray, FloatArray, tuple[Claim, ...]]:
    """Compare the conditions (14) to (16) with the eigenvalues over a grid, ω < k included.

    Returns ω/k, β/(mk), the largest real part of the roots of (13) over k on the grid of both (first index:
    damping), and the claims.
    """
    ratio = (np.arange(150) + 0.5) / 50.0
    damping = np.geomspace(0.03, 10.0, 81)
    ratio = ratio[ratio != 1.0]
    pins = [pin_at(K * r, PIN.mass * K * d) for d in damping for r in ratio]
    values, rounding = eigenvalues_with_rounding([variational_matrix(pin) for pin in pins])
    worst = np.argmax(values.real, axis=1)[:, np.newaxis]
    largest = np.take_along_axis(values.real, worst, axis=1)[:, 0]
    error = np.take_along_axis(rounding, worst, axis=1)[:, 0]
    in_14 = np.array([min(coefficient_margins(pin)) > 0.0 for pin in pins])
    in_15 = np.array([lower_branch_margin(pin) > 0.0 for pin in pins])
    in_16 = np.array([upper_branch_margin(pin) > 0.0 for pin in pins])
    values_of_pin = parameters_of(PIN, without=("disc_speed", "damping"))
    grid = (
        f"a grid of {len(ratio)} values of ω/k = {ratio[0]:g} … {ratio[-1]:g} and {len(damping)} of "
        f"β/(mk) = {damping[0]:g} … {damping[-1]:g}"
    )

    def count(sentence: str, equation: str, margins: ArrayLike, errors: ArrayLike, note: str) -> Claim:
        return Claim(
            sentence,
            equation=equation,
            engine="theory",
            **holds(margins, errors, may_be_open=len(pins) // 1000),
            parameters=values_of_pin,
            source=f"assumption: {grid}",
            note=note,
        )

    claims = (
        count(
            HURWITZ,
            "(16)",
            np.where(in_16, -largest, largest),
            error,
            "Whether the condition and the eigenvalues of (12) say the same at each grid point; rounding may leave "
            "one in a thousand open. Below k this is about the matrix only: no whirl exists there.",
        ),
        count(
            IMPLIED,
            "(14), (16)",
            ~in_16 | in_14,
            0.0,
            "At each grid point. With q = 4k²m²/β² the bound of (16) is "
            "−q/(1 + q + √(1 + q²)), which is above −1 and above −q.",
        ),
        count(
            INCOMPATIBLE,
            "(14), (15)",
            ~(in_14 & in_15),
            0.0,
            "At each grid point. With q = 4k²m²/β² the bound of (15) is "
            "−(1 + q + √(1 + q²))/2, which is below −min(1, q), where (14) fails.",
        ),
    )
    return ratio, damping, largest.reshape(len(damping), len(ratio)) / K, claims


STUDY = Study(
    name="whirl-stability",
    title="The whirl without offset and its stability",
    section="The friction pin",
    paper=(
        "Without offset the pin can whirl on a circle of radius μN/(βk) with its natural frequency k; the "
        "paper says that this solution always exists (11). Deviations from it obey (12), with the "
        "characteristic equation (13), and by Hurwitz' criterion (14) to (16) they decay where (16) holds, "
        "which is so wherever ω > k.\n\n"
        "By the sense of the friction force in (10) the whirl exists only for ω > k, and (13) is misprinted; "
        "here its corrected form is used, and the errata show both."
    ),
    by_hand=measure,
    theory=theory,
    draw=draw,
    figures={
        "whirl-motions": (
            "Left: the radius after a start on the circle (11); below ω = k the pin leaves it and is caught "
            "by the disc. Right: deviation of the radius after a small displacement with a kick, simulated "
            "and by (12), inside of the envelope of its modes."
        ),
        "whirl-eigenvalues": (
            "Eigenvalues of the whirl over the speed of the disc, from (12) and measured in simulations of "
            "small deviations. The zero that belongs to the phase is left out on the left by the logarithm."
        ),
        "whirl-map": (
            "Largest real part of the roots of (13) over speed and damping. The boundary (16) lies below "
            "ω = k/3, where no whirl exists: wherever it exists, it is stable."
        ),
    },
    seconds=2.0,
    quick=True,
    contact=True,
)
