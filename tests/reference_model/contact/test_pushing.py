"""Pushed bodies: closed forms, Mason's voting theorem, and the laws of friction for random pushes."""

import cmath
import math

import numpy as np
import pytest

from reference_model.contact import Points, largest_wrench, polygon_patch, wrench_of_slip
from reference_model.contact.pushing import Pushing

HALF = 0.05
TWO_FEET = Points([(-HALF, 0.0, 0.5), (HALF, 0.0, 0.5)])

ROUGH = 1e9
"""Coefficient of a hand that always sticks."""


def random_push(seed):
    """Return a pushing with a random contact, the hand and its velocity, which points into the body."""
    draw = np.random.default_rng(seed)
    places = draw.normal(0.0, 0.05, (3 + seed % 4, 2))
    shares = draw.dirichlet(np.ones(len(places)))
    contact = Points(np.column_stack((places, shares)).tolist())
    hand, normal = complex(*draw.normal(0.0, 0.1, 2)), cmath.rect(1.0, draw.uniform(-3.0, 3.0))
    velocity = normal * cmath.rect(0.01, draw.uniform(-1.5, 1.5))
    return Pushing(contact, hand, normal, draw.uniform(0.0, 1.0)), hand, velocity


def centre(contact):
    return contact.shares @ np.array(contact.arms(0.0))


RANDOM = pytest.mark.parametrize("seed", range(20))


@RANDOM
def test_the_sense_of_the_turn_is_voted_by_the_velocity_and_both_sides_of_the_cone(seed):
    """M. T. Mason, International Journal of Robotics Research 5 (1986) 53-71."""
    pushing, hand, velocity = random_push(seed)
    cone = math.atan(pushing.friction_coefficient)
    rays = [velocity, *(pushing.normal * cmath.exp(1j * side * cone) for side in (-1.0, 1.0))]
    votes = [np.sign(((hand - centre(pushing.contact)).conjugate() * ray).imag) for ray in rays]
    _, spin = pushing.motion(hand, velocity)
    assert np.sign(spin) == np.sign(sum(votes))


@RANDOM
def test_a_force_in_the_cone_of_the_hand_drives_the_motion(seed):
    """The power of the largest such force equals that of friction, so it is held and the motion is normal to it."""
    pushing, hand, velocity = random_push(seed)
    position, angle = 0.3 - 0.2j, 0.7
    turn = cmath.exp(1j * angle)
    slip, spin = pushing.motion(position + turn * hand, turn * velocity, position, angle)
    slip /= turn
    sliding = (velocity - slip - 1j * spin * hand) / pushing.normal
    assert sliding.real == pytest.approx(0.0, abs=1e-12)
    cone = math.atan(pushing.friction_coefficient)
    lean = math.copysign(cone, sliding.imag)
    if abs(sliding) < 1e-12:
        lean = cmath.phase(wrench_of_slip(pushing.contact, slip, spin)[0] / pushing.normal)
        assert abs(lean) <= cone
    direction = pushing.normal * cmath.rect(1.0, lean)
    force, moment = largest_wrench(pushing.contact, direction, (hand.conjugate() * direction).imag)
    slips = slip + 1j * spin * np.array(pushing.contact.arms(0.0))
    power = (force.conjugate() * slip).real + moment * spin
    assert power == pytest.approx(pushing.contact.shares @ abs(slips), rel=1e-9)


@pytest.mark.parametrize("friction", [0.0, 0.4])
@pytest.mark.parametrize("contact", [polygon_patch([(0.0, 0.0), (0.1, 0.0), (0.0, 0.1)], 4), TWO_FEET])
def test_a_push_through_the_centre_of_friction_moves_the_body_straight(contact, friction):
    start = complex(centre(contact)) - 0.06j
    position, angle = Pushing(contact, start + 0.01j, 2j, friction).pose(start, start + 0.03j)
    assert position == pytest.approx(0.02j, abs=1e-10)
    assert angle == pytest.approx(0.0, abs=1e-8)


@pytest.mark.parametrize("x", [0.002, 0.03, HALF])
def test_a_push_beside_the_centre_turns_a_body_about_its_far_foot(x):
    """The other foot rests, and the hand has no friction."""
    position, angle = Pushing(TWO_FEET, 0j, 1j, 0.0).pose(x - 0.001j, x + 0.02j, steps=50)
    assert angle == pytest.approx(math.atan(0.02 / (x + HALF)), rel=1e-4)
    assert position - HALF * cmath.exp(1j * angle) == pytest.approx(-HALF, abs=1e-5)


def test_a_foot_that_sticks_to_the_hand_draws_the_other_along_a_tractrix():
    """The other foot slips towards or away from the hand, so tan(φ/2) grows like exp(s/L)."""
    start, way, touched = 0.4, 0.03, 0.004

    def error(steps):
        # At the angle ``start`` to the line from the hand to the other foot.
        along = cmath.exp(1j * (math.pi + start))
        pushing = Pushing(TWO_FEET, HALF, along, ROUGH)
        _, angle = pushing.pose(HALF - touched * along, HALF + way * along, steps)
        return start - angle - 2.0 * math.atan(math.tan(start / 2.0) * math.exp(way / (2.0 * HALF)))

    assert error(32) == pytest.approx(0.0, abs=1e-5)
    assert error(4) / error(8) == pytest.approx(4.0, rel=0.1)


def test_a_hand_that_moves_away_leaves_the_body():
    pushing = Pushing(TWO_FEET, 0j, 1j, 0.3)
    for end in (0.02 - 0.001j, 0.03 - 0.01j, 0.01 - 0.0001j):
        assert pushing.pose(0.01 - 0.001j, end) == (0.0, 0.0)


def push(normal=1j, friction=0.1):
    return Pushing(TWO_FEET, 0j, normal, friction)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: push(normal=0j), "normal = 0: it must point into the body"),
        (lambda: push(normal=1j * math.inf), "normal = .*: it must be finite"),
        (lambda: push(normal="1j"), "normal = '1j': it must be a number"),
        (lambda: Pushing([], 0j, 1j, 0.1), r"contact = \[\]: it must be a Points"),
        (lambda: push(friction=-0.1), "friction_coefficient = -0.1: it must be >= 0"),
        (lambda: push().pose(0.01j, 0.02j), "start = 0.01j: the hand must start outside"),
        (lambda: push().pose(0j, 0.02j, 0), "steps = 0"),
    ],
)
def test_invalid_numbers_are_refused(call, message):
    with pytest.raises(ValueError, match=message):
        call()
