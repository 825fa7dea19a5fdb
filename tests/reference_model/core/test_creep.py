"""Slip that decays without end or stays slow, and states between the steps of strongly damped motions."""

import math
from dataclasses import replace

import numpy as np
import pytest
from plain_engines import as_disc

from reference_model import PinOnDisc, simulate

CREEPING = PinOnDisc(mass=1.0, stiffness=1.0, damping=2.0, friction_force=0.1, disc_speed=0.5, offset=0.0)
HARDENING = PinOnDisc(
    mass=1.0, stiffness=1.0, damping=18.33447359460056, friction_force=0.23857615288586362,
    disc_speed=0.015113070308458439, offset=0.0, hardening=7.5004186926367495,
)  # fmt: skip

TURNED = replace(as_disc(CREEPING, None), shaft_damping=0.01, shaft_speed=-1.0)
"""A ring that turns while it creeps, because its shaft exerts a moment."""


@pytest.fixture
def few_steps(monkeypatch):
    monkeypatch.setattr("reference_model.trajectory.MOST_STEPS", 3_000)


@pytest.mark.usefixtures("few_steps")
@pytest.mark.parametrize("compiled", [False, True])
@pytest.mark.parametrize("points", ["pin", None, 6], ids=["pin", "ring", "six points"])
def test_creep_decays_without_end_at_the_slower_of_two_rates(points, compiled):
    system, start = CREEPING, [0.5, 0.0, 0.0, 0.0]
    if points != "pin":
        system, start = as_disc(CREEPING, points), [0.5, 0.0, 0.0, 0.0, 0.0, 0.5]
    creeping = simulate(system, start, [0.0, 20.0, 24.0, 28.0, 32.0, 1000.0], compiled=compiled)
    assert [phase.kind for phase in creeping.phases] == ["slip"]
    assert creeping.solution.steps < 3_000
    # The roots of s'' + (β/m)·s' + (k² − ω²)·s = 0 are −1/2 and −3/2; the faster one has decayed. The next order is
    # s, and rounding of x causes 1e-17/s.
    assert np.diff(np.log(creeping.slip_speed[1:5])) == pytest.approx(-2.0, rel=1e-4)
    # At the final radius the pull, |ω² − k² − iωβ/m| times the radius, equals friction.
    assert creeping.radius[-1] == pytest.approx(0.1 / math.hypot(0.5**2 - 1.0, 0.5 * 2.0), rel=1e-9)


@pytest.mark.usefixtures("few_steps")
@pytest.mark.parametrize("system", [CREEPING, HARDENING, TURNED], ids=["linear", "hardening", "ring"])
def test_closed_form_for_the_end_of_creep_does_not_depend_on_the_tolerance(system):
    start = [-0.3, 0.2, -0.1, 0.3] if system is not TURNED else [-0.3, 0.2, 0.0, -0.1, 0.3, 0.9]
    times = np.linspace(0.0, 300.0, 61)
    default, tight = (simulate(system, start, times, tolerance=tolerance) for tolerance in (1e-9, 1e-11))
    assert [phase.kind for phase in default.phases] == [phase.kind for phase in tight.phases]
    assert np.abs(default.states - tight.states).max() < 1e-9 * tight.radius.max()


@pytest.mark.parametrize("hardening", [0.5, 2.0])
def test_creep_on_a_hardening_support_ends_where_the_pull_equals_friction_to_rounding(hardening):
    pin = replace(CREEPING, damping=3.0, hardening=hardening)
    x, y = simulate(pin, [0.3, 0.0, 0.0, 0.0], [0.0, 2000.0], tolerance=1e-12).at_end[:2]
    # The closed form neglects 1 % of the allowed error of a step, which is 3e-14 at this tolerance.
    square = x**2 + y**2
    carried = complex(
        pin.stiffness + pin.hardening * square - pin.disc_speed**2, pin.damping * pin.disc_speed
    )
    assert abs(carried) * math.sqrt(square) == pytest.approx(pin.friction_force, rel=3e-14, abs=0.0)


def test_strongly_damped_pin_without_friction_follows_its_slow_root():
    stiffer = 1e8
    pin = PinOnDisc(mass=1.0, stiffness=1.0, damping=stiffer, friction_force=0.0, disc_speed=1.0, offset=0.0)
    times = np.linspace(0.0, 50.0, 11)
    found = simulate(pin, [1.0, 0.0, 0.0, 0.0], times)
    slow = 2.0 / (stiffer + math.sqrt(stiffer**2 - 4.0))
    fast = 1.0 / slow
    x = (fast * np.exp(-slow * times) - slow * np.exp(-fast * times)) / (fast - slow)
    assert found.states[:, 0] == pytest.approx(x, abs=1e-9)


OVERDAMPED = PinOnDisc(
    mass=1.0, stiffness=1.0, damping=2.0, friction_force=0.00348404708, disc_speed=3.83354141, offset=2.108728
)
FROM_THE_AXIS = [0.01498423, -0.0328726, 0.04863351, -0.1851470]
TWO_RATES = PinOnDisc(
    mass=1.0, stiffness=5.4, damping=184.55, friction_force=0.0786, disc_speed=2.7, offset=0.29
)
"""Its fast root is 79 times its natural frequency, so the last term of an interpolant may miss it within a step."""


@pytest.mark.parametrize(
    ("pin", "start", "end", "tolerance", "allowed"),
    [
        *((replace(OVERDAMPED, damping=c), FROM_THE_AXIS, 27.656, 1e-9, 2.0) for c in (2.0, 8.3458546)),
        (TWO_RATES, [-1.25, -0.13, 0.19, 0.69], 1.57, 1e-6, 1.0),
    ],
)
def test_states_between_the_steps_of_a_strongly_damped_pin_are_as_accurate_as_at_its_end(
    pin, start, end, tolerance, allowed
):
    times = np.linspace(0.0, end, 1001)
    found, tight = (simulate(pin, start, times, tolerance=accuracy) for accuracy in (tolerance, 1e-13))
    # The units are X0 or the initial radius, and 1/ω. The step and its interpolant may each be off by the tolerance.
    scales = max(pin.offset, math.hypot(*start[:2])) * np.array([1.0, 1.0, pin.disc_speed, pin.disc_speed])
    assert (np.abs(found.states - tight.states) / scales).max() < allowed * tolerance
    if pin.damping == 8.3458546:
        compiled = simulate(pin, start, times, compiled=True).states
        between = [90, 350, 513, 577, 800]
        assert compiled[between] == pytest.approx(tight.states[between], abs=2e-9)
