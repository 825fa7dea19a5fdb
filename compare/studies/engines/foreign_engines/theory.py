"""Tables of all recorded settings: how far off, at what cost, how they were set."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from compare.claims import COARSENING, ROUNDING, Claim, ErrorBudget, Recorded, refined
from compare.claims.parameters import parameters_of
from compare.claims.prose import Table
from compare.foreign import CASES, ERROR, SECONDS, STEPS, TOLERANCE, Case, Recording, estimate, recordings
from reference_model import Phase, Solution, Trajectory, plain
from reference_model.systems import FloatArray

# --- Which recorded settings share a law of friction or an order, and what is listed of all.

FIRST_ORDER = (
    "MuJoCo, elliptic cone",
    "Bullet, cone",
    "Drake, TAMSI",
    "Drake, SAP",
    "Drake, lagged",
    "DART, NSGS",
    "DART, FBF",
    "Bullet, our force",
    "DART, our force",
    "Chipmunk, pivot joint",
    "Box2D, friction joint",
    "Rapier, contact",
    "Jolt, contact",
)
"""Settings whose steps are of order 1 where contact slides, and whose friction is Coulomb's, at least for a pin."""

SINGLE_PRECISION = ("Box2D, friction joint", "Rapier, contact", "Jolt, contact")
"""Settings whose rounding grows beyond the error of a step before that is halved often."""

OFF_FOR_DISCS = ("Bullet, cone", "Chipmunk, pivot joint")
"""Settings that know Coulomb's friction for a pin, and another law for a disc on several points."""

BOXES, PYRAMIDS = ("Bullet, box", "DART, Dantzig", "DART, PGS"), ("MuJoCo, pyramidal cone",)

BY_AXIS = PYRAMIDS + BOXES
"""Settings whose friction knows two axes of the world instead of a direction."""

STICKING = (
    *(name for name in FIRST_ORDER if name not in ("Drake, SAP", "Drake, lagged", *SINGLE_PRECISION)),
    "MuJoCo, elliptic cone, RK4",
    "MuJoCo, our force",
)
"""Settings with Coulomb friction and steps of a fixed length, that can be halved four times before errors grow."""

TANGENTS = (
    *("Bullet, cone", "Bullet, box", "DART, NSGS", "DART, FBF", "DART, Dantzig", "DART, PGS"),
    *("Chipmunk, pivot joint", "Box2D, friction joint"),
)
"""Settings that leave no slip at the end of a step in which contact sticks, and whose rounding does not show."""

WANTED = 1e-3
"""Error in m, the time to which is listed: the largest that shows in no picture of the paper."""

HALVED = 0.02
"""How far the quotient of two numbers of steps may be from 2, as steps divide the interval between output times."""


# --- The recorded ladders of runs with ever smaller tolerance, and what is read off them.


@functools.cache
def recorded() -> tuple[Recording, ...]:
    """Return all recordings, read once."""
    return recordings()


def halvings(runs: FloatArray) -> FloatArray:
    """Return those last of ``runs`` between which the step was halved each time, shape (m, columns)."""
    ratios = runs[1:, STEPS] / runs[:-1, STEPS]
    strange = np.nonzero(np.abs(ratios - 2.0) > HALVED)[0]
    # A ladder may end in a step that is the engine's smallest.
    if strange.size and strange[-1] == len(ratios) - 1:
        return halvings(runs[:-1])
    return runs[strange[-1] + 1 :] if strange.size else runs


# --- What engines do that are not Coulomb's: friction that knows two axes of the world, and stick along tangents.

Law = Callable[[complex, float], complex]
"""Friction against a slip in m/s, as a fraction of μN, smoothed over a slip speed ε in m/s."""


def box(slip: complex, epsilon: float) -> complex:
    """Return what each axis has by itself: up to √2 times too large."""
    x, y = slip.real, slip.imag
    return -complex(x / max(abs(x), epsilon), y / max(abs(y), epsilon))


def pyramid(slip: complex, epsilon: float) -> complex:
    """Return what takes most power out of the slip with |F_x| + |F_y| <= μN: all along the axis nearest to it."""
    x, y = slip.real, slip.imag
    share = min(max(0.5 + 0.5 * (abs(x) - abs(y)) / epsilon, 0.0), 1.0)
    return -complex(share * x / max(abs(x), epsilon), (1.0 - share) * y / max(abs(y), epsilon))


def creep(steps: int) -> float:
    """Return how far ``steps`` along tangents of its circle carry a stuck pin off it, in m, the largest over time."""
    case = CASES["stuck"]
    i = np.linspace(0, steps, len(case.times))
    h = float(case.times[-1]) / steps
    return float(np.max(np.abs(case.start[0] * (1.0 + 1j * case.system.disc_speed * h) ** i - case.exact())))


def _run(law: Law, case: Case, epsilon: float, **options: Any) -> Any:
    """Return what ``solve_ivp`` makes of ``case`` under ``law``, smoothed over a slip of ``epsilon`` m/s."""
    pin = case.system

    def friction(slip_x: float, slip_y: float, *_: float) -> tuple[float, float, float]:
        force = pin.friction_force * law(complex(slip_x, slip_y), epsilon)
        return force.real, force.imag, 0.0

    def motion(_: float, state: np.ndarray) -> list[float]:
        return plain.rates(pin, friction, state)

    span, accuracy = (case.times[0], case.times[-1]), 1e-3 * epsilon
    return solve_ivp(
        motion, span, case.start, method="LSODA", rtol=accuracy, atol=accuracy, max_step=0.05, **options
    )


def release_by(law: Law) -> tuple[float, float]:
    """Return when a stuck pin is let go by ``law`` in s, and the error of that, see ``refined``.

    That is when its slip along an axis of the world, which creeps below ε as long as friction holds it, comes to ε.
    """
    case = CASES["release"]
    turning = 1j * case.system.disc_speed

    def time(epsilon: float) -> float:
        def beyond(_: float, state: np.ndarray) -> float:
            slip = complex(*state[2:]) - turning * complex(*state[:2])
            return max(abs(slip.real), abs(slip.imag)) - epsilon

        beyond.terminal, beyond.direction = True, 1.0  # type: ignore[attr-defined]
        events = _run(law, case, epsilon, events=beyond).t_events[0]
        return float(events[0]) if len(events) else math.nan

    value, error = refined(time, 1e-5)
    return float(value), float(error)


def release_where(held: Callable[[complex], float]) -> float:
    """Return when a stuck pin's pull, as a fraction of μN, leaves ``held`` <= 1, in s, by (6) in closed form."""
    case = CASES["release"]
    pin, start = case.system, complex(*case.start[:2])
    carried = pin.stiffness - pin.mass * pin.disc_speed**2 + 1j * pin.damping * pin.disc_speed

    def excess(time: float) -> float:
        pull = carried * start * np.exp(1j * pin.disc_speed * time) - pin.stiffness * pin.offset
        return held(pull / pin.friction_force) - 1.0

    times = np.linspace(case.times[0], case.times[-1], 401)
    beyond = [excess(time) > 0.0 for time in times]
    first = beyond.index(True)
    return float(brentq(excess, times[first - 1], times[first], xtol=1e-14)) if first else 0.0


def error_of(law: Law, name: str) -> tuple[float, float]:
    """Return how far off a pin is by that ``law`` in the case of that ``name``, in m, and the error of that number.

    It is from the change at smaller ε and tolerance, see ``refined``.
    """
    case = CASES[name]
    pin = case.system

    def off(epsilon: float) -> float:
        span, accuracy = (case.times[0], case.times[-1]), 1e-3 * epsilon
        run = _run(law, case, epsilon, t_eval=case.times)
        solution = Solution("LSODA", accuracy, run.nfev, len(run.t), 0.0, epsilon)
        phases = (Phase("slip", *span, run.y[:, 0]),)
        found = case.quantity(Trajectory(pin, case.times, run.y.T, phases, solution))
        return float(np.max(np.abs(found - case.exact())))

    value, error = refined(off, 1e-5)
    return float(value), float(error)


# --- What each recorded engine makes of each case: whether its motion comes to the exact one as the tolerance falls.

OUR_FORCE = "our force"
"""The setting of engines in which friction is none of theirs."""

IN_SHORT = {
    "slip": ("slides", "slip"),
    "stick-slip": ("sticks 9 times", "stick"),
    "whirl": ("whirls", "slip"),
    "stuck": ("stays stuck", "stick"),
    "release": ("lets go", "stick"),
    "disc": ("disc, 6 points", "slip"),
}
"""Of each case a name and whether it slips or sticks."""


def recorded_settings() -> tuple[Recorded, ...]:
    """Return what the report's matrix shows of each setting."""
    return tuple(recorded_claims(recording) for recording in recorded())


def recorded_claims(recording: Recording) -> Recorded:
    """Return the claim of each case that one setting of an engine simulates, from its finest run."""
    claims = []
    for name, runs in recording.runs.items():
        case = CASES[name]
        rounding = ROUNDING * max(map(abs, case.start))
        claims.append(
            Claim(
                case.sentence,
                equation=case.equation,
                kind=case.kind,
                engine=recording.name,
                predicted=np.array(0.0),
                measured=runs[-1, ERROR],
                budget=ErrorBudget(estimate(runs) + rounding, resolution=case.resolution),
                parameters=parameters_of(case.system)
                | {"tolerance": float(runs[-1, TOLERANCE]), "steps": float(runs[-1, STEPS])},
                source=f"Recorded on {recording.recorded} with {recording.engine} {recording.version}, "
                f"{recording.platform}; {case.title}",
                unit="m",
                note="How far the finest run is off the exact motion, the largest over time. Numerical error: what "
                "the last two refinements of the tolerance changed. Resolution: a tenth of what another law of "
                "friction, or a pin that lets go, would change.",
            )
        )
    return Recorded(
        recording.engine,
        recording.setting,
        recording.version,
        recording.recorded,
        tuple(claims),
        own=recording.setting != OUR_FORCE,
        cases={CASES[name].sentence: words for name, words in IN_SHORT.items()},
    )


# --- Tables of all recorded settings: how far off, at what cost, how they were set.


def _finest(runs: FloatArray) -> str:
    """Return in words the error in m of the finest of ``runs``, its estimate and, of several runs, the order."""
    steps, error = runs[:, STEPS], runs[:, ERROR]
    if len(runs) == 1 or not np.all(error[-2:] > 0.0):
        return f"{error[-1]:.1g}"
    order = math.log(error[-2] / error[-1]) / math.log(steps[-1] / steps[-2])
    return f"{error[-1]:.2g} ± {estimate(runs):.1g}, order {order:.1f}"


def time_to(wanted: float, runs: FloatArray) -> str:
    """Return in words the processor time in ms that an error of ``wanted`` takes, between runs by powers of it."""
    good = np.nonzero(runs[:, ERROR] <= wanted)[0]
    if not good.size:
        return "not reached"
    i = int(good[0])
    if i == 0:
        return f"≤ {1e3 * runs[0, SECONDS]:.3g}"
    error, seconds = np.log(runs[i - 1 : i + 1, ERROR]), np.log(runs[i - 1 : i + 1, SECONDS])
    return f"{1e3 * math.exp(np.interp(math.log(wanted), error[::-1], seconds[::-1])):.3g}"


def _of_each_case(recording: Recording, words: Callable[[FloatArray], str]) -> list[str]:
    """Return ``words`` about the runs of each case."""
    return [words(recording.runs[case]) if case in recording.runs else "not simulated" for case in CASES]


def tables() -> tuple[Table, ...]:
    """Return how far each setting is off, what it costs, and how it was set."""
    titles = tuple(case.title for case in CASES.values())
    finest = tuple((recording.name, *_of_each_case(recording, _finest)) for recording in recorded())
    cost = tuple(
        (recording.name, *_of_each_case(recording, functools.partial(time_to, WANTED)))
        for recording in recorded()
    )
    how = tuple(
        (recording.name, recording.version, recording.says, f"{recording.recorded}, {recording.platform}")
        for recording in recorded()
    )
    return (
        Table(
            "How far the finest run of each setting is off the exact motion, in m, the largest difference over time, "
            f"± what its last two refinements, to {COARSENING:g} times less tolerance, changed: from these is the "
            "verdict in the matrix. Orders are in the number of steps, from the last refinement.",
            ("Engine, setting", *titles),
            finest,
        ),
        Table(f"Time in ms of one core to an error of {WANTED:g} m.", ("Engine, setting", *titles), cost),
        Table("How they were set and recorded.", ("Engine, setting", "Version", "Setting", "Recorded"), how),
    )
