"""How every command refuses bad input, says what went wrong, and ends: in one sentence and with an exit status."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from typer.core import TyperCommand

from compare.output.outside_text import printable

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
