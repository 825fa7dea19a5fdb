"""Measure foreign engines, and our own beside them, and write ``compare/foreign/<engine>.json`` for the report.

    pip install --editable '.[engines]'
    python builders/record.py                 # all engines: five minutes of one core
    python builders/record.py mujoco bullet   # or some of them
    python builders/record.py --laws          # what tells the law alone; times and errors stay as they are recorded

Each setting of an engine goes through the cases of ``compare.foreign.cases`` with tolerances that fall by the factor
of ``compare.claims.error_estimates.COARSENING``, until a run takes ``LONGEST``. An engine that is not installed is
left out, with a sentence. Times are to be compared within one recording only.
"""

from __future__ import annotations

import argparse
import importlib
import json
import platform
import re
import sys
import time
from collections.abc import Callable
from datetime import datetime, timezone
from importlib.metadata import version
from typing import Any

import numpy as np

import compare.engines
from compare.claims.as_json import as_json
from compare.claims.error_estimates import COARSENING
from compare.diagnosis.findings import PROBES, parts_of
from compare.engines import Engine
from compare.foreign.cases import CASES, Case
from compare.foreign.records import COLUMNS, DIGITS, FOLDER
from reference_model import SimulationError, Trajectory

LONGEST = 0.7
"""Seconds: the first run that takes so long is the last of its ladder,"""

LEAST = 5
"""unless it has fewer runs than this, which an order takes."""

TOLERANCES = 1e-2 / COARSENING ** np.arange(12)

FOREIGN = {"mujoco": "MuJoCo", "bullet": "Bullet", "drake": "Drake", "dart": "DART"}
"""By the name of the module, which is ``<name>_engine``."""

PACKAGES = {
    "mujoco": "mujoco",
    "bullet": "pybullet",
    "drake": "drake",
    "dart": "dartpy",
    "reference": "friction-discs",
    "exudyn": "exudyn",
    "exudyn-native": "exudyn",
}

WHEELS = {
    "mujoco": "Linux, macOS and Windows",
    "bullet": "Linux; elsewhere pip compiles it",
    "drake": "Linux, and macOS with newer Pythons; none for Windows",
    "dart": "Linux, and from Python 3.12 on macOS and Windows",
}
"""Where pip finds a package ready to use."""

Simulate = Callable[..., Trajectory]


def settings_of(name: str) -> dict[str, Simulate]:
    """Return what simulates with each setting of an engine, by its name; raise ``ImportError`` without it."""
    if name in FOREIGN:
        settings = importlib.import_module(f"{name}_engine").SETTINGS
        return {setting.name: setting for setting in settings}
    (engine,) = compare.engines.engines([name])
    return {"": engine.simulate}


def ladder(simulate: Simulate, case: Case) -> list[list[float | None]]:
    """Return a row of ``COLUMNS`` for each tolerance, from the largest on."""
    _timed(simulate, case, case.times[:2], TOLERANCES[0])  # what is compiled or loaded at the first call
    rows: list[list[float | None]] = []
    before = None
    for tolerance in TOLERANCES.tolist():
        trajectory, seconds, wall = _timed(simulate, case, case.times, tolerance)
        if trajectory is None:
            continue  # at a tolerance this large
        found = case.quantity(trajectory)
        error = float(np.max(np.abs(found - case.exact())))
        change = None if before is None else float(np.max(np.abs(found - before)))
        if change != 0.0:  # as where the longest or the shortest step of an engine comes before the tolerance
            row = (tolerance, trajectory.solution.steps, error, change, seconds, wall)
            rows.append([value and float(f"{value:.{DIGITS}g}") for value in row])
            before = found
        if seconds > LONGEST and len(rows) >= LEAST:
            break
    return rows


def _timed(
    simulate: Simulate, case: Case, times: Any, tolerance: float
) -> tuple[Trajectory | None, float, float]:
    wall, processor = time.perf_counter(), time.process_time()
    try:
        trajectory = simulate(case.system, case.start, times, tolerance=tolerance)
    except SimulationError as error:
        print(f"  tolerance {tolerance:g}: {error}")
        return None, 0.0, 0.0
    return trajectory, time.process_time() - processor, time.perf_counter() - wall


def record(name: str) -> dict[str, Any]:
    """Measure all settings of an engine; raise ``ImportError`` if it is not installed."""
    settings = []
    for setting, simulate in settings_of(name).items():
        print(f"{name}: {setting}", flush=True)
        runs = {key: ladder(simulate, case) for key, case in CASES.items()}
        says = getattr(simulate, "says", "")
        settings.append({"name": setting, "says": says, "probes": probes(name, simulate), "runs": runs})
    return {
        "engine": FOREIGN.get(name, name),
        "version": version(PACKAGES[name]),
        "recorded": f"{datetime.now(timezone.utc):%Y-%m-%d}",
        "platform": f"{platform.system()} {platform.machine()}, Python {platform.python_version()}",
        "columns": COLUMNS,
        "settings": settings,
    }


def probes(name: str, simulate: Simulate) -> dict[str, Any]:
    """Return what tells the law of friction of a setting, as JSON."""
    engine = Engine(name, simulate, phases=False, nonlinear=False)
    return {probe: as_json(parts_of(engine)[probe](engine)) for probe in PROBES}


def record_laws(name: str) -> dict[str, Any]:
    """Return what is recorded of an engine with what tells its laws measured anew."""
    found: dict[str, Any] = json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8"))
    simulating = settings_of(name)
    for setting in found["settings"]:
        setting["probes"] = probes(name, simulating[setting["name"]])
    return found


def written(found: dict[str, Any]) -> str:
    """Return JSON with a line for each row of numbers."""
    text = json.dumps(found, ensure_ascii=False, indent=1)
    rows = re.sub(r"\[([^\[\]{}\"]+)\]", lambda row: "[" + " ".join(row[1].split()) + "]", text)
    return rows + "\n"


def main() -> None:
    """Record the engines that are named, or all."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("engines", nargs="*", metavar="ENGINE", help=", ".join(PACKAGES))
    parser.add_argument(
        "--laws", action="store_true", help="measure anew what tells the law, and nothing else"
    )
    given = parser.parse_args()
    names = given.engines or list(PACKAGES)
    if unknown := set(names) - set(PACKAGES):
        parser.error(f"no engine {', '.join(sorted(unknown))}: known are {', '.join(PACKAGES)}")
    for name in names:
        try:
            found = record_laws(name) if given.laws else record(name)
        except ImportError as error:
            wheels = f"; wheels of {PACKAGES[name]} are for {WHEELS[name]}" if name in WHEELS else ""
            print(f"{name} is left out, it is not installed ({error}){wheels}", file=sys.stderr)
            continue
        (FOLDER / f"{name}.json").write_text(written(found), encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()
