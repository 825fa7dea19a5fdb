"""Claims."""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from compare.claims.error_estimates import ROUNDING, Measurement, refined
from compare.claims.linearised_flow import rotated
from compare.claims.measured import Measured, answers_of, asked
from compare.claims.study import ByEngine, Data, Figures, Study
from compare.engines import Engine
from compare.output.figures import GREY, Axes, axis, curve, engines_in, new_figure, points
from compare.studies.pin.sticking_domain.theory import (
    BRACKET,
    CREEP,
    CREEP_AT_EDGE,
    DAMPINGS,
    FAST,
    INSIDE,
    LATEST,
    OUTSIDE,
    PIN,
    PRECISION,
    RESONANCE,
    REVOLUTIONS,
    SEARCH_TOLERANCE,
    SEARCHED,
    SOURCE,
    SPEEDS,
    TOLERANCE,
    curves,
    pin_at,
    predicted_turns,
    top,
    vertex,
)
from compare.studies.toolkit.pins import first_release, safest_angle, stuck
from reference_model.formulas.pin import release_time, resonant_disc_speed, sticking_radius
from reference_model.systems import FloatArray, PinOnDisc

STUDY = Study.beside(
    __file__,
    "sticking-domain",
    source=SOURCE,
    system=PIN,
    seconds=6.0,
)

LARGEST_AT = "The sticking domain is largest at the disc speed ω* = √(C/m − β²/2m²)"


@functools.lru_cache(maxsize=4)
def two_revolutions(
    engine: Engine, speeds: tuple[float, ...], tolerance: float
) -> tuple[FloatArray, list[bool]]:
    """Return the displacements on the disc of pins inside the radius (9), shape (n, 2), and which pins always stick.

    Displacements are relative to the distance from the axis.
    """
    pins = [pin_at(speed) for speed in speeds]
    radii = [INSIDE * sticking_radius(pin) for pin in pins]
    starts = [stuck(pin, radius, safest_angle(pin)) for pin, radius in zip(pins, radii, strict=True)]
    turn = REVOLUTIONS * 2.0 * math.pi
    runs = engine.simulate_many(
        [(pin, start, [0.0, turn / pin.disc_speed]) for pin, start in zip(pins, starts, strict=True)],
        tolerance=tolerance,
    )
    displacements, sticks = [], []
    for radius, start, run in zip(radii, starts, runs, strict=True):
        on_disc = rotated(run.at_end, -turn)
        displacements.append((on_disc - start)[:2] / radius)
        sticks.append(all(phase.kind != "slip" for phase in run.phases))
    return np.array(displacements), sticks


def displaced(engine: Engine, speeds: tuple[float, ...] = SPEEDS) -> Measurement:
    """Return the displacements of ``two_revolutions`` and their errors."""
    found = refined(lambda tolerance: two_revolutions(engine, speeds, tolerance)[0], TOLERANCE)
    # Zero displacements have no scale for rounding, so the rounding of a turn counts.
    return found.plus(ROUNDING)


def creeps(engine: Engine, speeds: tuple[float, ...] = SPEEDS, *, most: float = CREEP) -> bool:
    """Return whether stuck pins may creep by more than ``most``, which leaves conclusions about stick open."""
    return displaced(engine, speeds).largest > most


@STUDY.claim(
    "A pin stuck at 0.98 of the radius (9) is at the same position on the disc two revolutions later",
    equation="(9)",
    resolution=CREEP,
    note="Displacement on the disc over the distance from the axis; starts where the holding force is smallest. "
    "Error: the change at a smaller tolerance, which reveals the creep of a law that only approximates stick.",
    swept=("disc_speed",),
)
def stays(engine: Engine, speeds: tuple[float, ...] = SPEEDS) -> Measured:
    found = displaced(engine, speeds)
    return Measured(
        predicted=np.zeros_like(found.value),
        value=found.value,
        error=found.rows,
        size=1.0,
        at={"ω in rad/s": speeds},
        components=("x", "y"),
    )


@STUDY.claim(
    "A pin stuck at 0.98 of the radius (9) does not slip within two revolutions",
    equation="(8)",
    note="Is each of these motions without a slip phase?",
    swept=("disc_speed",),
)
def holds(engine: Engine, speeds: tuple[float, ...] = SPEEDS) -> Measured:
    margins, errors = asked(lambda tolerance: two_revolutions(engine, speeds, tolerance)[1], TOLERANCE)
    if np.any(margins < 0.0) and creeps(engine, speeds):
        errors = np.full_like(margins, np.inf)
    return answers_of(margins, errors)


@STUDY.claim(
    "A pin stuck at 1.02 and at 1.5 of the radius (9) is released at the time that (7) predicts",
    equation="(7)",
    unit="rad",
    resolution=1e-2,
    note="Turn of the disc until the end of the first stick phase, from a start where the holding force is smallest. "
    "Error: the change at a smaller tolerance.",
    swept=("disc_speed",),
)
def lets_go(engine: Engine, speeds: Sequence[float] = SPEEDS) -> Measured:

    def turns(tolerance: float) -> FloatArray:
        motions = []
        for pin in map(pin_at, speeds):
            for share in OUTSIDE:
                radius, angle = share * sticking_radius(pin), safest_angle(pin)
                end = LATEST * release_time(pin, radius, angle)
                motions.append((pin, stuck(pin, radius, angle), [0.0, end]))
        runs = engine.simulate_many(motions, tolerance=tolerance)
        found = [run.system.disc_speed * first_release(run) for run in runs]
        return np.array(found).reshape(len(speeds), len(OUTSIDE))

    found = refined(turns, TOLERANCE)
    return Measured(
        predicted=predicted_turns(speeds),
        value=found.value,
        error=_unless_missing(engine, found.value, found.rows),
        at={"ω in rad/s": speeds, "radius/(9)": OUTSIDE},
        data={"speed": speeds, "turn": found.value, "turn_error": found.rows},
    )


@functools.lru_cache(maxsize=2)
def largest_radii(engine: Engine, searched: Sequence[float]) -> Measurement:
    """Return the largest sticking radii in m at ``searched`` ω in rad/s, by bisection, shape (n,)."""
    pins = [pin_at(speed) for speed in searched]
    first = [_between(engine, pin, SEARCH_TOLERANCE, _anywhere(pin)) for pin in pins]

    def around(pin: PinOnDisc, near: tuple[float, float]) -> tuple[float, float]:
        """Return the bracket for another tolerance, which moves the radius only slightly."""
        return near if np.all(np.isfinite(near)) else _anywhere(pin)

    def radii(tolerance: float) -> FloatArray:
        found = first
        if tolerance != SEARCH_TOLERANCE:
            found = [
                _between(engine, pin, tolerance, around(pin, near))
                for pin, near in zip(pins, first, strict=True)
            ]
        return np.asarray(np.sqrt(np.prod(found, axis=1)))

    found = refined(radii, SEARCH_TOLERANCE)
    error = found.error + PRECISION * found.value / 2.0
    return Measurement(found.value, _unless_missing(engine, found.value, error))


def _unless_missing(engine: Engine, values: FloatArray, errors: FloatArray) -> FloatArray:
    """Return the errors of ``values``; a missing value is open if the engine creeps, and a mistake otherwise."""
    missing = ~np.isfinite(values)
    if not np.any(missing):
        return errors
    return np.where(
        missing,
        np.inf if creeps(engine, most=CREEP_AT_EDGE) else 0.0,
        np.where(np.isnan(errors), np.inf, errors),
    )


def _anywhere(pin: PinOnDisc) -> tuple[float, float]:
    return BRACKET[0] * pin.offset, BRACKET[1] * pin.offset


def _between(
    engine: Engine, pin: PinOnDisc, tolerance: float, around: tuple[float, float]
) -> tuple[float, float]:
    """Return radii in m that enclose the largest sticking radius, by bisection.

    The search begins between the radii ``around`` and extends beyond them if necessary. The result is NaN if the
    search fails.
    """
    # The holding force goes from its minimum to its maximum in half a revolution.
    end = 1.02 * math.pi / pin.disc_speed

    @functools.cache
    def sticks(radius: float) -> bool:
        start = stuck(pin, radius, safest_angle(pin))
        run = engine.simulate(pin, start, [0.0, end], tolerance=tolerance)
        return all(phase.kind == "stick" for phase in run.phases)

    (inside, outside), (least, most) = around, _anywhere(pin)
    ratio = outside / inside
    while not sticks(inside):
        inside, outside, ratio = inside / ratio, inside, ratio**2
        if inside < least:
            return math.nan, math.nan
    while sticks(outside):
        inside, outside, ratio = outside, outside * ratio, ratio**2
        if outside > most:
            return math.nan, math.nan
    while outside - inside > PRECISION * outside:
        middle = math.sqrt(inside * outside)
        if sticks(middle):
            inside = middle
        else:
            outside = middle
    return inside, outside


@STUDY.claim(
    "The largest radius at which a stuck pin does not slip is (9)",
    equation="(9)",
    resolution=1e-2,
    note=f"By bisection to {PRECISION:g} of the radius, with starts that pass the angle of the largest force. "
    "Relative to (9). Error: the error of the bisection, and the change at a smaller tolerance. Neither shows an "
    "error below 1e-3, because just outside the radius the slip grows from zero like the power 3/2 of the distance. "
    "Regularised friction hides it: Exudyn's radii have errors of 2e-4 to 6e-4 at tolerances from 1e-6 to 1e-8.",
    swept=("disc_speed",),
)
def largest(engine: Engine, searched: Sequence[float] = SEARCHED) -> Measured:
    found = largest_radii(engine, searched)
    predicted = np.array([sticking_radius(pin_at(speed)) for speed in searched])
    return Measured(
        predicted=np.ones(len(searched)),
        value=found.value / predicted,
        error=found.error / predicted,
        at={"ω in rad/s": searched},
        data={"searched": searched, "radius": found.value, "radius_error": found.error},
    )


@STUDY.claim(
    LARGEST_AT,
    equation="(9)",
    unit="rad/s",
    resolution=1e-3 * RESONANCE,
    note="Vertex of the parabola for 1/A² in ω² through the first three radii; by (9), 1/A² is such a parabola.",
    implied_by=largest,
    swept=("disc_speed",),
)
def resonance(engine: Engine, searched: Sequence[float] = SEARCHED) -> Measured:
    radii, error = (each[:3] for each in largest_radii(engine, searched))
    relative = np.where(np.isfinite(radii), error / radii, error)
    found, error_of_vertex = vertex(np.array(searched[:3]) ** 2, 1.0 / radii**2, relative)
    return Measured(predicted=RESONANCE, value=found, error=error_of_vertex)


@STUDY.claim(
    LARGEST_AT,
    equation="(9)",
    unit="rad/s",
    resolution=1e-3 * RESONANCE,
    note="Maximum of the right side of (9), by differences.",
    swept=("disc_speed", "damping"),
)
def resonance_of_9() -> Measured:
    found, errors, expected = [], [], []
    for damping in DAMPINGS:
        pin = replace(PIN, damping=damping)
        expected.append(resonant_disc_speed(pin))
        # The logarithm of the radius is a parabola near its maximum; halving the width gives the error of the vertex.
        wide, narrow = (top(pin, expected[-1], width) for width in (2e-3, 1e-3))
        found.append(narrow)
        errors.append(abs(wide - narrow) + np.finfo(float).eps / (1e-3 * damping) ** 2)
    return Measured(
        predicted=expected,
        value=found,
        error=errors,
        at={"β in N s/m": DAMPINGS},
        source=f"Fig. 4; β = {DAMPINGS[0]:g} … {DAMPINGS[-1]:g} N s/m is our choice",
    )


@STUDY.claim(
    "For large ω, the sticking domain shrinks like 1/ω²",
    equation="(9)",
    resolution=0.05,
    note="Right side of (9) over (μN − C·X0)/(mω²). Model error: twice the first omitted term, (ω*/ω)² at the "
    "smallest ω.",
    swept=("disc_speed",),
)
def shrinks() -> Measured:
    speeds = np.array(FAST)
    radii = np.array([sticking_radius(pin_at(speed)) for speed in FAST])
    return Measured(
        predicted=np.ones(len(FAST)),
        value=PIN.mass * speeds**2 * radii / (PIN.friction_force - PIN.stiffness * PIN.offset),
        error=4.0 * np.finfo(float).eps,
        model=2.0 * (RESONANCE / FAST[0]) ** 2,
        at={"ω in rad/s": FAST},
        source="Fig. 4; the values of ω are our choice",
    )


# --- Figure


def draw(data: ByEngine) -> Figures:
    figure, (domain, time, error) = new_figure(ncols=3, width=12.6, height=3.7)
    if "theory" in data:
        domain.semilogy(data["theory"]["speed"], data["theory"]["radius"], **curve("theory", "eq. (9)"))
        _draw_release(time, data["theory"])
    for engine in engines_in(data):
        found = data[engine]
        speed = found["speed"]
        domain.semilogy(found["searched"], found["radius"], **points(engine, f"{engine}: bisection"))
        away = np.abs(found["turn"] - predicted_turns(speed))
        for i in range(len(OUTSIDE)):
            label = engine if i == 0 else "_"
            time.semilogy(speed, found["turn"][:, i] / speed, **points(engine, label))
            error.plot(speed, away[:, i], **points(engine, label))
        budget = curve(engine, f"{engine}: error budget", linewidth=1.0, linestyle="--")
        error.plot(speed, found["turn_error"][:, 0], **budget)
    domain.axvline(RESONANCE, color=GREY, linestyle=":", linewidth=1.0, label=r"$\omega_*$")
    domain.set(
        xlabel=axis(r"\omega", "rad/s"), ylabel=axis("A", "m"), title="Largest radius of permanent stick"
    )
    domain.legend()
    time.set(xlabel=axis(r"\omega", "rad/s"), ylabel=axis("t_r", "s"), title="Time until release")
    error.set_yscale("symlog", linthresh=1e-16)
    error.set_yticks([0.0, *10.0 ** np.arange(-16.0, 1.0, 4.0)])
    error.set(
        xlabel=axis(r"\omega", "rad/s"),
        ylabel=axis(r"|\Delta(\omega\,t_r)|", "rad"),
        ylim=(-5e-17, 1.0),
        title="Deviation of the turn until release from (7)",
    )
    for panel, place in ((time, (0.62, 0.7)), (error, (0.2, 0.24))):
        handles, labels = panel.get_legend_handles_labels()
        if handles:
            panel.legend(handles, labels, loc=place)
    return {"sticking-domain": figure}


def _draw_release(panel: Axes, theory: Data) -> None:
    speed = theory["speed"]
    middle = int(np.argmin(np.abs(speed - 1.75)))
    for i, share in enumerate(OUTSIDE):
        release = theory["turn"][:, i] / speed
        panel.semilogy(speed, release, **curve("theory", "eq. (7)" if i == 0 else "_"))
        panel.annotate(
            rf"start at {share:g} $A$",
            (speed[middle], release[middle]),
            (2, 8) if i == 0 else (-4, -8),
            textcoords="offset points",
            ha="left" if i == 0 else "right",
            va="bottom" if i == 0 else "top",
            fontsize=9.5,
        )


STUDY.provides(figures=draw, curves=curves)
