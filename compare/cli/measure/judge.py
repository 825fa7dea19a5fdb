"""``friction-discs judge``: engines with one fault each, and the claims that catch it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from compare.cli.door.command import FINE, INTERRUPTED, SOMETHING_DIFFERS, printing, refused, say
from compare.cli.door.options import Folder, Jobs, Resume, check_folder, cores, studies_of
from compare.cli.door.progress import measurements

if TYPE_CHECKING:
    from compare.judge.faults import Fault
    from compare.judge.outcome import Judged

Names = Annotated[
    list[str] | None,
    typer.Argument(metavar="FAULT", help="Faults to measure; all without any.", show_default=False),
]
Studies = Annotated[
    list[str] | None,
    typer.Option(
        metavar="NAME",
        help="Study to measure them with, several times for several.",
        show_default="trajectories and sticking-domain",
    ),
]


def judge(
    context: typer.Context,
    names: Names = None,
    study: Studies = None,
    output: Folder = Path("judge"),
    jobs: Jobs = None,
    resume: Resume = False,
) -> int:
    """Measure engines with one fault each, to see which claims catch it; write judge.html and judge.json.

    Without FAULT right engines are measured with random parameters besides, and the smallest error of each
    parameter that is noticed is found. The exit status is 0 when each fault that changes the physics is caught by
    trajectories and by a claim of another kind and every right engine passes, 1 otherwise, 2 on bad input, and 130
    after Ctrl-C.

    \b
    Examples:
      friction-discs judge
      friction-discs judge moment-of-wrong-sign --study trajectories --study power-balance
    """
    from compare.judge.faults import RIGHT

    with refused():
        faults = _faults(names or [])
        check_folder(output)

    from compare.judge.judge import STUDIES, write_judged
    from compare.judge.judge import judge as measure_faults
    from compare.run.workers import interrupts_ignored

    with measurements() as progress:
        judged = measure_faults(
            faults,
            RIGHT,
            studies_of(context, study or STUDIES),
            folder=output / "data",
            whole=not names,
            jobs=jobs or cores(),
            resume=resume,
            progress=progress,
        )
    with interrupts_ignored():
        write_judged(judged, output)
    with printing():
        _print_judged(judged, output / "judge.html")
    if judged.interrupted:
        return say("Interrupted. The same command with --resume completes it.", INTERRUPTED)
    return FINE if judged.good else SOMETHING_DIFFERS


def _faults(names: Sequence[str]) -> tuple[Fault, ...]:
    """Return the faults of the given names in the order of the catalogue, or all; raise ``ValueError`` for others."""
    from compare.engines import one_of
    from compare.judge.faults import FAULTS

    wanted = {one_of("fault", name, [fault.name for fault in FAULTS]) for name in names}
    return tuple(fault for fault in FAULTS if fault.name in wanted or not wanted)


def _print_judged(judged: Judged, page: Path) -> None:
    """Print a table of what caught each fault, and the totals."""
    from rich.console import Console
    from rich.table import Column, Table

    from compare.judge.page import summary

    fault = Column("fault", overflow="fold")  # names have no spaces to break at
    table = Table(fault, "trajectories", "other claims", "verdict", highlight=False)
    for judgement in (*judged.right, *judged.faults):
        kinds = dict.fromkeys(
            kind for catch in judgement.by_others for kind in catch.kinds if kind != "trajectory"
        )
        others = f"{len(judgement.by_others)} ({', '.join(kinds)})" if kinds else "0"
        table.add_row(judgement.name, str(len(judgement.by_trajectory)), others, judgement.outcome.value)
    Console(highlight=False).print(table)
    print(f"{summary(judged)} ({page})")
