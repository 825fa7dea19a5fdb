"""Measurement of sound and faulty engines with the study of trajectories, motion by motion."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from compare.claims.claim import Kind, Verdict
from compare.engines import BadTrajectoryError, Engine
from compare.studies.engines.trajectories import STUDY
from reference_model.trajectory import SimulationError

OF_ENGINES = [one for one in STUDY.declared if one.of_engine]


@dataclass(frozen=True)
class Caught:
    """Claims that differ for one engine.

    Parameters
    ----------
    sentences : tuple of str
        Sentences of these claims, or the reason if the engine failed.
    kinds : frozenset of Kind
        Kinds of these claims; all kinds of the study if the engine failed, because then no claim can pass.

    """

    sentences: tuple[str, ...] = ()
    kinds: frozenset[Kind] = frozenset()

    @property
    def twice(self) -> bool:
        """True if a comparison of trajectories and a claim of another kind differ."""
        return "trajectory" in self.kinds and len(self.kinds) > 1

    def __or__(self, other: Caught) -> Caught:
        """Return the union of both."""
        return Caught(self.sentences + other.sentences, self.kinds | other.kinds)


def caught(engine: Engine) -> Iterator[Caught]:
    """Yield the claims that differ for ``engine``, for each kind of motion."""
    for motion in dict.fromkeys(case for one in OF_ENGINES for case, _ in one.cases()):
        parts = {one.part(case) for one in OF_ENGINES for case, _ in one.cases() if case == motion}
        try:
            claims = STUDY.measure(engine, only=parts).claims
        except (BadTrajectoryError, SimulationError) as error:
            yield Caught((f"the engine failed: {error}",), frozenset(one.kind for one in OF_ENGINES))
            continue
        differ = [claim for claim in claims if claim.verdict is Verdict.DIFFERS]
        yield Caught(tuple(claim.sentence for claim in differ), frozenset(claim.kind for claim in differ))


def caught_at_last(engine: Engine) -> Caught:
    """Return the claims that differ for ``engine``; stop when it is caught twice."""
    so_far = Caught()
    for found in caught(engine):
        so_far |= found
        if so_far.twice:
            break
    return so_far
