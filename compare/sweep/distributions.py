"""Uncertain quantities and their distributions."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from compare.engines import one_of
from compare.sweep.quantities import components, parameters, units
from reference_model.systems import FloatArray, System, checked_state, number_in_text

LEAST_UNIFORM = 2.0**-54
"""Replacement for the random number 0, whose normal quantile is infinite."""


class _Kind(NamedTuple):
    """Names and conditions of a distribution's numbers, and its function."""

    arguments: tuple[str, ...]
    allowed: str
    possible: Callable[..., bool]
    frozen: Callable[..., Any]


KINDS = {
    "normal": _Kind(
        ("mean", "deviation"),
        "deviation > 0",
        lambda mean, deviation: deviation > 0.0,
        lambda stats, mean, deviation: stats.norm(mean, deviation),
    ),
    "truncnorm": _Kind(
        ("mean", "deviation", "low", "high"),
        "deviation > 0 and low < high",
        lambda mean, deviation, low, high: deviation > 0.0 and low < high,
        lambda stats, mean, deviation, low, high: stats.truncnorm(
            (low - mean) / deviation, (high - mean) / deviation, mean, deviation
        ),
    ),
    "uniform": _Kind(
        ("low", "high"),
        "low < high",
        lambda low, high: low < high,
        lambda stats, low, high: stats.uniform(low, high - low),
    ),
    "triangular": _Kind(
        ("low", "mode", "high"),
        "low <= mode <= high and low < high",
        lambda low, mode, high: low <= mode <= high and low < high,
        lambda stats, low, mode, high: stats.triang((mode - low) / (high - low), low, high - low),
    ),
    "lognormal": _Kind(
        ("median", "deviation"),
        "median > 0 and deviation (of the logarithm) > 0",
        lambda median, deviation: median > 0.0 and deviation > 0.0,
        lambda stats, median, deviation: stats.lognorm(deviation, scale=median),
    ),
}


def in_words() -> str:
    """Return the syntax of all distributions."""
    return ", ".join(f"{name}({', '.join(kind.arguments)})" for name, kind in KINDS.items())


@dataclass(frozen=True)
class Uncertain:
    """An uncertain parameter or component of the initial state.

    ``kind`` is one of ``KINDS``, and ``numbers`` are its arguments in the quantity's SI unit. Raises ``ValueError``
    for an unknown distribution, or numbers that it does not allow.
    """

    name: str
    kind: str
    numbers: tuple[float, ...]

    def __post_init__(self) -> None:
        kind = KINDS[one_of("distribution", self.kind, KINDS)]
        if len(self.numbers) != len(kind.arguments) or not kind.possible(*self.numbers):
            raise ValueError(f"{self}: {self.kind} takes ({', '.join(kind.arguments)}) with {kind.allowed}")

    def __str__(self) -> str:
        return f"{self.name}={self.kind}({', '.join(f'{number:g}' for number in self.numbers)})"

    @classmethod
    def parse(cls, text: str, system: System) -> Uncertain:
        """Return the quantity of a text "NAME=KIND(NUMBER, ...)".

        Raises ``ValueError`` for another text, or if the distribution includes values that ``system`` does not allow.
        """
        found = re.fullmatch(r"\s*(\w+)\s*=\s*(\w+)\s*\(([^()]*)\)\s*", text)
        if not found:
            raise ValueError(f"--vary {text!r}: write it as NAME=DISTRIBUTION with one of {in_words()}")
        name = one_of("parameter or component", found[1], units(system))
        numbers = tuple(number_in_text(name, number) for number in found[3].split(","))
        uncertain = cls(name, found[2], numbers)
        uncertain.check(system)
        return uncertain

    def check(self, system: System) -> None:
        """Raise ``ValueError`` if the distribution includes values that ``system`` does not allow."""
        drawn = self.values(np.array([0.0, 0.5, 1.0 - LEAST_UNIFORM * 2.0]))
        if not np.all(np.isfinite(drawn)):
            raise ValueError(f"{self}: its values are not finite numbers; use a larger deviation")
        largest = float(np.max(np.abs(drawn)))
        for end in self.distribution.support():
            # replace an infinite end by the largest value that can be drawn
            value = float(end) if math.isfinite(end) else math.copysign(largest, end)
            changes: dict[str, Any] = {self.name: value}
            try:
                if self.name in parameters(system):
                    replace(system, **changes)
                else:
                    checked_state(system, [changes.get(name, 0.0) for name in components(system)])
            except ValueError as error:
                allowed = str(error).rpartition(": ")[2]
                raise ValueError(
                    f"{self} includes {self.name} = {end:g}, but {allowed}; "
                    "use truncnorm(mean, deviation, low, high) to limit a normal distribution"
                ) from None

    @cached_property
    def distribution(self) -> Any:
        """SciPy's distribution."""
        from scipy import stats  # slow import

        return KINDS[self.kind].frozen(stats, *self.numbers)

    def values(self, uniform: FloatArray) -> FloatArray:
        """Return the quantiles of ``uniform``, numbers in [0, 1)."""
        return np.asarray(self.distribution.ppf(np.maximum(uniform, LEAST_UNIFORM)), dtype=float)


def uniform_rows(seed: int, first: int, count: int, width: int) -> FloatArray:
    """Return rows ``first`` to ``first + count`` of a table of random numbers in [0, 1), shape (count, width).

    The generator is counter-based (Philox), so any part of the table can be computed separately.
    """
    blocks = -(-width // 4)  # Philox yields four numbers per count
    generator = np.random.Philox(key=seed)
    generator.advance(first * blocks)
    rows: FloatArray = np.random.Generator(generator).random((count, 4 * blocks))
    return rows[:, :width]
