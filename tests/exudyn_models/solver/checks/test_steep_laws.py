"""Implicit steps across a peak of friction: a load below static friction comes to rest and is held."""

import warnings

import exudyn as exu
import numpy as np
import pytest
from free_bodies import drive, new_model, rate_of, rotor, settings_of

from exudyn_models import add_ring_friction, solve_dynamic

SOLVERS = exu.DynamicSolverType
IMPLICIT = pytest.mark.parametrize("solver", [SOLVERS.TrapezoidalIndex2, SOLVERS.GeneralizedAlpha], ids=str)

SLIDING, STATIC, LEVER, NORMAL = 24.0, 28.8, 0.1, 800.0
LAWS = {
    "static ratio": {"friction_coefficient": 0.3, "static_ratio": STATIC / SLIDING},
    "steep table": {"friction_coefficient": [[0.0, 0.36], [5e-3, 0.3], [0.05, 0.3]]},
}


def speed_after_a_stop(solver, first, load=27.0, epsilon=1e-3, adaptive=True, **law):
    """Return the speed in rad/s after 0.15 s of a rotor that friction stops and a load (N m) pulls back."""
    mbs = new_model()
    wheel = rotor(mbs, 0.5, first)
    drive(mbs, wheel, -load)
    add_ring_friction(
        mbs, None, wheel, contact_radius=LEVER, normal_load=NORMAL, regularisation=epsilon, **law
    )
    settings = settings_of(0.15, 150)
    settings.timeIntegration.adaptiveStep = adaptive
    solve_dynamic(mbs, settings, solver)
    return rate_of(mbs, wheel)


@IMPLICIT
@pytest.mark.parametrize(
    ("law", "share", "epsilon"),
    [("static ratio", 0.99, 1e-3), ("static ratio", 0.99, 1e-4), ("steep table", 0.9375, 1e-3)],
)
def test_a_load_that_static_friction_holds_never_rolls_back(law, share, epsilon, solver):
    for first in np.linspace(5.0, 6.0, 5):
        speed = speed_after_a_stop(solver, first, share * STATIC, epsilon, **LAWS[law])
        assert abs(speed) <= epsilon / LEVER  # creep of a sticking contact


@IMPLICIT
def test_a_load_beyond_static_friction_rolls_back_as_by_hand(solver):
    speed = speed_after_a_stop(solver, 5.0, load=30.0, **LAWS["static ratio"])
    stop = 5.0 / ((30.0 + SLIDING) / 0.5)
    assert speed == pytest.approx(-(30.0 - SLIDING) / 0.5 * (0.15 - stop), rel=0.02)


@IMPLICIT
def test_a_fixed_step_across_the_peak_causes_a_warning(solver):
    with pytest.warns(RuntimeWarning, match="skips a peak of friction"):
        assert speed_after_a_stop(solver, 5.2, adaptive=False, **LAWS["steep table"]) < -0.1


@IMPLICIT
def test_a_contact_that_keeps_slipping_causes_no_warning(solver):
    """At 2ε the first step adds more slip than there was, on the falling side of the peak."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        speed = speed_after_a_stop(solver, -2e-3 / LEVER, load=40.0, adaptive=False, **LAWS["steep table"])
    assert speed == pytest.approx(-(40.0 - SLIDING) / 0.5 * 0.15, rel=0.02)
