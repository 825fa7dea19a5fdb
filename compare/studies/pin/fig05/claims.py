"""Fig. 5: equilibrium and whirl side by side, the stick phases on the way, and the start that divides them."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable

import numpy as np

from compare.claims.error_estimates import Measurement, open_where_coarse, refined
from compare.claims.measured import Measured, answers_of, asked
from compare.claims.paper_parameters import FIG5, FIG5_STARTS
from compare.claims.parameters import components_of
from compare.claims.study import Study
from compare.engines import Engine
from compare.studies.pin.fig05.parameters import (
    CAPTURE,
    CRITICAL_TOLERANCE,
    FURTHER_TURNS,
    RUNS_TOLERANCE,
    SAMPLES,
    SIDES_TOLERANCE,
    SLIDING_START,
    SLIDING_TIMES,
    SOURCE,
    UNTIL,
)
from compare.studies.pin.fig05.pictures import animate, draw
from compare.studies.pin.fig05.theory import (
    critical_velocity,
    first_stick_and_release,
    outside_at_end,
    predicted_critical_velocity,
    reference_events,
    sliding_in_polar_form,
    whirl,
)
from compare.studies.toolkit.deviations import remaining_transient
from reference_model import Trajectory
from reference_model.formulas.pin import equilibrium_position
from reference_model.steady.stability import equilibrium_eigenvalues
from reference_model.systems import FloatArray

STUDY = Study.beside(__file__, "fig05", source=SOURCE, system=FIG5, seconds=4.5)
STUDY.provides(figures=draw, animations=animate)


@functools.lru_cache(maxsize=8)
def run_of(engine: Engine, name: str, tolerance: float) -> Trajectory:
    """Return the run of Fig. 5 to the motion ``name``."""
    times = np.linspace(0.0, UNTIL, SAMPLES)
    return engine.simulate(FIG5, FIG5_STARTS[name], times, tolerance=tolerance)


@STUDY.claim(
    "A sliding pin moves for 100 s as (10) says, integrated independently in polar form",
    equation="(1), (10)",
    kind="trajectory",
    unit="m, m/s",
    resolution=1e-7,
    basis="independent",  # (10) has equations and an integration of its own
    named={"slip for 100 s": None},
)
def slides(engine: Engine) -> Measured:
    """Compare the state of a sliding pin at 101 times with (10)."""
    # The other integrator's own error: its change at a larger tolerance.
    predicted, rougher = (sliding_in_polar_form(tolerance).ravel() for tolerance in (3e-14, 2e-13))
    found = refined(
        lambda tolerance: engine.simulate(
            FIG5, SLIDING_START, SLIDING_TIMES, tolerance=tolerance
        ).states.ravel()
    )
    return Measured(
        predicted=predicted,
        value=found.value,
        error=found.plus(np.abs(rougher - predicted)).largest,  # a single number may be right by chance
        components=[f"t = {t:g} s, {name}" for t in SLIDING_TIMES for name in components_of(FIG5)],
        source="Fig. 5; start (0.9, 0, 0, 0.9) is an assumption: near to the whirl, without sticking",
    )


@STUDY.claim(
    "The first start of Fig. 5 ends in the self-centred equilibrium",
    equation="(3)",
    unit="m",
    resolution=1e-6 * FIG5.offset,
)
def rests(engine: Engine) -> Measured:
    """Compare the end of the first run with (3)."""
    found = refined(lambda tolerance: run_of(engine, "equilibrium", tolerance).at_end[:2], RUNS_TOLERANCE)
    states = run_of(engine, "equilibrium", RUNS_TOLERANCE).states
    rate = -max(value.real for value in equilibrium_eigenvalues(FIG5))
    left = remaining_transient(states[-700:-300, :2], states[-1, :2], rate, 30.0)
    return Measured(
        predicted=equilibrium_position(FIG5),
        value=found.value,
        error=found.plus(left).largest,
        components=("x", "y"),
        source=f"{SOURCE}; t = {UNTIL:g} s",
    )


@STUDY.claim(
    "The second start of Fig. 5 ends on the whirl, whose mean is that of the periodic orbit",
    equation="(17)",
    kind="trajectory",
    unit="m",
    resolution=1e-6 * FIG5.offset,
    note="Predicted: the periodic orbit found by shooting with the reference at its tightest. Remaining transient: "
    "the orbit's slowest multiplier over the time since the last stick phase.",
)
def whirls(engine: Engine) -> Measured:
    """Let the second run go on for some more turns, and average the last one."""
    orbit = whirl()
    times = np.concatenate(([0.0], orbit.period * (FURTHER_TURNS + np.linspace(0.0, 1.0, 129))))

    def mean(tolerance: float) -> FloatArray:
        end = run_of(engine, "whirl", tolerance).at_end
        states = engine.simulate(FIG5, end, times, tolerance=tolerance).states
        return np.asarray(states[1:-1, :2].mean(axis=0))

    found = refined(mean, RUNS_TOLERANCE)
    multiplier = sorted(abs(value) for value in orbit.multipliers)[-2]  # the largest but that of the phase
    # What is left of the transient after the run, from the largest deviation that it can have had at its start.
    left = float(np.max(np.abs(orbit.state))) * multiplier ** ((UNTIL - 60.0) / orbit.period + FURTHER_TURNS)
    return Measured(
        predicted=orbit.mean,
        value=found.value,
        error=found.plus(left).largest,
        components=("x", "y"),
        source=f"{SOURCE}; t = {UNTIL:g} s and {FURTHER_TURNS} turns",
    )


@STUDY.claim(
    "A pin on its way to the {} first sticks when its slip by (10) ends, and is let go when (7) says",
    equation="(7), (10)",
    kind="trajectory",
    unit="s",
    resolution=1e-3,
    basis="independent",  # nothing of the reference's simulation takes part
    each=tuple(FIG5_STARTS),
)
def first_stick(engine: Engine, name: str) -> Measured:
    """Compare the first stick phase with a plain event on the slip and (7)."""
    predicted = refined(lambda tolerance: first_stick_and_release(name, tolerance), 4e-13)
    found = _events(engine, name, lambda times: _padded(times[:2], 2))
    return Measured(
        predicted=predicted.value,
        value=found.value,
        error=found.plus(predicted.error).largest,
        components=("stick", "release"),
        size=1.0 / FIG5.natural_frequency,
    )


@STUDY.claim(
    "All stick and release times on the way to the {} are those of exact Coulomb friction",
    equation="(6), (7)",
    kind="trajectory",
    unit="s",
    resolution=1e-2,
    note="Predicted: the reference at tolerance 1e-13. A stick phase too many or too few shows as a missing number.",
    each=tuple(FIG5_STARTS),
)
def all_sticks(engine: Engine, name: str) -> Measured:
    """Compare all stick and release times with those of the reference."""
    predicted = reference_events(name)
    found = _events(engine, name, lambda times: _padded(times, len(predicted)))
    run = run_of(engine, name, RUNS_TOLERANCE)
    return Measured(
        predicted=predicted,
        value=found.value,
        error=found.largest,
        size=1.0 / FIG5.natural_frequency,
        components=[
            f"{event} no. {i}" for i in range(1, len(predicted) // 2 + 1) for event in ("stick", "release")
        ],
        named={f"events on the way to the {name}": None},
        data={
            f"{name}: times": run.times,
            f"{name}: states": run.states,
            f"{name}: sticks": run.stick_times,
            f"{name}: reference sticks": predicted,
            f"{name}: error bar of sticks": found.largest,
        },
    )


def _events(engine: Engine, name: str, chosen: Callable[[FloatArray], FloatArray]) -> Measurement:
    """Return the stick and release times in s that are ``chosen`` from those of a run."""
    found = refined(lambda tolerance: chosen(run_of(engine, name, tolerance).stick_times), RUNS_TOLERANCE)
    return open_where_coarse(
        found, refined(lambda tolerance: run_of(engine, name, tolerance).states, RUNS_TOLERANCE)
    )


def _padded(events: FloatArray, size: int) -> FloatArray:
    """Return ``events`` if there are ``size`` of them, and no numbers otherwise."""
    return events if len(events) == size else np.full(size, np.nan)


@STUDY.claim(
    "The initial velocity that parts the two motions of Fig. 5 is that of exact Coulomb friction",
    kind="trajectory",
    unit="m/s",
    resolution=CAPTURE,
    note="Where the second stick phase is as far from the axis as the first. Between slip phases a pin has one "
    "degree of freedom, the radius at which it sticks, so the motions divide at the fixed point of the map from "
    "one stick phase to the next. Predicted: the reference at tolerance 1e-12.",
    named={"dividing velocity": 0},
)
def critical(engine: Engine) -> Measured:
    """Find the initial velocity that divides both motions."""
    found = _critical(engine)
    return Measured(
        predicted=predicted_critical_velocity(),
        value=found.value,
        error=found.largest,
        source=f"{SOURCE}; x(0) = 0.1, vx(0) between the two printed values",
    )


def _critical(engine: Engine) -> Measurement:
    return refined(functools.partial(critical_velocity, engine), CRITICAL_TOLERANCE)


@STUDY.claim(
    "Starts 1e-6 m/s below and above the critical velocity end in equilibrium and whirl",
    note="Whether the end is nearer to the axis than 2·X0, then whether it is farther; run to 220 s, from the "
    "engine's own critical velocity.",
    basis="self-check",
)
def sides(engine: Engine) -> Measured:
    """See what becomes of the neighbours of the engine's critical velocity."""
    margins, errors = asked(functools.partial(_parted, engine), SIDES_TOLERANCE)
    if _critical(engine).largest > CAPTURE:  # it may as well part them at another start
        errors = np.full_like(margins, math.inf)
    return answers_of(
        margins,
        errors,
        parameters={"tolerance": SIDES_TOLERANCE},
    )


def _parted(engine: Engine, tolerance: float) -> FloatArray:
    """Return by how much in m starts beside the engine's critical velocity end inside and outside of 2·X0."""
    middle = critical_velocity(engine, tolerance)
    if not math.isfinite(middle):
        return np.full(2, math.nan)
    return np.array(
        [side * outside_at_end(engine, middle + side * CAPTURE, tolerance) for side in (-1.0, 1.0)]
    )
