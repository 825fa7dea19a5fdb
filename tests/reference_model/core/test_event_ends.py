"""Runs that end at an event, or one rounding error before or after it."""

import functools
import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
from disc_equations import STICKING, STICKY
from scipy.optimize import brentq

from reference_model import PinOnDisc, simulate

PIN = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.12, disc_speed=1.2, offset=0.1)
ON_PIN = [0.1, 0.0, 0.0, 0.12]
MOTIONS = {
    "pin": (PIN, ON_PIN, {"stick", "slip"}),
    "pin on a hard support": (replace(PIN, hardening=3.0), ON_PIN, {"stick", "slip"}),
    "ring": (STICKY, STICKING, {"stick", "slip"}),
    "three points": (replace(STICKY, contact_points=3), STICKING, {"stick", "slip", "pivot"}),
}


@pytest.fixture(autouse=True)
def bounded_work(monkeypatch):
    monkeypatch.setattr("reference_model.trajectory.MOST_STEPS", 20_000)


def neighbours(event):
    return [float(np.nextafter(event, event + side)) for side in (-1, 0, 1)]


@pytest.mark.parametrize("motion", MOTIONS)
def test_run_that_ends_where_a_phase_begins_agrees_with_a_longer_run(motion):
    system, start, kinds = MOTIONS[motion]
    whole = simulate(system, start, [0.0, 12.0])
    events = [phase.start for phase in whole.phases[1:4]]
    assert {phase.kind for phase in whole.phases[1:5]} == kinds
    through = simulate(system, start, [0.0, *events, 12.0]).states[1:-1]
    for event, state in zip(events, through, strict=True):
        for end in neighbours(event):
            assert simulate(system, start, [0.0, end]).states[-1] == pytest.approx(state, abs=1e-8)


@pytest.mark.parametrize("motion", ["pin", "ring", "three points"])
def test_run_that_ends_where_contact_with_the_stop_begins_or_ends_is_at_the_gap(motion):
    system, start = replace(MOTIONS[motion][0], stop_gap=0.15, stop_stiffness=20.0), MOTIONS[motion][1]

    @functools.cache
    def beyond(t):
        x, y = simulate(system, start, [0.0, t]).states[-1, :2]
        return math.hypot(x - system.offset, y) - system.stop_gap

    looks = np.linspace(0.1, 5.0, 11)
    brackets = [ends for ends in itertools.pairwise(looks) if beyond(ends[0]) * beyond(ends[1]) < 0.0]
    assert len(brackets) >= 2
    for bracket in brackets[:2]:
        for end in neighbours(brentq(beyond, *bracket, xtol=1e-15)):
            assert abs(beyond(end)) < 1e-9
