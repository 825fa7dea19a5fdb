"""Claims."""

import functools
import math
from typing import Any

import numpy as np

import compare.output.figures as plots
import compare.studies.drivetrain.coupled_clutches.theory as theory
from compare.claims import ByEngine, Data, Figures, Measured, Study, observed_exponent
from compare.claims.parameters import at_each
from compare.engines import DeclaredLackError, Engine
from compare.output.figures import Axes, axis, engine_style, engines_in, new_figure
from compare.studies.drivetrain.coupled_clutches.theory import EPSILONS, exact, published, with_our_contact
from compare.studies.toolkit.torsional_chain import STUCK
from reference_model.systems import FloatArray

SHOWN, STEPS, INERTIAS = theory.SHOWN, theory.STEPS, theory.INERTIAS
BRISTLES, SMALL_EPSILON = theory.BRISTLES, theory.SMALL_EPSILON
ROTORS = tuple(f"speed of rotor {i + 1}" for i in range(len(INERTIAS)))
FOLLOWED = STEPS[[0, 2]]

EVENTS = tuple(
    f"clutch {clutch + 1} {'sticks' if mode == STUCK else 'releases'} at {time:.4f} s"
    for time, clutch, mode in theory.switches()
)
OF_ORDER = (
    "Largest error of a speed. Numerical error: scatter about the power law. Model error: the next term."
)


def curves() -> Data:
    t = np.linspace(0.0, theory.UNTIL, 1501)
    record = published()
    off = record.speeds - theory.first_and_slips(exact().states(record.times)[1])
    return {"t": t, "speeds": exact().states(t)[1], "published t": record.times, "published": off}


SOURCE = "Modelica.Mechanics.Rotational.Examples.CoupledClutches"
ENGINES = ("exudyn", "exudyn-native")
STUDY = Study.beside(__file__, "coupled-clutches", source=SOURCE, only=ENGINES, contact=True, seconds=2.0)


def _speeds(t: FloatArray) -> FloatArray:
    return exact().states(t)[1]


def _is_native(engine: Engine) -> bool:
    return engine.kin == "exudyn"


@functools.lru_cache(maxsize=2)
def _runs(engine: Engine) -> list[theory.Run]:
    if _is_native(engine):
        return [theory.with_bristles(*of_one) for of_one in BRISTLES]
    return [with_our_contact(float(epsilon)) for epsilon in EPSILONS]


def _explicit(engine: Engine) -> list[theory.Run]:
    _check_has_epsilon(engine)
    return _runs(engine)


@functools.lru_cache(maxsize=len(STEPS))
def _implicit(engine: Engine, step: float) -> theory.Run:
    _check_has_epsilon(engine)
    until = theory.UNTIL if step in FOLLOWED else theory.ALL_SLIP_UNTIL
    return with_our_contact(SMALL_EPSILON, step, until=until)


def _check_has_epsilon(engine: Engine) -> None:
    if _is_native(engine):
        raise DeclaredLackError("Exudyn's own connector sticks by bristles and has no ε")


HALVED = (
    "Result of the finest run. Numerical error: twice the largest change from the next coarser run, whose errors of "
    "first order are twice as large."
)


def _finest(runs: list[FloatArray]) -> tuple[FloatArray, float]:
    return runs[0], 2.0 * float(np.max(np.abs(runs[0] - runs[1])))


@STUDY.claim(
    "Three clutches in a row move four rotors through slip and stick as exact Coulomb friction does",
    kind="trajectory",
    unit="rad/s",
    resolution=1e-3,
    note=HALVED,
)
def moves(engine: Engine) -> Measured:
    runs = _runs(engine)
    found, error = _finest([run.at(SHOWN) for run in runs])
    note = (
        f"Exudyn's CoordinateSpringDamperExt with bristles of {BRISTLES[0][1]:g} N m/rad and implicit steps of "
        f"{BRISTLES[0][0]:g} s; the coarser run has a quarter of that stiffness and twice that step."
        if _is_native(engine)
        else f"add_ring_friction with ε = {EPSILONS[0]:g} m/s, explicit."
    )
    data = {"run t": runs[0].times, "run off": runs[0].speeds - _speeds(runs[0].times)}
    return _of_speeds(found, error, note=note, named={"speeds of four rotors": None}, data=data)


@STUDY.claim(
    "Each clutch sticks and releases at the times of exact Coulomb friction",
    unit="s",
    resolution=1e-3,
    note=f"Times when the slip passes ε = {EPSILONS[0]:g} m/s, nearest to each event. {HALVED}",
)
def switches_on_time(engine: Engine) -> Measured:
    runs = zip(_explicit(engine), EPSILONS.tolist(), strict=True)
    times, error = _finest([_passings(run, epsilon) for run, epsilon in runs])
    return Measured(
        predicted=[time for time, *_ in theory.switches()], value=times, error=error, components=EVENTS
    )


def _passings(run: theory.Run, epsilon: float) -> FloatArray:
    """Return for each event the nearest time (s) when the slip passes ``epsilon`` (rad/s), or NaN."""
    found = []
    for time, clutch, mode in theory.switches():
        above = (np.abs(run.slips[:, clutch]) - epsilon) * (1.0 if mode == STUCK else -1.0)
        first = np.flatnonzero((above[:-1] > 0.0) & (above[1:] <= 0.0))
        share = above[first] / (above[first] - above[first + 1])
        passed = run.times[first] + share * (run.times[first + 1] - run.times[first])
        found.append(_nearest(passed, time))
    return np.array(found)


def _nearest(times: FloatArray, time: float) -> float:
    return float(times[np.argmin(np.abs(times - time))]) if times.size else math.nan


@STUDY.claim(
    "Four rotors gain the angular momentum that the torque on the first rotor supplies",
    kind="conservation",
    friction=False,
    unit="kg m²/s",
    resolution=1e-8,
    note="At the end. Numerical error: eight times the difference between the runs of the first claim; rounding, "
    "which grows as the root of the number of steps; and the impulse of the largest torque in the gaps that "
    "solve_dynamic leaves at breaks in all runs.",
)
def momentum(engine: Engine) -> Measured:
    from exudyn_models.solver.breaks import GAP

    gaps = 2.0 * GAP * theory.UNTIL * len({*theory.BREAKS, *SHOWN.tolist()})  # s
    runs = _runs(engine)
    found = [float(np.dot(INERTIAS, run.speeds[-1])) for run in runs]
    return Measured(
        predicted=float(np.dot(INERTIAS, _speeds(np.array([theory.UNTIL]))[0])),
        value=found[0],
        error=8.0
        * (float(np.ptp(found)) + np.finfo(float).eps * theory.SPEED * math.sqrt(len(runs[0].times)))
        + gaps * theory.TORQUE,
    )


@STUDY.claim(
    "With implicit steps, the clutches move four rotors through slip and stick as exact Coulomb friction does",
    kind="trajectory",
    unit="rad/s",
    resolution=1e-3,
    note=f"At steps of {STEPS[0]:g} s and ε = {SMALL_EPSILON:g} m/s. Numerical error: the largest change from a run "
    "with four times the step, because errors scatter with the position of an event within its step.",
)
def implicit(engine: Engine) -> Measured:
    fine, coarse = (_implicit(engine, float(step)).at(SHOWN) for step in FOLLOWED)
    return _of_speeds(fine, float(np.max(np.abs(fine - coarse))))


def _of_speeds(found: FloatArray, error: float, **more: Any) -> Measured:
    at = {"t in s": SHOWN}
    return Measured(predicted=_speeds(SHOWN), value=found, error=error, components=ROTORS, at=at, **more)


@STUDY.claim(
    "The error of explicit runs falls like ε while clutches stick",
    kind="order",
    resolution=0.1,
    note=f"{at_each('ε in m/s', EPSILONS)}. {OF_ORDER}",
)
def order_in_epsilon(engine: Engine) -> Measured:
    """Measure before the first release, whose delay contains a logarithm of ε."""
    times = SHOWN[(SHOWN > theory.ALL_SLIP_UNTIL + 0.01) & (SHOWN < theory.LETS_GO_FROM)]
    return _order(EPSILONS, _explicit(engine), times, predicted=1.0)


@STUDY.claim(
    "The error of implicit runs falls like the square of the step while all clutches slip",
    kind="order",
    resolution=0.1,
    note=f"{at_each('step in s', STEPS)}; ε = {SMALL_EPSILON:g} m/s. {OF_ORDER}",
)
def order_in_step(engine: Engine) -> Measured:
    runs = [_implicit(engine, float(step)) for step in STEPS]
    return _order(STEPS, runs, SHOWN[SHOWN < theory.ALL_SLIP_UNTIL + 0.01], predicted=2.0)


def _order(lengths: FloatArray, runs: list[theory.Run], times: FloatArray, *, predicted: float) -> Measured:
    errors = np.array([np.max(np.abs(run.at(times) - _speeds(times))) for run in runs])
    exponent, numerical, model = observed_exponent(lengths, errors, next_term=1.0)
    words = ", ".join(f"{error:.3g} rad/s" for error in errors)
    return Measured(
        predicted=predicted,
        value=exponent,
        error=numerical,
        model=model,
        note=f"From {times[0]:g} to {times[-1]:g} s. Errors: {words}.",
    )


OF_PUBLISHED = (
    "Published by the Modelica Association: Dymola 2020x, DASSL. Numerical error: "
    f"{theory.ACCUMULATED:g} times Dymola's relative tolerance of {theory.PUBLISHED_TOLERANCE:g}, times the largest "
    "value of the same kind."
)
SLIPS = tuple(f"slip of clutch {i}" for i in range(1, len(INERTIAS)))


def _published(values: FloatArray, predicted: FloatArray, components: tuple[str, ...]) -> Measured:
    allowed = theory.ACCUMULATED * theory.PUBLISHED_TOLERANCE * float(np.max(np.abs(predicted)))
    worst = np.argmax(np.abs(values - predicted), axis=0), np.arange(len(components))
    return Measured(predicted=predicted[worst], value=values[worst], error=allowed, components=components)


@STUDY.claim(
    "Modelica's published speeds of CoupledClutches equal the exact speeds",
    kind="trajectory",
    basis="independent",
    unit="rad/s",
    resolution=1e-3,
    note=f"Where they differ most. {OF_PUBLISHED}",
    named={"published speed": 0},
)
def published_speeds() -> Measured:
    predicted = theory.first_and_slips(_speeds(published().times))
    return _published(published().speeds, predicted, ("speed of rotor 1", *SLIPS))


@STUDY.claim(
    "Modelica's published angles of CoupledClutches equal the exact angles",
    kind="trajectory",
    basis="independent",
    unit="rad",
    resolution=1e-3,
    note=f"Where they differ most. {OF_PUBLISHED}",
)
def published_angles() -> Measured:
    predicted = theory.first_and_slips(exact().states(published().times)[0])
    names = ("angle of rotor 1", *(f"angle of {one}" for one in SLIPS))
    return _published(published().angles, predicted, names)


@STUDY.claim(
    "Modelica's published clutches stick and release at the exact times",
    basis="independent",
    unit="s",
    resolution=1e-3,
    note=OF_PUBLISHED,
)
def published_switches() -> Measured:
    times, modes = published().times, published().modes
    found = []
    for time, clutch, mode in theory.switches():
        begins = (modes[1:, clutch] == mode) & (modes[:-1, clutch] != mode)
        found.append(_nearest(times[1:][begins], time))
    return _published(np.array([found]), np.array([[time for time, *_ in theory.switches()]]), EVENTS)


EXACT = 1e-7
"""Lower end of the axis in rad/s."""


def draw(data: ByEngine) -> Figures:
    if not data:
        return {}
    figure, (speeds, errors) = new_figure(nrows=2, width=9.0, height=6.4, sharex=True, height_ratios=(3, 2))
    exact_motion = data.get("theory", {})
    if "t" in exact_motion:
        for number, speed in enumerate(exact_motion["speeds"].T):
            colour, label = plots.PALETTE[number], f"rotor {number + 1}"
            speeds.plot(exact_motion["t"], speed, color=colour, linewidth=1.6, label=label)
        speeds.legend(loc="upper right")
        record = exact_motion["published t"], exact_motion["published"]
        _error(errors, *record, "Modelica, as published", plots.GREY)
    for engine in engines_in(data):
        found = data[engine]
        if "run t" in found:
            _error(errors, found["run t"], found["run off"], engine, engine_style(engine).colour)
    for time, clutch, mode in theory.switches():
        for panel in (speeds, errors):
            panel.axvline(time, color=plots.GREY, linewidth=0.6, linestyle="-" if mode == STUCK else ":")
        words = f"{clutch + 1} {'sticks' if mode == STUCK else 'releases'}"
        speeds.annotate(words, (time, 10.6), rotation=90, ha="right", va="top", fontsize=8.0, color="0.3")
    speeds.set(ylabel="speed in rad/s", ylim=(-0.3, 10.8))
    errors.set(xlabel=axis("t", "s"), xlim=(0.0, 1.5))
    errors.set(ylabel="largest speed error\nin rad/s", yscale="log", ylim=(EXACT, 0.1))
    if errors.get_legend_handles_labels()[0]:
        errors.legend(loc="upper left", ncols=3, fontsize=9.0)
    return {"coupled-clutches": figure}


def _error(panel: Axes, t: np.ndarray, off: np.ndarray, label: str, colour: str) -> None:
    panel.plot(t, np.maximum(np.max(np.abs(off), axis=1), EXACT), color=colour, linewidth=1.0, label=label)


STUDY.provides(figures=draw, curves=curves)
