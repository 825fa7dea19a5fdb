"""What the commands share: options, how they refuse bad input, read numbers and parameters, and end."""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer.core import TyperCommand

if TYPE_CHECKING:
    from reference_model.systems import System

FINE, SOMETHING_DIFFERS, BAD_INPUT, INTERRUPTED = 0, 1, 2, 130

MOST_SAMPLES, MOST_JOBS = 10_000_000, 1000
"""More would fill the memory of a machine, or its table of processes."""


Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="NAME=VALUE",
        help="A parameter in SI units, several times for several.",
        show_default=False,
    ),
]
Tolerance = Annotated[str, typer.Option(metavar="TOL", help="Accuracy to aim at.")]


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
    print(sentence, file=sys.stderr)
    return result


def changed(system: System, settings: Sequence[str]) -> System:
    """Return ``system`` with changes "name=value"; raise ``ValueError`` for what is neither."""
    from compare.engines import known

    names = [field.name for field in fields(system)]
    changes: dict[str, Any] = {}
    for setting in settings:
        name, equals, value = setting.partition("=")
        if not equals:
            raise ValueError(f"--set {setting!r}: write it as NAME=VALUE")
        name = known("parameter", name.strip(), names)
        if name in changes:
            raise ValueError(f"--set {name}: it is there more than once")
        ring = name == "contact_points" and value.strip().lower() == "none"
        changes[name] = None if ring else value
    return replace(system, **changes)


def positive(name: str, text: str, unit: str) -> float:
    """Return the number > 0 that ``text`` says; raise ``ValueError`` otherwise."""
    from reference_model.systems import finite_number

    value = finite_number(name, text)
    if value <= 0.0:
        raise ValueError(f"{name} = {value:g} {unit}: it must be > 0")
    return value


def count(name: str, text: str, least: int, most: int) -> int:
    """Return the whole number from ``least`` to ``most`` that ``text`` says; raise ``ValueError`` otherwise."""
    try:
        value = int(text)
    except ValueError:
        raise ValueError(f"{name} = {text!r}: it must be a whole number") from None
    if not least <= value <= most:
        raise ValueError(f"{name} = {value}: it must lie between {least} and {most}")
    return value


def check_folder(folder: Path) -> None:
    """Raise ``ValueError`` if no file can be made in ``folder``, which is made itself."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise ValueError(f"can't write into the folder {str(folder)!r}: {error.strerror}") from None


def cores() -> int:
    """Return how many cores this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
