"""Stick found from states, for engines that tell none: when a body comes to rest on the master disc and lets go.

Up to stick the slip falls as the time that is left, and from release on it grows as the square of the time that is
gone: both are followed down to where the engine's own creep or noise begins, and extrapolated from there.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from reference_model.support import Support
from reference_model.systems import DiscOnDisc, FloatArray, System
from reference_model.trajectory import Phase, Trajectory, phases_of

PER_PERIOD = 64
"""Samples in a period of the support or in a revolution, whichever is shorter."""

MOST = 20_000
"""Samples that a motion is looked at before one looks closer."""

REST = 1e-2
"""Slip over the largest speed of the motion, below which a body may stick; looking closer, it must come down more."""

CREEP = 3e-4
"""Slip over the largest speed of the motion, up to which a body may creep where it sticks, at a tolerance of 1e-9.

It goes with the tolerance, as the creep of a smoothed law should, up to ``REST``.
"""

CLOSER = 64
"""By how much samples become denser, and the slip that is looked for smaller, at one look."""

LOOKS = 3

LEAST = 1e-7
"""Slip over the largest speed of the motion from which is extrapolated at a tolerance of 1e-9; it goes with its root.

What is off by extrapolation then changes with the tolerance, and is in the errors that are estimated by that.
"""

ABOVE_NOISE = 32.0
"""The same over an engine's precision, where that is more."""

NOISE = 0.1
"""Change of slip from sample to sample, over the slip, from which on it is rounding and no creep."""

ABOVE_CREEP = 8.0
"""Least slip from which is extrapolated, over that in a stick phase."""

QUIET, QUIETER = 0.1, 0.5
"""Share of the time of a slow span that is stick for sure: at first, when there may be slow slip in it, and later."""

GROWS = 1.2
"""Creep in the third quarter of a stick phase over that in the first, from which on it grows up to release."""

BELOW_REST = 16.0
"""``REST`` over the largest creep that grows: of more it is not known where it ends and slip begins."""

FLANK = 16.0
"""Largest slip from which is extrapolated, over the least."""


class StatesOnly(Trajectory):
    """A trajectory whose stick phases are looked for when somebody asks for them.

    Parameters
    ----------
    told : Trajectory
        What the engine returned.
    ask : callable
        ``ask(times) -> states`` of the same motion, at times from ``told.times[0]`` on.
    coarseness : float
        The tolerance at which the engine was asked, over 1e-9.
    precision : float
        The engine's, see ``compare.engines.precision``.

    """

    def __init__(
        self,
        told: Trajectory,
        ask: Callable[[FloatArray], FloatArray],
        coarseness: float,
        precision: float = 0.0,
    ) -> None:
        for name in ("system", "times", "states", "solution"):
            object.__setattr__(self, name, getattr(told, name))
        object.__setattr__(self, "_samples", _Samples(told.system, ask, coarseness, precision))

    _samples: _Samples

    @cached_property
    def phases(self) -> tuple[Phase, ...]:
        """From ``times[0]`` to ``times[-1]``; where a single point of several rests is not found."""
        return self._samples.phases(float(self.times[0]), float(self.times[-1]))


@dataclass
class _Span:
    """The samples ``first`` to ``last``, by their times in s, between which the slip is below ``level`` in m/s.

    From the level outwards beginning and end are extrapolated by polynomials of a ``degree``.
    """

    first: float
    last: float
    level: float
    degree: int = 2


class _Samples:
    """What is known of a motion: states and slip speeds at times that become more.

    ``coarseness`` and ``precision`` are those of ``StatesOnly``.
    """

    def __init__(
        self, system: System, ask: Callable[[FloatArray], FloatArray], coarseness: float, precision: float
    ) -> None:
        self.system, self.ask, self.coarseness = system, ask, coarseness
        self.least = max(LEAST, ABOVE_NOISE * precision) * math.sqrt(coarseness)
        self.times = np.empty(0)
        self.states = np.empty((0, system.state_size))
        self.slip = np.empty(0)
        self.largest = 0.0  # speed in m/s

    def phases(self, begin: float, end: float) -> tuple[Phase, ...]:
        """Return the phases from ``begin`` to ``end`` in s."""
        self.look(np.linspace(begin, end, self._how_many(end - begin)))
        self.look(self._where_it_may_rest_between())
        self.largest = self._largest_speed()
        spans = self._spans(REST * self.largest)
        for _ in range(LOOKS):
            self.look(_joined(map(self._edges, spans)))
            spans = [closer for span in spans for closer in self._closer(span)]
        self.look(_joined(map(self._edges, spans)))
        self.look(_joined(map(self._flanks, spans)))
        found = [(self._begin(span), self._end(span), span) for span in spans]
        held = [(start, span) for start, stop, span in found if self._is_stick(start, stop, span)]
        released = [self._released(span) for _, span in held]
        self.look(_joined(map(self._flanks, released)))
        sticks = [(start, self._end(span)) for (start, _), span in zip(held, released, strict=True)]
        begun: list[tuple[Literal["slip", "pivot", "stick"], float]] = []
        if not sticks or sticks[0][0] > begin:
            begun.append(("slip", begin))
        for start, stop in sticks:
            begun += [("stick", start), ("slip", stop)] if stop < end else [("stick", start)]
        self.look(np.array([at for _, at in begun]))
        return phases_of([(kind, at, self._state(at)) for kind, at in begun], end)

    def _largest_speed(self) -> float:
        """Return the largest speed of the motion in m/s, of the slip or of what the disc below carries.

        Of what creeps on a plane at rest, which carries nothing, it is that which the springs would give.
        """
        fastest, omega = float(np.max(self.slip)), abs(self.system.disc_speed)
        x, y = self.states[:, :2].T
        if omega > 0.0:
            return max(fastest, omega * float(np.max(np.hypot(x, y))))
        by_springs = self.system.natural_frequency * float(np.max(np.hypot(x - self.system.offset, y)))
        return by_springs if fastest <= CREEP * self.coarseness * by_springs else fastest

    def _how_many(self, duration: float) -> int:
        natural = math.sqrt(self.system.stiffness / self.system.mass)
        turns = duration * max(natural, abs(self.system.disc_speed)) / (2.0 * math.pi)
        return min(max(PER_PERIOD, math.ceil(PER_PERIOD * turns)), MOST) + 1

    def look(self, times: FloatArray) -> None:
        """Ask for the states at more ``times``."""
        times = np.setdiff1d(times, self.times)
        if times.size == 0:
            return
        # the first time says where the motion starts
        asked = times if self.times.size == 0 else np.concatenate((self.times[:1], times))
        states = self.ask(asked)[len(asked) - len(times) :]
        order = np.argsort(np.concatenate((self.times, times)))
        self.times = np.concatenate((self.times, times))[order]
        self.states = np.concatenate((self.states, states))[order]
        self.slip = slip_of(Trajectory(self.system, self.times, self.states))

    def _where_it_may_rest_between(self) -> FloatArray:
        """Return times between samples where the slip, falling and growing as beside them, may come to nothing."""
        slip, steps = self.slip, np.abs(np.diff(self.slip))
        beside = np.concatenate(([np.inf], slip, [np.inf]))
        lowest = np.flatnonzero((slip <= beside[:-2]) & (slip < beside[2:]))
        nearest = [
            int(i) for i in lowest if slip[i] < 2.0 * np.max(steps[max(0, i - 2) : i + 2], initial=0.0)
        ]
        return _joined(
            np.linspace(self.times[max(i - 1, 0)], self.times[min(i + 1, len(slip) - 1)], 2 * CLOSER + 1)
            for i in nearest
        )

    def _spans(self, level: float, start: int = 0, stop: int | None = None) -> list[_Span]:
        """Return where at least two samples after each other, of some, have slips below ``level`` in m/s."""
        slow = self.slip[start:stop] <= level
        edges = start + np.flatnonzero(np.diff(np.concatenate(([0], slow, [0]))))
        return [
            _Span(float(self.times[first]), float(self.times[after - 1]), level)
            for first, after in edges.reshape(-1, 2)
            if after - first > 1
        ]

    def _places(self, span: _Span) -> tuple[int, int]:
        """Return the first and the last place of a span, to which samples may have come."""
        first, last = (int(i) for i in np.searchsorted(self.times, (span.first, span.last)))
        while first > 0 and self.slip[first - 1] <= span.level:
            first -= 1
        while last < len(self.slip) - 1 and self.slip[last + 1] <= span.level:
            last += 1
        return first, last

    def _edges(self, span: _Span) -> FloatArray:
        """Return times between the outermost samples of a span and those beside them."""
        first, last = self._places(span)
        outside = max(first - 1, 0), min(last + 1, len(self.times) - 1)
        return _joined(
            np.linspace(self.times[i], self.times[j], CLOSER + 1)
            for i, j in ((outside[0], first), (last, outside[1]))
        )

    def _closer(self, span: _Span) -> list[_Span]:
        """Return what of a span is below a lower level, as low as its creep allows."""
        first, last = self._places(span)
        share = QUIETER if span.level < REST * self.largest else QUIET
        creep = self._quantile(float(self.times[first]), float(self.times[last]), share)
        level = max(span.level / CLOSER, ABOVE_CREEP * creep, self.least * self.largest)
        return [span] if level >= span.level else self._spans(level, first, last + 1)

    def _quantile(self, begin: float, end: float, share: float) -> float:
        """Return the slip in m/s that is not exceeded for a ``share`` of the time from ``begin`` to ``end`` in s."""
        evenly = np.linspace(begin, end, 4 * CLOSER + 1)
        return float(np.quantile(np.interp(evenly, self.times, self.slip), share))

    def _is_stick(self, begin: float, end: float, span: _Span) -> bool:
        """Return whether a body that is slow from ``begin`` to ``end`` in s rests there, and does not pass by slowly.

        It all but rests, for most of the time in which it is slow, and friction can hold it.
        """
        if end - begin <= (span.last - span.first) / 2.0:
            return False
        slow, creep, fast = (self._quantile(begin, end, share) for share in (0.25, 0.5, 0.75))
        most = REST / (BELOW_REST if fast > GROWS * slow else ABOVE_CREEP)
        rests = creep <= min(CREEP * self.coarseness, most) * self.largest
        return rests and _load(self.system, self._state((begin + end) / 2.0)) <= self.system.friction_force

    def _flanks(self, span: _Span) -> FloatArray:
        """Return times before and after a span at which the slip is some times its level."""
        first, last = self._places(span)
        fast = np.flatnonzero(self.slip > FLANK * span.level)
        before, after = fast[fast < first], fast[fast > last]
        flanks = (before[-1] if before.size else 0, first), (last, after[0] if after.size else -1)
        return _joined(np.linspace(self.times[i], self.times[j], CLOSER + 1) for i, j in flanks)

    def _begin(self, span: _Span) -> float:
        """Return when the slip, which falls as the time that is left, is nothing."""
        first, _ = self._places(span)
        if first == 0:
            return float(self.times[0])
        time, nearest = self._extrapolated(np.arange(first)[::-1], 1.0, span)
        return min(max(time, nearest), span.last)

    def _end(self, span: _Span) -> float:
        """Return when the slip, which grows as the square of the time that is gone, was nothing."""
        _, last = self._places(span)
        if last == len(self.times) - 1:
            return float(self.times[-1])
        time, nearest = self._extrapolated(np.arange(last + 1, len(self.times)), 0.5, span)
        return max(min(time, nearest), span.first)

    def _released(self, span: _Span) -> _Span:
        """Return a span with the level and the degree from which its end, release, is extrapolated.

        The level is the geometric mean of the creep and of ``REST``. Where friction is smoothed over ε and creep
        grows before release, as ε·f/√(1 − f²), it comes to a multiple of ε at the same time for each ε. The level
        hangs on nothing but that creep: if it jumped with the samples, so would the release, and what it is off by
        would no more fall with the step as its error estimate takes for granted. Nor would it if what a parabola
        leaves out, which is late, made up for creep, which is early: a cubic leaves out less.
        """
        first, last = self._places(span)
        slip = self.slip[first : last + 1]
        creep = self._quantile(float(self.times[first]), float(self.times[last]), 0.5)
        if len(slip) < 2 or np.median(np.abs(np.diff(slip))) > NOISE * creep:
            return span
        level = max(self.least * self.largest, math.sqrt(creep * REST * self.largest))
        return replace(span, level=level, degree=3)

    def _extrapolated(self, outwards: NDArray[np.intp], power: float, span: _Span) -> tuple[float, float]:
        """Return when slip**power is nothing, by a polynomial through a flank, and the time of the nearest sample."""
        beyond = np.flatnonzero(self.slip[outwards] > FLANK * span.level)
        places = outwards[: max(int(beyond[0]), 1) if beyond.size else None]
        roots, nearest = (self.slip[places] / span.level) ** power, float(self.times[places[0]])
        degree = min(span.degree, len(np.unique(roots)) - 1)
        fitted = np.polynomial.Polynomial.fit(roots, self.times[places] - nearest, degree)
        return float(fitted(0.0)) + nearest, nearest

    def _state(self, time: float) -> FloatArray:
        """Return the state of the nearest sample."""
        return np.asarray(self.states[int(np.argmin(np.abs(self.times - time)))])


def _joined(times: Iterable[FloatArray]) -> FloatArray:
    return np.concatenate([np.empty(0), *times])


def slip_of(run: Trajectory) -> FloatArray:
    """Return how fast a body moves on the master disc in m/s, shape (n,): its centre, and its rim about that."""
    system = run.system
    if isinstance(system, DiscOnDisc):
        rim = system.contact_radius * (run.states[:, -1] - system.disc_speed)
        return np.asarray(np.hypot(run.slip_speed, rim))
    return run.slip_speed


def _load(system: System, state: FloatArray) -> float:
    """Return the force in N with which friction has to hold a body at the place of ``state`` on the master disc."""
    z, omega = complex(*state[:2]), system.disc_speed
    return abs(
        Support.of(system).force(z) - complex(0.0, system.damping * omega) * z + system.mass * omega**2 * z
    )
