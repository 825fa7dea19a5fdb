"""``friction-discs report``: measure the studies and write the report."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from compare.cli.command import (
    FINE,
    INTERRUPTED,
    NOTHING_SHOWN,
    SOMETHING_DIFFERS,
    measurements,
    printing,
    refused,
    say,
)
from compare.cli.options import (
    Folder,
    Jobs,
    Resume,
    Seed,
    check_folder,
    chosen_from,
    cores,
    positive,
    studies_of,
    whole,
)
from compare.output.outside_text import one_of

if TYPE_CHECKING:
    from compare.claims.study import Study
    from compare.engines import Engine
    from compare.report.matrix import Matrix
    from compare.run.runner import Run
    from compare.run.workers import Failure


FULL = "report"
"""Default folder of a full report."""

MOST_LISTED = 10

Names = Annotated[
    list[str] | None,
    typer.Argument(metavar="STUDY", help="Studies to run; all by default.", show_default=False),
]
Engines = Annotated[
    list[str] | None,
    typer.Option(
        metavar="NAME",
        help="Engine to measure; repeat for more engines (default: all). Your own engine is MODULE:FUNCTION "
        "(a Python function), exec:COMMAND (a program in any language), files:DIR (motions requested by plan) "
        "or fmu:FILE (a co-simulation FMU).",
        show_default=False,
    ),
]
Level = Annotated[
    str,
    typer.Option(
        metavar="LEVEL",
        help="quick (studies that take seconds, with every kind of claim) or full (all studies).",
        parser=chosen_from("level", ("quick", "full")),
    ),
]

Limit = Annotated[
    float | None,
    typer.Option(
        "--study-limit",
        metavar="SECONDS",
        help="Limit of processor time in s for one study of one engine. By default 85 for your own engine at the "
        "quick level, which leaves out claims that need too many steps; else no limit.",
        parser=positive("study-limit", "s"),
        show_default=False,
    ),
]


LeastConclusive = Annotated[
    int,
    typer.Option(
        "--min-conclusive",
        metavar="N",
        help="Minimum number of claims that must agree; the theory's own algebra does not count.",
        parser=whole("min-conclusive", 0, 1_000_000),
    ),
]


OneClaim = Annotated[
    str | None,
    typer.Option(
        metavar="ID",
        help="Measure only this claim, for example fig06/rests, and print its numbers.",
        show_default=False,
    ),
]


Replace = Annotated[
    bool,
    typer.Option("--replace", help="Allow a partial report to replace a full one in the folder of --output."),
]


Logs = Annotated[
    Path | None,
    typer.Option(
        metavar="FOLDER",
        help="Folder with the logs of the measured pushes, to be reduced again and compared with the table of the "
        "study pushes.",
        show_default=False,
    ),
]


def report(
    context: typer.Context,
    names: Names = None,
    claim: OneClaim = None,
    engine: Engines = None,
    level: Level = "full",
    seed: Seed = None,
    study_limit: Limit = None,
    min_conclusive: LeastConclusive = 1,
    output: Folder = Path(FULL),
    replace_full: Replace = False,
    jobs: Jobs = None,
    resume: Resume = False,
    data: Logs = None,
) -> int:
    """Measure the claims of studies and write a report.

    It writes index.html, results.json, junit.xml and figures. Without --output, a full report goes into the folder
    report, and a partial one (some studies or engines, one claim, the quick level) into report-part.

    The exit status is 0 if no claim differs and at least half of each engine's claims were measured, and 1 if a claim
    differs or an engine failed. It is 2 for bad input, and 3 if less was measured or fewer claims agree than
    --min-conclusive requires. It is 130 after Ctrl-C; --resume then completes the report, but does not notice changes
    to data files of your own engine.

    \b
    Examples:
      friction-discs report
      friction-discs report --level quick
      friction-discs report fig03 fig05 --engine exudyn --output fig
      friction-discs report --claim fig06/rests --engine exudyn
    """
    from compare.claims.errata import ERRATA
    from compare.run.levels import seed_of
    from compare.run.runner import loaded
    from compare.run.workers import Workers

    _check_logs(data)
    studies = _requested_studies(context, names or [], claim, level, resume)
    part = bool(names or claim or engine or level != "full")
    output = _folder(context, output, part)
    with refused(), Workers() as workers:
        chosen = loaded(engine or [], workers, seed_of(level, seed))
        if part and not replace_full:
            _check_kept(output, studies_of(context, []), () if claim else studies, chosen)
        check_folder(output)
        check_folder(store_of(output))
    result = _run(
        studies,
        chosen,
        output,
        jobs=jobs or cores(),
        limit=study_limit,
        quick=level == "quick",
        resume=resume,
        errata=() if context.obj is not None or names or claim or level != "full" else ERRATA,
    )
    matrix = _write(result, output)
    _print_results(result, matrix, chosen, output / "index.html", with_numbers=claim is not None)
    return _status(result, matrix, min_conclusive, [one.name for one in chosen] if engine else [])


def _check_logs(folder: Path | None) -> None:
    if folder is None:
        return
    from compare.studies.plane.pushes.reduction import check_table
    from compare.studies.plane.pushes.study import account

    with refused():
        agreeing, new = check_table(folder)
    with printing():
        if agreeing:
            print(f"The table agrees with the logs of {len(agreeing)} series: {', '.join(agreeing)}")
        for line in account(new):
            print(line)


def store_of(output: Path) -> Path:
    """Return the folder of measurements for ``--resume``, outside the report."""
    return output.resolve().with_name(f"{output.resolve().name}.data")


def _requested_studies(
    context: typer.Context, names: list[str], claim: str | None, level: str, resume: bool
) -> tuple[Study, ...]:
    studies = studies_of(context, names, level)
    if claim is None:
        return studies
    with refused():
        if names or level != "full" or resume:
            raise ValueError("--claim cannot be combined with named studies, --level or --resume")
        return (with_claim(studies, claim),)


def _folder(context: typer.Context, output: Path, part: bool) -> Path:
    """Return the folder; a partial report does not replace a full one by default."""
    source = context.get_parameter_source("output")
    return Path("report-part") if part and source is not None and source.name == "DEFAULT" else output


def _check_kept(
    output: Path, everything: Sequence[Study], studies: Sequence[Study], engines: Sequence[Engine]
) -> None:
    """Raise ``ValueError`` if ``output`` contains all studies, with measurements that the new report would lack."""
    from compare.claims.claim import THEORY
    from compare.report.results_json import seconds_of_last_run

    old = seconds_of_last_run(output)
    kept = {(study.name, column) for study in studies for column in (THEORY, *(one.name for one in engines))}
    if {one.name for one in everything if not one.only} <= {study for study, _ in old} and old.keys() - kept:
        raise ValueError(
            f"{output} contains a full report; choose another --output, or replace the report with --replace"
        )


def _run(studies: tuple[Study, ...], engines: tuple[Engine, ...], output: Path, **options: Any) -> Run:
    """Measure the studies and show the progress, with the durations of the last report."""
    from compare.report.results_json import seconds_of_last_run
    from compare.run.runner import run
    from reference_model.simulation import prepare

    prepare()
    expected = seconds_of_last_run(output, Path(FULL))
    with measurements() as progress:
        more = options | {"folder": store_of(output), "expected": expected, "progress": progress}
        return run(studies, engines, **more)


def _write(result: Run, output: Path) -> Matrix:
    """Write the report without interruption by Ctrl-C."""
    from compare.report.write import write_report
    from compare.run.interrupts import postponed

    with postponed():
        return write_report(result, output)


def _print_results(
    result: Run, matrix: Matrix, engines: Iterable[Engine], index: Path, with_numbers: bool
) -> None:
    with printing():
        if with_numbers:
            _print_numbers(matrix)
        _print_summary(result, matrix, index)
    if not result.interrupted:
        _print_diagnoses(engines, matrix)


def _print_numbers(matrix: Matrix) -> None:
    from compare.report.numbers import account

    for claim in matrix.claims:
        print(f"{claim.engine} {claim.verdict.value}: {account(claim)}")


def _print_diagnoses(engines: Iterable[Engine], matrix: Matrix) -> None:
    from compare.diagnosis.run import in_short
    from compare.report.matrix import State

    counts = ((engine, matrix.count(engine.name)) for engine in engines)
    for line in in_short(engine for engine, of in counts if of[State.DIFFERS] or of[State.FAILED]):
        with printing():
            print(line)


def _status(result: Run, matrix: Matrix, least_conclusive: int, named: Collection[str]) -> int:
    from compare.report.matrix import State

    if result.interrupted:
        missing = _listed([f"{study} {column}" for study, column in result.missing]) or "figures"
        return say(
            f"Interrupted; still missing: {missing}. Repeat the command with --resume to complete the report.",
            INTERRUPTED,
        )
    if matrix.totals[State.DIFFERS] or matrix.totals[State.FAILED] or _failures(_evidence(result)):
        return SOMETHING_DIFFERS
    if short := "; ".join(
        f"{name}: {share.in_words('claim')}"
        for name in result.engines
        if not (share := result.share(name)).enough and (share.of or name in named)
    ):
        return say(f"too little to show anything: {short}", NOTHING_SHOWN)
    conclusive = matrix.totals[State.AGREES] - matrix.of_evidence("algebra")[State.AGREES]
    if conclusive < least_conclusive:
        return say(
            f"{conclusive} claims agree, but --min-conclusive requires {least_conclusive}", NOTHING_SHOWN
        )
    return FINE


def _print_summary(result: Run, matrix: Matrix, index: Path) -> None:
    from compare.report.matrix import State, failure_of
    from compare.report.page import summary

    lines = []
    for row in matrix.rows:
        for column, cell in row.cells.items():
            line = f"{row.study.name} {column} {cell.state.value}"
            if cell.state is State.FAILED:
                lines.append(f"{line}: {failure_of(result, row.study.name, column, row.sentence)}")
            elif cell.state is State.NOT_SIMULATED or (
                cell.state is State.MISSING and not result.interrupted
            ):
                lines.append(f"{line}: {cell.reason}")
            elif cell.state in (State.DIFFERS, State.INCONCLUSIVE):
                lines.append(f"{line}: {row.sentence}")
    for line in dict.fromkeys(lines):  # one reason may apply to all claims of a study
        print(line)
    for what, failure in _failures(_figures(result) | _evidence(result)).items():
        print(f"{what}: {failure}")
    for name in () if result.interrupted else result.engines:
        print(f"{name}: {result.share(name).in_words('claim')}")
    print(f"{summary(matrix)} ({index})")


def _listed(names: Sequence[str]) -> str:
    more = f" and {len(names) - MOST_LISTED} more" if len(names) > MOST_LISTED else ""
    return ", ".join(names[:MOST_LISTED]) + more


def _failures(work: Mapping[str, object]) -> dict[str, Failure]:
    from compare.run.workers import Failure

    return {name: value for name, value in work.items() if isinstance(value, Failure)}


def _figures(result: Run) -> dict[str, object]:
    """Return the drawings; a drawing that fails does not affect verdicts."""
    return {f"{name}: the figures could not be drawn": drawing for name, drawing in result.drawings.items()}


def _evidence(result: Run) -> dict[str, object]:
    return {
        f"errata: no evidence for {result.errata[i].equation}": evidence
        for i, evidence in result.evidence.items()
    }


# --- A single claim of a study


def with_claim(studies: Sequence[Study], identity: str) -> Study:
    """Return the study of the claim ``identity``, for example "fig06/rests", without its other claims and figures.

    Raises ``ValueError`` if no study declares it.
    """
    found = {
        declared.identity(study.name, case): (study, declared, case)
        for study in studies
        for declared in study.declared
        for case, _ in declared.cases()
    }
    name, _, _ = identity.partition("/")
    one_of("study", name, [study.name for study in studies])
    study, declared, case = found[
        one_of("claim", identity, (one for one in found if one.startswith(f"{name}/")))
    ]
    alone = replace(declared, each={case: declared.each[case]}) if declared.each else declared
    return replace(study, prose=replace(study.prose, finding="", figures={}), declared=[alone], provided={})
