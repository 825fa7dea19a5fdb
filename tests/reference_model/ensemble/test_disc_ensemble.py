import math
import platform
from dataclasses import replace

import numba
import numpy as np
import pytest

from compare.claims.parameters import FIG8, FIG9, FIG11
from reference_model import DiscOnDisc, self_centred_equilibria, simulate, whirls
from reference_model.ensemble import EndState, simulate_ensemble
from reference_model.ensemble.core.records import layout
from reference_model.ensemble.disc import kernel as disc_kernel
from reference_model.ensemble.disc import lanes as disc_lanes
from reference_model.ensemble.disc.trapping import known_regions

STICKING = DiscOnDisc(
    mass=1.0, polar_inertia=0.034, stiffness=1.0, damping=0.255, friction_force=0.14, disc_speed=1.2, offset=0.1,
    contact_radius=0.28, shaft_damping=0.01, shaft_speed=-0.5,
)  # fmt: skip
"""Sticks and slips again and again, with a shaft that asks for four tenths of the moment that friction could give."""

BISTABLE = DiscOnDisc(
    mass=1.0, polar_inertia=0.01, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=1.5, offset=0.1,
    contact_radius=0.05, shaft_damping=0.01, shaft_speed=1.4,
)  # fmt: skip
"""Nearly the pin of Fig. 5: some starts end at the equilibrium, others on the whirl."""

WHIRLING = replace(FIG11, friction_force=0.05)


def starts_of(n, seed=0):
    rng = np.random.default_rng(seed)
    starts = np.zeros((n, 6))
    starts[:, 0], starts[:, 3] = rng.uniform(-0.3, 0.5, n), rng.uniform(-0.4, 0.4, n)
    starts[:, 5] = rng.uniform(0.0, 1.5, n)
    return starts


def turning_with(disc, x, y):
    return [x, y, 0.0, -disc.disc_speed * y, disc.disc_speed * x, disc.disc_speed]


def same(one, other, which=slice(None)):
    return all(
        np.array_equal(a[which], b, equal_nan=True)
        for a, b in zip(vars(one).values(), vars(other).values(), strict=True)
    )


@pytest.mark.parametrize("points", [None, 6])
@pytest.mark.parametrize("disc", [FIG8, FIG9, FIG11], ids=["Fig. 8", "Fig. 9", "Fig. 11"])
def test_slip_is_that_of_the_reference_up_to_t_100(disc, points):
    disc = replace(disc, contact_points=points)
    starts = starts_of(5)
    found = simulate_ensemble(disc, starts, duration=100.0, early_end=False)
    expected = [simulate(disc, start, [0.0, 100.0], tolerance=1e-11).at_end for start in starts]
    assert np.all(found.time == 100.0)
    assert np.max(np.abs(found.states - expected)) < 1e-7


def test_the_place_where_a_point_of_the_ring_rests_costs_no_accuracy():
    # There friction has infinite slopes; errors of 500 steps of 1e-10 each may add up to 5e-8.
    starts = starts_of(12, seed=1)
    found = simulate_ensemble(FIG9, starts, duration=100.0, early_end=False)
    expected = [simulate(FIG9, start, [0.0, 100.0], tolerance=1e-11).at_end for start in starts]
    assert np.max(np.abs(found.states - expected)) < 1e-7


@pytest.mark.parametrize("points", [None, 6])
def test_stick_and_release_are_those_of_the_reference_up_to_t_40(points):
    disc = replace(STICKING, contact_points=points)
    start = turning_with(disc, -0.08, 0.0)
    motion = simulate(disc, start, [0.0, 40.0], tolerance=1e-11)
    found = simulate_ensemble(disc, start, duration=40.0, early_end=False)
    assert len(motion.stick_phases) > 3
    assert np.max(np.abs(found.states[0] - motion.at_end)) < 1e-7


def test_the_error_falls_with_the_tolerance():
    start = starts_of(3, seed=2)
    exact = [simulate(FIG8, one, [0.0, 50.0], tolerance=1e-13).at_end for one in start]
    errors = [
        np.max(
            np.abs(simulate_ensemble(FIG8, start, duration=50.0, tolerance=t, early_end=False).states - exact)
        )
        for t in (1e-5, 1e-7, 1e-9)
    ]
    # In proportion, but for a factor of 4 by which the share of the steps differs.
    assert errors[1] < 4e-2 * errors[0]
    assert errors[2] < 4e-2 * errors[1]


@pytest.mark.parametrize(
    ("advance", "around"),
    [(disc_kernel._advance_rings, ()), (disc_kernel._advance_points, (1.0, 0.0, -0.5, 0.8, -0.5, -0.8))],
    ids=["ring", "points"],
)
def test_one_step_of_all_lanes_is_vectorised_throughout(advance, around):
    arm = platform.machine() in ("arm64", "aarch64")
    together, alone = ("fsqrt\tv", "fsqrt\td") if arm else ("sqrtpd", "sqrtsd")
    caller = numba.njit(lambda lanes, around: advance(lanes, around))
    caller.compile((numba.from_dtype(layout(disc_lanes.DiscLanes)), numba.typeof(around)))
    code = "".join(caller.inspect_asm().values())
    assert code.count(together) > 13 * 3
    assert code.count(alone) == 0


@pytest.mark.parametrize("points", [None, 6])
def test_results_do_not_depend_on_neighbours_or_threads(points):
    disc = replace(FIG11, contact_points=points)
    starts = np.concatenate((starts_of(600), [turning_with(disc, 0.1, 0.0)]))
    whole = simulate_ensemble(disc, starts, duration=20.0, threads=1)
    order = np.random.default_rng(1).permutation(len(starts))
    assert same(whole, simulate_ensemble(disc, starts, duration=20.0, threads=2))
    assert same(whole, simulate_ensemble(disc, starts[order], duration=20.0, threads=2), order)
    assert same(whole, simulate_ensemble(disc, starts[17], duration=20.0), slice(17, 18))


def test_parameters_that_differ_do_as_if_each_stood_alone():
    loads = np.array([0.03, 0.05, 0.08])
    found = simulate_ensemble(FIG8, starts_of(1)[0], duration=60.0, parameters={"friction_force": loads})
    for i, load in enumerate(loads):
        expected = simulate(
            replace(FIG8, friction_force=load), starts_of(1)[0], [0.0, found.time[i]], tolerance=1e-11
        )
        assert np.max(np.abs(found.states[i] - expected.at_end)) < 1e-7


def test_what_is_ended_early_in_fig_8_rests_where_the_equilibrium_is():
    starts = starts_of(40)
    early = simulate_ensemble(FIG8, starts, duration=3000.0)
    full = simulate_ensemble(FIG8, starts, duration=3000.0, early_end=False)
    point = self_centred_equilibria(FIG8)[0]
    assert np.all(early.end == EndState.SELF_CENTRED)
    assert np.all(full.end == EndState.SELF_CENTRED)
    assert np.all(early.time < 0.2 * full.time)
    assert np.allclose(full.states[:, :2], (point.x, point.y), atol=1e-7)
    assert np.allclose(early.largest_radius, math.hypot(point.x, point.y))
    torque = FIG8.shaft_damping * (FIG8.shaft_speed - point.spin)
    # What the master disc puts in: the friction force on the disc at rest times what moves below it, and the moment.
    force = FIG8.stiffness * complex(point.x - FIG8.offset, point.y)
    drive = (force.conjugate() * -1j * FIG8.disc_speed * complex(point.x, point.y)).real
    power = -drive - torque * (FIG8.disc_speed - point.spin)
    assert early.slip_power == pytest.approx(power, rel=1e-9)


def test_motion_on_the_edge_of_a_region_goes_to_the_equilibrium():
    region = known_regions(BISTABLE)[0]
    form = np.zeros((5, 5))
    form[np.triu_indices(5)] = region["form"].tolist()
    form += np.triu(form, 1).T
    directions = np.random.default_rng(3).standard_normal((200, 5))
    sizes = np.sqrt(region["level"] / np.einsum("ni,ij,nj->n", directions, form, directions))
    x, y, vx, vy, r = (region["centre"] + sizes[:, np.newaxis] * directions).T
    gyration = math.sqrt(BISTABLE.polar_inertia / BISTABLE.mass)
    starts = np.column_stack((x, y, 0.0 * x, vx, vy, BISTABLE.disc_speed + r / gyration))
    found = simulate_ensemble(BISTABLE, starts, duration=600.0, early_end=False)
    assert np.all(np.abs(found.states[:, :2] - region["centre"][:2]) < 1e-6)


def test_what_is_ended_early_ends_as_at_full_length_and_as_in_the_reference():
    starts = starts_of(300, seed=4)
    early = simulate_ensemble(BISTABLE, starts, duration=1000.0)
    full = simulate_ensemble(BISTABLE, starts, duration=1000.0, early_end=False)
    assert set(early.end) == {EndState.SELF_CENTRED, EndState.WHIRL}
    assert np.array_equal(early.end, full.end)
    assert np.mean(early.time) < 0.3 * 1000.0
    point = self_centred_equilibria(BISTABLE)[0]
    for i in [
        *np.flatnonzero(early.end == EndState.SELF_CENTRED)[:2],
        *np.flatnonzero(early.end == EndState.WHIRL)[:2],
    ]:
        motion = simulate(BISTABLE, starts[i], np.linspace(0.0, 500.0, 5001))
        rests = math.dist(motion.at_end[:2], (point.x, point.y)) < 1e-8
        assert rests == (early.end[i] == EndState.SELF_CENTRED)
        last = motion.radius[-1000:]
        assert early.least_radius[i] == pytest.approx(last.min(), rel=2e-4)
        assert early.largest_radius[i] == pytest.approx(last.max(), rel=2e-4)


def test_a_whirl_without_offset_is_the_circle_of_the_formula():
    whirl = whirls(WHIRLING)[0]
    assert whirl.stable
    found = simulate_ensemble(WHIRLING, starts_of(30), duration=2000.0)
    full = simulate_ensemble(WHIRLING, starts_of(30), duration=2000.0, early_end=False)
    assert np.array_equal(found.end, full.end)
    assert set(found.end) == {EndState.WHIRL, EndState.STUCK}  # this much friction may also hold the disc
    whirling = found.end == EndState.WHIRL
    assert found.largest_radius[whirling] == pytest.approx(whirl.radius, rel=1e-4)
    assert np.hypot(*full.states[whirling, :2].T) == pytest.approx(whirl.radius, rel=1e-8)
    for start, end in list(zip(starts_of(30), found.end, strict=True))[:6]:
        last = simulate(WHIRLING, start, [0.0, 400.0]).phases[-1]
        assert last.kind == ("slip" if end == EndState.WHIRL else "stick")


def test_the_modulated_whirl_of_fig_11_has_the_radii_of_the_reference():
    found = simulate_ensemble(FIG11, starts_of(20), duration=3000.0)
    # Begun near to it: others come so close to the axis that the integrator's error decides where they go on from.
    near = (0.04, 0.0, 0.0, 0.0, 0.04, 1.39)
    late = simulate(FIG11, near, np.linspace(0.0, 1000.0, 10001)).radius[6000:]
    assert np.all(found.end == EndState.MODULATED)
    assert found.least_radius == pytest.approx(late.min(), rel=1e-3)
    assert found.largest_radius == pytest.approx(late.max(), rel=1e-3)


def test_a_motion_that_stays_long_at_an_unstable_centre_does_not_end_there():
    start = [0.04795804, 0.0, 0.0, -0.35128644, 0.0, 0.15522885]
    waiting = simulate(FIG11, start, [0.0, 200.0]).at_end
    assert math.hypot(*waiting[:2]) < 1e-9
    assert not self_centred_equilibria(FIG11)[0].stable
    assert simulate_ensemble(FIG11, start, duration=3000.0).end[0] == EndState.MODULATED


@pytest.mark.parametrize("points", [None, 6])
def test_a_disc_that_friction_holds_everywhere_is_stuck_for_ever(points):
    disc = replace(STICKING, friction_force=2.0, contact_points=points)
    start = turning_with(disc, 0.1, 0.05)
    found = simulate_ensemble(disc, start, duration=50.0)
    assert found.end[0] == EndState.STUCK
    assert found.slip_power[0] == 0.0
    assert found.largest_radius[0] == pytest.approx(math.hypot(0.1, 0.05))
    full = simulate_ensemble(disc, start, duration=50.0, early_end=False)
    assert full.states[0] == pytest.approx(simulate(disc, start, [0.0, 50.0]).at_end, abs=1e-12)


def test_a_disc_that_sticks_and_slips_in_turn_is_told_as_that():
    found = simulate_ensemble(STICKING, turning_with(STICKING, -0.08, 0.0), duration=2000.0)
    assert found.end[0] == EndState.STICK_SLIP
    assert found.time[0] < 500.0


def test_without_friction_a_disc_swings_like_the_linear_oscillator():
    disc = replace(FIG8, friction_force=0.0, damping=0.0, offset=0.0)
    found = simulate_ensemble(disc, [0.1, 0.0, 0.0, 0.0, 0.2, 0.3], duration=50.0, early_end=False)
    c, s = math.cos(50.0), math.sin(50.0)
    assert found.states[0, :2] == pytest.approx((0.1 * c, 0.2 * s), abs=1e-8)
    assert found.states[0, 5] == pytest.approx(0.5 - 0.2 * math.exp(-0.01 * 50.0), abs=1e-8)


@pytest.mark.parametrize("points", [None, 6])
def test_without_friction_a_disc_that_starts_without_slip_moves_and_is_decided_as_any(points):
    disc = replace(FIG8, friction_force=0.0, damping=0.3, shaft_damping=0.5, contact_points=points)
    start = turning_with(disc, 0.3, 0.1)
    full = simulate_ensemble(disc, start, duration=20.0, early_end=False)
    k, decay = math.sqrt(1.0 - 0.15**2), 0.15
    z, v = complex(0.3 - disc.offset, 0.1), 1j * disc.disc_speed * complex(0.3, 0.1)
    z = disc.offset + math.exp(-decay * 20.0) * (
        z * math.cos(20.0 * k) + (v + decay * z) / k * math.sin(20.0 * k)
    )
    assert full.time[0] == 20.0
    assert full.states[0, :2] == pytest.approx((z.real, z.imag), abs=1e-8)
    for parameters in ({}, {"mass": [disc.mass]}):
        found = simulate_ensemble(disc, start, duration=300.0, parameters=parameters)
        assert found.end[0] == EndState.SELF_CENTRED
        assert found.largest_radius[0] == pytest.approx(disc.offset, rel=1e-4)


@pytest.mark.parametrize("points", [None, 6])
@pytest.mark.filterwarnings("error")
def test_without_friction_and_offset_a_disc_comes_to_the_axis(points):
    disc = replace(
        FIG8, friction_force=0.0, damping=0.3, shaft_damping=0.5, offset=0.0, contact_points=points
    )
    assert (
        simulate_ensemble(disc, turning_with(disc, 0.3, 0.1), duration=300.0).end[0] == EndState.SELF_CENTRED
    )


def test_more_points_than_are_written_out_are_refused():
    with pytest.raises(ValueError, match=r"contact_points = 25: .* support up to 24"):
        simulate_ensemble(replace(FIG8, contact_points=25), starts_of(1), duration=1.0)


def test_a_disc_on_six_points_ends_about_where_the_ring_rests():
    disc = replace(FIG8, contact_points=6)
    found = simulate_ensemble(disc, starts_of(12), duration=1500.0)
    full = simulate_ensemble(disc, starts_of(12), duration=1500.0, early_end=False)
    point = self_centred_equilibria(FIG8)[0]
    assert np.all(found.end == EndState.SELF_CENTRED)
    assert np.mean(found.time) < 0.5 * 1500.0
    # Points add a moment and a force that come round six times a turn, a few per cent of what the ring gives.
    assert np.all(np.hypot(full.states[:, 0] - point.x, full.states[:, 1] - point.y) < 0.05 * point.x)


def ring(inertia, damping, friction, speed, offset, radius, shaft_damping, shaft_speed):
    return DiscOnDisc(
        mass=1.0, stiffness=1.0, polar_inertia=inertia, damping=damping, friction_force=friction, disc_speed=speed,
        offset=offset, contact_radius=radius, shaft_damping=shaft_damping, shaft_speed=shaft_speed,
    )  # fmt: skip


def ended(disc, start, duration=1000.0):
    """Where it ends, told by the motion itself."""
    return simulate_ensemble(disc, start, duration=duration, parameters={"mass": [1.0]})


def test_a_ring_that_comes_to_the_axis_ends_at_radius_zero():
    disc = ring(0.04472, 0.152, 0.06584, -1.385, 0.0, 0.3582, 0.09325, 0.7529)
    found = ended(disc, [0.1, 0.0, 0.0, 0.03, 0.0, 0.5])
    assert found.end[0] == EndState.SELF_CENTRED
    assert found.least_radius[0] == found.largest_radius[0] == 0.0
    # A ring that spins on the spot slips by R·(spin − ω), with the moment of friction at its largest, μN·R.
    most = disc.friction_force * disc.contact_radius
    slip = disc.disc_speed - disc.shaft_speed + most / disc.shaft_damping
    assert found.slip_power[0] == pytest.approx(most * abs(slip), rel=1e-3)


def test_a_ring_that_creeps_inward_by_turns_is_stuck_where_its_motion_leads():
    disc = ring(0.8, 0.1511, 0.1354, -0.7539, 0.01847, 0.05522, 0.003907, -0.4767)
    found = ended(disc, turning_with(disc, 0.27, 0.0))
    assert found.end[0] == EndState.STUCK
    limit = found.largest_radius[0]
    turns = 400.0 * 2.0 * math.pi / abs(disc.disc_speed)
    left = simulate(disc, found.states[0], [0.0, turns, 4.0 * turns], compiled=True).radius - limit
    assert left[2] < 1e-3 * limit
    assert left[1] / left[2] == pytest.approx(4.0, rel=0.2)  # the way left falls like one over the turns made


def test_the_largest_radius_of_stick_and_slip_is_seen_while_slip_begins():
    disc = ring(0.0747428, 1.63329, 0.0985983, -1.502217, 0.0964475, 0.9644915, 0.00126935, 0.6208175)
    found = ended(disc, [0.4, 0.1, 0.0, 0.0, 0.0, 0.0])
    assert found.end[0] == EndState.STICK_SLIP
    radius = simulate(disc, found.states[0], np.linspace(0.0, 5.0, 2001), compiled=True).radius
    assert found.least_radius[0] == pytest.approx(radius.min(), rel=1e-4)
    assert found.largest_radius[0] == pytest.approx(radius.max(), rel=1e-4)
