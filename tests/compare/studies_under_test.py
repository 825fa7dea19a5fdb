"""What the tests of the studies share."""

from dataclasses import replace

import pytest
from broken_engines import broken_engines

from compare.engines import EVERY_KIND, Engine, engines
from reference_model import simulate

for_every_sound_engine = pytest.mark.parametrize(
    "engine", [*engines(["reference", "exudyn"]), broken_engines()["intact"]], ids=lambda engine: engine.name
)


def altered(**factors):
    """Return the reference with parameters that are wrong by ``factors``."""

    def simulated(system, initial_state, times, *, tolerance=1e-9):
        wrong = {name: factor * getattr(system, name) for name, factor in factors.items()}
        trajectory = simulate(replace(system, **wrong), initial_state, times, tolerance=tolerance)
        return replace(trajectory, system=system)

    return Engine("altered", simulated, EVERY_KIND)


def verdicts(findings):
    """Return the verdict of every sentence."""
    return {claim.sentence: claim.verdict for claim in findings.claims}


def sentences(findings, verdict):
    """Return the sentences with a verdict."""
    return {sentence for sentence, found in verdicts(findings).items() if found is verdict}


def findings_of(study, name, few):
    """Measure a part of ``study`` with a registered engine."""
    return study.measure(engines([name])[0], **few)
