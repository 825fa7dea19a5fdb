"""What the tests of the studies share: engines that are broken on purpose. A check is worth what it fails on."""

import functools

from faults import FAULTS
from faults.make import Make
from faults.plain import simulate as simulate_plainly
from faults.wrong_parameters import with_parameters

from compare.engines import EVERY_KIND, Engine


def with_changed(change):
    """Return the reference with the parameters that ``change`` returns for a system."""
    return Engine("changed", functools.partial(with_parameters, change), EVERY_KIND)


def altered(**factors):
    """Return the reference with parameters that are wrong by ``factors``."""
    return with_changed(
        lambda system: {name: factor * getattr(system, name) for name, factor in factors.items()}
    )


def made(**make):
    """Return the plain engine with one part made wrong."""
    return Engine("made", functools.partial(simulate_plainly, make=Make(**make)), EVERY_KIND)


def fault(name):
    """Return a wrong engine of the catalogue."""
    return next(fault.engine for fault in FAULTS if fault.name == name)


COARSE, FINER = {"order": 4, "step": 0.01}, {"order": 4, "step": 0.004}
"""Fixed steps, and ε by them: coarse and quick will do for an engine that is grossly wrong.

Where it may hold a body at rest, ε is small enough for one that is held to hardly creep.
"""

GROSS = {
    "wrong sign": made(friction=-1.0, **COARSE),
    "square": made(sides=4, circumscribed=True, **FINER),
    "half the damping": altered(damping=0.5),
}
"""Mistakes that every claim about a pin is tried with."""


def verdicts(findings):
    """Return the verdict of every sentence."""
    return {claim.sentence: claim.verdict for claim in findings.claims}


def sentences(findings, verdict):
    """Return the sentences with a verdict."""
    return {sentence for sentence, found in verdicts(findings).items() if found is verdict}
