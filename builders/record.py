"""Measure foreign engines and our own, and write ``compare/foreign/<engine>.json`` for the report.

    pip install --editable '.[engines]'
    python builders/record.py                 # all engines: ten minutes of one core
    python builders/record.py mujoco bullet   # or some of them
    python builders/record.py --laws          # only the friction laws; recorded times and errors are kept

Each setting of an engine simulates the cases of ``compare.foreign``. A fixed step is halved, and a tolerance falls by
the factor ``compare.claims.error_estimates.COARSENING``, until a run takes ``LONGEST``. In addition, it measures the
friction laws, and the claims of some studies. The command skips an engine that is not installed and says so. Times
are comparable only within one recording.
"""

from __future__ import annotations

import argparse
import functools
import importlib
import json
import math
import platform
import re
import shlex
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

import compare.engines
from compare.claims.as_json import as_json, claim_as_json
from compare.claims.error_estimates import COARSENING
from compare.diagnosis.findings import PROBES, parts_of
from compare.diagnosis.run import measured
from compare.engines import INSTALLED, Engine, installed_engine
from compare.engines.live.setting import rate
from compare.foreign import CASES, COLUMNS, DIGITS, FOLDER, Case
from compare.run.measuring import measured as claims_about
from compare.run.workers import Workers
from compare.studies import studies
from reference_model import SimulationError, Trajectory
from reference_model.systems import System
from reference_model.trajectory import Solution

LONGEST = 0.7
"""Time of a run in s that ends its ladder,"""

LEAST = 5
"""unless the ladder has fewer runs than this, which an order of convergence needs."""

TOLERANCES = 1e-2 / COARSENING ** np.arange(12)

PROGRAMS = {
    "rapier": "Rapier",
    "jolt": "Jolt",
    "physx": "PhysX",
    "havok": "Havok",
    "cannon": "cannon-es",
    "planck": "planck",
}
"""npm engines by the argument of ``examples/exec_contact.js``. The current folder must contain node_modules."""

PROGRAM_SETTINGS = {
    "contact": ("", "with its best settings"),
    "as shipped": (" shipped", "with its default settings"),
    "box": (" box", "with a box in place of a ring"),
}
"""Further argument and description of the settings of npm engines; planck has no box."""

OURS = {"reference": "friction-discs", "exudyn": "exudyn", "exudyn-native": "exudyn"}
"""Our own engines, and the packages that give their versions."""

NAMES = (*(name for name in INSTALLED if name != "newton"), *PROGRAMS, *OURS)  # a step of Newton takes 2 ms

TOO_LARGE = "scales"
"""Probe that is not recorded: forces over wide ranges would be most of every file."""

CLAIMS_OF, FINER = ("joints", "tosses"), 4.0
"""Studies whose claims are recorded, and the ratio of an engine's fixed step to the step for these claims."""

PROBE_LIMIT = 300.0
"""Time limit of a probe of the friction law in s. The row then lacks its result."""

FINEST = 2e-3
"""Smallest step in single precision, in units of 1/max(k, ω). At 1.3e-3 rounding spoils Rapier."""

Simulate = Callable[..., Trajectory]


@dataclass(frozen=True)
class Setting:
    """An engine, its simulate function, a description of its settings, and its smallest step as for ``FINEST``."""

    engine: Engine
    simulate: Simulate
    says: str = ""
    finest: float = 0.0


def settings_of(name: str) -> dict[str, Setting]:
    """Return the settings of an engine by name; raise ``ValueError`` if the engine is not installed."""
    if name in INSTALLED:
        found = {}
        for key in INSTALLED[name].settings:
            engine = installed_engine(name, key)
            setting = getattr(importlib.import_module(engine.function.module), engine.function.function)
            found[setting.name] = Setting(engine, setting, setting.says, setting.finest)
        return found
    if name in PROGRAMS:
        program, found = Path(__file__).parents[1] / "examples" / "exec_contact.js", {}
        for title, (argument, says) in PROGRAM_SETTINGS.items():
            if title == "box" and not _has_box(name):
                continue
            (engine,) = compare.engines.engines([f"exec:node {shlex.quote(str(program))} {name}{argument}"])
            about = f"{says}, by npm's package: steps of order 1."
            found[title] = Setting(engine, functools.partial(by_steps, engine), about, FINEST)
        return found
    (engine,) = compare.engines.engines([name])
    return {"": Setting(engine, engine.simulate)}


def by_steps(
    engine: Engine, system: System, start: Any, times: Any, *, tolerance: float, step: float
) -> Trajectory:
    """Return a motion from a program, which knows no tolerance."""
    before = time.perf_counter()
    found = engine.function(system, start, times, step=step)
    steps = int(np.sum(np.ceil(np.diff(times) / step * (1.0 - 1e-9))))
    solution = Solution(engine.name, tolerance, steps, steps, time.perf_counter() - before)
    return replace(found, solution=solution)


def accuracies(setting: Setting, case: Case) -> Iterator[dict[str, float]]:
    """Yield the accuracies of the runs, largest first: tolerances, and fixed steps that are halved exactly.

    A setting with a smallest step ends with it.
    """
    interval, tolerances = float(case.times[1] - case.times[0]), TOLERANCES.tolist()
    turns, coarsest = interval * rate(case.system), 0.1 * tolerances[0] ** (1.0 / 3.0)
    number = math.ceil(turns / coarsest)
    if setting.finest:
        # One run less, because a stuck pin would slip with the coarsest step.
        number, tolerances = 2 * max(1, int(turns / setting.finest) >> LEAST - 1), tolerances[1:LEAST]
    for k, tolerance in enumerate(tolerances):
        steps = {"step": interval / (number << k)} if setting.engine.step is not None else {}
        yield {"tolerance": tolerance, **steps}


def ladder(setting: Setting, case: Case, *, outside: bool = False) -> list[list[float | None]]:
    """Return a row of ``COLUMNS`` for each tolerance, largest first.

    For an engine in another process (``outside``) only the wall-clock time is known.
    """
    rows: list[list[float | None]] = []
    before = None
    for accuracy in accuracies(setting, case):
        if not rows:  # the first call compiles or loads
            _timed(setting.simulate, case, case.times[:2], accuracy, outside)
        trajectory, seconds, wall = _timed(setting.simulate, case, case.times, accuracy, outside)
        if trajectory is None:
            continue  # the tolerance is too large
        found = case.quantity(trajectory)
        error = float(np.max(np.abs(found - case.exact())))
        change = None if before is None else float(np.max(np.abs(found - before)))
        if change != 0.0:  # else a limit of the step, not the tolerance, determines it
            row = (accuracy["tolerance"], trajectory.solution.steps, error, change, seconds, wall)
            rows.append([value and float(f"{value:.{DIGITS}g}") for value in row])
            before = found
        if seconds > LONGEST and len(rows) >= LEAST:
            break
    return rows


def _timed(
    simulate: Simulate, case: Case, times: Any, accuracy: dict[str, float], outside: bool
) -> tuple[Trajectory | None, float, float]:
    wall, processor = time.perf_counter(), time.process_time()
    try:
        trajectory = simulate(case.system, case.start, times, **accuracy)
    except SimulationError as error:
        print(f"  {accuracy}: {error}")
        return None, 0.0, 0.0
    wall, processor = time.perf_counter() - wall, time.process_time() - processor
    return trajectory, wall if outside else processor, wall


def record(name: str) -> dict[str, Any]:
    """Measure all settings of an engine; raise ``ValueError`` if it is not installed."""
    settings, outside = [], name in PROGRAMS
    for title, setting in settings_of(name).items():
        print(f"{name}: {title}", flush=True)
        runs = {
            key: ladder(setting, case, outside=outside)
            for key, case in CASES.items()
            if setting.engine.simulates(case.system)
        }
        about = {"name": title, "says": setting.says, "step": setting.engine.step}
        settings.append(about | {**laws(setting.engine, box=_has_box(name)), "runs": runs})
    return {
        "engine": INSTALLED[name].title if name in INSTALLED else PROGRAMS.get(name, name),
        "version": setting.engine.version or version(OURS[name]),
        "recorded": f"{datetime.now(UTC):%Y-%m-%d}",
        "platform": f"{platform.system()} {platform.machine()}, Python {platform.python_version()}",
        "columns": COLUMNS,
        "settings": settings,
    }


def _has_box(name: str) -> bool:
    return name in PROGRAMS and name != "planck"


def laws(engine: Engine, *, box: bool) -> dict[str, Any]:
    """Return the probes of an engine's friction law, and its claims by study and identity, as JSON.

    An engine with a ``box`` simulates discs on four points, which its greeting does not mention.
    """
    finer = engine if engine.step is None else replace(engine, step=engine.step / FINER)
    finer = replace(finer, kinds=(*finer.kinds, "points")) if box and "pin" in finer.kinds else finer
    found: dict[str, Any] = {}
    for study in studies(CLAIMS_OF):
        claims = claims_about(study, finer).claims
        found[study.name] = {claim.identity: claim_as_json(claim) for claim in claims}
    kept = ("verdict", "measured", "difference", "numerical_error")
    short = {
        study: {identity: {key: _short(claim[key]) for key in kept} for identity, claim in claims.items()}
        for study, claims in found.items()
        if claims
    }
    return {"probes": probes(engine), "claims": short}


def _short(value: Any) -> Any:
    """Return numbers with ``DIGITS`` digits."""
    if isinstance(value, list):
        return [_short(one) for one in value]
    return float(f"{value:.{DIGITS}g}") if isinstance(value, float) else value


def probes(engine: Engine) -> dict[str, Any]:
    """Return the probes of an engine's friction law as JSON, without those that fail or exceed the time limit."""
    found = {}
    with Workers(1, PROBE_LIMIT) as workers:
        for probe in parts_of(engine):
            if probe in PROBES and probe != TOO_LARGE:
                workers.submit(probe, measured, engine, probe)
        for done in workers.finished():
            if isinstance(done.value, PROBES[str(done.key)]):
                found[str(done.key)] = as_json(done.value)
            else:  # a failure, a refusal, or motions beyond the engine's ranges
                print(f"  {engine.name}, {done.key}: {done.value}", flush=True)
    return found


def record_laws(name: str) -> dict[str, Any]:
    """Return the recording of an engine with new probes of its friction laws and new claims."""
    found: dict[str, Any] = json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8"))
    simulating = settings_of(name)
    for setting in found["settings"]:
        print(f"{name}: {setting['name']}", flush=True)
        setting |= laws(simulating[setting["name"]].engine, box=_has_box(name))
    return found


def written(found: dict[str, Any]) -> str:
    """Return JSON with one line per row of numbers."""
    text = json.dumps(found, ensure_ascii=False, indent=1)
    rows = re.sub(r"\[([^\[\]{}\"]+)\]", lambda row: "[" + " ".join(row[1].split()) + "]", text)
    return rows + "\n"


def main() -> None:
    """Record the given engines, or all."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("engines", nargs="*", metavar="ENGINE", help=", ".join(NAMES))
    parser.add_argument("--laws", action="store_true", help="measure only the friction laws again")
    given = parser.parse_args()
    names = given.engines or list(NAMES)
    if unknown := set(names) - set(NAMES):
        parser.error(f"unknown engine {', '.join(sorted(unknown))}: expected one of {', '.join(NAMES)}")
    for name in names:
        try:
            found = record_laws(name) if given.laws else record(name)
        except ValueError as error:
            print(f"{name} skipped: {error}", file=sys.stderr)
            continue
        (FOLDER / f"{name}.json").write_text(written(found), encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()
