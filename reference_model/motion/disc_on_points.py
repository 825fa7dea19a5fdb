"""A disc on single points: it slips, pivots about a point at rest, or sticks.

A point at rest about which the disc turns stays at rest while its share of friction suffices: a pivot phase
(:mod:`reference_model.motion.pivot`). If two points rest, the whole disc sticks.
"""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.optimize import brentq, minimize, minimize_scalar

from reference_model.contact.limit_surface import PointsLimit
from reference_model.contact.points import Points
from reference_model.motion.bodies import DiscBody
from reference_model.motion.disc_equations import DiscMotion
from reference_model.motion.pivot import OnePoint
from reference_model.motion.slip.coordinates import LEAST_SLIP, Coordinates, Leave, come_to_rest
from reference_model.motion.slip.slide import slide, slide_slowly
from reference_model.motion.stepper import Run
from reference_model.motion.stick import GRAZING, ROUNDING
from reference_model.systems import ComplexArray, FloatArray

SAMPLES_PER_TURN = 360


class PointsBody(DiscBody):
    """A disc on points."""

    def __init__(self, run: Run, motion: DiscMotion, contact: Points) -> None:
        super().__init__(run, motion)
        self.contact = contact
        self.limit = PointsLimit.of(contact, motion.length)
        self.points = [OnePoint(motion, contact, i) for i in range(len(contact.shares))]
        self.slipping = [point.slipping(run.thresholds) for point in self.points]
        self.pivoting = [point.pivoting(run.thresholds) for point in self.points]
        self.pivot: int | None = None
        leverage = max(point.leverage for point in self.points)
        self._least_speed = max(run.thresholds.common_rest, run.local_tolerance * leverage)

    def begin(self, y: list[float]) -> None:
        resting = self._slow_point(y) if self.sticky and self.coordinates.speed(y) > 0.0 else None
        if resting is not None and self._at_rest(resting, y):
            self._rest_on(resting, 0.0, y)
        if self.pivot is None:
            super().begin(y)

    def advance(self, t: float, y: list[float]) -> tuple[float, list[float]]:
        if self.pivot is not None:
            return self._turn_about(self.pivot, t, y)
        slow = self._slow_point(y) if self.sticky and self.coordinates.speed(y) > 0.0 else None
        if slow is None or self.creeping(self.coordinates, y) is not None:
            return super().advance(t, y)
        if self.coordinates.speed(y) < self._least_speed:
            return self._rest(t, y)
        own = self._own(slow, y)
        if not self._at_rest(slow, y):
            end = slide_slowly(self.run, self.slipping[slow], t, own, self.leaving(self.slipping[slow]))
            t, own = end.t, end.y
            y = self.slipping[slow].standard(np.array([own]).T)[:, 0].tolist()
            if self.slipping[slow].speed(own) > 0.0 or t >= self.run.end:
                return t, y
        if not self._rest_on(slow, t, y):
            return self._slip_from(slow, t, y)
        return t, y

    def _rest(self, t: float, y: list[float]) -> tuple[float, list[float]]:
        """Bring the disc to rest as a whole; it is so slow that the order of its points does not matter."""
        rates = self.coordinates.rates(y)
        speed = self.coordinates.speed(y)
        falling = -sum(a * b for a, b in zip(y[3:], rates[3:], strict=True)) / speed
        if falling <= 0.0:
            return t, [*y[:3], 0.0, 0.0, 0.0]
        return t + speed / falling, come_to_rest(self.run, self.coordinates, t, speed / falling, y)

    def leave(self, y: list[float]) -> bool:
        return super().leave(y) or (self.sticky and self._slow_point(y) is not None)

    def leaving(self, motion: Coordinates) -> Leave:
        """Like :meth:`DiscBody.leaving`; coordinates of a single point end if the disc creeps."""
        if motion is self.coordinates:
            return self.leave
        if motion.slip == 1:
            return lambda own: self.creeping(motion, own) is not None
        whole = super().leave
        return lambda own: whole(motion.standard(np.array([own]).T)[:, 0].tolist())

    def _slow_point(self, y: Sequence[float]) -> int | None:
        """Return the point that slips slowly and decelerates, or rests."""
        u, turning = complex(y[3], y[4]), 1j * y[5] / (self.motion.gyration * self.motion.length)
        speeds = [abs(u + turning * arm) for arm in self.contact.arms(y[2])]
        slowest = min(speeds)
        i = speeds.index(slowest)
        own = [*y[:3], y[5], 0.0, 0.0]
        if slowest >= self.slipping[i].slow(own):
            return None
        own = self._own(i, y)
        rates = self.slipping[i].rates(own)
        return i if self._at_rest(i, y) or own[4] * rates[4] + own[5] * rates[5] < 0.0 else None

    def _at_rest(self, i: int, y: Sequence[float]) -> bool:
        return abs(self.points[i].velocity(y)) <= 4.0 * float(np.finfo(float).eps) * math.hypot(y[3], y[4])

    def _own(self, i: int, y: Sequence[float]) -> list[float]:
        v = self.points[i].velocity(y)
        return [*y[:3], y[5], v.real, v.imag]

    def _rest_on(self, i: int, t: float, y: Sequence[float]) -> bool:
        holds = self.points[i].grip([*y[:3], y[5]]) > 0.0
        if holds:
            self.pivot = i
            self.run.enter("pivot", t, y)
        return holds

    def _turn_about(self, i: int, t: float, y: list[float]) -> tuple[float, list[float]]:
        motion, own = self.pivoting[i], [*y[:3], y[5]]
        creep = self.creeping(motion, own)
        if creep is not None:
            return self.creep(t, y, creep)
        slowly = motion.speed(own) < motion.slow(own) and own[3] * motion.rates(own)[3] < 0.0
        end = (slide_slowly if slowly else slide)(self.run, motion, t, own, self.leaving(motion))
        y = motion.standard(np.array([end.y]).T)[:, 0].tolist()
        if end.released and motion.speed(end.y) > 0.0:
            self.pivot = None
            self.run.enter("slip", end.t, y)
            return self._slip_from(i, end.t, y)
        if motion.speed(end.y) == 0.0:
            self.pivot = None
        return end.t, y

    def _slip_from(self, i: int, t: float, y: Sequence[float]) -> tuple[float, list[float]]:
        """Follow point ``i`` as it slips from rest, unless the disc stops before that matters."""
        own = [*y[:3], y[5]]
        point = self.points[i]
        if point.gain(own) < self._least_speed:
            motion = replace(self.pivoting[i], grip=None)
            end = slide_slowly(self.run, motion, t, own, lambda _: False)
            return end.t, motion.standard(np.array([end.y]).T)[:, 0].tolist()
        return self.begin_slip(t, own, self.slipping[i], point.pivoting_rates(own), point.leaving(own))

    def _share(self, y: Sequence[float], delays: FloatArray | float = 0.0) -> tuple[ComplexArray, float]:
        """Return the force and moment that friction must hold, divided by μN/m, in the frame of the disc."""
        centre = self.motion.centre
        turns = np.exp(1j * centre.disc_speed * np.atleast_1d(delays))
        pulls = np.array([centre.pull(place, 0j) for place in (complex(y[0], y[1]) * turns).tolist()])
        forces = pulls / (turns * np.exp(1j * y[2]))
        moment = self.motion.turning_pull(0.0) * self.motion.gyration
        return forces / centre.friction, moment / centre.friction

    def holds_for(self, y: Sequence[float]) -> float:
        """Like :meth:`DiscBody.holds_for`, up to the first root of the margin within one turn."""
        centre = self.motion.centre

        def margin(delay: float) -> float:
            return float(self.limit.margins(*self._share(y, delay))[0])

        if margin(0.0) < -ROUNDING:
            return 0.0
        if centre.disc_speed == 0.0 or centre.support.offset == 0.0:
            return math.inf
        delays = np.linspace(0.0, 2.0 * math.pi / abs(centre.disc_speed), SAMPLES_PER_TURN + 1)
        margins = self.limit.margins(*self._share(y, delays))
        if margins[0] < ROUNDING and margin(1e-6 * delays[1]) < margins[0]:
            return 0.0
        for k in range(1, SAMPLES_PER_TURN + 1):
            given_way = float(delays[k])
            if margins[k] >= 0.0:
                # Near a local minimum the margin may dip by as much as it changes to the next samples.
                around = margins[k - 1 : k + 2]
                if margins[k] > around.min() or margins[k] > np.ptp(around):
                    continue
                ends = (float(delays[k - 1]), float(delays[min(k + 1, SAMPLES_PER_TURN)]))
                dip = minimize_scalar(margin, bounds=ends, method="bounded", options={"xatol": 1e-9})
                if dip.fun >= -GRAZING:
                    continue
                given_way = float(dip.x)
            held = float(delays[k - 1])
            if margin(held) <= 0.0:
                return held
            return float(brentq(margin, held, given_way, xtol=1e-15, rtol=1e-14))
        return math.inf

    def begin_to_slip(self, t: float, y: list[float]) -> tuple[float, list[float]]:
        pivot = self._pivot_of(y)
        if pivot is None:
            return super().begin_to_slip(t, y)
        i, sense = pivot
        self.run.enter("pivot", t, y)
        self.pivot = i
        return self.begin_slip(t, y[:3], self.pivoting[i], self.drift(y), np.array([sense]))

    def _pivot_of(self, y: Sequence[float]) -> tuple[int, float] | None:
        """Return the initial pivot and the sense of rotation; None if all points slip."""
        least = -ROUNDING * self.motion.centre.friction
        for i, point in enumerate(self.points):
            for sense in (1.0, -1.0):
                own = [*y[:3], sense * LEAST_SLIP]
                if point.grip(own) > 0.0 and sense * point.pivoting_rates(own)[3] >= least:
                    return i, sense
        return None

    def direction(self, y: Sequence[float]) -> FloatArray:
        """Like :meth:`DiscBody.direction`, normal to the limit surface.

        If friction is exceeded it minimises ½q² + g·P(q) − a·q, where a − g∇P(q) = q.
        """
        forces, moment = self._share(y)
        if self.limit.margins(forces, moment)[0] > -GRAZING:
            u, w = self.limit.direction(complex(forces[0]), moment)
            u *= np.exp(1j * y[2])
            n = np.array((u.real, u.imag, w * self.motion.gyration))
            return np.asarray(n / np.linalg.norm(n))
        pull = np.array(self.motion.rates([*y[:3], 0.0, 0.0, 0.0])[3:])

        def cost(q: FloatArray) -> tuple[float, FloatArray]:
            slope = np.array(self.motion.rates([*y[:3], *q.tolist()])[3:])
            friction = self._pull_at(y, q) - slope
            return float(0.5 * q @ q + friction @ q - pull @ q), q + friction - pull

        found = minimize(cost, pull, jac=True, method="BFGS", options={"gtol": 1e-10 * np.linalg.norm(pull)})
        return np.asarray(found.x / np.linalg.norm(found.x))

    def _pull_at(self, y: Sequence[float], q: FloatArray) -> FloatArray:
        a = self.motion.centre.pull(complex(y[0], y[1]), complex(q[0], q[1]))
        return np.array((a.real, a.imag, self.motion.turning_pull(float(q[2]))))
