"""Friction force and moment of a disc at several ratios of slide to spin, and the law that they follow."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy.optimize import minimize_scalar

from compare.diagnosis.ladder import Ladder
from compare.diagnosis.laws import DISTINCT
from compare.diagnosis.probes import PLANE, SETTLES_FOR, SLIDES_FOR, SMOOTH, SPEED, discs
from compare.engines import Engine
from compare.report.numbers import error_text
from reference_model import Annulus, PointsOnRing, Ring
from reference_model.systems import DiscOnDisc, FloatArray

RATIOS = np.radians([0.0, 15.0, 30.0, 40.0, 50.0, 60.0, 75.0, 90.0])
"""Angles in rad: slip speed and rim speed are ``SPEED`` times their cosine and sine."""

TIMES = np.array([0.0, SETTLES_FOR, SETTLES_FOR + 0.5 * SLIDES_FOR, SETTLES_FOR + SLIDES_FOR])
SIMPSON = np.array([1.0, 4.0, 1.0]) / 6.0
HEADING = 0.3  # direction of the slip in rad
CLOSE = 2e-3  # largest deviation over μN of a law that the engine may have
KNOWN = 1e-2  # largest error over μN of a disc that is called right
POINTS = 6
KINDS = {"ring": "a ring", "points": f"{POINTS} points"}
SHAFT = 0.01  # largest relative change of the spin by the shaft


@dataclass(frozen=True)
class Patch:
    """Force and moment on a disc with each of ``kinds``, at each of ``RATIOS``.

    ``motions`` contains slip speed and rim speed in m/s, and the angle, at the last three ``TIMES``, shape
    (k, 8, 3, 3). ``wrenches`` contains the mean force against the slip over μN and the moment over μNR, shape
    (k, 8, 2). ``shaft`` is the angular acceleration by the shaft, divided by the exact acceleration.
    """

    kinds: tuple[str, ...]
    motions: FloatArray
    wrenches: FloatArray
    error: float
    shaft: float


def patch(engine: Engine) -> Patch:
    """Return force and moment on a ring and on points, as far as the engine simulates them."""
    # the last discs are large and turn slowly, so points keep their directions
    systems = {kind: discs(points)[-1][0] for kind, points in (("ring", None), ("points", POINTS))}
    kinds = tuple(kind for kind, system in systems.items() if engine.simulates(system))

    def question(tolerance: float) -> FloatArray:
        return np.array([_measured(engine, systems[kind], tolerance) for kind in kinds])

    ladder = Ladder.of(engine, question)
    changes = float(np.max(np.abs(np.diff(ladder.values[-3:, ..., -2:], axis=0))))
    disc = systems[kinds[0]]
    noise = engine.noise * disc.mass * SPEED / (disc.friction_force * SLIDES_FOR)
    motions = ladder.finest[..., :-2].reshape(len(kinds), len(RATIOS), 3, 3)
    return Patch(
        kinds, motions, ladder.finest[..., -2:], DISTINCT * (changes + noise), _by_shaft(engine, disc)
    )


def _measured(engine: Engine, disc: DiscOnDisc, tolerance: float) -> FloatArray:
    """Return motion and wrench at each ratio, shape (8, 11)."""
    radius, along = disc.contact_radius, np.exp(1j * HEADING)
    motions = []
    for ratio in RATIOS.tolist():
        slip = SPEED * round(math.cos(ratio), 12) * along  # exactly 0 for spin alone
        motions.append((disc, (0.0, 0.0, 0.0, slip.real, slip.imag, SPEED * math.sin(ratio) / radius), TIMES))
    found = []
    for run in engine.simulate_many(motions, tolerance=tolerance):
        states = run.states[1:]
        z, v = ((pair @ PLANE) * np.conj(along) for pair in (states[:, :2], states[:, 3:5]))
        impulse = disc.mass * (v[-1] - v[0]) + disc.stiffness * SLIDES_FOR * (SIMPSON @ z)
        turned = disc.polar_inertia * (states[-1, 5] - states[0, 5]) / radius
        wrench = -np.array([impulse.real, turned]) / (disc.friction_force * SLIDES_FOR)
        motion = np.column_stack((v.real, radius * states[:, 5], states[:, 2] - HEADING))
        found.append(np.concatenate((motion.ravel(), wrench)))
    return np.array(found)


def _by_shaft(engine: Engine, disc: DiscOnDisc) -> float:
    driven = replace(
        disc,
        friction_force=SMOOTH.friction_force,
        shaft_damping=SHAFT * disc.polar_inertia / SLIDES_FOR,
        shaft_speed=2.0,
    )
    spins = engine.simulate(driven, (0.0,) * 3 + (SPEED, 0.0, 1.0), TIMES[[0, 1, 3]]).states[:, 5]
    share = float((spins[2] - spins[1]) / (driven.shaft_speed - spins[1]))
    return -math.log1p(-min(share, 0.99)) / SHAFT


# --- Laws that engines have for a disc that slides and spins.

Contact = Ring | PointsOnRing | Annulus
Wrench = Callable[[FloatArray, float], Sequence[float]]


class Law(NamedTuple):
    """A law in words, its force and moment for a motion and a free number, and the bounds of this number."""

    said: str
    wrench: Wrench
    bounds: tuple[float, float] | None = None


def _on(contact: Contact) -> Wrench:
    """Return the wrench of a contact of radius 1, whose radius is multiplied by the free number."""

    def wrench(motion: FloatArray, number: float) -> tuple[float, float]:
        slip, rim, angle = motion.tolist()
        force, moment = contact.force_and_moment(slip + 0j, -number * rim, angle)
        return -force.real, -number * moment

    return wrench


def _stopping(*, by_axis: bool) -> Wrench:
    """Return the wrench of points with friction along the impulse that would stop each alone, on discs of J = mR².

    ``by_axis`` neglects the coupling of the impulses along the axes of the world.
    """

    def wrench(motion: FloatArray, _: float) -> tuple[float, float]:
        slip, rim, angle = motion.tolist()
        arms = np.exp(1j * (angle + 2.0 * math.pi * np.arange(POINTS) / POINTS))
        axes = np.full(POINTS, np.exp(-1j * HEADING)) if by_axis else arms
        places, slips = arms * np.conj(axes), (slip + 1j * rim * arms) * np.conj(axes)
        stops = slips.real / (1.0 + places.imag**2) + 1j * slips.imag / (1.0 + places.real**2)
        directions = axes * stops / np.abs(stops)
        return float(np.mean(directions.real)), float(np.mean((np.conj(arms) * directions).imag))

    return wrench


def _ellipsoid(motion: FloatArray, number: float) -> tuple[float, float]:
    slip, rim = float(motion[0]), float(motion[1])
    size = math.hypot(slip, number * rim)
    return slip / size, number**2 * rim / size


def _slides(motion: FloatArray) -> float:
    return 1.0 if motion[0] > CLOSE * SPEED else 0.0


def _larger(motion: FloatArray, _: float) -> tuple[float, float]:
    return (1.0, 0.0) if motion[0] > motion[1] else (0.0, 1.0)


def _separate(motion: FloatArray, number: float) -> tuple[float, float]:
    return _slides(motion), number if motion[1] > CLOSE * SPEED else 0.0


CONTACTS: dict[str, Contact] = {
    "a ring": Ring(1.0),
    "6 points": PointsOnRing(1.0, POINTS),
    "4 points": PointsOnRing(1.0, 4),
    "a full disc with even pressure": Annulus(0.0, 1.0),
}


MOMENT, INERTIA = "times the right friction moment", "moment of inertia"


def _laws(right: Contact) -> list[Law]:
    exact = _on(right)
    return [
        *(Law(f"has the friction of {name}", _on(contact)) for name, contact in CONTACTS.items()),
        Law(
            "has friction along the impulse that would stop each of 6 points alone", _stopping(by_axis=False)
        ),
        Law(
            "has friction along the impulse that would stop each of 6 points by axis", _stopping(by_axis=True)
        ),
        Law("has no friction against spin", lambda motion, _: (_slides(motion), 0.0)),
        Law("has friction against the larger of slide and spin only, a pyramid", _larger),
        Law("has separate limits for slide and spin, μN and {number}·μNR", _separate, (0.01, 3.0)),
        Law("has the friction of an ellipsoid with the limits μN and {number}·μNR", _ellipsoid, (0.01, 3.0)),
        Law(
            "has viscous friction against spin, {number} s/m·μN times the speed of the rim",
            lambda motion, number: (_slides(motion), number * float(motion[1])),
            (0.0, 30.0),
        ),
        Law(
            f"has {{number}} {MOMENT}",
            lambda motion, number: (exact(motion, 1.0)[0], number * exact(motion, 1.0)[1]),
            (-3.0, 3.0),
        ),
        Law(
            "has {number} times the right friction force (or a wrong mass)",
            lambda motion, number: (number * exact(motion, 1.0)[0], exact(motion, 1.0)[1]),
            (0.0, 3.0),
        ),
        Law(
            "has {number} times the right force and moment",
            lambda motion, number: [number * part for part in exact(motion, 1.0)],
            (0.0, 3.0),
        ),
        *(
            Law(f"has the friction of {name} of {{number}} times the radius", _on(CONTACTS[name]), (0.1, 3.0))
            for name in ("a ring", "6 points", "a full disc with even pressure")
        ),
    ]


def law_of(found: Patch, strength: float) -> tuple[str, bool]:
    """Return the law of discs in words, and whether it is right; ``strength`` is the factor of μ of blocks.

    The law of the first wrong kind counts; it lists the laws that explain force and moment, or the closest law.
    """
    allowed, right = max(CLOSE, found.error), ""
    for kind, motions, measured in zip(found.kinds, found.motions, found.wrenches, strict=True):
        exact, wrenches = CONTACTS[KINDS[kind]], measured / strength
        own = _deviation(_on(exact), 1.0, motions, wrenches)
        size = f"{error_text(100.0 * own)} % of μN"
        if own > allowed:
            fits, close = list[tuple[float, str]](), list[tuple[float, str]]()
            for free in (False, True):  # laws without a free number explain more
                if not close:
                    laws = [law for law in _laws(exact) if (law.bounds is not None) == free]
                    fits += [_fit(law, motions, wrenches) for law in laws]
                    close = [one for one in fits if one[0] <= allowed]
            nearest, closest = min(fits)
            rest = f"follows no known law: the closest {closest}, up to {error_text(100.0 * nearest)} % of μN"
            said = " or ".join(text for _, text in close) or rest
            if close and MOMENT in said and abs(found.shaft - 1.0) > CLOSE:
                said = f"has {1.0 / found.shaft:.3g} times the right {INERTIA}"
            return (
                f"a disc that slides and spins {said}; it deviates from {KINDS[kind]} by up to {size}",
                False,
            )
        least = f"is known only to {error_text(100.0 * found.error)} % of μN"
        said = f"is right to {size}" if found.error <= KNOWN else least
        right = right or f"a disc that slides and spins {said}, at {len(RATIOS)} ratios of the two"
    return right, True


def _fit(law: Law, motions: FloatArray, wrenches: FloatArray) -> tuple[float, str]:
    """Return the smallest deviation of the law, and the law in words."""
    if law.bounds is None:
        return _deviation(law.wrench, 1.0, motions, wrenches), law.said

    def off(number: float) -> float:
        return _deviation(law.wrench, number, motions, wrenches)

    start = min(np.linspace(*law.bounds, 25).tolist(), key=off)
    wide = (law.bounds[1] - law.bounds[0]) / 24.0
    best = minimize_scalar(off, bounds=(start - wide, start + wide), options={"xatol": 1e-6})
    return float(best.fun), law.said.format(number=f"{float(best.x):.3g}")


def _deviation(wrench: Wrench, number: float, motions: FloatArray, wrenches: FloatArray) -> float:
    """Return the largest difference of the mean force or moment, over μN or μNR."""
    means = [SIMPSON @ np.array([wrench(state, number) for state in motion]) for motion in motions]
    return float(np.max(np.abs(np.array(means) - wrenches)))
