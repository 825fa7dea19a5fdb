"""How good the claims are: engines with one fault each are measured like any other, and must not get away with it.

A fault that changes the physics is to be caught twice: by a comparison of trajectories, and by a claim that takes its
prediction from something else than a simulation, see ``compare.claims.claim.Kind``. The engines that the faults are
built from must pass.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from compare.claims.as_json import as_json
from compare.claims.claim import Kind, Verdict
from compare.claims.study import Findings, Study, nothing_drawn
from compare.engines import Engine
from compare.judge.detection import DETECTION, detected
from compare.judge.outcome import Catch, Judged, Judgement, Outcome
from compare.judge.page import judge_page
from compare.judge.repetitions import REPEATED, REPETITIONS
from compare.output.text_files import write_text
from compare.run.provenance import platform_stamp
from compare.run.runner import Run, run
from compare.run.workers import Failure

if TYPE_CHECKING:
    from compare.judge.faults import Fault

STUDIES = ("trajectories", "sticking-domain")
"""A second each for an engine, and between them they catch the whole catalogue by two kinds of claims."""

LIMIT = 120.0
"""Seconds after which a fault has stopped an engine, as far as a study is concerned."""


def judge(
    faults: tuple[Fault, ...],
    right: tuple[Engine, ...],
    studies: tuple[Study, ...],
    *,
    folder: Path,
    whole: bool = True,
    jobs: int = 1,
    resume: bool = False,
    progress: Callable[[int, int, str], None] = lambda done, total, name: None,
) -> Judged:
    """Measure the studies with engines that have a fault each, and with right ones.

    Parameters
    ----------
    faults : tuple of Fault
        The catalogue, or a part of it.
    right : tuple of Engine
        Engines without a fault; from their claims it is known what an engine missed that failed in a study.
    studies : tuple of Study
        Cheap ones: each is measured once for each fault.
    whole : bool
        Whether to measure the right engines with random parameters too, and to find the smallest errors of parameters
        that are noticed, with the first of them.
    folder, jobs, resume, progress
        As for ``compare.run.runner.run``.

    """
    engines = (*right, *(replace(fault.engine, name=fault.name) for fault in faults))
    repeated = (replace(REPEATED, only=tuple(engine.name for engine in right)),) if whole else ()
    detection = tuple(replace(study, only=(right[0].name,)) for study in DETECTION if whole)
    measured = run(
        (*(_only_measured(study) for study in studies), *repeated, *detection),
        engines,
        folder=folder,
        jobs=jobs,
        limit=LIMIT,
        resume=resume,
        progress=progress,
    )
    kinds = {study.name: _kinds(measured, study.name, right) for study in studies}
    of_right = kinds | {study.name: _kinds(measured, study.name, right) for study in repeated}
    return Judged(
        studies,
        tuple(
            _judgement(measured, of_right, engine.name, _of_right(repeated), False, "", right=True)
            for engine in right
        ),
        tuple(
            _judgement(measured, kinds, fault.name, fault.says, fault.changes_physics, fault.why_not_caught)
            for fault in faults
        ),
        detected(measured.outcomes.get((study.name, right[0].name)) for study in detection),
        measured.interrupted,
    )


def _of_right(repeated: tuple[Study, ...]) -> str:
    """Say what engine it is."""
    also = f" Measured with {REPETITIONS} sets of random parameters besides." if repeated else ""
    return f"An engine without a fault.{also}"


def _only_measured(study: Study) -> Study:
    """Return the study without theory and pictures."""
    declared = [claim for claim in study.declared if claim.of_engine]
    return replace(study, theory=None, curves=None, draw=nothing_drawn, animations=None, declared=declared)


def _kinds(measured: Run, study: str, right: tuple[Engine, ...]) -> tuple[Kind, ...]:
    """Return the kinds of claims that a right engine finds in a study."""
    found: dict[Kind, None] = {}
    for engine in right:
        outcome = measured.outcomes.get((study, engine.name))
        if isinstance(outcome, Findings):
            found |= dict.fromkeys(claim.kind for claim in outcome.claims)
    return tuple(found)


def _judgement(
    measured: Run,
    kinds: dict[str, tuple[Kind, ...]],
    name: str,
    says: str,
    changes_physics: bool,
    why_not_caught: str,
    *,
    right: bool = False,
) -> Judgement:
    catches = tuple(_catches(measured, kinds, name))
    finished = all((study, name) in measured.outcomes for study in kinds)
    judgement = Judgement(
        name,
        says,
        changes_physics,
        why_not_caught,
        catches,
        Outcome.UNFINISHED,
        sum(measured.seconds.get((study, name), 0.0) for study in kinds),
    )
    return replace(judgement, outcome=_outcome(judgement, right)) if finished else judgement


def _catches(measured: Run, kinds: dict[str, tuple[Kind, ...]], name: str) -> Iterator[Catch]:
    for study, of_study in kinds.items():
        outcome = measured.outcomes.get((study, name))
        if isinstance(outcome, Failure):
            yield Catch(study, f"the engine failed: {outcome.reason}", of_study, failed=True)
        elif outcome is not None:
            for claim in outcome.claims:
                if claim.verdict is Verdict.DIFFERS:
                    yield Catch(study, claim.sentence, (claim.kind,))


def _outcome(judgement: Judgement, right: bool) -> Outcome:
    if not judgement.changes_physics:
        good = Outcome.PASSES if right else Outcome.INVISIBLE
        return Outcome.WRONGED if judgement.catches else good
    return {
        (True, True): Outcome.CAUGHT,
        (True, False): Outcome.ONLY_TRAJECTORY,
        (False, True): Outcome.ONLY_OTHERS,
        (False, False): Outcome.MISSED,
    }[bool(judgement.by_trajectory), bool(judgement.by_others)]


def write_judged(judged: Judged, output: Path) -> None:
    """Write ``judge.json`` and ``judge.html`` into the folder ``output``."""
    stamp = platform_stamp()
    content = {
        "stamp": stamp,
        "interrupted": judged.interrupted,
        "studies": [study.name for study in judged.studies],
        "right": [_as_json(judgement) for judgement in judged.right],
        "faults": [_as_json(judgement) for judgement in judged.faults],
        "detection_limits": [limit.as_json() for limit in judged.limits],
    }
    write_text(output / "judge.json", json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False))
    write_text(output / "judge.html", judge_page(judged, stamp))


def _as_json(judgement: Judgement) -> dict[str, Any]:
    return {
        "name": judgement.name,
        "says": judgement.says,
        "changes_physics": judgement.changes_physics,
        "why_not_caught": judgement.why_not_caught,
        "outcome": judgement.outcome.value,
        "seconds": judgement.seconds,
        "caught_by": as_json(judgement.catches),
    }
