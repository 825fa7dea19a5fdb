"""Sound engines are accurate, and each fault changes the motion."""

import functools
import itertools
import math
import pickle
import re
from dataclasses import replace

import numpy as np
import pytest
from scipy.special import ellipe, ellipkm1

from compare.claims.parameters import FIG5, FIG5_STARTS
from compare.engines import BadTrajectoryError
from faults import FAULTS, SOUND, reference
from faults.equations import carried, rates
from faults.friction import mean_slip, on_polygon
from faults.make import RIGHT as MADE_RIGHT
from faults.make import Make, Numbers
from faults.plain import simulate
from reference_model import DiscOnDisc, PinOnDisc
from reference_model.plain import on_ring
from reference_model.plain import rates as printed_rates
from reference_model.trajectory import SimulationError

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
    "pin on a stop": (PIN, (0.2, 0.1, 0.3, 0.1), 6.0),
    "ring": (RING, MOVING, 6.0),
    "points": (POINTS, MOVING, 6.0),
    "points that slip more than they spin": (POINTS, (0.2, 0.1, 0.3, 0.3, 0.6, 2.0), 1.0),
    "ring that slips more than it spins": (RING, (0.2, 0.1, 0.3, 0.3, 0.6, 2.0), 1.0),
    "pin on a fast disc, backwards": (replace(PIN, disc_speed=-4.5), (0.2, 0.1, 0.3, 0.1), 3.0),
    "pin let go by a fast disc": (
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


def apart_in_time(first, second):
    times, others = first.stick_times, second.stick_times
    return float(np.max(np.abs(times - others), initial=0.0)) if times.shape == others.shape else math.inf


# ---------------------------------------------------------------- the plain engine is right


def test_a_block_that_is_let_go_straight_between_the_axes_is_not_followed_in_steps_of_its_first_moment():
    """LSODA keeps the initial stiffness as long as its predictor is exact to rounding."""
    block = PinOnDisc(mass=1.0, stiffness=0.1, damping=0.0, friction_force=1.0, disc_speed=0.0)
    start = [-10.1 * math.cos(math.pi / 4.0), -10.1 * math.sin(math.pi / 4.0), 0.0, 0.0]
    run = simulate(block, start, [0.0, 11.0], tolerance=1.25e-10)
    assert run.solution.steps < 5_000
    np.testing.assert_allclose(run.at_end[:2], np.full(2, -9.9 * math.sqrt(0.5)), atol=1e-7)


@pytest.mark.parametrize("ratio", [1e-9, 1e-3, 0.3, 0.999, 1.0 - 1e-9, 1.0 + 1e-9, 1.7, 1e3, 1e9])
def test_mean_slip_is_that_of_the_elliptic_integrals_of_scipy(ratio):
    u, w = ratio, 1.0
    m, complement = min(4.0 * u * w / (u + w) ** 2, 1.0), ((u - w) / (u + w)) ** 2
    first, second = ellipkm1(complement), ellipe(m)
    speed, by_slip, by_rim = mean_slip(u, w)
    assert speed == pytest.approx(2.0 / math.pi * (u + w) * second, rel=1e-14)
    # The sums cancel if one speed is small; the error is of the order of rounding over that speed.
    rounding = 8.0 * np.finfo(float).eps
    assert by_slip == pytest.approx(
        ((u + w) * second + (u - w) * first) / (math.pi * u), abs=rounding * first * (1.0 + 1.0 / ratio)
    )
    assert by_rim == pytest.approx(
        ((u + w) * second - (u - w) * first) / (math.pi * w), abs=rounding * first * (1.0 + ratio)
    )
    # P is homogeneous of degree one (Euler); this check has no cancellation.
    assert u * by_slip + w * by_rim == pytest.approx(speed, rel=1e-14)


@pytest.mark.parametrize(
    ("system", "start", "points"), [(PIN, (0.2, 0.1, 0.3, 0.1), 1), (POINTS, MOVING, 6), (RING, MOVING, 4000)]
)
def test_its_equations_are_those_printed(system, start, points):
    width, half = 1e-9, len(start) // 2
    friction = on_ring(system.friction_force, getattr(system, "contact_radius", 0.0), points, width)
    expected = np.array(printed_rates(system, friction, start))
    expected[half : half + 2] -= carried(expected[:2], system.disc_speed)  # relative to the master disc
    y = np.array(start)
    y[half:] -= carried(y[:half], system.disc_speed)
    found = rates(0.0, y, width, 1.0, Numbers.of(system), MADE_RIGHT)
    assert found == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("name", MOTIONS)
@pytest.mark.parametrize("tolerance", [1e-7, 1e-9])
def test_the_plain_engine_comes_to_the_motion_of_the_reference_like_its_tolerance(name, tolerance):
    exact = motion(REFERENCE, name, 1e-12)
    errors = [apart(motion(PLAIN, name, t), exact) for t in (8.0 * tolerance, tolerance)]
    estimate = apart(motion(PLAIN, name, 8.0 * tolerance), motion(PLAIN, name, tolerance))
    assert errors[1] <= estimate
    assert (
        errors[1] < 2e3 * tolerance
    )  # creep of 10 tolerances for some seconds, and its effect on later phases


def test_the_plain_engine_sticks_and_slips_when_the_reference_does():
    plain, exact = (motion(engine, "pin with stick", 1e-10) for engine in (PLAIN, REFERENCE))
    assert [phase.kind for phase in plain.phases] == [phase.kind for phase in exact.phases]
    assert plain.stick_times == pytest.approx(exact.stick_times, abs=1e-6)


@pytest.mark.parametrize(("order", "steps"), [(1, (4e-4, 2e-4, 1e-4)), (4, (0.02, 0.01, 0.005))])
def test_fixed_steps_have_the_order_that_they_have_in_truth(order, steps):
    times = [0.0, 1.0]
    exact = REFERENCE.simulate(RING, MOVING, times, tolerance=1e-13).at_end
    errors = [
        np.max(np.abs(simulate(RING, MOVING, times, make=Make(order=order, step=h)).at_end - exact))
        for h in steps
    ]
    observed = np.log2(np.array(errors[:-1]) / errors[1:])
    assert observed == pytest.approx([order] * 2, abs=0.2)


@pytest.mark.parametrize("circumscribed", [False, True])
@pytest.mark.parametrize("sides", [4, 8])
def test_a_polygon_gives_its_nearest_force(sides, circumscribed):
    make = Make(sides=sides, circumscribed=circumscribed, first_side=0.2)
    apothem = 1.0 if circumscribed else math.cos(math.pi / sides)
    corners = (
        apothem
        / math.cos(math.pi / sides)
        * np.exp(1j * (0.2 + math.pi / sides * (2 * np.arange(sides + 1) + 1)))
    )
    edge = np.concatenate([np.linspace(a, b, 2001) for a, b in itertools.pairwise(corners)])
    generator = np.random.default_rng(1)
    for force in 2.0 * (generator.normal(size=50) + 1j * generator.normal(size=50)):
        found = on_polygon(force, make)
        nearest = edge[np.argmin(np.abs(edge - force))]
        inside = np.all(
            (force * np.exp(-1j * (0.2 + 2.0 * math.pi / sides * np.arange(sides)))).real <= apothem
        )
        assert abs(found - (force if inside else nearest)) < 1e-3


# ---------------------------------------------------------------- the reference with faults around it


@pytest.mark.parametrize("points", [None, 3, 5, 6, 7])
def test_only_kernels_of_many_runs_are_used(points, monkeypatch):
    asked = []
    monkeypatch.setattr("reference_model.simulate", lambda *_, compiled, **more: asked.append(compiled))
    reference.simulate(replace(RING, contact_points=points), MOVING, [0.0, 1.0])
    assert asked == [None if points in (None, 6) else False]


# ---------------------------------------------------------------- the catalogue


def test_the_catalogue_is_large_and_every_name_is_its_own():
    names = [fault.name for fault in FAULTS]
    assert len(names) == len(set(names)) >= 40
    for fault in FAULTS:
        assert re.fullmatch(r"[a-z0-9]+(-[a-z0-9]+)*", fault.name)
        assert fault.engine.name == fault.name
        assert fault.says.endswith(".")


@pytest.mark.parametrize(
    "engine", [*SOUND, *(fault.engine for fault in FAULTS)], ids=lambda engine: engine.name
)
def test_an_engine_can_be_sent_to_another_process(engine):
    assert pickle.loads(pickle.dumps(engine)).name == engine.name


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.name)
def test_a_fault_changes_a_motion_by_more_than_the_error_of_the_engine_that_it_is_in(fault):
    base = PLAIN if getattr(fault.engine.function, "func", None) is simulate else REFERENCE
    for name, (system, _, _) in MOTIONS.items():
        if not fault.engine.simulates(system):
            continue
        right = motion(base, name, 1e-9)
        try:
            changed = apart(motion(fault.engine, name, 1e-9), right)
        except (BadTrajectoryError, SimulationError):
            return  # a failed simulation also counts as a change
        if changed > 3.0 * apart(motion(base, name, 8e-9), right):
            return
        late = apart_in_time(motion(fault.engine, name, 1e-9), right)
        if late > 3.0 * apart_in_time(motion(base, name, 8e-9), right):
            return
    pytest.fail("no motion is changed")


def test_every_part_of_the_engine_that_can_be_wrong_is_so_in_some_fault():
    touched = set()
    for fault in FAULTS:
        make = getattr(fault.engine.function, "keywords", {}).get("make", MADE_RIGHT)
        touched |= {name for name in Make._fields if getattr(make, name) != getattr(MADE_RIGHT, name)}
    assert touched == set(Make._fields)
