"""Measure all sound and faulty engines with the study of trajectories, in processes as a report does."""

from __future__ import annotations

from dataclasses import dataclass

from compare.claims.claim import Kind, Verdict
from compare.claims.study import Findings
from compare.engines import Engine
from compare.run.runner import measured
from compare.run.workers import Failure, Workers
from compare.studies.engines.trajectories import STUDY
from faults.catalogue import FAULTS, SOUND

LIMIT = 120.0
"""Seconds for one engine. A fault may make a motion so stiff that it never ends."""


@dataclass(frozen=True)
class Caught:
    """What the claims report about one engine.

    Parameters
    ----------
    sentences : tuple of str
        Claims that differ; the reason in their place if the engine failed.
    kinds : frozenset of Kind
        Kinds of these claims; all kinds of the study if the engine failed, because then no claim can pass.

    """

    sentences: tuple[str, ...]
    kinds: frozenset[Kind]

    @property
    def twice(self) -> bool:
        """Whether a comparison of trajectories and a claim of another kind differ."""
        return "trajectory" in self.kinds and len(self.kinds) > 1


def caught_by_name(jobs: int) -> dict[str, Caught]:
    """Return what the study of trajectories finds in each sound and each faulty engine, by the engine's name."""
    with Workers(jobs, LIMIT) as workers:
        for engine in (*SOUND, *(fault.engine for fault in FAULTS)):
            workers.submit(engine.name, measured, STUDY, engine)
        return {str(done.key): caught(done.value) for done in workers.finished()}


def caught_now(engine: Engine) -> Caught:
    """Return what the study of trajectories finds in ``engine``, measured in this process."""
    return caught(measured(STUDY, engine))


def caught(outcome: Findings | Failure) -> Caught:
    """Return what differs in the ``outcome`` of one measurement."""
    if isinstance(outcome, Failure):
        kinds = frozenset(one.kind for one in STUDY.declared if one.of_engine)
        return Caught((f"the engine failed: {outcome.reason}",), kinds)
    differ = [claim for claim in outcome.claims if claim.verdict is Verdict.DIFFERS]
    return Caught(tuple(claim.sentence for claim in differ), frozenset(claim.kind for claim in differ))
