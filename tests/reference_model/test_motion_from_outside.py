"""Motions of every kind, without knowledge of how they are computed.

The motion must be the limit of motions with smooth friction, have the symmetries of the equations, lose energy, and
converge with the tolerance.
"""

import cmath
import functools
from dataclasses import replace

import numpy as np
import pytest
from plain_engines import in_units
from random_systems import TIMES, RandomMotion, smooth_motion

from reference_model import Annulus, power_balance, simulate

KINDS = ("pin", "ring", "points", "annulus")
SUPPORTS = ("linear", "hardening", "stop", "both")
EPSILON = 1e-6
"""Coarser of two slip speeds of smooth friction in m/s; the finer is a quarter of it."""

OF_ALL_STEPS = 30.0
"""Error bound in tolerances. Each of some hundreds of steps may be off by 0.05, and most errors decay."""

of_each_kind = pytest.mark.parametrize(
    ("kind", "support"), [(kind, support) for kind in KINDS for support in SUPPORTS]
)


def motion_of(kind, support, course):
    """Return a random system, its start and the options of ``simulate``."""
    contact = {"pin": 0, "ring": 1, "points": 2, "annulus": 1}[kind]
    random = RandomMotion.of(contact + 3 * SUPPORTS.index(support) + 12 * course)
    return random.system, random.start, options(kind, random.system)


def options(kind, system):
    if kind != "annulus":
        return {}
    return {"contact": Annulus(0.5 * system.contact_radius, system.contact_radius)}


@functools.cache
def smooth(kind, support, course, epsilon):
    system, start, chosen = motion_of(kind, support, course)
    return smooth_motion(system, start, epsilon, chosen.get("contact"))


@of_each_kind
def test_motion_is_the_limit_of_motions_with_smooth_friction(kind, support):
    # The integral over an annulus is expensive.
    for course in range(1 if kind == "annulus" else 5):
        system, start, chosen = motion_of(kind, support, course)
        found = simulate(system, start, TIMES, **chosen).states
        coarse, fine = (smooth(kind, support, course, EPSILON * share) for share in (1.0, 0.25))
        limit = fine + (fine - coarse) / 3.0
        # In stick the error is linear in ε, after a release of order ε^0.8, and in slip of order ε². For orders from
        # 0.7 to infinity the limit is off by at most a third of the change.
        change = np.abs(fine - coarse).max()
        assert np.abs(limit - found).max() < change / 3.0 + OF_ALL_STEPS * 1e-9


@of_each_kind
def test_motion_on_a_centred_support_turns_with_its_start(kind, support):
    turn = 0.7
    system, start, chosen = motion_of(kind, support, 0)
    system = replace(system, offset=0.0)
    straight, turned = (
        simulate(system, state, TIMES, **chosen).states for state in (start, turned_by(turn, start))
    )
    error = np.abs(np.array([turned_by(turn, state) for state in straight]) - turned).max()
    assert error < OF_ALL_STEPS * 1e-9


def turned_by(turn, state):
    """Return a state turned about the origin."""
    half, result = len(state) // 2, np.array(state)
    for x in (0, half):
        z = complex(*state[x : x + 2]) * cmath.exp(1j * turn)
        result[x : x + 2] = z.real, z.imag
    if half == 3:
        result[2] += turn
    return result


@of_each_kind
def test_motion_does_not_depend_on_the_units(kind, support):
    mass, length, time = 400.0, 1e-3, 30.0
    system, start, chosen = motion_of(kind, support, 1)
    half = len(start) // 2
    units = np.array([length, length, 1.0][:half] + [length / time, length / time, 1.0 / time][:half])
    other = in_units(system, mass, length, time)
    found = simulate(other, start * units, TIMES * time, **options(kind, other)).states
    expected = simulate(system, start, TIMES, **chosen).states
    assert np.abs(found / units - expected).max() < OF_ALL_STEPS * 1e-9


@of_each_kind
def test_error_falls_in_proportion_to_the_tolerance(kind, support):
    system, start, chosen = motion_of(kind, support, 0)
    tight, *others = (
        simulate(system, start, TIMES, tolerance=tolerance, **chosen).states
        for tolerance in (1e-11, 1e-5, 1e-8)
    )
    for tolerance, states in zip((1e-5, 1e-8), others, strict=True):
        assert np.abs(states - tight).max() < OF_ALL_STEPS * tolerance


@of_each_kind
def test_friction_and_dampers_only_dissipate(kind, support):
    system, start, chosen = motion_of(kind, support, 0)
    fine = simulate(system, start, np.linspace(0.0, 25.0, 2001), **chosen)
    balance = power_balance(fine, **chosen)
    # An error of 1 % in any force exceeds 1e-3. Kinks of the rates between two samples cause less than 1e-4.
    assert np.abs(balance.residual).max() < 1e-4 * balance.turned_over
    assert np.diff(balance.friction_heat).min() > -1e-6 * balance.turned_over
    assert np.diff(balance.damper_heat).min() > -1e-6 * balance.turned_over
