"""Diagnosis of engines by parts that run in worker processes."""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import is_dataclass, replace
from typing import Any, NamedTuple

from compare.claims.as_json import from_json
from compare.claims.error_estimates import ROUNDING
from compare.diagnosis import friction_benchmark
from compare.diagnosis.findings import PROBES, Motion, parts_of
from compare.diagnosis.joint_probes import JOINT, first_check_of_joints
from compare.diagnosis.ladder import RUNGS, falling
from compare.diagnosis.probes import CHECKED_FOR, REACH, SLIDE, first_check
from compare.diagnosis.row import RIGHT, Row
from compare.engines import DeclaredLackError, Engine, OutOfRangeError, UnsupportedSystemError, owner_of
from compare.foreign import CASES, ERROR, SECONDS, STEPS, TOLERANCE, Recording, estimate, recordings
from compare.run.runner import loaded
from compare.run.workers import Failure, Workers
from reference_model.systems import DiscOnDisc, FloatArray, PinOnDisc, System
from reference_model.systems.joint import FrictionJoint

IN_SHORT = 20.0  # in s for each part


def diagnosed(
    engines: tuple[Engine, ...],
    *,
    limit: float,
    jobs: int = 1,
    progress: Callable[[int, int, str], None] = lambda done, total, name: None,
) -> Iterator[Row]:
    """Yield the row of each engine in order of completion; an engine that supports no part has an empty row.

    A row reports parts that exceed ``limit`` (s). ``progress`` is called with the numbers of finished and of all
    parts, and the name of the last part.
    """
    parts = {engine: list(parts_of(engine)) for engine in engines}
    rows = {engine.name: _empty(engine) for engine in engines}
    left = {engine.name: len(parts[engine]) for engine in engines}
    yield from (rows[name] for name, count in left.items() if count == 0)
    with Workers(jobs, limit) as workers:
        for engine in engines:
            for part in parts[engine]:
                workers.submit((engine.name, part), measured, engine, part, owner=owner_of(engine))
        for number, done in enumerate(workers.finished(), 1):
            key: Any = done.key
            name, part = key
            rows[name] = _with(rows[name], part, done.value, done.seconds)
            progress(number, sum(map(len, parts.values())), f"{name} {part}")
            left[name] -= 1
            if left[name] == 0:
                yield rows[name]


def checked(engines: Iterable[Engine], workers: Workers) -> Iterator[tuple[Engine, str | Row]]:
    """Yield each engine with a sentence about two blocks, or two joints, one that moves and one that should rest.

    The sentence is "" for an engine that simulates neither. If an engine has no result, its row appears instead.
    """
    for engine in engines:
        of_joints = engine.simulates(JOINT) and not engine.simulates(SLIDE)
        check = first_check_of_joints if of_joints else first_check
        found = workers.ask(_or_reason, check, engine, owner=owner_of(engine))
        if found is None or isinstance(found, str | LeftOut):
            yield engine, ""
        elif isinstance(found, Failure):
            yield engine, _with(_empty(engine), "two joints" if of_joints else "two blocks", found)
        else:
            (slid, exact), (moved, rest) = found
            body, verb, limit, unit = (
                ("joint", "turns", "F", "rad") if of_joints else ("block", "slides", "μN", "m")
            )
            slides = f"a {body} {verb} {slid:.7g} {unit} in {CHECKED_FOR:g} s (exact: {exact:.7g} {unit})"
            rests = (
                f"a {body} under half of the limit {limit} moves {moved:.2g} {unit} (exact: {rest:g} {unit})"
            )
            yield engine, f"{slides}, and {rests}"


def in_short(engines: Iterable[Engine | str]) -> Iterator[str]:
    """Yield a line with the diagnosis of each engine whose claims failed, from the probes alone."""
    with Workers(1, IN_SHORT) as workers:
        for engine in engines:
            name = engine if isinstance(engine, str) else engine.name
            try:
                (known,) = loaded([engine], workers) if isinstance(engine, str) else (engine,)
                row = _probed(known, workers)
                said = "single blocks show no error." if row.verdict == RIGHT else " ".join(row.sentences)
                yield f"{name}: {said}"
            except ValueError as error:  # the engine cannot be imported
                yield str(error)


def _probed(engine: Engine, workers: Workers) -> Row:
    row, parts = _empty(engine), parts_of(engine)
    for part in PROBES:
        if part in parts and not row.gaps:
            row = _with(row, part, workers.ask(measured, engine, part, owner=owner_of(engine)))
    return row


def measured(engine: Engine, part: str) -> Any:
    """Return one part of an engine's diagnosis, why the engine refuses it, or None if its declaration excludes it."""
    return _or_reason(parts_of(engine)[part], engine)


class LeftOut(NamedTuple):
    """A part that needs motions beyond the ranges that the engine declares."""

    reason: str


def _or_reason(measure: Callable[[Engine], Any], engine: Engine) -> Any:
    try:
        return measure(engine)
    except OutOfRangeError as error:
        return LeftOut(str(error))
    except DeclaredLackError:
        return None
    except UnsupportedSystemError as error:
        return str(error)


def _empty(engine: Engine) -> Row:
    return Row(engine.name, engine.version, engine.step or math.nan)


def _with(row: Row, part: str, found: Any, seconds: float = 0.0) -> Row:
    row = replace(row, seconds=row.seconds + seconds)
    if isinstance(found, LeftOut):
        return replace(row, left_out=row.left_out | {part: found.reason})
    if isinstance(found, str) or (isinstance(found, Failure) and found.unfinished):
        return replace(row, not_measured=row.not_measured | {part: str(found)})
    if isinstance(found, Failure):
        return replace(row, gaps=row.gaps | {part: str(found)})
    if isinstance(found, Motion):
        return replace(row, motions=row.motions | {part: found})
    return row if found is None else replace(row, **{part: found})  # names in PROBES are fields of the row


def benchmarked(engine: Engine) -> dict[str, Any]:
    """Return the engine's results in ``friction_benchmark``, with springs for constant forces on blocks."""

    def moved(case: friction_benchmark.Case, times: Sequence[float]) -> list[Any]:
        system, start, share = _system_of(case)
        try:
            states = engine.simulate(system, start, times).states
        except UnsupportedSystemError as error:
            raise NotImplementedError(str(error)) from None
        half = len(start) // 2
        places = [(*state[:half], 0.0)[:2] for state in states.tolist()]
        return [(x / share, y, math.nan, math.nan) for x, y in places]  # only places are measured

    return friction_benchmark.run(moved)


def _system_of(case: friction_benchmark.Case) -> tuple[System | FrictionJoint, tuple[float, ...], float]:
    """Return the system of a case, its start, and its path as a share of that under the force of the case.

    A spring from as far away as the probes reach, or somewhat more, stands for a constant force. Under constant
    friction the path a·t²/2 becomes a·(1 − cos φ)/k, φ = t·√k, with the stiffness k over the mass.
    """
    x, y, vx, vy = case.start
    common = {"stiffness": case.stiffness, "damping": case.damping}
    if case.inertia:
        common |= {"friction_moment": case.friction, "static_ratio": case.static_ratio}
        ends = tuple((time, case.force[0] + case.growth * time) for time in (0.0, case.until))
        return FrictionJoint(inertia=case.inertia, moment=ends, **common), (x, vx), 1.0
    common |= {"mass": case.mass, "friction_force": case.friction, "disc_speed": case.plate_speed}
    if case.radius:
        ring = {"contact_radius": case.radius, "polar_inertia": case.mass * case.radius**2}
        disc = DiscOnDisc(**common, **ring, shaft_damping=0.0, shaft_speed=0.0, contact_points=None)
        return disc, (x, y, 0.0, vx, vy, case.spin), 1.0
    if not (pull := case.force[0]):
        return PinOnDisc(**common), case.start, 1.0
    slides = pull > case.friction
    reach = max(REACH, pull * case.until**2 / case.mass) if slides else REACH
    phase = math.sqrt(pull / reach / case.mass) * case.until
    share = 2.0 * (1.0 - math.cos(phase)) / phase**2 if slides else 1.0
    return PinOnDisc(**common | {"stiffness": pull / reach}, offset=reach), case.start, share


# --- Rows from recordings of foreign engines.


def recorded_rows() -> tuple[Row, ...]:
    """Return a row for each recorded setting."""
    return tuple(row_of(recording) for recording in recordings() if recording.setting)


def row_of(recording: Recording) -> Row:
    """Return the row of a recording."""
    step = recording.step
    motions = {name: _motion(runs, name, by_step=step is not None) for name, runs in recording.runs.items()}
    probes: dict[str, Any] = {
        name: from_json(PROBES[name], content) if is_dataclass(PROBES[name]) else content
        for name, content in recording.probes.items()
    }
    version = f"{recording.version}, recorded on {recording.recorded}"
    return Row(recording.name, version, step or math.nan, motions=motions, **probes)


def _motion(runs: FloatArray, name: str, *, by_step: bool) -> Motion:
    last = runs[[-min(len(runs), 3), -1]]  # two refinements, because the last may be small
    sizes = 1.0 / last[:, STEPS] if by_step else last[:, TOLERANCE]
    ratio = float(sizes[0] / sizes[1]) if len(runs) > 1 else math.nan
    return Motion(
        tuple(runs[-RUNGS:, ERROR].tolist()),
        max(estimate(runs) + ROUNDING * max(map(abs, CASES[name].start)), CASES[name].negligible),
        falling(last[:, ERROR], ratio),
        CASES[name].resolution,
        float(runs[-1, SECONDS]),
    )
