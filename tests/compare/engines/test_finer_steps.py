"""An inconclusive claim is measured again with shorter steps, which does not help a wrong engine."""

import functools
import itertools
import math
from dataclasses import replace

import numpy as np
import pytest

from compare.claims.claim import Verdict
from compare.claims.error_estimates import LONGEST, SHORTER, decided
from compare.claims.measured import Measured
from compare.claims.prose import Prose
from compare.claims.study import Study
from compare.engines import Engine
from reference_model import PinOnDisc, Trajectory

STEP = 0.1
# Its motion is cos t.
PIN = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.0, friction_force=0.0, disc_speed=0.0, offset=0.0)


def euler(system, state, times, *, step, stiffness=1.0):
    """Simulate the oscillator by the symplectic Euler method."""
    steps = math.ceil((times[-1] - times[0]) / step)
    h, (x, _, vx, _) = (times[-1] - times[0]) / steps, state
    for _ in range(steps):
        vx -= h * stiffness * x
        x += h * vx
    return Trajectory(system, np.array(times), np.array([state, (x, 0.0, vx, 0.0)]))


def study_of(resolution):
    study = Study("mine", Prose("Mine"))

    @study.claim("It swings", resolution=resolution)
    def swings(engine):
        found, coarse = (
            engine.simulate(PIN, (1.0, 0.0, 0.0, 0.0), (0.0, 10.0), tolerance=tolerance).states[-1][0]
            for tolerance in (1e-9, 8e-9)
        )
        return Measured(
            value=found, predicted=math.cos(10.0), error=abs(found - coarse), system=PIN, source="here"
        )

    return study


def fails_below(system, state, times, *, step):
    """Simulate the oscillator, but fail below the engine's own step."""
    if step < 0.5 * STEP:
        raise RuntimeError("out of memory")
    return euler(system, state, times, step=step)


def fails_above(system, state, times, *, step):
    """Simulate the oscillator, but fail at the engine's own step."""
    if step > STEP:
        raise RuntimeError("diverged")
    return euler(system, state, times, step=step)


AGAIN = "Measured with 1/4 of the engine's own step, which leaves the claim inconclusive."
FAILED = "The run with 1/4 of the engine's own step failed: out of memory"


@pytest.mark.parametrize(
    ("function", "resolution", "verdict", "note"),
    [
        (euler, 0.5, Verdict.AGREES, ""),
        (euler, 2e-2, Verdict.AGREES, AGAIN),
        (functools.partial(euler, stiffness=1.01), 1e-3, Verdict.DIFFERS, AGAIN.replace("1/4", "1/16")),
        (fails_below, 2e-2, Verdict.INCONCLUSIVE, FAILED),
        (fails_above, 2e-2, Verdict.AGREES, AGAIN),
    ],
    ids=["conclusive at once", "inconclusive", "wrong", "fails", "fails at its own step"],
)
def test_an_inconclusive_claim_is_measured_again_with_shorter_steps(function, resolution, verdict, note):
    (claim,) = study_of(resolution).measure(Engine("mine", function, step=STEP)).claims
    assert (claim.verdict, claim.note) == (verdict, note)


def test_an_engine_that_always_fails_gives_its_own_reason():
    def fails(*motion, step):
        raise RuntimeError(f"no result at {step:.3g} s")

    with pytest.raises(RuntimeError, match=r"no result at 0\.1 s"):
        study_of(1.0).measure(Engine("mine", fails, step=STEP))


def test_only_a_fixed_step_is_shortened_and_only_within_the_time_limit(monkeypatch):
    def asked(engine, seconds):
        """Return the steps of an engine that leaves a claim open and needs ``seconds`` for each run."""
        clock, steps = itertools.count(0.0, seconds), []
        monkeypatch.setattr("compare.claims.error_estimates.processor_time", lambda: next(clock))
        decided(
            engine, lambda engine: steps.append(engine and engine.step) or "open", lambda _: len(steps) < 4
        )
        return steps

    fixed = Engine("mine", euler, step=STEP)
    assert asked(Engine("free", euler), 0.0) == asked(None, 0.0) == [None]
    assert asked(fixed, 0.9 * LONGEST / SHORTER) == pytest.approx([STEP / 4.0**i for i in range(4)])
    assert asked(fixed, 1.1 * LONGEST / SHORTER) == [STEP]
    assert asked(replace(fixed, precision=1e-6), 0.0) == [STEP]  # shorter steps only add rounding errors
