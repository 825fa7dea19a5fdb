"""Names of programs and scripts."""

import re
from collections.abc import Sequence
from pathlib import PurePath

INTERPRETERS = re.compile(
    r"(python|pypy|node|deno|bun|julia|ruby|perl|lua|php|java|mono|dotnet|octave|Rscript|sbcl|guile|sh|bash|env|wine)"
    r"[\d.]*"
)
"""Interpreters, whose engines are named after the script."""


def name_of(command: Sequence[str]) -> str:
    """Return the name of an engine: the program's own name and its arguments."""
    return " ".join([own_name(command), *_run(command)[1:]])


def own_name(command: Sequence[str]) -> str:
    """Return the name of the program or the script, without folder and extension."""
    path = PurePath(_run(command)[0])
    return path.stem if path.suffix.lstrip(".").isalpha() else path.name


def _run(command: Sequence[str]) -> Sequence[str]:
    if not is_interpreter(command[0]):
        return command
    own = next((i for i, word in enumerate(command) if i > 0 and not word.startswith("-")), 0)
    return command[own:]


def is_interpreter(program: str) -> bool:
    """Return whether a program is one of the INTERPRETERS."""
    return INTERPRETERS.fullmatch(PurePath(program).name.removesuffix(".exe")) is not None
