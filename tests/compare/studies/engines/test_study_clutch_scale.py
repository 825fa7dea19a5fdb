"""The study of the clutch's scale: what its claims see."""

import pytest
from studies_under_test import altered
from study_harness import LEFT_OUT, OPEN, SEES, StudyTests

import exudyn_models
from compare.claims.parameters import FIG5, FIG8
from compare.engines import EVERY_KIND, Engine
from compare.studies.engines.clutch_scale import CLUTCH, STUDY

NO_PASS = (SEES, OPEN)


def absolute(system, initial_state, times, *, tolerance=1e-9):
    """Exudyn with ε in m/s: 100·tolerance whatever the size of the motion."""
    return exudyn_models.simulate(
        system, initial_state, times, tolerance=tolerance, regularisation=100.0 * tolerance
    )


class TestClutchScale(StudyTests):
    study = STUDY
    few = {"shares": {"starts": 200}}
    sound = ("reference",)
    faults = {
        "friction 1 % off": altered(friction_force=1.01),
        "friction 10 % off": altered(friction_force=1.1),
        "half the damping": altered(damping=0.5),
        "ε in m/s": Engine("ε in m/s", absolute, EVERY_KIND),
    }
    columns = ("rests", "sticks", "ends", "whirls", "spins", "cycles")
    table = {
        "friction 1 % off": (NO_PASS, SEES, LEFT_OUT, SEES, SEES, SEES),
        "friction 10 % off": (LEFT_OUT, LEFT_OUT, SEES, LEFT_OUT, LEFT_OUT, LEFT_OUT),
        # What rests in space is not damped.
        "half the damping": (NO_PASS, SEES, LEFT_OUT, SEES, LEFT_OUT, SEES),
        # 1e-7 m/s are 33 times the ε of this motion: what sticks creeps too far for the claim's resolution.
        "ε in m/s": (LEFT_OUT, NO_PASS, LEFT_OUT, LEFT_OUT, LEFT_OUT, LEFT_OUT),
    }

    def test_the_ensemble_has_starts_for_both_ends(self):
        (shares,) = self.found("theory").claims
        assert 0.0 < shares.measured[0] < 1.0


def test_scaling_keeps_the_dimensionless_numbers():
    pin = CLUTCH.system(FIG5)
    assert pin.offset == pytest.approx(1e-4)
    assert pin.disc_speed == pytest.approx(300.0)
    assert pin.disc_speed / pin.natural_frequency == pytest.approx(1.5)
    assert pin.friction_force / (pin.stiffness * pin.offset) == pytest.approx(0.9)
    disc = CLUTCH.system(FIG8)
    for one in (
        lambda d: d.polar_inertia / (d.mass * d.contact_radius**2),
        lambda d: d.shaft_damping / (d.polar_inertia * d.disc_speed),
        lambda d: d.shaft_speed / d.disc_speed,
        lambda d: d.contact_radius / d.offset,
        lambda d: d.damping / (d.mass * d.disc_speed),
    ):
        assert one(disc) == pytest.approx(one(FIG8))
