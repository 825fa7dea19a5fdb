"""The command line: ``friction-discs list | report | diff | matrix | simulate | sweep | ...``.

A user's mistake ends in one sentence on the error stream and exit status 2. Commands import heavy libraries (SciPy,
Exudyn, matplotlib) themselves.
"""

from __future__ import annotations

import codecs
import io
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from compare.cli.command import (
    BAD_INPUT,
    FINE,
    INTERRUPTED,
    SOMETHING_DIFFERS,
    BadInputError,
    Command,
    EngineFailedError,
    InterruptedByUserError,
    Program,
    close_output,
    printing,
    say,
)
from compare.cli.diff import diff
from compare.cli.export_fmu import export_fmu
from compare.cli.matrix import matrix
from compare.cli.options import studies_of
from compare.cli.plan import plan
from compare.cli.report import FULL, report
from compare.cli.simulate import simulate
from compare.cli.sweep import sweep

if TYPE_CHECKING:
    from compare.claims.study import Study


def list_studies(context: typer.Context) -> None:
    """List studies and engines.

    The list shows the time, level and engines of each study. Times come from the last report in the folder report,
    or are estimates for one engine.

    \b
    Example:
      friction-discs list
    """
    from compare.engines import INSTALLED, engines, on_request
    from compare.engines.registry import packaged
    from compare.report.results_json import seconds_of_last_run

    spent: dict[str, float] = {}
    for (name, _), seconds in seconds_of_last_run(Path(FULL)).items():
        spent[name] = spent.get(name, 0.0) + seconds
    lines = [
        (
            study.name,
            f"{spent.get(study.name, study.seconds):.1f} s",
            "quick" if study.quick else "full",
            ", ".join(study.only) or "every engine",
            study.title,
        )
        for study in studies_of(context, [])
    ]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    print("Studies:")
    for line in lines:
        print("  " + "  ".join(f"{text:{width}}" for text, width in zip(line, widths, strict=True)).rstrip())
    settings = (
        f"{name}:{setting}" if i else name
        for name, known in INSTALLED.items()
        for i, setting in enumerate(known.settings)
    )
    print("Engines:", ", ".join(engine.name for engine in engines()))
    print(
        "Engines on request:", ", ".join([*(engine.name for engine in on_request()), *settings, *packaged()])
    )
    print("Your own engines: MODULE:FUNCTION, exec:COMMAND, files:DIR, fmu:FILE")


def errata() -> None:
    """Print errors in the paper's formulas and their corrections.

    Each correction comes with numerical evidence.

    \b
    Example:
      friction-discs errata
    """
    from compare.claims.errata import ERRATA, TEXT
    from compare.report.numbers import error_text, value_text

    print(f"{TEXT}\n")
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


app = typer.Typer(
    name="friction-discs",
    cls=Program,
    add_completion=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
app.command("list", cls=Command)(list_studies)
for command in (report, diff, matrix, plan, errata):
    app.command(cls=Command)(command)
app.add_typer(export_fmu, name="export-fmu")
app.add_typer(simulate, name="simulate")
app.add_typer(sweep, name="sweep")


def run(arguments: Sequence[str] | None = None, studies: tuple[Study, ...] | None = None) -> None:
    """Run the command line with open streams and exit with its status."""
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:  # closed by the caller, so the next file would receive its number
            setattr(sys, name, open(os.devnull, mode))  # noqa: SIM115
            os.set_inheritable(getattr(sys, name).fileno(), True)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            unset = codecs.lookup(stream.encoding).name == "ascii"  # no locale, such as in a container
            stream.reconfigure(encoding="utf-8" if unset else None, errors="backslashreplace")
    sys.exit(status(sys.argv[1:] if arguments is None else arguments, studies))


def status(arguments: Sequence[str], studies: tuple[Study, ...] | None = None) -> int:
    """Run the command line and return its exit status."""
    # typer exports no base class of usage errors, and may use its own copy of click
    usage_error: type[Exception] = typer.BadParameter.__mro__[1]
    try:
        with printing():
            result = app(list(arguments), standalone_mode=False, obj=studies, prog_name="friction-discs")
    except (BadInputError, usage_error) as error:
        message = error.format_message() if hasattr(error, "format_message") else str(error)
        return say(" ".join(message.split()), BAD_INPUT)
    except EngineFailedError as error:
        return say(str(error), SOMETHING_DIFFERS)
    except ModuleNotFoundError as error:
        if not (error.name or "").startswith("friction-discs["):  # not a missing extra
            raise
        return say(str(error), BAD_INPUT)
    except MemoryError:
        return say("not enough memory", SOMETHING_DIFFERS)
    except SystemExit as end:
        if not isinstance(end.__context__, BrokenPipeError):  # typer turns it into status 1
            raise
        close_output()
        return FINE
    except OSError as error:
        close_output()
        return say(f"cannot write to {error.filename or 'the output'}: {error.strerror}", BAD_INPUT)
    except (KeyboardInterrupt, InterruptedByUserError, typer.Abort):
        return say("Interrupted.", INTERRUPTED)
    return result if isinstance(result, int) else FINE


@app.callback(invoke_without_command=True)
def friction_discs(
    context: typer.Context,
    version: Annotated[bool, typer.Option("--version", help="Print the version.")] = False,
) -> None:
    """Measure how accurately engines simulate dry friction, and simulate friction discs.

    \b
    Examples:
      friction-discs list
      friction-discs report
      friction-discs matrix --engine reference
      friction-discs simulate pin --set disc_speed=2 --until 100 --output pin.csv
      friction-discs sweep basin pin
      friction-discs export-fmu clutch --set plates=4 --output clutch.fmu
      friction-discs errata

    Shell completion: run friction-discs --install-completion once, and open a new shell.
    """
    if version:
        from compare.run.provenance import version_of

        print(f"friction-discs {version_of('friction-discs')}")
    elif context.invoked_subcommand is None:
        print(context.get_help())
