"""All steady motions of the disc, against the equations of motion, a dense search and limiting cases."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from disc_equations import FIG_9, eq_23
from scipy.optimize import brentq
from scipy.special import ellipe, ellipkm1

from compare.claims.parameters import FIG8, FIG11
from reference_model.contact.annulus import Annulus
from reference_model.contact.contact_law import Ring, ThreeTermRing
from reference_model.formulas.disc import held_pin, pin_of, shaft_torque
from reference_model.steady.stability import onset_load
from reference_model.steady.steady_states import (
    self_centred_equilibria,
    smallest_load_with_whirl,
    whirls,
    why_no_equilibrium,
    why_no_whirl,
)
from reference_model.systems import DiscOnDisc

LAWS = [Ring, ThreeTermRing]


def whirling(gain, load=1.0):
    """Return a disc with b(|ω| − k)/(βkR) = ``gain``·R, R = 1 and b|ω − Ω| = 1."""
    return DiscOnDisc(
        mass=1.0, polar_inertia=1.0, stiffness=1.0, damping=1.0 / gain, friction_force=load, disc_speed=2.0,
        contact_radius=1.0, shaft_damping=1.0, shaft_speed=1.0,
    )  # fmt: skip


def friction_at(disc, law, slip, spin):
    """Return force in N and moment in N m, for arrays of slip and relative spin, by (23) or elliptic integrals."""
    if law is ThreeTermRing:
        force, _, moment = eq_23(disc)(slip, 0.0, spin, 0.0)
        return -force, moment
    rim = disc.contact_radius * spin
    total, difference = slip + rim, slip - rim
    complement = (difference / total) ** 2
    E, K = ellipe(1.0 - complement), ellipkm1(complement)
    force = (total * E + difference * K) / (np.pi * slip)
    moment = disc.contact_radius * (total * E - difference * K) / (np.pi * rim)
    return disc.friction_force * force, disc.friction_force * moment


def friction_by_slip(disc, law, slip):
    """Return the force at given slips by bisection of the torque balance, because b|ω − Ω| − bS falls and M grows."""
    low, high = np.zeros_like(slip), np.full_like(slip, abs(disc.disc_speed - disc.shaft_speed))
    for _ in range(50):
        middle = 0.5 * (low + high)
        too_fast = disc.shaft_damping * middle + friction_at(disc, law, slip, middle)[1] > shaft_torque(disc)
        low, high = np.where(too_fast, low, middle), np.where(too_fast, middle, high)
    return friction_at(disc, law, slip, 0.5 * (low + high))[0]


def pull(disc, d):
    return (
        disc.stiffness * d + disc.hardening * d**3 + disc.stop_stiffness * np.maximum(d - disc.stop_gap, 0.0)
    )


def brackets_of_radii(disc, law, whirl):
    """Return pairs of neighbouring radii between which the balance of forces changes sign, from 1e-4 of the largest
    radius on, where the plain form of the law is accurate.
    """
    speed, k = abs(disc.disc_speed), disc.natural_frequency
    largest = disc.friction_force / (disc.damping * k) if whirl else abs(disc.offset)
    radius = largest * np.concatenate(
        (np.geomspace(1e-4, 1e-2, 200), np.linspace(1e-2, 1.0 - 1e-9, 1500)[1:])
    )
    if whirl:
        turning = np.sqrt(pull(disc, radius) / (disc.mass * radius))
        slip = np.maximum(speed - turning, 1e-12 * speed) * radius
        excess = disc.damping * turning * radius - friction_by_slip(disc, law, slip)
    else:
        excess = friction_by_slip(disc, law, speed * radius) - pull(disc, np.sqrt(disc.offset**2 - radius**2))
    change = np.flatnonzero(np.diff(np.sign(excess)) != 0.0)
    return list(zip(radius[change], radius[change + 1], strict=True))


def random_disc(rng, whirl):
    def size(least, most):
        return 10.0 ** rng.uniform(math.log10(least), math.log10(most))

    k = size(0.3, 3.0)
    speed = rng.choice((-1.0, 1.0)) * k * (1.0 + size(0.01, 5.0) if whirl else size(0.1, 10.0))
    disc = DiscOnDisc(
        mass=1.0, polar_inertia=size(0.1, 10.0), stiffness=k**2, damping=size(0.01, 3.0), friction_force=1.0,
        disc_speed=speed, offset=0.0 if whirl else rng.choice((-1.0, 1.0)) * size(0.03, 3.0),
        contact_radius=size(0.1, 3.0), shaft_damping=size(0.01, 10.0), shaft_speed=speed + rng.uniform(-2.0, 2.0),
    )  # fmt: skip
    load = size(0.5, 1.6) * (smallest_load_with_whirl(disc) if whirl else disc.stiffness * abs(disc.offset))
    reach = load / (disc.damping * k) if whirl else abs(disc.offset)
    harder = {"hardening": size(0.01, 1.0) * (k / reach) ** 2, "stop_gap": size(0.1, 1.0) * reach}
    harder["stop_stiffness"] = size(0.1, 10.0) * k**2 * rng.integers(2)
    return replace(disc, friction_force=load, **(harder if rng.random() < 0.5 else {}))


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("whirl", [False, True])
def test_steady_motions_agree_with_a_dense_search_over_the_radius(whirl, law):
    """The dense search eliminates in another order: it computes the spin for each radius."""
    rng = np.random.default_rng(20)
    numbers = set()
    for _ in range(40):
        disc = random_disc(rng, whirl)
        find, why = (whirls, why_no_whirl) if whirl else (self_centred_equilibria, why_no_equilibrium)
        contact = law(disc.contact_radius)
        radii = sorted(math.hypot(*motion.state[:2]) for motion in find(disc, contact))
        left = list(radii)
        brackets = brackets_of_radii(disc, law, whirl)
        for low, high in brackets:
            inside = [radius for radius in left if low * (1.0 - 1e-9) <= radius <= high * (1.0 + 1e-9)]
            assert inside, f"{disc}: none of {radii} between {low} and {high}"
            left.remove(inside[0])
        assert len(left) % 2 == 0, f"{disc}: {left} outside {brackets}"  # pairs within one step of the search
        assert (why(disc, contact) is None) == bool(radii)
        numbers.add(len(radii))
    assert numbers >= ({0, 1, 2} if whirl else {0, 1})


@pytest.mark.parametrize(("gain", "width"), [(1.5, 9e-4), (1.12, 6e-10)])
def test_three_whirls_are_found_in_a_very_narrow_peak(gain, width):
    """For a gain just above 1, peak and dip are exponentially close to U = W and to each other."""
    distances = np.geomspace(1e-14, 0.1, 1500)
    ring = Ring(1.0)

    def arm(slip, rim):
        resistance, moment = ring.shares(slip, rim)
        return moment + gain * resistance * rim / slip

    peak = max(arm(1.0, 1.0 - d) for d in distances)
    dip = min(arm(1.0 - d, 1.0) for d in distances)
    assert peak - dip == pytest.approx(width, rel=0.1)
    for part, number in ((-0.5, 1), (0.3, 3), (0.7, 3), (1.5, 1)):
        disc = whirling(gain, 1.0 / (dip + part * (peak - dip)))
        assert len(whirls(disc)) == number


@pytest.mark.parametrize(("gain", "law"), [(5.0, Ring), (30.0, ThreeTermRing)])
def test_smallest_load_with_a_whirl_is_a_fold(gain, law):
    disc, contact = whirling(gain), law(1.0)
    load = smallest_load_with_whirl(disc, contact)
    assert load < onset_load(disc, contact)
    assert whirls(replace(disc, friction_force=load * (1.0 - 1e-12)), contact) == ()
    outer, inner = whirls(replace(disc, friction_force=load * (1.0 + 1e-10)), contact)
    assert 0.0 < outer.radius - inner.radius < 1e-3 * outer.radius
    # Apart from the phase, one eigenvalue is almost zero, with opposite signs for the two whirls.
    slow = [min(whirl.eigenvalues[1:], key=abs) for whirl in (outer, inner)]
    assert slow[0].real < 0.0 < slow[1].real
    assert max(map(abs, slow)) < 1e-3


@pytest.mark.parametrize(("law", "limit"), [(Ring, 4.0), (ThreeTermRing, 0.25)])
def test_whirl_grows_continuously_from_the_centred_rotation_below_a_limit_of_the_gain(law, limit):
    """The expansion of the arm at U = 0 is R + gain·R/2 − (R/4)(U/W)²·(1 − gain/limit)."""
    contact = law(1.0)
    for factor, jumps in ((0.98, False), (1.02, True)):
        disc = whirling(factor * limit)
        just_above = replace(disc, friction_force=onset_load(disc, contact) * (1.0 + 1e-7))
        # A continuous branch has a very small whirl just above the onset, and a jump has one just below.
        just_below = replace(disc, friction_force=onset_load(disc, contact) * (1.0 - 1e-7))
        small = [
            any(whirl.radius < 0.02 * (2.0 - whirl.spin) for whirl in whirls(system, contact))
            for system in (just_above, just_below)
        ]
        assert small == [not jumps, jumps]


NEIGHBOURS = 1.0 + np.finfo(float).eps * np.arange(-4, 5)
"""Factors within a few rounding errors of 1."""


def test_at_the_onset_there_is_no_whirl_of_zero_size():
    """Below the gain 2 the largest arm is the one of pure spin, 1 + gain/2, and the arm is flat nearby."""
    for gain in (2.0, 1.7, 0.1):
        for load in NEIGHBOURS / (1.0 + gain / 2.0):
            assert whirls(whirling(gain, float(load))) == ()


@pytest.mark.parametrize("gain", [0.1, 3.0])
def test_whirl_with_equal_slip_and_rim_speed_is_found_once(gain):
    """By (23), U = W takes b|ω − Ω|/μN = (1 + gain)·0.9375/√2."""
    for load in NEIGHBOURS * math.sqrt(2.0) / 0.9375 / (1.0 + gain):
        found = whirls(whirling(gain, float(load)), ThreeTermRing(1.0))
        assert len([whirl for whirl in found if abs(whirl.radius - 2.0 + whirl.spin) < 1e-6]) == 1


@pytest.mark.parametrize("law", LAWS)
def test_slip_near_sticking_is_proportional_to_the_missing_load(law):
    """U and W vanish at the limit load, and their ratio stays constant."""
    contact = law(0.12)

    def spare(load):
        return held_pin(replace(FIG8, friction_force=load), contact).friction_force - 0.1

    limit = brentq(spare, 0.05, 0.2, xtol=1e-17, rtol=1e-15)
    sizes = []
    for missing in (4e-9, 2e-9):
        (equilibrium,) = self_centred_equilibria(
            replace(FIG8, friction_force=limit * (1.0 - missing)), contact
        )
        sizes.append((math.hypot(equilibrium.x, equilibrium.y), 0.8 - equilibrium.spin))
    # The relative errors are 1e-15 in the limit and 1e-16 in these loads.
    assert np.divide(*sizes) == pytest.approx([2.0, 2.0], rel=1e-6)


@pytest.mark.parametrize(
    "without_moment", [lambda disc: {"shaft_damping": 0.0}, lambda disc: {"shaft_speed": disc.disc_speed}]
)
def test_disc_without_relative_spin_has_the_motions_of_a_pin(without_moment):
    disc = replace(FIG8, friction_force=0.0999, **without_moment(FIG8))
    (equilibrium,), (of_pin,) = self_centred_equilibria(disc), self_centred_equilibria(pin_of(disc))
    assert (equilibrium.x, equilibrium.y) == pytest.approx((of_pin.x, of_pin.y), rel=1e-14)
    assert equilibrium.spin == disc.disc_speed
    assert self_centred_equilibria(replace(disc, friction_force=0.1001)) == ()
    disc = replace(FIG11, friction_force=1e-6, **without_moment(FIG11))
    (whirl,), (of_pin,) = whirls(disc), whirls(pin_of(disc))
    assert (whirl.radius, whirl.frequency, whirl.spin) == (of_pin.radius, of_pin.frequency, 1.5)
    assert smallest_load_with_whirl(disc) == 0.0


@pytest.mark.parametrize("size", [1e-3, 1e-14])
def test_relative_spin_with_a_weak_shaft_agrees_with_the_first_order(size):
    """To first order M = R·W/(2U) gives S = b(ω − Ω)/(μN·R²/(2U) + b), and U is that of a pin up to S²."""
    disc = replace(FIG8, shaft_damping=size * 0.01)
    (equilibrium,) = self_centred_equilibria(disc)
    (of_pin,) = self_centred_equilibria(pin_of(disc))
    slip = 0.8 * math.hypot(of_pin.x, of_pin.y)
    expected = disc.shaft_damping * 0.3 / (0.05 * 0.12**2 / (2.0 * slip) + disc.shaft_damping)
    assert math.hypot(equilibrium.x, equilibrium.y) == pytest.approx(slip / 0.8, rel=1e-13 + size**2)
    assert 0.8 - equilibrium.spin == pytest.approx(expected, rel=size**2, abs=1e-15)


@pytest.mark.parametrize("offset", [1e-3, 1e-15])
def test_deflection_by_a_small_offset_is_linear(offset):
    """Near the axis friction acts like a damper μN/(2W) that turns with ω: (C − iω·μN/(2W))·z = C·X0."""
    disc = replace(FIG8, friction_force=0.01, offset=offset)
    (equilibrium,) = self_centred_equilibria(disc)
    rim = 0.12 * 0.3 - 0.01 * 0.12**2 / 0.01
    expected = offset / complex(1.0, -0.8 * 0.01 / (2.0 * rim))
    assert complex(equilibrium.x, equilibrium.y) == pytest.approx(expected, rel=1e-12 + (offset / rim) ** 2)


@pytest.mark.parametrize("law", [Ring, ThreeTermRing, lambda R: Annulus(0.0, R)])
def test_disc_without_an_offset_only_spins(law):
    disc = replace(FIG_9, friction_force=0.005)
    contact = law(0.12)
    (equilibrium,) = self_centred_equilibria(disc, contact)
    moment = contact.shares(0.0, 1.0).moment
    assert (equilibrium.x, equilibrium.y) == (0.0, 0.0)
    assert equilibrium.spin == pytest.approx(1.25 + 0.005 * moment / 0.01, rel=1e-15)


@pytest.mark.parametrize(
    ("changes", "x", "slip_torque", "stable"),
    [
        ({"disc_speed": 0.0, "friction_force": 0.02}, 0.1, -0.02 * 0.12, True),
        ({"stiffness": 0.0, "friction_force": 0.01}, 0.0, 0.01 * 0.12, False),
        ({"stiffness": 0.0, "friction_force": 0.01, "offset": 0.0}, 0.0, 0.01 * 0.12, False),
        ({"friction_force": 0.0}, 0.1, 0.0, True),
        ({"friction_force": 0.0, "disc_speed": 0.0}, 0.1, 0.0, True),
    ],
)
def test_disc_whose_centre_does_not_slip_spins_by_the_moment_of_friction(changes, x, slip_torque, stable):
    (equilibrium,) = self_centred_equilibria(replace(FIG8, **changes))
    assert (equilibrium.x, equilibrium.y) == (x, 0.0)
    assert equilibrium.spin == pytest.approx(0.5 + slip_torque / 0.01, rel=1e-14)
    assert equilibrium.stable == stable


NO_EQUILIBRIUM = [
    ({"friction_force": 0.12}, r"friction_force = 0\.12 N: together with the shaft's moment of 0\.003 N m friction "
     r"holds a force of 0\.1148\d* N, at least the spring force stiffness·\|offset\| = 0\.1 N"),
    ({"shaft_speed": 0.8, "friction_force": 0.1}, r"holds a force of 0\.1 N"),
    ({"shaft_damping": 0.0, "offset": 0.0}, r"holds a force of 0\.05 N.*= 0 N"),
    ({"disc_speed": 0.0, "friction_force": 0.05}, r"disc_speed = 0 rad/s.*moment of the shaft, 0\.005 N m"),
    ({"stiffness": 0.0}, "holds a force"),
    ({"stiffness": 0.0, "disc_speed": 0.0}, "stiffness = 0 N/m: without springs the disc may rest at any position"),
    ({"stiffness": 0.0, "friction_force": 0.0}, "stiffness = 0 N/m"),
    ({"shaft_damping": 0.0, "friction_force": 0.0}, "shaft_damping = 0 N m s/rad, friction_force = 0 N"),
]  # fmt: skip
NO_WHIRL = [
    ({"friction_force": 0.0205}, r"friction_force = 0\.0205 N: a whirl exists only above 0\.0205479 N"),
    *(({name: 0.0}, f"{name} = 0") for name in ("friction_force", "damping", "stiffness")),
    ({"disc_speed": -1.0}, "disc_speed = -1 rad/s.*natural frequency 1 rad/s"),
]


@pytest.mark.parametrize(
    ("find", "why", "disc", "changes", "reason"),
    [
        *((self_centred_equilibria, why_no_equilibrium, FIG8, *case) for case in NO_EQUILIBRIUM),
        *((whirls, why_no_whirl, FIG11, *case) for case in NO_WHIRL),
    ],
)
def test_missing_steady_motion_is_explained(find, why, disc, changes, reason):
    disc = replace(disc, **changes)
    assert find(disc) == ()
    assert re.search(reason, why(disc))
