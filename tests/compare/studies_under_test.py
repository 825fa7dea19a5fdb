"""What the tests of the studies share."""

from dataclasses import replace

from compare.engines import EVERY_KIND, Engine
from reference_model import simulate


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
