"""Parts of an engine's diagnosis, measured separately so that a hanging part does not affect the others."""

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

# --- Convergence of a quantity at successively smaller tolerances or steps.

RUNGS = 4
"""Number of rungs of a ladder, the same for every engine and machine."""

HALVED = 2.0
"""Ratio of fixed steps from rung to rung."""

SAFETY = 3.0
"""Ratio of the error estimate to the last change: three times the error for first order and halved steps."""


def tolerances(engine: Engine) -> FloatArray:
    """Return the tolerances of the rungs in descending order, shape (RUNGS,); the last one is the default."""
    factor = COARSENING if engine.step is None else HALVED**engine.root
    return USUAL_TOLERANCE * factor ** np.arange(RUNGS - 1, -1, -1.0)


@dataclass(frozen=True, eq=False)
class Ladder:
    """Values of one quantity at each rung, shape (RUNGS, ...)."""

    values: FloatArray

    @classmethod
    def of(cls, engine: Engine, question: Callable[[float], ArrayLike]) -> Ladder:
        """Evaluate ``question(tolerance)`` at each rung."""
        return cls(np.array([question(tolerance) for tolerance in tolerances(engine).tolist()], dtype=float))

    @property
    def finest(self) -> FloatArray:
        """Value at the finest rung, shape (...)."""
        return np.asarray(self.values[-1])

    @property
    def error(self) -> FloatArray:
        """Estimated distance of the finest value from the limit, shape (...), at least rounding error."""
        change = np.max(np.abs(np.diff(self.values[-3:], axis=0)), axis=0)
        return np.asarray(SAFETY * change + ROUNDING * np.max(np.abs(self.finest), initial=0.0))


def step_ratio(engine: Engine) -> float:
    """Return the ratio of steps from rung to rung, or of tolerances if the step is not fixed."""
    return COARSENING if engine.step is None else HALVED


# --- The parts and their results.


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
"""Motions for every engine that supports them."""


@dataclass(frozen=True)
class Creep:
    """Creep of a block that friction should hold.

    Parameters
    ----------
    speed : float
        Speed in m/s of a block under a load of μN/2, at the finest rung.
    order : float
        Order of the speed in the step, or in the tolerance if the step is not fixed; NaN if undefined.
    smoothing : str
        Regularised friction law that explains the creep; "" if none does.
    epsilon : float
        Regularisation of that law in m/s, at the finest rung.

    """

    speed: float
    order: float
    smoothing: str
    epsilon: float


@dataclass(frozen=True)
class Lag:
    """Delay in s of the friction force behind the slip at the finest rung, its error, and its order in the step."""

    seconds: float
    error: float
    order: float


@dataclass(frozen=True)
class Motion:
    """Errors of one case of ``compare.foreign`` against the exact motion.

    Parameters
    ----------
    errors : tuple of float
        Largest error over time at each rung, in m.
    estimate : float
        Estimate of the last error in m from the changes between rungs.
    order : float
        Order of the error in the step, or in the tolerance if the step is not fixed; NaN if undefined.
    resolution : float
        A tenth of the change due to another friction law, in m, see ``Case``.
    seconds : float
        Processor time in s at the finest rung.

    """

    errors: tuple[float, ...]
    estimate: float
    order: float
    resolution: float
    seconds: float

    @property
    def error(self) -> float:
        """Error at the finest rung, in m."""
        return self.errors[-1]

    @property
    def converges(self) -> bool:
        """True if the estimate covers the error."""
        return self.error <= self.estimate

    @property
    def conclusive(self) -> bool:
        """True if the estimate is small enough to exclude another law."""
        return self.estimate <= self.resolution


Part = Friction | Creep | Lag | Motion


def friction(engine: Engine) -> Friction:
    """Return the friction law that decelerates blocks on a plane at rest."""
    ladder = Ladder.of(engine, functools.partial(probes.forces, engine))
    noise = engine.precision * probes.SPEED * probes.SLIDE.mass / (probes.FRICTION * probes.SLIDES_FOR)
    return fitted(ladder.finest, float(np.max(ladder.error[:, :2])) + noise)


def creep(engine: Engine) -> Creep:
    """Return the creep of blocks under loads that friction can hold."""
    ladder = Ladder.of(engine, functools.partial(probes.creep, engine))
    half = ladder.values[:, probes.PULLS.index(0.5)]
    order = falling(np.abs(half), step_ratio(engine))
    return Creep(float(half[-1]), order, *smoothing_of(ladder.finest))


def lag(engine: Engine) -> Lag:
    """Return the delay of friction behind the slip."""
    ladder = Ladder.of(engine, functools.partial(probes.lag, engine))
    return Lag(float(ladder.finest), float(ladder.error), falling(np.abs(ladder.values), step_ratio(engine)))


def motion(engine: Engine, name: str) -> Motion:
    """Return the errors of the motion ``MOTIONS[name]``."""
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
    """Return the order from the last two of ``sizes`` and the ``ratio`` of their steps; NaN if undefined."""
    if len(sizes) < 2 or not (0.0 < sizes[-2] < math.inf and 0.0 < sizes[-1] < math.inf):
        return math.nan
    return math.log(sizes[-2] / sizes[-1]) / math.log(ratio)


PROBES: dict[str, type[Any]] = {"law": Friction, "creep": Creep, "lag": Lag}
"""Parts that identify the friction law, and their results."""


def parts_of(engine: Engine) -> dict[str, Callable[[Engine], Part]]:
    """Return the measurements that apply to an engine by name: the friction law first, then the motions.

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
