"""Exact motion of rotors that clutches with Coulomb friction couple, in a row or in any other way.

Torques and capacities are piecewise harmonic, so the motion between events has a closed form. After the end of a
slip, or a torque beyond a clutch's capacity, a search over all combinations of modes finds the consistent
combination.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from reference_model.systems import FloatArray

FORWARD, STUCK, BACKWARD, OPEN = 1, 0, -1, 2
"""Modes of a clutch, numbered as in Modelica; forward if the rotor behind the clutch is faster."""

PER_PERIOD = 400
"""Samples per period of the fastest harmonic in the search for events; it misses two events in one interval."""

LEAST_SAMPLES = 200


@dataclass(frozen=True)
class Harmonic:
    """The torque amplitude·sin(rate·t + phase) in N m with a rate >= 0 in rad/s, constant if the rate is 0."""

    amplitude: float = 0.0
    rate: float = 0.0
    phase: float = math.pi / 2.0

    def __call__(self, t: FloatArray) -> FloatArray:
        """Return the torque (N m)."""
        return np.asarray(self.amplitude * np.sin(self.rate * t + self.phase))

    def integrals(self, begin: float, t: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the first and second integrals over time from ``begin`` to ``t``, in N m s and N m s²."""
        tau, value, a, w = t - begin, self.phase + self.rate * begin, self.amplitude, self.rate
        if w == 0.0:
            return a * math.sin(value) * tau, 0.5 * a * math.sin(value) * tau**2
        # the difference of two cosines as a product avoids cancellation at short times
        once = 2.0 * a / w * np.sin(value + 0.5 * w * tau) * np.sin(0.5 * w * tau)
        twice = a / w * (math.cos(value) * tau - (np.sin(w * t + self.phase) - math.sin(value)) / w)
        return np.asarray(once), np.asarray(twice)


Pieces = Sequence[tuple[float, Harmonic]]
"""Harmonics with their start times (s); the first is the start of the motion."""


@dataclass(frozen=True)
class Chain:
    """Rotors with external torques, and the clutches between them.

    A slipping clutch transmits its capacity, and a stuck clutch up to ``static_ratio`` times as much; 0 opens it. The
    ``inertias`` (kg m²) are numbers, or the mass matrix of coordinates that gears couple. A row of ``slips`` maps the
    speeds to the slip of one clutch; by default the clutches connect neighbours. The rows must be independent.
    """

    inertias: Sequence[float] | FloatArray
    torques: Sequence[Pieces]
    capacities: Sequence[Pieces]
    static_ratio: float = 1.0
    slips: FloatArray | None = None

    @cached_property
    def breaks(self) -> list[float]:
        """Start times (s) of all pieces."""
        return sorted({begin for pieces in (*self.torques, *self.capacities) for begin, _ in pieces})

    @cached_property
    def slip_rows(self) -> FloatArray:
        """Return the matrix that maps speeds to slips."""
        return np.diff(np.eye(len(self.inertias)), axis=0) if self.slips is None else self.slips

    @cached_property
    def _mobility(self) -> FloatArray:
        masses = np.asarray(self.inertias)
        return np.diag(1.0 / masses) if masses.ndim == 1 else np.linalg.inv(masses)

    def in_force(self, t: float) -> list[Harmonic]:
        """Return the harmonics of torques and capacities in effect from ``t`` (s)."""
        return [[f for begin, f in pieces if begin <= t][-1] for pieces in (*self.torques, *self.capacities)]

    def transmitted(self, modes: Sequence[int]) -> FloatArray:
        """Return the matrix that maps ``in_force`` to the torque of each clutch on the rotor behind it."""
        n, m, d = len(self.inertias), len(self.capacities), self.slip_rows
        by_inertia = d @ self._mobility
        equations, given = np.eye(m), np.zeros((m, n + m))
        for i, mode in enumerate(modes):
            if mode == STUCK:
                equations[i], given[i, :n] = by_inertia[i] @ d.T, -by_inertia[i]
            elif mode != OPEN:
                given[i, n + i] = -mode
        return np.asarray(np.linalg.solve(equations, given))

    def accelerations(self, modes: Sequence[int]) -> FloatArray:
        """Return the matrix, shape (n, n + m), that maps ``in_force`` to the angular accelerations."""
        n = len(self.inertias)
        torques = np.eye(n, n + len(self.capacities))
        return np.asarray(self._mobility @ (torques + self.slip_rows.T @ self.transmitted(modes)))

    def motion(self, speeds: Sequence[float], until: float) -> Motion:
        """Return the motion from ``breaks[0]`` to ``until`` (s), from angles of 0 and ``speeds`` (rad/s)."""
        begin, state = self.breaks[0], (np.zeros(len(speeds)), np.asarray(speeds, dtype=float))
        signs, phases = np.sign(self.slip_rows @ state[1]), []
        while begin < until:
            phase = Phase(self, begin, self._modes(begin, signs), *state)
            end, happened = phase.first_event(min([until, *(time for time in self.breaks if time > begin)]))
            phases.append(phase)
            at_end = np.array([end])
            state = tuple(values[0] for values in phase.states(at_end))
            signs = np.sign(self.slip_rows @ state[1])
            for i, mode in enumerate(phase.modes):
                if mode == STUCK:  # a released clutch slips against the torque that held it
                    signs[i] = -np.sign(phase.transmitted(at_end)[0, i]) if happened[i] else 0.0
                elif happened[i]:
                    signs[i] = 0.0
            begin = end
        return Motion(self, tuple(phases), until)

    def _modes(self, t: float, signs: FloatArray) -> tuple[int, ...]:
        """Return the modes after ``t`` from the signs of the slips; clutches without slip take a consistent mode."""
        harmonics, n = self.in_force(t), len(self.inertias)
        values = np.array([float(f(np.asarray(t))) for f in harmonics])
        choices = [
            (OPEN,) if capacity.amplitude == 0.0 else (int(sign),) if sign else (STUCK, FORWARD, BACKWARD)
            for capacity, sign in zip(harmonics[n:], signs, strict=True)
        ]
        for modes in itertools.product(*choices):
            held = np.abs(self.transmitted(modes) @ values)
            begins = self.slip_rows @ self.accelerations(modes) @ values
            if all(
                held[i] <= self.static_ratio * values[n + i] if mode == STUCK else mode * begins[i] > 0.0
                for i, mode in enumerate(modes)
                if signs[i] == 0.0 and mode != OPEN
            ):
                return modes
        raise ValueError(f"no consistent combination of clutch modes after t = {t:g} s")


@dataclass(frozen=True)
class Phase:
    """Motion of a chain from ``begin`` (s) without a change of modes, from angles (rad) and speeds (rad/s)."""

    chain: Chain
    begin: float
    modes: tuple[int, ...]
    angles: FloatArray
    speeds: FloatArray

    @cached_property
    def _harmonics(self) -> list[Harmonic]:
        return self.chain.in_force(self.begin)

    def states(self, t: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return angles and speeds, each of shape (len(t), n)."""
        once, twice = np.swapaxes([f.integrals(self.begin, t) for f in self._harmonics], 0, 1)
        matrix = self.chain.accelerations(self.modes)
        gone = (t - self.begin)[:, np.newaxis]
        return self.angles + gone * self.speeds + (matrix @ twice).T, self.speeds + (matrix @ once).T

    def transmitted(self, t: FloatArray) -> FloatArray:
        """Return the clutch torques (N m) on the rotors behind them, shape (len(t), m)."""
        values = np.array([f(t) for f in self._harmonics])
        return np.asarray((self.chain.transmitted(self.modes) @ values).T)

    def first_event(self, end: float) -> tuple[float, NDArray[np.bool_]]:
        """Return the time (s) of the first event, at most ``end``, and a mask of the clutches that change mode."""
        fastest = max(f.rate for f in self._harmonics)
        number = max(LEAST_SAMPLES, math.ceil(PER_PERIOD * fastest * (end - self.begin) / (2.0 * math.pi)))
        times = np.linspace(self.begin, end, number + 1)
        first, which = end, np.zeros(len(self.modes), dtype=bool)
        for i, mode in enumerate(self.modes):
            if mode == OPEN:
                continue
            margin = self._hold(i) if mode == STUCK else self._slip(i, mode)
            values = margin(times)
            ends = np.flatnonzero((values[:-1] > 0.0) & (values[1:] <= 0.0))
            if ends.size == 0:
                continue
            span = times[ends[0] : ends[0] + 2]
            time = float(brentq(lambda t, margin=margin: margin(np.array([t]))[0], *span, xtol=1e-16))
            if time < first:
                first, which = time, np.zeros(len(self.modes), dtype=bool)
            which[i] |= time == first
        return first, which

    def _slip(self, i: int, mode: int) -> Callable[[FloatArray], FloatArray]:
        return lambda t: mode * self.states(t)[1] @ self.chain.slip_rows[i]

    def _hold(self, i: int) -> Callable[[FloatArray], FloatArray]:
        capacity = self._harmonics[len(self.chain.inertias) + i]
        return lambda t: self.chain.static_ratio * capacity(t) - np.abs(self.transmitted(t)[:, i])


@dataclass(frozen=True)
class Motion:
    """Exact motion of a chain up to ``until`` (s)."""

    chain: Chain
    phases: tuple[Phase, ...]
    until: float

    def _each(self, t: FloatArray) -> list[tuple[NDArray[np.bool_], Phase]]:
        begins = np.array([phase.begin for phase in self.phases])
        number = np.searchsorted(begins, t, side="right") - 1
        return [(number == k, phase) for k, phase in enumerate(self.phases)]

    def states(self, t: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return angles (rad) and speeds (rad/s), each of shape (len(t), n)."""
        angles, speeds = np.empty((2, len(t), len(self.chain.inertias)))
        for at, phase in self._each(t):
            angles[at], speeds[at] = phase.states(t[at])
        return angles, speeds

    def modes(self, t: FloatArray) -> NDArray[np.int_]:
        """Return the modes, shape (len(t), m)."""
        found = np.empty((len(t), len(self.chain.capacities)), dtype=int)
        for at, phase in self._each(t):
            found[at] = phase.modes
        return found

    def switches(self, clutch: int) -> list[tuple[float, int]]:
        """Return the times (s) of a clutch's mode changes, each with the new mode."""
        modes = [(phase.begin, phase.modes[clutch]) for phase in self.phases]
        return [later for earlier, later in itertools.pairwise(modes) if later[1] != earlier[1]]
