"""How fast the engines converge: in tolerance, in step, and in the slip speed that smooths the friction law."""

from __future__ import annotations

import cmath
import functools
import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from compare.claims.claim import Claim, ErrorBudget
from compare.claims.error_estimates import COARSENING, extrapolated_order, observed_exponent
from compare.claims.paper_parameters import FIG5, FIG5_STARTS
from compare.claims.parameters import at_each, parameters_of
from compare.claims.study import Data, Findings, Study
from compare.engines import Engine
from compare.studies.engines.engine_convergence.pictures import draw
from compare.studies.engines.engine_convergence.solvers import SOLVERS
from reference_model import Phase, PinOnDisc, Trajectory, simulate
from reference_model.motion.pin_equations import simulate_polar_form
from reference_model.systems import FloatArray

if TYPE_CHECKING:
    pass

Simulate = Callable[..., Trajectory]

SLIDING_STARTS = ((0.9, 0.0, 0.0, 0.9), (1.2, 0.0, 0.0, 1.2))
"""Near to the whirl and a third farther out: the pin slides all the time (our choice)."""

SLIDING_TIMES = np.linspace(0.0, 20.0, 26)
"""In s: multiples of every step, so that a solver's own states are looked at and not its interpolation."""

STICKING_STARTS = tuple((0.1, 0.0, float(speed), 0.0) for speed in np.linspace(0.0, 0.06, 12))
"""As those of Fig. 5, where vx is 0 and 0.03 m/s; each pin sticks and lets go once in the first 8 s."""


def _tolerances(largest: float, smallest: float, per_decade: int) -> FloatArray:
    return np.geomspace(largest, smallest, round(per_decade * math.log10(largest / smallest)) + 1)


@dataclass(frozen=True)
class Scan:
    """The tolerances at which one engine is measured, and how its error is expected to follow them.

    Parameters
    ----------
    order : int
        Of the integrator. Its error estimate is of the same order in the step, so the step is ~ tolerance^(1/order)
        and the error ~ tolerance; the next term is smaller by one power of the step.
    sliding, sticking, work : array
        Tolerances for both exponents, between a pin's first few steps and rounding, and for error over work.
    sticking_term : float
        Power of the tolerance by which the next term is smaller where the pin sticks.

    """

    order: int
    sliding: FloatArray
    sticking: FloatArray
    sticking_term: float
    work: FloatArray


SCANS = {
    "reference": Scan(
        order=8,
        sliding=_tolerances(1e-4, 10**-10.5, 8),
        sticking=_tolerances(1e-4, 10**-10.5, 2),
        sticking_term=1 / 8,
        work=_tolerances(1e-4, 1e-11, 1),
    ),
    "exudyn": Scan(
        order=5,
        sliding=_tolerances(1e-4, 1e-10, 4),
        sticking=_tolerances(1e-6, 1e-8, 2),
        sticking_term=1.0,  # ε = 100·tolerance outweighs the step: the next term is ε²
        work=_tolerances(1e-4, 1e-9, 1),
    ),
}


REGULARISATIONS = np.geomspace(1e-4, 10**-6.5, 6)
"""ε in m/s for the motion through three stick phases."""

FIRST_REGULARISATIONS = np.geomspace(1e-3, 10**-5.5, 11)
"""ε in m/s for the first stick alone."""

CREEP_REGULARISATIONS = (1.6e-3, 8e-4, 4e-4)
"""ε in m/s for the first release by RK44, whose step must be below 2.8·mε/μN = 31 s²/m·ε."""

TIGHT = 1e-10
"""Tolerance at which ε dominates all other errors."""

STICK_SLIP_TIMES = np.linspace(0.0, 60.0, 61)
"""In s: past all nine stick phases on the way to the whirl."""

SLIDES = "The error of a sliding pin falls in proportion to the tolerance"
STICKS = "The errors of stick and release times fall in proportion to the tolerance"
STEPS = "The error of a sliding pin falls like h{} with {} at a fixed step h"
FIRST_STICK = "The error of the first stick falls like ε² with the slip speed ε that smooths the friction law"
LATER = "The errors of all later stick and release times fall like ε"
STATE = "The error of the state after three stick phases falls like ε"
CREEP = "The first release is early by ε times what the creep of a stuck pin gives"

SUPERSCRIPTS = {2: "²", 4: "⁴", 6: "⁶"}

SLIDING_SOURCE = "Fig. 5; starts (0.9, 0, 0, 0.9) and (1.2, 0, 0, 1.2) are assumptions: 20 s without sticking"


@functools.cache
def sliding_truth() -> tuple[FloatArray, float]:
    """Return the states of the sliding pins by (10) in polar form, shape (start, time, 4), and their error."""

    def states(tolerance: float) -> FloatArray:
        return np.array(
            [
                simulate_polar_form(FIG5, np.array(start), SLIDING_TIMES, tolerance=tolerance)
                for start in SLIDING_STARTS
            ]
        )

    truth: FloatArray = states(3e-14)
    return truth, _root_mean_square(truth - states(2e-13))


def _root_mean_square(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values**2)))


def _sliding(run: Simulate, **how: Any) -> tuple[float, float, float]:
    """Simulate the sliding pins; return their error (m, m/s), evaluations, and processor time in s."""
    began = time.process_time()  # unlike wall time it does not count what other studies do on the same cores
    trajectories = [run(FIG5, start, SLIDING_TIMES, **how) for start in SLIDING_STARTS]
    spent = time.process_time() - began
    truth, _ = sliding_truth()
    error = _root_mean_square(np.array([trajectory.states for trajectory in trajectories]) - truth)
    return error, sum(trajectory.solution.evaluations for trajectory in trajectories), spent


def _gap(found: FloatArray, exact: FloatArray) -> FloatArray:
    """Return how far the events found are off; without numbers where there are too many or too few of them."""
    return np.abs(found - exact) if found.shape == exact.shape else np.full(exact.shape, np.nan)


def measure(engine: Engine) -> Findings:
    """Measure the exponents in tolerance; for Exudyn those of its fixed steps and of its regularisation too."""
    scan = SCANS[engine.name]
    claims, data = claim_of_sliding(engine, scan)
    for found, more in (claim_of_sticking(engine, scan), _work_of_engine(engine, scan)):
        claims, data = claims + found, data | more
    if engine.name == "exudyn":
        import exudyn_models  # the command line must start without it

        for found, more in (
            claims_of_steps(exudyn_models.simulate_fixed_step),
            claims_of_regularisation(exudyn_models.simulate),
            claim_of_creep(exudyn_models.simulate_fixed_step),
            _work_of_fixed_steps(exudyn_models.simulate_fixed_step),
        ):
            claims, data = claims + found, data | more
    return Findings(claims, data)


Part = tuple[tuple[Claim, ...], Data]


def claim_of_sliding(engine: Engine, scan: Scan) -> Part:
    """Return the exponent with which the error of sliding pins falls with the tolerance."""
    errors = np.array([_sliding(engine.simulate, tolerance=t)[0] for t in scan.sliding.tolist()])
    exponent, numerical, model = observed_exponent(
        scan.sliding, errors, next_term=1.0 / scan.order, noise=sliding_truth()[1]
    )
    claim = Claim(
        SLIDES,
        equation="(1), (10)",
        kind="order",
        engine=engine.name,
        predicted=1.0,
        measured=exponent,
        budget=ErrorBudget(numerical, model=model, resolution=0.1),
        parameters=parameters_of(FIG5),
        source=SLIDING_SOURCE + f"; {_range_of(scan.sliding, 'tolerance')}",
        note="Against (10) in polar form at tolerance 3e-14. Error and error estimate of the integrator are both of "
        f"order {scan.order} in its step, so that the step is ~ tolerance^(1/{scan.order}), the exponent 1, and the "
        "next term smaller by one step. Least squares with that term; numerical error: 95 % interval from the "
        "scatter; model error: what the term changes.",
    )
    return (claim,), {"sliding: tolerances": scan.sliding, "sliding: errors": errors}


def claim_of_sticking(engine: Engine, scan: Scan) -> Part:
    """Return the exponent with which the errors of stick and release times fall with the tolerance."""

    def events(run: Simulate, tolerance: float) -> FloatArray:
        return np.concatenate(
            [run(FIG5, start, (0.0, 8.0), tolerance=tolerance).stick_times for start in STICKING_STARTS]
        )

    exact = events(simulate, 1e-13)
    errors = np.array(
        [_root_mean_square(_gap(events(engine.simulate, t), exact)) for t in scan.sticking.tolist()]
    )
    exponent, numerical, model = observed_exponent(
        scan.sticking,
        errors,
        next_term=scan.sticking_term,
        noise=_root_mean_square(events(simulate, COARSENING * 1e-13) - exact),
    )
    claim = Claim(
        STICKS,
        equation="(6), (7)",
        kind="order",
        engine=engine.name,
        predicted=1.0,
        measured=exponent,
        budget=ErrorBudget(numerical, model=model, resolution=0.2),
        parameters=parameters_of(FIG5, until=8.0),
        source=f"Fig. 5 with {len(STICKING_STARTS)} starts x = 0.1, vx from 0 to 0.06; "
        + _range_of(scan.sticking, "tolerance"),
        note="Root mean square over the first stick and release of every start, against the reference at tolerance "
        "1e-13. Exponent and errors as for the sliding pin.",
        basis="reference",
    )
    return (claim,), {"sticking: tolerances": scan.sticking, "sticking: errors": errors}


def claims_of_steps(simulate_fixed_step: Simulate) -> Part:
    """Return the order of each of Exudyn's fixed-step solvers; takes the simulation that is to be measured."""
    claims: list[Claim] = []
    data: Data = {}
    for solver in SOLVERS:
        rows = np.array([_sliding(simulate_fixed_step, integrator=solver.name, step=h) for h in solver.steps])
        order, numerical, model = extrapolated_order(rows[:, 0], sliding_truth()[1])
        observed = np.log2(rows[:-1, 0] / rows[1:, 0])
        claims.append(
            Claim(
                STEPS.format(SUPERSCRIPTS[solver.order], solver.name),
                equation="(1), (10)",
                kind="order",
                engine="exudyn",
                predicted=solver.order,
                measured=order,
                budget=ErrorBudget(numerical, model=model, resolution=0.2),
                parameters=parameters_of(FIG5),
                source=SLIDING_SOURCE,
                note=f"Orders observed while halving the step; {at_each('h', solver.steps)} s: "
                f"{', '.join(f'{value:.3f}' for value in observed)}, extrapolated to h = 0. Model error: the "
                "extrapolation's own step; numerical error: its change from one step to the next.",
            )
        )
        data |= {f"{solver.name}: steps": np.array(solver.steps), f"{solver.name}: sliding": rows}
    return tuple(claims), data


def claims_of_regularisation(simulate_smoothed: Simulate) -> Part:
    """Return the exponents of the errors in ε; takes the simulation that is to be measured."""
    until = (0.0, 20.0)
    exact = simulate(FIG5, FIG5_STARTS["whirl"], until, tolerance=1e-13)

    def errors(epsilon: float, tolerance: float) -> FloatArray:
        found = simulate_smoothed(
            FIG5, FIG5_STARTS["whirl"], until, tolerance=tolerance, regularisation=epsilon
        )
        state = _root_mean_square(found.at_end - exact.at_end)
        return np.append(_gap(found.stick_times, exact.stick_times), state)

    by_epsilon = np.array([errors(epsilon, TIGHT) for epsilon in REGULARISATIONS.tolist()])
    # The tolerance weighs most at the smallest ε.
    noise = np.abs(errors(float(REGULARISATIONS[-1]), COARSENING * TIGHT) - by_epsilon[-1])
    exponents, numerical, model = np.transpose(
        [
            observed_exponent(REGULARISATIONS, column, next_term=1.0, noise=part)
            for column, part in zip(by_epsilon.T, noise, strict=True)
        ]
    )[:, 1:]

    start = FIG5_STARTS["equilibrium"]
    first = simulate(FIG5, start, (0.0, 8.0), tolerance=1e-13).stick_times[:1]

    def first_error(epsilon: float, tolerance: float) -> float:
        found = simulate_smoothed(FIG5, start, (0.0, 5.0), tolerance=tolerance, regularisation=epsilon)
        return float(_gap(found.stick_times[:1], first)[0])

    firsts = np.array([first_error(epsilon, TIGHT) for epsilon in FIRST_REGULARISATIONS.tolist()])
    first_noise = abs(first_error(float(FIRST_REGULARISATIONS[-1]), COARSENING * TIGHT) - float(firsts[-1]))
    first_exponent, first_numerical, first_model = observed_exponent(
        FIRST_REGULARISATIONS, firsts, next_term=1.0, noise=first_noise
    )
    how = (
        f"Against the reference at tolerance 1e-13. Least squares with a term smaller by ε; numerical error: 95 % "
        f"interval from the scatter, and the change at tolerance {COARSENING * TIGHT:g}; model error: what the term "
        "changes."
    )
    claims = (
        Claim(
            FIRST_STICK,
            equation="(6)",
            kind="order",
            engine="exudyn",
            predicted=2.0,
            measured=first_exponent,
            budget=ErrorBudget(first_numerical, model=first_model, resolution=0.1),
            parameters=parameters_of(FIG5, tolerance=TIGHT),
            source="Fig. 5, first start; " + _range_of(FIRST_REGULARISATIONS, "ε", "m/s"),
            note="The law is exact down to ε, and the slip left there is over in a time ~ ε whose error is ~ ε². "
            + how,
        ),
        Claim(
            LATER,
            equation="(6), (7)",
            kind="order",
            engine="exudyn",
            predicted=np.ones(len(exponents) - 1),
            measured=exponents[:-1],
            budget=ErrorBudget(numerical[:-1], model=float(np.max(model[:-1])), resolution=0.1),
            parameters=parameters_of(FIG5, tolerance=TIGHT),
            source="Fig. 5, second start to 20 s; " + _range_of(REGULARISATIONS, "ε", "m/s"),
            note="First release, second stick, and so on. " + how,
        ),
        Claim(
            STATE,
            equation="(1), (6)",
            kind="order",
            engine="exudyn",
            predicted=1.0,
            measured=exponents[-1],
            budget=ErrorBudget(numerical[-1], model=model[-1], resolution=0.1),
            parameters=parameters_of(FIG5, tolerance=TIGHT),
            source="Fig. 5, second start at 20 s; " + _range_of(REGULARISATIONS, "ε", "m/s"),
            note=how,
        ),
    )
    return claims, {
        "first regularisations": FIRST_REGULARISATIONS,
        "first stick": firsts,
        "regularisations": REGULARISATIONS,
        "later events and state": by_epsilon[:, 1:],
    }


def release_shift_by_creep(pin: PinOnDisc, stick: Phase) -> float:
    """Return by how much creep shifts the end of a stick phase under exact friction, in s for each m/s of ε.

    A stuck pin under F = −μN·v/ε creeps with w = ε·a/g, where m·a is the force that friction has to balance (eq. 6)
    and g = μN/m. In the frame of the disc that moves it by (ε/g)·∫a·exp(−iωt)dt, in closed form since a is linear in
    z = z₀·exp(iωt). Release is where |a| = g (eq. 7): the shift is −d|a|/dε over d|a|/dt.
    """
    omega = 1j * pin.disc_speed
    spring = pin.stiffness / pin.mass
    slope = -(pin.damping / pin.mass + omega) * omega - spring
    held = stick.end - stick.start
    z = complex(*stick.initial_state[:2])
    turned = cmath.exp(omega * held)
    g = pin.friction_force / pin.mass
    creep = (slope * z * held + spring * pin.offset * (1.0 - 1.0 / turned) / omega) / g * turned
    pull = slope * z * turned + spring * pin.offset
    grows = (pull.conjugate() * slope * omega * z * turned).real
    return -(pull.conjugate() * slope * creep).real / grows


def claim_of_creep(simulate_fixed_step: Simulate) -> Part:
    """Return the first release of both starts of Fig. 5 per ε; takes the simulation that is to be measured."""
    until = (0.0, 6.0)
    exact = [simulate(FIG5, start, until, tolerance=1e-13).stick_phases[0] for start in FIG5_STARTS.values()]

    def shifts(epsilon: float, steps: float) -> FloatArray:
        step = FIG5.mass * epsilon / FIG5.friction_force / steps
        found = [
            simulate_fixed_step(FIG5, start, until, integrator="RK44", step=step, regularisation=epsilon)
            for start in FIG5_STARTS.values()
        ]
        ends = [trajectory.stick_times[1] if trajectory.stick_phases else math.nan for trajectory in found]
        return np.array([(end - phase.end) / epsilon for end, phase in zip(ends, exact, strict=True)])

    measured = np.array([shifts(epsilon, 4.0) for epsilon in CREEP_REGULARISATIONS])
    rough = shifts(CREEP_REGULARISATIONS[-1], 2.0)
    extrapolated = 2.0 * measured[1:] - measured[:-1]
    numerical = np.abs(rough - measured[-1]) + np.abs(extrapolated[-1] - extrapolated[-2])
    model = np.abs(measured[-1] - measured[-2])
    finite = bool(np.all(np.isfinite(extrapolated)))
    predicted = np.array([release_shift_by_creep(FIG5, phase) for phase in exact])
    claim = Claim(
        CREEP,
        equation="(6), (7)",
        engine="exudyn",
        predicted=predicted,
        measured=extrapolated[-1],
        budget=ErrorBudget(
            numerical if finite else 0.0,
            model=float(np.max(model)) if finite else 0.0,
            resolution=0.05 * float(np.min(np.abs(predicted))),
        ),
        parameters=parameters_of(FIG5),
        source="Fig. 5, both starts; " + at_each("ε", CREEP_REGULARISATIONS) + " m/s",
        unit="s per m/s",
        note="Shift of the first release over ε, RK44 with four steps in mε/μN, extrapolated to ε = 0. Predicted: "
        "creep with w = ε·a/g all through the stick phase under exact friction, where m·a is the force of (6). Model "
        "error: the extrapolation's own step; numerical error: its change from one ε to the next, and the change at "
        "twice the step.",
    )
    return (claim,), {}


def _work_of_engine(engine: Engine, scan: Scan) -> Part:
    """Return error, evaluations and processor time over the tolerance, sliding and with stick phases."""
    tolerances = scan.work.tolist()
    return (), {
        "work: sliding": np.array([_sliding(engine.simulate, tolerance=t) for t in tolerances]),
        "work: stick-slip": np.array([_stick_slip(engine.simulate, tolerance=t) for t in tolerances]),
    }


def _work_of_fixed_steps(simulate_fixed_step: Simulate) -> Part:
    """Return the same for two fixed-step solvers with stick phases, where ε has to follow the step."""
    steps = (0.04, 0.02, 0.01, 0.005)
    return (), {
        f"{name}: stick-slip": np.array(
            [
                _stick_slip(
                    simulate_fixed_step, integrator=name, step=h, regularisation=smallest_regularisation(h)
                )
                for h in steps
            ]
        )
        for name in ("RK44", "GeneralizedAlpha")
    }


def smallest_regularisation(step: float) -> float:
    """Return ε in m/s for which RK44, stable up to 2.8·mε/μN, resolves sticking with ``step``."""
    return step * FIG5.friction_force / FIG5.mass / 1.5


def _stick_slip(run: Simulate, **how: Any) -> tuple[float, float, float]:
    """Simulate Fig. 5's way to the whirl; return the error (m, m/s), evaluations, and processor time in s."""
    began = time.process_time()
    trajectory = run(FIG5, FIG5_STARTS["whirl"], STICK_SLIP_TIMES, **how)
    spent = time.process_time() - began
    error = _root_mean_square(trajectory.states - _stick_slip_truth())
    return error, trajectory.solution.evaluations, spent


@functools.cache
def _stick_slip_truth() -> FloatArray:
    return simulate(FIG5, FIG5_STARTS["whirl"], STICK_SLIP_TIMES, tolerance=1e-13).states


def _range_of(values: FloatArray, name: str, unit: str = "") -> str:
    return f"{name} from {values[0]:.3g} to {values[-1]:.3g} {unit}".rstrip()


STUDY = Study(
    name="engine-convergence",
    title="Convergence of the engines",
    section="The engines",
    paper="Not in the paper. An engine is to be trusted when its errors fall as its method says: with the tolerance, "
    "with the step h, and, where the friction law is smoothed, with the slip speed ε below which it is viscous, "
    "F = −μN·v/max(|v|, ε). The reference takes Coulomb friction as it is and has no ε. Sliding pins are measured "
    "against (10) in polar form, stick and release times against the reference at its tightest.",
    by_hand=measure,
    draw=draw,
    figures={
        "engine-convergence-orders": "Left: error of sliding pins over the step, Exudyn's fixed-step solvers. Right: "
        "errors over the slip speed ε that smooths the friction law, Exudyn with variable step: first stick (Fig. 5, "
        "first start), later stick and release times and the state (second start). Lines: powers, not fits.",
        "engine-convergence-tolerance": "Errors over the tolerance, of sliding pins and of stick and release times. "
        "Exudyn smooths friction with ε = 100·tolerance, which is the error at sticking; the reference has no ε. "
        "Lines: in proportion to the tolerance.",
        "engine-convergence-work": "Error over evaluations of the equations of motion and over processor time. Left: "
        "sliding pins. Right: Fig. 5's way to the whirl. With stick phases ε decides: solvers at a fixed step, which "
        "need ε ~ h, have the same error whatever their order. Evaluations of the reference are Python, those of "
        "Exudyn C++ with the friction in Python; times depend on the machine.",
    },
    only=("reference", "exudyn"),
    seconds=3.0,
)
