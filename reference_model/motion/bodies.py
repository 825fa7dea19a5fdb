"""The sequence of slip and stick phases of a pin or a disc, and creep in closed form."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from operator import mul

import numpy as np

from reference_model.contact.contact_law import NONE, IsotropicContact
from reference_model.motion.disc_equations import DiscMotion
from reference_model.motion.pin_equations import SlipMotion
from reference_model.motion.slip.breakaway import begin_slip
from reference_model.motion.slip.coordinates import LEAST_SLIP, Coordinates, Leave, stop_surfaces
from reference_model.motion.slip.slide import slide, slide_slowly
from reference_model.motion.stepper import Run, SwitchingSurface
from reference_model.motion.stick import can_hold, release_delay, slip_direction, slip_from_rest, stuck_centre
from reference_model.systems import FloatArray

CREEP = 1e-6
"""Largest distance and slip speed, in scaled units, of creep in closed form."""

ERROR = 0.01
"""Largest error of that distance, as a share of the local tolerance."""


@dataclass(frozen=True)
class Creep:
    """Slip that decays forever, s = A·exp(−λt) + B·exp(−Λt) with λ < Λ and A > 0, in scaled units.

    ``slow`` is (A, λ) and ``fast`` (B, Λ).
    """

    slow: tuple[float, float]
    fast: tuple[float, float]

    @classmethod
    def of(cls, slip: float, excess: float, damping: float, fall: float) -> Creep | None:
        """Return the solution of s'' + b·s' + c·s = 0 with s' = e − b·s; None if it grows or ends in rest."""
        discriminant = damping**2 - 4.0 * fall
        if not (fall > 0.0 and damping > 0.0 and discriminant > 0.0):
            return None
        apart = math.sqrt(discriminant)
        fast = 0.5 * (damping + apart)
        slow = fall / fast
        share = (excess - slow * slip) / apart
        return cls((share, slow), (slip - share, fast)) if share > 0.0 else None

    @property
    def way_left(self) -> float:
        return sum(size / rate for size, rate in (self.slow, self.fast))

    def slip(self, delays: FloatArray) -> FloatArray:
        return np.asarray(sum(size * np.exp(-rate * delays) for size, rate in (self.slow, self.fast)))

    def way(self, delays: FloatArray) -> FloatArray:
        return np.asarray(
            sum(size / rate * -np.expm1(-rate * delays) for size, rate in (self.slow, self.fast))
        )


class Body(ABC):
    """A body that slips over the master disc or sticks to it, in scaled unknowns relative to that disc."""

    def __init__(self, run: Run, coordinates: Coordinates, centre: SlipMotion) -> None:
        self.run = run
        self.coordinates = coordinates
        self.sticky = centre.friction > 0.0
        self.autonomous = centre.disc_speed == 0.0 or centre.support.offset == 0.0

    def go(self, y: list[float]) -> tuple[float, list[float]]:
        run, t = self.run, 0.0
        run.record(t, lambda _: np.array([y]).T)
        self.begin(y)
        while t < run.end:
            t, y = self.advance(t, y)
        return t, y

    def begin(self, y: list[float]) -> None:
        stuck = self.sticky and self.coordinates.speed(y) == 0.0 and self.holds_for(y) > 0.0
        self.run.enter("stick" if stuck else "slip", 0.0, y)

    def advance(self, t: float, y: list[float]) -> tuple[float, list[float]]:
        """Follow the motion until its description changes; return time and unknowns."""
        if not self.sticky or self.coordinates.speed(y) > 0.0:
            creep = self.creeping(self.coordinates, y)
            return self.slip(t, y) if creep is None else self.creep(t, y, creep)
        held = self.holds_for(y)
        if held > 0.0:
            return self.stick(t, y, held)
        return self.begin_to_slip(t, y)

    def slip(self, t: float, y: list[float]) -> tuple[float, list[float]]:
        slowly = self.sticky and self.coordinates.speed(y) < self.coordinates.slow(y)
        end = (slide_slowly if slowly else slide)(self.run, self.coordinates, t, y, self.leave)
        return end.t, end.y

    def leave(self, y: list[float]) -> bool:
        return self.creeping(self.coordinates, y) is not None

    def creeping(self, motion: Coordinates, y: list[float]) -> Creep | None:
        """Return the creep in the coordinates ``motion`` if slip decays forever and is almost over; else None.

        The excess e of the pull over friction falls by c times the distance, and slip changes at the rate e − b·s. To
        first order in the distance b and c are constant, so s'' + b·s' + c·s = 0.
        """
        d, s = motion.slip, motion.speed(y)
        if not 0.0 < s < CREEP or not self.sticky or not self.autonomous:
            return None
        n = [part / s for part in y[-d:]]
        resting, moving = (motion.rates([*y[:-d], *[v * part for part in n]]) for v in (LEAST_SLIP, 1.0))
        directions = [b - c for b, c in zip(moving[:-d], resting[:-d], strict=True)]

        def next_to_rest(way: float) -> list[float]:
            there = [a + way * b for a, b in zip(y[:-d], directions, strict=True)]
            return [*there, *[LEAST_SLIP * part for part in n]]

        def growth_at(unknowns: list[float]) -> float:
            return float(sum(map(mul, n, motion.rates(unknowns)[-d:])))

        growth, excess = growth_at(y), growth_at(next_to_rest(0.0))
        if not growth < 0.0 < excess:
            return None
        fall = (excess - growth_at(next_to_rest(CREEP))) / CREEP
        creep = Creep.of(s, excess, damping=(excess - growth) / s, fall=fall)
        if creep is None or not creep.way_left < CREEP:
            return None
        end = next_to_rest(creep.way_left)
        if motion.grip is not None and motion.grip(end) <= 0.0:
            return None
        # Friction must hold the body where slip ends.
        left = abs(growth_at(end) / excess)
        return creep if left * creep.way_left <= ERROR * self.run.local_tolerance else None

    def creep(self, t: float, y: list[float], creep: Creep) -> tuple[float, list[float]]:
        run, s = self.run, float(creep.slip(np.zeros(1))[0])

        def sample(times: FloatArray) -> FloatArray:
            delays = times - t
            return self.carried(y, delays, creep.slip(delays) / s, creep.way(delays) / s)

        run.record(run.end, sample)
        return run.end, sample(np.array([run.end]))[:, 0].tolist()

    def stick(self, t: float, y: list[float], held: float) -> tuple[float, list[float]]:
        """Turn with the master disc for the time ``held`` until release, or to the end of the run."""
        self.run.enter("stick", t, y)
        release = min(t + held, self.run.end)

        def sample(times: FloatArray) -> FloatArray:
            none = np.zeros_like(times)
            return self.carried(y, times - t, none, none)

        self.run.record(release, sample)
        y = sample(np.array([release]))[:, 0].tolist()
        if release < self.run.end:
            self.run.enter("slip", release, y)
            return self.begin_to_slip(release, y)
        return release, y

    @abstractmethod
    def holds_for(self, y: Sequence[float]) -> float:
        """Return how long friction holds the body at rest at ``y``."""

    @abstractmethod
    def carried(
        self, y: Sequence[float], delays: FloatArray, slip: FloatArray, way: FloatArray
    ) -> FloatArray:
        """Return the unknowns of a body that sticks or creeps after ``delays``, shape (unknowns, n).

        The direction of slip is fixed on the master disc. ``slip`` and ``way`` are in units of the slip of ``y``.
        """

    @abstractmethod
    def begin_to_slip(self, t: float, y: list[float]) -> tuple[float, list[float]]:
        """Follow slip from rest."""


class PinBody(Body):
    """The pin; its unknowns are x, y and the slip velocity."""

    def __init__(self, run: Run, motion: SlipMotion) -> None:
        self.motion = motion
        omega, g = motion.disc_speed, motion.friction

        def rates(unknowns: Sequence[float]) -> tuple[float, ...]:
            x, y, wx, wy = unknowns
            w = wx + 1j * wy
            a = motion.pull(x + 1j * y, w) - g * w / (abs(w) + NONE)
            return wx - omega * y, wy + omega * x, a.real, a.imag

        slow = run.thresholds.slow_slip * g
        surfaces = stop_surfaces(motion.support)
        super().__init__(
            run, Coordinates(rates, 2, lambda _: slow, abs(omega) + 1.0, surfaces=surfaces), motion
        )

    def holds_for(self, y: Sequence[float]) -> float:
        """Like :meth:`Body.holds_for`, by eq. 6 and 7."""
        z = complex(y[0], y[1])
        return release_delay(self.motion, z) if can_hold(self.motion, z) else 0.0

    def carried(
        self, y: Sequence[float], delays: FloatArray, slip: FloatArray, way: FloatArray
    ) -> FloatArray:
        turn = np.exp(1j * self.motion.disc_speed * delays)
        w = complex(y[2], y[3])
        z = (complex(y[0], y[1]) + way * w) * turn
        w = slip * w * turn
        return np.array((z.real, z.imag, w.real, w.imag))

    def begin_to_slip(self, t: float, y: list[float]) -> tuple[float, list[float]]:
        """Like :meth:`Body.begin_to_slip`; on a linear support by the series while it is accurate."""
        run = self.run
        if not self.motion.support.linear:
            pull, omega = self.motion.pull(complex(y[0], y[1]), 0j), self.motion.disc_speed
            direction = np.array((pull.real, pull.imag)) / abs(pull)
            drift = -omega * y[1], omega * y[0]
            return begin_slip(run, self.coordinates, t, y[:2], drift, direction, self.leave)[:2]
        start = slip_from_rest(self.motion, complex(y[0], y[1]), tolerance=run.thresholds.series)
        run.evaluations += len(start.positions)
        stop = t + min(start.duration, start.rest)
        end = min(stop, run.end)

        def sample(times: FloatArray) -> FloatArray:
            z, w = start.at(times - t)
            return np.array((z.real, z.imag, w.real, w.imag))

        run.record(end, sample)
        y = sample(np.array([end]))[:, 0].tolist()
        rests = start.rest <= start.duration and end == stop
        if rests:
            y[2:] = [0.0, 0.0]
        elif end < run.end:
            return slide(run, self.coordinates, end, y, self.leave)[:2]
        return end, y


class DiscBody(Body):
    """The friction disc; its unknowns are x, y, φ, the slip velocity of the centre and r = κ(φ̇ − ω)."""

    def __init__(self, run: Run, motion: DiscMotion, surfaces: tuple[SwitchingSurface, ...] = ()) -> None:
        self.motion = motion
        slow = run.thresholds.slow_slip * motion.centre.friction
        surfaces += stop_surfaces(motion.centre.support)
        coordinates = Coordinates(motion.rates, 3, lambda _: slow, motion.pace, angle=2, surfaces=surfaces)
        super().__init__(run, coordinates, motion.centre)

    def carried(
        self, y: Sequence[float], delays: FloatArray, slip: FloatArray, way: FloatArray
    ) -> FloatArray:
        turn = self.motion.centre.disc_speed * delays
        u = complex(y[3], y[4])
        z = (complex(y[0], y[1]) + way * u) * np.exp(1j * turn)
        angle = y[2] + turn + way * y[5] / self.motion.gyration
        u = slip * u * np.exp(1j * turn)
        return np.array((z.real, z.imag, angle, u.real, u.imag, slip * y[5]))

    def begin_to_slip(self, t: float, y: list[float]) -> tuple[float, list[float]]:
        return self.begin_slip(t, y[:3], self.coordinates, self.drift(y), self.direction(y))

    def begin_slip(
        self,
        t: float,
        own: Sequence[float],
        coordinates: Coordinates,
        drift: Sequence[float],
        direction: FloatArray,
    ) -> tuple[float, list[float]]:
        end = begin_slip(self.run, coordinates, t, own, drift, direction, self.leaving(coordinates))
        return end.t, coordinates.standard(np.array([end.y]).T)[:, 0].tolist()

    def leaving(self, motion: Coordinates) -> Leave:
        return self.leave

    def drift(self, y: Sequence[float]) -> tuple[float, float, float]:
        omega = self.motion.centre.disc_speed
        return -omega * y[1], omega * y[0], omega

    @abstractmethod
    def direction(self, y: Sequence[float]) -> FloatArray:
        """Return the unit vector of the incipient slip, shape (3,)."""


class RingBody(DiscBody):
    """A disc with an isotropic contact."""

    def __init__(self, run: Run, motion: DiscMotion, contact: IsotropicContact) -> None:
        rims = (SwitchingSurface(partial(motion.lead_over_rim, radius)) for radius in contact.resting_radii)
        super().__init__(run, motion, tuple(rims))
        self.contact = contact
        self.stuck = stuck_centre(motion, contact) if self.sticky else None

    def holds_for(self, y: Sequence[float]) -> float:
        z = complex(y[0], y[1])
        return release_delay(self.stuck, z) if self.stuck is not None and can_hold(self.stuck, z) else 0.0

    def direction(self, y: Sequence[float]) -> FloatArray:
        return slip_direction(self.motion, self.contact, complex(y[0], y[1]))
