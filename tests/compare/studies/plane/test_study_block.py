from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from studies_under_test import engine_named

from compare.engines import Engine
from compare.studies.plane.block import study
from compare.studies.plane.block.study import STUDY


def test_an_engine_for_blocks_is_measured_on_every_claim():
    blocks_only = Engine("blocks", engine_named("reference").function, ("block",))
    found = STUDY.measure(blocks_only)
    assert found.not_simulated == ""
    assert len(found.claims) == len(STUDY.declared)


def test_an_engine_without_stick_is_measured_on_permanent_slip_only():
    sliding = Engine("sliding", engine_named("reference").function, ("block",), sticks=False)
    found = STUDY.measure(sliding)
    assert found.not_simulated == "sliding does not simulate stick"
    assert [claim.identity for claim in found.claims] == [
        "block/slows",
        "block/pulled-along",
        "block/pulled-across",
    ]


@pytest.mark.parametrize("stiffness", [0.0, study.ACROSS.stiffness, 1e4 * study.ACROSS.stiffness])
def test_the_bound_covers_the_effect_of_the_spring_on_the_velocity_across_the_pull(stiffness, monkeypatch):
    """The bound also holds for springs whose force changes by 1 %."""
    block, times = study.ACROSS, study.TURNING

    def rates(_, y):
        z, v = y.view(complex)
        a = (block.friction_force * (1.0 - v / abs(v)) - stiffness * z) / block.mass
        return np.array([v, a]).view(float)

    run = solve_ivp(
        rates, (0.0, times[-1]), (0.0, 0.0, 0.0, study.SPEED), "DOP853", times, rtol=1e-12, atol=1e-13
    )
    monkeypatch.setattr(study, "ACROSS", replace(block, stiffness=stiffness))
    apart = np.max(np.abs(run.y[2:].T - study.across(times)))
    bound = study.bend_by_spring(times)
    assert apart <= bound + 1e-10
    assert apart >= 0.1 * bound
