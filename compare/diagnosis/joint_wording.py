"""Sentences about the friction of a joint, the cause first."""

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from compare.diagnosis.findings import NEGLIGIBLE, Creep
from compare.diagnosis.joint_probes import HOUR, RATIO, STOPS, SUPPORTS, Joint, draws
from compare.diagnosis.ladder import SAFETY, falling
from compare.diagnosis.laws import DISTINCT, smoothing_of
from compare.diagnosis.probes import PULLS, SETTLES_FOR, SLIDES_FOR
from compare.diagnosis.scaling import MISSING
from compare.diagnosis.wording import (
    ALIKE,
    DAMPED,
    FALLS,
    LEAST_LAG,
    LEAST_SHARE,
    MOTION,
    RESTS,
    Remark,
    of_creep,
    sentence,
    size_text,
)
from compare.report.numbers import error_text
from reference_model.systems import FloatArray

JOINT, INERTIA = "Not Coulomb friction in a joint", "Wrong inertia"
"""Beginnings of a verdict."""

KNOWN = 1e-2
"""Largest error, relative to the number, of a measurement that shows something."""

COARSE = 0.1  # the same for a stop, where the errors of many steps add up

HELD = 0.011  # largest relative error of a breakaway moment that is right; bisection ends at 1 %
STEADY = 0.02  # largest spread of equal shares, relative to their deviation
RATES = 1.2  # largest ratio of the rates of one hidden damping

CREEPS = 100.0  # ratio of a speed to the creep below which creep explains weak friction

VARIABLES = ("inertia", "friction moment", "speed", "angle", "direction and the speed")
UNITS = ("kg m²", "N m", "rad/s", "rad", "rad/s")


class _Number(NamedTuple):
    """A value at the finest rung, its error, and whether it differs from the right value."""

    value: float
    error: float
    right: float

    @property
    def off(self) -> bool:
        return abs(self.value - self.right) > max(DISTINCT * self.error, LEAST_SHARE)

    @property
    def unknown(self) -> bool:
        return not self.off and self.error > COARSE


def _number(values: FloatArray, right: float, noise: float = 0.0) -> _Number:
    if not np.all(np.isfinite(values[-3:])):
        return _Number(float(values[-1]), 0.0 if math.isinf(values[-1]) else math.nan, right)
    change = float(np.max(np.abs(np.diff(values[-3:]))))
    return _Number(float(values[-1]), SAFETY * change + noise, right)


def of_joint(joint: Joint, refined: str, ratio: float, noise: float) -> list[Remark]:
    """Return how the friction of a joint differs from Coulomb's, and whether it creeps.

    ``ratio`` is the ratio of the steps or tolerances of two rungs, and ``noise`` the relative error of the states.
    """
    found = [*_of_supports(joint, noise)] or [*_of_slides(joint, refined, ratio)]
    creep = _creep(joint, ratio)
    crept = [*of_creep(creep, refined, _least(noise), "joint", "rad/s", "F")]
    wrong = [one for one in crept if one.wrong]
    fast = np.abs(draws()[:, 2]) > CREEPS * abs(creep.speed)
    if wrong and np.any(fast) and np.all(np.abs(joint.slides[-1, fast] - 1.0) < KNOWN):
        found = wrong
    if not found:
        found = [*_of_breakaway(joint)] or wrong
        found = found or [*_of_stops(joint, refined, ratio, noise)]
        found = found or [*_of_motions(joint)]
        found += [one for one in crept if not one.wrong]
    usual = Remark("", True).about
    return [one._replace(about=JOINT) if one.about == usual else one for one in found]


def right(joint: Joint, refined: str, noise: float) -> str:
    """Return a sentence about a joint that shows no errors; for ``refined`` and ``noise`` see ``of_joint``."""
    error = max(*(_number(values, 1.0).error for values in joint.slides.T), *joint.noise)
    stop = 100.0 * max(_number(values, 1.0).error for values in joint.stops.T[:2])
    rests = abs(joint.creeps[-1, PULLS.index(0.5), 0]) <= _least(noise)
    static = "" if np.isnan(joint.held[1, 0]) else f", or at {RATIO:g} F with that static ratio"
    end = "stays at rest" if rests else f"creeps ever more slowly as the {refined} decreases"
    return (
        f"Coulomb friction in a joint, accurate to {error_text(error)} times its moment F: it breaks away at F"
        f"{static} (±1 %), stops at the right time and angle (±{error_text(stop)} %), and {end}."
    )


def examined() -> str:
    """Return a sentence with the ranges of the measured joints."""
    inertia, friction, spin, _ = np.abs(draws()).T
    ranges = (
        f"{name} {error_text(float(np.min(values)))} to {error_text(float(np.max(values)))} {unit}"
        for name, unit, values in zip(VARIABLES, UNITS, (inertia, friction, spin), strict=False)
    )
    return f"Joints examined: {', '.join(ranges)}; both directions."


def _least(noise: float) -> float:
    """Return the speed in rad/s below which a joint is at rest."""
    return (RESTS + noise) * STOPS


def of_hour(angle: float, joint: Joint | None) -> Iterator[Remark]:
    """Yield how far a joint moves in an hour at rest, unless it creeps anyway."""
    creeps = 0.0 if joint is None else float(abs(joint.creeps[0, PULLS.index(0.5), 0]))
    if abs(angle) > max(2.0 * creeps * HOUR, _least(0.0) * HOUR):
        text = f"A joint under half of its limit F moves by {error_text(abs(angle))} rad in an hour."
        yield Remark(text, True, JOINT)


def _creep(joint: Joint, ratio: float) -> Creep:
    half = np.abs(joint.creeps[:, PULLS.index(0.5)])
    shaking = np.max(joint.creeps[:, :, 1], axis=1)
    speeds = joint.creeps[-1, :, 0]
    return Creep(
        float(speeds[PULLS.index(0.5)]),
        falling(half[:, 0], ratio),
        *smoothing_of(speeds),
        float(shaking[-1]),
        falling(shaking, ratio),
    )


def _of_supports(joint: Joint, noise: float) -> Iterator[Remark]:
    """Yield a wrong inertia, or each wrong moment other than friction."""
    if _rate(joint.slides[-1]):
        return
    numbers = [_number(values, 1.0, 100.0 * noise) for values in joint.supports.T]
    off = [one for one in numbers if one.off]
    if len(off) > 1:
        share = max((one.value for one in off), key=lambda value: abs(value - 1.0))
        slack = ALIKE * abs(share - 1.0)
        alike = all(abs(one.value - share) <= slack + DISTINCT * one.error for one in numbers)
        if share and alike and abs(float(np.median(joint.slides[-1])) - share) <= slack:
            text = f"The inertia is {size_text(1.0 / share)}, because all moments act alike."
            yield Remark(text, True, INERTIA)
            return
    for name, one in zip(SUPPORTS, numbers, strict=True):
        if one.off:
            size = size_text(one.value) if abs(one.value) > MISSING else "missing"
            yield Remark(f"The {name} of a joint is {size}.", True, MOTION)


def _of_slides(joint: Joint, refined: str, ratio: float) -> Iterator[Remark]:
    """Yield how the friction of a joint that turns differs from F."""
    shares = joint.slides[-1]
    numbers = [
        _number(values, 1.0, noise)
        for values, noise in zip(joint.slides.T, joint.noise.tolist(), strict=True)
    ]
    off, error = np.array([one.off for one in numbers]), max(one.error for one in numbers)
    changes = np.max(np.abs(np.diff(joint.slides, axis=0)), axis=1)
    if changes[-1] > KNOWN and not falling(changes, ratio) > FALLS:
        worst = int(np.argmax(np.abs(joint.slides[-1] - joint.slides[-2])))
        values = ", ".join(error_text(float(value)) for value in joint.slides[:, worst])
        text = f"Friction depends on the {refined} and does not converge: {values} times F, the finest last."
        yield Remark(text, True)
    elif np.any(off):
        yield Remark(_of_shares(shares, error), True, DAMPED if _rate(shares) else JOINT)
    elif error > KNOWN:
        text = f"its error is {error_text(error)} times F"
        yield Remark(f"The friction of a joint that turns could not be measured: {text}.", None)


def _of_shares(shares: FloatArray, error: float) -> str:
    if np.max(np.abs(shares)) <= MISSING:
        return "No friction was measured in a joint that turns."
    if rate := _rate(shares):
        return f"Every joint loses {error_text(100.0 * rate)} % of its speed per second."
    middle, spread = float(np.median(shares)), float(np.ptp(shares))
    if spread <= max(STEADY * abs(middle - 1.0), DISTINCT * error) and abs(middle - 1.0) > error:
        if abs(middle + 1.0) < STEADY:
            return "Friction accelerates the joint."
        return f"The friction moment of a joint that turns is {size_text(middle, error)}."
    inertia, friction, spin, angle = draws().T
    digits = 2 if spread > STEADY else 4
    least, most = (error_text(float(end), digits) for end in (np.min(shares), np.max(shares)))
    text = f"Friction of a joint that turns is {least} to {most} times F"
    if all(float(np.ptp(shares[way])) < ALIKE * spread for way in (spin > 0.0, spin < 0.0)):
        return f"{text}: it depends on the direction."
    middles = np.abs(angle + (SETTLES_FOR + 0.5 * SLIDES_FOR) * spin)
    variables = inertia, friction, np.abs(spin), middles, spin
    causes = [
        f"{name} ({error_text(float(np.min(values)))} to {error_text(float(np.max(values)))} {unit})"
        for name, unit, values in zip(VARIABLES, UNITS, variables, strict=True)
        if _is_monotone(shares[np.argsort(values)], DISTINCT * error + STEADY * spread)
    ]
    if len(causes) == 1:
        return f"{text}: it depends on the {causes[0]}."
    return f"{text}: it depends on the {', the '.join(VARIABLES[:-1])} or the direction."


def _is_monotone(values: FloatArray, slack: float) -> bool:
    """Return whether ``values`` only rise or only fall, except by ``slack``."""
    return any(bool(np.all(np.maximum.accumulate(one) - one <= slack)) for one in (values, -values))


def _rate(shares: FloatArray) -> float:
    """Return the rate in 1/s of a hidden damping that explains all shares, or 0."""
    inertia, friction, spin, _ = draws().T
    rates = (shares - 1.0) * friction / (inertia * np.abs(spin))
    alike = np.min(rates) > LEAST_SHARE and np.max(rates) < RATES * np.min(rates)
    return float(np.median(rates)) if alike else 0.0


def _of_breakaway(joint: Joint) -> Iterator[Remark]:
    """Yield a wrong breakaway moment, or a late breakaway."""
    for (held, slides), ratio in zip(joint.held.tolist(), (1.0, RATIO), strict=True):
        of = f" with a static ratio of {ratio:g}" if ratio > 1.0 else ""
        if held <= 1.0 < ratio:
            text = f"The static ratio has no effect: a joint{of} breaks away at F."
        elif held > 30.0:
            text = f"A joint at rest does not break away under 30 times its moment F{of}."
        elif ratio > 1.0 and abs(slides - 1.0) > HELD:
            text = f"A joint{of} slides with {slides:.3g} F, in place of F."
        elif abs(held / ratio - 1.0) > HELD:
            text = f"A joint at rest{of} breaks away at {held:.3g} F, in place of {ratio:g} F."
        else:
            continue
        yield Remark(text, True)
        return
    late = _number(joint.delays, 0.0)
    if late.value > max(DISTINCT * late.error, LEAST_LAG):
        yield Remark(f"A joint breaks away {error_text(1e3 * late.value)} ms late.", True)


def _of_stops(joint: Joint, refined: str, ratio: float, noise: float) -> Iterator[Remark]:
    """Yield a wrong stop, a reversal, or a swing that ends elsewhere."""
    angle, time, lowest, after, rests, chatter = (
        _number(values, expected, 100.0 * noise)
        for values, expected in zip(joint.stops.T, (1.0, 1.0, 0.0, 0.0, 0.5, 0.0), strict=True)
    )
    reverses = np.abs(joint.stops[:, 2])
    if lowest.value < -max(LEAST_SHARE, 3.0 * noise) and not falling(reverses, ratio) > FALLS:
        back = error_text(-100.0 * lowest.value)
        yield Remark(f"A joint that should stop turns back at {back} % of its initial speed.", True)
    elif after.off:
        yield Remark(
            f"A joint that has stopped creeps at {error_text(abs(after.value) * STOPS)} rad/s.", True
        )
    elif angle.off or time.off:
        yield Remark(
            f"A joint stops after {angle.value:.4g} times the right angle and {time.value:.4g} times the right time.",
            True,
        )
    elif rests.off:
        yield Remark(f"On a spring, a joint rests at {rests.value:.4g} F/C, in place of 0.5 F/C.", True)
    elif chatter.value > 1.0:
        falls = falling(joint.stops[:, 5], ratio) > FALLS
        how = f"decreasing with the {refined}" if falls else f"at any {refined}"
        text = f"friction overshoots when the speed changes its sign within a step, {how}"
        yield Remark(sentence(text), not falls)
    for name, number in (("angle", angle), ("time", time)):
        if number.unknown:
            yield Remark(
                f"The {name} of a stop is known only to {error_text(number.error)} of its size.", None
            )


def _of_motions(joint: Joint) -> Iterator[Remark]:
    """Yield whether whole motions converge to the exact motions."""
    sizes = np.max(np.abs(joint.errors), axis=1)
    estimate = SAFETY * float(np.max(np.abs(np.diff(joint.errors[-3:], axis=0))))
    if sizes[-1] > max(estimate, NEGLIGIBLE) and sizes[-1] > 0.5 * sizes[0]:
        yield Remark(
            f"Motions with stick and reversals converge to others than the exact ones, with an error of "
            f"{error_text(float(sizes[-1]))} of their size.",
            True,
            MOTION,
        )
