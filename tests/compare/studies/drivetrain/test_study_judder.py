"""The study of judder agrees, and each of its claims fails for a wrong clutch; its closed form is the equation's."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from study_harness import BLIND, LEFT_OUT, OPEN, SEES
from wrong_parts import WrongPartTests

import compare.studies.drivetrain.judder.claims as claims
import compare.studies.drivetrain.judder.model as model
from compare.claims.claim import Verdict
from compare.studies.drivetrain.judder.claims import STUDY
from compare.studies.drivetrain.judder.parameters import (
    COEFFICIENT,
    DAMPING,
    GRADIENTS,
    INERTIA,
    LOAD,
    PERTURBED,
    RADIUS,
    SPEED,
    STEADY_SLIP,
    STIFFNESS,
    TIMES,
)
from compare.studies.drivetrain.judder.theory import MOMENT, motion
from exudyn_models import RingFriction, add_ring_friction


def off(**factors):
    """Let the model be built with numbers that are off by ``factors``."""

    def put(patch):
        for name, factor in factors.items():
            patch.setattr(model, name, factor * getattr(model, name))

    return put


def slope_left_out_of_the_jacobian(patch):
    def of_a_constant_coefficient(*arguments, friction_coefficient, **options) -> RingFriction:
        return add_ring_friction(*arguments, friction_coefficient=COEFFICIENT, **options)

    patch.setattr("exudyn_models.add_ring_friction", of_a_constant_coefficient)


class TestJudder(WrongPartTests):
    study = STUDY
    faults = {
        "load 0.1 % too large": off(LOAD=1.001),
        "stiffness 0.1 % too large": off(STIFFNESS=1.001),
        "damping 0.1 % too large": off(DAMPING=1.001),
        "coefficient without its slope": slope_left_out_of_the_jacobian,
        "drive 0.1 % too fast": off(SPEED=1.001),
    }
    columns = ("linear", "vibrates", "onset", "sticks")
    table = {
        "load 0.1 % too large": (SEES, SEES, SEES, BLIND),
        "stiffness 0.1 % too large": (SEES, SEES, BLIND, BLIND),
        "damping 0.1 % too large": (SEES, SEES, SEES, BLIND),
        # Alike for all gradients, growth has no root.
        "coefficient without its slope": (SEES, SEES, OPEN, LEFT_OUT),
        # The slope is a straight line: elsewhere on it the same vibrations are about another place of rest.
        "drive 0.1 % too fast": (BLIND, SEES, BLIND, SEES),
    }

    @classmethod
    def measured_with(cls, fault, few, only):
        """Measure with four times the ε, which takes a quarter of the steps in stick."""
        with pytest.MonkeyPatch.context() as patch:
            for module in (claims, model):
                patch.setattr(module, "EPSILON", 4.0 * module.EPSILON)
            return super().measured_with(fault, few, only)

    def test_a_clutch_without_fault_ends_in_stick_at_the_wider_epsilon_too(self, monkeypatch):
        monkeypatch.setitem(self.faults, "none", lambda patch: None)
        (found,) = self.measured_with("none", {}, ("sticks",)).claims
        assert found.verdict is Verdict.AGREES


@pytest.mark.parametrize("gradient", GRADIENTS[[0, 3, 6]])
def test_the_closed_form_is_the_motion_of_the_disc(gradient):
    def rates(t, y):
        coefficient = COEFFICIENT - gradient * (RADIUS * (SPEED - y[1]) - STEADY_SLIP)
        return [y[1], (coefficient * LOAD * RADIUS - DAMPING * y[1] - STIFFNESS * y[0]) / INERTIA]

    start = [MOMENT / STIFFNESS, PERTURBED]
    found = solve_ivp(rates, (0.0, TIMES[-1]), start, t_eval=TIMES, rtol=1e-11, atol=1e-13, method="DOP853")
    np.testing.assert_allclose(motion(gradient, TIMES), found.y.T, atol=1e-9)
