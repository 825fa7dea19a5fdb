"""Exact motion of rotors with clutches, one-way clutches, gears and differentials, by events.

It tries all modes: a row of weights on the speeds rests, or slips forward or backward, and the moment of a mesh has
either sign. In each case accelerations and moments solve one linear system, so speeds are closed-form integrals. No
resting rows may depend on each other.
"""

from dataclasses import dataclass
from itertools import combinations, product

import numpy as np
from exact_trains import AT_REST, NEXT, ROUNDING, Change, Signal, _first_event


@dataclass(frozen=True, eq=False)
class Friction:
    """Friction of constant size in N m against the slip weights·ω."""

    weights: tuple[float, ...]
    capacity: float
    static_ratio: float = 1.0

    def limit(self, load, direction, at_rest):
        return (self.static_ratio if at_rest else 1.0) * self.capacity


@dataclass(frozen=True, eq=False)
class OneWay:
    """Free for a slip >= 0, which no moment >= 0 lets become negative."""

    weights: tuple[float, ...]

    def limit(self, load, direction, at_rest):
        return 0.0 if direction > 0 else np.inf


@dataclass(frozen=True, eq=False)
class Mesh:
    """Ideal constraint with a moment T, and friction up to preload + share·|T|; driving if T·slip < 0."""

    weights: tuple[float, ...]
    constraint: tuple[float, ...]
    preload: float
    driving: float
    driven: float

    def share(self, sign, direction):
        return self.driving if sign * direction < 0 else self.driven

    def limit(self, load, direction, at_rest):
        shares = np.where(load * direction < 0.0, self.driving, self.driven)
        return self.preload + shares * np.abs(load)


@dataclass(frozen=True, eq=False)
class Loaded:
    """Friction that grows by ``arm`` times the moment of the row ``part``: of its mesh, or else its friction."""

    weights: tuple[float, ...]
    capacity: float
    arm: float
    part: int
    static_ratio: float = 1.0

    def limit(self, load, direction, at_rest):
        return (self.static_ratio if at_rest else 1.0) * (self.capacity + self.arm * np.abs(load))


@dataclass(frozen=True)
class Couplings:
    """Rotors with inertias (kg m²), initial speeds (rad/s), moments (N m) and rows."""

    inertias: tuple[float, ...]
    speeds: tuple[float, ...]
    moments: tuple[Signal, ...]
    rows: tuple

    def breaks(self):
        return sorted({time for signal in self.moments for time, _ in signal.steps})


def exact_motion_of(train, end):
    """Return all changes of mode until ``end`` (s), and the final speeds (rad/s)."""
    time, speeds = 0.0, np.array(train.speeds, float)
    slips = np.array([row.weights for row in train.rows]) @ speeds
    phase, changes = _decide(train, time, speeds, np.sign(slips).astype(int)), []
    for stop in [*train.breaks(), end]:
        while True:
            time = _first_event(phase, stop)
            speeds, before = phase.speeds(np.array([time]))[:, 0], phase.modes
            phase = _decide(train, time, speeds, before)
            pairs = enumerate(zip(before.tolist(), phase.modes.tolist(), strict=True))
            changes += [Change(time, k, *modes) for k, modes in pairs if modes[0] != modes[1]]
            if time >= stop:
                break
    return changes, speeds


def _decide(train, time, speeds, before):
    """Choose modes of rows without slip: static limits first, sliding limits for those that slip, and so on."""
    slips = np.array([row.weights for row in train.rows]) @ speeds
    rests = np.flatnonzero((before == 0) | (np.abs(slips) < AT_REST))
    modes = np.where(np.isin(np.arange(len(slips)), rests), 0, np.sign(slips)).astype(int)
    slipped = set()
    while True:
        found = _consistent(train, time, speeds, modes, rests, slipped)
        new = set(rests[found.modes[rests] != 0].tolist()) - slipped
        if not new:
            return _consistent(train, time, speeds, modes, sorted(slipped), None)
        slipped |= new


def _consistent(train, time, speeds, modes, may_slip, slipped):
    """Return the phase with the fewest slipping rows; rows not in ``slipped``, if given, slip statically."""
    loads = sum(isinstance(row, (Mesh, Loaded)) for row in train.rows)
    static = [slipped is not None and k in may_slip and k not in slipped for k in range(len(modes))]
    sliding = [slipped is not None and k in slipped for k in range(len(modes))]
    for count in range(len(may_slip) + 1):
        for moving in map(list, combinations(may_slip, count)):
            ways = [(1,) if isinstance(train.rows[k], OneWay) else (1, -1) for k in moving]
            for directions in product(*ways):
                tried = modes.copy()
                tried[moving] = directions
                for signs in product((1, -1), repeat=loads):
                    phase = _Phase(train, time, speeds, tried, signs, static, sliding)
                    if phase.is_consistent(moving, directions):
                        return phase
    raise ValueError(f"no modes at t = {time} s")


class _Phase:
    """Motion in constant ``modes``, with moments of meshes and of parts that load others of constant ``signs``."""

    def __init__(self, train, start, speeds, modes, signs, static, sliding):
        self.train, self.start, self.initial, self.modes, self.sliding = train, start, speeds, modes, sliding
        rotors, rows = len(speeds), train.rows
        self.meshes = [k for k, row in enumerate(rows) if isinstance(row, Mesh)]
        self.signs = np.array(signs)
        size = rotors + len(self.meshes)
        #: Places of the moments that let friction grow.
        self.loads = {k: rotors + i for i, k in enumerate(self.meshes)}
        self.loads |= {
            k: self.loads.get(row.part, size + row.part)
            for k, row in enumerate(rows)
            if isinstance(row, Loaded)
        }
        sign_of = dict(zip(self.loads, signs, strict=True))
        system, self.right = np.zeros((size + len(rows),) * 2), np.zeros(size + len(rows))
        system[:rotors, :rotors] = np.diag(train.inertias)
        for i, k in enumerate(self.meshes):
            system[rotors + i, :rotors] = rows[k].constraint
            system[:rotors, rotors + i] = -np.array(rows[k].constraint)
        for k, (row, mode) in enumerate(zip(rows, modes, strict=True)):
            system[:rotors, size + k] = -np.array(row.weights)
            if mode == 0:
                system[size + k, :rotors] = row.weights
                continue
            system[size + k, size + k] = 1.0
            if isinstance(row, Mesh):
                system[size + k, self.loads[k]] = mode * row.share(sign_of[k], mode) * sign_of[k]
                self.right[size + k] = -mode * row.preload
            else:
                self.right[size + k] = -mode * row.limit(0.0, mode, static[k])
                if isinstance(row, Loaded):
                    by_load = row.limit(1.0, mode, static[k]) - row.limit(0.0, mode, static[k])
                    system[size + k, self.loads[k]] += mode * by_load * sign_of[k]
        self.solve = np.linalg.inv(system)

    def _all(self, t, read):
        moments = np.array([read(moment, t) + 0.0 * t for moment in self.train.moments])
        return self.solve[:, : len(moments)] @ moments

    def now(self, t):
        """Return accelerations, moments of meshes and friction at the times ``t``, shape (n, times)."""
        return self._all(t, lambda signal, t: signal(t)) + (self.solve @ self.right)[:, None]

    def speeds(self, t):
        gained = self._all(t, Signal.integral) - self._all(np.full_like(t, self.start), Signal.integral)
        gained += np.outer(self.solve @ self.right, t - self.start)
        return self.initial[:, None] + gained[: len(self.initial)]

    def slips(self, t):
        slips = np.array([row.weights for row in self.train.rows]) @ self.speeds(t)
        sliding = self.modes != 0
        loads = self.now(t)[list(self.loads.values())]
        return [*(self.modes[sliding, None] * slips[sliding]), *(self.signs[:, None] * loads)]

    def margin(self, t):
        """Return the least unused moment of rows at rest in N m, at the times ``t``."""
        now, rotors = self.now(t), len(self.initial)
        least = np.full(len(t), np.inf)
        for k, row in enumerate(self.train.rows):
            if self.modes[k] == 0:
                force = now[rotors + len(self.meshes) + k]
                load = now[self.loads[k]] if k in self.loads else 0.0 * t
                for way in (1, -1):
                    least = np.minimum(least, row.limit(load, way, not self.sliding[k]) + way * force)
        return least

    def is_consistent(self, moving, directions):
        t = np.array([self.start + NEXT])
        now = self.now(t)[:, 0]
        rates = np.array([row.weights for row in self.train.rows])[moving] @ now[: len(self.initial)]
        loads = now[list(self.loads.values())] * self.signs
        return (
            (rates * directions > ROUNDING).all()
            and (loads >= -ROUNDING).all()
            and self.margin(t)[0] > -ROUNDING
        )
