"""Exact motion of trains of rotors with dry contacts on one axis, by events; independent of the package.

All moments depend on time only, so speeds are closed-form integrals between events. At an event all modes of the
contacts at rest are tried, with static limits first and sliding limits for those that then slip. A group of locked
contacts holds if no cut through it carries more than its contacts can (Hoffman's theorem for flows), in any topology.
"""

from dataclasses import dataclass, field
from itertools import combinations, product

import numpy as np
from scipy.optimize import brentq

GROUND = -1
OPEN = 2
NEXT = 1e-7
"""Time in s from an event to the choice of modes, because slip accelerations are zero at a release."""
AT_REST = 1e-9
"""Largest slip in rad/s of a contact that rests at an event."""
ROUNDING = 1e-11
"""Slip in rad/s, slip acceleration in rad/s², or moment in N m, that counts as zero."""
SAMPLES = 2.5e-4
"""Distance in s of the samples between which events are bracketed."""


@dataclass(frozen=True)
class Signal:
    """A function of time t: offset + slope·t + amplitude·sin(2π·frequency·t + phase) + heights of past steps."""

    offset: float = 0.0
    slope: float = 0.0
    amplitude: float = 0.0
    frequency: float = 0.0
    phase: float = 0.0
    steps: tuple[tuple[float, float], ...] = ()

    def __call__(self, t):
        wave = self.amplitude * np.sin(2.0 * np.pi * self.frequency * t + self.phase)
        past = sum(height * (np.asarray(t) >= time) for time, height in self.steps)
        return self.offset + self.slope * np.asarray(t) + wave + past

    def integral(self, t):
        """Integrate from 0 to ``t``."""
        total = self.offset * t + self.slope * np.square(t) / 2.0
        if self.amplitude:
            rate = 2.0 * np.pi * self.frequency
            total = total + self.amplitude / rate * (np.cos(self.phase) - np.cos(rate * t + self.phase))
        return total + sum(height * np.maximum(np.asarray(t) - time, 0.0) for time, height in self.steps)

    def rate(self, t):
        wave = 2.0 * np.pi * self.frequency
        return self.slope + self.amplitude * wave * np.cos(wave * np.asarray(t) + self.phase)


@dataclass(frozen=True, eq=False)  # equal contacts may be parallel
class Link:
    """A contact of the rotors a and b, with sliding moment >= 0 in N m; a one-way link only drives b forward."""

    a: int
    b: int
    capacity: Signal
    static_ratio: float = 1.0
    one_way: bool = False


@dataclass(frozen=True)
class Train:
    """Rotors with inertias (kg m²), initial speeds (rad/s) and moments (N m); ``shafts`` have prescribed speeds."""

    inertias: tuple[float, ...]
    speeds: tuple[float, ...]
    moments: tuple[Signal, ...]
    links: tuple[Link, ...]
    shafts: dict[int, Signal] = field(default_factory=dict)

    def breaks(self):
        signals = (*self.moments, *(link.capacity for link in self.links))
        return sorted({time for signal in signals for time, _ in signal.steps})


@dataclass(frozen=True)
class Change:
    time: float
    link: int
    before: int
    after: int


def exact_motion(train, end):
    """Return all changes of mode until ``end`` (s), and the final speeds (rad/s)."""
    run = _Run(train)
    for stop in [time for time in train.breaks() if 0.0 < time < end] + [end]:
        run.advance(stop)
    return run.changes, run.speeds


class _Run:
    def __init__(self, train):
        self.train, self.time, self.changes = train, 0.0, []
        self.speeds = np.array(train.speeds, dtype=float)
        for shaft, signal in train.shafts.items():
            self.speeds[shaft] = signal(0.0)
        self.modes = np.sign(self._slips(self.speeds)).astype(int)
        self._decide(first=True)

    def advance(self, stop):
        """Follow the motion to ``stop`` with all events before it; choose modes there, where signals may step."""
        while (time := _first_event(_Phase(self.train, self.modes, self.time, self.speeds), stop)) < stop:
            self._go_to(time)
        self._go_to(stop)

    def _go_to(self, time):
        self.speeds = _Phase(self.train, self.modes, self.time, self.speeds).speeds(np.array([time]))[:, 0]
        self.time = time
        self._decide()

    def _slips(self, speeds):
        padded = np.append(speeds, 0.0)  # the ground is the last, as index -1
        return np.array([padded[link.b] - padded[link.a] for link in self.train.links])

    def _decide(self, first=False):
        time, before, slips = self.time + NEXT, self.modes, self._slips(self.speeds)
        closed = np.array([link.capacity(time) > 0.0 for link in self.train.links])
        rests = closed & ((before == 0) | (np.abs(slips) < AT_REST))
        modes = np.where(closed, np.sign(slips).astype(int), OPEN)
        self.modes = _choice(self.train, np.where(rests, 0, modes), np.flatnonzero(rests), time)
        if not first:
            pairs = enumerate(zip(before.tolist(), self.modes.tolist(), strict=True))
            self.changes += [Change(self.time, k, old, new) for k, (old, new) in pairs if old != new]


def _choice(train, modes, rests, time):
    """Choose modes of the contacts ``rests``: those slip that static friction cannot hold, as few as possible.

    Static friction acts on all first, and sliding friction on those that then slip, until no other slips.
    """
    slipped = set()
    while True:
        static = [link for k, link in enumerate(train.links) if k in rests and k not in slipped]
        found = _consistent(train, modes, rests, rests, time, static)
        new = {int(k) for k in rests if found[k] != 0} - slipped
        if not new:
            return _consistent(train, modes, rests, sorted(slipped), time)
        slipped |= new


def _consistent(train, modes, rests, may_slip, time, static=None):
    """Return the modes with the fewest slipping contacts; ``static`` friction, if given, acts on those that slip."""
    slipped = () if static is None else [train.links[k] for k in may_slip if train.links[k] not in static]
    for count in range(len(may_slip) + 1):
        for moving in map(list, combinations(may_slip, count)):
            for signs in product((1, -1), repeat=count):
                tried = modes.copy()
                tried[rests], tried[moving] = 0, signs
                phase = _Phase(train, tried, time, np.array(train.speeds), static or ())
                goes = (phase.slip_rates(time)[moving] * signs > ROUNDING).all()
                if goes and phase.margin(np.array([time]), slipped)[0] > -ROUNDING:
                    return tried
    raise ValueError(f"no modes at t = {time} s")


class _Phase:
    """Motion with constant ``modes`` from the speeds at the time ``start``; ``static`` links slip statically."""

    def __init__(self, train, modes, start, speeds, static=()):
        self.train, self.start, self.initial, self.static = train, start, speeds, static
        self.masses = np.array(train.inertias)
        count = len(self.masses)
        group = np.arange(count + 1)  # the last is the ground
        locked = [link for link, mode in zip(train.links, modes, strict=True) if mode == 0]
        for link in locked:
            group[group == group[link.a]] = group[link.b]
        self.groups = [np.flatnonzero(group == g) for g in dict.fromkeys(group.tolist())]
        pairs = zip(train.links, modes, strict=True)
        self.slides = [(link, mode) for link, mode in pairs if mode not in (0, OPEN)]
        free = [[n for n in nodes.tolist() if n < count and n not in train.shafts] for nodes in self.groups]
        cuts = [
            cut for rotors in free for size in range(len(rotors)) for cut in combinations(rotors, size + 1)
        ]
        crossings = [
            [(link, link.b in cut) for link in locked if (link.a in cut) != (link.b in cut)] for cut in cuts
        ]
        self.cuts = [(list(cut), crossing) for cut, crossing in zip(cuts, crossings, strict=True) if crossing]

    def _sums(self, t, read):
        """Return the moments of all rotors, or their integrals, without those of locked contacts; shape (n, ...)."""
        total = np.array([read(moment, t) + 0.0 * t for moment in self.train.moments])
        for link, mode in self.slides:
            ratio = link.static_ratio if link in self.static else 1.0
            moment = ratio * _direction(link, mode) * read(link.capacity, t)
            for node, sign in ((link.a, -1.0), (link.b, 1.0)):
                if node != GROUND:
                    total[node] += sign * moment
        return total

    def _by_groups(self, sums, prescribed):
        """Divide the sums of groups by their masses, or take the value of a prescribed shaft or of the ground."""
        result = np.empty_like(sums)
        for nodes in self.groups:
            rotors = nodes[nodes < len(self.masses)]
            shafts = [node for node in rotors if node in self.train.shafts]
            if len(rotors) < len(nodes):
                result[rotors] = 0.0
            elif shafts:
                result[rotors] = prescribed(self.train.shafts[shafts[0]])
            else:
                result[rotors] = sums[rotors].sum(axis=0) / self.masses[rotors].sum()
        return result

    def accelerations(self, t):
        return self._by_groups(self._sums(t, lambda signal, t: signal(t)), lambda signal: signal.rate(t))

    def speeds(self, t):
        """Return the speeds at the times ``t``, shape (n, times)."""
        begin = np.full_like(t, self.start)
        gained = self._sums(t, Signal.integral) - self._sums(begin, Signal.integral)
        return self.initial[:, None] + self._by_groups(gained, lambda signal: signal(t) - signal(begin))

    def slip_rates(self, t):
        rates = np.append(self.accelerations(t), 0.0)
        return np.array([rates[link.b] - rates[link.a] for link in self.train.links])

    def slips(self, t):
        """Return the slips of the sliding contacts in the direction of their modes."""
        speeds = np.vstack([self.speeds(t), 0.0 * t])
        return [mode * (speeds[link.b] - speeds[link.a]) for link, mode in self.slides]

    def margin(self, t, slipped=()):
        """Return the least moment (N m) that is left in any cut through locked contacts, at the times ``t``."""
        missing = self.masses[:, None] * self.accelerations(t) - self._sums(t, lambda signal, t: signal(t))
        least = np.full(len(t), np.inf)
        for nodes in self.groups:
            rates = [self.train.shafts[node].rate(t) for node in nodes if node in self.train.shafts]
            rates += [0.0 * t] * (len(self.masses) in nodes)
            if len(rates) > 1:  # two prescribed motions
                least = np.where(np.ptp(rates, axis=0) > ROUNDING, -np.inf, least)
        for cut, crossing in self.cuts:
            need = missing[cut].sum(axis=0)
            for sign in (1.0, -1.0):
                most = sum(_largest(link, sign if inward else -sign, slipped, t) for link, inward in crossing)
                least = np.minimum(least, most - sign * need)
        return least


def _direction(link, mode):
    """Return the sign of the moment of a sliding contact on b."""
    return max(-mode, 0) if link.one_way else -mode


def _largest(link, direction, slipped, t):
    """Return the largest moment of a locked contact on b in a direction."""
    ratio = 1.0 if link in slipped else link.static_ratio
    return (0.0 if link.one_way and direction < 0.0 else ratio) * link.capacity(t)


def _first_event(phase, stop):
    """Return the time of the first event of a phase, or ``stop``."""

    def slacks(t):
        return np.array([*phase.slips(t), phase.margin(t)])

    begin = phase.start + NEXT
    while begin < stop - 1e-12:
        t = np.minimum(np.arange(begin, begin + 200.0 * SAMPLES, SAMPLES), stop - 1e-12)
        values = slacks(t)
        failed = values < -ROUNDING
        if failed.any():
            place = int(np.argmax(failed.any(axis=0)))
            if place == 0:
                raise ValueError(f"an event at t = {begin} s, just after another")
            rows = [row for row in np.flatnonzero(failed[:, place]) if values[row, place - 1] > 0.0]
            return min((_root(slacks, row, *t[place - 1 : place + 1]) for row in rows), default=t[place - 1])
        begin = t[-1] if t[-1] > begin else stop
    return stop


def _root(slacks, row, *ends):
    return brentq(lambda t: slacks(np.array([t]))[row, 0], *ends, xtol=1e-14, rtol=1e-14)
