"""Fig. 3 and eqs. (3) to (5): the pin at rest in space on the semicircle."""

import functools
import itertools
import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from compare.claims import WORKING, ByEngine, Data, Figures, Measured, Measurement, Study, answers_of, refined
from compare.claims.linearised_flow import eigenvalues_with_rounding, real_and_imaginary
from compare.engines import Engine
from compare.output.figures import GREY, Axes, Figure, axis, curve, engines_in, new_figure, points
from compare.studies.toolkit.deviations import Rates, measured_rates, settled
from compare.studies.toolkit.measuring import compared, residual_of_4
from reference_model.formulas import pin as formulas
from reference_model.formulas.pin import equilibrium_position
from reference_model.steady.stability import equilibrium_eigenvalues, sliding_jacobian
from reference_model.systems import FloatArray, PinOnDisc

PIN = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.05, disc_speed=0.8, offset=0.1)
SOURCE = "assumption: the paper prints no parameters for Fig. 3; support as in Fig. 4, ω below k"

LIMIT = formulas.largest_load_with_equilibrium(PIN)  # (5), in N
START = (0.1, 0.05, 0.0, 0.0)  # position in m, displaced from every equilibrium
LOADS = (0.0, 0.04, 0.08, 0.095, 0.098)  # μN in N, within (5)
DURATION, DELAY, TOLERANCE = 520.0, 60.0, 0.03 * WORKING
"""Runs to rest: duration in s until the slowest transient, exp(−βt/2m), has fallen to 5e-12, its final part for the
remaining transient, and tolerance for a resolution of 1e-9 of X0.
"""

SHARES, SETTLING = (0.98, 0.999, 1.05, 1.2), 300.0
"""μN as a multiple of the limit (5), and duration in s from the axis to the equilibrium."""

REVOLUTION = 2.0 * np.pi / PIN.disc_speed
"""Period of the disc in s. Above the limit the pin sticks at once, so two periods suffice."""

FLOW_DURATION = 0.3
"""Duration in s, short enough for strongly damped eigenvalues."""

GRID_SHARES = np.array([0.01, *np.linspace(0.05, 0.95, 19), 0.99, 0.999])
GRID_SPEEDS = np.geomspace(0.05, 5.0, 25)
GRID_DAMPINGS = np.geomspace(0.01, 3.0, 12)
"""Grid for the linearised (1): μN as a share of the limit (5), ω in rad/s and β in N s/m."""


def with_load(load: float) -> PinOnDisc:
    return replace(PIN, friction_force=load)


def curves() -> Data:
    loads = LIMIT * np.sin(np.linspace(0.0, 0.5 * np.pi, 181))[:-1]  # equal steps along the semicircle
    eigenvalues = [along_and_across(equilibrium_eigenvalues(with_load(load))) for load in loads[1:]]
    return {
        "position": np.vstack((positions(loads), [0.0, 0.0])),
        "eigenvalue_load": loads[1:],
        "eigenvalue": real_and_imaginary(eigenvalues),
    }


def positions(loads: Sequence[float] | FloatArray) -> FloatArray:
    """Return the positions (3) at μN = ``loads`` (N), shape (n, 2)."""
    return np.array([equilibrium_position(with_load(load)) for load in loads])


def along_and_across(values: Sequence[complex]) -> list[complex]:
    """Return the eigenvalues of motion along the circumference, damped by the support alone, then the others."""
    m, beta, C = PIN.mass, PIN.damping, PIN.stiffness
    along = sorted(values, key=lambda value: abs(m * value**2 + beta * value + C))
    return [
        *sorted(along[:2], key=lambda value: -value.imag),
        *sorted(along[2:], key=lambda value: (-value.imag, -value.real)),
    ]


def vanishing_load(loads: Sequence[float], places: FloatArray, error: FloatArray) -> tuple[float, float]:
    """Return μN (N) for ρ² = 0, extrapolated from the last two ``places``, and its error.

    According to (3), ρ² is linear in (μN)².
    """
    first, last = (load**2 for load in loads[-2:])
    radius = np.hypot(*places[-2:].T)
    rho_first, rho_last = radius**2
    fall = rho_first - rho_last
    squared = last + rho_last * (last - first) / fall
    moved = 2.0 * radius * error[-2:] * (rho_last, rho_first) * (last - first) / fall**2
    limit = math.sqrt(squared) if squared > 0.0 else math.nan
    return limit, float(np.sum(np.abs(moved))) / (2.0 * limit)


STUDY = Study.beside(__file__, "fig03", source=SOURCE, system=PIN, seconds=2.0)

DECAYS = "The position of rest is stable at every friction force within (5)"


@STUDY.claim(
    "A displaced pin comes to rest in space at the position (3)",
    equation="(3)",
    unit="m",
    resolution=1e-9 * PIN.offset,
    note=f"Starts at rest at x = {START[0]:g} m, y = {START[1]:g} m; position after {DURATION:g} s. Numerical "
    f"error: the tolerance, the change at a smaller tolerance, and the remaining transient, judged by its "
    f"change in the last "
    f"{DELAY:g} s.",
    swept=("friction_force",),
)
def rests(engine: Engine, loads: Sequence[float] = LOADS) -> Measured:
    found = resting_places(engine, loads)
    return compared(
        positions(loads),
        found,
        at={"μN in N": loads},
        components=("x", "y"),
        data={"load": loads, "position": found.value, "position_error": found.error[:, 0]},
    )


@functools.lru_cache(maxsize=2)
def resting_places(engine: Engine, loads: Sequence[float]) -> Measurement:
    """Return the final positions (m), shape (n, 2), with their errors as distances."""

    def track(load: float, times: list[float], tolerance: float) -> FloatArray:
        return engine.simulate(with_load(load), START, times, tolerance=tolerance).states[1:, :2]

    places, errors = [], []
    for load in loads:
        end = settled(
            functools.partial(track, load),
            duration=DURATION,
            delay=DELAY,
            period=2.0 * np.pi / PIN.natural_frequency,
            rate=-equilibrium_eigenvalues(with_load(load))[0].real,
            tolerance=TOLERANCE,
        )
        places.append(end.value)
        # At rest, two runs may agree better than the tolerance.
        errors.append([np.max(end.error) + np.hypot(*end.left) + TOLERANCE * PIN.offset] * 2)
    return Measurement(np.array(places), np.array(errors))


@STUDY.claim(
    "The positions of rest lie on the semicircle through the axis and the relaxed point of the springs",
    equation="(4)",
    unit="m²",
    resolution=1e-9 * PIN.offset**2,
    note="Left side minus right side of (4), at the positions of the previous claim.",
    implied_by=rests,
    friction=False,
    swept=("friction_force",),
)
def semicircle(engine: Engine, loads: Sequence[float] = LOADS) -> Measured:
    places, error = resting_places(engine, loads)
    return residual_of_4(PIN, places, error[:, 0], {"μN in N": loads})


@STUDY.claim(
    "The position of rest reaches the axis at the friction force C·X0",
    equation="(5)",
    unit="N",
    resolution=1e-9 * LIMIT,
    note="The squared distance from the axis, linear in (μN)², is extrapolated to zero from the two largest μN.",
    implied_by=rests,
    swept=("friction_force",),
)
def vanishes(engine: Engine, loads: Sequence[float] = LOADS) -> Measured:
    places, distance = resting_places(engine, loads)
    limit, error = vanishing_load(loads, places, distance[:, 0])
    return Measured(predicted=LIMIT, value=limit, error=error)


@STUDY.claim(
    "A pin rests in space below the friction force C·X0, and turns with the disc above it",
    equation="(5)",
    resolution=1e-3,
    note="Mean speed at which the pin turns about the axis in the last period of the disc, over ω. Starts at rest "
    "near the axis.",
    swept=("friction_force",),
)
def rest_or_turn(engine: Engine, shares: Sequence[float] = SHARES) -> Measured:
    x = min(formulas.sticking_radius(with_load(LIMIT * share)) for share in shares if share > 1.0) / 2.0
    speeds, errors = [], []
    for share in shares:
        end = SETTLING if share < 1.0 else 2.0 * REVOLUTION
        found = refined(functools.partial(_turning, engine, LIMIT * share, x, end), 1e-7)
        speed, *radii = found.value
        speeds.append(speed / PIN.disc_speed)
        left = 0.0
        if share < 1.0:  # all remaining motion decays with the envelope exp(−rt)
            decay = equilibrium_eigenvalues(with_load(LIMIT * share))[0].real
            left = float(np.exp(decay * SETTLING)) * PIN.offset / min(radii) / REVOLUTION
        errors.append((found.error[0] + left) / PIN.disc_speed)
    return Measured(
        predicted=[0.0 if share < 1.0 else 1.0 for share in shares],
        value=speeds,
        error=np.full(len(shares), max(errors)),
        at={"μN/(C·X0)": shares},
        note=f"The starts are {x:.2e} m away from it.",
    )


def _turning(engine: Engine, load: float, x: float, end: float, tolerance: float) -> FloatArray:
    """Return the mean speed about the axis (rad/s) in the period up to ``end`` (s), and distances from it (m)."""
    times = [0.0, *np.linspace(end - REVOLUTION, end, 17)]
    states = engine.simulate(with_load(load), (x, 0.0, 0.0, 0.0), times, tolerance=tolerance).states[1:]
    angles = np.unwrap(np.arctan2(states[:, 1], states[:, 0]))
    return np.array([(angles[-1] - angles[0]) / REVOLUTION, *np.hypot(*states[:, :2].T)])


@functools.lru_cache(maxsize=2)
def rates(engine: Engine, loads: Sequence[float]) -> Rates:
    pins = [with_load(load) for load in loads]
    motions = [(pin, (*equilibrium_position(pin), 0.0, 0.0)) for pin in pins]
    return measured_rates(engine, motions, map(equilibrium_eigenvalues, pins), duration=FLOW_DURATION)


@STUDY.claim(
    "Small deviations from the position of rest evolve with the eigenvalues of the linearised (1)",
    equation="(1)",
    unit="1/s",
    resolution=1e-6 * PIN.natural_frequency,
    note=f"Central differences of the motion over {FLOW_DURATION:g} s, extrapolated to zero. Numerical error: the "
    "change with larger differences, and at a smaller tolerance.",
    swept=("friction_force",),
)
def eigenvalues(engine: Engine, loads: Sequence[float] = LOADS) -> Measured:
    found = rates(engine, loads)
    return found.compared({"μN in N": loads}, data={"eigenvalue": real_and_imaginary(found.measured)})


@STUDY.claim(
    DECAYS,
    equation="(5)",
    note="Is the real part of each measured eigenvalue below zero?",
    friction=False,
    implied_by=eigenvalues,
    swept=("friction_force",),
)
def stable(engine: Engine, loads: Sequence[float] = LOADS) -> Measured:
    return rates(engine, loads).decaying()


@STUDY.claim(
    DECAYS,
    equation="(5)",
    note=f"Does each mode of the linearised (1) decay? Grid: μN/(C·X0) = {GRID_SHARES[0]:g} … "
    f"{GRID_SHARES[-1]:g}, ω = {GRID_SPEEDS[0]:g} … {GRID_SPEEDS[-1]:g} rad/s, β = {GRID_DAMPINGS[0]:g} … "
    f"{GRID_DAMPINGS[-1]:g} N s/m; rounding may leave one point in a thousand undecided. In closed form they "
    f"are the roots "
    "of mλ² + βλ + C and of mλ² + (β + μN/(ωρ*))λ + C, which all have negative real parts if β > 0.",
    swept=("friction_force", "disc_speed", "damping"),
)
def stable_on_a_grid() -> Measured:
    pins = [
        replace(PIN, friction_force=share * LIMIT, disc_speed=speed, damping=damping)
        for share, speed, damping in itertools.product(GRID_SHARES, GRID_SPEEDS, GRID_DAMPINGS)
    ]
    values, rounding = eigenvalues_with_rounding(
        [sliding_jacobian(pin, (*equilibrium_position(pin), 0.0, 0.0)) for pin in pins]
    )
    return answers_of(
        -values.real,
        rounding,
        may_be_open=values.size // 1000,
        source="assumption: a grid of friction forces, disc speeds and dampings",
    )


def draw(data: ByEngine) -> Figures:
    eigenvalues = {"fig03-eigenvalues": draw_eigenvalues(data)} if "theory" in data else {}
    return {"fig03-semicircle": draw_semicircle(data)} | eigenvalues


def draw_semicircle(data: ByEngine) -> Figure:
    figure, (plane, distance) = new_figure(ncols=2, width=9.6, height=3.9)
    if "theory" in data:
        plane.plot(*data["theory"]["position"].T, **curve("theory", "eq. (3)"))
    for engine in engines_in(data):
        found = data[engine]
        plane.plot(*found["position"].T, **points(engine))
        away = np.hypot(*(found["position"] - positions(found["load"])).T)
        floor = np.finfo(float).eps * PIN.offset
        distance.semilogy(found["load"], np.maximum(away, floor), **points(engine))
        budget = curve(engine, f"{engine}: error budget", linewidth=1.0, linestyle="--")
        distance.semilogy(found["load"], found["position_error"], **budget)
    _label(plane)
    if data:
        plane.legend(loc="center", bbox_to_anchor=(0.5, 0.42))
    distance.axhline(1e-9 * PIN.offset, color=GREY, linewidth=0.9, linestyle=":", label=r"$10^{-9}\,X_0$")
    distance.set(xlabel=axis(r"\mu N", "N"), title="Distance from (3)")
    distance.set(ylabel="distance in m", ylim=(1e-16, 1e-8))
    distance.legend(loc="upper left", ncols=2, fontsize=9.0)
    return figure


def _label(plane: Axes) -> None:
    X0 = PIN.offset
    small: dict[str, Any] = {"textcoords": "offset points", "fontsize": 9.5}
    plane.plot([0.0, X0], [0.0, 0.0], color="black", marker="+", linestyle="none", markersize=9.0)
    plane.annotate("axis of the disc", (0.0, 0.0), (2, -13), **small)
    plane.annotate("springs relaxed", (X0, 0.0), (-2, -13), ha="right", **small)
    for load in LOADS:
        x, y = equilibrium_position(with_load(load))
        outwards = np.array([x - X0 / 2.0, y]) / (X0 / 2.0)
        small["ha"] = "left" if outwards[0] > 0.3 else "right" if outwards[0] < -0.3 else "center"
        small["va"] = "bottom" if outwards[1] > 0.3 else "center"
        plane.annotate(f"{load:g}", (x, y), tuple(9.0 * outwards), **small)
    plane.set(xlabel=axis("x", "m"), ylabel=axis("y", "m"), aspect="equal")
    plane.set(xlim=(-0.018, 0.121), ylim=(-0.012, 0.066))
    plane.set(title=r"Positions of rest, labelled with $\mu N$ in N")


def draw_eigenvalues(data: ByEngine) -> Figure:
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


STUDY.provides(figures=draw, curves=curves)
