"""Stick phases found from states, for engines that do not report them.

Before stick, slip falls in proportion to the time left; after release, it grows as the square of the time elapsed.
Both are sampled down to the engine's own creep or noise and extrapolated to zero slip.
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
from reference_model.systems.joint import FrictionJoint
from reference_model.trajectory import Phase, Trajectory, phases_of

PER_PERIOD = 64  # samples per period or revolution, whichever is shorter
MOST = 20_000  # largest number of samples before refinement

REST = 1e-2
"""Slip, as a share of the largest speed, below which a body may stick; refinement lowers it."""

CREEP = 3e-4
"""Largest creep in stick, as a share of the largest speed, at a tolerance of 1e-9.

It is proportional to the tolerance, up to ``REST``.
"""

CLOSER = 64  # factor between sample densities, and between levels of slip, of successive refinements
LOOKS = 3

LEAST = 1e-7
"""Least slip for extrapolation, as a share of the largest speed, at a tolerance of 1e-9.

This limit is proportional to the root of the tolerance, so error estimates include the extrapolation.
"""

ABOVE_NOISE = 32.0  # least slip for extrapolation, in units of the precision, if that exceeds ``LEAST``
NOISE = 0.1  # relative change of slip between samples that indicates rounding noise instead of creep
ABOVE_CREEP = 8.0  # least slip for extrapolation, in units of the creep in stick

QUIET, QUIETER = 0.1, 0.5
"""Share of a slow span that is certainly stick, for the first span, which may contain slow slip, and for later
spans."""

GROWS = 1.2
"""Ratio of the third to the first quartile of creep that grows up to release."""

BELOW_REST = 16.0
"""Ratio of ``REST`` to the largest growing creep; beyond it, the end of creep looks like the start of slip."""

FLANK = 16.0  # ratio of the largest to the least slip for extrapolation


class StatesOnly(Trajectory):
    """The trajectory ``told`` by an engine, with stick phases that are computed from states on first use.

    ``ask`` returns the states of the same motion at any later times. ``coarseness`` is the engine's tolerance
    divided by 1e-9, ``precision`` and ``step`` (s) belong to the engine.
    """

    def __init__(
        self,
        told: Trajectory,
        ask: Callable[[FloatArray], FloatArray],
        coarseness: float,
        precision: float = 0.0,
        step: float = 0.0,
    ) -> None:
        for name in ("system", "times", "states", "solution"):
            object.__setattr__(self, name, getattr(told, name))
        object.__setattr__(self, "_samples", _Samples(told.system, ask, coarseness, precision, step))

    _samples: _Samples

    @cached_property
    def phases(self) -> tuple[Phase, ...]:
        """Slip and stick phases from ``times[0]`` to ``times[-1]``, without pivots."""
        return self._samples.phases(float(self.times[0]), float(self.times[-1]))


@dataclass
class _Span:
    """A time span from sample ``first`` to ``last``, in s, with slip below ``level`` in m/s.

    Polynomials of this ``degree`` fitted to slip above the level, yield the times of zero slip.
    """

    first: float
    last: float
    level: float
    degree: int = 2


class _Samples:
    def __init__(
        self,
        system: System,
        ask: Callable[[FloatArray], FloatArray],
        coarseness: float,
        precision: float,
        step: float,
    ) -> None:
        self.system, self.ask, self.coarseness = system, ask, coarseness
        self._least = max(LEAST, ABOVE_NOISE * precision) * math.sqrt(coarseness)
        self._in_a_step = step * _slowing(system)
        self.times = np.empty(0)
        self.states = np.empty((0, system.state_size))
        self.slip = np.empty(0)
        self.largest = 0.0  # speed in m/s

    def phases(self, begin: float, end: float) -> tuple[Phase, ...]:
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
        """Return the largest speed in m/s of the slip, or of the master disc below the body.

        If a body creeps on a plane at rest, return the speed that its springs could cause.
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

    @property
    def least(self) -> float:
        """Least slip in m/s for extrapolation. Less than friction stops within a step may be stick."""
        return max(self._least * self.largest, self._in_a_step)

    def look(self, times: FloatArray) -> None:
        times = np.setdiff1d(times, self.times)
        if times.size == 0:
            return
        # the motion starts at the first requested time
        asked = times if self.times.size == 0 else np.concatenate((self.times[:1], times))
        states = self.ask(asked)[len(asked) - len(times) :]
        order = np.argsort(np.concatenate((self.times, times)))
        self.times = np.concatenate((self.times, times))[order]
        self.states = np.concatenate((self.states, states))[order]
        self.slip = slip_of(Trajectory(self.system, self.times, self.states))

    def _where_it_may_rest_between(self) -> FloatArray:
        """Return times around minima of slip that may reach zero between samples."""
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
        slow = self.slip[start:stop] <= level
        edges = start + np.flatnonzero(np.diff(np.concatenate(([0], slow, [0]))))
        return [
            _Span(float(self.times[first]), float(self.times[after - 1]), level)
            for first, after in edges.reshape(-1, 2)
            if after - first > 1
        ]

    def _places(self, span: _Span) -> tuple[int, int]:
        """Return the indices of the first and last sample of a span, which may have grown."""
        first, last = (int(i) for i in np.searchsorted(self.times, (span.first, span.last)))
        while first > 0 and self.slip[first - 1] <= span.level:
            first -= 1
        while last < len(self.slip) - 1 and self.slip[last + 1] <= span.level:
            last += 1
        return first, last

    def _edges(self, span: _Span) -> FloatArray:
        first, last = self._places(span)
        outside = max(first - 1, 0), min(last + 1, len(self.times) - 1)
        return _joined(
            np.linspace(self.times[i], self.times[j], CLOSER + 1)
            for i, j in ((outside[0], first), (last, outside[1]))
        )

    def _closer(self, span: _Span) -> list[_Span]:
        """Return the spans within ``span`` below a level as low as its creep allows."""
        first, last = self._places(span)
        share = QUIETER if span.level < REST * self.largest else QUIET
        creep = self._quantile(float(self.times[first]), float(self.times[last]), share)
        level = max(span.level / CLOSER, ABOVE_CREEP * creep, self.least)
        return [span] if level >= span.level else self._spans(level, first, last + 1)

    def _quantile(self, begin: float, end: float, share: float) -> float:
        evenly = np.linspace(begin, end, 4 * CLOSER + 1)
        return float(np.quantile(np.interp(evenly, self.times, self.slip), share))

    def _is_stick(self, begin: float, end: float, span: _Span) -> bool:
        """Return whether a slow body sticks: it mostly creeps, and friction can hold it."""
        if end - begin <= (span.last - span.first) / 2.0:
            return False
        slow, creep, fast = (self._quantile(begin, end, share) for share in (0.25, 0.5, 0.75))
        most = REST / (BELOW_REST if fast > GROWS * slow else ABOVE_CREEP)
        rests = creep <= min(CREEP * self.coarseness, most) * self.largest
        return rests and _load(self.system, self._state((begin + end) / 2.0)) <= self.system.friction_force

    def _flanks(self, span: _Span) -> FloatArray:
        """Return times before and after a span with slip up to ``FLANK`` times its level."""
        first, last = self._places(span)
        fast = np.flatnonzero(self.slip > FLANK * span.level)
        before, after = fast[fast < first], fast[fast > last]
        flanks = (before[-1] if before.size else 0, first), (last, after[0] if after.size else -1)
        return _joined(np.linspace(self.times[i], self.times[j], CLOSER + 1) for i, j in flanks)

    def _begin(self, span: _Span) -> float:
        first, _ = self._places(span)
        if first == 0:
            return float(self.times[0])
        time, nearest = self._extrapolated(np.arange(first)[::-1], 1.0, span)
        return min(max(time, nearest), span.last)

    def _end(self, span: _Span) -> float:
        _, last = self._places(span)
        if last == len(self.times) - 1:
            return float(self.times[-1])
        time, nearest = self._extrapolated(np.arange(last + 1, len(self.times)), 0.5, span)
        return max(min(time, nearest), span.first)

    def _released(self, span: _Span) -> _Span:
        """Return a span with the level and degree for extrapolating its end, the release.

        The level is the geometric mean of the creep and of ``REST``. If friction is regularised below ε, creep grows
        before release as ε·f/√(1 − f²) and reaches a given multiple of ε at the same time for every ε. A level that
        jumps with the samples would spoil the error estimate. A cubic has a smaller error.
        """
        first, last = self._places(span)
        slip = self.slip[first : last + 1]
        creep = self._quantile(float(self.times[first]), float(self.times[last]), 0.5)
        if len(slip) < 2 or np.median(np.abs(np.diff(slip))) > NOISE * creep:
            return span
        level = max(self.least, math.sqrt(creep * REST * self.largest))
        return replace(span, level=level, degree=3)

    def _extrapolated(self, outwards: NDArray[np.intp], power: float, span: _Span) -> tuple[float, float]:
        """Return the times of zero slip, by a polynomial in slip**power on a flank, and of the nearest sample."""
        beyond = np.flatnonzero(self.slip[outwards] > FLANK * span.level)
        places = outwards[: max(int(beyond[0]), 1) if beyond.size else None]
        roots, nearest = (self.slip[places] / span.level) ** power, float(self.times[places[0]])
        degree = min(span.degree, len(np.unique(roots)) - 1)
        fitted = np.polynomial.Polynomial.fit(roots, self.times[places] - nearest, degree)
        return float(fitted(0.0)) + nearest, nearest

    def _state(self, time: float) -> FloatArray:
        return np.asarray(self.states[int(np.argmin(np.abs(self.times - time)))])


def _joined(times: Iterable[FloatArray]) -> FloatArray:
    return np.concatenate([np.empty(0), *times])


def slip_of(run: Trajectory) -> FloatArray:
    """Return the slip speed on the master disc in m/s, of centre and rim combined; for a joint its spin in rad/s."""
    system = run.system
    if isinstance(system, FrictionJoint):
        return np.abs(run.states[:, 1])
    if isinstance(system, DiscOnDisc):
        rim = system.contact_radius * (run.states[:, -1] - system.disc_speed)
        return np.asarray(np.hypot(run.slip_speed, rim))
    return run.slip_speed


def _slowing(system: System) -> float:
    """Return the largest deceleration of slip by friction in m/s²."""
    rim = system.contact_radius**2 / system.polar_inertia if isinstance(system, DiscOnDisc) else 0.0
    return system.friction_force * (1.0 / system.mass + rim)


def _load(system: System, state: FloatArray) -> float:
    """Return the friction force in N that holds a body on the master disc."""
    z, omega = complex(*state[:2]), system.disc_speed
    return abs(
        Support.of(system).force(z) - complex(0.0, system.damping * omega) * z + system.mass * omega**2 * z
    )
