"""Exact motion of chains of bodies on revolute joints with dry brakes, in minimal coordinates, by events."""

from itertools import combinations, product

import numpy as np
from scipy.integrate import solve_ivp

NONE = 2
"""Mode of a joint without a brake; 0 is locked, and ±1 slides."""
NEXT = 1e-6
"""Time in s from an event to the choice of modes, because slip accelerations are zero at a release."""
ROUNDING = 1e-10


def turned(axis, angle):
    across = np.cross(np.eye(3), axis)
    return np.eye(3) + np.sin(angle) * across + (1.0 - np.cos(angle)) * across @ across


class Chain:
    """Bodies with ``masses`` (kg), ``inertias`` (kg m²) about their centres, and joints.

    Joint i is at ``places[i]`` (m) from the centre of its parent and -``centres[i]`` from that of its body, about
    ``axes[i]``. All bodies start with the global axes and relative ``speeds`` (rad/s). ``motors`` are functions of
    time and ``slides`` sliding moments of the brakes, 0 for none, in N m.
    """

    def __init__(self, masses, inertias, places, axes, centres, motors, slides, ratios, speeds):
        self.masses, self.inertias, self.places, self.axes, self.centres = (
            masses,
            inertias,
            places,
            axes,
            centres,
        )
        self.motors, self.speeds, self.slides = motors, np.array(speeds), np.array(slides)
        self.statics = self.slides * np.array(ratios)

    def bodies(self, q, v):
        """Return for each body rotation, centre, spin, bias accelerations, and the axes and places of all joints."""
        rotation, (centre, spin, turn, push) = np.eye(3), np.zeros((4, 3))
        found, axes, joints = [], [], []
        for k in range(len(q)):
            axis, arm = rotation @ self.axes[k], rotation @ self.places[k]
            push = push + np.cross(turn, arm) + np.cross(spin, np.cross(spin, arm))
            axes, joints = [*axes, axis], [*joints, centre + arm]
            turn, spin = turn + np.cross(spin, axis) * v[k], spin + axis * v[k]
            rotation = rotation @ turned(self.axes[k], q[k])
            arm = rotation @ self.centres[k]
            centre = joints[-1] + arm
            push = push + np.cross(turn, arm) + np.cross(spin, np.cross(spin, arm))
            found.append((rotation, centre, spin, turn, push, np.array(axes), np.array(joints)))
        return found

    def solve(self, t, q, v, modes, slides=None):
        """Return the accelerations (rad/s²) and the moments of the brakes (N m), which slip with ``slides`` (N m)."""
        count, slides = len(q), self.slides if slides is None else slides
        masses, moments = np.zeros((count, count)), np.array([float(motor(t)) for motor in self.motors])
        for k, (rotation, centre, spin, turn, push, axes, joints) in enumerate(self.bodies(q, v)):
            turns, moves = np.zeros((3, count)), np.zeros((3, count))
            turns[:, : k + 1], moves[:, : k + 1] = axes.T, np.cross(axes, centre - joints).T
            inertia = rotation @ self.inertias[k] @ rotation.T
            masses += self.masses[k] * moves.T @ moves + turns.T @ inertia @ turns
            moments -= moves.T @ (self.masses[k] * push)
            moments -= turns.T @ (inertia @ turn + np.cross(spin, inertia @ spin))
        brakes = np.where(np.abs(modes) == 1, -modes * slides, 0.0)
        rates, free = np.zeros(count), modes != 0
        rates[free] = np.linalg.solve(masses[np.ix_(free, free)], (moments + brakes)[free])
        brakes[~free] = (masses @ rates - moments)[~free]
        return rates, brakes

    def choice(self, t, q, v, modes, rests):
        """Choose modes of the brakes ``rests``: those slip that static friction cannot hold, as few as possible.

        Static friction acts on all first, and sliding friction on those that then slip, until no other slips.
        """
        slipped = set()
        while True:
            limits = np.where(np.isin(np.arange(len(q)), [*set(rests) - slipped]), self.statics, self.slides)
            found = self._consistent(t, q, v, modes, rests, rests, limits, limits)
            new = {int(k) for k in rests if found[k] != 0} - slipped
            if not new:
                return self._consistent(t, q, v, modes, rests, sorted(slipped), self.statics, self.slides)
            slipped |= new

    def _consistent(self, t, q, v, modes, rests, may_slip, limits, slides):
        for count in range(len(may_slip) + 1):
            for moving in map(list, combinations(may_slip, count)):
                for signs in product((1, -1), repeat=count):
                    tried = modes.copy()
                    tried[rests], tried[moving] = 0, signs
                    rates, brakes = self.solve(t, q, v, tried, slides)
                    if (rates[moving] * signs > ROUNDING).all() and (np.abs(brakes) <= limits + ROUNDING)[
                        tried == 0
                    ].all():
                        return tried
        raise ValueError(f"no modes at t = {t} s")

    def rates(self, t, state, modes):
        q, v = np.split(state, 2)
        return np.hstack([v, self.solve(t, q, v, modes)[0]])

    def _slack(self, k, mode):
        def left(t, state, modes):
            q, v = np.split(state, 2)
            return mode * v[k] if mode else self.statics[k] - abs(self.solve(t, q, v, modes)[1][k])

        left.terminal, left.direction = True, -1
        return left

    def motion(self, end):
        """Return the changes as (time, joint, before, after), and the state at the time ``end`` (s)."""
        count = len(self.speeds)
        time, state, changes = 0.0, np.hstack([np.zeros(count), self.speeds]), []
        modes = np.where(self.slides == 0.0, NONE, np.sign(self.speeds)).astype(int)
        modes = self.choice(NEXT, *np.split(state, 2), modes, np.flatnonzero(modes == 0))
        while True:
            brakes = [k for k in range(count) if modes[k] != NONE]
            steps = {
                "max_step": 1e-2,
                "first_step": min(1e-5, (end - time) / 2.0),
                "rtol": 1e-10,
                "atol": 1e-12,
            }
            events = [self._slack(k, modes[k]) for k in brakes]
            run = solve_ivp(self.rates, (time, end), state, "DOP853", events=events, args=(modes,), **steps)
            time, state = run.t[-1], run.y[:, -1]
            if run.status == 0:
                return changes, state
            stops = [k for k, times in zip(brakes, run.t_events, strict=True) if len(times) and modes[k] != 0]
            state[[count + k for k in stops]] = 0.0
            rests = [k for k in brakes if modes[k] == 0 or k in stops]
            soon = state if stops else state + NEXT * self.rates(time, state, modes)
            new = self.choice(time + NEXT, *np.split(soon, 2), modes, rests)
            pairs = enumerate(zip(modes.tolist(), new.tolist(), strict=True))
            changes += [(time, k, before, after) for k, (before, after) in pairs if before != after]
            modes = new
