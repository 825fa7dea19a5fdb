"""A row of the matrix: results for one engine, and sentences that explain them."""

from __future__ import annotations

import functools
import itertools
import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

import numpy as np

from compare.claims.as_json import as_json
from compare.diagnosis.findings import MOTIONS, RUNGS, Creep, History, Lag, Moments, Motion, Repeat, Support
from compare.diagnosis.laws import CONE, DISTINCT, ELLIPSE, NEAR, NOTHING, Friction
from compare.diagnosis.probes import HEADINGS, SPEED, SUPPORTS
from compare.diagnosis.scaling import UNITS, VARIABLES, Scales, blind, deviation, speed_limit
from compare.output.figures import Figure, new_figure, paper_style, saved
from compare.output.text_files import replacing, write_text
from compare.report.numbers import error_text

LEAST_DEVIATION = 1e-7
"""Smallest reported relative deviation of a force or its direction."""

FALLS = 0.3
"""Order in the step above which a quantity counts as decreasing with it."""

RESTS = 1e-9
"""Ratio of speed to sliding speed below which a block is at rest."""

LEAST_LAG = 1e-6
"""Smallest reported lag in s, if the force is equally accurate: the slip rotates at about 1 rad/s in the probe."""

STEPS = (0.2, 3.0)
"""Range of lags, in steps, that are reported in steps."""


LEAST_SHARE = 1e-6
"""Smallest reported relative deviation of a distance, or of force and moment on a disc."""

ALIKE = 0.1
"""Largest spread of the forces of the support that a wrong mass explains, and deviation of a force that another
explains, relative to the larger deviation."""

SAME_DELAY = 0.2
"""Largest relative difference of the delays of two late releases."""

CHATTERS = 3.0
"""Least ratio of the velocity of a block that chatters to its creep."""

RIGHT, WRONG, UNDECIDED = "right", "wrong", "undecided"
"""Verdicts over everything that was measured."""

FRICTION_LAW, MOTION, MASS = "Not Coulomb friction", "Wrong motion", "Wrong mass"
"""Beginnings of the verdict of a wrong engine."""


class Remark(NamedTuple):
    """A finding: its sentence, True if it refutes the engine (None: undecided), and the beginning of the verdict."""

    text: str
    wrong: bool | None
    about: str = ""


@dataclass(frozen=True)
class Row:
    """Results for an engine.

    Parameters
    ----------
    engine, version : str
        Name and version of the engine.
    step : float
        Step in s at the finest rung; NaN if the engine has a tolerance.
    law, scales, creep, history, support, repeat, lag, moments
        Results of the probes; None if not measured.
    motions : mapping
        Errors of the simulated motions, by name.
    gaps : mapping
        Reason why a part has no result, by name.
    not_simulated : tuple of str
        Parts that the engine does not support.
    seconds : float
        Total wall-clock time in s.

    """

    engine: str
    version: str = ""
    step: float = math.nan
    law: Friction | None = None
    scales: Scales | None = None
    creep: Creep | None = None
    history: History | None = None
    support: Support | None = None
    repeat: Repeat | None = None
    lag: Lag | None = None
    moments: Moments | None = None
    motions: dict[str, Motion] = field(default_factory=dict)
    gaps: dict[str, str] = field(default_factory=dict)
    not_simulated: tuple[str, ...] = ()
    seconds: float = 0.0

    @functools.cached_property
    def remarks(self) -> tuple[Remark, ...]:
        """Findings about friction, the support and the motions, the cause of others first."""
        law, found = self.law, [*_of_repeat(self.repeat)]
        if self.scales is not None and (text := speed_limit(self.scales)):
            found.append(Remark(f"{_sentence(text)}.", True, MOTION))
        elif self.support is not None:
            found += _of_support(self.support)
        support_right = not any(remark.wrong for remark in found)
        if law is not None and not any(remark.about == MASS for remark in found):
            found += _of_law(law, self.scales, support_right, self._refined)
        if law is None or law.coulomb:
            explained = any(remark.wrong for remark in found)
            if self.creep is not None and not (self.scales is not None and blind(self.scales)):
                found += _of_creep(self.creep, self._refined)
            if self.history is not None and support_right:
                found += _of_history(self.history, explained or any(remark.wrong for remark in found))
            if self.lag is not None and not explained:
                found += _of_lag(self.lag, self.step, self._least_lag)
            if self.moments is not None and support_right:
                found += _of_moments(self.moments, law)
        found += _of_motions(self.motions, self._refined)
        for reason, names in self._gaps_by_reason.items():
            found.append(Remark(f"No result for {', '.join(names)}: {reason}.", None))
        if self.repeat is not None and self.repeat.deaf and any(remark.wrong for remark in found):
            deaf = Remark(
                f"Results do not change with the {self._refined}, so an error of the integration cannot be "
                "distinguished from another law.",
                True,
                MOTION,
            )
            found.insert(0 if law is None or law.coulomb else len(found), deaf)
        said = {
            remark.text.partition(" with ε")[0]: remark for remark in reversed(found)
        }  # regularised by two probes
        return tuple(remark for remark in found if remark in said.values())

    @property
    def sentences(self) -> tuple[str, ...]:
        """Diagnosis in a few sentences: the verdict over everything, then the other findings."""
        decisive = True if self.verdict == WRONG else None
        first = next((remark for remark in self.remarks if remark.wrong is decisive), None)
        said = [remark.text for remark in self.remarks if remark is not first]
        if first is not None:
            said.insert(0, f"{first.about or 'Undecided'}: {first.text[0].lower()}{first.text[1:]}")
        elif self.law is not None:
            said.insert(0, f"Coulomb friction, accurate to {error_text(self.law.error)} times the limit μN.")
        if self.scales is not None:
            said.append(f"Examined: {self.scales.looked_at}; {len(HEADINGS)} headings.")
        return tuple(said)

    @property
    def verdict(self) -> str:
        """``RIGHT``, ``WRONG`` or ``UNDECIDED``."""
        if any(remark.wrong for remark in self.remarks):
            return WRONG
        return UNDECIDED if any(remark.wrong is None for remark in self.remarks) else RIGHT

    @property
    def _gaps_by_reason(self) -> dict[str, list[str]]:
        found: dict[str, list[str]] = {}
        for name, reason in self.gaps.items():
            found.setdefault(reason, []).append(name)
        return found

    @property
    def _refined(self) -> str:
        """Quantity that decreases from rung to rung: "tolerance" or "step"."""
        return "tolerance" if math.isnan(self.step) else "step"

    @property
    def _least_lag(self) -> float:
        """Smallest reported lag in s."""
        return max(LEAST_LAG, DISTINCT * self.law.error) if self.law is not None else math.inf

    @property
    def empty(self) -> bool:
        """True if nothing was measured and nothing failed."""
        return not (self.law or self.creep or self.lag or self.motions or self.gaps)

    @property
    def wrong(self) -> bool:
        """True if a deviation was found that persists at smaller steps."""
        return self.verdict == WRONG


def _of_law(law: Friction, scales: Scales | None, support_right: bool, refined: str) -> Iterator[Remark]:
    """Yield how friction differs from Coulomb's, over wide ranges and for one block."""
    if scales is not None and (text := blind(scales)):
        yield Remark(f"{_sentence(text)}.", True, FRICTION_LAW)
    elif law.shape == NOTHING:
        yield Remark("There is no friction.", True, FRICTION_LAW)
    elif not math.isnan(law.per_step):
        shape = f" Its shape is a {law.shape}." if law.shape != CONE else ""
        yield Remark(
            f"Friction is limited by an impulse per step, {error_text(law.per_step)} s times the limit μN "
            "at any step."
            f"{shape}",
            True,
            FRICTION_LAW,
        )
    elif not law.sure and law.fits:
        yield Remark(
            f"The friction law could not be identified: the error of the forces is {error_text(law.error)} times "
            "the limit μN.",
            None,
        )
    elif not law.sure:
        yield Remark(
            f"No known friction law fits: the best fit, a {law.shape}, "
            f"deviates by {error_text(law.misfit)} times the limit μN.",
            True,
            FRICTION_LAW,
        )
    else:
        small = abs(law.force(np.ones(1, dtype=complex))[0] + 1.0) < NEAR  # a wrong support may explain it
        other = deviation(scales, law) if scales is not None else None
        cause, explained = _cause(law), other is not None and other.explained
        if other is not None and (explained or (support_right and not cause)):
            how = f", decreasing with the {refined}" if other.falls else ""
            yield Remark(f"{_sentence(other.text)}{how}.", not other.falls, FRICTION_LAW)
        if cause and (law.shape != CONE or not (explained or (small and not support_right))):
            yield Remark(cause, True, FRICTION_LAW)


def _sentence(text: str) -> str:
    return f"{text[0].upper()}{text[1:]}"


def _cause(law: Friction) -> str:
    """Return the sentence on how a law differs from Coulomb's, or ""."""
    deviations = _deviations(law)
    if law.shape == ELLIPSE:
        return (
            f"Friction is an ellipse: the coefficient μ is {law.along:.4g} times its value along "
            f"{math.degrees(law.axis):.1f}° and {law.across:.4g} times across."
        )
    if law.shape != CONE or not law.fits:
        further = (
            "" if law.fits else f", with a further difference of {error_text(law.misfit)} times the limit μN"
        )
        name = "Coulomb's cone" if law.shape == CONE else f"a {law.shape}"
        return f"Friction is {name}{''.join(f', but {one}' for one in deviations)}{further}."
    return f"{_sentence(' and '.join(deviations))}." if deviations else ""


def _deviations(law: Friction) -> list[str]:
    """Return descriptions of the deviations of a force from its own law."""
    found = []
    least = max(DISTINCT * law.error, LEAST_DEVIATION, law.misfit)
    if abs(law.strength - 1.0) > least:
        size = f"{error_text(law.strength)} times as large as it should be"
        if 0.5 < law.strength < 2.0:
            word = "large" if law.strength > 1.0 else "small"
            size = f"{error_text(100.0 * abs(law.strength - 1.0))} % too {word}"
        found.append(f"the coefficient μ is {size} (±{error_text(100.0 * law.error)} %)")
    if abs(law.angle) > least:
        found.append(
            f"the friction force is rotated by {error_text(math.degrees(law.angle))}° "
            f"(±{error_text(math.degrees(law.error))}°)"
        )
    return found


def _of_creep(creep: Creep, refined: str) -> Iterator[Remark]:
    if creep.chatter > max(RESTS * SPEED, CHATTERS * abs(creep.speed)):
        falls = creep.chatter_order > FALLS
        how = f"decreasing with the {refined}" if falls else f"independent of the {refined}"
        yield Remark(
            "Friction chatters: a block that should rest moves to and fro at "
            f"{error_text(creep.chatter)} m/s, {how}.",
            not falls,
            FRICTION_LAW,
        )
        return
    if abs(creep.speed) < RESTS * SPEED:
        yield Remark("A block loaded below μN stays at rest.", False)
        return
    falls = creep.order > FALLS
    how = f"decreasing with the {refined}" if falls else f"independent of the {refined}"
    speed = f"at {error_text(abs(creep.speed))} m/s under half of the limit μN"
    if creep.smoothing:
        text = (
            f"Friction is regularised as {creep.smoothing} with ε = {error_text(creep.epsilon)} m/s, {how}: "
            f"a block that should rest creeps {speed}."
        )
    else:
        text = f"A block that should rest creeps {speed}, {how}."
    yield Remark(text, not falls, FRICTION_LAW)


def _of_history(history: History, explained: bool) -> Iterator[Remark]:
    """Yield how friction depends on the motion before; ``explained`` if another finding may be the reason."""
    if history.static > 1.0:
        if explained:
            return
        yield Remark(
            f"Static friction is {error_text(100.0 * (history.static - 1.0))} % above sliding friction.",
            True,
            FRICTION_LAW,
        )
        return
    once, twice = history.delay, history.second_delay
    allowed = 2.0 * history.delay_error + history.second_delay_error + SAME_DELAY * once
    if not explained and once > max(history.delay_error, LEAST_LAG) and abs(twice - 2.0 * once) < allowed:
        yield Remark(f"A block is released {error_text(1e3 * history.delay)} ms late.", True, FRICTION_LAW)
    elif not explained and abs(history.second - 1.0) > max(DISTINCT * history.second_error, LEAST_SHARE):
        yield Remark(
            f"After a second release, a block moves {error_text(history.second)} times as far as it should.",
            True,
            FRICTION_LAW,
        )
    if not explained and history.rest > RESTS * SPEED:
        yield Remark(
            f"A block that came to rest from a slide, or is close to its release, creeps at "
            f"{error_text(history.rest)} m/s.",
            True,
            FRICTION_LAW,
        )


def _of_support(support: Support) -> list[Remark]:
    """Return the forces of the support that are wrong; an equal factor of all is that of the mass."""
    off = np.abs(support.shares - 1.0) > np.maximum(DISTINCT * support.errors, LEAST_SHARE)
    farthest = float(support.shares[np.argmax(np.abs(support.shares - 1.0))])
    change = 1.0 / farthest - 1.0 if farthest else math.inf
    if np.all(off) and float(np.ptp(support.shares)) < ALIKE * abs(change):
        word = "large" if change > 0.0 else "small"
        text = f"The mass is {error_text(100.0 * abs(change))} % too {word}, because all forces act alike."
        return [Remark(text, True, MASS)]
    return [
        Remark(
            f"The {name} is {'negative, ' if share < 0.0 else ''}{share:.3g} times the right one."
            if abs(share - 1.0) > 0.01
            else f"The {name} is {error_text(100.0 * abs(share - 1.0))} % too {'large' if share > 1.0 else 'small'}.",
            True,
            MOTION,
        )
        for name, share, wrong in zip(SUPPORTS, support.shares.tolist(), off.tolist(), strict=True)
        if wrong
    ]


def _of_repeat(repeat: Repeat | None) -> list[Remark]:
    if repeat is None or repeat.difference == 0.0:
        return []
    text = f"Equal calls return states that differ by {error_text(repeat.difference)} of their size"
    if repeat.difference <= 2.0 * repeat.declared:
        return [Remark(f"{text}, within the declared precision.", False)]
    return [Remark(f"{text}, more than the declared precision of {repeat.declared:g}; declare it.", None)]


def _of_moments(moments: Moments, law: Friction | None) -> Iterator[Remark]:
    """Yield the errors of force and moment on discs that are not those of the law."""
    least = (
        LEAST_SHARE
        if law is None
        else max(LEAST_SHARE, 2.0 * DISTINCT * law.error, 2.0 * abs(law.strength - 1.0))
    )
    off = np.abs(moments.shares - 1.0)
    beyond = off > np.maximum(DISTINCT * moments.errors, least)
    largest = np.max(np.where(beyond, off, 0.0))
    for column, name in enumerate(("force", "moment")):
        # an error of the moment changes the spin, and so the force a little
        wrong = beyond[:, column] & (off[:, column] > ALIKE * largest)
        if np.any(wrong):
            found = moments.shares[wrong, column]
            ends = dict.fromkeys(f"{end:.4g}" for end in (np.min(found), np.max(found)))
            where = (
                "" if np.sum(wrong) == np.sum(np.isfinite(off[:, column])) else ", but not in every motion"
            )
            yield Remark(
                f"The friction {name} on a disc is {' to '.join(ends)} times the right one{where}.",
                True,
                MOTION,
            )


def _of_lag(lag: Lag, step: float, least: float) -> Iterator[Remark]:
    if abs(lag.seconds) < least:
        return
    verb = "lags" if lag.seconds > 0.0 else "leads"
    if abs(lag.seconds) > max(DISTINCT * lag.error, least):
        yield Remark(
            f"Friction {verb} the slip by {error_text(abs(lag.seconds))} s at every step size.",
            True,
            FRICTION_LAW,
        )
    elif lag.order > FALLS and STEPS[0] <= abs(lag.seconds) / step <= STEPS[1]:
        yield Remark(f"Friction {verb} the slip by {error_text(abs(lag.seconds) / step)} steps.", False)


def _of_motions(motions: dict[str, Motion], refined: str) -> Iterator[Remark]:
    """Yield the order of the errors, and the motions that do not converge to the exact one."""
    others = {name: motion for name, motion in motions.items() if not motion.converges}
    orders = [motion.order for name, motion in motions.items() if name not in others and motion.order > FALLS]
    if orders:
        least, most = (f"{order:.1f}" for order in (min(orders), max(orders)))
        yield Remark(
            f"Errors are of order {least}" + f" to {most}" * (least != most) + f" in the {refined}.", False
        )
    open_ = [name for name, motion in motions.items() if motion.converges and not motion.conclusive]
    if open_:
        yield Remark(f"Too coarse to tell: {', '.join(open_)}.", False)
    if others and all(len(set(motion.errors)) == 1 for motion in others.values()):
        yield Remark(
            f"Results do not change with the {refined}, so an error cannot be distinguished from another law.",
            True,
            MOTION,
        )
    elif others:
        off = ", ".join(f"{name} {error_text(motion.error)} m" for name, motion in others.items())
        yield Remark(f"Motions converge to others than the exact ones: {off}.", True, MOTION)


# --- The figure of the matrix: error of each engine in each motion against the rung.
#
# Each rung halves a fixed step and reduces a tolerance to an eighth. The dotted line is a tenth of the change due to
# another friction law.

MARKERS = "os^Dvx+*"

LEAST = 1e-16
"""Smallest plotted error in m; smaller errors are drawn there."""


def drawn(rows: Sequence[Row]) -> Figure:
    """Return a figure with a panel for each simulated motion and a line for each engine."""
    names = [name for name in MOTIONS if any(name in row.motions for row in rows)]
    columns = min(4, len(names))
    figure, panels = new_figure(ncols=columns, nrows=-(-len(names) // columns), width=11.0, height=6.5)
    for panel, name in zip(panels, names, strict=False):
        for row, marker in zip(rows, itertools.cycle(MARKERS), strict=False):
            if name in row.motions:
                errors = np.array(row.motions[name].errors)
                rungs = np.arange(RUNGS - len(errors), RUNGS) + 1
                panel.semilogy(rungs, np.maximum(errors, LEAST), marker=marker, label=row.engine)
        panel.axhline(MOTIONS[name].resolution, color="0.6", linewidth=0.8, linestyle=":")
        panel.set(
            title=name, xticks=range(1, RUNGS + 1), xlabel="rung (finer to the right)", ylabel="error in m"
        )
    for panel in panels[len(names) :]:
        panel.set_visible(False)
    lines = {str(line.get_label()): line for panel in panels for line in panel.get_lines()}
    named = [line for label, line in lines.items() if not label.startswith("_")]
    figure.legend(handles=named, loc="outside lower center", ncols=4)
    return figure


def drawn_forces(rows: Sequence[Row]) -> Figure:
    """Return a figure of the measured friction force, with its error, against each variable of ``Scales``."""
    figure, panels = new_figure(ncols=len(VARIABLES), width=15.0, height=3.5)
    wide = max(float(np.ptp(np.log10(np.hypot(*row.scales.forces.T)))) for row in rows if row.scales) > 1.0
    for row, marker in zip(rows, itertools.cycle(MARKERS), strict=False):
        scales = row.scales
        assert scales is not None  # by the caller
        sizes = np.hypot(*scales.forces.T)
        for panel, values in zip(panels, np.abs(scales.conditions).T, strict=True):
            moves = values > 0.0
            panel.errorbar(
                values[moves], sizes[moves], scales.errors[moves], fmt=marker, markersize=3, label=row.engine
            )
    for column, (panel, name, unit) in enumerate(zip(panels, VARIABLES, UNITS, strict=True)):
        panel.set(xscale="log", yscale="log" if wide else "linear", xlabel=f"{name} in {unit}")
        panel.set_visible(any(row.scales and np.any(row.scales.conditions[:, column]) for row in rows))
        panel.axhline(1.0, color="0.6", linewidth=0.8, linestyle=":")
    panels[0].set_ylabel("friction force over μN")
    figure.legend(handles=panels[0].get_legend_handles_labels()[0], loc="outside lower center", ncols=4)
    return figure


# --- Files of a matrix: numbers and sentences as JSON, and the figure.


def write_rows(rows: Sequence[Row], folder: Path) -> None:
    """Write the rows available so far to ``folder``/matrix.json; the file is replaced atomically."""
    content = [as_json(row) | {"sentences": list(row.sentences), "wrong": row.wrong} for row in rows]
    write_text(folder / "matrix.json", json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False))


def write_pictures(rows: Sequence[Row], folder: Path) -> list[Path]:
    """Write matrix and friction as svg and png, if there is something to draw; return the paths of the latter."""
    figures: dict[str, Figure] = {}
    wrong = [row for row in rows if row.scales is not None and row.verdict != RIGHT]
    with paper_style():
        if any(row.motions for row in rows):
            figures["matrix"] = drawn(rows)
        if wrong:
            figures["friction"] = drawn_forces(wrong)
    for name, figure in figures.items():
        for ending, content in zip(("svg", "png"), saved(figure), strict=True):
            with replacing(folder / f"{name}.{ending}", "wb") as stream:
                stream.write(content)
    return [folder / f"{name}.png" for name in figures]
