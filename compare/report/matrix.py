"""The matrix of claims and engines: what the first screen, the totals and the exit status are made of."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum
from typing import Literal

from compare.claims.claim import GRADES, THEORY, Claim, Evidence, Grade, Verdict
from compare.claims.prose import slug
from compare.claims.study import Findings, Recorded, Study
from compare.engines import repeated_by, shares_code
from compare.report.numbers import deciding, in_short
from compare.run.runner import Run
from compare.run.workers import Failure


class State(Enum):
    """What a cell says; the first three are verdicts."""

    AGREES = "agrees"
    DIFFERS = "differs"
    INCONCLUSIVE = "inconclusive"
    FAILED = "failed"
    MISSING = "missing"
    NOT_SIMULATED = "not simulated"

    @property
    def symbol(self) -> str:
        """A mark that is told apart without colour."""
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
"""Marks of what agrees; "✓" too where only the claim's resolution says what is small."""

VERDICTS = (State.AGREES, State.DIFFERS, State.INCONCLUSIVE)

WORST_FIRST = (
    State.FAILED,
    State.DIFFERS,
    State.INCONCLUSIVE,
    State.MISSING,
    State.NOT_SIMULATED,
    State.AGREES,
)
"""A cell with several claims says the first that applies to any."""


@dataclass(frozen=True)
class Cell:
    """One engine's answer to one claim.

    Parameters
    ----------
    state : State
        The worst of all.
    claims : tuple of Claim
        Usually one; several where a study makes the same claim for several parameters.
    reason : str
        Why there is no verdict.
    evidence : str
        Its kind, see ``compare.claims.claim.EVIDENCE``; "" where there is no verdict.
    implied_by : str
        From which claim, or from which engine's verdict on the same claim, it follows.

    """

    state: State
    claims: tuple[Claim, ...] = ()
    reason: str = ""
    evidence: Evidence | Literal[""] = ""
    implied_by: str = ""

    @property
    def number(self) -> str:
        """What stands beside the verdict, see ``compare.report.numbers.in_short``; "" where there is none."""
        return in_short(deciding(self._decisive)) if self.claims else ""

    @property
    def grade(self) -> Grade | None:
        """How finely it agrees, the coarsest of several claims; None where none has a size or it does not agree."""
        if self.state is not State.AGREES:
            return None
        found = {claim.grade for claim in self.claims}
        return next((grade for grade in reversed(GRADES) if grade in found), None)

    @property
    def symbol(self) -> str:
        """A mark that is told apart without colour."""
        return GRADE_SYMBOLS[self.grade] if self.grade is not None else self.state.symbol

    @property
    def _decisive(self) -> list[Claim]:
        return [claim for claim in self.claims if state_of(claim) is self.state]


@dataclass(frozen=True)
class Row:
    """One claim of a study, with a cell for each column that has something to say about it.

    ``identity`` is the permanent name of the claim and its anchor in the page: "fig06/rests".
    """

    study: Study
    identity: str
    sentence: str
    equation: str
    cells: dict[str, Cell]

    @property
    def claims(self) -> tuple[Claim, ...]:
        """All claims of the row, column by column."""
        return tuple(claim for cell in self.cells.values() for claim in cell.claims)

    @property
    def kind(self) -> str:
        """What the prediction is taken from, "" where nobody made the claim."""
        return self.claims[0].kind if self.claims else ""


@dataclass(frozen=True)
class RecordedMatrix:
    """What recorded engines make of one study's claims, a row for each of ``settings``."""

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
    def claims(self) -> tuple[Claim, ...]:
        """The claims of all cases, as the first one, an engine of ours, makes them."""
        return self.settings[0].claims

    def cells(self, setting: Recorded) -> tuple[Cell | None, ...]:
        """Return the cells of a row, in the order of ``claims``; None for what the engine does not simulate."""
        found = {claim.sentence: _cell([claim]) for claim in setting.claims}
        return tuple(found.get(claim.sentence) for claim in self.claims)

    @property
    def totals(self) -> Counter[State]:
        """How many cells are in each state."""
        return Counter(cell.state for setting in self.settings for cell in self.cells(setting) if cell)


@dataclass(frozen=True)
class Matrix:
    """The rows of some studies; ``columns`` are "theory", where any study has claims of it, and the engines.

    ``recorded`` stands apart: it was found about the engines of others and is not a verdict on this run.
    """

    columns: tuple[str, ...]
    studies: tuple[Study, ...]
    rows: tuple[Row, ...]
    recorded: tuple[RecordedMatrix, ...] = ()

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
        """Return how many cells of the column are in each state."""
        return Counter(cell.state for cell in self.column(column))

    @property
    def totals(self) -> Counter[State]:
        """How many cells are in each state."""
        return Counter(cell.state for cell in self.cells)

    def grades(self, column: str) -> Counter[Grade]:
        """Return how many cells of the column agree to each grade, from the finest on."""
        found = Counter(cell.grade for cell in self.column(column))
        return Counter({grade: found[grade] for grade in GRADES if found[grade]})

    def reasons(self, state: State) -> Counter[str]:
        """Return the reasons of all cells in ``state``, and how many cells give each."""
        return Counter(cell.reason for cell in self.cells if cell.state is state)

    def of_evidence(self, evidence: Evidence, column: str = "") -> Counter[State]:
        """Return how many verdicts of a kind of evidence, in one column or in all, are in each state."""
        cells = self.column(column) if column else self.cells
        return Counter(cell.state for cell in cells if cell.evidence == evidence)

    def row_of(self, sentence: str) -> Row | None:
        """Return the row of a claim; None if there is none."""
        return next((row for row in self.rows if row.sentence == sentence), None)

    @property
    def worst(self) -> tuple[State, ...]:
        """The worst state of all cells, () where they agree or were not asked for."""
        found = next((state for state in WORST_FIRST if self.totals[state]), State.AGREES)
        return () if found in (State.AGREES, State.NOT_SIMULATED) else (found,)

    @property
    def agrees(self) -> bool:
        """Whether there are claims, and all that could be simulated agree."""
        return self.totals[State.AGREES] > 0 and not self.worst


def matrix(run: Run) -> Matrix:
    """Return the matrix of a run, also of an incomplete one."""
    rows = tuple(row for study in run.studies for row in _rows(run, study))
    used = {column for row in rows for column in row.cells}
    recorded = tuple(
        RecordedMatrix(study, settings) for study in run.studies if (settings := study.recorded())
    )
    columns = tuple(column for column in (THEORY, *run.engines) if column in used)
    return Matrix(columns, run.studies, rows, recorded)


def _rows(run: Run, study: Study) -> list[Row]:
    columns = run.columns(study)
    claims: dict[tuple[str, str], dict[str, list[Claim]]] = {}  # in the order in which they are first met
    for column in columns:
        outcome = run.outcomes.get((study.name, column))
        if isinstance(outcome, Findings):
            for claim in outcome.claims:
                claims.setdefault((claim.sentence, claim.equation), {}).setdefault(column, []).append(claim)
    gaps = {column: gap for column in columns if (gap := _gap(run, study, column)) is not None}
    rows: list[Row] = []
    for (sentence, equation), found in claims.items():
        theory_only = set(found) == {THEORY}
        cells = {}
        for column in columns:
            if column in found:
                cells[column] = _cell(found[column])
            elif column in gaps and column != THEORY and not theory_only:
                cells[column] = gaps[column]
        identity = _identity(study, next(iter(found.values()))[0], rows)
        rows.append(Row(study, identity, sentence, equation, cells))
    rows = [_weighed(row, rows, study) for row in rows]
    # a gap that no row shows, because nobody made a claim there, still has to be seen
    unseen = {
        column: gap for column, gap in gaps.items() if not any(row.cells.get(column) is gap for row in rows)
    }
    if unseen:
        rows.append(Row(study, f"{study.name}/unknown", "(claims not known)", "", unseen))
    return rows


def _identity(study: Study, claim: Claim, rows: Sequence[Row]) -> str:
    """Return what a claim is called; one made by hand by its sentence, and unlike all of ``rows``."""
    if claim.identity:
        return claim.identity
    name = f"{study.name}/{slug(claim.sentence)}"
    same = sum(row.identity.partition("~")[0] == name for row in rows)
    return f"{name}~{same + 1}" if same else name


def _weighed(row: Row, rows: list[Row], study: Study) -> Row:
    """Return ``row`` with the kind of evidence of each verdict, which may follow from another one of ``rows``."""
    return replace(row, cells={column: _weighed_cell(row, column, rows, study) for column in row.cells})


def _weighed_cell(row: Row, column: str, rows: list[Row], study: Study) -> Cell:
    cell = row.cells[column]
    if not cell.claims:
        return cell
    own, engine = evidence_of(cell.claims[0]), repeated_by(column)
    if engine and not study.contact and _agrees(row.cells.get(engine)):
        return replace(cell, evidence="implied", implied_by=engine)
    sentence = cell.claims[0].implied_by
    by = (
        next((each.cells.get(column) for each in rows if each.sentence == sentence), None)
        if sentence
        else None
    )
    # A self-check implies nothing that is more than one.
    if (
        by is not None
        and _agrees(by)
        and (own != "independent" or evidence_of(by.claims[0]) == "independent")
    ):
        return replace(cell, evidence="implied", implied_by=sentence)
    return replace(cell, evidence=own)


def evidence_of(claim: Claim) -> Evidence:
    """Return what agreement is evidence of if the claim does not follow from another verdict."""
    if claim.basis != "reference":
        return claim.basis
    # The reference simulates what is predicted in the name of the theory.
    same = claim.engine == THEORY or shares_code(claim.engine, "reference")
    return "self-check" if same else "independent"


def _agrees(cell: Cell | None) -> bool:
    return cell is not None and cell.state is State.AGREES


def _gap(run: Run, study: Study, column: str) -> Cell | None:
    """Return what stands in place of the claims that ``column`` has not, None where none is missing."""
    outcome = run.outcomes.get((study.name, column))
    if isinstance(outcome, Findings) and outcome.not_simulated:
        return Cell(State.NOT_SIMULATED, reason=outcome.not_simulated)
    if isinstance(outcome, Failure):
        return Cell(State.FAILED, reason=outcome.reason)
    return Cell(State.MISSING, reason="not finished before the interruption") if outcome is None else None


def _cell(claims: list[Claim]) -> Cell:
    states = {state_of(claim) for claim in claims}
    return Cell(next(state for state in WORST_FIRST if state in states), tuple(claims))


def state_of(claim: Claim) -> State:
    """Return the state that a claim's verdict is."""
    verdict: Verdict = claim.verdict
    return State(verdict.value)
