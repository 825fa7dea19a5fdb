"""Coulomb friction benchmark: closed-form cases for any physics engine, in one file that needs only NumPy.

Copy this file into your project. Write ``simulate(case, times)`` for your engine and call ``run(simulate)``, or

    python friction_benchmark.py mymodule:simulate > results.json
"""

import importlib
import json
import math
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Case:
    """A point mass, or a thin ring, on a horizontal plate that may rotate about the origin, or a joint; SI units.

    The force on the mass is ``force`` − stiffness·position − damping·velocity, plus friction of at most ``friction``.
    ``start`` is (x, y, vx, vy), and ``plate_speed`` an angular speed. A ring lies on the plate under uniform
    pressure. It has the ``radius`` R, the moment of inertia m·R² and the initial ``spin``.

    A case with an ``inertia`` is a joint about a fixed axis. Its angle is x, its spin vx, and all forces are moments;
    the applied one grows from ``force[0]`` at the rate ``growth``. At rest, friction is at most ``static_ratio``
    times ``friction``.
    """

    name: str
    friction: float
    start: tuple[float, float, float, float]
    until: float
    measured: str  # "x", "distance", "heading" or "radius" at the end
    expected: float
    scale: float  # the error divided by this is the relative error
    formula: str
    mass: float = 1.0
    force: tuple[float, float] = (0.0, 0.0)
    stiffness: float = 0.0
    damping: float = 0.0
    plate_speed: float = 0.0
    radius: float = 0.0
    spin: float = 0.0
    inertia: float = 0.0
    static_ratio: float = 1.0
    growth: float = 0.0


TOLERANCES = {"exact": 1e-6, "good": 1e-3, "fair": 1e-2}
"""Largest relative error of each grade. An error of 1e-2 of a stopping distance is visible, 1e-3 hardly is."""

NOT_SIMULATED = "not simulated"

GRAVITY = 9.81


def ramps() -> Iterator[Case]:
    """Yield a mass released on slopes: it rests up to tan θ = μ, then slides with g·(sin θ − μ·cos θ)."""
    for mu in (0.1, 0.3, 0.6):
        for slope in (0.5, 0.99, 1.01, 1.5):  # tan θ/μ; 0.5 shows creep, 0.99 and 1.01 show breakaway
            theta = math.atan(slope * mu)
            pull, hold = GRAVITY * math.sin(theta), GRAVITY * mu * math.cos(theta)
            path = 0.5 * max(0.0, pull - hold) * 2.0**2
            name = f"ramp, μ = {mu:g}, tan θ = {slope:g} μ"
            formula = "x = t²·g·(sin θ − μ·cos θ)/2, at least 0"
            yield Case(name, hold, (0.0,) * 4, 2.0, "x", path, path or 2.0 * hold, formula, force=(pull, 0.0))


def joints() -> Iterator[Case]:
    """Yield a joint that stops, a joint that breaks away, and a joint that a moment turns back."""
    inertia, friction, spin = 0.5, 2.0, 2.0
    start, rest = (0.0, 0.0, spin, 0.0), (0.0, 0.0, 0.0, 0.0)
    # Friction slows the joint down at F/J from ω until it rests for good: φ = J·ω²/(2F).
    angle = inertia * spin**2 / (2.0 * friction)
    yield Case("joint, stop", friction, start, 2.0, "x", angle, angle, "J·ω²/(2F)", inertia=inertia)
    # It holds until q·t = r·F. With τ since then, J·φ'' = (r − 1)·F + q·τ, so φ = ((r − 1)·F·τ²/2 + q·τ³/6)/J.
    ratio, growth, until = 1.5, 2.0, 2.5
    tau = until - ratio * friction / growth
    angle = ((ratio - 1.0) * friction * tau**2 / 2.0 + growth * tau**3 / 6.0) / inertia
    law = "φ = ((r − 1)·F·τ²/2 + q·τ³/6)/J after the time r·F/q"
    case = Case("joint, breakaway", friction, rest, until, "x", angle, angle, law, inertia=inertia)
    yield replace(case, static_ratio=ratio, growth=growth)
    # A moment −M slows it down at (M + F)/J until t₁ = J·ω/(M + F), and then turns it back at (M − F)/J.
    moment, until = 4.0, 1.0
    slows = inertia * spin / (moment + friction)
    back = (moment - friction) / inertia * (until - slows) ** 2 / 2.0
    angle, law = spin * slows / 2.0 - back, "φ = ω·t₁/2 − (M − F)·(t − t₁)²/(2J) with t₁ = J·ω/(M + F)"
    case = Case("joint, turned back", friction, start, until, "x", angle, back, law, inertia=inertia)
    yield replace(case, force=(-moment, 0.0))


def at_rest_after_swings(start: float, least: float) -> float:
    """Return where a mass on a spring, released at ``start`` > 0, stops; ``least`` = F/C."""
    swings = max(0, math.ceil((start - least) / (2.0 * least)))
    return float((-1.0) ** swings) * (start - 2.0 * swings * least)


def cases() -> tuple[Case, ...]:
    """Return all cases."""
    rest = at_rest_after_swings(9.5, 1.0)
    stop = (0.0, 0.0, 0.6, 0.8)
    swings = "x = (−1)ⁿ·(x₀ − 2n·F/C) after n half swings, with the first |x| ≤ F/C"
    found = [*ramps(), *joints()]
    for mass in (0.01, 1.0, 100.0):
        path = mass * 1.0**2 / (2.0 * 3.0 * mass)
        name = f"stopping distance, {mass:g} kg"
        found.append(Case(name, 3.0 * mass, stop, 1.0, "distance", path, path, "m·v²/(2F)", mass=mass))
    for angle in (10.0, 45.0, 80.0):
        start = (0.0, 0.0, math.cos(math.radians(angle)), math.sin(math.radians(angle)))
        expected = math.radians(angle)
        found.append(
            Case(f"heading, {angle:g}°", 3.0, start, 1.0, "heading", expected, 1.0, "the path is straight")
        )
    found += [
        Case(
            "creep for 100 s at half load", 1.0, (0.0,) * 4, 100.0, "x", 0.0, 1.0, "x = 0", force=(0.5, 0.0)
        ),
        Case(
            "spring, position of rest", 1.0, (9.5, 0.0, 0.0, 0.0), 20.0, "x", rest, 9.5, swings, stiffness=1.0
        ),
        Case(
            "whirl on a turntable",
            1.0,
            (1.0, 0.0, 0.0, 1.0),
            80.0,
            "radius",
            2.0,
            2.0,
            "r = F/(c·√(C/m)), if the turntable is faster than √(C/m)",
            stiffness=1.0,
            damping=0.5,
            plate_speed=2.0,
        ),
        # At v = ωR, friction averages 2/π of its limit and of its largest moment, so v/(ωR) stays 1 until both stop.
        Case(
            "thrown spinning ring",
            3.0,
            stop,
            1.0,
            "distance",
            math.pi / 12.0,
            math.pi / 12.0,
            "π·m·v²/(4F), if v = ω·R",
            radius=0.1,
            spin=10.0,
        ),
    ]
    return tuple(found)


def measured(case: Case, states: Any) -> float:
    """Return the measured number of a case."""
    x, y = np.asarray(states[-1])[:2] - (0.0 if case.measured == "radius" else np.asarray(states[0])[:2])
    if case.measured == "x":
        return float(states[-1][0])
    return float(math.atan2(y, x) if case.measured == "heading" else math.hypot(x, y))


def run(simulate: Callable[[Case, Sequence[float]], Any]) -> dict[str, Any]:
    """Return the results of all cases as a dictionary that JSON can hold.

    ``simulate(case, times)`` returns the states (x, y, vx, vy) at both times, shape (2, 4). It raises
    ``NotImplementedError`` for a case that the engine does not simulate. After another exception the case fails.
    """
    results: list[dict[str, Any]] = []
    for case in cases():
        try:
            value = measured(case, simulate(case, [0.0, case.until]))
        except Exception as error:  # an engine may raise anything
            grade = NOT_SIMULATED if isinstance(error, NotImplementedError) else "fails"
            failed = {"value": None, "error": None, "grade": grade, "reason": repr(error)}
            results.append({**asdict(case), **failed})
            continue
        off = abs(value - case.expected) / case.scale
        grade = next((name for name, largest in TOLERANCES.items() if off <= largest), "fails")
        numbers = {"value": value, "error": off}
        known = {name: number if math.isfinite(number) else None for name, number in numbers.items()}
        results.append({**asdict(case), **known, "grade": grade})
    grades = (*TOLERANCES, "fails", NOT_SIMULATED)
    score = {name: sum(one["grade"] == name for one in results) for name in grades}
    return {"score": score, "cases": results}


def status(results: dict[str, Any]) -> int:
    """Return 1 if a case fails, 3 if less than half of the cases are simulated, else 0."""
    score = results["score"]
    return 1 if score["fails"] else 3 if 2 * score[NOT_SIMULATED] > sum(score.values()) else 0


if __name__ == "__main__":
    if len(sys.argv) != 2 or ":" not in sys.argv[1]:
        sys.exit("usage: python friction_benchmark.py MODULE:FUNCTION")
    module, _, function = sys.argv[1].partition(":")
    sys.path.insert(0, "")
    found = run(getattr(importlib.import_module(module), function))
    json.dump(found, sys.stdout, indent=1)
    print(", ".join(f"{number} {grade}" for grade, number in found["score"].items()), file=sys.stderr)
    sys.exit(status(found))
