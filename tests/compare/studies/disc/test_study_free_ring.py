"""The study of the free ring agrees for every sound engine and fails for each broken one."""

import functools
import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from studies_under_test import sentences, verdicts

from compare.claims.claim import Verdict
from compare.engines import EVERY_KIND, Engine, engines
from compare.studies.disc.free_ring import claims as study
from compare.studies.disc.free_ring.theory import EXISTS, PUBLISHED, approach_constant, deviation
from compare.studies.toolkit.free_bodies import Slowing
from reference_model import simulate
from reference_model.contact.contact_law import ThreeTermRing
from reference_model.contact.elliptic import mean_directions
from reference_model.trajectory import Phase, Solution, Trajectory

FEW = {
    "rings": study.RINGS[1:3],
    "others": study.OTHERS[::5],
    "integrated": (study.RINGS[1], study.OTHERS[0]),
    "lopsided": study.LOPSIDED[1:3],
}
ALL = {
    study.TOGETHER,
    study.RATIO_ONE,
    study.APPROACH,
    study.RATIO_OTHER,
    study.LOPSIDED_POWERS,
    study.STOP,
    study.EXACT,
    study.HEAT,
}


@functools.cache
def measured(name):
    """Measure a part of the study with a registered engine, once for all tests."""
    return study.measure(engines([name])[0], **FEW)


def uncoupled(system, state, times, *, tolerance=1e-9):
    """Brake sliding and spinning each as if the other were not there, on a table at rest."""
    times = np.asarray(times)
    position, velocity = state[:2], state[3:5]
    speed, spin = np.hypot(*velocity), state[5]
    stops = np.maximum(
        (
            system.mass * speed / system.friction_force,
            system.polar_inertia * abs(spin) / (system.friction_force * system.contact_radius),
        ),
        1e-300,  # what does not move stops at once
    )
    left = [np.maximum(1.0 - times / stop, 0.0)[:, np.newaxis] for stop in stops]
    ways = [0.5 * stop * (1.0 - share**2) for stop, share in zip(stops, left, strict=True)]
    states = np.hstack(
        (position + ways[0] * velocity, state[2] + ways[1] * spin, left[0] * velocity, left[1] * spin)
    )
    rest = min(max(stops), times[-1])
    phases = (Phase("slip", times[0], rest, states[0]), Phase("stick", rest, times[-1], states[-1]))
    return Trajectory(system, times, states, phases, Solution("closed form", tolerance, 0, 0, 0.0))


def other_system(change):
    """Return an engine that simulates ``change(system)`` in place of the system."""

    def simulated(system, state, times, *, tolerance=1e-9):
        return simulate(change(system), state, times, tolerance=tolerance)

    return Engine("broken", simulated, EVERY_KIND)


def other_law(contact):
    """Return an engine with the law ``contact(radius)`` in place of the ring's."""

    def simulated(system, state, times, *, tolerance=1e-9):
        return simulate(system, state, times, tolerance=tolerance, contact=contact(system.contact_radius))

    return Engine("broken", simulated, EVERY_KIND)


BROKEN = {
    "a thousandth more friction": other_system(
        lambda disc: replace(disc, friction_force=1.001 * disc.friction_force)
    ),
    "a thousandth more inertia": other_system(
        lambda disc: replace(disc, polar_inertia=1.001 * disc.polar_inertia)
    ),
    "the expansion (23) for the ring": other_law(ThreeTermRing),
    "sliding and spinning braked each by itself": Engine("broken", uncoupled, EVERY_KIND),
    "twelve points for the ring": other_system(lambda disc: replace(disc, contact_points=12)),
}


@pytest.mark.parametrize("name", ["reference", "exudyn"])
def test_every_statement_holds_in_a_sound_engine(name):
    assert verdicts(measured(name)) == dict.fromkeys(ALL, Verdict.AGREES)


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # of the ratio of no motion
@pytest.mark.parametrize(
    ("fault", "seen"),
    [
        # The ratio does not depend on the friction force, only the time that it takes does.
        ("a thousandth more friction", {study.STOP, study.EXACT, study.HEAT}),
        ("a thousandth more inertia", {study.STOP, study.EXACT, study.HEAT}),
        # An expansion without infinite slope comes to the ratio 1 like a power.
        ("the expansion (23) for the ring", {study.RATIO_ONE, study.APPROACH, study.STOP, study.HEAT}),
        (
            "sliding and spinning braked each by itself",
            ALL - {study.EXACT},
        ),
        ("twelve points for the ring", {study.APPROACH, study.STOP, study.HEAT}),
    ],
)
def test_a_broken_engine_is_found_out(fault, seen):
    assert seen <= sentences(study.measure(BROKEN[fault], **FEW), Verdict.DIFFERS)


def test_the_theory_holds():
    assert verdicts(study.theory()) == {EXISTS: Verdict.AGREES, PUBLISHED: Verdict.AGREES}


@pytest.mark.parametrize(("inertia", "sliding", "rim"), [(1.0, 1.0, 0.3), (0.7, 0.2, 1.0), (1.4, 1.0, 0.2)])
def test_the_integrals_are_those_of_the_motion_in_time(inertia, sliding, rim):
    """Also across the ratio 1, where the slopes of friction are infinite."""
    rest = Slowing(inertia).stop(sliding, rim)

    def rates(_, y):
        along_slip, along_rim = mean_directions(y[0], y[1])
        return -along_slip, -along_rim / inertia, y[0], y[1]

    share = 1e-6  # of the time, that is left out
    end = rest.time * (1.0 - share)
    y = solve_ivp(rates, (0.0, end), (sliding, rim, 0.0, 0.0), rtol=1e-11, atol=1e-13, method="DOP853").y[
        :, -1
    ]
    assert y[0] == pytest.approx(math.exp(Slowing(inertia).terminal) * y[1], rel=1e-4)
    assert y[2:] == pytest.approx([rest.slid, rest.turned], abs=1e-9)
    _, along_rim = mean_directions(y[0], y[1])
    assert y[1] * inertia / along_rim == pytest.approx(share * rest.time, rel=1e-3)


def test_the_terminal_ratio_of_a_ring_is_one_and_symmetric_in_both_motions():
    assert Slowing(1.0).terminal == 0.0
    for inertia in (0.55, 0.8, 1.7):
        assert Slowing(inertia).terminal == pytest.approx(-Slowing(1.0 / inertia).terminal, abs=1e-13)


@pytest.mark.parametrize("limit", [0.5, 2.0])
def test_the_terminal_ratio_leaves_all_bounds_at_the_limits(limit):
    inside = [abs(Slowing(limit + (1.0 - limit) * share).terminal) for share in (1e-1, 1e-3, 1e-5)]
    assert inside[0] < inside[1] < inside[2]
    assert inside[2] > 4.0


def test_the_constant_of_the_approach_does_not_depend_on_where_it_is_taken():
    far, near = (approach_constant(1.0, 0.1, near) for near in (1e-4, 1e-7))
    assert far == pytest.approx(near, rel=1e-7)
    assert deviation(near / 0.001) < 1e-9


def test_the_exact_throws_know_both_formulas():
    claim = next(claim for claim in measured("reference").claims if claim.sentence == study.EXACT)
    g, v, radius = 0.1, 0.3, 0.12
    assert claim.predicted[:, 0] == pytest.approx([v / g, v / g, v / g, 2.5 * v / g])
    assert np.hypot(*claim.predicted[0, 1:3]) == pytest.approx(0.5 * v**2 / g)
    assert claim.predicted[3, 3] == pytest.approx(-0.5 * 2.5 * (v**2 / g) / radius)


def test_figures_are_drawn_whatever_is_there():
    data = {"reference": measured("reference").data, "theory": study.theory().data}
    assert set(study.draw(data)) == set(study.STUDY.figures)
    assert study.draw({}) == {}
    for part in ({"theory": data["theory"]}, {"reference": data["reference"]}):
        assert set(study.draw(part)) == set(study.STUDY.figures)
