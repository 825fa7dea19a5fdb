"""A row of the matrix: results for one engine, and sentences that explain them."""

import functools
import itertools
import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from compare.claims.as_json import as_json
from compare.diagnosis import joint_wording, wording
from compare.diagnosis.causes.acting import acting
from compare.diagnosis.causes.course import Course, beginning_of, change_of
from compare.diagnosis.causes.output import Output, flaw_of
from compare.diagnosis.causes.patch import INERTIA, Patch, law_of
from compare.diagnosis.findings import MOTIONS, PROBES, Creep, History, Lag, Motion, Repeat, Shares, heading
from compare.diagnosis.joint_probes import Joint
from compare.diagnosis.ladder import HALVED, RUNGS
from compare.diagnosis.laws import CONE, DISTINCT, Friction
from compare.diagnosis.probes import FRICTION, HEADINGS, SLIDES_FOR, SPEED, SUPPORTS
from compare.diagnosis.scaling import UNITS, VARIABLES, Scales, blind, deviation, speed_limit
from compare.diagnosis.wording import DAMPED, DISCS, LEAST_LAG, MASS, MOTION, RESTS, Remark, sentence
from compare.engines import COARSENING
from compare.output.figures import Figure, new_figure, paper_style, saved
from compare.output.text_files import replacing, write_text
from compare.report.numbers import error_text
from compare.run.statuses import Share

RIGHT, WRONG, UNDECIDED = "right", "wrong", "undecided"  # verdicts over everything


@dataclass(frozen=True)
class Row:
    """Results for an engine; a probe is None if not measured."""

    engine: str
    version: str = ""
    step: float = math.nan  # in s at the finest rung; NaN if the engine has a tolerance
    law: Friction | None = None
    scales: Scales | None = None
    creep: Creep | None = None
    history: History | None = None
    support: Shares | None = None
    far: Shares | None = None
    nonlinear: Shares | None = None
    repeat: Repeat | None = None
    course: Course | None = None
    output: Output | None = None
    patch: Patch | None = None
    lag: Lag | None = None
    moments: Shares | None = None
    joint: Joint | None = None
    hour: float | None = None  # angle in rad that a joint at rest moves in an hour
    motions: dict[str, Motion] = field(default_factory=dict)
    gaps: dict[str, str] = field(default_factory=dict)  # reasons of parts that failed
    not_measured: dict[str, str] = field(default_factory=dict)  # reasons of parts refused or out of time
    left_out: dict[str, str] = field(default_factory=dict)  # reasons of parts beyond the declared ranges
    seconds: float = 0.0  # wall-clock time

    @functools.cached_property
    def remarks(self) -> tuple[Remark, ...]:
        """Findings about friction, the support and the motions, causes first."""
        law, found = self.law, [*wording.of_repeat(self.repeat)]
        flaw = flaw_of(self.output, self._differs) if self.output is not None else None
        if flaw is not None:
            found.append(Remark(sentence(flaw.text), True, MOTION))
        if flaw is None or flaw.only_spin:
            others = self._of_forces(spin_right=flaw is None)
            others += [*self._of_joint, *wording.of_motions(self.motions, self._refined)]
            found += [remark for remark in others if not (remark.wrong and self._random)]
        if self.repeat is not None and self.repeat.deaf and any(remark.wrong for remark in found):
            deaf = Remark(
                f"Results do not change with the {self._refined}, so an error of the integration cannot be "
                "distinguished from another law.",
                True,
                MOTION,
            )
            found.insert(0 if law is None or law.coulomb else len(found), deaf)
        found += wording.of_gaps("No result for", self.gaps, wrong=True)
        if not self.share.enough:
            found.append(Remark(sentence(self.share.in_words("part")), None))
        found += wording.of_gaps("Not measured:", self.not_measured, wrong=False)
        found += wording.of_gaps("Left out:", self.left_out, wrong=False)
        said = {
            remark.text.partition(" with ε")[0]: remark for remark in reversed(found)
        }  # regularised by two probes
        return tuple(remark for remark in found if remark in said.values())

    def _of_forces(self, *, spin_right: bool) -> list[Remark]:
        """Return the findings about forces; each may explain those that follow."""
        law, scales, found = self.law, self.scales, list[Remark]()
        forces, predicted = acting(scales) if scales is not None else None, np.zeros(len(SUPPORTS))
        strength = law.strength if law is not None and law.shape == CONE else math.nan
        supports = list[Remark]()
        if self.support is not None:
            supports = wording.of_support(self.support, strength, forces.of_supports if forces else predicted)
            if supports and forces is not None:  # a wrong support acts on the slides, too
                forces, supports = None, wording.of_support(self.support, strength, predicted)
        if forces is not None:
            found.append(Remark(sentence(forces.text), True, forces.about))
        elif scales is not None and (text := speed_limit(scales)):
            found.append(Remark(sentence(text), True, MOTION))
        found += supports
        support_right = not found
        changes = change_of(self.course) if self.course is not None and support_right else ""
        if law is not None and law.shape == CONE and changes and not self._explained:
            found.append(Remark(sentence(changes), True))
        elif law is not None and forces is None and not any(one.about in {MASS, DAMPED} for one in found):
            found += wording.of_law(law, scales, self.support, support_right, self._refined)
        if self.course is not None and not any(one.wrong for one in found):
            found += [Remark(sentence(text), None) for text in [beginning_of(self.course)] if text]
        explained = any(remark.wrong for remark in found)
        forced = scales is None or not blind(scales)
        open_ = law is None or law.coulomb or (law.fits and not law.sure)
        if self.creep is not None and forced and open_ and forces is None:
            found += wording.of_creep(self.creep, self._refined, self._least_speed)
        if law is None or law.coulomb:
            if self.history is not None and support_right:
                explained = explained or any(remark.wrong for remark in found)
                found += wording.of_history(self.history, explained, self._least_speed)
            if self.lag is not None and not explained:
                found += wording.of_lag(self.lag, self.step, self._least_lag)
            if support_right and spin_right:
                found += self._of_discs()
            if self.far is not None and forces is None:
                found += wording.of_far(self.far)
        if self.nonlinear is not None and support_right:
            found += wording.of_nonlinear(self.nonlinear)
        return found

    def _of_discs(self) -> Iterator[Remark]:
        text, right = self.spin
        if text:
            yield Remark(sentence(text), not right, MOTION if INERTIA in text else DISCS)
        if self.moments is not None and right:  # otherwise they follow from the law
            yield from wording.of_moments(self.moments, self.law)

    @functools.cached_property
    def spin(self) -> tuple[str, bool]:
        """Law of discs that slide and spin in words, or "" if blocks have another law; and whether it is right."""
        law = self.law
        if self.patch is None or not (law is None or law.coulomb):
            return "", True
        return law_of(self.patch, law.strength if law is not None else 1.0)

    @property
    def _explained(self) -> bool:
        """True if a known dependence of the coefficient μ explains the slides."""
        if self.law is None or self.scales is None:
            return False
        other = deviation(self.scales, self.law)
        return bool(blind(self.scales)) or (other is not None and other.explained)

    @property
    def _differs(self) -> float:
        """Difference of equal calls, as a share of the states."""
        return self.repeat.difference if self.repeat is not None else 0.0

    @property
    def _random(self) -> bool:
        """True if undeclared differences of equal calls explain the deviations of the forces."""
        if self.repeat is None or self._differs <= 2.0 * self.repeat.declared:
            return False
        law = self.law
        off = 0.0 if law is None else max(abs(law.strength - 1.0), law.misfit, abs(law.angle))
        return off <= DISTINCT * self._differs * SPEED / (FRICTION * SLIDES_FOR)

    def reason(self, name: str) -> str:
        """Return why the motion ``name`` does not agree, as a clause; "" if it does."""
        motion = self.motions[name]
        of_disc = [one.text for one in self.remarks if one.wrong and one.about == DISCS and name == "disc"]
        others = [one.text for one in self.remarks if one.wrong and one.about != DISCS]
        found = [*of_disc, *others] if motion.mark == "✗" else of_disc
        causes = [f"{text[0].lower()}{text[1:]}".rstrip(".").partition(": ")[0] for text in found]
        if motion.mark == "?":
            bar, least = error_text(motion.estimate), error_text(motion.resolution)
            causes.append(f"its error bar of {bar} m exceeds {least} m, a tenth of the effect of another law")
        return causes[0] if motion.mark != "✓" else ""

    @property
    def sentences(self) -> tuple[str, ...]:
        """Diagnosis in a few sentences, the verdict first."""
        decisive = True if self.verdict == WRONG else None
        first = next((remark for remark in self.remarks if remark.wrong is decisive), None)
        said = [remark.text for remark in self.remarks if remark is not first]
        if first is not None:
            about = first.about if decisive else "Undecided"
            said.insert(0, f"{about}: {first.text[0].lower()}{first.text[1:]}")
        elif self.law is not None:
            said.insert(0, f"Coulomb friction, accurate to {error_text(self.law.error)} times the limit μN.")
        elif self.moments is not None:
            error = error_text(float(np.nanmax(self.moments.errors)))
            said.insert(
                0, f"The force and the moment of friction on a disc are right to {error} of their size."
            )
        if self.joint is not None and self._repeats and all(one.wrong is False for one in self._of_joint):
            at = 0 if first is None and self.law is None and self.moments is None else len(said)
            said.insert(at, joint_wording.right(self.joint, self._refined, self._noise))
        if self.scales is not None:
            looked_at = [self.scales.looked_at, f"{len(HEADINGS)} headings"]
            said.append(f"Examined, with forces known to 1 %: {'; '.join(filter(None, looked_at))}.")
        if self.joint is not None:
            said.append(joint_wording.examined())
        return tuple(said)

    @property
    def verdict(self) -> str:
        """``RIGHT``, ``WRONG`` or ``UNDECIDED``."""
        if any(remark.wrong for remark in self.remarks):
            return WRONG
        return UNDECIDED if any(remark.wrong is None for remark in self.remarks) else RIGHT

    @property
    def share(self) -> Share:
        """Share of the parts whose result can distinguish friction laws."""
        probes = sum(getattr(self, name) is not None for name in PROBES)
        measured = probes + sum(bool(motion.conclusive) for motion in self.motions.values())
        return Share(measured, probes + len(self.motions) + len(self.gaps) + len(self.not_measured))

    @functools.cached_property
    def _of_joint(self) -> tuple[Remark, ...]:
        found: list[Remark] = []
        if not self._repeats:
            return ()  # any number may be chance
        if self.joint is not None:
            ratio = COARSENING if math.isnan(self.step) else HALVED
            found += joint_wording.of_joint(self.joint, self._refined, ratio, self._noise)
        if self.hour is not None and not any(remark.wrong for remark in found):
            found += joint_wording.of_hour(self.hour, self.joint)
        return tuple(found)

    @property
    def _repeats(self) -> bool:
        """True if equal calls are not known to differ by more than the declared precision."""
        return self.repeat is None or self.repeat.difference <= 2.0 * self.repeat.declared

    @property
    def _noise(self) -> float:
        return max(self.repeat.difference, self.repeat.declared) if self.repeat is not None else 0.0

    @property
    def _refined(self) -> str:
        return "tolerance" if math.isnan(self.step) else "step"

    @property
    def _least_speed(self) -> float:
        """Speed in m/s below which a block is at rest, by noise in the states."""
        return (RESTS + self._noise) * SPEED

    @property
    def _least_lag(self) -> float:
        return max(LEAST_LAG, DISTINCT * self.law.error) if self.law is not None else math.inf

    @property
    def wrong(self) -> bool:
        """True if a deviation persists at smaller steps."""
        return self.verdict == WRONG


# --- The figure of the matrix: error of each engine in each motion against the rung.
#
# Each rung halves a fixed step and reduces a tolerance to an eighth. The dotted line is a tenth of the change due
# to another friction law.

MARKERS = "os^Dvx+*"
LEAST = 1e-16  # smallest plotted error in m


def drawn(rows: Sequence[Row]) -> Figure:
    """Return a figure with a panel for each motion."""
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
            title=heading(name), xticks=range(1, RUNGS + 1), xlabel="refinement", ylabel="largest error in m"
        )
    for panel in panels[len(names) :]:
        panel.set_visible(False)
    lines = {str(line.get_label()): line for panel in panels for line in panel.get_lines()}
    named = [line for label, line in lines.items() if not label.startswith("_")]
    figure.legend(handles=named, loc="outside lower center", ncols=4)
    return figure


def drawn_forces(rows: Sequence[Row]) -> Figure:
    """Return a figure of the friction force against each variable of ``Scales``."""
    figure, panels = new_figure(ncols=len(VARIABLES), width=15.0, height=3.5)
    wide = max(float(np.ptp(np.log10(np.hypot(*row.scales.forces.T)))) for row in rows if row.scales) > 1.0
    for row, marker in zip(rows, itertools.cycle(MARKERS), strict=False):
        scales = row.scales
        assert scales is not None
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
    """Write the available rows to ``folder``/matrix.json atomically."""
    content = [as_json(row) | {"sentences": list(row.sentences), "wrong": row.wrong} for row in rows]
    write_text(folder / "matrix.json", json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False))


def write_pictures(rows: Sequence[Row], folder: Path) -> list[Path]:
    """Write available figures as svg and png; return the paths of the png files."""
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
