"""``friction-discs plan``: the motions of studies as files, for engines that only their owner can run."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from compare.cli.command import FINE, SOMETHING_DIFFERS, BadInputError, measurements, printing, refused, say
from compare.cli.options import Folder, Jobs, Seed, check_folder, cores, studies_of
from compare.cli.report import Level

if TYPE_CHECKING:
    from compare.claims.study import Study
    from compare.run.plan import Planned
    from compare.run.workers import Failure

Names = Annotated[
    list[str] | None,
    typer.Argument(metavar="STUDY", help="Studies to plan; all by default.", show_default=False),
]
Kinds = Annotated[
    list[str] | None,
    typer.Option(
        "--kind",
        metavar="KIND",
        help="Kind of system that your engine simulates: block, pin, points, ring or joint; repeat for more kinds.",
        show_default="pin",
    ),
]


def plan(
    context: typer.Context,
    names: Names = None,
    kind: Kinds = None,
    level: Level = "full",
    seed: Seed = None,
    output: Folder = Path("plan"),
    jobs: Jobs = None,
) -> int:
    """Write the motions of studies as files for another engine.

    Use it for an engine that this project cannot run. Add a NAME.csv to each NAME.json, in the format of simulate
    --output. Then judge these motions with report --engine files:DIR. Missing and incomplete motions are not scored.
    Claims whose motions depend on earlier results are left out.

    \b
    Examples:
      friction-discs plan --level quick
      friction-discs plan trajectories --kind pin --kind ring --output motions
    """
    from compare.engines import KINDS, one_of

    studies = studies_of(context, names or [], level)
    with refused():
        kinds = tuple(dict.fromkeys(one_of("kind of system", one, KINDS) for one in kind or ["pin"]))
        check_folder(output)

    from compare.run.levels import seed_of
    from compare.run.plan import Planned, write_plan
    from compare.run.workers import Failure

    for study in studies:
        if names and study.only:
            say(f"{study.name} applies only to {' and '.join(study.only)}; skipped", FINE)
    studies = tuple(study for study in studies if not study.only)
    seed = seed_of(level, seed)
    found = _found(studies, kinds, seed, jobs or cores())
    plans = {study.name: one for study in studies if isinstance(one := found[study.name], Planned)}
    motions = dict.fromkeys(line for one in plans.values() for line in one.motions)
    for name, failure in found.items():
        if isinstance(failure, Failure):
            say(f"cannot plan {name}: {failure}", SOMETHING_DIFFERS)
    if not motions and len(plans) < len(found):
        return SOMETHING_DIFFERS
    if not motions:
        raise BadInputError(
            "no motions to plan: they are of another --kind, or they depend on earlier answers"
        )
    write_plan(output, kinds, motions)
    _print_plans(plans, len(motions), output, seed)
    return FINE if len(plans) == len(found) else SOMETHING_DIFFERS


def _found(
    studies: tuple[Study, ...], kinds: tuple[str, ...], seed: int | None, jobs: int
) -> dict[str, Planned | Failure]:
    from compare.run.plan import planned
    from compare.run.workers import Workers

    found: dict[str, Planned | Failure] = {}
    with Workers(jobs) as workers, measurements() as progress:
        for study in sorted(studies, key=lambda study: -study.seconds):
            workers.submit(study.name, planned, study, kinds, seed)
        for count, done in enumerate(workers.finished(), 1):
            found[str(done.key)] = done.value
            progress(count, len(studies), str(done.key))
    return found


def _print_plans(plans: Mapping[str, Planned], count: int, output: Path, seed: int | None) -> None:
    with printing():
        for name, one in plans.items():
            print(
                f"{name}: {len(one.motions)} motions for {one.claims} claims, {one.adaptive} claims left out"
            )
        command = f"friction-discs report --engine files:{output}" + (
            f" --seed {seed}" if seed is not None else ""
        )
        print(f"{count} motions in {output}; judge the answers with {command}")
