"""Options of the command line that several commands have, each declared once, with the parser that reads it.

A parser raises ``BadInputError``: of a ``ValueError`` typer would show the value, and not what is allowed.
"""

from __future__ import annotations

import inspect
import os
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import MISSING, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Concatenate, ParamSpec, TypeVar, get_type_hints

import typer

from compare.cli.command import refused

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

    from compare.claims.study import Study
    from reference_model.systems import System

Value = TypeVar("Value")
Group = TypeVar("Group", bound="DataclassInstance")
Own = ParamSpec("Own")

MOST_JOBS = 1000
"""More would fill a machine's table of processes."""


def whole(name: str, least: int, most: int) -> Callable[[str], int]:
    """Return the parser of whole numbers from ``least`` to ``most``."""

    def parsed(text: str) -> int:
        with refused():
            return count(name, text, least, most)

    return parsed


def positive(name: str, unit: str) -> Callable[[str], float]:
    """Return the parser of numbers > 0 with ``unit``."""

    def parsed(text: str) -> float:
        from reference_model.systems import finite_number

        with refused():
            value = finite_number(name, text)
            if value <= 0.0:
                raise ValueError(f"{name} = {value:g} {unit}: it must be > 0")
        return value

    return parsed


def finite(name: str) -> Callable[[str], float]:
    """Return the parser of finite numbers."""

    def parsed(text: str) -> float:
        from reference_model.systems import finite_number

        with refused():
            return finite_number(name, text)

    return parsed


def chosen_from(kind: str, names: Sequence[str]) -> Callable[[str], str]:
    """Return the parser of one of ``names``."""

    def parsed(text: str) -> str:
        from compare.engines import one_of

        with refused():
            return one_of(kind, text, names)

    return parsed


def tolerance_of(text: str) -> float:
    """Return the tolerance that ``text`` says."""
    from reference_model.systems import checked_tolerance, finite_number

    with refused():
        return checked_tolerance(finite_number("tolerance", text))


def count(name: str, text: str, least: int, most: int) -> int:
    """Return the whole number from ``least`` to ``most`` that ``text`` says; raise ``ValueError`` otherwise."""
    try:
        value = int(text)
    except ValueError:
        raise ValueError(f"{name} = {text!r}: it must be a whole number") from None
    if not least <= value <= most:
        raise ValueError(f"{name} = {value}: it must lie between {least} and {most}")
    return value


def cores() -> int:
    """Return how many cores this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="NAME=VALUE",
        help="A parameter in SI units, several times for several.",
        show_default=False,
    ),
]
Tolerance = Annotated[
    float,
    typer.Option(metavar="TOL", help="Accuracy to aim at.", parser=tolerance_of),
]
Folder = Annotated[Path, typer.Option("--output", metavar="DIR", help="Folder for the results.")]
Jobs = Annotated[
    int | None,
    typer.Option(
        metavar="N",
        help="Number of processes.",
        parser=whole("jobs", 1, MOST_JOBS),
        show_default="one for each core",
    ),
]
Resume = Annotated[
    bool,
    typer.Option("--resume", help="Keep what the same code and libraries have already computed there."),
]


def taking(
    group: type[Group], **defaults: Any
) -> Callable[[Callable[Concatenate[Group, Own], Value]], Callable[..., Value]]:
    """Let a command take the fields of the dataclass ``group`` as options besides its own.

    The command is handed them as its first argument. ``defaults`` are those that this command has others of. Typer
    reads options from a signature: that of the fields takes the place of the first argument.
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
    """Return ``system`` with changes "name=value"; raise ``ValueError`` for what is neither."""
    changes: dict[str, Any] = dict(changes_of(settings, [field.name for field in fields(system)]))
    if str(changes.get("contact_points", "")).strip().lower() == "none":
        changes["contact_points"] = None
    return replace(system, **changes)


def changes_of(settings: Sequence[str], names: Sequence[str]) -> dict[str, str]:
    """Return the values by name of settings "name=value"; raise ``ValueError`` for what is none of ``names``."""
    from compare.engines import one_of

    changes: dict[str, str] = {}
    for setting in settings:
        name, equals, value = setting.partition("=")
        if not equals:
            raise ValueError(f"--set {setting!r}: write it as NAME=VALUE")
        name = one_of("parameter", name.strip(), names)
        if name in changes:
            raise ValueError(f"--set {name}: it is there more than once")
        changes[name] = value
    return changes


def studies_of(context: typer.Context, names: Sequence[str], level: str = "full") -> tuple[Study, ...]:
    """Return the studies of these names, or all of a level; those of ``main`` where it was given its own."""
    from compare.studies import STUDIES, studies

    with refused():
        if level == "quick" and names:
            raise ValueError(f"--level quick chooses the studies: leave out {', '.join(names)}, or the level")
        found = studies(names, STUDIES if context.obj is None else context.obj)
    return tuple(study for study in found if study.quick or level == "full")


def check_folder(folder: Path) -> None:
    """Raise ``ValueError`` if no file can be made in ``folder``, which is made itself: check all else before."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise ValueError(f"can't write into the folder {str(folder)!r}: {error.strerror}") from None
