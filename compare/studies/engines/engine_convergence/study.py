"""Claims."""

import functools
import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

import compare.studies.engines.engine_convergence.theory as theory
from compare.claims import COARSENING, TRUTH, Measured, Study, extrapolated_order, observed_exponent
from compare.claims.parameters import FIG5, FIG5_STARTS, at_each
from compare.engines import Engine
from reference_model import simulate
from reference_model.systems import FloatArray

STUDY = Study.beside(__file__, "engine-convergence", system=FIG5, only=("reference", "exudyn"), seconds=3.0)


# --- With the tolerance


@STUDY.claim(
    "The error of a sliding pin falls in proportion to the tolerance",
    equation="(1), (10)",
    kind="order",
    resolution=0.1,
    note="Errors are relative to (10) in polar form at tolerance 3e-14. Error and error estimate of an "
    "integrator of order n "
    "have the same order in the step. The step is therefore ~ tolerance^(1/n), the exponent is 1, and the next term "
    "is smaller by one power of the step. The fit is a least-squares fit with this term. Numerical error: 95 "
    "% interval from the "
    "scatter. Model error: the effect of the term.",
)
def sliding(engine: Engine) -> Measured:
    scan = theory.SCANS[engine.name]
    errors = np.array([theory.of_sliding(engine.simulate, tolerance=t) for t in scan.sliding.tolist()])
    exponent, numerical, model = observed_exponent(
        scan.sliding, errors, next_term=1.0 / scan.order, noise=theory.sliding_truth()[1]
    )
    return Measured(
        predicted=1.0,
        value=exponent,
        error=numerical,
        model=model,
        source=theory.SLIDING_SOURCE + f"; {_range_of(scan.sliding, 'tolerance')}",
        note=f"Here n is {scan.order}.",
        data={"sliding: tolerances": scan.sliding, "sliding: errors": errors},
    )


@STUDY.claim(
    "The errors of stick and release times fall in proportion to the tolerance",
    equation="(6), (7)",
    kind="order",
    resolution=0.2,
    note="Root mean square over the first stick and release of every start, compared with the reference at tolerance "
    f"{TRUTH:g}. Exponent and errors as for the sliding pin.",
    basis="reference",
)
def sticking(engine: Engine) -> Measured:
    scan = theory.SCANS[engine.name]
    exact, noise = _exact_events()
    errors = np.array(
        [
            theory.root_mean_square(theory.gap(_events(engine.simulate, t), exact))
            for t in scan.sticking.tolist()
        ]
    )
    exponent, numerical, model = observed_exponent(
        scan.sticking, errors, next_term=scan.sticking_term, noise=noise
    )
    return Measured(
        predicted=1.0,
        value=exponent,
        error=numerical,
        model=model,
        parameters={"until": theory.STICKING_UNTIL},
        source=f"Fig. 5 with {len(theory.STICKING_STARTS)} starts x = 0.1, vx from 0 to 0.06; "
        + _range_of(scan.sticking, "tolerance"),
        data={"sticking: tolerances": scan.sticking, "sticking: errors": errors},
    )


def _events(run: theory.Simulate, tolerance: float) -> FloatArray:
    times = (0.0, theory.STICKING_UNTIL)
    return np.concatenate(
        [run(FIG5, start, times, tolerance=tolerance).stick_times for start in theory.STICKING_STARTS]
    )


@functools.cache
def _exact_events() -> tuple[FloatArray, float]:
    exact = _events(simulate, TRUTH)
    return exact, theory.root_mean_square(_events(simulate, COARSENING * TRUTH) - exact)


# --- With the step


def of_every_order(function: Callable[..., Measured | None]) -> Callable[..., Measured | None]:
    for order, superscript in {4: "⁴", 6: "⁶", 2: "²"}.items():
        STUDY.claim(
            f"With {{}} at a fixed step h, the error of a sliding pin falls like h{superscript}",
            equation="(1), (10)",
            kind="order",
            resolution=0.2,
            note="Orders observed in successive halvings of the step, extrapolated to h = 0. Model error: the "
            "change due to extrapolation. Numerical error: change of the extrapolated value from one step to the "
            "next.",
            each={solver.name: solver for solver in theory.SOLVERS if solver.order == order},
        )(function)
    return function


@of_every_order
def steps(engine: Engine, solver: theory.Solver) -> Measured | None:
    if engine.name != "exudyn":
        return None
    import exudyn_models  # deferred: the command line must start without it

    run = exudyn_models.simulate_fixed_step
    errors = np.array([theory.of_sliding(run, integrator=solver.name, step=h) for h in solver.steps])
    order, numerical, model = extrapolated_order(errors, theory.sliding_truth()[1])
    observed = ", ".join(f"{value:.3f}" for value in np.log2(errors[:-1] / errors[1:]))
    return Measured(
        predicted=solver.order,
        value=order,
        error=numerical,
        model=model,
        source=theory.SLIDING_SOURCE,
        note=f"{at_each('h', solver.steps)} s: {observed}.",
        data={f"{solver.name}: steps": np.array(solver.steps), f"{solver.name}: sliding": errors},
    )


# --- With the slip speed that regularises friction

HOW = (
    f"Compared with the reference at tolerance {TRUTH:g}. Least squares with a next term smaller by ε. Numerical "
    f"error: 95 % interval from the scatter, and the change at tolerance {COARSENING * theory.TOLERANCE:g}. Model "
    "error: the effect of the next term."
)


@STUDY.claim(
    "The error of the first stick time falls like ε² with the slip speed ε that regularises friction",
    equation="(6)",
    kind="order",
    resolution=0.1,
    note="The law is exact above ε, and the remaining slip ends after a time ~ ε, whose error is ~ ε². "
    + HOW,
)
def first_stick(engine: Engine) -> Measured | None:
    if engine.name != "exudyn":
        return None
    import exudyn_models

    start = FIG5_STARTS["equilibrium"]
    first = simulate(FIG5, start, (0.0, 8.0), tolerance=TRUTH).stick_times[:1]

    def error(epsilon: float, tolerance: float) -> float:
        found = exudyn_models.simulate(FIG5, start, (0.0, 5.0), tolerance=tolerance, regularisation=epsilon)
        return float(theory.gap(found.stick_times[:1], first)[0])

    errors = np.array([error(epsilon, theory.TOLERANCE) for epsilon in theory.FIRST_REGULARISATIONS.tolist()])
    # The tolerance has the largest effect at the smallest ε.
    noise = abs(
        error(float(theory.FIRST_REGULARISATIONS[-1]), COARSENING * theory.TOLERANCE) - float(errors[-1])
    )
    exponent, numerical, model = observed_exponent(
        theory.FIRST_REGULARISATIONS, errors, next_term=1.0, noise=noise
    )
    return Measured(
        predicted=2.0,
        value=exponent,
        error=numerical,
        model=model,
        parameters={"tolerance": theory.TOLERANCE},
        source="Fig. 5, first start; " + _range_of(theory.FIRST_REGULARISATIONS, "ε", "m/s"),
        data={"first regularisations": theory.FIRST_REGULARISATIONS, "first stick": errors},
    )


class Smoothing(NamedTuple):
    """Errors of later events and the state (last column) by regularisation, shape (ε, n), and their exponents."""

    errors: FloatArray
    exponents: FloatArray
    numerical: FloatArray
    model: FloatArray


@STUDY.claim(
    "The errors of all later stick and release times fall like ε",
    equation="(6), (7)",
    kind="order",
    resolution=0.1,
    note=HOW,
)
def later_events(engine: Engine) -> Measured | None:
    if engine.name != "exudyn":
        return None
    import exudyn_models

    found = smoothing(exudyn_models.simulate)
    events = len(found.exponents) - 1
    return Measured(
        predicted=np.ones(events),
        value=found.exponents[:-1],
        error=found.numerical[:-1],
        model=float(np.max(found.model[:-1])),
        components=[f"{('release', 'stick')[i % 2]} {(i + 1) // 2 + 1}" for i in range(events)],
        parameters={"tolerance": theory.TOLERANCE},
        source="Fig. 5, second start to 20 s; " + _range_of(theory.REGULARISATIONS, "ε", "m/s"),
        data={"regularisations": theory.REGULARISATIONS, "later events and state": found.errors},
    )


@STUDY.claim(
    "The error of the state after three stick phases falls like ε",
    equation="(1), (6)",
    kind="order",
    resolution=0.1,
    note=HOW,
)
def state(engine: Engine) -> Measured | None:
    if engine.name != "exudyn":
        return None
    import exudyn_models

    found = smoothing(exudyn_models.simulate)
    return Measured(
        predicted=1.0,
        value=found.exponents[-1],
        error=found.numerical[-1],
        model=float(found.model[-1]),
        parameters={"tolerance": theory.TOLERANCE},
        source="Fig. 5, second start at 20 s; " + _range_of(theory.REGULARISATIONS, "ε", "m/s"),
    )


@functools.lru_cache(maxsize=1)
def smoothing(simulate_smoothed: theory.Simulate) -> Smoothing:
    start, until = FIG5_STARTS["whirl"], (0.0, 20.0)
    exact = simulate(FIG5, start, until, tolerance=TRUTH)

    def errors(epsilon: float, tolerance: float) -> FloatArray:
        found = simulate_smoothed(FIG5, start, until, tolerance=tolerance, regularisation=epsilon)
        state = theory.root_mean_square(found.at_end - exact.at_end)
        return np.append(theory.gap(found.stick_times, exact.stick_times), state)[
            1:
        ]  # without the first stick, whose error falls faster

    by_epsilon = np.array([errors(epsilon, theory.TOLERANCE) for epsilon in theory.REGULARISATIONS.tolist()])
    noise = np.abs(errors(float(theory.REGULARISATIONS[-1]), COARSENING * theory.TOLERANCE) - by_epsilon[-1])
    exponents, numerical, model = np.transpose(
        [
            observed_exponent(theory.REGULARISATIONS, column, next_term=1.0, noise=part)
            for column, part in zip(by_epsilon.T, noise, strict=True)
        ]
    )
    return Smoothing(by_epsilon, exponents, numerical, model)


@STUDY.claim(
    "The first release is early by ε times a factor that follows from the creep of a stuck pin",
    equation="(6), (7)",
    unit="s per m/s",
    note="Shift of the first release over ε, RK44 with four steps in mε/μN, extrapolated to ε = 0. Predicted: creep "
    "at the slip speed w = ε·a/g during the stick phase of exact friction, where m·a is the force of (6). Model "
    "error: the change due to extrapolation. Numerical error: change of the extrapolated value from one ε to the "
    "next, and at twice the step.",
)
def creep(engine: Engine) -> Measured | None:
    if engine.name != "exudyn":
        return None
    import exudyn_models

    starts, until = list(FIG5_STARTS.values()), (0.0, 6.0)
    exact = [simulate(FIG5, start, until, tolerance=TRUTH).stick_phases[0] for start in starts]

    def shifts(epsilon: float, steps: float) -> FloatArray:
        step = FIG5.mass * epsilon / FIG5.friction_force / steps
        found = [
            exudyn_models.simulate_fixed_step(
                FIG5, start, until, integrator="RK44", step=step, regularisation=epsilon
            )
            for start in starts
        ]
        ends = [trajectory.stick_times[1] if trajectory.stick_phases else math.nan for trajectory in found]
        return np.array([(end - phase.end) / epsilon for end, phase in zip(ends, exact, strict=True)])

    measured = np.array([shifts(epsilon, 4.0) for epsilon in theory.CREEP_REGULARISATIONS])
    rough = shifts(theory.CREEP_REGULARISATIONS[-1], 2.0)
    extrapolated = 2.0 * measured[1:] - measured[:-1]
    numerical = np.abs(rough - measured[-1]) + np.abs(extrapolated[-1] - extrapolated[-2])
    model = np.abs(measured[-1] - measured[-2])
    finite = bool(np.all(np.isfinite(extrapolated)))
    predicted = np.array([theory.release_shift_by_creep(FIG5, phase) for phase in exact])
    return Measured(
        predicted=predicted,
        value=extrapolated[-1],
        error=numerical if finite else 0.0,
        model=float(np.max(model)) if finite else 0.0,
        resolution=0.05 * float(np.min(np.abs(predicted))),
        components=[f"start of the way to the {end}" for end in FIG5_STARTS],
        source="Fig. 5, both starts; " + at_each("ε", theory.CREEP_REGULARISATIONS) + " m/s",
    )


def _range_of(values: FloatArray, name: str, unit: str = "") -> str:
    return f"{name} from {values[0]:.3g} to {values[-1]:.3g} {unit}".rstrip()
