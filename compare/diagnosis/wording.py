"""Sentences that explain the results for one engine."""

import math
from collections.abc import Iterator, Mapping
from typing import NamedTuple

import numpy as np

from compare.diagnosis.findings import LATER, MOST_HELD, Creep, History, Lag, Motion, Repeat, Shares, heading
from compare.diagnosis.laws import CONE, DISTINCT, ELLIPSE, FITS, NEAR, NOTHING, Friction
from compare.diagnosis.probes import FAR, NONLINEAR, SETTLES_FOR, SLIDE, SLIDES_FOR, SPEED, SUPPORTS
from compare.diagnosis.scaling import MISSING, Scales, blind, deviation
from compare.report.numbers import error_text
from reference_model.systems import FloatArray

LEAST_DEVIATION = 1e-7  # smallest reported relative deviation of a force
FALLS = 0.3  # order in the step above which a quantity decreases with it
RESTS = 1e-9  # ratio of speed to sliding speed below which a block is at rest

LEAST_LAG = 1e-6
"""Smallest reported lag in s; the slip rotates at about 1 rad/s in the probe."""

STEPS = (0.2, 3.0)  # range of lags that are reported in steps
IMPRECISE = 1e-5  # error over resolution that limited precision explains
LEAST_SHARE = 1e-6  # smallest reported relative deviation of other results

ALIKE = 0.1
"""Largest spread of forces that a wrong mass explains, and relative size of deviations that other causes explain."""

VARIES = 3.0  # largest ratio of rates of hidden damping
SAME_DELAY = 0.2  # largest relative difference of equal delays
ASLEEP = 1e-4
"""Smallest distance in m that a block moves before it falls asleep; a regularised block creeps less."""

CHATTERS = 3.0  # smallest ratio of velocity to creep of a block that chatters

MOTION, MASS, DAMPED, FAILED = "Wrong motion", "Wrong mass", "Hidden damping", "Engine failed"
DISCS = "Wrong friction of discs"
"""Beginnings of a verdict that does not concern friction."""


class Remark(NamedTuple):
    """A finding: its sentence, True if it refutes the engine (None: undecided), and the beginning of the verdict."""

    text: str
    wrong: bool | None
    about: str = "Not Coulomb friction"


def sentence(text: str) -> str:
    """Return ``text`` as a sentence."""
    return f"{text[0].upper()}{text[1:]}."


def size_text(share: float, error: float | None = None) -> str:
    """Return a ratio of two numbers in words."""
    if not 0.5 < share < 2.0:
        return f"{share:.3g} times the right one"
    margin = f" (±{error_text(100.0 * error)} %)" if error is not None else ""
    return f"{error_text(100.0 * abs(share - 1.0))} % too {'large' if share > 1.0 else 'small'}{margin}"


def of_gaps(beginning: str, gaps: Mapping[str, str], *, wrong: bool) -> Iterator[Remark]:
    """Yield each reason of ``gaps``, which has the names of parts as keys."""
    for reason in dict.fromkeys(gaps.values()):
        names = ", ".join(heading(name) for name, why in gaps.items() if why == reason)
        yield Remark(f"{beginning} {names}: {reason}.", wrong, FAILED)


HERE = f"At {SLIDE.mass:g} kg, {SLIDE.friction_force:g} N, {SPEED:g} m/s and 1 m from the axis"
"""The one condition of the slides in all directions."""


def of_law(
    law: Friction, scales: Scales | None, support: Shares | None, support_right: bool, refined: str
) -> Iterator[Remark]:
    """Yield how friction differs from Coulomb's."""
    if scales is not None and (text := blind(scales)):
        yield Remark(sentence(text), True)
    elif law.shape == NOTHING:
        yield Remark(_no_friction(law, scales), True)
    elif not math.isnan(law.per_step):
        shape = f" Its shape is a {law.shape}." if law.sure and law.shape != CONE else ""
        yield Remark(
            f"Friction is limited by an impulse per step, {error_text(law.per_step)} s times the limit μN "
            "at any step."
            f"{shape}",
            True,
        )
    elif not law.sure and law.fits:
        yield Remark(
            f"The friction law could not be identified: the error of the forces is {error_text(law.error)} times "
            "the limit μN.",
            None,
        )
    elif not law.sure:
        yield Remark(
            f"No known friction law fits: the best fit, a {law.shape}, "
            f"deviates by {error_text(law.misfit)} times the limit μN.",
            True,
        )
    else:
        small = abs(law.force(np.ones(1, dtype=complex))[0] + 1.0) < NEAR  # a wrong support may explain it
        other = deviation(scales, law) if scales is not None else None
        cause, explained = _cause(law, support), other is not None and other.explained
        how = f", decreasing with the {refined}" if other is not None and other.falls else ""
        if other is not None and (explained or (support_right and not cause)):
            yield Remark(sentence(other.text + how), not other.falls)
        if cause and (law.shape != CONE or not (explained or (small and not support_right))):
            if other is not None and not explained and support_right:
                # one condition is not a law of all others
                cause = f"{HERE}, {cause[0].lower()}{cause[1:-1]}, but {other.text}{how}."
            yield Remark(cause, True)


def _no_friction(law: Friction, scales: Scales | None) -> str:
    """Describe slides without friction, and the force on the others."""
    load = f", {error_text(law.load)} N" if math.isfinite(law.load) else ""
    text = f"No friction was measured at {SLIDE.mass:g} kg{load} and {SPEED:g} m/s"
    if scales is None:
        return f"{text}."
    sizes = np.hypot(*scales.forces.T)
    acts = sizes > FITS + DISTINCT * scales.errors
    if not np.any(acts):
        return f"{text}, or in {len(sizes)} other slides."
    least, most = (error_text(float(end)) for end in (np.min(sizes[acts]), np.max(sizes[acts])))
    return (
        f"{text}, but {least} to {most} times the limit μN in {np.sum(acts)} of {len(sizes)} other slides, "
        f"at {scales.ranges(acts)}."
    )


def _cause(law: Friction, support: Shares | None) -> str:
    deviations = _deviations(law, support)
    if law.shape == ELLIPSE:
        return (
            f"Friction is an ellipse: the coefficient μ is {law.along:.4g} times its value along "
            f"{math.degrees(law.axis):.1f}° and {law.across:.4g} times across."
        )
    if law.shape != CONE or not law.fits:
        further = (
            "" if law.fits else f", with a further difference of {error_text(law.misfit)} times the limit μN"
        )
        name = "Coulomb's cone" if law.shape == CONE else f"a {law.shape}"
        return f"Friction is {name}{''.join(f', but {one}' for one in deviations)}{further}."
    return sentence(" and ".join(deviations)) if deviations else ""


def _deviations(law: Friction, support: Shares | None) -> list[str]:
    found = []
    least = max(DISTINCT * law.error, LEAST_DEVIATION, law.misfit)
    if abs(law.strength - 1.0) > least:
        found.append(f"the coefficient μ is {size_text(law.strength, law.error)}")
        if support is not None and np.all(abs(support.shares - law.strength) <= DISTINCT * support.errors):
            found[-1] += f", or the mass {size_text(1.0 / law.strength)}"
    if abs(abs(law.angle) - math.pi) < least:
        found.append("friction accelerates the slip")
    elif abs(law.angle) > least:
        found.append(
            f"the friction force is rotated by {error_text(math.degrees(law.angle))}° "
            f"(±{error_text(math.degrees(law.error))}°)"
        )
    return found


def of_creep(
    creep: Creep, refined: str, least: float, body: str = "block", unit: str = "m/s", limit: str = "μN"
) -> Iterator[Remark]:
    """Yield whether a ``body`` at rest creeps or chatters, faster than ``least`` in ``unit``."""
    chatters = creep.chatter > max(least, CHATTERS * abs(creep.speed))
    if not chatters and abs(creep.speed) < least:
        yield Remark(f"A {body} loaded below {limit} stays at rest.", False)
        return
    falls = (creep.chatter_order if chatters else creep.order) > FALLS
    how = f"decreasing with the {refined}" if falls else f"independent of the {refined}"
    speed = f"{error_text(abs(creep.speed))} {unit}"
    text = f"a {body} that should rest creeps at {speed} under half of the limit {limit}, {how}"
    if chatters and falls:
        text = f"friction chatters: a {body} that should rest swings at {error_text(creep.chatter)} {unit}, {how}"
    elif chatters:
        text = (
            f"a {body} that should rest moves unsteadily, at up to {error_text(creep.chatter)} {unit}, {how}: "
            "friction chatters or gives way"
        )
    elif creep.smoothing:
        law = f"as {creep.smoothing} with ε = {error_text(creep.epsilon)} {unit}"
        whose = f"regularised by its {refined} or {law}" if falls else f"regularised {law}"
        text = f"{text}: friction is {whose}"
    yield Remark(sentence(text), not falls)


def of_history(history: History, explained: bool, least: float) -> Iterator[Remark]:
    """Yield how friction depends on earlier motion; ``explained`` if another finding may be the reason."""
    once, twice = history.delay, history.second_delay
    allowed = 2.0 * history.delay_error + history.second_delay_error + SAME_DELAY * once
    if explained:
        return
    if history.static > 0.9 * MOST_HELD:
        yield Remark(f"A block at rest is not released by {history.static:.0f} times the limit μN.", True)
    elif history.asleep > ASLEEP:
        yield Remark(
            f"A block pulled by more than μN moves {error_text(history.asleep)} m and stops again: it falls asleep, "
            "or friction grows.",
            True,
        )
    elif history.static > 1.0:
        yield Remark(
            f"Static friction is {error_text(100.0 * (history.static - 1.0))} % above sliding friction.", True
        )
    elif once > max(history.delay_error, LEAST_LAG) and abs(twice - 2.0 * once) < allowed:
        yield Remark(f"A block is released {error_text(1e3 * history.delay)} ms late.", True)
    elif abs(history.second - 1.0) > max(DISTINCT * history.second_error, LEAST_SHARE):
        yield Remark(f"The way of a block after a second release is {size_text(history.second)}.", True)
    if history.rest > least:
        yield Remark(
            f"A block at rest after a slide, or close to its release, creeps at {error_text(history.rest)} m/s.",
            True,
        )


AT = " at 1 N"  # about the size of the forces in ``SUPPORTS``


def of_support(support: Shares, friction: float, predicted: FloatArray) -> list[Remark]:
    """Return the wrong forces of the support, or a wrong mass.

    ``friction`` is the factor of the coefficient μ, NaN if unknown. ``predicted`` are deviations due to others.
    """
    shares = support.shares - predicted
    allowed = np.maximum(DISTINCT * support.errors, LEAST_SHARE) + ALIKE * np.max(np.abs(predicted))
    off = np.abs(shares - 1.0) > allowed
    farthest = float(shares[np.argmax(np.abs(shares - 1.0))])
    alike = np.append(shares, shares[0] if math.isnan(friction) else friction)
    if np.all(off) and farthest and float(np.ptp(alike)) < ALIKE * abs(1.0 / farthest - 1.0):
        return [Remark(f"The mass is {size_text(1.0 / farthest)}, because all forces act alike.", True, MASS)]
    spring, damper, offset = _hidden_damping(shares)
    least, most = sorted((spring, offset))
    if off[0] and off[2] and 0.0 < most < VARIES * least:
        if np.all(off) and most < VARIES * damper < VARIES**2 * least:
            rates = dict.fromkeys(error_text(100.0 * end(spring, damper, offset)) for end in (min, max))
            return [Remark(f"Every body loses {' to '.join(rates)} % of its speed per second.", True, DAMPED)]
        if not off[1] and spring < 1.0:
            said = f"A body on springs loses {error_text(100.0 * spring)} % of its speed per second."
            return [Remark(said, True, DAMPED)]
    return [
        Remark(f"The {name} is {size_text(share) + AT if abs(share) > MISSING else 'missing'}.", True, MOTION)
        for name, share, wrong in zip(SUPPORTS, shares.tolist(), off.tolist(), strict=True)
        if wrong
    ]


def of_nonlinear(forces: Shares) -> Iterator[Remark]:
    """Yield the wrong forces of nonlinear supports."""
    off = np.abs(forces.shares - 1.0) > np.maximum(DISTINCT * forces.errors, LEAST_SHARE)
    for name, share, wrong in zip(NONLINEAR, forces.shares.tolist(), off.tolist(), strict=True):
        if wrong:
            size = size_text(share) if abs(share) > MISSING else "missing"
            text = f"The {name} is {size}; declare nonlinear = False if the engine lacks it."
            yield Remark(text, True, MOTION)


def of_far(far: Shares) -> Iterator[Remark]:
    """Yield that friction is wrong far from the axis; if there is none, the engine's plate may end before."""
    (share,), (error,) = far.shares.tolist(), far.errors.tolist()
    missing = abs(share) <= max(MISSING, error)
    if abs(share - 1.0) > max(ALIKE, DISTINCT * error):
        size = "missing; refuse motions that leave the plate" if missing else size_text(share)
        yield Remark(f"Friction {FAR:g} m from the axis is {size}.", None if missing else True)


def _hidden_damping(shares: FloatArray) -> list[float]:
    """Return the additional damping in 1/s that explains each deviation; the damper of ``SUPPORTS`` has 1/s."""
    spring, damper, offset = shares.tolist()
    until = 0.5 * (SLIDES_FOR + SETTLES_FOR)
    return [(1.0 - spring) / until, damper - 1.0, (1.0 - offset) / until]


LEAST_SHIFT = 0.05
"""Smallest relative effect of a later start that counts; steps may fall on other times."""


def of_repeat(repeat: Repeat | None) -> list[Remark]:
    """Return whether equal calls have equal results, at any time of the start."""
    if repeat is None:
        return []
    if repeat.shift > LEAST_SHIFT:
        text = f"A motion that starts at t = {LATER:g} s differs by {error_text(repeat.shift)} of its size"
        return [Remark(f"{text} from the same motion that starts at 0; begin at times[0].", True, MOTION)]
    if repeat.floor > 0.0:
        text = f"States are the same at steps of {repeat.floor:g} and {2.0 * repeat.floor:g} s"
        return [Remark(f"{text}, so the engine does not take its declared step.", None)]
    if repeat.difference == 0.0:
        return []
    text = f"Equal calls return states that differ by {error_text(repeat.difference)} of their size"
    if repeat.difference <= 2.0 * repeat.declared:
        return [Remark(f"{text}, within the declared precision.", False)]
    return [Remark(f"{text}, more than the declared precision of {repeat.declared:g}; declare it.", None)]


def of_moments(moments: Shares, law: Friction | None) -> Iterator[Remark]:
    """Yield wrong forces and moments on discs."""
    least = LEAST_SHARE
    if law is not None:
        least += 2.0 * (DISTINCT * law.error + abs(law.strength - 1.0))
    off = np.abs(moments.shares - 1.0)
    beyond = off > np.maximum(DISTINCT * moments.errors, least)
    largest = np.max(np.where(beyond, off, 0.0))
    for column, name in enumerate(("force", "moment")):
        # an error of the moment changes the spin, and so the force a little
        wrong = beyond[:, column] & (off[:, column] > ALIKE * largest)
        if np.any(wrong):
            worst = float(moments.shares[np.argmax(np.where(wrong, off[:, column], 0.0)), column])
            yield Remark(f"The friction {name} on a disc is {size_text(worst)}.", True, DISCS)


def of_lag(lag: Lag, step: float, least: float) -> Iterator[Remark]:
    """Yield a lag of friction behind the slip."""
    if abs(lag.seconds) < least:
        return
    verb = "lags" if lag.seconds > 0.0 else "leads"
    if abs(lag.seconds) > max(DISTINCT * lag.error, least):
        yield Remark(
            f"Friction {verb} the slip by {error_text(abs(lag.seconds))} s at every step size.",
            True,
        )
    elif lag.order > FALLS and STEPS[0] <= abs(lag.seconds) / step <= STEPS[1]:
        yield Remark(f"Friction {verb} the slip by {error_text(abs(lag.seconds) / step)} steps.", False)


def of_motions(motions: dict[str, Motion], refined: str) -> Iterator[Remark]:
    """Yield the order of the errors, and motions that do not converge."""
    others = {name: motion for name, motion in motions.items() if not motion.converges}
    orders = [motion.order for name, motion in motions.items() if name not in others and motion.order > FALLS]
    if orders:
        least, most = (f"{order:.1f}" for order in (min(orders), max(orders)))
        yield Remark(
            f"Errors are of order {least}" + f" to {most}" * (least != most) + f" in the {refined}.", False
        )
    open_ = [heading(name) for name, motion in motions.items() if motion.mark == "?"]
    if open_:
        yield Remark(f"The error bar could hide another friction law: {', '.join(open_)}.", False)
    if others and all(len(set(motion.errors)) == 1 for motion in others.values()):
        yield Remark(
            f"Results do not change with the {refined}, so an error cannot be distinguished from another law.",
            True,
            MOTION,
        )
    elif others:
        off = ", ".join(f"{heading(name)} {error_text(motion.error)} m" for name, motion in others.items())
        if all(motion.error < IMPRECISE * motion.resolution for motion in others.values()):
            yield Remark(f"Errors remain at any {refined}: {off}; declare the engine's precision.", None)
            return
        yield Remark(f"Motions converge to others than the exact ones: {off}.", True, MOTION)
