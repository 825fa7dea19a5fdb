"""Random admissible parameters: no claim differs for sound engines, and wrong engines differ."""

import functools
import itertools

import numpy as np
import pytest
from faults import SOUND
from studies_under_test import altered

from compare.claims.claim import Verdict
from compare.claims.error_estimates import TRUTH, WORKING
from compare.studies.engines.trajectories.study import measure
from compare.studies.engines.trajectories.theory import Motion
from compare.studies.toolkit.random_systems import any_disc, any_pin, any_start
from reference_model import simulate

DRAWN = 12
"""Four motions of each kind of system; two of them stick."""

SEED = 50

UNTIL = 10.0
"""Duration in s: three to thirty radians of the natural oscillation."""

RESOLUTION = 1e-4
"""Resolution of a claim relative to the largest number in the start."""

SYSTEMS = {
    "pin": any_pin,
    "disc on the continuous ring": lambda random: any_disc(random, None),
    "disc on points": lambda random: any_disc(random, int(random.integers(3, 7))),
}


@functools.cache
def motions():
    """Return motions with random parameters and starts, alternating between the kinds of systems."""
    random = np.random.default_rng(SEED)
    found = {}
    for i, kind in zip(range(DRAWN), itertools.cycle(SYSTEMS), strict=False):
        system = SYSTEMS[kind](random)
        start = any_start(random, system)
        phases = simulate(system, start, [0.0, UNTIL], tolerance=TRUTH).phases
        found[f"{kind}, parameters {i + 1}"] = Motion(
            system,
            tuple(start.tolist()),
            UNTIL,
            sticks=any(phase.kind != "slip" for phase in phases),
            tolerance=WORKING,
            resolution=RESOLUTION * float(np.max(np.abs(start))),
            source=f"assumption: parameters and start are random, with seed {SEED}",
        )
    return found


def differing(engine, count):
    """Return the sentences that differ for the first ``count`` motions."""
    few = dict(itertools.islice(motions().items(), count))
    return [claim.sentence for claim in measure(engine, few).claims if claim.verdict is Verdict.DIFFERS]


@pytest.mark.parametrize("engine", SOUND, ids=lambda engine: engine.name)
def test_no_claim_differs_for_a_sound_engine(engine):
    assert sum(motion.sticks for motion in motions().values()) == 2
    found = measure(engine, motions()).claims
    assert len(found) > 2 * DRAWN
    assert not [claim.sentence for claim in found if claim.verdict is Verdict.DIFFERS]
    agree = sum(claim.verdict is Verdict.AGREES for claim in found)
    assert agree > 0.8 * len(found)  # integrals of forces are uncertain if a point comes to rest


@pytest.mark.parametrize("parameter", ["mass", "offset", "friction_force"])
def test_a_parameter_error_of_1e_5_differs_for_every_kind_of_system(parameter):
    wrong = differing(altered(**{parameter: 1.0 + 1e-5}), 3)
    for kind in SYSTEMS:
        assert any(kind in sentence for sentence in wrong)
