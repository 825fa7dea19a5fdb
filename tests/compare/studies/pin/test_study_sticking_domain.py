import numpy as np
import pytest

from compare.claims.error_estimates import Measurement
from compare.engines import Engine
from compare.studies.pin.sticking_domain import study
from reference_model import Phase, Trajectory


@pytest.mark.parametrize(("creep", "open_"), [(1e-6, False), (7e-3, True)])
def test_release_is_open_if_the_pin_creeps_nearly_to_the_edge(creep, open_, monkeypatch):
    def displaced(engine, speeds=()):
        return Measurement(np.zeros(2), np.full(2, creep))

    def simulate(pin, start, times, *, tolerance):
        states = np.tile(start, (len(times), 1))
        return Trajectory(pin, np.array(times), states, (Phase("stick", times[0], times[-1], states[0]),))

    monkeypatch.setattr(study, "displaced", displaced)
    found = study.lets_go(Engine("mine", simulate), (1.4,))
    assert np.all(np.isinf(found.value))
    assert np.all(np.isinf(found.error) == open_)
