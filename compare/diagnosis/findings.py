"""Parts of an engine's diagnosis, measured separately, so a hanging part does not affect the others."""

import functools
import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from compare.claims.error_estimates import ROUNDING
from compare.claims.parameters import FIG11
from compare.diagnosis import joint_probes, probes
from compare.diagnosis.causes.course import Course, course
from compare.diagnosis.causes.output import Output, output
from compare.diagnosis.causes.patch import Patch, patch
from compare.diagnosis.joint_probes import Joint
from compare.diagnosis.ladder import HALVED, SAFETY, Ladder, falling, step_ratio, tolerances
from compare.diagnosis.laws import Friction, fitted, smoothing_of
from compare.diagnosis.scaling import Scales
from compare.engines import USUAL_TOLERANCE, Engine
from compare.engines.engine import LEAST_STEP
from compare.foreign import CASES
from reference_model.systems import FloatArray

NEGLIGIBLE = 1e-6  # error over resolution that shows no other law
PER_STEP = 0.2  # largest deviation from −1 of a force's order that shows a bounded impulse per step
SAME = 0.8  # creep is independent of the rung if no value is below this share of the largest
HELD = 0.05  # a block is held if its mean speed is below this share of a Coulomb block's

MOST_HELD, BISECTIONS = 32.0, 20

RING: dict[str, Any] = {
    "name": "disc on a ring",
    "sentence": "A ring follows Coulomb's law",
    "system": FIG11,
}
MOTIONS = CASES | {"ring": replace(CASES["disc"], **RING)}


def heading(part: str) -> str:
    """Return the name of a motion, or that of another part unchanged."""
    return MOTIONS[part].name if part in MOTIONS else part


@dataclass(frozen=True)
class Creep:
    """Creep in m/s of a block that friction should hold, at the finest rung.

    Orders refer to the step, or to the tolerance if the step is not fixed; NaN if undefined.
    """

    speed: float  # under a load of μN/2
    order: float
    smoothing: str  # friction law that explains the creep, or ""
    epsilon: float  # its regularisation
    chatter: float = 0.0  # largest deviation of the velocity from the creep
    chatter_order: float = math.nan


@dataclass(frozen=True)
class History:
    """Dependence of friction on the motion before."""

    static: float  # largest load/μN that friction holds from rest, at least 1
    second: float  # distance of a second release, divided by the exact one
    second_error: float
    delay: float  # delay of the release from rest, in s
    delay_error: float
    second_delay: float  # delay of the motion after two releases, in s
    second_delay_error: float
    rest: float  # creep in m/s close to release, or at rest after a slide; 0 if it depends on the rung
    asleep: float = 0.0  # largest distance in m that a block moved before it was held again


@dataclass(frozen=True)
class Shares:
    """Forces divided by the exact forces, and their errors; NaN for a missing force.

    They refer to ``probes.SUPPORTS`` or ``NONLINEAR``, shape (n,), to force and moment on discs, shape (n, 2), or
    friction far from the axis, shape (1,).
    """

    shares: FloatArray
    errors: FloatArray


@dataclass(frozen=True)
class Repeat:
    """Difference between two equal calls, as a share of the states, and the declared precision.

    ``deaf`` is True if a motion does not change with the tolerance or the step. ``shift`` is the difference, as a
    share of the states, from the same motion that starts at ``LATER``. ``floor`` is the smallest step in s if the
    motion is the same at twice this step, and otherwise 0.
    """

    difference: float
    declared: float
    deaf: bool = False
    shift: float = 0.0
    floor: float = 0.0


@dataclass(frozen=True)
class Lag:
    """Delay in s of friction behind the slip, its error, and its order in the step."""

    seconds: float
    error: float
    order: float


@dataclass(frozen=True)
class Motion:
    """Errors in m of one case of ``compare.foreign``."""

    errors: tuple[float, ...]  # largest over time at each rung
    estimate: float  # estimate of the last error from the changes between rungs
    order: float  # as in ``Creep``
    resolution: float  # a tenth of the change due to another friction law
    seconds: float  # processor time at the finest rung

    @property
    def error(self) -> float:
        """Error in m at the finest rung."""
        return self.errors[-1]

    @property
    def converges(self) -> bool:
        """True if the estimate covers the error, or the error is negligible."""
        return self.error <= max(self.estimate, NEGLIGIBLE * self.resolution)

    @property
    def conclusive(self) -> bool:
        """True if the estimate excludes another law."""
        return self.estimate <= self.resolution

    @property
    def mark(self) -> str:
        """Mark of the verdict, as in the report."""
        return "✗" if not self.converges else "✓" if self.conclusive else "?"


def friction(engine: Engine) -> Friction:
    """Return the friction law of blocks on a plane at rest."""
    values = _slides(engine, probes.headings()).values.copy()
    load = float(np.min(values[-1, :, probes.CONDITIONS][:, 1]))
    sizes = np.max(np.hypot(values[..., 0], values[..., 1]), axis=1)
    step = math.nan
    if engine.step is not None and abs(falling(sizes, HALVED) + 1.0) < PER_STEP:
        step = engine.step
        values[..., probes.FORCE] *= (sizes[-1] / sizes)[:, None, None]
    error = float(np.max(Ladder(values).error[:, probes.FORCE]))
    found = fitted(values[-1, :, :4], error + float(np.max(values[-1, :, probes.NOISE])))
    return replace(found, per_step=found.strength * step, load=load)


def _slides(engine: Engine, pushes: Sequence[probes.Push]) -> Ladder:
    rungs = tolerances(engine).tolist()
    for saturates in (rungs[0], rungs[-1]):  # a bounded impulse per step is a larger force at the last rung
        pushes = probes.unsaturated(engine, pushes, saturates)
        runs = [
            probes.slides(engine, pushes, rung, probes.FEWEST_PANELS << i) for i, rung in enumerate(rungs)
        ]
        found = Ladder(np.array(runs))
        if np.min(found.finest[:, probes.LEFT]) >= 1.0 - probes.SPENT:
            break
    return found


def scales(engine: Engine) -> Scales:
    """Return friction forces over wide ranges."""
    pushes = probes.draws(turning=False, limits=engine.limits)
    if engine.simulates(probes.TURN):
        pushes += probes.draws(turning=True, limits=engine.limits)
    ladder = _slides(engine, pushes)
    finest, changes = ladder.finest, np.abs(np.diff(ladder.values[-3:], axis=0))
    error = SAFETY * np.max(np.hypot(changes[..., 0], changes[..., 1]), axis=0)
    error += SAFETY * np.max(np.hypot(changes[..., 2], changes[..., 3]), axis=0)
    return Scales(
        finest[:, probes.CONDITIONS],
        finest[:, probes.FORCE],
        ladder.values[-2, :, probes.FORCE],
        finest[:, probes.SLIP],
        finest[:, probes.RADIAL],
        error + finest[:, probes.NOISE] + ROUNDING,
        finest[:, probes.BEGUN],
    )


def creep(engine: Engine) -> Creep:
    """Return the creep under loads that friction can hold."""
    ladder = Ladder.of(engine, functools.partial(probes.pulled, engine, probes.PULLS))
    half, ratio = np.abs(ladder.values[:, probes.PULLS.index(0.5)]), step_ratio(engine)
    shaking = np.max(ladder.values[:, :, 1], axis=1)
    return Creep(
        float(ladder.finest[probes.PULLS.index(0.5), 0]),
        falling(half[:, 0], ratio),
        *smoothing_of(ladder.finest[:, 0]),
        float(shaking[-1]),
        falling(shaking, ratio),
    )


def history(engine: Engine) -> History:
    """Return the largest load held from rest, and friction after a slide."""
    pulls, gravity = np.array(probes.BEYOND), probes.FRICTION / probes.SLIDE.mass
    ladder = Ladder.of(engine, functools.partial(probes.pulled, engine, probes.BEYOND))
    moves = ladder.finest[:, 0] > HELD * (pulls - 1.0) * gravity * probes.PULLED_FOR
    _, _, gained, speed, _ = ladder.values[:, -1].T
    asleep = ladder.finest[~moves, 4]
    rate = probes.pulled_block(pulls[-1]).natural_frequency
    start, phase = (pulls[-1] - 1.0) * gravity, 0.5 * rate * probes.PULLED_FOR
    exact, acceleration = start * math.sin(phase) / rate, start * math.cos(phase)
    delay = Ladder((exact - speed) / np.where(gained == 0.0, np.inf, acceleration))
    second = Ladder.of(engine, functools.partial(probes.second_release, engine))
    rest = Ladder.of(engine, functools.partial(probes.at_rest, engine))
    return History(
        1.0 if moves[0] else _held(engine, probes.BEYOND),
        float(second.finest[0]),
        float(second.error[0]),
        float(delay.finest),
        float(delay.error),
        float(second.finest[1]),
        float(second.error[1]),
        float(rest.finest) if np.min(rest.values) > SAME * np.max(rest.values) else 0.0,
        float(np.max(asleep, initial=0.0)),
    )


def _held(engine: Engine, pulls: Sequence[float]) -> float:
    least, most = pulls[0], MOST_HELD
    for number in range(BISECTIONS):
        middle = (
            pulls[number]
            if 0 < number < len(pulls) and least < pulls[number] < most
            else math.sqrt(least * most)
        )
        ((speed, *_),) = probes.pulled(engine, (middle,), float(tolerances(engine)[-1]))
        if speed > HELD * (middle - 1.0) * probes.FRICTION / probes.SLIDE.mass * probes.PULLED_FOR:
            most = middle
        else:
            least = middle
    return least


def support(engine: Engine, parts: Mapping[str, Any] = probes.SUPPORTS) -> Shares:
    """Return the forces of spring, damper and offset without friction, or of other ``parts``."""
    ladder = Ladder.of(engine, functools.partial(probes.supports, engine, parts))
    noise = SAFETY * engine.noise / (probes.SLIDES_FOR - probes.SETTLES_FOR)
    return Shares(ladder.finest, ladder.error + noise)


def far(engine: Engine) -> Shares:
    """Return the friction force far from the axis."""
    ladder = Ladder.of(engine, functools.partial(probes.far_away, engine))
    noise = SAFETY * engine.noise * probes.FAR / (probes.FRICTION * probes.SLIDES_FOR)
    return Shares(ladder.finest, ladder.error + noise)


def moments(engine: Engine) -> Shares:
    """Return force and moment on discs, on a ring and on points."""
    kinds = [points for points in (None, 6) if engine.simulates(probes.discs(points)[0][0])]
    ladder = Ladder.of(
        engine, lambda tolerance: np.vstack([probes.moments(engine, points, tolerance) for points in kinds])
    )
    changes = np.max(np.abs(np.diff(ladder.values[-3:], axis=0)), axis=0)
    noise = SAFETY * engine.noise * probes.SPEED / (probes.FRICTION * probes.SLIDES_FOR)
    return Shares(ladder.finest, SAFETY * changes + noise)


LATER = 4.0
"""Time in s of a later start. The motion does not depend on time, so its states must be the same."""


def repeat(engine: Engine) -> Repeat:
    """Return the differences between two equal calls and a later start."""
    motion: Any = (probes.TURN, (0.0, 0.0, probes.SPEED, 0.0), (0.0, probes.TURNS_FOR))
    if not engine.simulates(probes.SWING):
        motion = (joint_probes.JOINT, (0.0, joint_probes.STOPS), (0.0, 0.5))
    elif not engine.simulates(probes.TURN):
        motion = (probes.SWING, (1.0, 0.0, 0.0, 0.0), (0.0, 0.5))
    later = (*motion[:2], tuple(LATER + time for time in motion[2]))
    asked = (
        (motion, USUAL_TOLERANCE),
        (motion, USUAL_TOLERANCE),
        (later, USUAL_TOLERANCE),
        (motion, float(tolerances(engine)[0])),
        (motion, float(tolerances(engine)[-2])),
    )
    usual, again, moved, coarse, next_step = (
        engine.simulate(*one, tolerance=rung).states for one, rung in asked
    )
    difference, shift = (
        float(np.max(np.abs(other - usual)) / np.max(np.abs(usual))) for other in (again, moved)
    )
    deaf = bool(np.array_equal(usual, coarse))
    floor = engine.step if engine.step and not deaf and np.array_equal(usual, next_step) else 0.0
    return Repeat(difference, engine.noise, deaf, shift, floor)


def lag(engine: Engine) -> Lag:
    """Return the delay of friction behind the slip."""
    ladder = Ladder.of(engine, functools.partial(probes.lag, engine))
    return Lag(float(ladder.finest), float(ladder.error), falling(np.abs(ladder.values), step_ratio(engine)))


FINER, AFFORDABLE = 4.0, 5.0
"""Ratio of steps when a motion that does not converge is repeated, and largest processor time in s of the
repetition."""


def motion(engine: Engine, name: str) -> Motion:
    """Return the errors of the motion ``MOTIONS[name]``.

    An implicit method may damp a vibration completely at all steps of a ladder, so a motion that converges to another
    is repeated with smaller steps.
    """
    found = _motion(engine, name)
    if engine.step is None or found.converges or found.error < found.resolution:
        return found
    if FINER**2 * found.seconds > AFFORDABLE or engine.step < FINER * LEAST_STEP:
        return found
    return _motion(replace(engine, step=engine.step / FINER), name)


def _motion(engine: Engine, name: str) -> Motion:
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
    rounding = (ROUNDING + engine.noise) * max(map(abs, case.start))
    order = falling(errors, step_ratio(engine))
    return Motion(tuple(errors), SAFETY * change + rounding, order, case.resolution, seconds)


def _plane(numbers: np.ndarray) -> FloatArray:
    return np.stack((numbers.real, numbers.imag), axis=-1)


def _largest(vectors: FloatArray) -> float:
    return float(np.max(np.hypot(*vectors.T)))


PROBES: dict[str, type[Any]] = {
    "law": Friction,
    "scales": Scales,
    "creep": Creep,
    "history": History,
    "support": Shares,
    "far": Shares,
    "repeat": Repeat,
    "course": Course,
    "nonlinear": Shares,
    "output": Output,
    "lag": Lag,
    "moments": Shares,
    "patch": Patch,
    "joint": Joint,
    "hour": float,
}
"""Parts that identify the friction law."""


def parts_of(engine: Engine) -> dict[str, Callable[[Engine], object]]:
    """Return the measurements that apply to an engine by name, in their order."""
    parts: dict[str, Callable[[Engine], object]] = {}
    if engine.simulates(probes.SLIDE):
        parts |= {"law": friction, "scales": scales, "creep": creep, "history": history}
        parts |= {"support": support, "far": far, "repeat": repeat, "course": course}
        if engine.nonlinear:
            parts["nonlinear"] = functools.partial(support, parts=probes.NONLINEAR)
    of_discs = any(engine.simulates(probes.discs(points)[0][0]) for points in (None, 6))
    if of_discs or engine.simulates(probes.SMOOTH):
        parts["output"] = output
    parts |= {"lag": lag} if engine.simulates(probes.TURN) else {}
    if of_discs:
        parts |= {"moments": moments, "patch": patch}
    if engine.simulates(joint_probes.JOINT):
        parts |= {"repeat": repeat, "joint": joint_probes.joint, "hour": joint_probes.hour}
    return parts | {
        name: functools.partial(motion, name=name)
        for name, case in MOTIONS.items()
        if engine.simulates(case.system)
    }
