"""Options that several commands share, and their parsers.

Parsers raise ``BadInputError``, because typer's message for a ``ValueError`` does not say what is allowed.
"""

from __future__ import annotations

import inspect
import os
import re
from collections.abc import Callable, Sequence
from dataclasses import MISSING, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Concatenate, ParamSpec, TypeVar, get_type_hints

import typer

from compare.cli.command import HELD, refused
from compare.output.outside_text import one_of
from compare.output.text_files import check_writable, locked

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

    from compare.claims.study import Study
    from reference_model.systems import System

Value = TypeVar("Value")
Group = TypeVar("Group", bound="DataclassInstance")
Own = ParamSpec("Own")

MOST_JOBS = 1000
"""Limit of ``--jobs``; more processes could fill the process table."""


def whole(name: str, least: int, most: int) -> Callable[[str], int]:
    """Return a parser of integers from ``least`` to ``most``."""
    return refused()(lambda text: count(name, text, least, most))


def positive(name: str, unit: str) -> Callable[[str], float]:
    """Return a parser of numbers > 0; messages show ``unit``."""

    @refused()
    def parsed(text: str) -> float:
        value = _number(name, text)
        if value <= 0.0:
            raise ValueError(f"{name} = {value:g} {unit}: it must be > 0")
        return value

    return parsed


def finite(name: str) -> Callable[[str], float]:
    """Return a parser of finite numbers."""
    return refused()(lambda text: _number(name, text))


def chosen_from(kind: str, names: Sequence[str]) -> Callable[[str], str]:
    """Return a parser that accepts only ``names``."""
    return refused()(lambda text: one_of(kind, text, names))


@refused()
def tolerance_of(text: str) -> float:
    """Return ``text`` as a valid tolerance."""
    from reference_model.systems import checked_tolerance

    return checked_tolerance(_number("tolerance", text))


def _number(name: str, text: str) -> float:
    from reference_model.systems import number_in_text

    return number_in_text(name, str(text))  # typer also parses defaults


def count(name: str, text: str, least: int, most: int) -> int:
    """Return ``text`` as an integer; raise ``ValueError`` unless it lies between ``least`` and ``most``."""
    if not re.fullmatch(r"[+-]?\d+", str(text).strip(), re.ASCII):
        raise ValueError(f"{name} = {text!r}: it must be a whole number")
    value = int(text)
    if not least <= value <= most:
        raise ValueError(f"{name} = {value}: it must lie between {least} and {most}")
    return value


def cores() -> int:
    """Return the number of available cores."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="NAME=VALUE",
        help="Parameter and its value in SI units; repeat for more parameters.",
        show_default=False,
    ),
]
Tolerance = Annotated[
    float,
    typer.Option(metavar="TOL", help="Requested relative accuracy.", parser=tolerance_of),
]
Folder = Annotated[Path, typer.Option("--output", metavar="DIR", help="Folder for the results.")]
Jobs = Annotated[
    int | None,
    typer.Option(
        metavar="N",
        help="Number of processes.",
        parser=whole("jobs", 1, MOST_JOBS),
        show_default="one per core",
    ),
]
Resume = Annotated[
    bool,
    typer.Option(
        "--resume", help="Complete an earlier run; reuse its results if code and libraries are unchanged."
    ),
]


def with_options(
    group: type[Group], **defaults: Any
) -> Callable[[Callable[Concatenate[Group, Own], Value]], Callable[..., Value]]:
    """Add the fields of the dataclass ``group`` to a command as options.

    The options replace the first argument, a ``group``, in the signature that typer reads. ``defaults`` override
    their defaults.
    """

    def decorated(command: Callable[Concatenate[Group, Own], Value]) -> Callable[..., Value]:
        def taken(**values: Any) -> Value:
            shared = group(**{field.name: values.pop(field.name) for field in fields(group)})
            return command(shared, **values)  # type: ignore[call-arg]

        kinds = get_type_hints(command, include_extras=True) | get_type_hints(group, include_extras=True)
        own = list(inspect.signature(command).parameters.values())[1:]
        usual = {field.name: field.default for field in fields(group)} | defaults
        parameters = [one.replace(kind=one.KEYWORD_ONLY, annotation=kinds[one.name]) for one in own]
        for name, default in usual.items():
            given = inspect.Parameter.empty if default is MISSING else default
            parameters.append(
                inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=given, annotation=kinds[name])
            )
        taken.__name__, taken.__doc__ = command.__name__, command.__doc__
        taken.__annotations__ = {one.name: one.annotation for one in parameters}
        taken.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
        return taken

    return decorated


def changed(system: System, settings: Sequence[str]) -> System:
    """Return ``system`` with the changes "name=value"; raise ``ValueError`` for an invalid change."""
    given = changes_of(settings, [field.name for field in fields(system)])
    changes: dict[str, Any] = {
        name: None if name == "contact_points" and text.strip().lower() == "none" else _number(name, text)
        for name, text in given.items()
    }
    return replace(system, **changes)


def changes_of(settings: Sequence[str], names: Sequence[str]) -> dict[str, str]:
    """Return the values of settings "name=value" by name; raise ``ValueError`` for an unknown name."""
    changes: dict[str, str] = {}
    for setting in settings:
        name, equals, value = setting.partition("=")
        if not equals:
            raise ValueError(f"--set {setting!r}: write it as NAME=VALUE")
        name = one_of("parameter", name.strip(), names)
        if name in changes:
            raise ValueError(f"--set {name} is given more than once; give it once")
        changes[name] = value
    return changes


Seed = Annotated[
    int | None,
    typer.Option(
        metavar="N",
        help="Seed of the units of mass, length and time, drawn for each system over three decades. Engines receive "
        "their motions in these units. Default: 1 for --level quick, else SI units.",
        parser=whole("seed", 0, 1_000_000),
        show_default=False,
    ),
]


def studies_of(context: typer.Context, names: Sequence[str], level: str = "full") -> tuple[Study, ...]:
    """Return the named studies, or all of a level, of ``main`` or the paper."""
    from compare.studies import STUDIES, studies

    with refused():
        if level == "quick" and names:
            raise ValueError(
                f"--level quick selects the studies, so it cannot be combined with {', '.join(names)}; omit the "
                "names, or omit --level to measure them completely"
            )
        found = studies(names, STUDIES if context.obj is None else context.obj)
    return tuple(study for study in found if study.quick or level == "full")


def check_file(path: Path) -> None:
    """Raise ``ValueError`` if ``path`` cannot be written; change no existing file."""
    try:
        check_writable(path)
    except OSError as error:
        raise ValueError(unwritable(path, error)) from None


def unwritable(path: Path, error: OSError) -> str:
    """Return the message for a file that cannot be written."""
    return f"cannot write the file {str(path)!r}: {error.strerror}"


def check_folder(folder: Path) -> None:
    """Make ``folder`` and hold it until the command ends; raise ``ValueError`` if it is not writable or is held.

    Make this the last check of a command.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        HELD.enter_context(locked(folder))
    except OSError as error:
        raise ValueError(f"cannot write to the folder {str(folder)!r}: {error.strerror}") from None
