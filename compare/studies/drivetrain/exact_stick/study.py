"""Claims and figure."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

import compare.studies.drivetrain.exact_stick.theory as theory
from compare.claims import ByEngine, Data, Figures, Measured, Study
from compare.claims.error_estimates import TRUTH
from compare.claims.parameters import FIG5, FIG5_STARTS, FIG9, components_of
from compare.engines import Engine
from compare.output.figures import GREY, axis, curve, engines_in, new_figure, points
from compare.studies.drivetrain.exact_stick.theory import Event, Model
from compare.studies.toolkit.torsional_chain import BACKWARD, FORWARD, OPEN, STUCK
from reference_model import simulate
from reference_model.systems import FloatArray, PinOnDisc, System

SOLVERS, STEPS, COARSER = ("TrapezoidalIndex2", "GeneralizedAlpha"), (2e-3, 4e-3, 8e-3), 2.0
"""Solvers with exact stick, steps in s, and a factor on the steps of slow motions."""

SPEEDS, UNTIL, BRAKED = (6.0, 0.0, 0.0, -2.0), 2.0, 0.35
"""Initial speeds of four rotors in rad/s, the duration of their motion in s, and the duration for the braked
wheel."""

READ = np.array([0.2, 0.48, 0.8, 1.12, 1.2])
"""Times in s at the ends of steps."""

NOTE = (
    "Measured with both implicit solvers. Numerical error: the largest of three numbers: the change from "
    "twice the step, three times an error of second order, and a quarter of the previous change."
)
BEGINS = {STUCK: "sticks", FORWARD: "slips forward", BACKWARD: "slips backward", OPEN: "opens"}


class Case(NamedTuple):
    """A model, its events, duration and breaks in s, and a name for the figure and for quotes."""

    build: Callable[[], Model]
    events: Callable[[], list[Event]]
    until: float
    breaks: tuple[float, ...] = ()
    name: str = ""


ROW = Case(
    partial(theory.chained, theory.IN_A_ROW, ((0, 1), (1, 2), (2, 3)), SPEEDS),
    partial(theory.switches, theory.IN_A_ROW, SPEEDS, UNTIL),
    UNTIL,
    name="row",
)
GEAR = Case(
    partial(theory.chained, theory.GEAR, ((1, 0), (None, 1)), (0.0, 0.0)),
    partial(theory.switches, theory.GEAR, (0.0, 0.0), 1.5),
    1.5,
    theory.SHIFT,
)


def _brakes(*order: int, name: str = "") -> Case:
    build = partial(theory.loaded, (theory.WHEEL,), theory.WHEEL_UNTIL, theory.BRAKES, order)
    return Case(build, theory.of_brakes, BRAKED, (theory.WHEEL_UNTIL,), name)


def _loop(*order: int) -> Case:
    build = partial(theory.loaded, theory.LOOPED, theory.LOOP_UNTIL, theory.LOOP, order)
    return Case(build, theory.of_loop, 0.9, (theory.LOOP_UNTIL,))


CASES = {
    "three clutches in a row": ROW,
    "a clutch and a brake that shift a planetary gear": GEAR,
    "two brakes with static friction": _brakes(0, 1, name="wheel"),
    "the same brakes in another order": _brakes(1, 0),
    "a loop of three contacts": _loop(0, 1, 2),
    "the same loop in another order": _loop(2, 1, 0),
    "a coin on a turntable that accelerates": Case(theory.turntable, theory.of_coin, 1.2),
}

PIN = (FIG5, FIG5_STARTS["whirl"], 6.0)
PAPER: dict[str, tuple[System, tuple[float, ...], float]] = {
    "the pin of Fig. 5": PIN,
    "a disc": (
        replace(FIG9, friction_force=0.2, polar_inertia=0.02),
        (0.1, 0.05, 0.0, 0.0, 0.0, 1.5),
        6.0,
    ),
}
"""System, initial state and duration in s. The disc of Fig. 9, changed so that it sticks."""

STUDY = Study.beside(
    __file__,
    "exact-stick",
    source="models of the study (assumption)",
    only=("exudyn",),
    seconds=5.0,
    quick=True,
)


def _compared(
    measure: Callable[[str, float], ArrayLike],
    predicted: ArrayLike,
    components: Sequence[str],
    coarser: float = 1.0,
    **more: Any,
) -> Measured:
    """Compare ``measure(solver, step)``, shape (n,), at the smallest step with the prediction."""
    runs = [[measure(solver, coarser * step) for solver in SOLVERS] for step in reversed(STEPS)]
    coarse, middle, fine = np.array(runs)
    change = np.maximum(np.abs(fine - middle), np.abs(middle - coarse) / 4.0)
    return Measured(
        predicted=np.broadcast_to(predicted, fine.shape),
        value=fine,
        error=change + theory.NEWTON * np.max(np.abs(fine)),
        components=components,
        at={"solver": SOLVERS},
        **more,
    )


@STUDY.claim(
    "Contacts stick and release at the times of a closed form: {}",
    each=CASES,
    unit="s",
    resolution=1e-4,
    note=NOTE,
)
def switches(engine: Engine, case: Case) -> Measured:
    events, data = sorted(case.events()), {}

    def times(solver: str, step: float) -> FloatArray:
        model = case.build()
        rows = model.follow(case.until, step, solver, case.breaks)
        if case.name:
            data.update({f"{case.name} t": rows[:, 0], f"{case.name} speeds": rows[:, 1:]})
        return model.times(events)

    names = [f"contact {one.contact + 1} {BEGINS[one.mode]} at {one.time:.4f} s" for one in events]
    named = {f"times of the {case.name}": None} if case.name else {}
    return _compared(times, [one.time for one in events], names, data=data, named=named)


@STUDY.claim(
    "A pendulum with a dry bearing reverses and rests at the angles of its energy balance",
    unit="rad",
    resolution=1e-5,
    note=f"Heats are divided by the moment of the bearing. {NOTE}",
)
def pendulum(engine: Engine) -> Measured:
    angles = theory.swings()

    def found(solver: str, step: float) -> FloatArray:
        model = theory.pendulum()
        rows = model.follow(3.2, step, solver)
        if len(model.changes) != len(angles):
            return np.full(len(angles) + 2, np.nan)
        swung = np.interp([change.time for change in model.changes], rows[:, 0], rows[:, 3])
        return np.append(swung, [rows[-1, 3], rows[-1, -1] / theory.BEARING])

    names = [*(f"reversal {i + 1}" for i in range(len(angles))), "end", "heat"]
    distance = np.sum(np.abs(np.diff(angles, prepend=0.0)))
    return _compared(found, [*angles, angles[-1], distance], names, COARSER)


@STUDY.claim(
    "Friction opposes a prescribed shaft and a prescribed slider, and the heat is force times distance",
    unit="s, J, N m",
    resolution=5e-3,
    note=NOTE,
)
def prescribed(engine: Engine) -> Measured:
    times = (np.arange(2) + 0.5) * np.pi / theory.TURNING
    turns = [Event(0, time, mode) for time, mode in zip(times.tolist(), (BACKWARD, FORWARD), strict=True)]
    turned = np.searchsorted(times, READ)
    signs, (on_shaft, on_slider) = (-1.0) ** turned, theory.FRICTION

    def found(solver: str, step: float) -> FloatArray:
        model = theory.shaft_and_slider()
        rows = model.follow(READ[-1], step, solver)
        read = [np.interp(READ, rows[:, 0], column) for column in rows[:, 1:].T]
        return np.concatenate((model.times(turns), *read))

    heat_of_shaft = on_shaft * (2.0 * turned + signs * np.sin(theory.TURNING * READ))
    heat_of_slider = 0.5 * on_slider * theory.STROKE * READ**2
    kinds = (("heat of shaft", "J"), ("heat of slider", "J"), ("moment on shaft", "N m"))
    names = [f"{what} at {t:g} s in {unit}" for what, unit in kinds for t in READ]
    predicted = np.concatenate((times, heat_of_shaft, heat_of_slider, -on_shaft * signs))
    return _compared(found, predicted, ["reversal in s", "return in s", *names])


@STUDY.claim(
    "With exact stick, {} sticks, releases and moves as in the reference",
    kind="trajectory",
    each=PAPER,
    unit="s, m, rad, m/s, rad/s",
    resolution=1e-4,
    note=NOTE,
)
def paper(engine: Engine, case: tuple[System, tuple[float, ...], float]) -> Measured:
    system, start, until = case
    exact = simulate(system, start, [0.0, until], tolerance=TRUTH)
    events = [Event(0, one.start, STUCK if one.kind == "stick" else BACKWARD) for one in exact.phases[1:]]
    kept = [1, 2, 4, 5] if isinstance(system, PinOnDisc) else [1, 2, 3, 4, 5, 6]
    data: Data = {}

    def found(solver: str, step: float) -> FloatArray:
        model = theory.paper(system, start)
        rows = model.follow(until, step, solver)
        if isinstance(system, PinOnDisc):
            data.update({"pin t": rows[:, 0], "pin speeds": _slip(system, rows[:, kept])})
        return np.append(model.times(events), rows[-1, kept])

    names = [*(f"{BEGINS[one.mode]} in s" for one in events), *components_of(system)]
    predicted = [*(one.time for one in events), *exact.states[-1]]
    source = "Figs. 5 and 9; the disc's load, inertia and initial state are assumptions"
    return _compared(found, predicted, names, COARSER, system=system, source=source, data=data)


def _slip(pin: PinOnDisc, states: FloatArray) -> FloatArray:
    """Return the slip speeds (m/s) of states, shape (n, 4)."""
    x, y, vx, vy = states.T
    return np.asarray(np.hypot(vx + pin.disc_speed * y, vy - pin.disc_speed * x))


def curves() -> Data:
    t, braked = np.linspace(0.0, UNTIL, 801), np.linspace(0.0, BRAKED, 401)
    pin = simulate(*PIN[:2], np.linspace(0.0, PIN[2], 801))
    return {
        "row t": t,
        "row speeds": theory.IN_A_ROW.motion(SPEEDS, UNTIL).states(t)[1],
        "wheel t": braked,
        "wheel speeds": theory.speed_of_wheel(braked),
        "pin t": pin.times,
        "pin speeds": _slip(PIN[0], pin.states),
    }


TITLES = {"row": "Four rotors and three clutches", "wheel": "Wheel with two brakes", "pin": "Pin of Fig. 5"}


def draw(data: ByEngine) -> Figures:
    figure, panels = new_figure(ncols=3, width=12.0, height=3.6)
    for panel, (what, title) in zip(panels, TITLES.items(), strict=True):
        for engine in ("theory", *engines_in(data)):
            t, values = (data.get(engine, {}).get(f"{what} {name}", np.empty(0)) for name in ("t", "speeds"))
            exact = engine == "theory"
            style = curve(engine, "exact", linewidth=1.2) if exact else points(engine, markersize=4.0)
            shown = slice(None, None, 1 if exact else max(1, len(t) // 40))
            _, *others = panel.plot(t[shown], values[shown], **style)
            for other in others:
                other.set_label("_")
        quantity = "slip speed in m/s" if what == "pin" else "speed in rad/s"
        panel.set(xlabel=axis("t", "s"), ylabel=quantity, title=title)
    row, wheel, pin = panels
    for event in ROW.events():
        row.axvline(event.time, color=GREY, linewidth=0.6, linestyle="-" if event.mode == STUCK else ":")
    sliding = sum(theory.BRAKES)
    for moment in (sliding, theory.STATIC_RATIO * sliding):
        wheel.axvline(moment / theory.RAMP, color=GREY, linewidth=0.6, linestyle=":")
        place = moment / theory.RAMP, 0.6
        wheel.annotate(f"load {moment:g} N m", place, rotation=90, ha="right", va="top", fontsize=8.5)
    pin.legend(loc="upper right")
    return {"exact-stick": figure}


STUDY.provides(figures=draw, curves=curves)
