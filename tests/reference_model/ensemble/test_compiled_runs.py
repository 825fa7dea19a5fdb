"""Motions and phases of compiled runs and ensembles, against the plain reference and closed forms."""

import cmath
import functools
from dataclasses import replace

import numpy as np
import pytest
from plain_engines import as_disc, stuck_state
from random_systems import SYSTEMS, TIMES, RandomMotion, random_points

from compare.claims.parameters import FIG5, FIG5_STARTS, FIG8, FIG9, FIG11
from reference_model import Annulus, DiscOnDisc, PinOnDisc, PointsOnRing, simulate
from reference_model.ensemble import EndState, simulate_ensemble

SECOND = list(FIG5_STARTS.values())[1]
"""A start with nine stick phases."""

HARD = replace(FIG9, friction_force=2.0 * FIG9.friction_force)

MOST_TOLERANCES = 13.0
"""Largest error of a compiled run in tolerances, which the documentation of ``simulate`` states."""


def on_six(disc):
    return replace(disc, contact_points=6)


def lasting(motion):
    """Return the phases of nonzero length; the reference has empty slip phases before pivots."""
    return [phase for phase in motion.phases if phase.end - phase.start > 1e-12 * motion.times[-1]]


SEEDS = range(0, SYSTEMS, 2)


@functools.cache
def compiled_run(seed):
    random = RandomMotion.of(seed)
    return simulate(random.system, random.start, TIMES - 7.0, compiled=True)


def test_random_systems_take_little_work():
    """The bound is 5 % above the measured 8,218 steps; a method of lower order would take more."""
    assert sum(compiled_run(seed).solution.steps for seed in SEEDS) < 8_630


@pytest.mark.parametrize("seed", SEEDS)
def test_motions_and_phases_of_random_systems_agree_with_the_reference(seed):
    found = compiled_run(seed)
    start, times = RandomMotion.of(seed).start, found.times
    plain = simulate(found.system, start, times, tolerance=1e-11)
    allowed = 1e-9 * MOST_TOLERANCES
    assert np.abs(found.states - plain.states).max() < allowed
    assert found.states[0].tolist() == start.tolist()
    assert (found.phases[0].start, found.phases[-1].end) == (times[0], times[-1])
    assert [phase.kind for phase in found.phases] == [phase.kind for phase in lasting(plain)]
    for mine, other in zip(found.phases, lasting(plain), strict=True):
        assert (mine.start, mine.end) == pytest.approx((other.start, other.end), abs=allowed)
        np.testing.assert_allclose(mine.initial_state, other.initial_state, atol=allowed)


@pytest.mark.parametrize(
    ("system", "start"), [(FIG5, SECOND), (on_six(FIG9), stuck_state(FIG9, -0.02, 0.0))], ids=["pin", "six points"]
)  # fmt: skip
def test_each_parameter_set_of_an_ensemble_moves_as_alone(system, start):
    rng = np.random.default_rng(2)
    varied = {"friction_force": rng.uniform(0.05, 0.15, 6), "offset": rng.uniform(-0.1, 0.2, 6)}
    together = simulate_ensemble(system, start, duration=20.0, parameters=varied, early_end=False)
    for i, (load, offset) in enumerate(zip(*varied.values(), strict=True)):
        one = replace(system, friction_force=float(load), offset=float(offset))
        alone = simulate_ensemble(one, start, duration=20.0, early_end=False)
        np.testing.assert_array_equal(together.states[i], alone.states[0])


def test_ensemble_of_points_moves_as_alone():
    system, start = on_six(FIG11), [0.1, 0.0, 0.0, 0.0, 0.0, 1.0]
    found = simulate(system, start, [0.0, 37.3], tolerance=1e-8, compiled=True)
    alone, two = (
        simulate_ensemble(system, starts, duration=37.3, tolerance=1e-8, early_end=False)
        for starts in (start, [start, start])
    )
    assert alone.steps[0] == two.steps[1]
    np.testing.assert_array_equal(alone.states[0], two.states[1])
    assert np.max(np.abs(found.at_end - alone.states[0])) < 1e-8


def test_run_with_a_single_time_has_its_first_phase():
    stuck = simulate(HARD, stuck_state(HARD, -0.02, 0.0), [3.0], compiled=True)
    assert [(phase.kind, phase.start, phase.end) for phase in stuck.phases] == [("stick", 3.0, 3.0)]
    assert simulate(FIG5, SECOND, [3.0], compiled=True).phases[0].kind == "slip"


LIGHT = DiscOnDisc(
    mass=1e-6, polar_inertia=0.02, stiffness=1.0, damping=1e6, friction_force=0.1, disc_speed=0.5,
    contact_radius=1e3, shaft_damping=0.0, shaft_speed=0.0,
)  # fmt: skip


def test_light_disc_with_a_strong_damper_moves_by_the_balance_of_forces_at_any_requested_time():
    times = np.linspace(0.0, 50.0, 1001)
    found = simulate(LIGHT, [0.5, 0.0, 0.0, 0.0, 0.0, 0.5], times, compiled=True)
    assert found.solution.steps < 5000
    # Starting again with a first step after each requested time would take about 600 evaluations.
    assert found.solution.evaluations - 12 * found.solution.steps < 20 * len(times)
    # β·v = −C·z + μN·i·z/|z| to first order in C/β and μN/β, because the slip is that of the master disc.
    z = 0.5 * np.exp(-50e-6) * np.exp(1j * 0.1 / 0.5 * 50e-6)
    assert complex(*found.at_end[:2]) == pytest.approx(z, abs=1e-9)


def test_random_pins_with_parameters_over_four_decades_take_a_bounded_number_of_steps():
    rng = np.random.default_rng(13)
    for _ in range(30):
        m, stiffness, damping, friction, speed, offset, size = 10.0 ** rng.uniform(-2.0, 2.0, 7)
        pin = PinOnDisc(
            mass=m, stiffness=stiffness, damping=damping, friction_force=friction,
            disc_speed=speed * rng.choice((-1.0, 1.0)), offset=offset * rng.choice((0.0, 1.0)),
        )  # fmt: skip
        k = pin.natural_frequency
        start = size * rng.normal(size=4) * np.array([1.0, 1.0, k, k])
        found = simulate(pin, start, [0.0, 50.0 * 2.0 * np.pi / k], compiled=True)
        assert found.solution.steps < 400_000


def test_creeping_ring_at_the_tightest_tolerance_comes_to_rest():
    """Slip at the level of rounding must not be extrapolated by the closed form of coming to rest."""
    disc = DiscOnDisc(
        mass=1.0, polar_inertia=0.022142264315993105, stiffness=1.0, damping=7.606038494632967, shaft_damping=0.0,
        friction_force=0.013290975255736146, disc_speed=0.26217015225390883, shaft_speed=0.06502856857572112,
        contact_radius=6.118735000726501, offset=0.0,
    )  # fmt: skip
    start = [1.19260846e-01, -5.32574504e-03, -1.80470287e-03, 8.97937173e-02, -8.01634282e-04, 5.81735776e01]
    found = simulate(disc, start, [0.0, 200.0, 300.0], tolerance=1e-12, compiled=True)
    place = (found.states[:, 0] + 1j * found.states[:, 1]) * np.exp(-1j * disc.disc_speed * found.times)
    assert abs(place[2] - place[1]) < 1e-11  # 2e-14 m/s for about 8 s


@pytest.mark.parametrize("seed", range(SYSTEMS))
def test_random_systems_move_in_an_ensemble_as_alone(seed):
    """Lanes know linear supports, and the core all; a seed has each kind of contact, support and course."""
    random = RandomMotion.of(seed)
    found = simulate_ensemble(random.system, random.start, duration=TIMES[-1], early_end=False)
    alone = simulate(random.system, random.start, [0.0, TIMES[-1]], tolerance=1e-11, compiled=True)
    assert found.time[0] == TIMES[-1]
    assert np.abs(found.states[0] - alone.at_end).max() < 1e-9 * MOST_TOLERANCES


@pytest.mark.parametrize("seed", [1, 4, 7, 10, 13, 16])
@pytest.mark.parametrize("kind", ["annulus", "unequal points", "thirty points"])
def test_discs_with_any_contact_move_in_an_ensemble_as_alone(kind, seed):
    random = RandomMotion.of(seed)
    contact = {
        "annulus": Annulus(0.07, 0.15), "unequal points": random_points(seed), "thirty points": PointsOnRing(0.1, 30),
    }[kind]  # fmt: skip
    found = simulate_ensemble(
        random.system, random.start, duration=TIMES[-1], contact=contact, early_end=False
    )
    alone = simulate(
        random.system, random.start, [0.0, TIMES[-1]], tolerance=1e-11, contact=contact, compiled=True
    )
    assert found.time[0] == TIMES[-1]
    assert np.abs(found.states[0] - alone.at_end).max() < 1e-9 * MOST_TOLERANCES


@pytest.mark.parametrize(
    ("system", "duration"),
    [
        (FIG5, 400.0), (replace(FIG5, damping=1.173, friction_force=0.658, disc_speed=1.8, offset=-0.42), 400.0),
        (replace(FIG5, friction_force=0.3, disc_speed=0.6), 400.0), (FIG8, 2000.0), (FIG11, 3000.0),
    ],
    ids=["Fig. 5", "stick and slip", "sticks", "Fig. 8", "Fig. 11"],
)  # fmt: skip
def test_the_core_finds_the_ends_that_lanes_find(system, duration):
    """A negligible hardening leaves all steps to the core."""
    starts = np.random.default_rng(5).uniform(-0.4, 0.4, (12, system.state_size))
    lanes = simulate_ensemble(system, starts, duration=duration)
    core = simulate_ensemble(replace(system, hardening=1e-12), starts, duration=duration)
    decided = (lanes.end != EndState.UNDECIDED) & (core.end != EndState.UNDECIDED)
    assert decided.mean() > 0.7
    np.testing.assert_array_equal(core.end[decided], lanes.end[decided])
    for name in ("least_radius", "largest_radius", "slip_power"):
        np.testing.assert_allclose(
            getattr(core, name)[decided], getattr(lanes, name)[decided], rtol=1e-3, atol=1e-6
        )


@pytest.mark.parametrize("body", ["pin", "ring", "three points"])
@pytest.mark.parametrize("excess", [1e-11, 1e-6, 1e-4, 3e-3])
def test_body_whose_pull_exceeds_friction_by_a_hair_moves_in_an_ensemble_as_alone(excess, body):
    omega, place, offset, damping = 0.5, 0.3 * cmath.exp(5.5j), 1.0, 0.1
    pull = abs(offset + complex(omega**2 - 1.0, -damping * omega) * place)
    pin = PinOnDisc(
        mass=1.0, stiffness=1.0, damping=damping, friction_force=pull / (1.0 + excess), disc_speed=omega,
        offset=offset,
    )  # fmt: skip
    system = pin if body == "pin" else as_disc(pin, {"ring": None, "three points": 3}[body])
    start = stuck_state(system, place.real, place.imag)
    found = simulate_ensemble(system, start, duration=5.0, early_end=False)
    assert np.abs(found.states[0] - simulate(system, start, [0.0, 5.0]).at_end).max() < 1e-9
