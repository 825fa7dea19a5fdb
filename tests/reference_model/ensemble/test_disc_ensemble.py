"""Ensembles of discs: motion against the reference, and end states."""

import math
from dataclasses import replace

import numpy as np
import pytest
from plain_engines import stuck_state

from compare.claims.parameters import FIG8, FIG11
from reference_model import DiscOnDisc, self_centred_equilibria, simulate, sticking_radius, whirls
from reference_model.ensemble import EndState, simulate_ensemble
from reference_model.ensemble.disc.trapping import trapping_regions
from reference_model.formulas.disc import held_pin

BISTABLE = DiscOnDisc(
    mass=1.0, polar_inertia=0.01, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=1.5, offset=0.1,
    contact_radius=0.05, shaft_damping=0.01, shaft_speed=1.4,
)  # fmt: skip
"""A disc similar to the pin of Fig. 5, with basins of an equilibrium and a whirl."""

WHIRLING = replace(FIG11, friction_force=0.05)

STICKING = DiscOnDisc(
    mass=1.0, polar_inertia=0.034, stiffness=1.0, damping=0.255, friction_force=0.14, disc_speed=1.2, offset=0.1,
    contact_radius=0.28, shaft_damping=0.01, shaft_speed=-0.5,
)  # fmt: skip


def starts_of(n, seed=0):
    rng = np.random.default_rng(seed)
    starts = np.zeros((n, 6))
    starts[:, 0], starts[:, 3] = rng.uniform(-0.3, 0.5, n), rng.uniform(-0.4, 0.4, n)
    starts[:, 5] = rng.uniform(0.0, 1.5, n)
    return starts


@pytest.mark.parametrize(("points", "away"), [(None, 1e-7), (6, 0.05)])
def test_early_end_at_the_equilibrium_of_fig_8_has_its_radius_and_power(points, away):
    starts, disc = starts_of(10), replace(FIG8, contact_points=points)
    early, full = (
        simulate_ensemble(disc, starts, duration=3000.0, early_end=early) for early in (True, False)
    )
    point = self_centred_equilibria(FIG8)[0]
    assert np.all(early.end == EndState.SELF_CENTRED)
    assert np.all(full.end == EndState.SELF_CENTRED)
    assert np.mean(early.time) < 0.5 * 3000.0
    # Friction of points oscillates six times per turn by a few per cent.
    assert np.hypot(full.states[:, 0] - point.x, full.states[:, 1] - point.y).max() < away * (
        point.x if points else 1.0
    )
    if points is None:
        assert np.allclose(early.largest_radius, math.hypot(point.x, point.y))
        torque = FIG8.shaft_damping * (FIG8.shaft_speed - point.spin)
        # The master disc supplies the power of the friction force and of the moment.
        force = FIG8.stiffness * complex(point.x - FIG8.offset, point.y)
        drive = (force.conjugate() * -1j * FIG8.disc_speed * complex(point.x, point.y)).real
        assert early.slip_power == pytest.approx(-drive - torque * (FIG8.disc_speed - point.spin), rel=1e-9)


def test_motion_from_the_edge_of_a_trapping_region_goes_to_the_equilibrium():
    region = trapping_regions(BISTABLE)[0]
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


def test_early_end_states_agree_with_full_length_and_the_reference():
    starts = starts_of(80, seed=4)
    early = simulate_ensemble(BISTABLE, starts, duration=1000.0)
    full = simulate_ensemble(BISTABLE, starts, duration=1000.0, early_end=False)
    assert set(early.end) == {EndState.SELF_CENTRED, EndState.WHIRL}
    assert np.array_equal(early.end, full.end)
    assert np.mean(early.time) < 0.3 * 1000.0
    point = self_centred_equilibria(BISTABLE)[0]
    for end in (EndState.SELF_CENTRED, EndState.WHIRL):
        i = np.flatnonzero(early.end == end)[0]
        motion = simulate(BISTABLE, starts[i], np.linspace(0.0, 500.0, 5001))
        rests = math.dist(motion.at_end[:2], (point.x, point.y)) < 1e-8
        assert rests == (end == EndState.SELF_CENTRED)
        last = motion.radius[-1000:]
        assert early.least_radius[i] == pytest.approx(last.min(), rel=2e-4)
        assert early.largest_radius[i] == pytest.approx(last.max(), rel=2e-4)


def test_whirl_without_offset_is_the_circle_of_the_formula():
    whirl = whirls(WHIRLING)[0]
    assert whirl.stable
    found = simulate_ensemble(WHIRLING, starts_of(12), duration=2000.0)
    full = simulate_ensemble(WHIRLING, starts_of(12), duration=2000.0, early_end=False)
    assert np.array_equal(found.end, full.end)
    assert set(found.end) == {EndState.WHIRL, EndState.STUCK}  # friction may also hold this disc
    whirling = found.end == EndState.WHIRL
    assert found.largest_radius[whirling] == pytest.approx(whirl.radius, rel=1e-4)
    assert np.hypot(*full.states[whirling, :2].T) == pytest.approx(whirl.radius, rel=1e-8)
    for start, end in list(zip(starts_of(12), found.end, strict=True))[:3]:
        last = simulate(WHIRLING, start, [0.0, 400.0]).phases[-1]
        assert last.kind == ("slip" if end == EndState.WHIRL else "stick")


def test_modulated_whirl_of_fig_11_has_the_radii_of_the_reference():
    # The last motion stays long at the unstable centre, from 1e-9 m on.
    through_centre = [0.04795804, 0.0, 0.0, -0.35128644, 0.0, 0.15522885]
    found = simulate_ensemble(FIG11, [*starts_of(6), through_centre], duration=3000.0)
    # This start avoids the axis, where errors of the integrator determine the further motion.
    near = (0.04, 0.0, 0.0, 0.0, 0.04, 1.39)
    late = simulate(FIG11, near, np.linspace(0.0, 1000.0, 10001), compiled=True).radius[6000:]
    assert np.all(found.end == EndState.MODULATED)
    assert found.least_radius == pytest.approx(late.min(), rel=1e-3)
    assert found.largest_radius == pytest.approx(late.max(), rel=1e-3)


@pytest.mark.parametrize("points", [None, 6])
def test_disc_that_friction_holds_everywhere_is_stuck(points):
    disc = replace(STICKING, friction_force=2.0, contact_points=points)
    start = stuck_state(disc, 0.1, 0.05)
    found = simulate_ensemble(disc, start, duration=50.0)
    assert found.end[0] == EndState.STUCK
    assert found.slip_power[0] == 0.0
    assert found.largest_radius[0] == pytest.approx(math.hypot(0.1, 0.05))
    full = simulate_ensemble(disc, start, duration=50.0, early_end=False)
    assert full.states[0] == pytest.approx(simulate(disc, start, [0.0, 50.0]).at_end, abs=1e-12)


@pytest.mark.parametrize("points", [None, 6])
@pytest.mark.filterwarnings("error")
def test_disc_without_friction_that_starts_without_slip_oscillates_and_is_decided(points):
    disc = replace(FIG8, friction_force=0.0, damping=0.3, shaft_damping=0.5, contact_points=points)
    start = stuck_state(disc, 0.3, 0.1)
    full = simulate_ensemble(disc, start, duration=20.0, early_end=False)
    k, decay = math.sqrt(1.0 - 0.15**2), 0.15
    z, v = complex(0.3 - disc.offset, 0.1), 1j * disc.disc_speed * complex(0.3, 0.1)
    z = disc.offset + math.exp(-decay * 20.0) * (
        z * math.cos(20.0 * k) + (v + decay * z) / k * math.sin(20.0 * k)
    )
    assert full.time[0] == 20.0
    assert full.states[0, :2] == pytest.approx((z.real, z.imag), abs=1e-8)
    for offset in (disc.offset, 0.0):
        for parameters in ({}, {"offset": [offset]}):
            disc = replace(disc, offset=offset)
            found = simulate_ensemble(disc, start, duration=300.0, parameters=parameters)
            assert found.end[0] == EndState.SELF_CENTRED
            assert found.largest_radius[0] == pytest.approx(offset, rel=1e-4)


def ring(inertia, damping, friction, speed, offset, radius, shaft_damping, shaft_speed):
    return DiscOnDisc(
        mass=1.0, stiffness=1.0, polar_inertia=inertia, damping=damping, friction_force=friction, disc_speed=speed,
        offset=offset, contact_radius=radius, shaft_damping=shaft_damping, shaft_speed=shaft_speed,
    )  # fmt: skip


def ended(disc, start, duration=1000.0):
    """Return the end state without known neighbourhoods of end states."""
    return simulate_ensemble(disc, start, duration=duration, parameters={"mass": [1.0]})


def test_ring_that_comes_to_the_axis_ends_at_radius_zero():
    disc = ring(0.04472, 0.152, 0.06584, -1.385, 0.0, 0.3582, 0.09325, 0.7529)
    found = ended(disc, [0.1, 0.0, 0.0, 0.03, 0.0, 0.5])
    assert found.end[0] == EndState.SELF_CENTRED
    assert found.least_radius[0] == found.largest_radius[0] == 0.0
    # A ring that spins at the axis slips by R·(spin − ω) and has the full moment of friction, μN·R.
    most = disc.friction_force * disc.contact_radius
    slip = disc.disc_speed - disc.shaft_speed + most / disc.shaft_damping
    assert found.slip_power[0] == pytest.approx(most * abs(slip), rel=1e-3)


def test_ring_that_slips_briefly_in_each_turn_is_stuck_at_its_final_radius():
    disc = ring(0.8, 0.1511, 0.1354, -0.7539, 0.01847, 0.05522, 0.003907, -0.4767)
    found = ended(disc, stuck_state(disc, 0.27, 0.0))
    assert found.end[0] == EndState.STUCK
    limit = found.largest_radius[0]
    assert limit == pytest.approx(sticking_radius(held_pin(disc)), rel=1e-12)
    turns = 10.0 * 2.0 * math.pi / abs(disc.disc_speed)
    left = simulate(disc, found.states[0], [0.0, turns, 4.0 * turns], compiled=True).radius - limit
    # The remaining distance falls like 1/turns.
    assert np.diff(1.0 / left) == pytest.approx(
        [1.0 / left[1] - 1.0 / left[0]] * np.array([1.0, 3.0]), rel=0.1
    )


def test_largest_radius_of_a_stick_slip_cycle_occurs_at_the_start_of_slip():
    disc = ring(0.0747428, 1.63329, 0.0985983, -1.502217, 0.0964475, 0.9644915, 0.00126935, 0.6208175)
    found = ended(disc, [0.4, 0.1, 0.0, 0.0, 0.0, 0.0])
    assert found.end[0] == EndState.STICK_SLIP
    radius = simulate(disc, found.states[0], np.linspace(0.0, 5.0, 2001), compiled=True).radius
    assert found.least_radius[0] == pytest.approx(radius.min(), rel=1e-4)
    assert found.largest_radius[0] == pytest.approx(radius.max(), rel=1e-4)
