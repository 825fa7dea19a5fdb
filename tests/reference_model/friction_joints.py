"""Random joints, and their motions by independent integrations."""

import itertools
import math

import numpy as np
from scipy.integrate import solve_ivp

from reference_model import FrictionJoint


def random_joint(seed):
    """Return a joint with or without spring, damper and moments up to 3 F, and its initial state."""
    random = np.random.default_rng(seed)
    inertia, friction = 10.0 ** random.uniform(-1.0, 1.0, 2)
    times = np.sort(random.uniform(-1.0, 9.0, random.integers(0, 6)))
    joint = FrictionJoint(
        inertia=inertia,
        friction_moment=friction,
        static_ratio=random.choice([1.0, 1.3, 2.0]),
        damping=random.choice([0.0, 10.0 ** random.uniform(-2.0, 1.5)]),
        stiffness=random.choice([0.0, 10.0 ** random.uniform(-1.0, 2.0)]),
        offset=random.uniform(-1.0, 1.0),
        moment=[(time, friction * random.uniform(-3.0, 3.0)) for time in times],
    )
    return joint, (
        random.uniform(-1.0, 1.0),
        random.choice([0.0, 3.0 * random.normal() * friction / inertia]),
    )


def load_of(joint):
    """Return the load on friction as a function of the time and the angle."""
    times, values = zip(*joint.moment, strict=True) if joint.moment else ((0.0,), (0.0,))
    return lambda t, angle: np.interp(t, times, values) - joint.stiffness * (angle - joint.offset)


def by_events(joint, state, times):
    """Return the states by DOP853, which ends each slide at an event; shape (n, 2)."""
    load, friction = load_of(joint), joint.friction_moment
    limit = joint.static_ratio * friction
    at, (angle, spin) = times[0], state
    way, found = float(np.sign(spin)), np.full((len(times), 2), np.nan)
    for bend in [*(t for t, _ in joint.moment if times[0] < t < times[-1]), times[-1]]:
        while at < bend:
            begun = at
            if way == 0.0 and abs(load(at, angle)) <= limit:
                first, last = load(at, angle), load(bend, angle)
                at = bend
                if abs(last) > limit * (1.0 + 1e-13):
                    way = float(np.sign(last))
                    at = begun + (bend - begun) * (limit - way * first) / abs(last - first)
                now = (times >= begun) & (times <= at)
                found[now] = angle, 0.0
                continue
            way = way or float(np.sign(load(at, angle)))

            def rates(t, y, way=way):
                return y[1], (load(t, y[0]) - way * friction - joint.damping * y[1]) / joint.inertia

            def stops(t, y, way=way, begun=begun, bend=bend):
                return way * y[1] if t > begun + 1e-9 * (bend - begun) else 1.0

            stops.terminal, stops.direction = True, -1.0
            period = math.sqrt(joint.inertia / joint.stiffness) if joint.stiffness else math.inf
            options = {"rtol": 1e-12, "atol": 1e-13, "max_step": min(period, bend - begun) / 5.0}
            run = solve_ivp(
                rates, (begun, bend), (angle, spin), "DOP853", events=stops, dense_output=True, **options
            )
            now = (times >= begun) & (times <= run.t[-1])
            found[now] = run.sol(times[now]).T if np.any(now) else found[now]
            at, (angle, spin) = run.t[-1], run.y[:, -1]
            if run.status == 1:
                spin = way = 0.0
    return found


def by_time_stepping(joint, state, times, step):
    """Return the states by Moreau's scheme: the impulse that stops the joint, at most that of friction."""
    load, (angle, spin) = load_of(joint), state
    found = [(angle, spin)]
    for begin, end in itertools.pairwise(times):
        number = math.ceil((end - begin) / step)
        h = (end - begin) / number
        for i in range(number):
            angle += 0.5 * h * spin
            pushed = spin + h * load(begin + (i + 0.5) * h, angle) / joint.inertia
            most = h * joint.friction_moment / joint.inertia
            kept = pushed - min(max(pushed, -most), most)
            spin = kept / (1.0 + h * joint.damping / joint.inertia)
            angle += 0.5 * h * spin
        found.append((angle, spin))
    return np.array(found)
