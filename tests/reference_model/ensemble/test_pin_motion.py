"""The compiled pin moves as the plain reference does, to tolerance, whatever runs beside it."""

import platform
import re
from dataclasses import replace

import numba
import numpy as np
import pytest

from compare.claims.parameters import FIG5, FIG5_STARTS
from reference_model import PinOnDisc, simulate
from reference_model.ensemble import chunks, simulate_ensemble
from reference_model.ensemble.core import laws
from reference_model.ensemble.core.nondimensional import units
from reference_model.ensemble.core.records import layout
from reference_model.ensemble.pin import lanes as pin_lanes
from reference_model.ensemble.pin import slip as pin_slip
from reference_model.ensemble.pin.kernel import run_pins
from reference_model.motion.nondimensional import Units
from reference_model.motion.pin_equations import SlipMotion
from reference_model.motion.stick import release_delay, slip_from_rest

TOLERANCE = 1e-9


def basin_starts(n, seed=0):
    rng = np.random.default_rng(seed)
    x, vx = rng.uniform(-0.3, 0.5, n), rng.uniform(-0.4, 0.4, n)
    return np.column_stack((x, np.zeros(n), vx, np.zeros(n)))


def ends_of(pin, starts, duration, **options):
    return simulate_ensemble(pin, starts, duration=duration, early_end=False, **options).states


def reference_ends(pin, starts, duration):
    return np.array([simulate(pin, start, [0.0, duration], tolerance=1e-12).at_end for start in starts])


def law_of(pin):
    m = pin.mass
    return laws.PinLaw(
        pin.stiffness / m, pin.damping / m, pin.friction_force / m, pin.disc_speed, pin.offset, 0.03, 0.0
    )


@pytest.mark.parametrize("duration", [7.3, 100.0])
def test_fig5_ends_where_the_reference_does_through_stick_phases(duration):
    starts = np.array([*FIG5_STARTS.values(), *basin_starts(6)])
    sticks = [len(simulate(FIG5, start, [0.0, duration]).stick_phases) for start in starts]
    assert sum(sticks) >= 2
    errors = np.abs(ends_of(FIG5, starts, duration) - reference_ends(FIG5, starts, duration))
    assert errors.max() < 1e-7, errors.max(axis=1)


@pytest.mark.parametrize(
    ("pin", "start"),
    [
        (replace(FIG5, disc_speed=-1.5), (0.3, 0.1, -0.2, 0.3)),
        (replace(FIG5, offset=-0.1), (-0.1, 0.0, -0.03, 0.0)),
        (replace(FIG5, disc_speed=0.4, friction_force=0.12), (0.3, 0.1, -0.2, 0.3)),
        (replace(FIG5, disc_speed=0.0), (0.3, 0.1, -0.2, 0.3)),
        (replace(FIG5, damping=3.0, friction_force=0.3), (0.3, -0.4, 1.0, 0.3)),
        (replace(FIG5, friction_force=0.0), (0.3, 0.0, -0.2, 0.1)),
        (replace(FIG5, stiffness=0.0), (0.3, 0.0, -0.2, 0.1)),
        (replace(FIG5, damping=0.0, offset=0.0), (0.3, 0.0, -0.2, 0.1)),
        (replace(FIG5, mass=1e-3, offset=1e3), (900.0, 0.0, 1.0, 0.0)),
        (replace(FIG5, friction_force=0.25), (0.12, 0.1, -0.15, 0.18)),  # starts stuck
    ],
    ids=[
        "clockwise", "offset to the left", "slow disc", "disc at rest", "overdamped", "no friction", "no springs",
        "undamped, centred", "light and far", "stuck",
    ],
)  # fmt: skip
def test_other_pins_end_where_the_reference_does(pin, start):
    duration = 40.0 / max(pin.natural_frequency, abs(pin.disc_speed))
    size = max(np.hypot(*start[:2]), abs(pin.offset))
    errors = np.abs(ends_of(pin, start, duration)[0] - reference_ends(pin, [start], duration)[0])
    rate = max(pin.natural_frequency, abs(pin.disc_speed))
    assert np.all(errors < 1e-7 * size * np.array([1.0, 1.0, rate, rate])), errors


def test_error_falls_with_the_tolerance():
    starts = basin_starts(32)
    exact = ends_of(FIG5, starts, 60.0, tolerance=1e-13)
    tolerances = np.array([1e-5, 1e-7, 1e-9])
    errors = [
        np.median(np.abs(ends_of(FIG5, starts, 60.0, tolerance=tolerance) - exact).max(axis=1))
        for tolerance in tolerances
    ]
    # An error per step of the tolerance and steps that grow like tolerance^(−1/8): slope 7/8.
    slope = np.polyfit(np.log(tolerances), np.log(errors), 1)[0]
    assert slope == pytest.approx(7.0 / 8.0, abs=0.2), errors
    assert errors[-1] < 1e-8


def test_neighbours_chunks_and_threads_change_no_bit(monkeypatch):
    starts = basin_starts(300)
    order = np.random.default_rng(1).permutation(len(starts))

    def run(states, **options):
        return simulate_ensemble(FIG5, states, duration=80.0, **options)

    def assert_same(one, other):
        for name in vars(one):
            np.testing.assert_array_equal(getattr(one, name), getattr(other, name), err_msg=name)

    together = run(starts, threads=1)
    assert_same(together, run(starts, threads=2))
    shuffled = run(starts[order], threads=2)
    for name in vars(together):
        np.testing.assert_array_equal(getattr(together, name)[order], getattr(shuffled, name), err_msg=name)
    monkeypatch.setattr(chunks, "CHUNK", 7)
    assert_same(together, run(starts, threads=3))
    alone = run(starts[17])
    for name in vars(together):
        np.testing.assert_array_equal(getattr(together, name)[17], getattr(alone, name)[0], err_msg=name)


def test_parameters_by_trajectory_are_those_of_single_runs():
    rng = np.random.default_rng(2)
    n = 20
    varied = {"friction_force": rng.uniform(0.05, 0.15, n), "offset": rng.uniform(-0.1, 0.2, n)}
    starts = basin_starts(n)
    together = simulate_ensemble(FIG5, starts, duration=50.0, parameters=varied, early_end=False)
    for i in range(n):
        pin = replace(FIG5, **{name: float(values[i]) for name, values in varied.items()})
        np.testing.assert_array_equal(together.states[i], ends_of(pin, starts[i], 50.0)[0])


def test_units_are_those_of_the_reference():
    rng = np.random.default_rng(3)
    for _ in range(30):
        zero = rng.random(3) > 0.2
        pin = PinOnDisc(
            mass=1.0, stiffness=zero[0] * rng.uniform(0.1, 10.0), damping=rng.uniform(0.0, 2.0),
            friction_force=zero[1] * rng.uniform(0.1, 2.0), disc_speed=zero[2] * rng.normal(), offset=rng.normal(),
        )  # fmt: skip
        x, y, vx, vy = state = rng.normal(size=4)
        unit = Units.of(pin, state)
        length, rate = units(
            pin.natural_frequency, pin.damping, pin.friction_force, pin.disc_speed, pin.offset,
            float(np.hypot(x, y)), float(np.hypot(vx, vy)),
        )  # fmt: skip
        assert (length, rate) == pytest.approx((unit.length, 1.0 / unit.time), rel=1e-14)


def test_release_and_first_slip_are_those_of_the_reference():
    motion, law = SlipMotion.of(FIG5), law_of(FIG5)
    work = np.zeros((6, pin_slip.MOST_TERMS + 2), dtype=complex)
    for angle in np.linspace(0.0, 6.0, 9):
        z = 0.05 * np.exp(1j * angle)
        delay = release_delay(motion, z)
        assert laws.release_delay(z, law) == pytest.approx(delay, rel=1e-12)
        z *= np.exp(1j * FIG5.disc_speed * delay)
        place, slip, duration, way = pin_slip.begin_slip(z, law, 1e-13, 100.0, work)
        exact, exact_slip = slip_from_rest(motion, z).at(np.array([duration]))
        assert abs(place - exact[0]) < 1e-13
        assert abs(slip - exact_slip[0]) < 1e-12
        assert way == pytest.approx(abs(slip) * duration / 3.0, rel=0.1)  # it grows like t²


def test_a_short_excursion_beyond_friction_ends_in_rest_again():
    strong = replace(FIG5, damping=0.85, friction_force=0.56, disc_speed=-0.46, offset=-0.07)
    slow_disc = replace(FIG5, damping=0.128, friction_force=0.2424, disc_speed=-0.26, offset=-0.2275)
    work = np.zeros((6, pin_slip.MOST_TERMS + 2), dtype=complex)
    for pin in (strong, slow_disc):
        motion, law = SlipMotion.of(pin), law_of(pin)
        largest = laws.sticking_radius(law)
        for excess in (1e-4, 2e-4, 3.6e-4, 1e-3):
            z = largest * (1.0 + excess) + 0j
            z *= np.exp(1j * pin.disc_speed * release_delay(motion, z))
            _, slip, duration, _ = pin_slip.begin_slip(z, law, 1e-10, 100.0, work)
            assert slip == 0.0
            assert duration == pytest.approx(slip_from_rest(motion, z).rest, rel=1e-8)


def test_while_the_pull_is_constant_the_time_to_rest_is_exact():
    # Without springs and dampers on a resting disc the pull is that of the offset's spring alone: here none at all.
    law = laws.PinLaw(0.0, 0.0, 0.5, 0.0, 0.0, 0.03, 0.0)
    for w in (1e-3 + 0j, 2.0 - 1.0j):
        assert pin_slip.time_to_rest(0.3 + 0.1j, w, law, 1e-12) == pytest.approx(abs(w) / 0.5, rel=1e-14)


def test_the_step_of_all_lanes_is_vectorised():
    packed = {"x86_64": r"v?sqrtpd", "AMD64": r"v?sqrtpd", "aarch64": r"fsqrt\s+v", "arm64": r"fsqrt\s+v"}
    caller = numba.njit(lambda lanes: pin_lanes.advance(lanes, None))
    caller.compile((numba.from_dtype(layout(pin_lanes.PinLanes)),))
    assembly = "\n".join(caller.inspect_asm().values())
    # Thirteen right-hand sides and four roots for the error, each in one vector at least.
    assert len(re.findall(packed[platform.machine()], assembly)) >= 16
    assert not re.search(r"v?sqrtsd", assembly)


def test_the_kernel_is_compiled_once_for_one_pin_and_for_many():
    for parameters in ({}, {"mass": [1.0, 1.1]}):
        simulate_ensemble(FIG5, basin_starts(1), duration=1.0, parameters=parameters)
    assert len(run_pins.kinds) == 1
