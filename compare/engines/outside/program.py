"""``exec:COMMAND``: a program in any language as an engine, connected by lines of JSON."""

import importlib
import os
import re
import shlex
import shutil
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from importlib.machinery import BYTECODE_SUFFIXES, all_suffixes
from pathlib import Path, PurePath
from typing import Any

from numpy.typing import ArrayLike

from compare.engines.engine import Engine
from compare.engines.registry import Scheme, register_scheme
from reference_model.systems import System
from reference_model.trajectory import Trajectory

INTERPRETERS = re.compile(
    r"(python|pypy|node|deno|bun|julia|ruby|perl|lua|php|java|mono|dotnet|octave|Rscript|sbcl|guile|sh|bash|env|wine)"
    r"[\d.]*"
)
"""Interpreters, whose engines are named after the script."""


def _conversation() -> Any:
    return importlib.import_module("compare.engines.outside.conversation")


@dataclass(frozen=True)
class Program:
    """The ``simulate`` of a program; each calling process starts its own."""

    command: tuple[str, ...]
    folder: str

    @property
    def files(self) -> set[Path]:
        """The program, the files among its arguments, and the files next to a script in its language.

        Empty if an interpreter runs anything other than a file, for example ``python -m``.
        """
        program, *arguments = self.command
        found = shutil.which(program) if not os.path.dirname(program) else os.path.join(self.folder, program)
        given = {path for word in arguments if (path := Path(self.folder, word)).is_file()}
        if found is None or (_is_interpreter(program) and not given):
            return set()
        files = given | {Path(found)}
        for script in files if os.path.dirname(program) else given:
            if script.suffix.lstrip(".").isalpha() and script.suffix != ".exe":
                endings = MODULES if script.suffix == ".py" else (script.suffix,)
                files = files | code_below([script.parent], endings)
        return files

    def __call__(
        self, system: System, initial_state: ArrayLike, times: ArrayLike, **accuracy: float
    ) -> Trajectory:
        """Return the program's motion."""
        trajectory: Trajectory = _conversation().simulate(
            self.command, self.folder, system, initial_state, times, **accuracy
        )
        return trajectory


def program_engine(text: str) -> Engine:
    """Return the engine "exec:TEXT" of the program's greeting; raise ``ValueError`` if it fails."""
    program = _program(text)
    greeting = _conversation().greeting_of(program.command, program.folder)
    name = name_of(program.command)
    about = f"{name} runs the program {greeting.who}." if greeting.who else ""
    try:
        return Engine(name, program, about=about, **{"phases": False, **greeting.promises})
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name} has an invalid greeting, {greeting.promises}: {error}") from None


def check_program(text: str) -> None:
    """Raise ``ValueError`` unless "exec:TEXT" names an existing program."""
    program = _program(text)
    _conversation().check_command(program.command, program.folder)


def _program(text: str) -> Program:
    try:
        command = tuple(shlex.split(text))
    except ValueError as error:
        raise ValueError(f"exec:{text}: {str(error).lower()}") from None
    if not command or not command[0]:
        raise ValueError(f"exec:{text}: give a command, for example exec:./my_engine")
    return Program(command, os.getcwd())


def name_of(command: Sequence[str]) -> str:
    """Return the name of an engine: the program's own name and its arguments."""
    return " ".join([own_name(command), *_run(command)[1:]])


def own_name(command: Sequence[str]) -> str:
    """Return the name of the program or the script, without folder and extension."""
    path = PurePath(_run(command)[0])
    return path.stem if path.suffix.lstrip(".").isalpha() else path.name


def _run(command: Sequence[str]) -> Sequence[str]:
    if not _is_interpreter(command[0]):
        return command
    own = next((i for i, word in enumerate(command) if i > 0 and not word.startswith("-")), 0)
    return command[own:]


def _is_interpreter(program: str) -> bool:
    return INTERPRETERS.fullmatch(PurePath(program).name.removesuffix(".exe")) is not None


register_scheme("exec", Scheme(program_engine, check_program))


# --- Files of foreign code, found by their extensions.

MODULES = tuple(set(all_suffixes()) - set(BYTECODE_SUFFIXES))


def code_below(folders: Iterable[str | Path], endings: tuple[str, ...] = MODULES) -> set[Path]:
    """Return the files with one of the ``endings`` in folders and their packages.

    A folder whose name is not an identifier, such as ``.venv``, is not a package.
    """
    found, seen = set[Path](), set[str]()
    for folder in folders:
        for place, inside, names in os.walk(folder, followlinks=True):
            new = os.path.realpath(place) not in seen  # a link may lead back
            seen.add(os.path.realpath(place))
            inside[:] = [name for name in inside if new and name.isidentifier() and name != "__pycache__"]
            found.update(Path(place, name) for name in names if name.endswith(endings))
    return {path for path in found if path.is_file()}
