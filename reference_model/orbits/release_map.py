"""All periodic motions of a pin with one stick phase per period, by their return map.

At a release the pull equals friction, (7) with equality. So one number contains the previous motion: the lag α of the
pull behind the offset's pull, between 0 and π. Orbits are the fixed points of the map from one α to the next, and its
slopes their multipliers. The map has gaps, where the pin never sticks again or sticks permanently, and jumps where
the next stick phase vanishes.
"""

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

from reference_model.orbits.shooting import REFERENCE, Orbit, ShootingProblem
from reference_model.support import require_linear_support
from reference_model.systems import FloatArray, PinOnDisc, checked_tolerance, require_kind, require_whole
from reference_model.trajectory import Trajectory

SEARCH_TIMES = (1.5, 16.0)
"""Search times for a release, in units of the longer of a turn of the disc and a free period of the pin.

A pin that does not stick within the second of these times is assumed never to stick.
"""

NODES = 48
"""Number of initial nodes; gaps and orbits less than π/NODES apart may be missed."""

NODES_OF_PIECE = 32
"""Number of spline nodes between two gaps, enough to resolve neighbouring fixed points."""

ROUNDING = 1e-12
"""Pull per distance, as a fraction of ω², that counts as zero, as for ω = k and β = 0."""

EDGE = 1e-5
"""Tolerance in rad of the edges of the gaps."""

ROUGH = 1e-6
"""Tolerance of the search for fixed points, before they are refined."""

JUMP = 1e-4
"""Residual in rad above which a change of sign is a jump, not a fixed point."""

SLOPE_STEPS = (1e-3, 1e-4, 1e-5)
"""Steps in rad of the central differences for the multiplier; the first that meets no gap is used."""


class Release(NamedTuple):
    """The end of a stick phase: its time in s, the angle α in rad, and the duration of the phase in s."""

    time: float
    angle: float
    stick_time: float


@dataclass(frozen=True)
class ReleaseMap:
    """The map from one release to the next, of a pin with friction, an offset and a turning disc."""

    pin: PinOnDisc
    tolerance: float

    @property
    def possible(self) -> bool:
        """True if releases exist: friction must hold the pin, and the pull must change in stick."""
        turns = abs(self._carried_pull) > ROUNDING * self.pin.disc_speed**2
        return turns and abs(self._offset_pull) > 0.0 and self.pin.friction_force > 0.0

    @property
    def turn(self) -> float:
        """The longer of a turn of the disc and a free period of the pin, in s."""
        return 2.0 * math.pi / min(abs(self.pin.disc_speed), self.pin.natural_frequency)

    @property
    def _offset_pull(self) -> float:
        """Pull on the axis in m/s², k²X0, which does not turn; zero if the disc is at rest."""
        return self.pin.stiffness * self.pin.offset / self.pin.mass if self.pin.disc_speed != 0.0 else 0.0

    @property
    def _carried_pull(self) -> complex:
        """Pull per distance from the axis in 1/s², ω² − k² − iωβ/m, which turns with the disc."""
        pin = self.pin
        return complex(pin.disc_speed**2 - pin.stiffness / pin.mass, -pin.disc_speed * pin.damping / pin.mass)

    def state(self, angle: float) -> FloatArray:
        """Return the state of release at ``angle``, shape (4,)."""
        omega, offset = self.pin.disc_speed, self._offset_pull
        limit = self.pin.friction_force / self.pin.mass * math.copysign(1.0, offset)
        z = (limit * cmath.exp(-1j * math.copysign(angle, omega)) - offset) / self._carried_pull
        v = 1j * omega * z
        return np.array((z.real, z.imag, v.real, v.imag))

    def angle(self, state: ArrayLike) -> float:
        """Return the lag of the pull behind the offset's pull, for a ``state`` of rest, shape (4,)."""
        x, y = np.asarray(state)[:2].tolist()
        pull = self._offset_pull + self._carried_pull * complex(x, y)
        return -math.copysign(1.0, self.pin.disc_speed) * cmath.phase(pull / self._offset_pull)

    def first(self, state: ArrayLike, wanted: Callable[[Release], bool]) -> tuple[Release | None, FloatArray]:
        """Return the first ``wanted`` release after ``state``, or None, and the last state."""
        for turns in SEARCH_TIMES:
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
        """Return the release after a release at ``angle``; None if the pin never sticks again."""
        # Rounding may hold the pin for another moment.
        return self.first(self.state(angle), lambda release: release.time > release.stick_time)[0]

    def slope(self, angle: float) -> float:
        """Return the derivative of the map at ``angle`` by central differences."""
        for step in SLOPE_STEPS:
            near, far = (
                (self.change(angle + reach) - self.change(angle - reach)) / (2.0 * reach)
                for reach in (step, 2.0 * step)
            )
            if math.isfinite(far):
                break
        return 1.0 + near + (near - far) / 3.0

    def pieces(self) -> Iterator[tuple[float, float]]:
        """Yield the intervals of angles that lead to another stick phase, in increasing order."""
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
        while abs(outside - inside) > EDGE:
            middle = 0.5 * (inside + outside)
            if self.after(middle) is None:
                outside = middle
            else:
                inside = middle
        return inside

    def fixed(self) -> list[float]:
        """Return the fixed points of the map, in increasing order."""
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
        """Return the change of the angle from one release to the next, or nan."""
        release = self.after(angle) if 0.0 < angle < math.pi else None
        return math.nan if release is None else release.angle - angle


@dataclass(frozen=True, eq=False, kw_only=True)
class StickSlipOrbit(Orbit):
    """A periodic motion of a pin with one stick phase per period; as an :class:`Orbit` it starts in mid-slip.

    ``release``, shape (4,), is the state at the release, ``release_angle`` its lag α in rad, and ``stick_time`` is in
    s. ``multiplier`` is the growth of a small deviation of α per period.
    """

    system: PinOnDisc
    release: FloatArray
    release_angle: float
    stick_time: float
    multiplier: float

    @property
    def multipliers(self) -> tuple[complex, ...]:
        """Floquet multipliers, largest first: ``multiplier``, 1 for a shift in time, and two zeros."""
        return tuple(sorted((complex(self.multiplier), 1.0 + 0j, 0j, 0j), key=abs, reverse=True))

    @property
    def stable(self) -> bool:
        """True if all small deviations decay, apart from a shift in time."""
        return abs(self.multiplier) < 1.0


def stick_slip_orbits(
    pin: PinOnDisc, *, tolerance: float = 1e-12, samples: int = 256
) -> tuple[StickSlipOrbit, ...]:
    """Return the periodic motions of ``pin`` with one stick phase per period, in order of increasing release angle.

    Stable orbits are stick-slip cycles. The stable set of a saddle, with a multiplier > 1, separates starts that lead
    to two other motions. There are no orbits without offset or friction, or on a disc at rest.
    Raises ``ValueError`` if an argument is invalid, or the support is not linear.
    """
    require_kind("pin", pin, PinOnDisc)
    require_linear_support(pin)
    require_whole("samples", samples, least=1)
    releases = ReleaseMap(pin, checked_tolerance(tolerance))
    return tuple(_orbit(releases, angle, samples) for angle in releases.fixed()) if releases.possible else ()


def _orbit(releases: ReleaseMap, angle: float, samples: int) -> StickSlipOrbit:
    pin, tolerance = releases.pin, releases.tolerance
    release = releases.after(angle)
    assert release is not None
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
