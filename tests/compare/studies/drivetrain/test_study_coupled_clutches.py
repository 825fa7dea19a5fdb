"""The study of the coupled clutches agrees, and each of its claims fails for a wrong clutch or a wrong record."""

from dataclasses import replace

import numpy as np
import pytest
from study_harness import BLIND, LEFT_OUT, SEES, engine_named
from wrong_parts import WrongPartTests

import compare.studies.drivetrain.coupled_clutches.study as claims
import compare.studies.drivetrain.coupled_clutches.theory as model
from compare.claims.claim import Verdict
from compare.studies.drivetrain.coupled_clutches.study import STUDY
from compare.studies.drivetrain.coupled_clutches.theory import published


def off(**factors):
    """Let all models be built with numbers that are off by ``factors``."""

    def put(patch):
        for name, factor in factors.items():
            patch.setattr(model, name, np.multiply(factor, getattr(model, name)).tolist())

    return put


def first_load_late(patch):
    on_time = model.first_load
    late = lambda time: on_time(time - 1e-3)  # noqa: E731
    patch.setattr(model, "first_load", late)
    patch.setattr(model, "LOADS", (late, *model.LOADS[1:]))


def torque_late(patch):
    on_time = model.torque
    patch.setattr(model, "torque", lambda time: on_time(time - 1e-4))


def creep_of_another_order(patch):
    build = model.with_our_contact
    patch.setattr(claims, "with_our_contact", lambda epsilon: build(epsilon**0.5 * 0.01))


class TestCoupledClutches(WrongPartTests):
    study = STUDY
    faults = {
        "sliding friction 0.5 % too large": off(COEFFICIENT=1.005),
        "first load 1 ms late": first_load_late,
        "static friction that of sliding": off(STATIC_RATIO=1.0 / 1.1),
        "second rotor 0.5 % too heavy": off(INERTIAS=np.array([1.0, 1.005, 1.0, 1.0])),
        "torque 0.1 ms late": torque_late,
        "creep of another order": creep_of_another_order,
    }
    columns = ("moves", "switches_on_time", "momentum", "implicit", "order_in_epsilon", "order_in_step")
    table = {
        # Friction and loads are inner forces.
        "sliding friction 0.5 % too large": (SEES, SEES, BLIND, SEES, LEFT_OUT, LEFT_OUT),
        "first load 1 ms late": (SEES, SEES, BLIND, LEFT_OUT, LEFT_OUT, LEFT_OUT),
        "static friction that of sliding": (SEES, SEES, BLIND, LEFT_OUT, LEFT_OUT, LEFT_OUT),
        "second rotor 0.5 % too heavy": (SEES, SEES, SEES, LEFT_OUT, LEFT_OUT, LEFT_OUT),
        "torque 0.1 ms late": (SEES, LEFT_OUT, SEES, LEFT_OUT, LEFT_OUT, SEES),
        "creep of another order": (LEFT_OUT, LEFT_OUT, LEFT_OUT, LEFT_OUT, SEES, LEFT_OUT),
    }

    @classmethod
    def measured_with(cls, fault, few, only):
        """Measure with twice each ε, which takes half the steps, but where rounding counts."""
        with pytest.MonkeyPatch.context() as patch:
            if fault != "static friction that of sliding":
                patch.setattr(claims, "EPSILONS", 2.0 * claims.EPSILONS)
            return super().measured_with(fault, few, only)

    @pytest.mark.parametrize("claim", ["moves", "momentum", "order_in_epsilon"])
    def test_clutches_without_fault_agree_at_the_larger_epsilons_too(self, claim, monkeypatch):
        monkeypatch.setitem(self.faults, "none", lambda patch: None)
        (found,) = self.measured_with("none", {}, (claim,)).claims
        assert found.verdict is Verdict.AGREES


NATIVE = replace(engine_named("exudyn-native"), contact_only=False)


def of_bristles(name, fault=None):
    """Return the verdict of the claim about speeds of Exudyn's own connector, with a fault."""
    with pytest.MonkeyPatch.context() as patch:
        if fault is not None:
            fault(patch)
        (claim,) = STUDY.measure(replace(NATIVE, name=name), {}, ("moves",)).claims
    return claim.verdict


def test_exudyns_own_connector_agrees():
    assert of_bristles("bristles") is Verdict.AGREES


@pytest.mark.parametrize("fault", [off(COEFFICIENT=1.005), first_load_late, off(STATIC_RATIO=1.0 / 1.1)])
def test_a_wrong_connector_with_bristles_is_seen(fault):
    assert of_bristles(f"wrong bristles {id(fault)}", fault) is Verdict.DIFFERS


@pytest.mark.parametrize(
    ("change", "function"),
    [
        (
            lambda record: replace(record, speeds=np.add(record.speeds, [0.0, 2e-4, 0.0, 0.0])),
            "published_speeds",
        ),
        (lambda record: replace(record, angles=record.angles * 1.0001), "published_angles"),
        (lambda record: replace(record, times=record.times + 2e-5), "published_switches"),
    ],
)
def test_a_wrong_record_is_seen(change, function, monkeypatch):
    record = change(published())
    monkeypatch.setattr(claims, "published", lambda: record)
    (claim,) = STUDY.measure_theory({}, (function,)).claims
    assert claim.verdict is Verdict.DIFFERS
