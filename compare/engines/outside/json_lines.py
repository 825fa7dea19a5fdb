"""Questions to a program that serves as an engine, and its answers, each a line of JSON.

``docs/judge-your-engine.md`` specifies them. All digits of numbers are written.
"""

import functools
import json
import reprlib
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from compare.engines.answer import PHASES
from compare.engines.engine import UnsupportedSystemError, kind_of
from compare.engines.registry import DECLARED
from compare.output.outside_text import one_line, one_of, printable
from reference_model.systems import PinOnDisc, finite_number
from reference_model.systems.joint import AnySystem
from reference_model.trajectory import Phase, Trajectory, phases_of

PROTOCOL = 1
ANSWER_LIMIT = 60.0  # default time limit in s for one motion
_written = json.JSONEncoder(separators=(",", ":"), allow_nan=False).encode


class BadLineError(RuntimeError):
    """A program wrote an invalid line; the message continues a sentence that begins with its name."""


class RefusedError(RuntimeError):
    """A program reported an error; the message is its own."""


@dataclass(frozen=True)
class Greeting:
    """The first line of a program; every entry is optional."""

    promises: dict[str, Any] = field(default_factory=dict)  # parameters of ``Engine``
    name: str = ""
    version: str = ""
    limit: float = ANSWER_LIMIT

    @property
    def who(self) -> str:
        """Name and version, "" if the program gave neither."""
        return " ".join(filter(None, (self.name, self.version)))


def greeting(line: bytes) -> Greeting:
    """Return the greeting in a program's first line; raise ``ValueError`` if it is invalid."""
    try:
        content = _object(line)
    except BadLineError as error:
        raise ValueError(str(error)) from None
    for key in content:
        one_of("field in its greeting", key, ("protocol", "name", "version", "limit", *DECLARED))
    if content.get("protocol", PROTOCOL) != PROTOCOL:
        raise ValueError(f"uses protocol {content['protocol']!r}: it must be {PROTOCOL}")
    if not isinstance(content.get("kinds", []), list):
        raise ValueError(f'greets with "kinds": {json.dumps(content["kinds"])}: it must be a list')
    limit = finite_number("limit", content.get("limit", ANSWER_LIMIT))
    if limit <= 0.0:
        raise ValueError(f'greets with "limit": {limit:g}: it must be > 0 s')
    promises = {key: content[key] for key in DECLARED if key in content}
    return Greeting(promises, one_line(content.get("name", "")), one_line(content.get("version", "")), limit)


def question(system: AnySystem, state: ArrayLike, times: ArrayLike, accuracy: dict[str, float]) -> bytes:
    """Return the line that requests a motion; ``accuracy`` is a tolerance, or a step in s."""
    ((name, value),) = accuracy.items()
    numbers = (_written(np.asarray(values, dtype=float).tolist()) for values in (state, times))
    text = '{{"system":{},"state":{},"times":{},"{}":{!r}}}\n'.format(
        _system(system), *numbers, name, float(value)
    )
    return text.encode("ascii")


@functools.lru_cache(maxsize=64)  # questions often have the same system
def _system(system: AnySystem) -> str:
    kind = "pin" if isinstance(system, PinOnDisc) else kind_of(system)  # a block is a pin on a disc at rest
    return _written({"kind": kind} | asdict(system))


def most_bytes(system: AnySystem, times: ArrayLike) -> int:
    """Return a length that no answer exceeds, even with all digits and phases."""
    return 1_000_000 + 100 * system.state_size * np.size(times)


def answered(line: bytes, system: AnySystem, times: ArrayLike) -> Trajectory:
    """Return the motion in ``line`` at the requested times (n,), not yet checked.

    Raises ``UnsupportedSystemError`` or ``RefusedError`` if the line says so, and ``BadLineError`` if it is invalid.
    """
    content = _object(line)
    if "unsupported" in content:
        raise UnsupportedSystemError(printable(content["unsupported"]))
    if "error" in content:
        raise RefusedError(printable(content["error"]))
    if "states" not in content:
        raise BadLineError(f'answered without "states": {_short(line)}')
    states = _array("states", content["states"])
    phases = _phases(content.get("phases", []), system, float(np.asarray(times)[-1]))
    return Trajectory(system, np.array(times, dtype=float), states, phases)


def _object(line: bytes) -> dict[str, Any]:
    try:
        content = json.loads(line)
    except (ValueError, RecursionError):
        raise BadLineError(f"wrote a line that is not JSON: {_short(line)}") from None
    if not isinstance(content, dict):
        raise BadLineError(f"wrote a line that is not a JSON object: {_short(line)}")
    return content


def _array(name: str, rows: object) -> Any:
    try:
        array = np.array(rows, dtype=float)
        if not set(map(type, np.array(rows, dtype=object).flat)) <= {int, float, type(None)}:
            raise TypeError  # NumPy accepts "1" and true as numbers
        return array
    except (TypeError, ValueError, OverflowError):
        raise BadLineError(
            f'answered with "{name}" that are not rows of numbers of equal length: {reprlib.repr(rows)}'
        ) from None


def _phases(told: object, system: AnySystem, end: float) -> tuple[Phase, ...]:
    begun = []
    for phase in told if isinstance(told, list) else [told]:
        if not isinstance(phase, dict) or phase.get("kind") not in PHASES:
            raise BadLineError(
                f'answered with a phase {reprlib.repr(phase)}: its "kind" must be one of {PHASES}'
            )
        start, state = _array("start", phase.get("start")), _array("state", phase.get("state"))
        if start.shape != () or state.shape != (system.state_size,) or not np.isfinite([start, *state]).all():
            raise BadLineError(
                f'answered with a phase {reprlib.repr(phase)}: its "start" must be a time, '
                f'and "state" {system.state_size} numbers'
            )
        begun.append((phase["kind"], float(start), state))
    return phases_of(begun, end) if begun else ()


def _short(line: bytes) -> str:
    text = line.decode(errors="replace").strip()
    return repr(text if len(text) <= 60 else f"{text[:57]}...")
