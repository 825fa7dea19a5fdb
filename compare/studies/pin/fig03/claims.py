"""Fig. 3 and eq. 3 to 5: the pin at rest in space on the semicircle, its stability, and the loss of it."""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

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
from compare.claims.parameters import at_each, parameters_of
from compare.claims.study import Data, Findings, Study
from compare.engines import Engine
from compare.figures import GREY, axis, curve, engines_in, new_figure, points
from compare.studies.toolkit.deviations import remaining_transient
from reference_model.formulas.pin import (
    equilibrium_position,
    largest_load_with_equilibrium,
    semicircle_residual,
    sticking_radius,
)
from reference_model.steady.stability import equilibrium_eigenvalues, sliding_jacobian
from reference_model.systems import FloatArray, PinOnDisc

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PIN = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.05, disc_speed=0.8, offset=0.1)
SOURCE = "assumption: the paper prints no parameters for Fig. 3; support as in Fig. 4, ω below k"

START = (0.1, 0.05, 0.0, 0.0)
"""x, y, vx, vy in m and m/s: at rest, displaced from every equilibrium."""

LOADS = (0.0, 0.02, 0.04, 0.06, 0.08, 0.09, 0.095, 0.098)
"""μN in N, within (5)."""

DURATION = 520.0
"""In s: the slowest transient, exp(−βt/2m), falls to 5e-12 of its beginning."""

DELAY = 60.0
"""In s: from how long before the end the remaining transient is inferred."""

TOLERANCE = 3e-11

LIMITS = (0.98, 0.999, 1.05, 1.2)
"""Loads about the limit (5), in units of it."""

SETTLING = 300.0
"""In s: from the axis to the equilibrium, for loads below the limit."""

REVOLUTIONS = 2.0
"""Of the disc, for loads above the limit, where the pin is caught at once."""

FLOW_DURATION = 0.3
"""In s, of the simulations that give eigenvalues: short enough for the strongly damped ones to be seen."""

RESTS = "A displaced pin comes to rest in space at the position (3)"
CIRCLE = "The positions of rest lie on the semicircle through the axis and the relaxed point of the springs"
VANISHES = "The distance of the position of rest from the axis goes to zero at the load C·X0"
GONE = "Below the load C·X0 the pin rests in space, above it there is no such rest and it turns with the disc"
EIGENVALUES = "Small deviations from the position of rest develop with the eigenvalues of linearised (1)"
STABLE = "No small deviation from the position of rest grows, whatever the load within (5)"


def with_load(load: float) -> PinOnDisc:
    """Return the pin of this study under the load μN in N."""
    return replace(PIN, friction_force=load)


def measure(engine: Engine, loads: Sequence[float] = LOADS, limits: Sequence[float] = LIMITS) -> Findings:
    """Measure all statements with ``engine``, at the loads μN in N and at those in units of the limit (5)."""
    positions, position_error = resting_positions(engine, loads)
    values = [
        measured_eigenvalues(
            engine,
            with_load(load),
            (*equilibrium_position(with_load(load)), 0.0, 0.0),
            duration=FLOW_DURATION,
        )
        for load in loads
    ]
    return Findings(
        (
            *position_claims(engine, loads, positions, position_error),
            existence_claim(engine, limits),
            *eigenvalue_claims(engine, loads, values),
        ),
        {
            "load": np.array(loads),
            "position": positions,
            "position_error": position_error,
            "eigenvalue": real_and_imaginary([eigenvalues for eigenvalues, _ in values]),
        },
    )


def resting_positions(engine: Engine, loads: Sequence[float]) -> tuple[FloatArray, FloatArray]:
    """Return where the pin is after a long time, and the error as a distance; shapes (n, 2) and (n,) in m."""
    period = 2.0 * np.pi / PIN.natural_frequency
    earlier = np.linspace(DURATION - DELAY - period, DURATION - DELAY, 13)
    times = [0.0, *earlier, DURATION]

    def track(load: float, tolerance: float) -> FloatArray:
        return engine.simulate(with_load(load), START, times, tolerance=tolerance).states[1:, :2]

    positions, errors = [], []
    for load in loads:
        positions_in_time, error = refined(functools.partial(track, load), TOLERANCE)
        decay = -equilibrium_eigenvalues(with_load(load))[0].real
        left = remaining_transient(positions_in_time[:-1], positions_in_time[-1], decay, DELAY)
        positions.append(positions_in_time[-1])
        # One component, or one instant, may be right by chance.
        # At rest two runs may coincide to within the tolerance, which then is what is known of the error.
        errors.append(np.max(error) + np.hypot(*left) + TOLERANCE * PIN.offset)
    return np.array(positions), np.array(errors)


def position_claims(
    engine: Engine, loads: Sequence[float], positions: FloatArray, error: FloatArray
) -> tuple[Claim, ...]:
    """Return what the positions of rest say about (3), (4) and (5)."""
    pin, X0 = parameters_of(PIN, without=("friction_force",)), PIN.offset
    predicted = np.array([equilibrium_position(with_load(load)) for load in loads])
    how = (
        f"Starts at rest at x = {START[0]:g} m, y = {START[1]:g} m; position after {DURATION:g} s, "
        f"for {at_each('μN', loads)} N. Error: the tolerance, the change at a smaller one, and what is "
        f"left of the transient by its change in the last {DELAY:g} s."
    )
    x, y = positions.T
    # ∂(4)/∂(x, y) is twice the way from the circle's centre, so of length X0 on the circle.
    on_circle = 2.0 * np.hypot(x - X0 / 2.0, y) * error + error**2
    load_limit, limit_error = vanishing_load(loads, positions, error)
    return (
        Claim(
            RESTS,
            equation="(3)",
            engine=engine.name,
            predicted=predicted,
            measured=positions,
            budget=ErrorBudget(np.repeat(error[:, np.newaxis], 2, axis=1), resolution=1e-9 * X0),
            parameters=pin,
            source=SOURCE,
            unit="m",
            note=how,
        ),
        Claim(
            CIRCLE,
            equation="(4)",
            engine=engine.name,
            predicted=np.zeros(len(loads)),
            measured=semicircle_residual(PIN, x, y),
            budget=ErrorBudget(on_circle, resolution=1e-9 * X0**2),
            parameters=pin,
            source=SOURCE,
            unit="m²",
            note="Left side minus right side of (4), at the positions of the claim above.",
            implied_by=RESTS,
        ),
        Claim(
            VANISHES,
            equation="(5)",
            engine=engine.name,
            predicted=largest_load_with_equilibrium(PIN),
            measured=load_limit,
            budget=ErrorBudget(limit_error, resolution=1e-9 * largest_load_with_equilibrium(PIN)),
            parameters=pin,
            source=SOURCE,
            unit="N",
            note=f"The squared distance, linear in the squared load, is extrapolated to zero from "
            f"{at_each('μN', loads[-2:])} N.",
            implied_by=RESTS,
        ),
    )


def vanishing_load(loads: Sequence[float], positions: FloatArray, error: FloatArray) -> tuple[float, float]:
    """Return the load in N at which ρ² of the last two positions reaches zero, and its error.

    By (3) ρ² is linear in (μN)².
    """
    first, last = (load**2 for load in loads[-2:])
    first_radius, last_radius = np.hypot(*positions[-2:].T)
    rho_first, rho_last = first_radius**2, last_radius**2
    fall = rho_first - rho_last
    squared = last + rho_last * (last - first) / fall
    by_first = 2.0 * first_radius * error[-2] * rho_last * (last - first) / fall**2
    by_last = 2.0 * last_radius * error[-1] * rho_first * (last - first) / fall**2
    limit = math.sqrt(squared) if squared > 0.0 else math.nan
    return limit, float(abs(by_first) + abs(by_last)) / (2.0 * limit)


def existence_claim(engine: Engine, limits: Sequence[float]) -> Claim:
    """Return how fast the pin turns about the axis in the end, for loads about the limit (5)."""
    revolution = 2.0 * np.pi / PIN.disc_speed
    limit = largest_load_with_equilibrium(PIN)
    x = min(sticking_radius(with_load(limit * ratio)) for ratio in limits if ratio > 1.0) / 2.0
    measured, errors = [], []
    for ratio in limits:
        pin = with_load(limit * ratio)
        end = SETTLING if ratio < 1.0 else REVOLUTIONS * revolution
        times = [0.0, *np.linspace(end - revolution, end, 17)]

        def turning(tolerance: float, pin: PinOnDisc = pin, times: list[float] = times) -> FloatArray:
            states = engine.simulate(pin, (x, 0.0, 0.0, 0.0), times, tolerance=tolerance).states[1:]
            angles = np.unwrap(np.arctan2(states[:, 1], states[:, 0]))
            return np.array([(angles[-1] - angles[0]) / revolution, *np.hypot(*states[:, :2].T)])

        (speed, *radii), error = refined(turning, 1e-7)
        measured.append(speed / PIN.disc_speed)
        left = 0.0
        if ratio < 1.0:  # whatever still moves does so with an envelope exp(−rt)
            decay = equilibrium_eigenvalues(pin)[0].real
            left = float(np.exp(decay * SETTLING)) * PIN.offset / min(radii) / revolution
        errors.append((error[0] + left) / PIN.disc_speed)
    pin_values = parameters_of(PIN, without=("friction_force",))
    return Claim(
        GONE,
        equation="(5)",
        engine=engine.name,
        predicted=[0.0 if ratio < 1.0 else 1.0 for ratio in limits],
        measured=measured,
        budget=ErrorBudget(np.full(len(limits), max(errors)), resolution=1e-3),
        parameters=pin_values,
        source=SOURCE,
        note=f"Mean speed at which the pin turns about the axis in the last revolution, over ω, for "
        f"{at_each('μN/(C·X0)', limits)}. Starts at rest {x:.2e} m beside the axis.",
    )


def eigenvalue_claims(
    engine: Engine, loads: Sequence[float], values: Sequence[tuple[ComplexArray, float]]
) -> tuple[Claim, ...]:
    """Return how the measured eigenvalues compare with the predicted ones, and with zero."""
    pin = parameters_of(PIN, without=("friction_force",))
    predicted = [
        matched(equilibrium_eigenvalues(with_load(load)), found)
        for load, (found, _) in zip(loads, values, strict=True)
    ]
    errors = np.array([error for _, error in values])
    measured = np.array([found for found, _ in values])
    return (
        Claim(
            EIGENVALUES,
            equation="(1)",
            engine=engine.name,
            predicted=real_and_imaginary(predicted),
            measured=real_and_imaginary(measured),
            budget=ErrorBudget(
                np.broadcast_to(errors[:, np.newaxis, np.newaxis], (len(loads), 4, 2)),
                resolution=1e-6 * PIN.natural_frequency,
            ),
            parameters=pin,
            source=SOURCE,
            unit="1/s",
            note=f"Real and imaginary parts of all four, for {at_each('μN', loads)} N: central differences "
            f"of the motion over {FLOW_DURATION:g} s, extrapolated to zero. Error: the change with larger "
            "differences, and at a smaller tolerance.",
        ),
        Claim(
            STABLE,
            equation="(5)",
            engine=engine.name,
            **holds(-measured.real, errors[:, np.newaxis]),
            parameters=pin,
            source=SOURCE,
            note="Whether the real part of each measured eigenvalue is below zero.",
            implied_by=EIGENVALUES,
        ),
    )


def theory() -> Findings:
    """Count the eigenvalues that do not decay, and compute the curves of the formulas."""
    ratios = np.array([0.01, *np.linspace(0.05, 0.95, 19), 0.99, 0.999])
    speeds = np.geomspace(0.05, 5.0, 25)
    dampings = np.geomspace(0.01, 3.0, 12)
    limit = largest_load_with_equilibrium(PIN)
    pins = [
        replace(PIN, friction_force=ratio * limit, disc_speed=speed, damping=damping)
        for ratio in ratios
        for speed in speeds
        for damping in dampings
    ]
    jacobians = [sliding_jacobian(pin, (*equilibrium_position(pin), 0.0, 0.0)) for pin in pins]
    values, rounding = eigenvalues_with_rounding(jacobians)
    claim = Claim(
        STABLE,
        equation="(5)",
        engine="theory",
        **holds(-values.real, rounding, may_be_open=values.size // 1000),
        parameters={"mass": PIN.mass, "stiffness": PIN.stiffness, "offset": PIN.offset},
        source="assumption: a grid of loads, disc speeds and dampings",
        note="Whether each eigenvalue of the linearised (1) decays: "
        f"μN/(C·X0) = {ratios[0]:g} … {ratios[-1]:g}, ω = {speeds[0]:g} … {speeds[-1]:g} rad/s, "
        f"β = {dampings[0]:g} … {dampings[-1]:g} N s/m; up to one in a thousand "
        "may be left open by rounding. In closed form they are the roots of mλ² + βλ + C and of "
        "mλ² + (β + μN/(ωρ*))λ + C: all decay where β > 0.",
    )
    loads = limit * np.sin(np.linspace(0.0, 0.5 * np.pi, 181))[:-1]  # equal steps along the semicircle
    positions = np.array([equilibrium_position(with_load(load)) for load in loads])
    curves = [along_and_across(equilibrium_eigenvalues(with_load(load))) for load in loads[1:]]
    return Findings(
        (claim,),
        {
            "load": np.array([*loads, limit]),
            "position": np.vstack((positions, [0.0, 0.0])),
            "eigenvalue_load": loads[1:],
            "eigenvalue": real_and_imaginary(curves),
        },
    )


def along_and_across(values: Sequence[complex]) -> list[complex]:
    """Sort the four eigenvalues, those of motion along the circumference (of the support alone) first."""
    m, beta, C = PIN.mass, PIN.damping, PIN.stiffness
    along = sorted(values, key=lambda value: abs(m * value**2 + beta * value + C))
    return [
        *sorted(along[:2], key=lambda value: -value.imag),
        *sorted(along[2:], key=lambda value: (-value.imag, -value.real)),
    ]


def draw(data: Mapping[str, Data]) -> dict[str, Figure]:
    """Draw the semicircle with the errors beside it, and the eigenvalues over the load."""
    figures = {"fig03-semicircle": draw_semicircle(data)}
    if "theory" in data:
        figures["fig03-eigenvalues"] = draw_eigenvalues(data)
    return figures


def draw_semicircle(data: Mapping[str, Data]) -> Figure:
    """Draw the positions of rest on the semicircle, and their distance from (3) over the load."""
    figure, (plane, distance) = new_figure(ncols=2, width=9.6, height=3.9)
    X0 = PIN.offset
    if "theory" in data:
        plane.plot(*data["theory"]["position"].T, **curve("theory", "eq. (3)"))
    plane.plot([0.0, X0], [0.0, 0.0], color="black", marker="+", linestyle="none", markersize=9.0)
    plane.annotate("axis of the disc", (0.0, 0.0), (2, -13), textcoords="offset points", fontsize=9.5)
    plane.annotate(
        "springs relaxed", (X0, 0.0), (-2, -13), textcoords="offset points", ha="right", fontsize=9.5
    )
    for engine in engines_in(data):
        plane.plot(*data[engine]["position"].T, **points(engine))
        found = data[engine]
        predicted = np.array([equilibrium_position(with_load(load)) for load in found["load"]])
        away = np.hypot(*(found["position"] - predicted).T)
        floor = np.finfo(float).eps * X0
        distance.semilogy(found["load"], np.maximum(away, floor), **points(engine))
        distance.semilogy(
            found["load"],
            found["position_error"],
            **curve(engine, f"{engine}: error budget", linewidth=1.0, linestyle="--"),
        )
    for load in LOADS:
        x, y = equilibrium_position(with_load(load))
        outwards = np.array([x - X0 / 2.0, y]) / (X0 / 2.0)
        plane.annotate(
            f"{load:g}",
            (x, y),
            tuple(9.0 * outwards),
            textcoords="offset points",
            ha="left" if outwards[0] > 0.3 else "right" if outwards[0] < -0.3 else "center",
            va="bottom" if outwards[1] > 0.3 else "center",
            fontsize=9.5,
        )
    plane.set(
        xlabel=axis("x", "m"),
        ylabel=axis("y", "m"),
        xlim=(-0.018, 0.121),
        ylim=(-0.012, 0.066),
        aspect="equal",
        title=r"Positions of rest, labelled with $\mu N$ in N",
    )
    if data:
        plane.legend(loc="center", bbox_to_anchor=(0.5, 0.42))
    distance.axhline(1e-9 * X0, color=GREY, linewidth=0.9, linestyle=":", label=r"$10^{-9}\,X_0$")
    distance.set(
        xlabel=axis(r"\mu N", "N"), ylabel="distance in m", ylim=(1e-16, 1e-8), title="Distance from (3)"
    )
    distance.legend(loc="upper left", ncols=2, fontsize=9.0)
    return figure


def draw_eigenvalues(data: Mapping[str, Data]) -> Figure:
    """Draw real and imaginary parts of the eigenvalues over the load."""
    figure, (decay, oscillation) = new_figure(ncols=2, sharex=True)
    theory = data["theory"]
    for panel, part, sign in ((decay, 0, -1.0), (oscillation, 1, 1.0)):
        for which in range(4):
            line = curve("theory", "linearised (1)" if which == 0 else "_")
            panel.plot(theory["eigenvalue_load"], sign * theory["eigenvalue"][:, which, part], **line)
        for engine in engines_in(data):
            load = np.repeat(data[engine]["load"], 4)
            panel.plot(load, sign * data[engine]["eigenvalue"][..., part].ravel(), **points(engine))
        panel.set(xlabel=axis(r"\mu N", "N"))
    decay.set(yscale="log", ylabel=axis(r"-\mathrm{Re}\,\lambda", "1/s"), title="Decay", ylim=(0.02, 100.0))
    decay.annotate("across the circumference", (0.004, 0.55), fontsize=9.5)
    decay.annotate("along the circumference", (0.004, 0.031), fontsize=9.5)
    decay.legend(loc="upper left")
    oscillation.set(ylabel=axis(r"\mathrm{Im}\,\lambda", "1/s"), title="Oscillation")
    return figure


STUDY = Study(
    name="fig03",
    title="Self-centring: the pin at rest in space",
    section="The friction pin",
    paper=(
        "At low speed of the disc the pin finds a rest in space while the disc slides below it (3). Under "
        "growing load the position of rest moves along a semicircle (4) towards the axis, until at μN = C·X0 "
        "it is lost (5). The equilibrium is always stable. Fig. 3 compares (3) with simulations, without "
        "giving parameters."
    ),
    by_hand=measure,
    theory=theory,
    draw=draw,
    figures={
        "fig03-semicircle": (
            "Fig. 3 redrawn. Left: formula (3) and where long simulations end. Right: how far these are from "
            "the formula, with the error that each engine could have made unnoticed."
        ),
        "fig03-eigenvalues": (
            "Eigenvalues of the position of rest over the load: of (1) linearised, and measured in "
            "simulations of small deviations. Motion along the circumference keeps the damping of the "
            "support; radial motion is braked by friction as well, the more the nearer to the axis."
        ),
    },
    seconds=2.0,
)
