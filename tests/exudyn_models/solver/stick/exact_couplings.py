"""Exact motion of rotors with clutches, one-way clutches, gears, differentials, springs and torques, by events.

It tries all modes: a row of weights on the speeds rests, or slips forward or backward, and the moment of a mesh has
either sign. In each case accelerations and moments solve one linear system, which DOP853 integrates to the next
event. No resting rows may depend on each other.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import combinations, product

import numpy as np
from exact_trains import AT_REST, NEXT, ROUNDING, Change, Signal
from scipy.integrate import DOP853
from scipy.optimize import brentq

LONGEST, SAMPLES = 5e-3, 12
"""Longest step in s, and number of samples in each step between which events are bracketed."""


@dataclass(frozen=True, eq=False)
class Friction:
    """Friction of a size in N m against the slip weights·ω; if ``one_way``, any moment holds a negative slip."""

    weights: tuple[float, ...]
    capacity: float | Callable[[float], float]
    static_ratio: float = 1.0
    one_way: bool = False

    def limit(self, t, load, direction, at_rest):
        if self.one_way and direction < 0:
            return np.inf
        capacity = self.capacity(t) if callable(self.capacity) else self.capacity
        return (self.static_ratio if at_rest else 1.0) * capacity

    def slope(self, sign, direction, at_rest):
        """Return the derivative of the limit by |load|."""
        return 0.0


def one_way_clutch(weights):
    return Friction(weights, 0.0, one_way=True)


@dataclass(frozen=True, eq=False)
class Mesh:
    """Ideal constraint with a moment T, and friction up to preload + share·|T|; driving if T·slip < 0."""

    weights: tuple[float, ...]
    constraint: tuple[float, ...]
    preload: float
    driving: float
    driven: float
    one_way: bool = False

    def slope(self, sign, direction, at_rest):
        return self.driving if sign * direction < 0 else self.driven

    def limit(self, t, load, direction, at_rest):
        return self.preload + self.slope(load, direction, at_rest) * abs(load)


@dataclass(frozen=True, eq=False)
class Loaded:
    """Friction that grows by ``arm`` times the moment of the row ``part``: of its mesh, or else its friction."""

    weights: tuple[float, ...]
    capacity: float
    arm: float
    part: int
    static_ratio: float = 1.0
    one_way: bool = False

    def slope(self, sign, direction, at_rest):
        return (self.static_ratio if at_rest else 1.0) * self.arm

    def limit(self, t, load, direction, at_rest):
        return (self.static_ratio if at_rest else 1.0) * (self.capacity + self.arm * abs(load))


@dataclass(frozen=True, eq=False)
class Spring:
    """Flanks beyond half of the clearance, which push in the twist weights·φ but never pull."""

    weights: tuple[float, ...]
    stiffness: float
    damping: float
    clearance: float

    def flank(self, side, q, v):
        """Return the elastic moment, and the moment if this flank is pressed."""
        elastic = self.stiffness * (side * np.dot(self.weights, q) - self.clearance / 2.0)
        return elastic, elastic + side * self.damping * np.dot(self.weights, v)

    def pressed(self, q, v):
        return next((side for side in (1, -1) if min(self.flank(side, q, v)) > 0.0), 2)

    def margin(self, flank, q, v):
        if flank != 2:
            return self.flank(flank, q, v)[1]
        return -max(min(self.flank(side, q, v)) for side in (1, -1))

    def torques(self, flank, q, v):
        return -flank * self.flank(flank, q, v)[1] * np.array(self.weights) if flank != 2 else 0.0


@dataclass(frozen=True)
class Couplings:
    """Rotors with inertias (kg m²), initial speeds (rad/s), moments (N m), rows and springs.

    ``ideals`` are weights of speeds that stay zero. ``torques`` are functions of time, angles and speeds.
    ``controllers`` are functions of the speeds by their periods, and ``edges`` are times when functions have kinks.
    """

    inertias: tuple[float, ...]
    speeds: tuple[float, ...]
    moments: tuple[Signal, ...]
    rows: tuple
    springs: tuple[Spring, ...] = ()
    ideals: tuple = ()
    torques: tuple = ()
    controllers: tuple = ()
    edges: tuple[float, ...] = ()

    def breaks(self, end):
        steps = {time for signal in self.moments for time, _ in signal.steps}
        return sorted(time for time in steps | set(self.edges) if 0.0 < time < end)

    def samples(self, end):
        """Return the functions to call at each sample."""
        found = {}
        for period, function in self.controllers:
            for k in range(math.ceil(end / period - 1e-9)):
                found.setdefault(round(k * period, 12), []).append(function)
        return found


def exact_motion_of(train, end):
    """Return all changes of mode until ``end`` (s), rows before springs, and the final speeds (rad/s)."""
    samples, time, y = train.samples(end), 0.0, np.hstack([np.zeros(len(train.speeds)), train.speeds])
    for function in samples.pop(0.0, ()):
        function(y[len(y) // 2 :])
    slips = _slips(train, y)
    phase, changes = _decide(train, time, y, y, np.sign(slips).astype(int)), []
    for stop in sorted({*train.breaks(end), *samples, end}):
        while True:
            time, y = _next_event(phase, time, y, stop)
            for function in samples.get(time, ()):
                function(y[len(y) // 2 :])
            before = phase.modes
            phase = _decide(train, time, y, y + NEXT * phase.rates(time, y), before[: len(train.rows)])
            pairs = enumerate(zip(before.tolist(), phase.modes.tolist(), strict=True))
            changes += [Change(time, k, *modes) for k, modes in pairs if modes[0] != modes[1]]
            if time >= stop:
                break
    return changes, y[len(y) // 2 :]


def _slips(train, y):
    return np.array([row.weights for row in train.rows]) @ y[len(y) // 2 :]


def _decide(train, time, y, soon, before):
    """Choose modes of rows without slip: static limits first, sliding limits for those that slip, and so on.

    ``soon`` is the state after the time ``NEXT``, which decides.
    """
    slips = _slips(train, y)
    rests = np.flatnonzero((before == 0) | (np.abs(slips) < AT_REST))
    modes = np.where(np.isin(np.arange(len(slips)), rests), 0, np.sign(slips)).astype(int)
    flanks = np.array([spring.pressed(*np.split(soon, 2)) for spring in train.springs], dtype=int)
    slipped = set()
    while True:
        found = _consistent(train, time, soon, modes, flanks, rests, slipped)
        new = set(rests[found.modes[rests] != 0].tolist()) - slipped
        if not new:
            return _consistent(train, time, soon, modes, flanks, sorted(slipped), None)
        slipped |= new


def _consistent(train, time, soon, modes, flanks, may_slip, slipped):
    """Return the phase with the fewest slipping rows; rows not in ``slipped``, if given, slip statically."""
    loads = sum(isinstance(row, (Mesh, Loaded)) for row in train.rows)
    static = [slipped is not None and k in may_slip and k not in slipped for k in range(len(modes))]
    sliding = [slipped is not None and k in slipped for k in range(len(modes))]
    for count in range(len(may_slip) + 1):
        for moving in map(list, combinations(may_slip, count)):
            ways = [(1,) if train.rows[k].one_way else (1, -1) for k in moving]
            for directions in product(*ways):
                tried = modes.copy()
                tried[moving] = directions
                for signs in product((1, -1), repeat=loads):
                    phase = _Phase(train, tried, flanks, signs, static, sliding)
                    if phase.is_consistent(time + NEXT, soon, moving, directions):
                        return phase
    raise ValueError(f"no modes at t = {time} s")


class _Phase:
    """Motion in constant modes, with moments of meshes and of parts that load others of constant ``signs``."""

    def __init__(self, train, modes, flanks, signs, static, sliding):
        self.train, self.own, self.flanks, self.static, self.sliding = train, modes, flanks, static, sliding
        self.rotors, rows = len(train.inertias), train.rows
        meshes = [k for k, row in enumerate(rows) if isinstance(row, Mesh)]
        constraints = [*(rows[k].constraint for k in meshes), *train.ideals]
        self.signs, self.first = np.array(signs), self.rotors + len(constraints)
        #: Places of the moments that let friction grow.
        self.loads = {k: self.rotors + i for i, k in enumerate(meshes)}
        self.loads |= {
            k: self.loads.get(row.part, self.first + row.part)
            for k, row in enumerate(rows)
            if isinstance(row, Loaded)
        }
        self.load_places = list(self.loads.values())
        sign_of = dict(zip(self.loads, signs, strict=True))
        system = np.zeros((self.first + len(rows),) * 2)
        system[: self.rotors, : self.rotors] = np.diag(train.inertias)
        for i, constraint in enumerate(constraints, self.rotors):
            system[i, : self.rotors] = constraint
            system[: self.rotors, i] = -np.array(constraint)
        for k, (row, mode) in enumerate(zip(rows, modes, strict=True), self.first):
            system[: self.rotors, k] = -np.array(row.weights)
            if mode == 0:
                system[k, : self.rotors] = row.weights
                continue
            system[k, k] = 1.0
            i = k - self.first
            if i in self.loads:
                slope = row.slope(sign_of[i], mode, static[i])
                system[k, self.loads[i]] += mode * slope * sign_of[i]
        self.solve = np.linalg.inv(system)

    @property
    def modes(self):
        return np.concatenate((self.own, self.flanks))

    def now(self, t, y):
        """Return accelerations, moments of constraints, and friction."""
        q, v = np.split(y, 2)
        right = np.zeros(len(self.solve))
        right[: self.rotors] = [moment(t) for moment in self.train.moments]
        for torque in self.train.torques:
            right[: self.rotors] += torque(t, q, v)
        for spring, flank in zip(self.train.springs, self.flanks, strict=True):
            right[: self.rotors] += spring.torques(flank, q, v)
        for k, (row, mode) in enumerate(zip(self.train.rows, self.own.tolist(), strict=True)):
            if mode and not (row.one_way and mode < 0):
                right[self.first + k] = -mode * row.limit(t, 0.0, mode, self.static[k])
        return self.solve @ right

    def rates(self, t, y):
        return np.concatenate((y[self.rotors :], self.now(t, y)[: self.rotors]))

    def slacks(self, t, y):
        """Return numbers that fall below zero when this phase ends."""
        (q, v), now, found = np.split(y, 2), self.now(t, y), []
        for k, row in enumerate(self.train.rows):
            if self.own[k]:
                found.append(self.own[k] * np.dot(row.weights, v))
                continue
            force, load = now[self.first + k], now[self.loads[k]] if k in self.loads else 0.0
            found += [row.limit(t, load, way, not self.sliding[k]) + way * force for way in (1, -1)]
        pairs = zip(self.train.springs, self.flanks, strict=True)
        return [*found, *(self.signs * now[self.load_places]), *(s.margin(side, q, v) for s, side in pairs)]

    def is_consistent(self, t, y, moving, directions):
        now = self.now(t, y)
        rates = np.array([row.weights for row in self.train.rows])[moving] @ now[: self.rotors]
        if (
            not (rates * directions > ROUNDING).all()
            or (now[self.load_places] * self.signs < -ROUNDING).any()
        ):
            return False
        for k in np.flatnonzero(self.own == 0):
            row, force = self.train.rows[k], now[self.first + k]
            load = now[self.loads[k]] if k in self.loads else 0.0
            if any(row.limit(t, load, way, not self.sliding[k]) + way * force < -ROUNDING for way in (1, -1)):
                return False
        return True


def _next_event(phase, time, y, stop):
    """Return time and state of the first event of a phase, or at ``stop``."""
    options = {"rtol": 1e-11, "atol": 1e-13, "max_step": LONGEST}
    solver = DOP853(phase.rates, time, y, stop, first_step=min(1e-5, stop - time), **options)
    before, begin = None, time + NEXT
    while solver.status == "running":
        solver.step()
        if solver.t < begin:
            continue
        state = solver.dense_output()
        for t in np.minimum(np.linspace(max(solver.t_old, begin), solver.t, SAMPLES), stop - 1e-12):
            values = np.array(phase.slacks(t, state(t)))
            if (values < -ROUNDING).any():
                if before is None:
                    raise ValueError(f"an event at t = {t} s, just after another")
                low, positive = before
                rows = [row for row in np.flatnonzero(values < -ROUNDING) if positive[row] > 0.0]
                found = min((_root(phase, state, row, low, t) for row in rows), default=low)
                return found, state(found)
            before = t, values
    return stop, solver.y


def _root(phase, state, row, *ends):
    return brentq(lambda t: phase.slacks(t, state(t))[row], *ends, xtol=1e-14, rtol=1e-14)
