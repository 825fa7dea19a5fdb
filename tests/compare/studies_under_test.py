"""What the tests of the studies share."""

import pytest
from broken_engines import broken_engines

from compare.engines import engines

for_every_sound_engine = pytest.mark.parametrize(
    "engine", [*engines(["reference", "exudyn"]), broken_engines()["intact"]], ids=lambda engine: engine.name
)


def verdicts(findings):
    """Return the verdict of every sentence."""
    return {claim.sentence: claim.verdict for claim in findings.claims}


def sentences(findings, verdict):
    """Return the sentences with a verdict."""
    return {sentence for sentence, found in verdicts(findings).items() if found is verdict}


def findings_of(study, name, few):
    """Measure a part of ``study`` with a registered engine."""
    return study.measure(engines([name])[0], **few)
