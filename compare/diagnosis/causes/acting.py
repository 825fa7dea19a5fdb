"""Forces that act on a sliding body in addition to friction, identified on slides over wide ranges.

Friction is measured as the missing momentum, so any other force counts as friction. Each term below is fitted, if
necessary together with a factor of the coefficient μ. It explains the slides if it leaves a small share of every
deviation. If no term does, pairs of terms are fitted. If several do, all of them are named.
"""

import itertools
import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from compare.diagnosis.laws import DISTINCT
from compare.diagnosis.probes import PLANE, SETTLES_FOR, SLIDES_FOR, SUPPORTS
from compare.diagnosis.scaling import LEAST, Scales
from compare.report.numbers import MINUS, error_text
from reference_model.systems import FloatArray

Complex = NDArray[np.complexfloating[Any, Any]]

LEAVES = 0.02
"""Largest share of a deviation that a term may leave; directions and speeds are means over a slide."""

FEWEST = 8
"""Smallest number of slides that identify a term."""

MOST_LOST = 0.3
"""Largest share of the speed that friction may remove, because the direction of a body that stops is unknown."""

MOST = 3
"""Largest number of explanations that are named."""

CLEAR = 0.99
"""Smallest mean of the unit vectors from the axis to a body that does not pass the axis."""


FORCE, FRICTION, DAMPING = "Wrong motion", "Not Coulomb friction", "Hidden damping"
"""Beginnings of a verdict."""


class Slides(NamedTuple):
    """Mean values on slides in SI units, shape (n,); vectors are complex."""

    mass: FloatArray
    load: FloatArray
    against: Complex  # direction of friction, of length 1 or less
    slip: Complex
    velocity: Complex
    place: Complex
    force: Complex  # friction over μN
    allowed: FloatArray  # its error

    @classmethod
    def of(cls, scales: Scales, least_distance: float = 0.0) -> "Slides":
        """Return the slides that keep their speed, with a mean direction from the axis of at least this length."""
        slip, radial, force = (part @ PLANE for part in (scales.slips, scales.radial, scales.forces))
        mass, load, speed, disc_speed, distance = scales.conditions.T
        lost = np.abs(force) * load / mass * (SETTLES_FOR + SLIDES_FOR)
        kept = scales.keep & (np.abs(slip) > 0.5) & (lost < MOST_LOST * speed)
        kept &= np.abs(radial) >= least_distance
        place = distance * radial
        velocity = speed * slip + 1j * disc_speed * place
        allowed = np.maximum(DISTINCT * scales.errors, LEAST)
        found = mass, load, -slip, speed * slip, velocity, place, force, allowed
        return cls(*(part[kept] for part in found))

    @property
    def off(self) -> Complex:
        """Deviation of the force from Coulomb friction, over μN."""
        return np.asarray(self.force - self.against)


class Term(NamedTuple):
    """A force in N, the sum of ``bases`` times real factors, and the sentence that describes the factors.

    Two factors are the parts along x and y of a vector.
    """

    said: str
    bases: tuple[Callable[[Slides], Complex], ...]
    about: str = FORCE
    of_place: bool = False


TERMS = (
    Term("every body loses {percent} % of its speed per second", (lambda s: -s.mass * s.velocity,), DAMPING),
    Term("a drag of {factor} N per m/s of the speed acts on every body", (lambda s: -s.velocity,)),
    Term(
        "viscous friction of {factor} N per kg and m/s of the slip acts too",
        (lambda s: -s.mass * s.slip,),
        FRICTION,
    ),
    Term("viscous friction of {factor} N per m/s of the slip acts too", (lambda s: -s.slip,), FRICTION),
    Term(
        "a drag with the square of the speed, {factor} N per kg and m²/s², acts on every body",
        (lambda s: -s.mass * s.velocity * np.abs(s.velocity),),
    ),
    Term(
        "a drag with the square of the speed, {factor} N per m²/s², acts on every body",
        (lambda s: -s.velocity * np.abs(s.velocity),),
    ),
    Term("every velocity turns by {factor} rad/s", (lambda s: 1j * s.mass * s.velocity,)),
    Term("a force of {factor} N per m/s acts across every velocity", (lambda s: 1j * s.velocity,)),
    Term(
        "every body is accelerated by {size} m/s² along {angle}° (is the plane tilted?)",
        (lambda s: s.mass + 0j, lambda s: 1j * s.mass),
    ),
    Term(
        "a force of {size} N along {angle}° acts on every body",
        (lambda s: np.full(len(s.mass), 1.0 + 0j), lambda s: np.full(len(s.mass), 1j)),
    ),
    Term(
        "every body is accelerated by {factor} m/s² per m towards the axis",
        (lambda s: -s.mass * s.place,),
        of_place=True,
    ),
    Term(
        "a force of {factor} N per m towards the axis acts on every body",
        (lambda s: -s.place,),
        of_place=True,
    ),
    Term("friction exceeds μN by {factor} N at any load (adhesion)", (lambda s: s.against,), FRICTION),
    Term("friction exceeds μN by {factor} N per kg at any load", (lambda s: s.mass * s.against,), FRICTION),
    Term(
        "the coefficient μ changes with the place, by {percent} % per m of distance from the axis",
        (lambda s: s.load * np.abs(s.place) * s.against,),
        FRICTION,
        of_place=True,
    ),
    Term(
        "the coefficient μ changes with the place, by {large} % per m along {angle}°",
        (lambda s: s.load * s.place.real * s.against, lambda s: s.load * s.place.imag * s.against),
        FRICTION,
        of_place=True,
    ),
)


class Acting(NamedTuple):
    """A sentence about an additional force, its beginning, and the deviations of ``SUPPORTS`` due to the force."""

    text: str
    about: str
    of_supports: FloatArray


def acting(scales: Scales) -> Acting | None:
    """Return the force that explains all deviations from Coulomb friction, or None."""
    everywhere, clear = Slides.of(scales), Slides.of(scales, CLEAR)
    if np.sum(np.abs(everywhere.off) > everywhere.allowed) < FEWEST:
        return None
    if _fit(everywhere, [everywhere.against], everywhere.force)[1] <= 1.0:
        return None  # a wrong coefficient alone
    for number in (1, 2):
        fits = [
            (terms, _factors(terms, everywhere, clear)) for terms in itertools.combinations(TERMS, number)
        ]
        found = [(terms, numbers) for terms, numbers in fits if numbers is not None]
        if found:
            break
    if not 0 < len(found) <= MOST:
        return None
    about = {term.about for terms, _ in found for term in terms}
    said = " or ".join(_words(terms, numbers) for terms, numbers in found)
    return Acting(said, about.pop() if len(about) == 1 else FORCE, _of_supports(*found[0]))


def _factors(terms: Sequence[Term], everywhere: Slides, clear: Slides) -> list[float] | None:
    """Return the factors of μN and of the bases of ``terms`` if they explain the slides."""
    slides = clear if any(term.of_place for term in terms) else everywhere
    if len(slides.mass) < FEWEST:
        return None
    columns = [basis(slides) / slides.load for term in terms for basis in term.bases]
    numbers, misfit = _fit(slides, columns, slides.off)
    numbers = np.concatenate(([1.0], numbers))
    if misfit > 1.0:
        numbers, misfit = _fit(slides, [slides.against, *columns], slides.force)
    # without any friction, it is the law that is wrong
    return numbers.tolist() if misfit <= 1.0 and abs(numbers[0]) > LEAVES else None


def _of_supports(terms: Sequence[Term], numbers: Sequence[float]) -> FloatArray:
    """Return the relative changes of the forces of ``SUPPORTS`` by the terms, in the middle of their measurement."""
    bases = [basis for term in terms for basis in term.bases]
    until, found = 0.5 * (SETTLES_FOR + SLIDES_FOR), []
    for _, system, start in SUPPORTS.values():
        z, begun = complex(*start[:2]), complex(*start[2:])
        force = -system.stiffness * (z - system.offset) - system.damping * begun
        v, mass, load = (
            begun + until * force / system.mass,
            np.array([system.mass]),
            np.array([system.friction_force]),
        )
        z += until * begun + 0.5 * until**2 * force / system.mass
        against, velocity, place, none = np.array([[-v / abs(v)], [v], [z], [0j]])
        slides = Slides(mass, load, against, velocity, velocity, place, none, none.real)
        extra = sum(number * basis(slides)[0] for number, basis in zip(numbers[1:], bases, strict=True))
        found.append((extra * np.conj(force)).real / abs(force) ** 2)
    return np.array(found)


def _fit(slides: Slides, columns: list[Complex], force: Complex) -> tuple[FloatArray, float]:
    """Return the real factors of ``columns`` that fit ``force``, and the largest misfit over its bound."""
    bound = slides.allowed + LEAVES * np.abs(slides.off)
    table, right = np.column_stack(columns) / bound[:, None], force / bound
    sizes = np.maximum(np.max(np.abs(table), axis=0), 1e-300)
    both = np.vstack((table.real, table.imag)) / sizes
    numbers, *_ = np.linalg.lstsq(both, np.concatenate((right.real, right.imag)), rcond=None)
    numbers = np.asarray(numbers / sizes)
    return numbers, float(np.max(np.abs(table @ numbers - right)))


def _words(terms: Sequence[Term], numbers: Sequence[float]) -> str:
    said, left = [], list(numbers[1:])
    for term in terms:
        x, y = (left.pop(0) if i < len(term.bases) else 0.0 for i in range(2))
        sign, size = MINUS if x < 0.0 else "", math.hypot(x, y)
        text = term.said.format(
            factor=f"{sign}{error_text(size)}",
            percent=f"{sign}{error_text(100.0 * size)}",
            size=error_text(size),
            large=error_text(100.0 * size),
            angle=f"{round(math.degrees(math.atan2(y, x)), 1) + 0.0:.1f}",
        )
        said.append(text.replace(f"loses {MINUS}", "gains "))
    if abs(numbers[0] - 1.0) > LEAST:
        change = (
            f"{error_text(100.0 * abs(numbers[0] - 1.0))} % too {'large' if numbers[0] > 1.0 else 'small'}"
        )
        said.append(f"the coefficient μ is {change}")
    return ", and ".join(said)
