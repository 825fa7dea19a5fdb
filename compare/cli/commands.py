"""The command line: ``friction-discs list | report | judge | simulate | sweep | errata``.

Whatever a user gets wrong ends in one sentence on the error stream and exit status 2. Heavy imports (SciPy,
Exudyn, matplotlib) happen inside of the commands that need them.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

try:
    import typer

    from compare.cli.options import (
        BAD_INPUT,
        FINE,
        INTERRUPTED,
        MOST_JOBS,
        MOST_SAMPLES,
        SOMETHING_DIFFERS,
        BadInputError,
        Command,
        EngineFailedError,
        InterruptedByUserError,
        Settings,
        Tolerance,
        changed,
        check_folder,
        close_output,
        cores,
        count,
        positive,
        printing,
        refused,
        say,
    )
    from compare.cli.sweep import sweep
    from compare.text_files import check_writable, replacing
except KeyboardInterrupt:  # which may come before there is anything that could take it
    print("Interrupted.", file=sys.stderr)
    sys.exit(130)

if TYPE_CHECKING:
    from compare.claims.study import Study
    from compare.judge.faults import Fault
    from compare.judge.outcome import Judged
    from compare.report.matrix import Matrix
    from compare.run.runner import Run
    from compare.run.workers import Failure
    from reference_model.systems import System

MOST_LISTED = 10
"""Measurements that a sentence names."""

app = typer.Typer(
    name="friction-discs",
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def main(arguments: Sequence[str] | None = None, studies: tuple[Study, ...] | None = None) -> None:
    """Run the command line and exit with its status.

    ``studies`` takes the place of the paper's own, for a project that brings its own studies and engines.
    """
    if sys.stdout is None:  # closed by the caller
        sys.stdout = open(os.devnull, "w")  # noqa: SIM115
    sys.exit(status(sys.argv[1:] if arguments is None else arguments, studies))


def status(arguments: Sequence[str], studies: tuple[Study, ...] | None = None) -> int:
    """Run the command line and return its exit status."""
    # public names only: typer brings its own copy of click or takes the installed one
    usage_error: type[Exception] = typer.BadParameter.__mro__[1]
    try:
        with printing():
            result = app(list(arguments), standalone_mode=False, obj=studies, prog_name="friction-discs")
    except (BadInputError, usage_error) as error:
        message = error.format_message() if hasattr(error, "format_message") else str(error)
        return say(" ".join(message.split()), BAD_INPUT)
    except EngineFailedError as error:
        return say(str(error), SOMETHING_DIFFERS)
    except MemoryError:
        return say("there is not enough memory", SOMETHING_DIFFERS)
    except SystemExit as end:
        if not isinstance(end.__context__, BrokenPipeError):  # which typer ends with status 1
            raise
        close_output()
        return FINE
    except OSError as error:
        close_output()
        return say(f"can't write to {error.filename or 'the output'}: {error.strerror}", BAD_INPUT)
    except (KeyboardInterrupt, InterruptedByUserError, typer.Abort):
        return say("Interrupted.", INTERRUPTED)
    return result if isinstance(result, int) else FINE


@app.callback(invoke_without_command=True)
def friction_discs(
    context: typer.Context,
    version: Annotated[bool, typer.Option("--version", help="Print the version.")] = False,
) -> None:
    """Compare two simulations of friction discs with each other and with every formula of the paper.

    \b
    Examples:
      friction-discs list
      friction-discs report
      friction-discs judge
      friction-discs simulate pin --set disc_speed=2 --until 100 --output pin.csv
      friction-discs simulate disc --set contact_points=6 --output disc.json
      friction-discs sweep basin pin
      friction-discs errata
    """
    if version:
        from compare.run.stamp import version_of

        print(f"friction-discs {version_of('friction-discs')}")
    elif context.invoked_subcommand is None:
        print(context.get_help())


@app.command("list", cls=Command)
def list_studies(context: typer.Context) -> None:
    """List the studies and the engines.

    \b
    Example:
      friction-discs list
    """
    from compare.engines import engines, on_request

    studies = _studies(context, [])
    width = max((len(study.name) for study in studies), default=0)
    usual, others = (", ".join(engine.name for engine in some) for some in (engines(), on_request()))
    print("Studies:")
    for study in studies:
        print(f"  {study.name:{width}}  {study.title}")
    print(f"Engines: {usual}; on request {others}")


@app.command(cls=Command)
def report(
    context: typer.Context,
    names: Annotated[
        list[str] | None,
        typer.Argument(metavar="STUDY", help="Studies to run; all without any.", show_default=False),
    ] = None,
    engine: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME",
            help="Engine to measure, several times for several; all without any. "
            "MODULE:FUNCTION takes a simulate() of your own.",
            show_default=False,
        ),
    ] = None,
    output: Annotated[Path, typer.Option(metavar="DIR", help="Folder for the report.")] = Path("report"),
    jobs: Annotated[
        str | None, typer.Option(metavar="N", help="Number of processes.", show_default="one for each core")
    ] = None,
    resume: Annotated[
        bool,
        typer.Option(
            "--resume",
            help="Keep what the same code and libraries have already measured there. "
            "Files of data that an engine of your own reads are not looked at.",
        ),
    ] = False,
) -> int:
    """Measure the claims of the studies and write index.html, results.json, junit.xml and the figures.

    The exit status is 0 when nothing differs, 1 when a claim differs or an engine failed, 2 on bad input, and
    130 after Ctrl-C; the report then holds what was finished, and --resume does the rest.

    \b
    Examples:
      friction-discs report
      friction-discs report fig03 fig05 --engine exudyn --output fig
    """
    from compare.engines import engines

    studies = _studies(context, names or [])
    with refused():
        chosen = engines(dict.fromkeys(engine or []))
        processes = cores() if jobs is None else count("jobs", jobs, 1, MOST_JOBS)
        check_folder(output)

    from compare.claims.errata import ERRATA
    from compare.report.write import write_report
    from compare.run.runner import run
    from compare.run.workers import interrupts_ignored

    with _progress() as progress:
        result = run(
            studies,
            chosen,
            folder=output / "data",
            jobs=processes,
            resume=resume,
            errata=ERRATA if context.obj is None and not names else (),  # part of the whole paper only
            progress=progress,
        )
    if resume:
        _tell_unknown(result.unknown)
    with interrupts_ignored():  # a second or so, and then nothing is half written
        matrix = write_report(result, output)
    with printing():
        _print_summary(result, matrix, output / "index.html")
    if result.interrupted:
        missing = _listed([f"{study} {column}" for study, column in result.missing]) or "figures"
        return say(
            f"Interrupted; missing: {missing}. The same command with --resume completes it.", INTERRUPTED
        )
    return SOMETHING_DIFFERS if _wrong(result, matrix) else FINE


@app.command(cls=Command)
def judge(
    context: typer.Context,
    names: Annotated[
        list[str] | None,
        typer.Argument(metavar="FAULT", help="Faults to measure; all without any.", show_default=False),
    ] = None,
    study: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME",
            help="Study to measure them with, several times for several.",
            show_default="trajectories and sticking-domain",
        ),
    ] = None,
    output: Annotated[Path, typer.Option(metavar="DIR", help="Folder for the result.")] = Path("judge"),
    jobs: Annotated[
        str | None, typer.Option(metavar="N", help="Number of processes.", show_default="one for each core")
    ] = None,
    resume: Annotated[
        bool,
        typer.Option("--resume", help="Keep what the same version of everything has already measured there."),
    ] = False,
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
        processes = cores() if jobs is None else count("jobs", jobs, 1, MOST_JOBS)
        check_folder(output)

    from compare.judge.judge import STUDIES, write_judged
    from compare.judge.judge import judge as measure_faults
    from compare.run.workers import interrupts_ignored

    with _progress() as progress:
        judged = measure_faults(
            faults,
            RIGHT,
            _studies(context, study or STUDIES),
            folder=output / "data",
            whole=not names,
            jobs=processes,
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


simulate = typer.Typer(rich_markup_mode=None)
app.add_typer(simulate, name="simulate")
app.add_typer(sweep, name="sweep")

EngineName = Annotated[str, typer.Option("--engine", metavar="NAME", help="Engine that simulates.")]
PinState = Annotated[
    tuple[str, str, str, str],
    typer.Option(metavar="X Y VX VY", help="Position in m and velocity in m/s at time 0."),
]
DiscState = Annotated[
    tuple[str, str, str, str, str, str],
    typer.Option(
        metavar="X Y ANGLE VX VY SPIN",
        help="Position in m, angle in rad, velocity in m/s and spin in rad/s at time 0.",
    ),
]
Until = Annotated[str, typer.Option(metavar="T", help="Last time in s.")]
Samples = Annotated[str, typer.Option(metavar="N", help="Number of times from 0 to T, >= 2.")]
File = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE", help="File to write, .csv or .json.", show_default="csv on the standard output"
    ),
]


@simulate.callback()
def simulate_system() -> None:
    """Simulate a system and write its motion.

    \b
    Examples:
      friction-discs simulate pin --output whirl.json
      friction-discs simulate disc --help
    """


@simulate.command("pin", cls=Command)
def simulate_pin(
    engine: EngineName = "reference",
    settings: Settings = None,
    start: PinState = ("0.1", "0", "0.03", "0"),
    until: Until = "400",
    samples: Samples = "4001",
    tolerance: Tolerance = "1e-9",
    output: File = None,
) -> None:
    """Simulate a pin and write its motion; what is not set is the second case of Fig. 5.

    \b
    Parameters, with their values in Fig. 5:
      mass=1 stiffness=1 damping=0.1 friction_force=0.09 disc_speed=1.5 offset=0.1
      hardening=0 stop_gap=0 stop_stiffness=0
    \b
    Examples:
      friction-discs simulate pin --output whirl.json
      friction-discs simulate pin --engine exudyn --set disc_speed=1.2 --set friction_force=0.05
          --start 0.1 0 -0.02 0 --until 100 --samples 1001 --output pin.csv
    """
    from compare.claims.paper_parameters import FIG5

    _simulate(FIG5, engine, settings or [], start, until, samples, tolerance, output)


@simulate.command("disc", cls=Command)
def simulate_disc(
    engine: EngineName = "reference",
    settings: Settings = None,
    start: DiscState = ("0.02", "0", "0", "0", "0", "1.3"),
    until: Until = "400",
    samples: Samples = "4001",
    tolerance: Tolerance = "1e-9",
    output: File = None,
) -> None:
    """Simulate a friction disc and write its motion; what is not set is Fig. 11 with X0 = 0.

    \b
    Parameters, with their values in Fig. 11; contact_points=none is the continuous ring:
      mass=1 polar_inertia=1 stiffness=1 damping=0.5 friction_force=0.0225 disc_speed=1.5 offset=0
      contact_radius=0.12 shaft_damping=0.015 shaft_speed=1.25 contact_points=none
      hardening=0 stop_gap=0 stop_stiffness=0
    \b
    Examples:
      friction-discs simulate disc --output modulated.csv
      friction-discs simulate disc --engine exudyn --set contact_points=6 --set disc_speed=2
          --start 0.1 0 0 0 0 1.2 --until 100 --samples 1001 --output disc.json
    """
    from compare.claims.paper_parameters import FIG11

    _simulate(FIG11, engine, settings or [], start, until, samples, tolerance, output)


def _simulate(
    paper: System,
    engine: str,
    settings: Sequence[str],
    start: Sequence[str],
    until: str,
    samples: str,
    tolerance: str,
    output: Path | None,
) -> None:
    """Simulate ``paper`` with its changes ``settings`` and write the motion to a file or standard output."""
    import numpy as np

    from compare.cli.trajectory_files import write_csv, writer
    from compare.engines import UnsupportedSystemError, engines
    from reference_model.systems import checked_state, checked_tolerance, finite_number

    with refused():
        (chosen,) = engines([engine])
        system = changed(paper, settings)
        if missing := chosen.lacking([system]):
            raise UnsupportedSystemError(missing)
        state = checked_state(system, [finite_number("start", value) for value in start])
        accuracy = checked_tolerance(finite_number("tolerance", tolerance))
        times = np.linspace(0.0, positive("until", until, "s"), count("samples", samples, 2, MOST_SAMPLES))
        write = write_csv if output is None else writer(output)
        if output is not None:
            _check_file(output)
    try:
        trajectory = chosen.simulate(system, state, times, tolerance=accuracy)
    except Exception as error:  # whatever an engine raises
        raise EngineFailedError(_failed(chosen.name, error)) from error
    if output is None:
        with printing():
            write(trajectory, chosen.name, sys.stdout)
        return
    try:
        with replacing(output) as stream:
            write(trajectory, chosen.name, stream)
    except OSError as error:
        raise BadInputError(_unwritable(output, error)) from None


def _failed(engine: str, error: Exception) -> str:
    """Return what an engine raised: a sentence of its own, or which exception and where in its code."""
    from compare.run.workers import failure

    if isinstance(error, RuntimeError | ValueError) and str(error):
        return str(error)
    failed = failure(error)
    return f"engine {engine!r} failed: {failed.reason} ({failed.where[-1]})"


def _unwritable(path: Path, error: OSError) -> str:
    return f"can't write the file {str(path)!r}: {error.strerror}"


@app.command(cls=Command)
def errata() -> None:
    """Print where the paper's formulas are wrong, their corrections, and the numbers that show it.

    \b
    Example:
      friction-discs errata
    """
    from compare.claims.errata import ERRATA
    from compare.report.numbers import error_text, value_text

    for erratum in ERRATA:
        evidence = erratum.evidence()
        nearest = abs(evidence.corrected_value - evidence.exact)
        print(erratum.heading)
        print(f"  printed    {erratum.printed}")
        print(f"  correct    {erratum.correct}")
        print(f"  {erratum.explanation}")
        print(f"  {evidence.quantity}: exact {value_text(evidence.exact, nearest)}")
        for name, value in (("printed", evidence.printed_value), ("corrected", evidence.corrected_value)):
            print(
                f"    {name:9}  {value_text(value, nearest)}, error {error_text(abs(value - evidence.exact))}"
            )
        print()


def _studies(context: typer.Context, names: Sequence[str]) -> tuple[Study, ...]:
    from compare.studies import STUDIES, studies

    with refused():
        return studies(names, STUDIES if context.obj is None else context.obj)


def _faults(names: Sequence[str]) -> tuple[Fault, ...]:
    """Return the faults of the given names in the order of the catalogue, or all; raise ``ValueError`` for others."""
    from compare.engines import known
    from compare.judge.faults import FAULTS

    wanted = {known("fault", name, [fault.name for fault in FAULTS]) for name in names}
    return tuple(fault for fault in FAULTS if fault.name in wanted or not wanted)


def _check_file(path: Path) -> None:
    """Raise ``ValueError`` if ``path`` can't be written; leave what is there as it is."""
    try:
        check_writable(path)
    except OSError as error:
        raise ValueError(_unwritable(path, error)) from None


@contextmanager
def _progress() -> Iterator[Callable[[int, int, str], None]]:
    """Show a progress bar on a terminal, and nothing at all elsewhere."""
    if not sys.stderr.isatty():
        yield lambda done, total, name: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (BarColumn(), MofNCompleteColumn(), TimeElapsedColumn(), TextColumn("{task.description}"))
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("")
        yield lambda done, total, name: bar.update(task, completed=done, total=total, description=name)


def _print_summary(result: Run, matrix: Matrix, index: Path) -> None:
    """Print a line for all that is no agreement, and the totals."""
    from compare.report.matrix import State
    from compare.report.page import summary

    for group in matrix.groups:
        for row in group.rows:
            for column, cell in row.cells.items():
                if cell.state is State.NOT_SIMULATED:
                    if group.first_with(column, cell.reason) is row:  # the same for all rows of the study
                        print(f"{group.study.name} {column} not simulated: {cell.reason}")
                elif cell.state not in (State.AGREES, State.MISSING):  # what is missing is said at the end
                    reason = f": {cell.reason}" if cell.reason else ""
                    print(f"{group.study.name} {column} {cell.state.value}: {row.sentence}{reason}")
    for what, failure in _failures(result).items():
        print(f"{what}: {failure.reason}")
    print(f"{summary(matrix)} ({index})")


def _listed(names: Sequence[str]) -> str:
    more = f" and {len(names) - MOST_LISTED} more" if len(names) > MOST_LISTED else ""
    return ", ".join(names[:MOST_LISTED]) + more


def _tell_unknown(unknown: Mapping[str, str]) -> None:
    """Say what could not be taken from an earlier run, and why."""
    for name, reason in unknown.items():
        say(f"{name} is measured anew, since what it depends on can't be seen: {reason}", FINE)


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


def _failures(result: Run) -> dict[str, Failure]:
    """Return what failed besides the measurements, by a name that can be printed."""
    from compare.run.workers import Failure

    work: dict[str, object] = {
        f"{name}: the figures could not be drawn": drawing for name, drawing in result.drawings.items()
    }
    work |= {
        f"errata: no evidence for {result.errata[i].equation}": evidence
        for i, evidence in result.evidence.items()
    }
    return {name: value for name, value in work.items() if isinstance(value, Failure)}


def _wrong(result: Run, matrix: Matrix) -> bool:
    from compare.report.matrix import State

    return bool(matrix.totals[State.DIFFERS] or matrix.totals[State.FAILED] or _failures(result))


if __name__ == "__main__":
    main()
