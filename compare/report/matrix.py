"""The matrix of claims and engines, the source of the first screen, the totals and the exit status."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum
from pathlib import Path
from typing import Literal

from compare.claims.claim import GRADES, THEORY, Claim, Evidence, Grade, Verdict
from compare.claims.prose import slug
from compare.claims.study import Declared, Findings, Study
from compare.claims.validation import Recorded, Validation
from compare.engines import repeated_by, shares_code
from compare.report.numbers import deciding, in_short
from compare.run.provenance import ROOT
from compare.run.runner import Run
from compare.run.workers import Failure


class State(Enum):
    """State of a cell; the first three are verdicts."""

    AGREES = "agrees"
    DIFFERS = "differs"
    INCONCLUSIVE = "inconclusive"
    FAILED = "failed"
    MISSING = "missing"
    NOT_SIMULATED = "not simulated"

    @property
    def symbol(self) -> str:
        """Mark that is recognisable without colour."""
        return _SYMBOLS[self.value]


_SYMBOLS = {
    "agrees": "✓",
    "differs": "✗",
    "inconclusive": "?",
    "failed": "!",
    "missing": "…",
    "not simulated": "∅",
}

GRADE_SYMBOLS = {Grade.EXACT: "✔", Grade.FINE: "✓", Grade.COARSE: "≈"}
"""Marks of agreement by grade; agreement without a grade has "✓" too."""

VERDICTS = (State.AGREES, State.DIFFERS, State.INCONCLUSIVE)

WORST_FIRST = (
    State.FAILED,
    State.DIFFERS,
    State.INCONCLUSIVE,
    State.MISSING,
    State.NOT_SIMULATED,
    State.AGREES,
)
"""States by priority: a cell takes the first state among its claims."""


@dataclass(frozen=True)
class Cell:
    """One engine's result for one row: the worst state of its claims, usually only one.

    ``reason`` says why a verdict is missing; ``evidence`` is the kind of evidence, "" without a verdict.
    ``implied_by`` is the claim, or the engine with the same claim, whose verdict implies the present verdict.
    """

    state: State
    claims: tuple[Claim, ...] = ()
    reason: str = ""
    evidence: Evidence | Literal[""] = ""
    implied_by: str = ""
    cost: str = ""  # step or tolerance, and time, of a recorded run

    @property
    def number(self) -> str:
        """Number next to the verdict, see ``compare.report.numbers.in_short``."""
        worst = [claim for claim in self.claims if state_of(claim) is self.state]
        return in_short(deciding(worst)) if worst else ""

    @property
    def grade(self) -> Grade | None:
        """Coarsest grade of the claims; None if they do not agree or have no grade."""
        if self.state is not State.AGREES:
            return None
        found = {claim.grade for claim in self.claims}
        return next((grade for grade in reversed(GRADES) if grade in found), None)

    @property
    def symbol(self) -> str:
        """Mark that is recognisable without colour."""
        return GRADE_SYMBOLS[self.grade] if self.grade is not None else self.state.symbol


@dataclass(frozen=True)
class Row:
    """One claim of a study, with a cell for each column that has a verdict or a reason for its absence.

    ``identity`` is the permanent name of the claim, "fig06/rests"; ``declared`` is None for a claim made by hand.
    """

    study: Study
    identity: str
    sentence: str
    equation: str
    cells: dict[str, Cell]
    declared: Declared | None = None

    @property
    def claims(self) -> tuple[Claim, ...]:
        """All claims, column by column."""
        return tuple(claim for cell in self.cells.values() for claim in cell.claims)

    @property
    def kind(self) -> str:
        """Source of the prediction, or ""."""
        return self.claims[0].kind if self.claims else ""


@dataclass(frozen=True)
class RecordedMatrix:
    """Recorded verdicts on the claims of one study, a row for each of ``settings``."""

    study: Study
    settings: tuple[Recorded, ...]

    @property
    def by_engine(self) -> dict[str, list[Recorded]]:
        """The settings of each engine."""
        found: dict[str, list[Recorded]] = {}
        for setting in self.settings:
            found.setdefault(setting.engine, []).append(setting)
        return found

    @property
    def adapters(self) -> dict[str, Path]:
        """Source files of the engines' adapters by their paths in the report."""
        found = {
            f"adapters/{Path(one.adapter).name}.txt": ROOT / one.adapter
            for one in self.settings
            if one.adapter
        }
        return {path: file for path, file in found.items() if file.is_file()}

    def anchor(self, engine: str) -> str:
        """Return the anchor of an engine's settings in the page."""
        return f"{self.study.name}-recorded/{slug(engine)}"

    @property
    def claims(self) -> tuple[Claim, ...]:
        """The claims of the first setting, which has them all."""
        return self.settings[0].claims

    def cells(self, setting: Recorded) -> tuple[Cell | None, ...]:
        """Return the cells of a row in the order of ``claims``; None if not simulated."""
        found = {
            one.sentence: replace(
                _cell([one]),
                reason=setting.reasons.get(one.sentence, ""),
                cost=setting.costs.get(one.sentence, ""),
            )
            for one in setting.claims
        }
        return tuple(found.get(claim.sentence) for claim in self.claims)

    @property
    def totals(self) -> Counter[State]:
        """Number of cells in each state."""
        return Counter(cell.state for setting in self.settings for cell in self.cells(setting) if cell)


@dataclass(frozen=True)
class Matrix:
    """The rows of some studies; ``columns`` are the engines, after "theory" if it has claims.

    ``recorded`` contains earlier results, not verdicts on this run.
    """

    columns: tuple[str, ...]
    studies: tuple[Study, ...]
    rows: tuple[Row, ...]
    recorded: tuple[RecordedMatrix, ...] = ()
    validations: tuple[tuple[Study, Validation], ...] = ()

    def of(self, study: Study) -> Matrix:
        """Return the rows of one study."""
        return Matrix(self.columns, (study,), tuple(row for row in self.rows if row.study is study))

    @property
    def claims(self) -> tuple[Claim, ...]:
        """All claims, row by row."""
        return tuple(claim for row in self.rows for claim in row.claims)

    @property
    def cells(self) -> tuple[Cell, ...]:
        """All cells, row by row."""
        return tuple(cell for row in self.rows for cell in row.cells.values())

    def column(self, column: str) -> tuple[Cell, ...]:
        """Return the cells of one column."""
        return tuple(row.cells[column] for row in self.rows if column in row.cells)

    def count(self, column: str) -> Counter[State]:
        """Return the number of cells in each state."""
        return Counter(cell.state for cell in self.column(column))

    @property
    def totals(self) -> Counter[State]:
        """Number of cells in each state."""
        return Counter(cell.state for cell in self.cells)

    def grades(self, column: str) -> Counter[Grade]:
        """Return the number of cells that agree to each grade, finest first."""
        found = Counter(cell.grade for cell in self.column(column))
        return Counter({grade: found[grade] for grade in GRADES if found[grade]})

    def reasons(self, state: State) -> Counter[str]:
        """Return the reasons of all cells in ``state`` with their numbers of cells."""
        return Counter(cell.reason for cell in self.cells if cell.state is state)

    def of_evidence(self, evidence: Evidence, column: str = "") -> Counter[State]:
        """Return the verdicts with this kind of evidence, in one column or in all."""
        cells = self.column(column) if column else self.cells
        return Counter(cell.state for cell in cells if cell.evidence == evidence)

    def of_friction(self) -> int:
        """Return the number of agreements on independent evidence that would fail with half the friction force."""
        agreeing = (cell for cell in self.cells if cell.state is State.AGREES)
        return sum(cell.evidence == "independent" and cell.claims[0].friction for cell in agreeing)

    def row_of(self, sentence: str) -> Row | None:
        """Return the row of a claim, or None."""
        return next((row for row in self.rows if row.sentence == sentence), None)

    @property
    def worst(self) -> tuple[State, ...]:
        """Worst state of all cells; () if all of them agree or are not simulated."""
        found = next((state for state in WORST_FIRST if self.totals[state]), State.AGREES)
        return () if found in (State.AGREES, State.NOT_SIMULATED) else (found,)

    @property
    def agrees(self) -> bool:
        """True if at least one cell agrees and all simulated cells do."""
        return self.totals[State.AGREES] > 0 and not self.worst


def matrix(run: Run) -> Matrix:
    """Return the matrix of a run, which may be incomplete."""
    rows = tuple(row for study in run.studies for row in _rows(run, study))
    used = {column for row in rows for column in row.cells}
    recorded = tuple(
        RecordedMatrix(study, settings) for study in run.studies if (settings := study.recorded())
    )
    columns = tuple(column for column in (THEORY, *run.engines) if column in used)
    validations = tuple((study, one) for study in run.studies for one in study.validations())
    return Matrix(columns, run.studies, rows, recorded, validations)


def _rows(run: Run, study: Study) -> list[Row]:
    columns = run.columns(study)
    known = {one.sentence_of(case): (one, case) for one in study.declared for case, _ in one.cases()}
    cells: dict[tuple[str, str], dict[str, Cell]] = {}  # in order of first occurrence
    for column in columns:
        outcome = run.outcomes.get((study.name, column))
        if isinstance(outcome, Findings):
            claims: dict[tuple[str, str], list[Claim]] = {}
            for claim in outcome.claims:
                claims.setdefault((claim.sentence, claim.equation), []).append(claim)
            for key, found in claims.items():
                cells.setdefault(key, {})[column] = _cell(found)
            for sentence, why in outcome.gaps.items():
                cells.setdefault((sentence, known[sentence][0].equation), {})[column] = single_gap(why)
    gaps = {column: gap for column in columns if (gap := gap_of(run, study.name, column)) is not None}
    rows: list[Row] = []
    for (sentence, equation), by_column in cells.items():
        fillers = {} if set(by_column) == {THEORY} else gaps.keys() - {THEORY}
        shown = {
            column: by_column.get(column) or gaps[column]
            for column in columns
            if column in by_column or column in fillers
        }
        declared, case = known.get(sentence, (None, ""))
        if declared is not None:
            identity = declared.identity(study.name, case)
        else:
            identity = _identity(study, next(iter(by_column.values())).claims[0], rows)
        rows.append(Row(study, identity, sentence, equation, shown, declared))
    rows = [
        replace(row, cells={column: _cell_with_evidence(row, column, rows, study) for column in row.cells})
        for row in rows
    ]
    # keep gaps of columns that made no claim
    unseen = {
        column: gap for column, gap in gaps.items() if not any(row.cells.get(column) is gap for row in rows)
    }
    if unseen:
        rows.append(Row(study, f"{study.name}/unknown", "(claims not known)", "", unseen))
    return rows


def _identity(study: Study, claim: Claim, rows: Sequence[Row]) -> str:
    if claim.identity:
        return claim.identity
    name = f"{study.name}/{slug(claim.sentence)}"
    same = sum(row.identity.partition("~")[0] == name for row in rows)
    return f"{name}~{same + 1}" if same else name


def _cell_with_evidence(row: Row, column: str, rows: list[Row], study: Study) -> Cell:
    """Return a cell with its kind of evidence; another row of ``rows`` may imply its verdict."""
    cell = row.cells[column]
    if not cell.claims:
        return cell
    own, engine = evidence_of(cell.claims[0]), repeated_by(column)
    if engine and not study.contact and _agrees(row.cells.get(engine)):
        return replace(cell, evidence="implied", implied_by=engine)
    sentence = cell.claims[0].implied_by
    for by in (each.cells.get(column) for each in rows if each.sentence == sentence):
        # A self-check cannot imply independent evidence.
        if by and _agrees(by) and (own != "independent" or evidence_of(by.claims[0]) == "independent"):
            return replace(cell, evidence="implied", implied_by=sentence)
    return replace(cell, evidence=own)


def evidence_of(claim: Claim) -> Evidence:
    """Return the kind of evidence of an agreement that no other verdict implies."""
    if claim.basis != "reference":
        return claim.basis
    # The theory's predictions are the reference's.
    same = claim.engine == THEORY or shares_code(claim.engine, "reference")
    return "self-check" if same else "independent"


def _agrees(cell: Cell | None) -> bool:
    return cell is not None and cell.state is State.AGREES


def gap_of(run: Run, study: str, column: str) -> Cell | None:
    """Return the cell that replaces missing claims of ``column``, or None."""
    outcome = run.outcomes.get((study, column))
    if isinstance(outcome, Findings) and outcome.not_simulated:
        return Cell(State.NOT_SIMULATED, reason=outcome.not_simulated)
    if isinstance(outcome, Failure):
        return single_gap(outcome)
    return Cell(State.MISSING, reason="not finished before the interruption") if outcome is None else None


def single_gap(why: Failure | str) -> Cell:
    """Return the cell of a claim that failed, or that was not attempted for the reason ``why``."""
    if isinstance(why, str):
        return Cell(State.NOT_SIMULATED, reason=why)
    return Cell(State.MISSING if why.unfinished else State.FAILED, reason=why.reason)


def failure_of(run: Run, study: str, column: str, sentence: str) -> Failure | None:
    """Return the failure of a claim, or of its study, with its locations in the code; None if it did not fail."""
    outcome = run.outcomes.get((study, column))
    found = outcome.gaps.get(sentence) if isinstance(outcome, Findings) else outcome
    return found if isinstance(found, Failure) else None


def _cell(claims: list[Claim]) -> Cell:
    states = {state_of(claim) for claim in claims}
    return Cell(next(state for state in WORST_FIRST if state in states), tuple(claims))


def state_of(claim: Claim) -> State:
    """Return the state of a verdict."""
    verdict: Verdict = claim.verdict
    return State(verdict.value)
