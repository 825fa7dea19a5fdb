"""``exec:COMMAND``: a program of any language as an engine, asked by lines of JSON."""

from __future__ import annotations

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
"""Programs that are known by what they run."""


def _conversation() -> Any:
    """Return the module that starts programs, loaded only when one is asked for."""
    return importlib.import_module("compare.engines.outside.conversation")


@dataclass(frozen=True)
class Program:
    """The ``simulate`` of a program: whichever process calls it has a process of the program for itself.

    Parameters
    ----------
    command : tuple of str
        The program and its arguments.
    folder : str
        Where it is started.

    """

    command: tuple[str, ...]
    folder: str

    @property
    def files(self) -> set[Path]:
        """The program, the files among its arguments, and what lies next to a script and is of its language.

        None if an interpreter runs something else than a file, as ``python -m`` does.
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
        """Ask for a motion."""
        trajectory: Trajectory = _conversation().simulate(
            self.command, self.folder, system, initial_state, times, **accuracy
        )
        return trajectory


def program_engine(text: str) -> Engine:
    """Return the engine "exec:TEXT" with what the program promises; raise ``ValueError`` if there is none."""
    program = _program(text)
    greeting = _conversation().greeting_of(program.command, program.folder)
    name = name_of(program.command)
    about = f"{name} is a program that calls itself {greeting.who}." if greeting.who else ""
    try:
        return Engine(name, program, about=about, **{"phases": False, **greeting.promises})
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name} greets with {greeting.promises}: {error}") from None


def check_program(text: str) -> None:
    """Raise ``ValueError`` unless "exec:TEXT" names a program that is there."""
    program = _program(text)
    _conversation().check_command(program.command, program.folder)


def _program(text: str) -> Program:
    try:
        command = tuple(shlex.split(text))
    except ValueError as error:
        raise ValueError(f"exec:{text}: {str(error).lower()}") from None
    if not command or not command[0]:
        raise ValueError(f"exec:{text}: a command has to follow, as in exec:./my_engine")
    return Program(command, os.getcwd())


def name_of(command: Sequence[str]) -> str:
    """Return what an engine is called: its program's own name, and the arguments that follow."""
    return " ".join([own_name(command), *_run(command)[1:]])


def own_name(command: Sequence[str]) -> str:
    """Return the name of the program, or of what an interpreter runs, without folder and ending."""
    path = PurePath(_run(command)[0])
    return path.stem if path.suffix.lstrip(".").isalpha() else path.name


def _run(command: Sequence[str]) -> Sequence[str]:
    """Return the command without an interpreter and its options."""
    if not _is_interpreter(command[0]):
        return command
    own = next((i for i, word in enumerate(command) if i > 0 and not word.startswith("-")), 0)
    return command[own:]


def _is_interpreter(program: str) -> bool:
    return INTERPRETERS.fullmatch(PurePath(program).name.removesuffix(".exe")) is not None


register_scheme("exec", Scheme(program_engine, check_program))


# --- Files of other people's code, found by their endings: nothing is imported or run.

MODULES = tuple(set(all_suffixes()) - set(BYTECODE_SUFFIXES))
"""Endings of what Python imports: sources and compiled extensions."""


def code_below(folders: Iterable[str | Path], endings: tuple[str, ...] = MODULES) -> set[Path]:
    """Return the files in folders with one of the ``endings``, and those in packages inside.

    A folder whose name is not an identifier, as ``site-packages`` or ``.venv``, is not a package and is left out.
    """
    found, seen = set[Path](), set[str]()
    for folder in folders:
        for place, inside, names in os.walk(folder, followlinks=True):
            new = os.path.realpath(place) not in seen  # a link may lead back
            seen.add(os.path.realpath(place))
            inside[:] = [name for name in inside if new and name.isidentifier() and name != "__pycache__"]
            found.update(Path(place, name) for name in names if name.endswith(endings))
    return {path for path in found if path.is_file()}
