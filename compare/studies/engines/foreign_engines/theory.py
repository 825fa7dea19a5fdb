"""Recorded settings of foreign engines: friction laws, errors, orders and tables."""

import functools
import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from compare.claims import ROUNDING, Claim, ErrorBudget, Recorded, refined
from compare.claims.claim import Verdict
from compare.claims.parameters import parameters_of
from compare.claims.prose import Table
from compare.diagnosis.run import row_of
from compare.engines import INSTALLED
from compare.foreign import CASES, ERROR, SECONDS, STEPS, TOLERANCE, Case, Recording, estimate, recordings
from compare.report.numbers import error_text
from reference_model import Phase, Solution, Trajectory, plain
from reference_model.systems import FloatArray

FIRST_ORDER = (
    "MuJoCo, elliptic cone",
    "Bullet, cone",
    "Drake, TAMSI",
    "Drake, SAP",
    "Drake, lagged",
    "DART, NSGS",
    "DART, FBF",
    "ODE, along the slip",
    "Bullet, our force",
    "DART, our force",
    "Chipmunk, pivot joint",
    "Box2D, friction joint",
    "Rapier, contact",
    "Jolt, contact",
)
"""Settings of order 1 during slip with Coulomb friction, at least for a pin."""

SINGLE_PRECISION = ("Box2D, friction joint", "Rapier, contact", "Jolt, contact")
"""Settings whose rounding exceeds the error of a step after a few halvings."""

OFF_FOR_DISCS = ("Bullet, cone", "Chipmunk, pivot joint")
"""Settings with Coulomb friction for a pin, but not for a disc on several points."""

BOXES, PYRAMIDS = ("Bullet, box", "DART, Dantzig", "DART, PGS"), ("MuJoCo, pyramidal cone",)

BY_AXIS = (*PYRAMIDS, *BOXES, "ODE, as shipped")
"""Settings whose friction depends on two axes of the world instead of the direction of slip."""

STICKING = (
    *(name for name in FIRST_ORDER if name not in ("Drake, SAP", "Drake, lagged", *SINGLE_PRECISION)),
    "MuJoCo, elliptic cone, RK4",
    "MuJoCo, our force",
)
"""Settings with Coulomb friction and fixed steps that can be halved four times before errors grow."""

TANGENTS = (
    *("Bullet, cone", "Bullet, box", "DART, NSGS", "DART, FBF", "DART, Dantzig", "DART, PGS"),
    *("Chipmunk, pivot joint", "Box2D, friction joint", "ODE, as shipped"),
)
"""Settings without slip at the end of a step during stick, and with negligible rounding."""

WANTED = 1e-3
"""Error (m) whose computing time the table lists, the largest that the paper's figures hide."""


@functools.cache
def recorded() -> tuple[Recording, ...]:
    """Return the recordings of pins; others contain only friction laws."""
    return tuple(one for one in recordings() if one.runs)


# --- Friction laws other than Coulomb's

Law = Callable[[complex, float], complex]
"""Friction/μN as a function of the slip and the smoothing slip speed ε (m/s)."""


def box(slip: complex, epsilon: float) -> complex:
    """Return friction that is bounded along each axis separately, up to √2 times too large."""
    x, y = slip.real, slip.imag
    return -complex(x / max(abs(x), epsilon), y / max(abs(y), epsilon))


def pyramid(slip: complex, epsilon: float) -> complex:
    """Return the friction with |F_x| + |F_y| <= μN that dissipates most: it acts along the axis nearest to slip."""
    x, y = slip.real, slip.imag
    share = min(max(0.5 + 0.5 * (abs(x) - abs(y)) / epsilon, 0.0), 1.0)
    return -complex(share * x / max(abs(x), epsilon), (1.0 - share) * y / max(abs(y), epsilon))


def creep(steps: int) -> float:
    """Return the largest deviation (m) of a stuck pin that moves in ``steps`` along tangents of its circle."""
    case = CASES["stuck"]
    i = np.linspace(0, steps, len(case.times))
    h = float(case.times[-1]) / steps
    return float(np.max(np.abs(case.start[0] * (1.0 + 1j * case.system.disc_speed * h) ** i - case.exact())))


def _run(law: Law, case: Case, epsilon: float, **options: Any) -> Any:
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
    """Return the time (s) when ``law`` releases a stuck pin, and its error.

    A held pin creeps along each world axis with a slip below ε, and is released when the slip reaches ε.
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
    """Return the time (s) when a stuck pin is released, in closed form.

    ``held`` maps the force (6)/μN to the used share of the friction law's limit.
    """
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


@functools.cache
def settling(law: Law) -> tuple[float, float]:
    """Return the change (m) of the radius of a whirl under ``law`` after the recorded motion, and its error.

    The motion starts on the whirl of Coulomb's law. The law's own whirl is farther out or in, and after the recorded
    100 s the approach continues. After five times that duration, exp(−βt/2m) is 1e-11.
    """
    case = CASES["whirl"]
    longer = replace(case, times=np.linspace(0.0, 5.0 * case.times[-1], 5 * len(case.times)))
    (settled, error), (recorded, _) = (error_of(law, one) for one in (longer, case))
    return settled - recorded, error


@functools.cache
def error_of(law: Law, case: Case) -> tuple[float, float]:
    """Return the deviation (m) of a pin under ``law`` from the exact motion of a case, and its error."""
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


OUR_FORCE = "our force"

AS_SHIPPED = ("Drake, lagged",)
"""Default settings with a name."""

PROGRAM = "examples/exec_contact.js"
ADAPTERS = {
    **{known.title: f"compare/engines/live/{name}_engine.py" for name, known in INSTALLED.items()},
    "reference": "reference_model/simulation.py",
    **dict.fromkeys(("exudyn", "exudyn-native"), "exudyn_models/paper/simulate.py"),
}
"""Files that run the recorded engines, relative to the folder of the packages; the others run in ``PROGRAM``."""


def recorded_settings() -> tuple[Recorded, ...]:
    return tuple(recorded_claims(recording) for recording in recorded())


def recorded_claims(recording: Recording) -> Recorded:
    claims, row = [], row_of(recording)
    sentences = {name: CASES[name].sentence for name in recording.runs}
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
                budget=ErrorBudget(
                    estimate(runs) + rounding, resolution=case.resolution, negligible=case.negligible
                ),
                parameters=parameters_of(case.system)
                | {"tolerance": float(runs[-1, TOLERANCE]), "steps": float(runs[-1, STEPS])},
                source=f"Recorded on {recording.recorded} with {recording.engine} {recording.version}, "
                f"{recording.platform}; {case.name}",
                unit="m",
                note="Largest deviation from the exact motion over time, at the smallest step or tolerance. "
                "Numerical error: twice that of Richardson's extrapolation, with the order that fits the last three "
                "changes. "
                "Resolution: a tenth of the effect of another friction law, or of a release. A deviation below a "
                "tenth of the resolution is negligible.",
            )
        )
    law = recording.probes.get("law", {})
    return Recorded(
        recording.engine,
        recording.setting,
        recording.version,
        recording.recorded,
        tuple(claims),
        own=recording.setting != OUR_FORCE,
        shipped=recording.name in AS_SHIPPED or recording.setting in ("", "as shipped"),
        cases={case.sentence: (case.name, case.truth) for case in CASES.values()},
        reasons={sentences[name]: why for name in row.motions if (why := row.reason(name))},
        costs={sentences[name]: _cost(recording, name) for name in recording.runs},
        law=law["shape"] if law.get("sure") else "",
        says=recording.says,
        adapter=ADAPTERS.get(recording.engine, PROGRAM),
        advice=_advice(recording, claims),
        whirl=float(
            (recording.runs["whirl"][-1, ERROR] + _settles(recording)) / abs(CASES["whirl"].exact()[0])
        ),
    )


def _settles(recording: Recording) -> float:
    found = recording.probes.get("law", {})
    laws = (law for law in (box, pyramid) if found.get("sure") and found["shape"].startswith(law.__name__))
    return sum(settling(law)[0] for law in laws)


def _advice(recording: Recording, claims: Sequence[Claim]) -> str:
    right = [claim.sentence for claim in claims if claim.verdict is not Verdict.DIFFERS]
    runs = {CASES[name]: rows for name, rows in recording.runs.items() if CASES[name].sentence in right}
    if not runs or recording.engine == "reference":
        return ""
    worst, rows = max(runs.items(), key=lambda one: float(one[1][-1, ERROR]))
    if rows[-1, ERROR] > WANTED:
        return (
            f"with {_refinement(recording, worst, rows[-1])} the error is {error_text(rows[-1, ERROR], 1)} m"
        )
    for_it = f"for an error of {1e3 * WANTED:g} mm"
    if recording.step is not None:
        number = max(_at(WANTED, rows, STEPS) / _periods(case) for case, rows in runs.items())
        return f"use {_rounded(number)} steps per natural period {for_it}"
    tolerance = min(_at(WANTED, rows, TOLERANCE) for rows in runs.values())
    return f"use a tolerance of {error_text(tolerance, 1)} {for_it}"


def _refinement(recording: Recording, case: Case, run: FloatArray) -> str:
    if recording.step is None:
        return f"a tolerance of {error_text(run[TOLERANCE], 1)}"
    return f"{_rounded(run[STEPS] / _periods(case))} steps per natural period"


def _cost(recording: Recording, name: str) -> str:
    run = recording.runs[name][-1]
    return f"{_refinement(recording, CASES[name], run)}, {error_text(run[SECONDS], 1)} s"


def _rounded(number: float) -> str:
    return f"{float(f'{number:.1e}'):,.0f}"


def _periods(case: Case) -> float:
    return float(case.times[-1] - case.times[0]) * case.system.natural_frequency / (2.0 * math.pi)


def _at(wanted: float, runs: FloatArray, column: int) -> float:
    """Return a column at the error ``wanted``, interpolated between runs by a power law; NaN if not reached."""
    good = np.nonzero(runs[:, ERROR] <= wanted)[0]
    if not good.size:
        return math.nan
    i = int(good[0])
    if i == 0:
        return float(runs[0, column])
    error, values = np.log(runs[i - 1 : i + 1, ERROR]), np.log(runs[i - 1 : i + 1, column])
    return math.exp(np.interp(math.log(wanted), error[::-1], values[::-1]))


def time_to(wanted: float, runs: FloatArray) -> str:
    if math.isnan(seconds := _at(wanted, runs, SECONDS)):
        return "not reached"
    return f"{'≤ ' * bool(runs[0, ERROR] <= wanted)}{1e3 * seconds:.3g}"


def _best_run(recording: Recording) -> Iterator[str]:
    motions, refined = row_of(recording).motions, "tolerance" if recording.step is None else "step"
    for name, runs in recording.runs.items():
        order = motions[name].order
        fitted = f", order {order:.1f} in the {refined}" if math.isfinite(order) else ""
        yield f"{runs[-1, ERROR]:.2g} ± {estimate(runs):.1g}{fitted}; {_cost(recording, name)}"


def _of_each_case(recording: Recording, words: Iterable[str]) -> list[str]:
    found = dict(zip(recording.runs, words, strict=True))
    return [found.get(case, "not simulated") for case in CASES]


def tables() -> tuple[Table, ...]:
    titles = tuple(case.name for case in CASES.values())
    best = tuple((one.name, *_of_each_case(one, _best_run(one))) for one in recorded())
    cost = tuple(
        (one.name, *_of_each_case(one, (time_to(WANTED, runs) for runs in one.runs.values())))
        for one in recorded()
    )
    how = tuple(
        (recording.name, recording.version, recording.says, f"{recording.recorded}, {recording.platform}")
        for recording in recordings()
    )
    spun = tuple((row.engine, row.spin[0]) for row in map(row_of, recordings()) if row.spin[0])
    return (
        Table(
            "Largest deviation from the exact motion over time in m, at the smallest step or tolerance, ± twice the "
            "error by Richardson's extrapolation of its last changes. The verdicts in the matrix follow from these "
            "numbers. Orders are fitted to the last two refinements. Fixed steps are halved. Times are those of one "
            "core.",
            ("Engine, setting", *titles),
            best,
        ),
        Table(f"Time in ms on one core for an error of {WANTED:g} m.", ("Engine, setting", *titles), cost),
        Table(
            "Disc that slides and spins, at eight ratios of slide to spin: friction law and largest deviation.",
            ("Engine, setting", "Friction law"),
            spun,
        ),
        Table("Settings and recording.", ("Engine, setting", "Version", "Setting", "Recorded"), how),
    )
