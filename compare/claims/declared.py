"""A claim before it is measured: what ``Study.claim`` declares on the function that measures it."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from compare.claims.claim import Basis, Kind
from compare.claims.measured import Measured
from compare.claims.prose import slug


@dataclass(frozen=True)
class Declared:
    """A claim as it is known before anything is measured: all that does not vary with the engine.

    Parameters
    ----------
    function : callable
        ``function(engine) -> Measured``, or without an engine for a claim of the theory; None where the claim is not
        made of an engine. Of a family it takes one of ``each`` besides.
    sentence, equation, kind, unit, note, basis, implied_by, named
        As in :class:`compare.claims.claim.Claim`; in a family the sentence has braces for the name of each, and
        ``implied_by`` is the sentence of the same one.
    resolution : float, optional
        The largest total error with which agreement still says something; None where the function says it.
    swept : tuple of str
        Parameters of the system that are varied, so that it stands for none of their values.
    each : mapping
        Of a family the name and the value of each; empty for a single claim.

    """

    function: Callable[..., Measured | None]
    sentence: str
    equation: str
    kind: Kind
    unit: str
    resolution: float | None
    note: str
    basis: Basis
    implied_by: str
    named: Mapping[str, int | None]
    swept: tuple[str, ...]
    each: Mapping[str, Any]

    @property
    def of_engine(self) -> bool:
        """Whether an engine takes part."""
        return takes_engine(self.function)

    def cases(self) -> Iterator[tuple[str, tuple[Any, ...]]]:
        """Yield the name of each member of the family and what its function takes besides the engine."""
        if not self.each:
            yield "", ()
        for name, value in self.each.items():
            yield name, (value,)

    def sentence_of(self, case: str) -> str:
        """Return the sentence of one member of the family."""
        return self.sentence.format(case) if self.each else self.sentence

    def part(self, case: str) -> str:
        """Return what chooses one member of the family, "function/case", or the claim, "function"."""
        return f"{self.function.__name__}/{case}" if self.each else self.function.__name__

    def identity(self, study: str, case: str) -> str:
        """Return what the claim is called for good, as "fig06/rests": whatever else is claimed beside it."""
        parts = (study, self.function.__name__.strip("_"), case)
        return "/".join(slug(part) for part in parts if part)


def takes_engine(function: Callable[..., Any]) -> bool:
    """Return whether an engine is the first argument."""
    return next(iter(inspect.signature(function).parameters), "") == "engine"
