"""Periodic motions of a pin with one stick phase a period, all of them, by their return map.

Where friction lets go the pin rests on the disc and its pull is as large as friction, (7) with equality. These
places lie on half a circle, so that all that a stick phase leaves of the motion before it is one number: the angle α
by which the pull lags behind that of the offset, between 0 and π. From one release to the next α goes by a map of one
variable. Its fixed points are the orbits, and its slope there is their multiplier: of the other three one is that of
a shift in time, and two are zero, because stick forgets with which velocity and when the pin came to rest.

The map has gaps, from which the pin never sticks again, or for ever, and jumps where the stick phase that follows
vanishes and a later one takes its place.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import Akima1DInterpolator
from scipy.optimize import newton

from reference_model.contact.contact_law import require_whole
from reference_model.motion.pin_equations import SlipMotion
from reference_model.orbits.shooting import REFERENCE, Orbit, ShootingProblem
from reference_model.support import require_linear_support
from reference_model.systems import FloatArray, PinOnDisc, checked_tolerance, require_system
from reference_model.trajectory import Trajectory

LOOKS = (1.5, 16.0)
"""Turns, of the disc or of the pin on its springs, the slower of the two, for which a pin is followed.

Most stick again in the first of them; one that did not in the last is taken never to do so.
"""

NODES = 48
"""Releases at which the map is first asked; gaps and orbits less than π/NODES apart may hide between them."""

NODES_OF_PIECE = 32
"""Releases between two gaps through which a spline is laid, to find two fixed points next to each other as well."""

ROUNDING = 1e-12
"""Pull of a stuck pin, per distance and as a fraction of ω², that is nothing but rounding: then ω = k and β = 0."""

EDGE = 1e-5
"""Angle in rad to which the edges of the gaps are found."""

ROUGH = 1e-6
"""Tolerance at which fixed points are looked for, before each is found to the one asked for."""

JUMP = 1e-4
"""Angle in rad by which the map misses a fixed point if it changes sides there by a jump."""

SLOPE_STEPS = (1e-3, 1e-4, 1e-5)
"""Angles in rad of the central differences of fourth order that give the multiplier: the first that meets no gap.

At a tolerance of 1e-12 the map's noise of some 1e-13 leaves 1e-10 with the first, and so does its fourth power.
"""


class Release(NamedTuple):
    """The end of a stick phase: when in s, the angle α in rad, and how long it had lasted in s."""

    time: float
    angle: float
    stick_time: float


@dataclass(frozen=True)
class ReleaseMap:
    """How the releases of a pin follow each other.

    Parameters
    ----------
    pin : PinOnDisc
        The parameters, with friction, an offset and a disc that turns.
    tolerance : float
        Handed to ``simulate``.

    """

    pin: PinOnDisc
    tolerance: float

    @property
    def possible(self) -> bool:
        """Whether there is a release at all: friction that holds the pin, and a pull that changes meanwhile."""
        turns = abs(self._carried_pull) > ROUNDING * self.pin.disc_speed**2
        return turns and abs(self._offset_pull) > 0.0 and self.pin.friction_force > 0.0

    @property
    def turn(self) -> float:
        """Time in s of one turn of the disc or of the pin on its springs, the longer of the two."""
        return 2.0 * math.pi / min(abs(self.pin.disc_speed), self.pin.natural_frequency)

    @property
    def _offset_pull(self) -> complex:
        """Pull on the axis in m/s², k²X0: it does not turn. Zero if the disc does not turn either."""
        return self._motion.pull(0j, 0j) if self.pin.disc_speed != 0.0 else 0j

    @property
    def _carried_pull(self) -> complex:
        """Pull per distance from the axis in 1/s², ω² − k² − iωβ/m: it turns with the disc."""
        motion, omega = self._motion, 1j * self.pin.disc_speed
        return -motion.support.stiffness - (motion.damping + omega) * omega

    @property
    def _motion(self) -> SlipMotion:
        return SlipMotion.of(self.pin)

    def state(self, angle: float) -> FloatArray:
        """Return the state, shape (4,), in which the pin is released at ``angle``."""
        motion, offset = self._motion, self._offset_pull
        lag = cmath.exp(-1j * math.copysign(angle, motion.disc_speed))
        z = (motion.friction * lag * offset / abs(offset) - offset) / self._carried_pull
        v = 1j * motion.disc_speed * z
        return np.array((z.real, z.imag, v.real, v.imag))

    def angle(self, state: ArrayLike) -> float:
        """Return the angle by which the pull lags behind that of the offset in a ``state``, shape (4,), of rest."""
        x, y = np.asarray(state)[:2].tolist()
        pull = self._motion.pull(complex(x, y), 0j)
        return -math.copysign(1.0, self.pin.disc_speed) * cmath.phase(pull / self._offset_pull)

    def first(self, state: ArrayLike, wanted: Callable[[Release], bool]) -> tuple[Release | None, FloatArray]:
        """Return the first ``wanted`` release on the way from ``state``, shape (4,), if there is one.

        And the last state that was looked at, shape (4,): without such a release that after all the patience.
        """
        for turns in LOOKS:
            times = [0.0, turns * self.turn]
            trajectory = REFERENCE(self.pin, state, times, tolerance=self.tolerance)
            release = next(filter(wanted, self.along(trajectory)), None)
            if release is not None:
                break
        return release, trajectory.at_end

    def along(self, trajectory: Trajectory) -> Iterator[Release]:
        """Yield the releases of a trajectory of the pin."""
        for stick, slip in pairwise(trajectory.phases):
            if stick.kind == "stick":
                yield Release(slip.start, self.angle(slip.initial_state), stick.end - stick.start)

    def after(self, angle: float) -> Release | None:
        """Return the release that follows on one at ``angle``; None if the pin never sticks again."""
        # By rounding the pin may still be held for a moment.
        return self.first(self.state(angle), lambda release: release.time > release.stick_time)[0]

    def slope(self, angle: float) -> float:
        """Return the derivative of the map at ``angle`` by central differences, shorter ones next to a gap."""
        for step in SLOPE_STEPS:
            near, far = (
                (self.change(angle + reach) - self.change(angle - reach)) / (2.0 * reach)
                for reach in (step, 2.0 * step)
            )
            if math.isfinite(far):
                break
        return 1.0 + near + (near - far) / 3.0

    def pieces(self) -> Iterator[tuple[float, float]]:
        """Yield intervals of angles, in increasing order, from which the pin sticks again."""
        nodes = (np.arange(NODES) + 0.5) * math.pi / NODES
        sticks = [self.after(node) is not None for node in nodes.tolist()]
        start: float | None = EDGE if sticks[0] else None
        for i, (left, right) in enumerate(pairwise(nodes.tolist())):
            if sticks[i] != sticks[i + 1]:
                edge = self._edge(left, right) if sticks[i] else self._edge(right, left)
                if start is not None:
                    yield start, edge
                start = None if sticks[i] else edge
        if start is not None:
            yield start, math.pi - EDGE

    def _edge(self, inside: float, outside: float) -> float:
        """Return where a gap begins between two angles, on the side from which the pin sticks again."""
        while abs(outside - inside) > EDGE:
            middle = 0.5 * (inside + outside)
            if self.after(middle) is None:
                outside = middle
            else:
                inside = middle
        return inside

    def fixed(self) -> list[float]:
        """Return the angles that come back to themselves, in increasing order."""
        rough = replace(self, tolerance=max(ROUGH, self.tolerance))
        found: list[float] = []
        for guess in (guess for piece in rough.pieces() for guess in rough.nearly_fixed(*piece)):
            angle, result = newton(self.change, guess, tol=self.tolerance, full_output=True, disp=False)
            if result.converged and abs(self.change(angle)) < JUMP and not np.any(np.isclose(found, angle)):
                found.append(float(angle))
        return sorted(found)

    def nearly_fixed(self, left: float, right: float) -> list[float]:
        """Return the zeros of a spline through the change of angle between two angles."""
        nodes = 0.5 * (left + right - (right - left) * np.cos(np.linspace(0.0, math.pi, NODES_OF_PIECE)))
        changes = np.array([self.change(node) for node in nodes.tolist()])
        defined = np.isfinite(changes)
        if np.count_nonzero(defined) < 2:
            return []
        spline = Akima1DInterpolator(nodes[defined], changes[defined])
        return [float(zero) for zero in spline.roots(extrapolate=False)]

    def change(self, angle: float) -> float:
        """Return by how much the angle changes from one release to the next; nan if one of them is none."""
        release = self.after(angle) if 0.0 < angle < math.pi else None
        return math.nan if release is None else release.angle - angle


@dataclass(frozen=True, eq=False, kw_only=True)
class StickSlipOrbit(Orbit):
    """A periodic motion of a pin with one stick phase a period; as an :class:`Orbit` it starts halfway through slip.

    Parameters
    ----------
    system : PinOnDisc
        The parameters.
    release : array of shape (4,)
        The state in which friction lets go.
    release_angle : float
        α in rad, by which the pull lags behind that of the offset there.
    stick_time : float
        In s.
    multiplier : float
        Factor by which a small deviation of the release angle grows in a period.

    """

    system: PinOnDisc
    release: FloatArray
    release_angle: float
    stick_time: float
    multiplier: float

    @property
    def multipliers(self) -> tuple[complex, ...]:
        """Floquet multipliers, largest first: ``multiplier``, 1 of a shift in time, and two that are zero."""
        return tuple(sorted((complex(self.multiplier), 1.0 + 0j, 0j, 0j), key=abs, reverse=True))

    @property
    def stable(self) -> bool:
        """Whether all small deviations die out but for a shift in time."""
        return abs(self.multiplier) < 1.0


def stick_slip_orbits(
    pin: PinOnDisc, *, tolerance: float = 1e-12, samples: int = 256
) -> tuple[StickSlipOrbit, ...]:
    """Return the periodic motions of ``pin`` that stick once a period, by increasing release angle.

    The stable ones are stick–slip cycles. One whose multiplier is larger than 1 is a saddle: what comes to it
    separates the starts that come to two other motions.

    Parameters
    ----------
    pin : PinOnDisc
        The parameters. There are no such motions without offset, without friction, or on a disc at rest.
    tolerance : float
        Handed to ``simulate``.
    samples : int
        Intervals of the returned trajectories.

    Raises
    ------
    ValueError
        If ``pin`` is no pin, if its support is not linear, or for a tolerance or samples that can't be.

    """
    require_system(pin, PinOnDisc)
    require_linear_support(pin)
    require_whole("samples", samples, least=1)
    releases = ReleaseMap(pin, checked_tolerance(tolerance))
    return tuple(_orbit(releases, angle, samples) for angle in releases.fixed()) if releases.possible else ()


def _orbit(releases: ReleaseMap, angle: float, samples: int) -> StickSlipOrbit:
    """Return the orbit that is released at ``angle``."""
    pin, tolerance = releases.pin, releases.tolerance
    release = releases.after(angle)
    assert release is not None  # the angle is a fixed point
    period = release.time
    state = releases.state(angle)
    start = REFERENCE(pin, state, [0.0, 0.5 * (period - release.stick_time)], tolerance=tolerance).at_end
    trajectory = REFERENCE(pin, start, np.linspace(0.0, period, samples + 1), tolerance=tolerance)
    miss = trajectory.at_end - start
    return StickSlipOrbit(
        system=pin,
        state=start,
        period=period,
        residual=float(np.max(np.abs(miss)) / np.max(np.abs(start))),
        trajectory=trajectory,
        problem=ShootingProblem(REFERENCE, pin, tolerance),
        release=state,
        release_angle=angle,
        stick_time=release.stick_time,
        multiplier=releases.slope(angle),
    )
