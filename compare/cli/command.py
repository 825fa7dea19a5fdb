"""Errors, exit statuses and progress of all commands."""

from __future__ import annotations

import os
import re
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING, Any

from typer.core import TyperCommand, TyperGroup

from compare.output.outside_text import printable
from compare.run.interrupts import caught
from compare.run.statuses import BAD_INPUT as BAD_INPUT
from compare.run.statuses import FINE as FINE
from compare.run.statuses import INTERRUPTED as INTERRUPTED
from compare.run.statuses import NOTHING_SHOWN as NOTHING_SHOWN
from compare.run.statuses import SOMETHING_DIFFERS as SOMETHING_DIFFERS

if TYPE_CHECKING:
    from compare.sweep.compute.run import Progress


HELD = ExitStack()
"""Folders that the running command writes, see ``check_folder``."""


class BadInputError(Exception):
    """Invalid input; the message says what is wrong and what is allowed."""


class EngineFailedError(Exception):
    """An engine has no result; the message gives the reason."""


class InterruptedByUserError(Exception):
    """The user pressed Ctrl-C; typer would exit without a message."""


class Command(TyperCommand):
    """A command that rejects repeated and empty options."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Parse arguments; raise ``BadInputError`` for an empty or repeated option."""
        values, _, given = self.make_parser(ctx).parse_args(args=list(args))
        for option in given:
            if option.param_type_name != "option" or option.is_flag or option.multiple:  # type: ignore[attr-defined]
                continue
            if values[option.name] == "":
                raise BadInputError(f"{option.opts[0]} '': it must not be empty")
            if given.count(option) > 1:
                raise BadInputError(f"{option.opts[0]} is given {given.count(option)} times; give it once")
        return super().parse_args(ctx, args)

    def get_help(self, ctx: Any) -> str:
        """Return the help without the Python types that typer prints after arguments."""
        return re.sub(r" <(str|path|list\[str\])>", "", super().get_help(ctx))

    def invoke(self, ctx: Any) -> Any:
        """Run the command."""
        with HELD:
            return super().invoke(ctx)


class Program(TyperGroup):
    """All commands."""

    def invoke(self, ctx: Any) -> Any:
        """Run a command; turn Ctrl-C into ``InterruptedByUserError``."""
        try:
            return super().invoke(ctx)
        except KeyboardInterrupt:
            raise InterruptedByUserError from None


@contextmanager
def printing() -> Iterator[None]:
    """Keep the exit status if a reader such as ``head`` closes the pipe early."""
    try:
        yield
        sys.stdout.flush()
    except BrokenPipeError:
        close_output()


def close_output() -> None:
    """Redirect standard output to the null device, so flushing it at exit cannot fail."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


@contextmanager
def refused() -> Iterator[None]:
    """Turn a check's ``ValueError`` into ``BadInputError``; wrap only checks, to hide no bugs."""
    try:
        yield
    except ValueError as error:
        raise BadInputError(str(error)) from None


def say(sentence: str, result: int) -> int:
    """Print a sentence on the error stream; return ``result``."""
    if result == INTERRUPTED:
        caught()
    print(printable(sentence), file=sys.stderr)
    return result


# --- Progress: a bar on a terminal; elsewhere, measurements print a line from time to time.

LINE_INTERVAL = 10.0
"""Time in s between two lines of progress without a terminal."""


@contextmanager
def _bar(*columns: Any) -> Iterator[Callable[..., None]]:
    """Show a bar; the function sets its description and numbers, and forgets the rate on ``restart``."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress

    bar = Progress(BarColumn(), MofNCompleteColumn(), *columns, console=Console(stderr=True), transient=True)
    with bar:
        task = bar.add_task("", total=None, visible=False)

        def show(restart: bool, **numbers: Any) -> None:
            if restart:
                bar.reset(task, total=numbers["total"], completed=numbers["completed"])
            bar.update(task, visible=True, **numbers)

        yield show


@contextmanager
def measurements() -> Iterator[Callable[..., None]]:
    """Show finished and running measurements and the remaining time in s."""
    if not sys.stderr.isatty():
        yield _lines()
        return
    from rich.progress import TextColumn, TimeElapsedColumn

    with _bar(TimeElapsedColumn(), TextColumn("{task.description}", markup=False)) as show:
        yield lambda done, total, now, left=0.0: show(
            False, completed=done, total=total, description=_left(left) + now
        )


def _left(seconds: float) -> str:
    return f"about {seconds:.0f} s left: " if seconds >= 1.0 else ""


def _lines() -> Callable[..., None]:
    last = time.monotonic()

    def show(done: int, total: int, now: str, left: float = 0.0) -> None:
        nonlocal last
        if time.monotonic() - last >= LINE_INTERVAL:
            last = time.monotonic()
            print(f"{done} of {total}: {_left(left)}{now}", file=sys.stderr, flush=True)

    return show


@contextmanager
def trajectories() -> Iterator[Progress]:
    """Show progress, rate and remaining time on a terminal, else nothing."""
    if not sys.stderr.isatty():
        yield lambda what, done, total: None
        return
    from rich.progress import ProgressColumn, Task, TextColumn, TimeRemainingColumn
    from rich.text import Text

    class Rate(ProgressColumn):
        def render(self, task: Task) -> Text:
            return Text("" if task.speed is None else f"{task.speed:.3g}/s")

    with _bar(Rate(), TimeRemainingColumn(), TextColumn("{task.description}")) as show:
        last = ""

        def shown(what: str, done: int, total: int) -> None:
            nonlocal last
            show(what != last, description=what, completed=done, total=total)
            last = what

        yield shown
