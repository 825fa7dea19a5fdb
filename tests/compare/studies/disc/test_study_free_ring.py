"""The study of the free ring: what its claims see, and that its integrals are those of the motion in time."""

import math
from dataclasses import replace

import numpy as np
import pytest
from faults.reference import simulate
from scipy.integrate import solve_ivp
from study_harness import LEFT_OUT, SEES, StudyTests

from compare.engines import EVERY_KIND, Engine
from compare.studies.disc.free_ring.study import STUDY, other_ratios, powers
from compare.studies.disc.free_ring.theory import LOPSIDED, OTHERS, RINGS, approach_constant, deviation
from compare.studies.toolkit.free_bodies import Slowing
from reference_model.contact.contact_law import ThreeTermRing
from reference_model.contact.elliptic import mean_directions
from reference_model.trajectory import Phase, Solution, Trajectory


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


class TestFreeRing(StudyTests):
    study = STUDY
    sound = ("reference", "exudyn")
    few = {
        "end_together": {"throws": (*RINGS[1:3], *OTHERS[::3])},
        "ratio_one": {"throws": RINGS[1:3]},
        "approach": {"throws": RINGS[1:3]},
        "other_ratios": {"throws": OTHERS[::3]},
        "powers": {"throws": LOPSIDED[1:3]},
        "stops": {"throws": (RINGS[1], OTHERS[0])},
        "heat": {"throws": RINGS[1:3]},
    }
    faults = {
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
    columns = (
        "end_together",
        "ratio_one",
        "approach",
        "other_ratios",
        "powers",
        "stops",
        "heat",
    )
    table = {
        # The ratio does not depend on the friction force, only the time that it takes does.
        "a thousandth more friction": (*[LEFT_OUT] * 5, SEES, SEES),
        "a thousandth more inertia": (*[LEFT_OUT] * 5, SEES, SEES),
        # An expansion without infinite slope comes to the ratio 1 like a power.
        "the expansion (23) for the ring": (LEFT_OUT, SEES, SEES, LEFT_OUT, LEFT_OUT, SEES, SEES),
        "sliding and spinning braked each by itself": (*[SEES] * 7,),
        "twelve points for the ring": (*[LEFT_OUT] * 2, SEES, *[LEFT_OUT] * 2, SEES, SEES),
    }

    @pytest.mark.filterwarnings("ignore::RuntimeWarning")  # of the ratio of no motion
    def test_each_claim_sees_the_faults_that_concern_it(self, fault, claim, expected):
        super().test_each_claim_sees_the_faults_that_concern_it(fault, claim, expected)

    def test_nothing_is_drawn_of_nothing(self):
        assert STUDY.draw({}) == {}


@pytest.mark.parametrize(("claim", "throws"), [(other_ratios, OTHERS[::3]), (powers, LOPSIDED[1:3])])
def test_error_of_the_time_to_rest_is_within_the_estimates_of_claims_that_sample_by_it(claim, throws):
    def simulated(system, state, times, *, tolerance=1e-9):
        later = replace(system, friction_force=(1.0 - 1e5 * tolerance) * system.friction_force)
        return simulate(later, state, times, tolerance=tolerance)

    measured = claim(Engine("late", simulated, EVERY_KIND), throws)
    off = np.abs(np.subtract(measured.value, measured.predicted))
    assert np.all(off <= np.add(measured.error, measured.model))


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
