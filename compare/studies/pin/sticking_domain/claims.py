"""Eq. 6 to 9: where the pin sticks to the disc for ever, when it lets go elsewhere, and the resonance of both."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from compare.claims.answers import asked, holds
from compare.claims.claim import Claim, ErrorBudget
from compare.claims.error_estimates import refined
from compare.claims.linearised_flow import rotated
from compare.claims.paper_parameters import FIG4
from compare.claims.parameters import at_each, parameters_of
from compare.claims.study import Data, Findings, Study
from compare.engines import Engine
from compare.figures import GREY, axis, curve, engines_in, new_figure, points
from compare.studies.toolkit.sticking import first_release, safest_angle, stuck
from reference_model.formulas.pin import (
    release_time,
    resonant_disc_speed,
    sticking_radius,
    turn_until_release,
)
from reference_model.systems import FloatArray, PinOnDisc

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PIN = FIG4
SOURCE = "Fig. 4, whose load is above C·X0; the values of ω are ours"
RESONANCE = resonant_disc_speed(PIN)

SPEEDS = (0.4, 0.7, RESONANCE, 1.4, 2.5)
"""ω in rad/s of the starts inside and outside of the radius (9)."""

INSIDE = 0.98
OUTSIDE = (1.02, 1.5)
"""Radii of the starts, in units of (9)."""

LATEST = 1.1
"""How long a pin outside is watched, in units of the time that (7) predicts."""

REVOLUTIONS = 2.0
"""For which a pin inside is watched: what it must be held with has the period of a revolution."""

SEARCHED = (0.9, 1.0, 1.1, 0.4, 2.0)
"""ω in rad/s at which the largest sticking radius is searched; the first three are about the resonance."""

BRACKET = (0.03, 4.0)
"""Where the search begins, in units of X0: without regard to (9), so that it can't lead to it."""

PRECISION = 3e-5
"""Relative, of that search."""

SEARCH_TOLERANCE = 1e-7

TOLERANCE = 3e-8
"""Moderate, since a regularised law costs the more in stick the closer it comes to Coulomb's."""

STAYS = "A pin stuck at 0.98 of the radius (9) is at the same place of the disc two revolutions later"
HOLDS = "A pin stuck at 0.98 of the radius (9) does not slip within two revolutions"
LETS_GO = "A pin stuck at 1.02 and at 1.5 of the radius (9) is let go at the time that (7) predicts"
LARGEST = "The largest radius at which a stuck pin does not slip is (9)"
RESONANT = "The sticking domain is largest at the disc speed ω* = √(C/m − β²/2m²)"
SHRINKS = "For large ω the sticking domain shrinks like 1/ω²"


def pin_at(speed: float) -> PinOnDisc:
    """Return the pin of this study at another disc speed in rad/s."""
    return replace(PIN, disc_speed=speed)


def measure(
    engine: Engine, speeds: Sequence[float] = SPEEDS, searched: Sequence[float] = SEARCHED
) -> Findings:
    """Measure all statements with ``engine``; ``speeds`` and ``searched`` are ω in rad/s.

    ``searched`` are those at which the largest sticking radius is found, at least three.
    """
    turn, turn_error, release_claim = releases(engine, speeds)
    radii, radius_error, radius_claims = largest_radii(engine, searched)
    return Findings(
        (*inside_claims(engine, speeds), release_claim, *radius_claims),
        {
            "speed": np.array(speeds),
            "turn": turn,
            "turn_error": turn_error,
            "searched": np.array(searched),
            "radius": radii,
            "radius_error": radius_error,
        },
    )


def inside_claims(engine: Engine, speeds: Sequence[float]) -> tuple[Claim, Claim]:
    """Return where pins that start inside of the radius (9) are in the end, and how often they slipped."""
    slides: dict[float, list[bool]] = {}

    def displacement(tolerance: float) -> FloatArray:
        found = []
        slides[tolerance] = []
        for speed in speeds:
            pin = pin_at(speed)
            radius = INSIDE * sticking_radius(pin)
            start = stuck(pin, radius, safest_angle(pin))
            end = REVOLUTIONS * 2.0 * math.pi / speed
            run = engine.simulate(pin, start, [0.0, end], tolerance=tolerance)
            slides[tolerance].append(any(phase.kind == "slip" for phase in run.phases))
            on_disc = rotated(run.at_end, -REVOLUTIONS * 2.0 * math.pi)
            found.append((on_disc - start)[:2] / radius)
        return np.array(found)

    measured, error = refined(displacement, TOLERANCE)
    # Displacements of zero have no scale of their own for rounding: that of a turn is theirs.
    error = error + 64.0 * np.finfo(float).eps
    where = f"for {at_each('ω', speeds)} rad/s"
    return (
        Claim(
            STAYS,
            equation="(9)",
            engine=engine.name,
            predicted=np.zeros_like(measured),
            measured=measured,
            budget=ErrorBudget(np.repeat(np.max(error, axis=1, keepdims=True), 2, axis=1), resolution=1e-2),
            parameters=parameters_of(PIN, without=("disc_speed",)),
            source=SOURCE,
            note="Displacement on the disc over the distance from the axis, in x and y; starts where the least "
            f"force holds the pin, {where}. Error: the change at a smaller tolerance, by which a law that only "
            "approximates stick shows its creep.",
        ),
        Claim(
            HOLDS,
            equation="(8)",
            engine=engine.name,
            **holds(*asked(lambda tolerance: np.logical_not(slides[tolerance]), TOLERANCE)),
            parameters=parameters_of(PIN, without=("disc_speed",)),
            source=SOURCE,
            note=f"Whether each of these motions has no slip phase, {where}.",
        ),
    )


def releases(engine: Engine, speeds: Sequence[float]) -> tuple[FloatArray, FloatArray, Claim]:
    """Return by how much the disc turns until it lets go pins outside of the radius (9), its error, and the claim.

    Turns and errors are in rad, of shape (n, 2).
    """

    def turns(tolerance: float) -> FloatArray:
        found = []
        for speed in speeds:
            pin = pin_at(speed)
            for share in OUTSIDE:
                radius, angle = share * sticking_radius(pin), safest_angle(pin)
                end = LATEST * release_time(pin, radius, angle)
                run = engine.simulate(pin, stuck(pin, radius, angle), [0.0, end], tolerance=tolerance)
                found.append(speed * first_release(run))
        return np.array(found).reshape(len(speeds), len(OUTSIDE))

    measured, error = refined(turns, TOLERANCE)
    error = np.broadcast_to(np.max(error, axis=1, keepdims=True), measured.shape)
    claim = Claim(
        LETS_GO,
        equation="(7)",
        engine=engine.name,
        predicted=predicted_turns(speeds),
        measured=measured,
        budget=ErrorBudget(np.where(np.isfinite(error), error, 0.0), resolution=1e-2),
        parameters=parameters_of(PIN, without=("disc_speed",)),
        source=SOURCE,
        unit="rad",
        note="Turn of the disc up to the end of the first stick phase, after a start where the least force holds "
        f"the pin, for {at_each('ω', speeds)} rad/s. Error: the change at a smaller tolerance.",
    )
    return measured, error, claim


def predicted_turns(speeds: ArrayLike) -> FloatArray:
    """Return the turns in rad that (7) predicts, shape (n, 2), for ``speeds`` in rad/s, shape (n,)."""
    return np.array(
        [
            [turn_until_release(pin, share * sticking_radius(pin), safest_angle(pin)) for share in OUTSIDE]
            for pin in map(pin_at, np.asarray(speeds, dtype=float).tolist())
        ]
    )


def largest_radii(
    engine: Engine, searched: Sequence[float]
) -> tuple[FloatArray, FloatArray, tuple[Claim, Claim]]:
    """Return the largest sticking radii in m found by bisection, their error, and the claims on them."""

    def sticks(pin: PinOnDisc, radius: float, tolerance: float) -> bool:
        # From where the least force holds the pin to where the greatest has to is half a revolution.
        end = 1.02 * math.pi / pin.disc_speed
        start = stuck(pin, radius, safest_angle(pin))
        run = engine.simulate(pin, start, [0.0, end], tolerance=tolerance)
        return all(phase.kind == "stick" for phase in run.phases)

    def radius_at(pin: PinOnDisc, tolerance: float) -> float:
        inside, outside = (share * pin.offset for share in BRACKET)
        if not sticks(pin, inside, tolerance) or sticks(pin, outside, tolerance):
            return math.nan
        while outside - inside > PRECISION * outside:
            middle = math.sqrt(inside * outside)
            if sticks(pin, middle, tolerance):
                inside = middle
            else:
                outside = middle
        return math.sqrt(inside * outside)

    def radii_at(tolerance: float) -> FloatArray:
        return np.array([radius_at(pin_at(speed), tolerance) for speed in searched])

    radii, error = refined(radii_at, SEARCH_TOLERANCE)
    error = np.where(
        np.isfinite(error), error + PRECISION * radii / 2.0, 0.0
    )  # a radius not found is NaN itself
    predicted = np.array([sticking_radius(pin_at(speed)) for speed in searched])
    how = (
        f"By bisection to {PRECISION:g} of the radius over starts that pass the angle of the greatest force, "
        f"for {at_each('ω', searched)} rad/s."
    )
    resonance, resonance_error = vertex(
        np.array(searched[:3]) ** 2, 1.0 / radii[:3] ** 2, error[:3] / radii[:3]
    )
    claims = (
        Claim(
            LARGEST,
            equation="(9)",
            engine=engine.name,
            predicted=np.ones(len(searched)),
            measured=radii / predicted,
            budget=ErrorBudget(error / predicted, resolution=1e-2),
            parameters=parameters_of(PIN, without=("disc_speed",)),
            source=SOURCE,
            note=how
            + " In units of (9). Error: that of the bisection, and the change at a smaller tolerance.",
        ),
        Claim(
            RESONANT,
            equation="(9)",
            engine=engine.name,
            predicted=RESONANCE,
            measured=resonance,
            budget=ErrorBudget(resonance_error, resolution=1e-3 * RESONANCE),
            parameters=parameters_of(PIN, without=("disc_speed",)),
            source=SOURCE,
            unit="rad/s",
            note="Where 1/A² is smallest on the parabola in ω² through the first three radii: by (9) it is one.",
            implied_by=LARGEST,
        ),
    )
    return radii, error, claims


def vertex(s: FloatArray, values: FloatArray, relative_error: FloatArray) -> tuple[float, float]:
    """Return √ of the vertex of the parabola through three points 1/A² over s = ω², and its error.

    ``relative_error`` is that of the radii A.
    """

    def found(values: FloatArray) -> float:
        square, linear, _ = np.polyfit(s, values, 2)
        return math.sqrt(max(-linear / (2.0 * square), 0.0))

    if not np.all(np.isfinite(values)):
        return math.nan, 0.0
    middle = found(values)
    shifts = [
        abs(found(values * (1.0 + 2.0 * relative_error * (np.arange(3) == i))) - middle) for i in range(3)
    ]
    return middle, sum(shifts)


def theory() -> Findings:
    """Check where the radius (9) is largest and how it shrinks, and compute the curves of the formulas."""
    dampings = np.geomspace(0.01, 1.3, 15)
    found, errors, expected = [], [], []
    for damping in dampings:
        pin = replace(PIN, damping=damping)
        expected.append(resonant_disc_speed(pin))
        # The logarithm of the radius is a parabola at its top: its vertex, and the error of that by halving.
        wide, narrow = (top(pin, expected[-1], width) for width in (2e-3, 1e-3))
        found.append(narrow)
        errors.append(abs(wide - narrow) + np.finfo(float).eps / (1e-3 * damping) ** 2)
    speeds = np.array([10.0, 30.0, 100.0])
    shrunk = [
        pin_at(speed).mass
        * speed**2
        * sticking_radius(pin_at(speed))
        / (PIN.friction_force - PIN.stiffness * PIN.offset)
        for speed in speeds
    ]
    claims = (
        Claim(
            RESONANT,
            equation="(9)",
            engine="theory",
            predicted=expected,
            measured=found,
            budget=ErrorBudget(errors, resolution=1e-3 * RESONANCE),
            parameters=parameters_of(PIN, without=("disc_speed", "damping")),
            source=f"Fig. 4; β = {dampings[0]:g} … {dampings[-1]:g} N s/m is ours",
            unit="rad/s",
            note="Where the right side of (9) is largest, by differences.",
        ),
        Claim(
            SHRINKS,
            equation="(9)",
            engine="theory",
            predicted=np.ones(len(speeds)),
            measured=shrunk,
            budget=ErrorBudget(
                4.0 * np.finfo(float).eps, model=2.0 * (RESONANCE / float(speeds[0])) ** 2, resolution=0.05
            ),
            parameters=parameters_of(PIN, without=("disc_speed",)),
            source="Fig. 4; the values of ω are ours",
            note=f"Right side of (9) over (μN − C·X0)/(mω²), for {at_each('ω', speeds)} rad/s. Model error: twice "
            "the first term that is left out, (ω*/ω)² at the smallest ω.",
        ),
    )
    curve_speeds = np.unique(
        np.concatenate((np.linspace(0.15, 2.6, 200), RESONANCE + np.linspace(-0.2, 0.2, 81)))
    )
    pins = [pin_at(speed) for speed in curve_speeds]
    return Findings(
        claims,
        {
            "speed": curve_speeds,
            "radius": np.array([sticking_radius(pin) for pin in pins]),
            "turn": predicted_turns(curve_speeds),
        },
    )


def top(pin: PinOnDisc, speed: float, width: float) -> float:
    """Return ω in rad/s at the vertex of the parabola through the radius (9) at three speeds around ``speed``."""
    step = width * speed
    # Beside the middle, so that the answer is not put in.
    nodes = speed + step * np.array([-0.6, 0.4, 1.4])
    low, middle, high = (sticking_radius(replace(pin, disc_speed=node)) for node in nodes)
    return float(nodes[1] + 0.5 * step * (low - high) / (low - 2.0 * middle + high))


def draw(data: Mapping[str, Data]) -> dict[str, Figure]:
    """Draw the radius over the speed of the disc, the time until release, and how far it is from (7)."""
    figure, (domain, time, error) = new_figure(ncols=3, width=12.6, height=3.7)
    if "theory" in data:
        theory = data["theory"]
        speed = theory["speed"]
        domain.semilogy(speed, theory["radius"], **curve("theory", "eq. (9)"))
        for i, share in enumerate(OUTSIDE):
            release = theory["turn"][:, i] / speed
            time.semilogy(speed, release, **curve("theory", "eq. (7)" if i == 0 else "_"))
            middle = int(np.argmin(np.abs(speed - 1.75)))
            time.annotate(
                rf"start at {share:g} $A$",
                (speed[middle], release[middle]),
                (2, 8) if i == 0 else (-4, -8),
                textcoords="offset points",
                ha="left" if i == 0 else "right",
                va="bottom" if i == 0 else "top",
                fontsize=9.5,
            )
    for engine in engines_in(data):
        found = data[engine]
        speed = found["speed"]
        domain.semilogy(found["searched"], found["radius"], **points(engine, f"{engine}: bisection"))
        away = np.maximum(np.abs(found["turn"] - predicted_turns(speed)), 1e-16)
        for i in range(len(OUTSIDE)):
            label = engine if i == 0 else "_"
            time.semilogy(speed, found["turn"][:, i] / speed, **points(engine, label))
            error.semilogy(speed, away[:, i], **points(engine, label))
        budget = curve(engine, f"{engine}: error budget", linewidth=1.0, linestyle="--")
        error.semilogy(speed, found["turn_error"][:, 0], **budget)
    domain.axvline(RESONANCE, color=GREY, linestyle=":", linewidth=1.0, label=r"$\omega_*$")
    domain.set(xlabel=axis(r"\omega", "rad/s"), ylabel=axis("A", "m"), title="Largest radius of sticking")
    domain.legend()
    time.set(xlabel=axis(r"\omega", "rad/s"), ylabel=axis("t_r", "s"), title="Time until release")
    error.set(
        xlabel=axis(r"\omega", "rad/s"),
        ylabel=axis(r"|\Delta(\omega\,t_r)|", "rad"),
        ylim=(2e-17, 1.0),
        title="Distance of the turn until release from (7)",
    )
    for panel, place in ((time, (0.62, 0.7)), (error, (0.2, 0.24))):
        handles, labels = panel.get_legend_handles_labels()
        if handles:
            panel.legend(handles, labels, loc=place)
    return {"sticking-domain": figure}


STUDY = Study(
    name="sticking-domain",
    title="Sticking to the disc, and its resonance",
    section="The friction pin",
    paper=(
        "If the load is above C·X0 the pin can stick to the disc and turn with it. The force that holds it "
        "changes with the angle (7); it stays below μN for every angle if the pin is nearer to the axis than the "
        "radius (9). This sticking domain has a resonance: it is largest at ω* = √(C/m − β²/2m²) and becomes "
        "arbitrarily small for large ω."
    ),
    by_hand=measure,
    theory=theory,
    draw=draw,
    figures={
        "sticking-domain": (
            "Left: the largest radius at which the pin sticks for ever, by (9) and found by trying. Middle: "
            "when a pin that starts further out, where the least force holds it, is let go, by (7) and "
            "simulated. Right: how far the turn of the disc until then is from (7), with the error budget."
        ),
    },
    seconds=2.0,
    quick=True,
)
