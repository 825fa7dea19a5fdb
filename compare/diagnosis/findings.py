"""What is found of one engine in parts, each measured by itself: one that hangs costs itself only."""

from __future__ import annotations

import functools
import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from compare.claims.error_estimates import ROUNDING, TRUTH
from compare.claims.parameters import FIG11
from compare.diagnosis import probes
from compare.diagnosis.laws import Friction, fitted, smoothing_of
from compare.engines import COARSENING, USUAL_TOLERANCE, Engine
from compare.foreign import CASES, Quantity
from reference_model import simulate
from reference_model.systems import FloatArray

# --- The same question at ever smaller tolerances or steps, and what the answers tend to.

RUNGS = 4
"""Of a ladder, for every engine and on every machine: what one costs depends on neither."""

HALVED = 2.0
"""Ratio of fixed steps from rung to rung."""

SAFETY = 3.0
"""Error of the finest rung over its change. Of a first order and halved steps that is three times the error."""


def tolerances(engine: Engine) -> FloatArray:
    """Return the tolerances of the rungs, from the largest, shape (RUNGS,); the last one is the usual."""
    factor = COARSENING if engine.step is None else HALVED**engine.root
    return USUAL_TOLERANCE * factor ** np.arange(RUNGS - 1, -1, -1.0)


@dataclass(frozen=True, eq=False)
class Ladder:
    """Answers to one question, an array of numbers at each rung, shape (RUNGS, ...)."""

    values: FloatArray

    @classmethod
    def of(cls, engine: Engine, question: Callable[[float], ArrayLike]) -> Ladder:
        """Ask ``question(tolerance)`` at each rung."""
        return cls(np.array([question(tolerance) for tolerance in tolerances(engine).tolist()], dtype=float))

    @property
    def finest(self) -> FloatArray:
        """The answer at the finest rung, shape (...)."""
        return np.asarray(self.values[-1])

    @property
    def error(self) -> FloatArray:
        """What the finest answer may be off what the answers tend to, shape (...), never less than rounding."""
        change = np.max(np.abs(np.diff(self.values[-3:], axis=0)), axis=0)
        return np.asarray(SAFETY * change + ROUNDING * np.max(np.abs(self.finest), initial=0.0))


def step_ratio(engine: Engine) -> float:
    """Return by how much what is called a step falls from rung to rung: the tolerance, where none is fixed."""
    return COARSENING if engine.step is None else HALVED


# --- The parts, and what is found in each.


@functools.cache
def _exact_ring() -> Quantity:
    ring = MOTIONS["ring"]
    return ring.quantity(simulate(ring.system, ring.start, ring.times, tolerance=TRUTH))


MOTIONS = CASES | {
    "ring": replace(
        CASES["disc"],
        title="a disc on a ring",
        sentence="A ring follows Coulomb's law",
        system=FIG11,
        exact=_exact_ring,
    )
}
"""What every engine is asked, if it promises it."""


@dataclass(frozen=True)
class Creep:
    """How a block moves that friction should hold.

    Parameters
    ----------
    speed : float
        Of a block pulled with half of μN, in m/s, at the finest rung.
    order : float
        By which it falls with the step, or with the tolerance where no step is fixed; NaN where there is none.
    smoothing : str
        The law of friction at slow slip that makes blocks creep so; "" where none does.
    epsilon : float
        Of that law, in m/s, at the finest rung.

    """

    speed: float
    order: float
    smoothing: str
    epsilon: float


@dataclass(frozen=True)
class Lag:
    """By how many s friction acts along an earlier slip, at the finest rung, its error, and its order in the step."""

    seconds: float
    error: float
    order: float


@dataclass(frozen=True)
class Motion:
    """How far off the exact motion one case of ``compare.foreign`` is.

    Parameters
    ----------
    errors : tuple of float
        Of all rungs, in m, the largest over time.
    estimate : float
        What the last of them may be by the engine's own change from rung to rung.
    order : float
        By which it falls with the step, or with the tolerance where no step is fixed; NaN where it has none.
    resolution : float
        In m: a tenth of what another law would change, see ``Case``.
    seconds : float
        Of the processor, at the finest rung.

    """

    errors: tuple[float, ...]
    estimate: float
    order: float
    resolution: float
    seconds: float

    @property
    def error(self) -> float:
        """That of the finest rung, in m."""
        return self.errors[-1]

    @property
    def converges(self) -> bool:
        """Whether the engine's own error explains how far it is off."""
        return self.error <= self.estimate

    @property
    def conclusive(self) -> bool:
        """Whether that error is small enough to tell another law."""
        return self.estimate <= self.resolution


Part = Friction | Creep | Lag | Motion


def friction(engine: Engine) -> Friction:
    """Return the law by which blocks are retarded that slide on a plane at rest."""
    ladder = Ladder.of(engine, functools.partial(probes.forces, engine))
    noise = engine.precision * probes.SPEED * probes.SLIDE.mass / (probes.FRICTION * probes.SLIDES_FOR)
    return fitted(ladder.finest, float(np.max(ladder.error[:, :2])) + noise)


def creep(engine: Engine) -> Creep:
    """Return how blocks creep that are pulled with less than friction can hold."""
    ladder = Ladder.of(engine, functools.partial(probes.creep, engine))
    half = ladder.values[:, probes.PULLS.index(0.5)]
    order = falling(np.abs(half), step_ratio(engine))
    return Creep(float(half[-1]), order, *smoothing_of(ladder.finest))


def lag(engine: Engine) -> Lag:
    """Return by how much friction lags behind the slip."""
    ladder = Ladder.of(engine, functools.partial(probes.lag, engine))
    return Lag(float(ladder.finest), float(ladder.error), falling(np.abs(ladder.values), step_ratio(engine)))


def motion(engine: Engine, name: str) -> Motion:
    """Return what the engine makes of the case of that name."""
    case, seconds = MOTIONS[name], 0.0

    def question(tolerance: float) -> FloatArray:
        nonlocal seconds
        before = time.process_time()
        run = engine.simulate(case.system, case.start, case.times, tolerance=tolerance)
        seconds = time.process_time() - before
        return _plane(case.quantity(run))

    ladder = Ladder.of(engine, question)
    errors = [_largest(value - _plane(case.exact())) for value in ladder.values]
    change = max(map(_largest, np.diff(ladder.values[-3:], axis=0)))
    rounding = (ROUNDING + engine.precision) * max(map(abs, case.start))
    order = falling(errors, step_ratio(engine))
    return Motion(tuple(errors), SAFETY * change + rounding, order, case.resolution, seconds)


def _plane(numbers: np.ndarray) -> FloatArray:
    return np.stack((numbers.real, numbers.imag), axis=-1)


def _largest(vectors: FloatArray) -> float:
    return float(np.max(np.hypot(*vectors.T)))


def falling(sizes: Sequence[float] | FloatArray, ratio: float) -> float:
    """Return by which power of the step the last of ``sizes`` is below the one before, at a ``ratio``-fold step."""
    if len(sizes) < 2 or not (0.0 < sizes[-2] < math.inf and 0.0 < sizes[-1] < math.inf):
        return math.nan
    return math.log(sizes[-2] / sizes[-1]) / math.log(ratio)


PROBES: dict[str, type[Any]] = {"law": Friction, "creep": Creep, "lag": Lag}
"""The parts that tell the law, and what each of them finds."""


def parts_of(engine: Engine) -> dict[str, Callable[[Engine], Part]]:
    """Return what is measured of an engine, by name: the law at rest and at slip first, then the motions it promises.

    The functions can be sent to other processes.
    """
    parts: dict[str, Callable[[Engine], Part]] = {}
    if engine.simulates(probes.SLIDE):
        parts |= {"law": friction, "creep": creep}
    if engine.simulates(probes.TURN):
        parts["lag"] = lag
    return parts | {
        name: functools.partial(motion, name=name)
        for name, case in MOTIONS.items()
        if engine.simulates(case.system)
    }
