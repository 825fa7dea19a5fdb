"""Friction force against mass, load, speed and place: the law that explains its deviations."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from compare.diagnosis.laws import CONE, DISTINCT, SMOOTHINGS, Friction
from compare.diagnosis.probes import PLANE, SETTLES_FOR, SLIDE
from compare.diagnosis.probes import SPEED as SLIDE_SPEED
from compare.report.numbers import error_text
from reference_model.systems import FloatArray

LEAST = 1e-6
"""Smallest relevant deviation of the force, in units of μN."""

KNOWN = 1e-2  # error of a force, over μN, that shows something
KEEPS = 0.98  # share of the initial speed below which something other than friction has acted
STOPS = 1e-3  # the same for a body that stops
MISSING = 1e-3  # share of the exact force that counts as missing
GROWS = 1.1  # least growth from rung to rung of a converging force that is too small
POWER_FITS = 0.02
CURVE_FITS = 0.03  # largest misfit of a curve over speed, relative to the deviations
FEWEST = 3  # smallest number of slides beyond a threshold
Curve = Callable[[FloatArray], FloatArray]

VARIABLES = ("mass", "friction force", "slip speed", "disc speed", "distance from the axis")
UNITS = ("kg", "N", "m/s", "rad/s", "m")
MASS, LOAD, SPEED, DISC_SPEED, DISTANCE = range(len(VARIABLES))


@dataclass(frozen=True, eq=False)
class Scales:
    """Forces on slides over wide ranges."""

    conditions: FloatArray  # (n, 5): the ``VARIABLES`` in ``UNITS``; the disc speed is 0 on a plane at rest
    forces: FloatArray  # (n, 2): mean friction force/μN
    coarser: FloatArray  # (n, 2): the same at the rung before
    slips: FloatArray  # (n, 2): mean direction of slip
    radial: FloatArray  # (n, 2): mean direction from the axis to the body
    errors: FloatArray  # (n,): of the forces
    speeds: FloatArray  # (n, 2): initial speed in m/s, given and as measured

    def ratios(self, law: Friction) -> NDArray[np.complex128]:
        """Return the ratios of measured to expected forces; NaN where the slip's direction is unknown."""
        force, slip = self.forces @ PLANE, self.slips @ PLANE
        with np.errstate(divide="ignore", invalid="ignore"):  # a body may have stopped
            if law.shape == CONE:
                return np.asarray(force / -slip)
            expected = law.force(slip / np.abs(slip)) / law.strength
        return np.where(self.conditions[:, DISC_SPEED] == 0.0, force / expected, np.nan)

    @property
    def keep(self) -> NDArray[np.bool_]:
        """True for slides that keep their initial speed."""
        return np.asarray(self.speeds[:, 1] >= KEEPS * self.speeds[:, 0])

    @property
    def looked_at(self) -> str:
        """The examined ranges: slides at constant speed whose force is known to ``KNOWN``."""
        return self.ranges(self.keep & (self.errors <= KNOWN))

    def ranges(self, chosen: NDArray[np.bool_]) -> str:
        """Return the ranges in words of the variables on the ``chosen`` slides."""
        found = []
        for name, unit, values in zip(VARIABLES, UNITS, np.abs(self.conditions[chosen]).T, strict=True):
            if np.any(values := values[values > 0.0]):
                found.append(f"{name} {_short(np.min(values))} to {_short(np.max(values))} {unit}")
        return ", ".join(found)


def _short(value: float) -> str:
    return error_text(value, 1)


def speed_limit(scales: Scales) -> str:
    """Describe a loss of speed before friction is measured."""
    blocks = scales.conditions[:, DISC_SPEED] == 0.0
    before, after = scales.speeds[blocks].T
    lost = ~scales.keep[blocks]
    if not np.any(lost):
        return ""
    if np.all(after[lost] < STOPS * before[lost]) and np.max(before[lost]) < np.min(
        before[~lost], initial=np.inf
    ):
        return f"a body that starts at {error_text(np.max(before[lost]))} m/s or less stops at once"
    i, most = int(np.argmin(after / before)), float(np.max(after))
    moves = f"a body that starts at {error_text(before[i])} m/s moves at {error_text(after[i])} m/s"
    if np.allclose(after[lost], most, rtol=0.1):
        return f"{moves} at once: speeds are limited to {error_text(most)} m/s"
    return f"{moves} {1e3 * SETTLES_FOR:g} ms later, which friction of μN does not explain"


@dataclass(frozen=True)
class Deviation:
    """A deviation in words, whether a known law explains it, and whether it falls with the step."""

    text: str
    explained: bool
    falls: bool = False


def deviation(scales: Scales, law: Friction) -> Deviation | None:
    """Return how the force deviates from ``law``, or None."""
    ratios = scales.ratios(law)
    keep = np.isfinite(ratios) & scales.keep
    ratios, conditions, errors = ratios[keep], scales.conditions[keep], scales.errors[keep]
    off = np.abs(ratios - law.strength * np.exp(1j * law.angle * (law.shape == CONE)))
    allowed = np.maximum(DISTINCT * errors, max(LEAST, DISTINCT * law.error, law.misfit))
    wrong = off > allowed
    if not np.any(wrong):
        return None
    sizes, before = np.abs(scales.forces[keep] @ PLANE), np.abs(scales.coarser[keep] @ PLANE)
    grows = sizes[wrong] > GROWS * before[wrong]
    falls = bool(np.all(sizes[wrong] < law.strength) and np.median(grows))
    sizes, blocks = ratios.real, conditions[:, DISC_SPEED] == 0.0
    if text := _limit(sizes[blocks] * conditions[blocks, LOAD], wrong[blocks]):
        return Deviation(text, True)
    text = _thresholds(conditions, sizes, wrong)
    if np.any(wrong & blocks):
        text = (
            _power(conditions[blocks], sizes[blocks])
            or (_everywhere(sizes[blocks]) if np.all(wrong[blocks]) else "")
            or _of_speed(conditions[blocks], sizes[blocks], errors[blocks])
            or text
        )
    else:
        text = _rotation(scales) or text
    if text:
        return Deviation(text, True, falls)
    worst = int(np.argmax(off / allowed))
    at = ", ".join(
        f"{error_text(abs(value))} {unit}"
        for value, unit in zip(conditions[worst], UNITS, strict=True)
        if value
    )
    size = (
        f"deviates by {error_text(off[worst])} times μN"
        if off[worst] < 0.1
        else f"is {sizes[worst]:.3g} times μN"
        if abs(sizes[worst]) > MISSING
        else "is missing"
    )
    where = "" if np.any(wrong & blocks) else "on turntables only, "
    return Deviation(f"{where}the friction force {size} at {at}", False, falls)


def _limit(forces: FloatArray, wrong: NDArray[np.bool_]) -> str:
    """Describe ``forces`` (in N) that end at a limit, which the impulse of a step may have."""
    if np.sum(wrong) < FEWEST:
        return ""
    limit = float(np.median(forces[wrong]))
    if np.ptp(forces[wrong]) > 0.1 * limit or np.any(forces[~wrong] > 1.1 * limit):
        return ""
    return f"the friction force is limited to {error_text(limit)} N"


def blind(scales: Scales) -> str:
    """Describe friction that ignores slip along the radius."""
    at_rest = scales.conditions[:, DISC_SPEED] == 0.0
    force, slip, radial = ((one @ PLANE)[at_rest] for one in (scales.forces, scales.slips, scales.radial))
    acts, slides = force * np.conj(radial), slip * np.conj(radial)
    # not past the axis, where the radius turns
    oblique = (np.minimum(np.abs(slides.real), np.abs(slides.imag)) > 0.1) & (np.abs(radial) > 0.99)
    ignores = np.all(np.abs(acts.real)[oblique] < 0.1 * np.abs(slides.real)[oblique])
    acts_across = np.all(np.abs(acts.imag)[oblique] > 0.1 * np.abs(slides.imag)[oblique])
    return "friction ignores slip towards and away from the axis" if ignores and acts_across else ""


ROTATIONS = {
    0.0: "friction ignores the rotation of the master disc",
    -1.0: "friction assumes that the master disc rotates the other way",
}
"""Mistakes by the factor of the disc speed."""

LEAST_SHARE = 5e-3  # smallest error of the disc speed that shows in mean directions
ALONG = 0.05  # largest angle in rad between friction and the assumed slip, whose direction is a mean


def _rotation(scales: Scales) -> str:
    """Describe friction against a slip with another rotation of the master disc."""
    turning = (scales.conditions[:, DISC_SPEED] != 0.0) & scales.keep
    force, slip, radial = ((one @ PLANE)[turning] for one in (scales.forces, scales.slips, scales.radial))
    speed, disc_speed, distance = scales.conditions[turning][:, [SPEED, DISC_SPEED, DISTANCE]].T
    if len(speed) < FEWEST or np.any(np.abs(force) == 0.0):
        return ""
    against = -np.conj(force) / np.abs(force)
    own, disc = speed * slip * against, 1j * disc_speed * distance * radial * against
    # the factor of the disc's speed that turns each slip towards friction, with the weight of the slip
    missing = -float(np.median(own.imag / np.where(disc.imag == 0.0, np.inf, disc.imag)))
    for _ in range(20):
        weights = 1.0 / np.abs(own + missing * disc) ** 2
        missing = -float(np.sum(weights * own.imag * disc.imag) / np.sum(weights * disc.imag**2))
    if abs(missing) < LEAST_SHARE or np.any(np.abs(np.angle(own + missing * disc)) > ALONG):
        return ""
    known = next((text for factor, text in ROTATIONS.items() if abs(1.0 - missing - factor) < 0.01), "")
    return known or f"friction assumes {1.0 - missing:.3g} times the speed of the master disc"


def _power(conditions: FloatArray, sizes: FloatArray) -> str:
    """Describe a force that is a power of mass, load or speed."""
    if not np.all(sizes > 0.0):
        return ""
    logs = np.log(conditions[:, : SPEED + 1])
    full = np.column_stack((np.ones(len(sizes)), logs))
    powers, *_ = np.linalg.lstsq(full, np.log(sizes), rcond=None)
    if np.max(np.abs(full @ powers - np.log(sizes))) > POWER_FITS * min(1.0, np.ptp(np.log(sizes))):
        return ""
    said = [
        f"{name}^{power:.2f}"
        for name, power in zip(VARIABLES, powers[1:], strict=False)
        if abs(power) > 0.005
    ]
    if not said:
        return ""
    return f"the friction force over μN is proportional to {' and '.join(said)}, but must not depend on it"


RISING: dict[str, Curve] = {"v": lambda x: x}

FALLING: dict[str, Curve] = {
    "exp(−v/V)": lambda x: np.exp(-x),
    "exp(−(v/V)²)": lambda x: np.exp(-x * x),
    "1/(1 + v/V)": lambda x: 1.0 / (1.0 + x),
}
"""Curves over the slip speed v."""


def _of_speed(conditions: FloatArray, sizes: FloatArray, errors: FloatArray) -> str:
    """Describe a force that depends on the slip speed alone."""
    allowed = CURVE_FITS * np.maximum(np.abs(sizes), 0.1) * min(1.0, float(np.ptp(sizes))) + DISTINCT * errors
    regularised = {one.name: one.share for one in SMOOTHINGS}
    found = [
        (*_fit(curve, conditions[:, SPEED], sizes, allowed, alone=name in regularised), name)
        for name, curve in (regularised | RISING | FALLING).items()
    ]
    misfit, scale, (base, more), name = min(found, key=lambda one: one[0])
    if misfit > 1.0:
        return ""
    if name in regularised:
        return f"friction is regularised as {name} with ε = {error_text(scale)} m/s"
    if name in RISING:
        law = f"{base:.4g} {'+' if more > 0.0 else '−'} {abs(more) / scale:.3g}·v/(m/s)"
        return f"the coefficient μ depends on the slip speed v, as {law} times its value"
    return (
        "the coefficient μ falls with the slip speed (Stribeck), "
        f"from {base + more:.5g} to {base:.5g} times its value, as {name} with V = {error_text(scale)} m/s"
    )


def _fit(
    curve: Curve, speeds: FloatArray, sizes: FloatArray, allowed: FloatArray, *, alone: bool
) -> tuple[float, float, FloatArray]:
    """Return misfit, scale and coefficients of a + b·curve(v/scale)."""

    def fit(power: float) -> tuple[float, FloatArray]:
        shape = curve(speeds / 10.0**power)
        table = np.column_stack((np.full_like(shape, 0.0 if alone else 1.0), shape))
        numbers, *_ = np.linalg.lstsq(table / allowed[:, None], sizes / allowed, rcond=None)
        return float(np.max(np.abs(table @ numbers - sizes) / allowed)), np.asarray(numbers, dtype=float)

    start = min(np.linspace(-6.0, 3.0, 91).tolist(), key=lambda power: fit(power)[0])
    best = minimize_scalar(lambda power: fit(power)[0], bounds=(start - 0.1, start + 0.1))
    misfit, numbers = fit(float(best.x))
    return misfit, 10.0 ** float(best.x), numbers


def _thresholds(conditions: FloatArray, sizes: FloatArray, wrong: NDArray[np.bool_]) -> str:
    """Describe deviations beyond thresholds of some variables."""
    sides = []
    for name, unit, values in zip(VARIABLES, UNITS, np.abs(conditions).T, strict=True):
        right = values[~wrong & (values > 0.0)]
        if right.size:
            low, high = float(np.min(right)), float(np.max(right))
            sides.append((values > high, f"{name} above {error_text(high)} {unit}"))
            sides.append(((values < low) & (values > 0.0), f"{name} below {error_text(low)} {unit}"))
    left, said = wrong.copy(), []
    while sides:
        beyond, words = max(sides, key=lambda side: int(np.sum(left & side[0])))
        if np.sum(left & beyond) < FEWEST:
            break
        said.append(words)
        left &= ~beyond
    if not said or np.sum(left) > FEWEST or not (alike := _alike(sizes[wrong])):
        return ""
    return f"{alike} for a {' or '.join(said)}"


def _alike(sizes: FloatArray) -> str:
    """Return by how much the coefficient μ is wrong, or "" if ``sizes`` differ."""
    if np.ptp(sizes) > 0.1 * np.max(np.abs(sizes - 1.0)):
        return ""
    change = 100.0 * (float(np.median(sizes)) - 1.0)
    return f"the coefficient μ is {error_text(abs(change))} % too {'large' if change > 0.0 else 'small'}"


def _everywhere(sizes: FloatArray) -> str:
    """Describe deviations of all slides except under one condition."""
    if not (alike := _alike(sizes)):
        return ""
    return f"{alike} except for {SLIDE.mass:g} kg, {SLIDE.friction_force:g} N and {SLIDE_SPEED:g} m/s"
