"""Detection limits: the smallest error of each parameter that turns a verdict."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from compare.claims.claim import Verdict
from compare.claims.study import Findings, Study
from compare.engines import Engine
from compare.studies.engines.trajectories.claims import measure
from compare.studies.engines.trajectories.parameters import MOTIONS
from reference_model.systems import DiscOnDisc, PinOnDisc, System
from reference_model.trajectory import Trajectory

if TYPE_CHECKING:
    pass

ERRORS = 10.0 ** (-0.5 * np.arange(2, 25))
"""Relative errors that are tried, from the largest to the smallest: powers of √10."""

ON_STIFFENING = ("hardening", "stop_gap", "stop_stiffness")

OF_PIN = ("mass", "stiffness", "damping", "friction_force", "disc_speed", "offset")

PARAMETERS: dict[str, tuple[type[System], tuple[str, ...]]] = {
    "pin": (PinOnDisc, (*OF_PIN, *ON_STIFFENING)),
    "disc": (DiscOnDisc, (*OF_PIN, "polar_inertia", "contact_radius", "shaft_damping", "shaft_speed")),
}


@dataclass(frozen=True)
class Detected:
    """The smallest relative error of a parameter that is noticed by trajectories, and by all other kinds of claims.

    Infinite where not even the largest one is.
    """

    system: str
    parameter: str
    by_trajectory: float
    by_others: float

    def as_json(self) -> dict[str, str | float | None]:
        """Return the numbers by name, none for infinity."""
        values = {"by_trajectory": self.by_trajectory, "by_others": self.by_others}
        finite = {name: value if math.isfinite(value) else None for name, value in values.items()}
        return {"system": self.system, "parameter": self.parameter, **finite}


def with_error(engine: Engine, parameter: str, error: float) -> Engine:
    """Return ``engine`` with ``parameter`` too large by ``error`` of itself."""

    def simulated(
        system: System, initial_state: ArrayLike, times: ArrayLike, *, tolerance: float = 1e-9
    ) -> Trajectory:
        wrong = replace(system, **{parameter: (1.0 + error) * getattr(system, parameter)})
        return replace(engine.simulate(wrong, initial_state, times, tolerance=tolerance), system=system)

    return Engine(f"{parameter} off by {error:g}", simulated, engine.kinds)


def limits_of(engine: Engine, system: type[System], parameter: str) -> tuple[float, float]:
    """Return the smallest error that is noticed by trajectories and by other claims, by bisection of ``ERRORS``."""
    motions = {
        name: motion
        for name, motion in MOTIONS.items()
        if isinstance(motion.system, system) and getattr(motion.system, parameter) != 0.0
    }

    @functools.cache
    def noticed_by(i: int) -> frozenset[bool]:
        """Return whether trajectories (True) and whether others (False) are among the claims that differ."""
        claims = measure(with_error(engine, parameter, float(ERRORS[i])), motions).claims
        return frozenset(claim.kind == "trajectory" for claim in claims if claim.verdict is Verdict.DIFFERS)

    return _last(lambda i: True in noticed_by(i)), _last(lambda i: False in noticed_by(i))


def _last(noticed: Callable[[int], bool]) -> float:
    """Return the smallest of ``ERRORS`` that is noticed if all larger ones are, ∞ if none is."""
    if not noticed(0):
        return math.inf
    low, high = 0, len(ERRORS)
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if noticed(middle) else (low, middle)
    return float(ERRORS[low])


def measure_limits(body: str, engine: Engine) -> Findings:
    """Find the limits for each parameter of ``body``, "pin" or "disc"."""
    system, parameters = PARAMETERS[body]
    limits = {name: np.array(limits_of(engine, system, name)) for name in parameters}
    return Findings(data={f"{body}: {name}": found for name, found in limits.items()})


def detected(outcomes: Iterable[object]) -> tuple[Detected, ...]:
    """Return what ``measure_limits`` found; failures and what is missing are left out."""
    found = []
    for outcome in outcomes:
        if isinstance(outcome, Findings):
            for key, (by_trajectory, by_others) in outcome.data.items():
                body, _, parameter = key.partition(": ")
                found.append(Detected(body, parameter, float(by_trajectory), float(by_others)))
    return tuple(found)


DETECTION = tuple(
    Study(
        name=f"detection-limits-{body}",
        title=f"The smallest error of each parameter of a {body} that is noticed",
        paper="An engine with one parameter slightly wrong, on the motions of the study of trajectories.",
        by_hand=functools.partial(measure_limits, body),
        seconds=30.0,
    )
    for body in PARAMETERS
)
