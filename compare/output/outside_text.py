"""Text from outside the project: engines, programs, models, exceptions, files and the command line."""

import difflib
import re
import signal
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

MOST = 2000
"""Largest number of characters; a longer text loses its middle."""

LEFT_OUT = " [...] "

NOT_ASCII = re.compile(r"[^\n\t -~]")
"""Characters that may be unprintable."""

FORMULA = tuple("=+-@＝＋－＠")
"""First characters of spreadsheet formulas."""


def printable(text: object, most: int = MOST) -> str:
    r"""Return ``text`` in a form that files, terminals and XML accept, with at most ``most`` characters.

    Unprintable characters are escaped as by ``repr``: "\x1b". Line breaks and tabs are kept. The function is
    idempotent.
    """
    try:
        text = str(text)
    except Exception as error:  # an engine may define the exception
        text = f"{type(text).__name__}, whose text raises {type(error).__name__}"
    return _shortened(NOT_ASCII.sub(_escaped, _shortened(text, most)), most)


def one_line(text: object) -> str:
    """Return a name or version as ``printable`` text on one line that is not a spreadsheet formula."""
    line = " ".join(printable(text).split())
    return f"'{line}" if line.startswith(FORMULA) else line


def one_of(kind: str, name: str, names: Iterable[str]) -> str:
    """Return ``name`` if it is among ``names``; else raise ``ValueError`` with a suggestion."""
    names = list(names)
    if name in names:
        return name
    nearest = difflib.get_close_matches(name, names, n=1, cutoff=0.4)
    hint = f"did you mean {nearest[0]!r}?" if nearest else f"choose from {', '.join(names)}"
    raise ValueError(f"unknown {kind} {name!r}: {hint}")


def reason_of(error: BaseException) -> str:
    """Return the message of an exception in one line, or its class."""
    return " ".join(str(error).split()) or type(error).__name__


def all_printable(content: Any) -> Any:
    """Return JSON values with all texts and names ``printable``."""
    if isinstance(content, dict):
        return {printable(name): all_printable(value) for name, value in content.items()}
    if isinstance(content, list):
        return [all_printable(value) for value in content]
    return printable(content) if isinstance(content, str) else content


def _escaped(found: re.Match[str]) -> str:
    return found[0] if found[0].isprintable() else ascii(found[0])[1:-1]


def _shortened(text: str, most: int) -> str:
    if len(text) <= most:
        return text
    kept = (most - len(LEFT_OUT)) // 2
    return f"{text[:kept]}{LEFT_OUT}{text[-kept:]}"


# --- Failures of engines and of processes, in words.


@dataclass(frozen=True)
class Failure:
    """A failed piece of work: the reason and the locations in the code ("pin.py:12 in simulate"), innermost last.

    ``unfinished`` is True if only the time limit ended it.
    """

    reason: str
    where: tuple[str, ...] = ()
    unfinished: bool = False

    def __post_init__(self) -> None:
        """Make the texts printable, because most of them come from an engine."""
        object.__setattr__(self, "reason", printable(self.reason))
        object.__setattr__(self, "where", tuple(map(printable, self.where)))

    def __str__(self) -> str:
        """Return the reason, followed by the innermost location in brackets."""
        return f"{self.reason} ({self.where[-1]})" if self.where else self.reason


def cause_of_end(code: int) -> str:
    """Return the cause of a process's end: its exit status, or a signal if the code is negative."""
    if code >= 0:
        return f"exit status {code}"
    return next((one.name for one in signal.Signals if one == -code), f"signal {-code}")  # some have no name
