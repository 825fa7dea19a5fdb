"""What the claims say of an engine with a fault, of a right one, and of all of them."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from compare.claims.claim import Kind
from compare.claims.study import Study
from compare.judge.detection import Detected


class Outcome(Enum):
    """What became of a fault, or of a right engine."""

    CAUGHT = "caught"
    INVISIBLE = "changes nothing"
    PASSES = "passes"
    ONLY_TRAJECTORY = "only trajectories differ"
    ONLY_OTHERS = "trajectories do not differ"
    MISSED = "slips through"
    WRONGED = "right, but failed"
    UNFINISHED = "not finished"

    @property
    def good(self) -> bool:
        """Whether the claims did what they are there for."""
        return self in (Outcome.CAUGHT, Outcome.INVISIBLE, Outcome.PASSES)


@dataclass(frozen=True)
class Catch:
    """A claim that differs, or a study in which the engine failed: that counts for all kinds of its claims."""

    study: str
    sentence: str
    kinds: tuple[Kind, ...]
    failed: bool = False


@dataclass(frozen=True)
class Judgement:
    """What the claims say of one engine.

    Parameters
    ----------
    name, says : str
        Of the fault, or of the right engine.
    changes_physics : bool
        Whether there is anything to be caught.
    why_not_caught : str
        The reason where there is not.
    catches : tuple of Catch
        In the order of the studies.
    outcome : Outcome
        Of all of them together.
    seconds : float
        How long all studies took.

    """

    name: str
    says: str
    changes_physics: bool
    why_not_caught: str
    catches: tuple[Catch, ...]
    outcome: Outcome
    seconds: float

    def by(self, study: str) -> tuple[Catch, ...]:
        """Return the catches in one study."""
        return tuple(catch for catch in self.catches if catch.study == study)

    @property
    def by_trajectory(self) -> tuple[Catch, ...]:
        """The comparisons of trajectories that differ."""
        return tuple(catch for catch in self.catches if "trajectory" in catch.kinds)

    @property
    def by_others(self) -> tuple[Catch, ...]:
        """The claims of all other kinds that differ."""
        return tuple(catch for catch in self.catches if set(catch.kinds) != {"trajectory"})


@dataclass(frozen=True)
class Judged:
    """The result of ``judge``.

    Parameters
    ----------
    studies : tuple of Study
        That were measured.
    right, faults : tuple of Judgement
        For each engine without and with a fault.
    limits : tuple of Detected
        The smallest changes of parameters that were noticed.
    interrupted : bool
        Whether Ctrl-C came before all was done.

    """

    studies: tuple[Study, ...]
    right: tuple[Judgement, ...]
    faults: tuple[Judgement, ...]
    limits: tuple[Detected, ...]
    interrupted: bool

    @property
    def good(self) -> bool:
        """Whether everything was caught that there is to catch, and nothing else."""
        return all(judgement.outcome.good for judgement in (*self.right, *self.faults))
