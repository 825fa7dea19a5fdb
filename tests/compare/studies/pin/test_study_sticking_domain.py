"""The study of sticking: where its starts are."""

import numpy as np
import pytest

from compare.claims.error_estimates import Measurement
from compare.engines import Engine
from compare.studies.pin.sticking_domain import study, theory
from compare.studies.pin.sticking_domain.theory import vertex
from compare.studies.toolkit.pins import safest_angle
from reference_model import Phase, Trajectory
from reference_model.formulas.pin import squared_holding_force


@pytest.mark.parametrize("speed", theory.SPEEDS)
def test_starts_are_where_the_least_force_holds_the_pin(speed):
    pin = theory.pin_at(speed)
    angle = safest_angle(pin)
    around = squared_holding_force(pin, 0.01, angle + np.linspace(-np.pi, np.pi, 101))
    assert np.min(around) == pytest.approx(squared_holding_force(pin, 0.01, angle))


def test_the_vertex_of_an_exact_parabola_is_found():
    s = np.array([0.8, 1.0, 1.3])
    found, error = vertex(s, 2.0 + 3.0 * (s - 0.9) ** 2, np.full(3, 1e-6))
    assert found == pytest.approx(np.sqrt(0.9), rel=1e-12)
    assert 0.0 < error < 1e-4


@pytest.mark.parametrize(("creep", "open_"), [(1e-6, False), (7e-3, True)])
def test_a_pin_just_outside_that_is_not_let_go_tells_nothing_where_it_creeps_nearly_to_the_edge(
    creep, open_, monkeypatch
):
    def displaced(engine, speeds=()):
        return Measurement(np.zeros(2), np.full(2, creep))

    def simulate(pin, start, times, *, tolerance):
        states = np.tile(start, (len(times), 1))
        return Trajectory(pin, np.array(times), states, (Phase("stick", times[0], times[-1], states[0]),))

    monkeypatch.setattr(study, "displaced", displaced)
    found = study.lets_go(Engine("mine", simulate), (1.4,))
    assert np.all(np.isinf(found.value))
    assert np.all(np.isinf(found.error) == open_)
