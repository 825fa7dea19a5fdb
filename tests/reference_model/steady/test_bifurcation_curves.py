"""Stability boundaries of the whirl: completeness, accuracy, and the change of stability across them."""

import functools
from dataclasses import replace

import numpy as np
import pytest

from compare.claims.parameters import FIG11
from reference_model.contact.contact_law import Ring, ThreeTermRing
from reference_model.formulas.characteristic_polynomial import characteristic_coefficients
from reference_model.formulas.disc import whirl_at
from reference_model.steady import bifurcation_curves as module
from reference_model.steady.bifurcation_curves import ParameterPlane, boundaries, crossings
from reference_model.steady.stability import onset_load, whirl_eigenvalues
from reference_model.steady.steady_states import whirls
from reference_model.systems import DiscOnDisc

RING, THREE_TERMS = Ring(0.12), ThreeTermRing(0.12)
LAWS = pytest.mark.parametrize("law", [RING, THREE_TERMS], ids=["ring", "(23)"])
SPEED_LOAD = ParameterPlane(FIG11, ("disc_speed", "friction_force"), (1.3, 0.001), (3.0, 0.08))
INERTIA = ParameterPlane(FIG11, ("polar_inertia", "shaft_damping"), (0.05, 0.008), (4.0, 0.024))

traced = functools.cache(boundaries)


def state_at(disc, alpha, law):
    load, radius, spin = whirl_at(disc, alpha, law)
    assert load == pytest.approx(disc.friction_force, rel=1e-12)
    turning = np.copysign(disc.natural_frequency, disc.disc_speed)
    return np.array([radius, 0.0, 0.0, 0.0, turning * radius, spin])


def random_disc(rng):
    k, mass = rng.uniform(0.5, 2.0, 2)
    speed = rng.choice((-1.0, 1.0)) * k * rng.uniform(1.05, 3.0)
    return DiscOnDisc(
        mass=mass, polar_inertia=rng.uniform(0.1, 2.0), stiffness=mass * k**2, damping=rng.uniform(0.05, 1.0),
        friction_force=1.0, disc_speed=speed, contact_radius=0.12, shaft_damping=rng.uniform(0.005, 0.1),
        shaft_speed=speed + rng.uniform(-1.0, 1.0),
    )  # fmt: skip


@LAWS
def test_the_characteristic_equation_has_the_eigenvalues_of_the_jacobian(law):
    rng = np.random.default_rng(11)
    for _ in range(40):
        disc, alpha = random_disc(rng), rng.uniform(0.1, 1.5)
        load, *_ = whirl_at(disc, alpha, law)
        disc = replace(disc, friction_force=load)
        state = state_at(disc, alpha, law)
        expected = np.array(whirl_eigenvalues(disc, state, law)[1:])
        coefficients = characteristic_coefficients(disc, np.cos(alpha), np.sin(alpha), law)
        roots = np.roots([1.0, *coefficients])
        for value in expected:
            assert np.min(np.abs(roots - value)) < 1e-9 * np.max(np.abs(expected))


@LAWS
def test_across_a_hopf_curve_a_whirl_changes_its_stability_and_across_a_fold_two_appear(law):
    def unstable(load):
        found = whirls(replace(FIG11, disc_speed=1.5, friction_force=load), law)
        return len(found), sum(value.real > 0.0 for whirl in found for value in whirl.eigenvalues)

    for kind, change in (("Hopf", 0), ("fold", 2)):
        for load in crossings(SPEED_LOAD, kind, "disc_speed", 1.5, law):
            (before, growing_before), (after, growing_after) = map(unstable, (load * 0.9999, load * 1.0001))
            assert abs(after - before) == change
            if kind == "Hopf":
                assert abs(growing_after - growing_before) == 2


@LAWS
def test_the_onset_curve_is_the_closed_form(law):
    (curve,) = traced(SPEED_LOAD, "onset", law)
    expected = [onset_load(SPEED_LOAD.at(values), law) for values in curve.parameters]
    assert curve.parameters[:, 1] == pytest.approx(expected, rel=1e-13)
    assert np.all(curve.alpha == np.pi / 2.0)


@pytest.mark.parametrize("kind", ["Hopf", "fold"])
def test_curves_do_not_depend_on_the_step(kind):
    coarse, fine = traced(SPEED_LOAD, kind), traced(SPEED_LOAD, kind, step=0.02)
    assert len(coarse) == len(fine)
    ends = [sorted(c.parameters[i].tolist() for c in curves for i in (0, -1)) for curves in (coarse, fine)]
    assert np.array(ends[0]) == pytest.approx(np.array(ends[1]), rel=1e-9)


def test_finer_search_finds_no_more_curves(monkeypatch):
    found = traced(INERTIA, "Hopf")
    monkeypatch.setattr(module, "LINES", 23)
    monkeypatch.setattr(module, "NODES", 97)
    assert len(boundaries(INERTIA, "Hopf", step=0.1)) == len(found)


def test_a_disc_that_turns_the_other_way_has_the_mirrored_curves():
    mirrored = replace(
        SPEED_LOAD, disc=replace(FIG11, shaft_speed=-1.25), lower=(-3.0, 0.001), upper=(-1.3, 0.08)
    )
    here = crossings(SPEED_LOAD, "Hopf", "disc_speed", 1.5)
    there = crossings(mirrored, "Hopf", "disc_speed", -1.5)
    assert len(here) == 2
    assert there == pytest.approx(here, rel=1e-12)


def test_a_start_lies_on_a_known_curve_only_within_the_sag_of_its_polygon():
    circle = np.array([[np.cos(angle), np.sin(angle)] for angle in np.linspace(0.0, 2.0 * np.pi, 61)])
    between = np.array([np.cos(np.pi / 60.0), np.sin(np.pi / 60.0)])
    assert module._near(between, circle)
    assert not module._near(1.01 * between, circle)
