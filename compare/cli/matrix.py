"""``friction-discs matrix``: friction laws and convergence of engines."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from compare.cli.command import (
    FINE,
    INTERRUPTED,
    NOTHING_MEASURED,
    NOTHING_SHOWN,
    SOMETHING_DIFFERS,
    measurements,
    printing,
    refused,
    say,
)
from compare.cli.options import Folder, Jobs, check_folder, cores, positive
from compare.cli.report import Engines

if TYPE_CHECKING:
    from compare.diagnosis.row import Row

Limit = Annotated[
    float,
    typer.Option(
        metavar="SECONDS",
        help="Time limit in s for each part of an engine's row.",
        parser=positive("limit", "s"),
    ),
]
Recorded = Annotated[
    bool,
    typer.Option("--recorded", help="Also show the recorded results of other engines."),
]

LIMIT = 60.0
"""Default of ``--limit`` in s."""


def matrix(
    engine: Engines = None,
    limit: Limit = LIMIT,
    recorded: Recorded = False,
    output: Folder = Path("matrix"),
    jobs: Jobs = None,
) -> int:
    """Identify the friction laws of engines and their convergence.

    Short motions identify the law within seconds: blocks and discs that slide at many masses, loads and speeds, and
    blocks that are pulled from rest. The motions of the recorded engines follow. All have four steps or tolerances.
    The command prints findings for each engine, with the verdict first, and a table. It writes matrix.json after each
    row, then matrix.png, and friction.png with the measured forces if a law is wrong, both also as svg.

    The exit status is 0 if an engine is right, which includes errors that vanish with smaller steps, and 1 if it is
    wrong. It is 2 for bad input, and 3 if the verdict is open or a part was not finished in time. It is 4 if an
    engine simulates none of these motions, and 130 after Ctrl-C.

    \b
    Examples:
      friction-discs matrix --engine reference
      friction-discs matrix --engine reference --engine exudyn --recorded
    """
    from compare.run.runner import loaded
    from compare.run.workers import Workers

    with refused(), Workers() as workers:
        chosen = loaded(engine or [], workers)
        check_folder(output)

    from compare.diagnosis.row import UNDECIDED, write_pictures, write_rows
    from compare.diagnosis.run import diagnosed, recorded_rows

    rows: list[Row] = list(recorded_rows()) if recorded else []
    others = len(rows)
    try:
        with measurements() as progress:
            for row in diagnosed(chosen, jobs=jobs or cores(), limit=limit, progress=progress):
                rows.append(row)
                write_rows(rows, output)
                with printing():
                    _print_row(row)
    except KeyboardInterrupt:
        done = len(rows) - others
        return say(f"Interrupted; {done} of {len(chosen)} rows were written to {output}.", INTERRUPTED)
    pictures = write_pictures(rows, output)
    with printing():
        _print_table(rows)
        print(*pictures, sep="\n")
    if any(row.wrong for row in rows[others:]):
        return SOMETHING_DIFFERS
    empty = [row.engine for row in rows[others:] if row.empty]
    if empty:
        return say(
            f"nothing was measured: none of these motions can be simulated by {', '.join(empty)}",
            NOTHING_MEASURED,
        )
    open_ = [row.engine for row in rows[others:] if row.verdict == UNDECIDED]
    return say(f"undecided: {', '.join(open_)}", NOTHING_SHOWN) if open_ else FINE


def _print_row(row: Row) -> None:
    print(f"{row.engine} {row.version}".rstrip())
    for sentence in row.sentences:
        print(f"  {sentence}")


def _print_table(rows: Sequence[Row]) -> None:
    from rich.console import Console
    from rich.table import Table

    from compare.diagnosis.findings import MOTIONS

    names = [name for name in MOTIONS if any(name in row.motions for row in rows)]
    table = Table(
        "engine",
        *names,
        caption="Error in m ± the engine's own estimate. ✓ the estimate explains the error; ✗ it does not; "
        "? the estimate is too large to distinguish friction laws; ! no result",
        highlight=False,
    )
    for row in rows:
        table.add_row(row.engine, *(_cell(row, name) for name in names))
    Console(highlight=False).print(table)


def _cell(row: Row, name: str) -> str:
    if name not in row.motions:
        return "!" if name in row.gaps else ""
    motion = row.motions[name]
    mark = "✗" if not motion.converges else "✓" if motion.conclusive else "?"
    return f"{mark} {motion.error:.0e} ± {motion.estimate:.0e}"
