"""Pins and rings on planes whose motion constraints prescribe: turntables, belts and shakers, against DOP853."""

import exudyn as exu
import numpy as np
import pytest
from exact_trains import Signal
from free_bodies import changes_of, coordinate, items, new_model, planar_body, rotor
from scipy.integrate import solve_ivp

from exudyn_models import add_ring_friction

IMPLICIT = [exu.DynamicSolverType.TrapezoidalIndex2, exu.DynamicSolverType.GeneralizedAlpha]
END, STEP = 0.8, 1e-3  # s
STOPS = 1e-6
"""Slip in m/s whose end is extrapolated."""


class Plane:
    """A plane of the velocities ``ways`` (m/s) and the spin ``turn`` (rad/s), and a body of 1 kg that it drags.

    Friction of ``sliding`` N, at rest ``ratio`` times as much, acts against springs of ``stiffness`` (N/m).
    """

    def __init__(self, ways, turn, sliding, ratio, stiffness, place, slip):
        self.ways, self.turn, self.sliding, self.hold = ways, turn, sliding, ratio * sliding
        self.stiffness, self.place = stiffness, np.array(place)
        self.velocity = self.carried(0.0, self.place)[0] + slip

    def carried(self, t, place):
        """Return velocity and acceleration of the point of the plane that is at a place."""
        spin, across = float(self.turn(t)), np.array([-place[1], place[0]])
        velocity, rate = (
            np.array([float(read(way, t)) for way in self.ways]) for read in (Signal.__call__, Signal.rate)
        )
        return velocity + spin * across, rate + float(self.turn.rate(t)) * across - spin**2 * place

    def slip(self, t, state):
        return state[2:] - self.carried(t, state[:2])[0]

    def rates(self, t, state, rests):
        velocity, acceleration = self.carried(t, state[:2])
        if rests:
            return [*velocity, *acceleration]
        slip = self.slip(t, state)
        return [
            *state[2:],
            *(-self.sliding * slip / np.hypot(*slip) - self.stiffness * (state[:2] - self.place)),
        ]

    def load(self, t, state):
        return np.hypot(*(self.carried(t, state[:2])[1] + self.stiffness * (state[:2] - self.place)))

    def motion(self):
        """Return the times (s) of all stops and releases, and the final velocity (m/s)."""
        time, state, times = 0.0, np.hstack([self.place, self.velocity]), []
        rests = np.hypot(*self.slip(0.0, state)) == 0.0
        assert not rests or self.load(0.0, state) < self.hold  # otherwise it slides from the start
        while True:
            event = (
                (lambda t, y, _: self.hold - self.load(t, y))
                if rests
                else (lambda t, y, _: np.hypot(*self.slip(t, y)) - STOPS)
            )
            event.terminal, event.direction = True, -1
            steps = {"max_step": 5e-3, "first_step": 1e-6, "rtol": 1e-10, "atol": 1e-12}
            run = solve_ivp(self.rates, (time, END), state, "DOP853", events=event, args=(rests,), **steps)
            time, state = run.t[-1], run.y[:, -1]
            if run.status == 0:
                return times, state[2:]
            velocity, acceleration = self.carried(time, state[:2])
            if rests:
                pull = -acceleration - self.stiffness * (state[:2] - self.place)
                state[2:] = velocity + 1e-9 * pull / np.hypot(*pull)
            else:
                slip = self.slip(time, state)
                gained = np.array(self.rates(time, state, False)[2:]) - acceleration
                rest = -(STOPS**2) / (gained @ slip)
                time, state[:2] = time + rest, state[:2] + rest * velocity
                assert self.load(time, state) < self.hold  # otherwise it passes through rest
                state[2:] = self.carried(time, state[:2])[0]
            rests = not rests
            times.append(time)


def wave(rng, size):
    return {
        "amplitude": size * rng.uniform(0.5, 1.0),
        "frequency": rng.uniform(0.5, 1.2),
        "phase": rng.uniform(0.0, 6.0),
    }


def random_plane(seed):
    """Return a turntable, a belt or a shaker, and the radius of the contact (m)."""
    rng = np.random.default_rng(seed)
    still, place = Signal(), [rng.uniform(0.1, 0.2), rng.uniform(-0.1, 0.1)]
    slip = rng.choice([0.0, 0.3]) * np.array([0.6, -0.8])
    force, ratio, stiffness = rng.uniform(2.0, 6.0), rng.uniform(1.0, 1.5), rng.choice([0.0, 20.0])
    if seed % 3 == 0:
        turn = Signal(offset=rng.uniform(1.0, 3.0), slope=rng.uniform(2.0, 5.0), **wave(rng, 1.5))
        return Plane((still, still), turn, force, ratio, stiffness, place, slip), 0.0
    ways = Signal(offset=0.5, **wave(rng, 1.5)), Signal(**wave(rng, 1.0)) if seed % 3 == 2 else still
    return Plane(ways, still, force, ratio, stiffness, place, slip), 0.05


def prescribe(mbs, node, place, speed):
    mbs.AddObject(
        items.CoordinateConstraint(
            markerNumbers=[coordinate(mbs, None), coordinate(mbs, node, place)],
            offsetUserFunction=lambda mbs, t, item, offset: float(speed.integral(t)),
            offsetUserFunction_t=lambda mbs, t, item, offset: float(speed(t)),
        )
    )


def check(seed, solver):
    plane, radius = random_plane(seed)
    times, velocity = plane.motion()
    mbs = new_model()
    if seed % 3 == 0:
        master = rotor(mbs, 1.0, float(plane.turn(0.0)))
        prescribe(mbs, master, 0, plane.turn)
    else:
        master = planar_body(mbs, 5.0, 1.0, [0.0] * 3, [*(float(way(0.0)) for way in plane.ways), 0.0])
        for place, way in enumerate((*plane.ways, Signal())):
            prescribe(mbs, master, place, way)
    body = planar_body(mbs, 1.0, 0.01, [*plane.place, 0.0], [*plane.velocity, float(plane.turn(0.0))])
    for place in range(2):
        ends = [coordinate(mbs, None), coordinate(mbs, body, place)]
        rest = mbs.GetNodeParameter(body, "referenceCoordinates")[place]  # the spring measures from there
        spring = {"stiffness": plane.stiffness, "offset": plane.place[place] - rest}
        mbs.AddObject(items.CoordinateSpringDamper(markerNumbers=ends, **spring))
    law = {
        "friction_coefficient": 1.0,
        "normal_load": plane.sliding,
        "static_ratio": plane.hold / plane.sliding,
    }
    add_ring_friction(mbs, master, body, contact_radius=radius, **law)
    found = [time for time, _, before, after in changes_of(mbs, END, STEP, solver) if 0 in (before, after)]
    np.testing.assert_allclose(found, times, atol=1e-5, rtol=0.0)
    speed = mbs.GetNodeOutput(body, exu.OutputVariableType.Velocity)[:2]
    np.testing.assert_allclose(speed, velocity, atol=1e-4 * max(1.0, np.abs(velocity).max()), rtol=0.0)
    return len(times)


@pytest.mark.parametrize("solver", IMPLICIT)
def test_pins_and_rings_on_prescribed_planes_stop_and_slide_at_the_exact_times(solver):
    assert sum(check(seed, solver) for seed in (0, 1, 4, 7, 20, 26, 53, 80, 97)) > 12
