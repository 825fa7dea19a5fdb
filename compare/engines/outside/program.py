"""``exec:COMMAND``: a program in any language as an engine, connected by lines of JSON."""

import os
import shlex
import shutil
from collections.abc import Iterable
from dataclasses import dataclass
from importlib.machinery import BYTECODE_SUFFIXES, all_suffixes
from pathlib import Path

from numpy.typing import ArrayLike

from compare.engines.engine import Engine
from compare.engines.outside import conversation
from compare.engines.outside.commands import is_interpreter, name_of
from compare.engines.registry import Scheme, register_scheme
from reference_model.systems.joint import AnySystem
from reference_model.trajectory import Trajectory


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
        if found is None or (is_interpreter(program) and not given):
            return set()
        files = given | {Path(found)}
        for script in files if os.path.dirname(program) else given:
            if script.suffix.lstrip(".").isalpha() and script.suffix != ".exe":
                endings = MODULES if script.suffix == ".py" else (script.suffix,)
                files = files | code_below([script.parent], endings)
        return files

    def __call__(
        self, system: AnySystem, initial_state: ArrayLike, times: ArrayLike, **accuracy: float
    ) -> Trajectory:
        """Return the program's motion."""
        return conversation.simulate(self.command, self.folder, system, initial_state, times, **accuracy)


def program_engine(text: str) -> Engine:
    """Return the engine "exec:TEXT" of the program's greeting; raise ``ValueError`` if it fails."""
    program = _program(text)
    greeting = conversation.greeting_of(program.command, program.folder)
    name = name_of(program.command)
    about = f"{name} runs the program {greeting.who}." if greeting.who else ""
    try:
        return Engine(name, program, about=about, **{"phases": False, **greeting.promises})
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name} has an invalid greeting, {greeting.promises}: {error}") from None


def check_program(text: str) -> None:
    """Raise ``ValueError`` unless "exec:TEXT" names an existing program."""
    program = _program(text)
    conversation.check_command(program.command, program.folder)


def _program(text: str) -> Program:
    try:
        command = tuple(shlex.split(text))
    except ValueError as error:
        raise ValueError(f"exec:{text}: {str(error).lower()}") from None
    if not command or not command[0]:
        raise ValueError(f"exec:{text}: give a command, for example exec:./my_engine")
    return Program(command, os.getcwd())


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
