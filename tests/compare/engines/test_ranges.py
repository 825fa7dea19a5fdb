"""An engine is never asked for motions beyond the ranges that it declares, and none of them counts as a fault."""

from dataclasses import replace

import numpy as np
import pytest

from compare.diagnosis import findings, run
from compare.diagnosis.row import RIGHT
from compare.engines import Engine, OutOfRangeError, Ranges, reference
from reference_model import FrictionJoint, PinOnDisc

PIN = PinOnDisc(mass=2.0, stiffness=0.0, damping=0.0, friction_force=1e-9, disc_speed=0.0, offset=0.0)
SMALL = {"coordinate": 20.0, "speed": 10.0, "time": 1e3, "mass": (0.01, 100.0)}


def limited(ranges, seed=None):
    """Return the reference with the ranges, which fails beyond them, and the list of its motions."""
    limits, asked = Ranges.of(ranges), []

    def simulate(system, start, times, *, tolerance):
        found = reference.function(system, start, times, tolerance=tolerance)
        asked.append(system)
        farthest, fastest = (np.max(np.hypot(*found.states[:, i : i + 2].T)) for i in (0, 2))
        assert farthest <= 1.001 * limits.coordinate
        assert fastest <= 1.001 * limits.speed
        assert max(times) <= limits.time
        assert limits.mass[0] <= system.mass <= limits.mass[1]
        return found

    return Engine("limited", simulate, ranges=ranges, phases=False, seed=seed), asked


@pytest.mark.parametrize(
    ("start", "times", "mass", "why"),
    [
        ((19.0, 0.0, 1.0, 0.0), (0.0, 2.0), 2.0, "coordinates up to 20 m, not 21 m"),
        ((0.0, 0.0, 11.0, 0.0), (0.0, 1.0), 2.0, "speeds up to 10 m/s, not 11 m/s"),
        ((0.0, 0.0, 0.0, 0.0), (0.0, 2e3), 2.0, "times up to 1000 s, not 2000 s"),
        ((0.0, 0.0, 1.0, 0.0), (0.0, 1.0), 200.0, "masses from 0.01 to 100 kg, not 200 kg"),
    ],
)
def test_a_motion_beyond_a_range_is_not_requested(start, times, mass, why):
    engine, asked = limited(SMALL)
    with pytest.raises(OutOfRangeError, match=f"limited declares {why}"):
        engine.simulate(replace(PIN, mass=mass), start, times)
    assert not asked


def test_only_the_time_limits_a_joint():
    engine = Engine("limited", reference.function, ("joint",), ranges=SMALL)
    joint = FrictionJoint(inertia=1e3, friction_moment=1.0)
    assert engine.simulate(joint, (50.0, 20.0), (0.0, 1.0)).at_end[0] > 60.0
    with pytest.raises(OutOfRangeError, match="limited declares times up to 1000 s, not 2000 s"):
        engine.simulate(joint, (0.0, 0.0), (0.0, 2e3))


def test_the_matrix_stays_within_the_ranges_and_names_what_it_leaves_out():
    engine, asked = limited(SMALL)
    row = run._empty(engine)
    for part in findings.parts_of(engine):
        row = run._with(row, part, run.measured(engine, part))
    assert len(asked) > 500
    assert row.verdict == RIGHT
    assert "Left out: far: limited declares coordinates up to 20 m, not 100 m." in row.sentences
    assert "slip speed 0.0001 to 9 m/s" in row.scales.looked_at


def test_ranges_hold_in_the_units_that_the_engine_receives():
    engine, asked = limited(SMALL, seed=1)
    for part in ("law", "scales"):
        run.measured(engine, part)
    assert {system.mass for system in asked} != {1.0}


@pytest.mark.parametrize(
    ("ranges", "why"),
    [
        ({"lenght": 1.0}, "range 'lenght'"),
        ({"speed": -1.0}, "speed = -1: it must be > 0"),
        ({"mass": 1.0}, "expected the smallest and the largest mass"),
        ({"mass": (2.0, 1.0)}, "must be >= 0 and increase"),
    ],
)
def test_invalid_ranges_are_refused(ranges, why):
    with pytest.raises(ValueError, match=why):
        Engine("wrong", reference.function, ranges=ranges)
