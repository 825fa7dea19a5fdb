"""A row of the matrix: results for one engine, and sentences that explain them."""

from __future__ import annotations

import itertools
import json
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from compare.claims.as_json import as_json
from compare.diagnosis.findings import MOTIONS, RUNGS, Creep, Lag, Motion
from compare.diagnosis.laws import CONE, DISTINCT, FITS, Friction
from compare.diagnosis.probes import FRICTION, SPEED
from compare.output.figures import Figure, new_figure, paper_style, saved
from compare.output.text_files import replacing, write_text
from compare.report.numbers import error_text

LEAST_DEVIATION = 1e-8
"""Smallest reported relative deviation of a force or its direction."""

FALLS = 0.3
"""Order in the step above which a quantity counts as decreasing with it."""

RESTS = 1e-9
"""Ratio of speed to sliding speed below which a block is at rest."""

LEAST_LAG = 1e-6
"""Smallest reported lag in s, if the force is equally accurate: the slip rotates at about 1 rad/s in the probe."""

STEPS = (0.2, 3.0)
"""Range of lags, in steps, that are reported in steps."""


@dataclass(frozen=True)
class Row:
    """Results for an engine.

    Parameters
    ----------
    engine, version : str
        Name and version of the engine.
    step : float
        Step in s at the finest rung; NaN if the engine has a tolerance.
    law, creep, lag
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
    creep: Creep | None = None
    lag: Lag | None = None
    motions: dict[str, Motion] = field(default_factory=dict)
    gaps: dict[str, str] = field(default_factory=dict)
    not_simulated: tuple[str, ...] = ()
    seconds: float = 0.0

    @property
    def sentences(self) -> tuple[str, ...]:
        """Diagnosis in a few sentences, the friction law first."""
        said = []
        if self.law is not None:
            said.append(_of_law(self.law))
        if self.creep is not None:
            said.append(_of_creep(self.creep, self._refined))
        if self.lag is not None and self._is_coulombs:
            said.append(_of_lag(self.lag, self.step, self._least_lag))
        said.append(_of_motions(self.motions, self._refined))
        for reason, names in self._gaps_by_reason.items():
            said.append(f"No result for {', '.join(names)}: {reason}.")
        return tuple(filter(None, said))

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
    def _is_coulombs(self) -> bool:
        """True if friction opposes the slip with μN, possibly with a lag."""
        return self.law is not None and self.law.sure and not _is_other(self.law)

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
        return (
            (self.law is not None and _is_other(self.law))
            or (self.creep is not None and _creeps_for_good(self.creep))
            or (self.lag is not None and self._is_coulombs and _lags_for_good(self.lag, self._least_lag))
            or any(not motion.converges for motion in self.motions.values())
        )


def _of_law(law: Friction) -> str:
    if law.misfit > max(DISTINCT * law.error, FITS):
        return (
            f"No known friction law fits: the best fit, a {law.shape}, "
            f"deviates by {error_text(law.misfit)} times μN."
        )
    if not law.sure:
        return (
            "The friction law could not be identified: "
            f"the error of the forces is {error_text(law.error)} times μN."
        )
    deviations = _deviations(law)
    name = "Friction is Coulomb's cone" if law.shape == CONE else f"Friction is a {law.shape}"
    if deviations:
        return f"{name}, but {' and '.join(deviations)}."
    return f"{name}, accurate to {error_text(law.error)} times μN."


def _is_other(law: Friction) -> bool:
    """Return whether a law certainly differs from Coulomb's."""
    return (law.sure and law.shape != CONE) or bool(_deviations(law))


def _deviations(law: Friction) -> list[str]:
    """Return descriptions of the deviations of a force from its own law."""
    found = []
    least = max(DISTINCT * law.error, LEAST_DEVIATION)
    if abs(law.strength - 1.0) > least:
        size = "large" if law.strength > 1.0 else "small"
        found.append(
            f"μ is {error_text(100.0 * abs(law.strength - 1.0))} % too {size} (±{error_text(100.0 * law.error)} %)"
        )
    if abs(law.angle) > least:
        found.append(
            f"its force is rotated by {error_text(math.degrees(law.angle))}° "
            f"(±{error_text(math.degrees(law.error))}°)"
        )
    return found


def _of_creep(creep: Creep, refined: str) -> str:
    if abs(creep.speed) < RESTS * SPEED:
        return "A block loaded below μN stays at rest."
    how = f"decreasing with the {refined}" if creep.order > FALLS else f"independent of the {refined}"
    if creep.smoothing:
        return (
            f"A block loaded below μN creeps: friction is regularised as {creep.smoothing} with "
            f"ε = {error_text(creep.epsilon)} m/s, {how}."
        )
    return f"A block loaded with half of μN = {FRICTION:g} N creeps at {error_text(abs(creep.speed))} m/s, {how}."


def _creeps_for_good(creep: Creep) -> bool:
    return abs(creep.speed) >= RESTS * SPEED and not creep.order > FALLS


def _of_lag(lag: Lag, step: float, least: float) -> str:
    if abs(lag.seconds) < least:
        return ""
    verb = "lags" if lag.seconds > 0.0 else "leads"
    if _lags_for_good(lag, least):
        return f"Friction {verb} the slip by {error_text(abs(lag.seconds))} s at every step size."
    if lag.order > FALLS and STEPS[0] <= abs(lag.seconds) / step <= STEPS[1]:
        return f"Friction {verb} the slip by {error_text(abs(lag.seconds) / step)} steps."
    return ""


def _lags_for_good(lag: Lag, least: float) -> bool:
    return abs(lag.seconds) > max(DISTINCT * lag.error, least)


def _of_motions(motions: dict[str, Motion], refined: str) -> str:
    """Return a sentence on the order of the errors and the motions that do not converge to the exact one."""
    others = {name: motion for name, motion in motions.items() if not motion.converges}
    said = []
    orders = [motion.order for name, motion in motions.items() if name not in others and motion.order > FALLS]
    if orders:
        least, most = (f"{order:.1f}" for order in (min(orders), max(orders)))
        said.append(f"errors are of order {least}" + f" to {most}" * (least != most) + f" in the {refined}")
    open_ = [name for name, motion in motions.items() if motion.converges and not motion.conclusive]
    if open_:
        said.append(f"too coarse to tell: {', '.join(open_)}")
    if others and all(len(set(motion.errors)) == 1 for motion in others.values()):
        said.append(
            f"results do not change with the {refined}, so an error cannot be distinguished from another law"
        )
    elif others:
        off = ", ".join(f"{name} {error_text(motion.error)} m" for name, motion in others.items())
        said.append(f"converges to a motion that deviates from the exact one: {off}")
    text = "; ".join(said)
    return f"{text[0].upper()}{text[1:]}." if text else ""


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


# --- Files of a matrix: numbers and sentences as JSON, and the figure.


def write_rows(rows: Sequence[Row], folder: Path) -> None:
    """Write the rows available so far to ``folder``/matrix.json; the file is replaced atomically."""
    content = [as_json(row) | {"sentences": list(row.sentences), "wrong": row.wrong} for row in rows]
    write_text(folder / "matrix.json", json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False))


def write_picture(rows: Sequence[Row], folder: Path) -> None:
    """Write matrix.svg and matrix.png, if any motion was simulated."""
    if not any(row.motions for row in rows):
        return
    with paper_style():
        figure = drawn(rows)
    for ending, content in zip(("svg", "png"), saved(figure), strict=True):
        with replacing(folder / f"matrix.{ending}", "wb") as stream:
            stream.write(content)
