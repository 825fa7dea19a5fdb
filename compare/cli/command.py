"""How every command refuses bad input, says what went wrong, and ends: in one sentence and with an exit status."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from typer.core import TyperCommand

from compare.output.outside_text import printable

if TYPE_CHECKING:
    from compare.sweep.compute.run import Progress


FINE, SOMETHING_DIFFERS, BAD_INPUT, NOTHING_SHOWN, NOTHING_MEASURED, INTERRUPTED = 0, 1, 2, 3, 4, 130


class BadInputError(Exception):
    """A sentence that tells the user what is wrong and what would be right."""


class EngineFailedError(Exception):
    """A sentence that tells why an engine has no result."""


class InterruptedByUserError(Exception):
    """Ctrl-C, which typer would turn into a status without a word."""


class Command(TyperCommand):
    """A command that takes no option twice and no empty one, and hands on what is no error of its own."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Refuse what would silently be ignored."""
        values, _, given = self.make_parser(ctx).parse_args(args=list(args))
        for option in given:
            if option.param_type_name != "option" or option.is_flag or option.multiple:  # type: ignore[attr-defined]
                continue
            if values[option.name] == "":
                raise BadInputError(f"{option.opts[0]} '': it must not be empty")
            if given.count(option) > 1:
                raise BadInputError(f"{option.opts[0]} is there {given.count(option)} times: give it once")
        return super().parse_args(ctx, args)

    def invoke(self, ctx: Any) -> Any:
        """Run the command."""
        try:
            return super().invoke(ctx)
        except KeyboardInterrupt:
            raise InterruptedByUserError from None


@contextmanager
def printing() -> Iterator[None]:
    """Print inside; a reader that has seen enough, "head" for instance, is no error and changes no exit status."""
    try:
        yield
        sys.stdout.flush()
    except BrokenPipeError:
        close_output()


def close_output() -> None:
    """Leave nothing behind that would be written once more, and fail again, at the end of the process."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


@contextmanager
def refused() -> Iterator[None]:
    """Turn the ``ValueError`` of a check into ``BadInputError``; not around more, lest it hide a mistake."""
    try:
        yield
    except ValueError as error:
        raise BadInputError(str(error)) from None


def say(sentence: str, result: int) -> int:
    """Print a sentence on the error stream and return the exit status ``result``."""
    print(printable(sentence), file=sys.stderr)
    return result


# --- Progress: a bar on a terminal, and of measurements a line now and then elsewhere.

SELDOM = 10.0
"""In s, between lines where there is no terminal."""


@contextmanager
def measurements() -> Iterator[Callable[[int, int, str], None]]:
    """Show how many measurements are done: a bar on a terminal, and a line every ``SELDOM`` seconds elsewhere."""
    if not sys.stderr.isatty():
        yield _lines()
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (BarColumn(), MofNCompleteColumn(), TimeElapsedColumn(), TextColumn("{task.description}"))
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("")
        yield lambda done, total, name: bar.update(task, completed=done, total=total, description=name)


def _lines() -> Callable[[int, int, str], None]:
    last = time.monotonic()

    def show(done: int, total: int, name: str) -> None:
        nonlocal last
        if time.monotonic() - last >= SELDOM:
            last = time.monotonic()
            print(f"{done} of {total}: {name}", file=sys.stderr, flush=True)

    return show


@contextmanager
def trajectories() -> Iterator[Progress]:
    """Show how much is done, how fast and for how long still on a terminal, and nothing at all elsewhere."""
    if not sys.stderr.isatty():
        yield lambda what, done, total: None
        return
    from rich import progress as rich
    from rich.console import Console
    from rich.text import Text

    class Rate(rich.ProgressColumn):
        def render(self, task: rich.Task) -> Text:
            return Text("" if task.speed is None else f"{task.speed:.3g}/s")

    columns = (
        rich.TextColumn("{task.description}"),
        rich.BarColumn(),
        rich.MofNCompleteColumn(),
        Rate(),
        rich.TimeRemainingColumn(),
    )
    with rich.Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("")

        def show(what: str, done: int, total: int) -> None:
            if bar.tasks[0].description != what:
                bar.reset(task, total=total, completed=done, description=what)
            bar.update(task, completed=done)

        yield show
