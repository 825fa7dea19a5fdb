"""A claim before its measurement, as declared by ``Study.claim``."""

import inspect
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from compare.claims.claim import Basis, Kind
from compare.claims.measured import Measured
from compare.claims.prose import slug


@dataclass(frozen=True)
class Declared:
    """All properties of a claim that do not depend on the engine.

    - ``function``: ``function(engine) -> Measured``, without an argument for the theory, or None if the claim does
      not apply to the engine. In a family it also takes a value of ``each``.
    - ``resolution``: largest total error of a conclusive agreement; None if the measurement contains it.
    - ``swept``: parameters of the system that the claim varies.
    - ``each``: names and values of the members of a family; empty for a single claim.
    - ``duration``: total duration in s of a long claim's motions, weighted for finer steps, for the quick level.

    All others are those of :class:`compare.claims.claim.Claim`. In a family, braces in the sentences stand for the
    member's name.
    """

    function: Callable[..., Measured | None]
    sentence: str
    kind: Kind = "formula"
    basis: Basis = ""  # type: ignore[assignment]  # the usual one, see ``Claim``
    equation: str = ""
    unit: str = ""
    resolution: float | None = None
    note: str = ""
    implied_by: str = ""
    named: Mapping[str, int | None] = field(default_factory=dict)
    swept: Collection[str] = ()
    each: Mapping[str, Any] = field(default_factory=dict)
    duration: float = 0.0

    @property
    def of_engine(self) -> bool:
        """True if the claim is about an engine: the first argument of its function."""
        return next(iter(inspect.signature(self.function).parameters), "") == "engine"

    @property
    def place(self) -> tuple[Path, int]:
        """File and line of the function."""
        code = inspect.unwrap(self.function).__code__
        return Path(code.co_filename), code.co_firstlineno

    def cases(self) -> Iterator[tuple[str, tuple[Any, ...]]]:
        """Yield each member of the family with additional arguments of its function."""
        if not self.each:
            yield "", ()
        for name, value in self.each.items():
            yield name, (value,)

    def sentence_of(self, case: str) -> str:
        """Return the sentence of a member of the family."""
        return self.sentence.format(case) if self.each else self.sentence

    def part(self, case: str) -> str:
        """Return the selector "function/case" of a member of the family, or "function" of a single claim."""
        return f"{self.function.__name__}/{case}" if self.each else self.function.__name__

    def identity(self, study: str, case: str) -> str:
        """Return the permanent id of the claim, such as "fig06/rests"."""
        parts = (study, self.function.__name__.strip("_"), case)
        return "/".join(slug(part) for part in parts if part)
