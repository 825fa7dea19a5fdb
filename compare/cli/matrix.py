"""``friction-discs matrix``: friction laws and convergence of engines."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from compare.cli.command import (
    FINE,
    INTERRUPTED,
    NOTHING_SHOWN,
    SOMETHING_DIFFERS,
    BadInputError,
    measurements,
    printing,
    refused,
    say,
)
from compare.cli.options import Folder, Jobs, Seed, check_folder, cores, positive
from compare.cli.report import Engines

if TYPE_CHECKING:
    from compare.diagnosis.row import Row
    from compare.engines import Engine

Limit = Annotated[
    float,
    typer.Option(
        metavar="SECONDS",
        help="Limit of processor time in s for each part of an engine's row.",
        parser=positive("limit", "s"),
    ),
]
Recorded = Annotated[
    bool,
    typer.Option("--recorded", help="Also show the recorded results of other engines."),
]

Benchmark = Annotated[
    bool,
    typer.Option("--benchmark", help="Run the friction benchmark instead: closed-form cases, with a score."),
]

LIMIT = 60.0


def matrix(
    engine: Engines = None,
    limit: Limit = LIMIT,
    recorded: Recorded = False,
    benchmark: Benchmark = False,
    seed: Seed = None,
    output: Folder = Path("matrix"),
    jobs: Jobs = None,
) -> int:
    """Identify the friction laws of engines and their convergence.

    The command first prints the motions of a sliding and a resting block next to the exact numbers, which exposes a
    broken adapter. Short motions then identify the law: blocks and discs that slide at many masses, loads and speeds,
    blocks that are pulled from rest, and joints that turn, hold and break away. The recorded motions follow. The
    command writes matrix.json after each row, and at the end matrix.png and, if a law is wrong, friction.png.

    The exit status is 0 if at least half of the parts were measured and the engine is right, even if only with
    smaller steps. It is 1 if the engine is wrong or failed, 2 for bad input, 3 if less was measured or the verdict is
    open, and 130 after Ctrl-C.

    \b
    Examples:
      friction-discs matrix --engine reference --engine exudyn --recorded
    """
    from compare.diagnosis.row import Row, write_pictures, write_rows
    from compare.diagnosis.run import checked, diagnosed, recorded_rows
    from compare.run.runner import loaded
    from compare.run.workers import Workers

    if benchmark and recorded:
        raise BadInputError("--recorded: the benchmark has no recorded results; omit it")
    with refused(), Workers(1, limit) as workers:
        chosen = loaded(engine or [], workers, seed)
        check_folder(output)
        found = list(_first_look(checked(chosen, workers)))
    broken = [one for one in found if isinstance(one, Row)]
    chosen = tuple(one for one in found if not isinstance(one, Row))
    if benchmark:
        return _benchmark(chosen, _status(broken), limit, output)
    rows: list[Row] = list(recorded_rows()) if recorded else []
    others = len(rows)
    if broken:
        rows += broken
        write_rows(rows, output)
    try:
        with measurements() as progress:
            for row in diagnosed(chosen, jobs=jobs or cores(), limit=limit, progress=progress):
                rows.append(row)
                write_rows(rows, output)
                with printing():
                    _print_row(row)
    except KeyboardInterrupt:
        done = len(rows) - others - len(broken)
        return say(f"Interrupted; {done} of {len(chosen)} rows were written to {output}.", INTERRUPTED)
    pictures = write_pictures(rows, output)
    with printing():
        _print_table(rows)
        for picture in pictures:
            print(picture)
    return _status(rows[others:])


def _status(rows: Sequence[Row]) -> int:
    """Return the exit status for the verdicts of the measured rows, and say which are open."""
    from compare.diagnosis.row import UNDECIDED

    if any(row.wrong for row in rows):
        return SOMETHING_DIFFERS
    open_ = [f"{row.engine} ({row.share.in_words('part')})" for row in rows if row.verdict == UNDECIDED]
    return say(f"undecided: {', '.join(open_)}", NOTHING_SHOWN) if open_ else FINE


def _first_look(checked: Iterable[tuple[Engine, str | Row]]) -> Iterator[Engine | Row]:
    """Print how two blocks move; yield each engine, or its row if it has no result."""
    for engine, found in checked:
        if not isinstance(found, str):
            _print_row(found)
            yield found
            continue
        if found:
            print(f"{engine.name}: {found}", flush=True)
        yield engine


def _benchmark(engines: Sequence[Engine], broken: int, limit: float, output: Path) -> int:
    from compare.diagnosis.friction_benchmark import status
    from compare.diagnosis.run import benchmarked
    from compare.engines import owner_of
    from compare.output.text_files import write_text
    from compare.run.workers import Failure, Workers

    found, statuses = {}, {broken}
    with Workers(1, limit) as workers:
        for engine in engines:
            results = workers.ask(benchmarked, engine, owner=owner_of(engine))
            if isinstance(results, Failure):
                statuses.add(NOTHING_SHOWN if results.unfinished else SOMETHING_DIFFERS)
                print(f"{engine.name}: no result: {results}", flush=True)
                continue
            found[engine.name] = results
            statuses.add(status(results))
            with printing():
                _print_benchmark(engine.name, results)
            write_text(output / "benchmark.json", json.dumps(found, indent=1, ensure_ascii=False))
    return next(one for one in (SOMETHING_DIFFERS, NOTHING_SHOWN, FINE) if one in statuses)


def _print_benchmark(name: str, results: dict[str, Any]) -> None:
    from rich.console import Console
    from rich.table import Table

    table = Table("case", "expected", "found", "error", "grade", title=name, highlight=False)
    for case in results["cases"]:
        numbers = ("" if number is None else f"{number:.6g}" for number in (case["expected"], case["value"]))
        error = "" if case["error"] is None else f"{case['error']:.1g}"
        table.add_row(case["name"], *numbers, error, case["grade"])
    Console(highlight=False).print(table)
    print(", ".join(f"{number} {grade}" for grade, number in results["score"].items()))


def _print_row(row: Row) -> None:
    print(f"{row.engine} {row.version}".rstrip())
    for sentence in row.sentences:
        print(f"  {sentence}")
    print(f"  {row.share.in_words('part')}")


def _print_table(rows: Sequence[Row]) -> None:
    from rich.console import Console
    from rich.table import Table

    from compare.diagnosis.findings import MOTIONS, heading

    names = [name for name in MOTIONS if any(name in row.motions for row in rows)]
    if not names:
        return
    table = Table("engine", *map(heading, names), highlight=False)
    for row in rows:
        table.add_row(row.engine, *(_cell(row, name) for name in names))
    Console(highlight=False).print(table)
    print(
        "Largest error in m ± its bar, estimated from the changes between refinements. ✓ the bar explains the error; "
        "✗ it does not; ? the bar exceeds a tenth of the effect of another friction law; ! no result"
    )


def _cell(row: Row, name: str) -> str:
    if name not in row.motions:
        return "!" if name in row.gaps else ""
    motion = row.motions[name]
    return f"{motion.mark} {motion.error:.0e} ± {motion.estimate:.0e}"
