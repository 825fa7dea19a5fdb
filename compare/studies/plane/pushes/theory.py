"""Predicted forces of measured pushes, their errors, and explanations of these errors.

A push is quasi-static, so the pusher balances friction: a foot that moves by d carries its share of the sliding force
against d. All parameters are the authors' values; nothing is fitted.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from itertools import combinations, groupby

import numpy as np
from numpy.typing import NDArray

from compare.studies.plane.pushes.reduction import Push, reduced_pushes
from compare.studies.toolkit.uncertainties import Uncertainties
from reference_model.contact.limit_surface import wrench_of_slip
from reference_model.contact.patch import polygon_patch
from reference_model.contact.points import Points
from reference_model.systems import FloatArray

MM = 1e-3

MASS, GRAVITY = 1.518, 9.81
"""Mass of the body in kg, and g in m/s²."""

CENTRE = 50.0 + 50.0j
"""Centre of mass in mm, in the frame of the body."""

LEGS = 150.0
"""Length of both legs of the triangle in mm; the origin is the corner between them."""

PUSHER = 0.05
"""The authors' unit of length (m) for moments."""

SLIDING_FORCES = {"board": 4.2, "wood": 5.0}
"""Sliding force in N, by surface."""

DIVISIONS = 8
"""Divisions of a side of the patch for its quadrature."""


def surface(series: str) -> str:
    return "wood" if series.startswith("wood") else "board"


def feet(series: str) -> list[complex]:
    """Return the positions of the feet (mm), or none for the patch."""
    numbers = [float(number) for number in series.removeprefix("wood_").split("_") if number != "patch"]
    return [complex(x, y) for x, y in zip(numbers[:3], numbers[3:], strict=True)]


@cache
def contact_of(series: str, centre: complex = CENTRE, divisions: int = DIVISIONS) -> Points:
    """Return the contact of a series, relative to the centre of mass.

    ``centre`` (mm) is the centre of pressure, which tilts the load linearly, and ``divisions`` refines a patch.
    """
    arms = np.array([(place - CENTRE) * MM for place in feet(series) or (0.0, LEGS, 1j * LEGS)])
    if not feet(series):  # all points represent equal areas
        arms = np.array(polygon_patch(np.column_stack((arms.real, arms.imag)), divisions).arms(0.0))
    rows, middle = np.array([np.ones(len(arms)), arms.real, arms.imag]), (centre - CENTRE) * MM
    shares = np.linalg.solve(rows @ rows.T, [1.0, middle.real, middle.imag]) @ rows
    return Points(np.column_stack((arms.real, arms.imag, shares / shares.sum())).tolist())


@dataclass(frozen=True)
class Wrench:
    """Force (N, complex) and moment (N m) on the body about its centre of mass, in the axes halfway."""

    force: complex
    moment: float

    @property
    def components(self) -> FloatArray:
        """Both force components, and the moment over ``PUSHER`` (N)."""
        return np.array([self.force.real, self.force.imag, self.moment / PUSHER])


@dataclass(frozen=True)
class Motion:
    """Displacement (m, complex) of the centre of mass in the axes halfway, and twice the sine of half the turn."""

    shift: complex
    spin: float

    @classmethod
    def of(cls, push: Push) -> Motion:
        """Return the measured motion."""
        spin = 2.0 * np.sin(0.5 * push.turn)
        return cls(complex(push.x, push.y) * MM + 1j * spin * CENTRE * MM, spin)


def measured(push: Push) -> Wrench:
    """Return the wrench of the pusher, whose force acts at the hand's final position."""
    force, arm = complex(push.force_x, push.force_y), (complex(push.end_x, push.end_y) - CENTRE) * MM
    return Wrench(force, (arm.conjugate() * force).imag)


def predicted(motion: Motion, contact: Points, sliding_force: float) -> Wrench:
    """Return the wrench that balances friction during a motion."""
    force, moment = wrench_of_slip(contact, motion.shift, motion.spin)
    return Wrench(sliding_force * force, sliding_force * moment)


Law = Callable[[Push], Wrench]


def coulomb(
    push: Push, *, centre: complex = CENTRE, factor: float = 1.0, divisions: int = DIVISIONS
) -> Wrench:
    """Return the wrench of Coulomb friction with the authors' parameters.

    ``factor`` multiplies the sliding force; for the others see ``contact_of``.
    """
    contact = contact_of(push.series, centre, divisions)
    return predicted(Motion.of(push), contact, factor * SLIDING_FORCES[surface(push.series)])


def force_error(push: Push, law: Law) -> float:
    """Return the angle (degrees) from the measured to the predicted force."""
    return float(np.degrees(np.angle(law(push).force * measured(push).force.conjugate())))


def wrench_difference(push: Push, law: Law) -> FloatArray:
    """Return the predicted minus the measured unit wrench in degrees, with moments over ``PUSHER``, shape (3,)."""
    directions = [wrench.components for wrench in (law(push), measured(push))]
    theory, found = (direction / np.linalg.norm(direction) for direction in directions)
    return np.asarray(np.degrees(theory - found))


def wrench_error(push: Push, law: Law) -> float:
    """Return the angle in degrees between the measured and the predicted wrench, with moments over ``PUSHER``."""
    chord = np.radians(np.linalg.norm(wrench_difference(push, law)))
    return float(2.0 * np.degrees(np.arcsin(min(1.0, 0.5 * chord))))


def work_ratio(push: Push, law: Law) -> float:
    """Return the measured over the predicted work."""
    motion = Motion.of(push)
    along = np.array([motion.shift.real, motion.shift.imag, motion.spin * PUSHER])
    return float((measured(push).components @ along) / (law(push).components @ along))


def work_error(push: Push, law: Law) -> float:
    """Return the measured minus the predicted work, in per cent of the predicted work."""
    return 100.0 * (work_ratio(push, law) - 1.0)


# --- Uncertainties, as in ASME V&V 20

Difference = Callable[[Push, Law], float | FloatArray]
"""Prediction minus measurement, a number or components."""

CENTRE_TO, SLIDING_FORCE_TO = 1.0, 0.1
"""Last digits of the centre of mass in mm and of the sliding force in N; the authors state no uncertainty."""

ROUNDED = 1.0 / np.sqrt(12.0)
"""Standard deviation of a rounding error, in units of the last digit."""

NORMAL = 1.4826
"""Ratio of standard deviation to median deviation of a normal distribution."""


def pose_errors(pushes: Sequence[Push]) -> tuple[float, float]:
    """Return the standard uncertainties of a displacement (mm) and a turn (rad).

    Height and tilt are constant on a flat surface, so their changes are errors of the poses. Errors in the plane are
    assumed to be as large.
    """
    lift = NORMAL * float(np.median([abs(push.lift) for push in pushes]))
    tilts = [abs(tilt) for push in pushes for tilt in (push.tilt_x, push.tilt_y)]
    return lift, NORMAL * float(np.median(tilts))


@cache
def uncertainties(pushes: tuple[Push, ...], of: Difference = force_error) -> Uncertainties:
    """Return the effects of a standard deviation of each measured or given number on the difference ``of``."""
    shift, turn = pose_errors(pushes)
    data, inputs, numerical = [], [], []
    for push in pushes:
        base = of(push, coulomb)
        changes = {
            **dict.fromkeys(("x", "y"), shift),
            "turn": turn,
            **dict.fromkeys(("end_x", "end_y"), shift / np.sqrt(2.0)),  # error of one pose
            **dict.fromkeys(("force_x", "force_y"), push.noise),  # noise of the first sample, the offset
        }
        moved = [replace(push, **{name: getattr(push, name) + change}) for name, change in changes.items()]
        data.append(_size([of(other, coulomb) - base for other in moved]))
        laws = [
            partial(coulomb, factor=1.0 + SLIDING_FORCE_TO * ROUNDED / SLIDING_FORCES[surface(push.series)]),
            *(partial(coulomb, centre=CENTRE + step * CENTRE_TO * ROUNDED) for step in (1.0, 1.0j)),
        ]
        inputs.append(_size([of(push, law) - base for law in laws]))
        finer = partial(coulomb, divisions=2 * DIVISIONS)
        numerical.append(0.0 if feet(push.series) else _size([of(push, finer) - base]))
    return Uncertainties(np.array(data), np.array(inputs), np.array(numerical))


def _size(changes: Sequence[float | FloatArray]) -> float:
    return float(np.linalg.norm(np.array(changes).ravel()))


ALIKE = 5.0, 7.5
"""Largest differences of equal pushes: distance of the hands at the start in mm, angle of the forces in degrees."""


def scatter(pushes: Sequence[Push], of: Difference = force_error) -> tuple[float, int]:
    """Return the standard deviation of a difference from push to equal push, and the number of pairs."""
    found = []
    for first, second in combinations(pushes, 2):
        apart = complex(first.start_x - second.start_x, first.start_y - second.start_y)
        turn = np.angle(measured(first).force * measured(second).force.conjugate(), deg=True)
        if abs(apart) < ALIKE[0] and abs(turn) < ALIKE[1]:
            found.append(_size([of(first, coulomb) - of(second, coulomb)]))
    return NORMAL * float(np.median(found)) / np.sqrt(2.0), len(found)


# --- Hypotheses about the remaining error


def pushed_above(push: Push, height: float) -> Wrench:
    """Return Coulomb's wrench for a pusher ``height`` mm above the surface, whose moment tilts the load."""
    return coulomb(push, centre=CENTRE + measured(push).force * height / (MASS * GRAVITY))


def summed(push: Push, *, exponent: float = 0.0, at_edges: float = 0.0) -> Wrench:
    """Return the wrench as a sum over contact points, with the share ``at_edges`` of a patch's load on its edges.

    μ is proportional to the speed to the power ``exponent``, with the same mean.
    """
    contact, motion = contact_of(push.series), Motion.of(push)
    arms, shares = np.array(contact.arms(0.0)), np.array(contact.shares)
    if at_edges > 0.0 and not feet(push.series):
        edges = _edges()
        arms = np.concatenate([arms, edges])
        shares = np.concatenate([(1.0 - at_edges) * shares, np.full(len(edges), at_edges / len(edges))])
    ways = motion.shift + 1j * motion.spin * arms
    lengths = np.maximum(abs(ways), 1e-12)
    strengths = shares * (lengths / (shares @ lengths)) ** exponent
    forces = SLIDING_FORCES[surface(push.series)] * strengths * ways / lengths
    return Wrench(complex(forces.sum()), float((arms.conjugate() * forces).imag.sum()))


def _edges(count: int = 60) -> NDArray[np.complex128]:
    corners = np.array([0.0, LEGS, 1j * LEGS, 0.0])
    lengths = abs(np.diff(corners))
    along = (np.arange(count) + 0.5) / count * lengths.sum()
    reached = np.concatenate([[0.0], np.cumsum(lengths)])
    return np.asarray((np.interp(along, reached, corners) - CENTRE) * MM)


def grouped(pushes: Iterable[Push]) -> dict[str, tuple[Push, ...]]:
    """Return the pushes of each series, which must follow each other."""
    return {series: tuple(group) for series, group in groupby(pushes, lambda push: push.series)}


@cache
def by_series() -> dict[str, tuple[Push, ...]]:
    return grouped(reduced_pushes())


def errors(pushes: Sequence[Push], of: Callable[[Push, Law], float], law: Law = coulomb) -> FloatArray:
    """Return the absolute values of the error function ``of`` under a law, shape (n,)."""
    return np.abs([of(push, law) for push in pushes])
