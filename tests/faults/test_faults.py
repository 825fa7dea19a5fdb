"""The sound plain engine is accurate."""

import functools
import math
from dataclasses import replace

import numpy as np
import pytest

from compare.claims.parameters import FIG5, FIG5_STARTS
from faults import SOUND
from faults.equations import carried, rates
from faults.make import RIGHT as MADE_RIGHT
from faults.make import Numbers
from faults.plain import simulate
from reference_model import DiscOnDisc, PinOnDisc
from reference_model.plain import on_ring
from reference_model.plain import rates as printed_rates

REFERENCE, PLAIN = SOUND

SUPPORT = {"mass": 2.3, "stiffness": 3.1, "damping": 0.2, "offset": 0.1}
STOP = {"hardening": 5.0, "stop_gap": 0.15, "stop_stiffness": 4.0}
PIN = PinOnDisc(friction_force=0.3, disc_speed=1.5, **SUPPORT, **STOP)
RING = DiscOnDisc(
    friction_force=0.3, disc_speed=1.5, **SUPPORT, polar_inertia=0.7, contact_radius=0.12, shaft_damping=0.05,
    shaft_speed=1.2,
)  # fmt: skip
POINTS = replace(RING, contact_points=6)
MOVING = (0.2, 0.1, 0.3, 0.3, 0.1, 2.0)
MOTIONS = {
    "pin with stick": (FIG5, FIG5_STARTS["whirl"], 12.0),
    "ring": (RING, MOVING, 6.0),
    "points": (POINTS, MOVING, 6.0),
    "pin on a fast disc, backwards": (replace(PIN, disc_speed=-4.5), (0.2, 0.1, 0.3, 0.1), 3.0),
    "pin released by a fast disc": (
        replace(FIG5, disc_speed=5.0, friction_force=0.12),
        (-0.005, 0.0, 0.0, -0.025),
        1.0,
    ),
}


@functools.cache
def motion(engine, name, tolerance):
    system, start, until = MOTIONS[name]
    return engine.simulate(system, start, np.linspace(0.0, until, 61), tolerance=tolerance)


def apart(first, second):
    return float(np.max(np.abs(first.states - second.states)))


def test_block_released_along_a_diagonal_does_not_keep_its_first_step_size():
    """LSODA keeps the initial stiffness as long as its predictor is exact to rounding."""
    block = PinOnDisc(mass=1.0, stiffness=0.1, damping=0.0, friction_force=1.0, disc_speed=0.0)
    start = [-10.1 * math.cos(math.pi / 4.0), -10.1 * math.sin(math.pi / 4.0), 0.0, 0.0]
    run = simulate(block, start, [0.0, 11.0], tolerance=1.25e-10)
    assert run.solution.steps < 5_000
    np.testing.assert_allclose(run.at_end[:2], np.full(2, -9.9 * math.sqrt(0.5)), atol=1e-7)


@pytest.mark.parametrize(
    ("system", "start", "points"), [(PIN, (0.2, 0.1, 0.3, 0.1), 1), (POINTS, MOVING, 6), (RING, MOVING, 4000)]
)
def test_equations_of_the_plain_engine_are_those_of_the_paper(system, start, points):
    width, half = 1e-9, len(start) // 2
    friction = on_ring(system.friction_force, getattr(system, "contact_radius", 0.0), points, width)
    expected = np.array(printed_rates(system, friction, start))
    expected[half : half + 2] -= carried(expected[:2], system.disc_speed)  # relative to the master disc
    y = np.array(start)
    y[half:] -= carried(y[:half], system.disc_speed)
    found = rates(0.0, y, width, 1.0, Numbers.of(system), MADE_RIGHT)
    assert found == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("name", MOTIONS)
def test_plain_engine_converges_to_the_reference_with_its_tolerance(name):
    tolerance, exact = 1e-8, motion(REFERENCE, name, 1e-12)
    coarse, fine = (motion(PLAIN, name, share * tolerance) for share in (8.0, 1.0))
    error = apart(fine, exact)
    assert error <= apart(coarse, fine)
    # Stick creeps with 10 tolerances for some seconds, which affects later phases.
    assert error < 2e3 * tolerance


def test_phases_of_the_plain_engine_agree_with_the_reference():
    plain, exact = (motion(engine, "pin with stick", 1e-10) for engine in (PLAIN, REFERENCE))
    assert [phase.kind for phase in plain.phases] == [phase.kind for phase in exact.phases]
    assert plain.stick_times == pytest.approx(exact.stick_times, abs=1e-6)
