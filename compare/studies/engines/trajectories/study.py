"""Claims."""

import functools
import itertools
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np

import compare.studies.engines.trajectories.theory as theory
from compare.claims import TRUTH, Measured, Measurement, Study, open_where_coarse, refined
from compare.claims.parameters import at_each, components_of, parameters_of
from compare.engines import DeclaredLackError, Engine
from compare.studies.engines.trajectories.drawn import DRAWN, Drawn
from compare.studies.engines.trajectories.theory import Motion
from reference_model import DiscOnDisc, PinOnDisc, Trajectory
from reference_model.systems import FloatArray

Motions = Iterable[Motion]

Measure = Callable[[Engine, Motion], "Measured | None"]
MeasureAll = Callable[[Engine, Motions], "Measured | None"]


def together(measure: Measure) -> MeasureAll:
    """Extend ``measure``, which takes one motion, to all motions of a claim."""

    @functools.wraps(measure)
    def measure_all(engine: Engine, motions: Motions) -> Measured | None:
        if engine.contact_only and (
            isinstance(motions, Drawn) or not set(motions) <= set(theory.ONE_OF_EACH_KIND)
        ):
            return None
        if not all(engine.simulates(motion.system) for motion in motions):
            # One sentence states everything that is missing, instead of one per claim.
            raise DeclaredLackError(engine.lacking(motion.system for motion in theory.MOTIONS.values()))
        parts = [part for motion in motions if (part := measure(engine, motion)) is not None]
        return pooled(parts) if parts else None

    return measure_all


def pooled(parts: Sequence[Measured]) -> Measured:
    first, *others = parts
    if not others:
        return first
    systems = [part.system for part in parts if isinstance(part.system, PinOnDisc | DiscOnDisc)]
    speeds = [system.disc_speed for system in systems]
    return Measured(
        predicted=np.concatenate([np.ravel(part.predicted) for part in parts]),
        value=np.concatenate([np.ravel(part.value) for part in parts]),
        error=np.concatenate([np.broadcast_to(part.error, np.shape(part.value)).ravel() for part in parts]),
        size=np.concatenate([_sizes(part) for part in parts]),
        resolution=first.resolution,
        components=[
            ", ".join((f"ω = {speed:g} rad/s", *place))
            for part, speed in zip(parts, speeds, strict=True)
            for place in itertools.product(*part.axes)
        ],
        parameters=_ranges([parameters_of(system) for system in systems]),
        source=first.source,
        note=f"{len(parts)} motions to t = {theory.UNTIL:g} s, for {at_each('ω', speeds)} rad/s.",
    )


def _sizes(part: Measured) -> FloatArray:
    size = np.max(np.abs(part.predicted)) if part.size is None else part.size
    return np.broadcast_to(size, np.shape(part.value)).ravel()


def _ranges(parameters: Sequence[Mapping[str, float | str]]) -> dict[str, float | str]:
    """Return the common value of each parameter, or its range as text."""
    found: dict[str, float | str] = {}
    for name, value in parameters[0].items():
        values = [one[name] for one in parameters]
        numbers = [one for one in values if not isinstance(one, str)]
        spread = len(set(values)) > 1
        found[name] = f"{min(numbers):.3g} … {max(numbers):.3g}" if spread else value
    return found


STUDY = Study.beside(
    __file__,
    "trajectories",
    words={"exact": f"{TRUTH:g}", "tolerance": f"{Motion.tolerance:g}"},
    seconds=2.0,
    quick=True,
    contact=True,
)

INTEGRATED = (
    f"Residual in every {theory.PANEL:g} s. Integrals by Gauss's rule with {len(theory.NODES)} nodes. Its error "
    "follows from the decay of the Legendre coefficients of the integrand. In addition, the tolerance counts as an "
    "error of both states."
)

NAMES = {motion: name for name, motion in theory.MOTIONS.items()}


def by_name(by_hand: Mapping[str, Motion], *drawn: str) -> dict[str, Motions]:
    return {name: (motion,) for name, motion in by_hand.items()} | {
        f"{kind} with random parameters": DRAWN[kind] for kind in drawn
    }


SLIDING = by_name(theory.PINS, "pins", "pins on stops")
STICKING = by_name(theory.PINS_THAT_STICK, "pins that stick")
OF_DISCS = {
    "(19), (20)": by_name(theory.RINGS, "rings"),
    "(19), (21)": by_name(theory.POINTS, "points"),
}


def of_bodies(
    sentence: str,
    *,
    of_pins: str,
    of_discs: str,
    pins: Mapping[str, Motions],
    by_law: bool = True,
    **more: Any,
) -> Callable[[MeasureAll], MeasureAll]:
    """Declare a claim about pins and about discs on rings and on points, in the unit ``of_pins`` or ``of_discs``.

    ``by_law`` is True if the claim is about the equations of motion; ``more`` is passed to ``Study.claim``.
    """

    def declare(function: MeasureAll) -> MeasureAll:
        for equation, each in ({"(1)": pins} | OF_DISCS).items():
            unit = of_pins if each is pins else of_discs
            STUDY.claim(sentence, equation=equation if by_law else "", unit=unit, each=each, **more)(function)
        return function

    return declare


@functools.lru_cache(maxsize=256)  # all motions, at the tolerances of an error estimate
def run(engine: Engine, motion: Motion, tolerance: float) -> Trajectory:
    return engine.simulate(motion.system, motion.start, theory.times_of(motion), tolerance=tolerance)


def states_of(engine: Engine, motion: Motion) -> Measurement:
    return refined(lambda tolerance: run(engine, motion, tolerance).states, motion.tolerance)


@of_bodies(
    "The states of a body equal those of the reference: {}",
    of_pins="m, m/s",
    of_discs="m, rad, m/s, rad/s",
    pins=SLIDING | STICKING,
    kind="trajectory",
    note=f"Predicted: the reference at tolerance {TRUTH:g}.",
)
@together
def moves(engine: Engine, motion: Motion) -> Measured:
    found = states_of(engine, motion)
    predicted = theory.by_reference(motion).states
    # Single numbers may agree by chance, or all of them if both runs take the same steps.
    bar = found.largest + motion.tolerance * float(np.max(np.abs(predicted)))
    times, data = theory.times_of(motion), {}
    if motion in NAMES:
        difference = np.max(np.abs(found.value - predicted), axis=1)
        shown = {"times": times, "difference": difference, "error bar": bar}
        data = {f"{NAMES[motion]}: {name}": values for name, values in shown.items()}
    return Measured(
        predicted=predicted,
        value=found.value,
        error=bar,
        resolution=motion.resolution,
        at={"t in s": times},
        components=components_of(motion.system),
        system=motion.system,
        source=motion.source,
        note=started(motion),
        data=data,
    )


@of_bodies(
    "Position and angle change by the integrals of velocity and spin: {}",
    of_pins="m",
    of_discs="m, rad",
    pins=SLIDING,
    by_law=False,
    friction=False,
    note=INTEGRATED,
)
@together
def kinematics(engine: Engine, motion: Motion) -> Measured | None:
    half = motion.system.state_size // 2
    return balance(
        engine,
        motion,
        lambda states: states[..., :half],
        lambda states: states[..., half:],
        components_of(motion.system)[:half],
    )


@of_bodies(
    "Momentum and angular momentum change by the impulses of friction, springs and dampers: {}",
    of_pins="N s",
    of_discs="N s, N m s",
    pins=SLIDING,
    kind="conservation",
    basis="reference",
    note=INTEGRATED,
)
@together
def momentum(engine: Engine, motion: Motion) -> Measured | None:
    body = motion.system
    half = body.state_size // 2
    inertia = np.array(
        [body.mass, body.mass, *([body.polar_inertia] if isinstance(body, DiscOnDisc) else [])]
    )
    return balance(
        engine,
        motion,
        lambda states: inertia * states[..., half:],
        functools.partial(theory.forces, body),
        ("along x in N s", "along y in N s", "of spin in N m s")[:half],
    )


def balance(
    engine: Engine,
    motion: Motion,
    amounts: Callable[[FloatArray], FloatArray],
    rates: Callable[[FloatArray], FloatArray],
    components: Sequence[str],
) -> Measured | None:
    """Compare the change of ``amounts`` in each panel with the integral of their ``rates``; None during stick."""
    if motion.sticks:  # the friction law does not determine the force during stick
        return None

    def integrals(tolerance: float) -> tuple[FloatArray, FloatArray]:
        return theory.gauss(rates(theory.at_nodes(run(engine, motion, tolerance).states)))

    def missing(tolerance: float) -> FloatArray:
        changes = np.diff(amounts(theory.at_bounds(run(engine, motion, tolerance).states)), axis=0)
        return np.asarray(changes - integrals(tolerance)[0])

    found = refined(missing, motion.tolerance)
    cut = float(np.max(integrals(motion.tolerance)[1]))
    return Measured(
        predicted=np.zeros_like(found.value),
        value=found.value,
        error=found.largest + cut + 2.0 * motion.tolerance,
        size=float(np.max(np.abs(amounts(theory.by_reference(motion).states)))),
        resolution=motion.resolution,
        at={"from t in s": theory.at_bounds(theory.times_of(motion))[:-1]},
        components=components,
        system=motion.system,
        source=motion.source,
        note=started(motion),
    )


@STUDY.claim(
    "A body sticks and is released at the times of the reference: {}",
    kind="trajectory",
    unit="s",
    resolution=theory.STICK_RESOLUTION,
    note=f"Times of all stick phases longer than {theory.STICK_RESOLUTION:g} s, compared with the reference.",
    each=STICKING,
)
@together
def phases(engine: Engine, motion: Motion) -> Measured | None:
    if not motion.sticks:
        return None
    predicted = theory.stick_times(theory.by_reference(motion))
    found = refined(
        lambda tolerance: theory.as_many(theory.stick_times(run(engine, motion, tolerance)), predicted),
        motion.tolerance,
    )
    found = open_where_coarse(found, states_of(engine, motion))
    return of_stick(motion, predicted, found, ("stick", "release"))


@STUDY.claim(
    "A body halfway through a stick phase is released at the time that (7) predicts: {}",
    equation="(7)",
    unit="s",
    resolution=theory.STICK_RESOLUTION,
    note="End of each stick phase minus the prediction of (7) from the position in the middle of the phase.",
    each=STICKING,
)
@together
def release(engine: Engine, motion: Motion) -> Measured | None:
    pin, middles = motion.system, theory.samples_in_stick(theory.by_reference(motion))
    if not isinstance(pin, PinOnDisc) or not middles:
        return None
    found = refined(
        lambda tolerance: theory.late(run(engine, motion, tolerance), pin, middles), motion.tolerance
    )
    found = open_where_coarse(found, states_of(engine, motion))
    return of_stick(motion, np.zeros(len(middles)), found, ("release",))


def of_stick(motion: Motion, predicted: FloatArray, found: Measurement, kind: Sequence[str]) -> Measured:
    """Return the result for a pin's stick phases; the numbers alternate between the ``kind`` names."""
    return Measured(
        predicted=predicted,
        value=found.value,
        # The tolerance scales the error of every number.
        error=found.largest + motion.tolerance * motion.until,
        size=1.0 / motion.system.natural_frequency,
        components=[f"{kind[i % len(kind)]} {i // len(kind) + 1}" for i in range(len(predicted))],
        system=motion.system,
        source=motion.source,
        note=started(motion),
    )


def started(motion: Motion) -> str:
    return f"To t = {motion.until:g} s from {motion.start}."
