"""Plain motions: state by state beside the reference, and whether velocities and forces add up along them.

The motions are those of ``trajectories_motions``.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.polynomial.legendre import legvander

from compare.claims.claim import Basis, Claim, ErrorBudget, Kind
from compare.claims.error_estimates import SAFETY, refined
from compare.claims.parameters import at_each, parameters_of
from compare.claims.study import Data, Findings, Study
from compare.engines import Engine
from compare.figures import axis, curve, engines_in, new_figure
from compare.studies.engines.trajectories.motions import (
    EXACT,
    MOTIONS,
    NODES,
    PANEL,
    WEIGHTS,
    Motion,
    by_reference,
    drawn_motions,
    times_of,
)
from compare.studies.engines.trajectories.stick import stick_claims
from reference_model import DiscOnDisc, PinOnDisc, Trajectory
from reference_model.contact.contact_law import contact_of
from reference_model.support import Support
from reference_model.systems import FloatArray, System

if TYPE_CHECKING:
    from matplotlib.figure import Figure

States = Callable[[float], FloatArray]
"""Gives the states at ``times_of(motion)`` that an engine finds at a tolerance."""

SLOWEST_FALL = 0.9
"""Largest ratio of neighbouring Legendre coefficients of what is integrated."""

ONE_OF_EACH_KIND = ("a pin", "a pin that sticks on its way", "a disc on six points")
"""What an engine is asked for that differs from another in its contact alone."""

MOVES = "It moves state by state as the reference does: {}"
KINEMATICS = "Places and angle change by the integrals of velocity and spin: {}"
MOMENTUM = "Momentum and spin change by the impulses of friction, springs and dampers: {}"


DRAWN = "{} with parameters from the whole range"


def measure(engine: Engine, motions: Mapping[str, Motion] = MOTIONS) -> Findings:
    """Follow each motion that the engine simulates."""
    claims: list[Claim] = []
    data: Data = {}
    if engine.contact_only:
        motions = {name: motion for name, motion in motions.items() if name in ONE_OF_EACH_KIND}
    for name, motion in motions.items():
        if not follows(engine, motion):
            continue
        run = functools.cache(functools.partial(_run, engine, motion))
        claims += claims_of(engine, name, motion, run)
        error = run(motion.tolerance).states - by_reference(motion).states
        data[f"{name}: times"] = times_of(motion)
        data[f"{name}: error"] = np.max(np.abs(error), axis=1)
    return Findings(tuple(claims), data, not_simulated=_lacking(engine, motions.values()))


def measure_whole_range(engine: Engine) -> Findings:
    """Follow the motions by hand each for itself, and those that are drawn by kinds."""
    by_hand = measure(engine)
    if engine.contact_only:
        return by_hand
    return replace(by_hand, claims=by_hand.claims + claims_by_kinds(engine, drawn_motions()))


def claims_by_kinds(engine: Engine, drawn: Mapping[str, Sequence[Motion]]) -> tuple[Claim, ...]:
    """Return the claims on each kind of motions that the engine follows."""
    claims: list[Claim] = []
    for kind, motions in drawn.items():
        if not all(follows(engine, motion) for motion in motions):
            continue
        name = DRAWN.format(kind)
        parts: dict[str, list[Claim]] = {}
        for motion in motions:
            run = functools.cache(functools.partial(_run, engine, motion))
            for claim in claims_of(engine, name, motion, run):
                parts.setdefault(claim.sentence, []).append(claim)
        claims += [pooled(part) for part in parts.values()]
    return tuple(claims)


def follows(engine: Engine, motion: Motion) -> bool:
    """Return whether the engine promises to follow the motion."""
    return engine.simulates(motion.system) and (engine.sticks or not motion.sticks)


def _lacking(engine: Engine, motions: Iterable[Motion]) -> str:
    lacking = engine.lacking(motion.system for motion in motions)
    return lacking if lacking or engine.sticks else f"{engine.name} does not simulate stick"


def _run(engine: Engine, motion: Motion, tolerance: float) -> Trajectory:
    """Return the motion at ``times_of(motion)``."""
    return engine.simulate(motion.system, motion.start, times_of(motion), tolerance=tolerance)


def claims_of(
    engine: Engine, name: str, motion: Motion, run: Callable[[float], Trajectory]
) -> tuple[Claim, ...]:
    """Return all claims on one motion, which ``run`` follows at a tolerance."""

    def states(tolerance: float) -> FloatArray:
        return run(tolerance).states

    moves = movement_claim(engine, name, motion, states)
    if motion.sticks:  # there friction holds, and is none of the contact's law
        return (moves, *stick_claims(engine, name, motion, run))
    return (moves, *sum_claims(engine, name, motion, states))


def pooled(claims: Sequence[Claim]) -> Claim:
    """Return claims of one sentence on several systems as one, with the numbers and error bars of all of them."""
    first = claims[0]
    budgets = [np.broadcast_to(claim.budget.numerical, claim.measured.shape).ravel() for claim in claims]
    speeds = [claim.parameters["disc_speed"] for claim in claims]
    return Claim(
        first.sentence,
        equation=first.equation,
        kind=first.kind,
        engine=first.engine,
        predicted=np.concatenate([claim.predicted.ravel() for claim in claims]),
        measured=np.concatenate([claim.measured.ravel() for claim in claims]),
        budget=ErrorBudget(
            np.concatenate(budgets), resolution=max(claim.budget.resolution for claim in claims)
        ),
        parameters=_ranges([claim.parameters for claim in claims]),
        source=first.source,
        unit=first.unit,
        note=f"{len(claims)} motions, for {at_each('ω', np.array(speeds, dtype=float))} rad/s. {first.note}",
        basis=first.basis,
    )


def _ranges(parameters: Sequence[Mapping[str, float | str]]) -> dict[str, float | str]:
    """Return the smallest and the largest value of each parameter in words, or the one that all have."""
    found: dict[str, float | str] = {}
    for name, value in parameters[0].items():
        values = [one[name] for one in parameters]
        numbers = [one for one in values if not isinstance(one, str)]
        spread = len(set(values)) > 1
        found[name] = f"{min(numbers):.3g} … {max(numbers):.3g}" if spread else value
    return found


def movement_claim(engine: Engine, name: str, motion: Motion, states: States) -> Claim:
    """Compare all states with the reference's."""
    measured, error = refined(states, motion.tolerance)
    predicted = by_reference(motion).states
    # A single number may be right by chance, and so may all of them where both runs take the same steps.
    worst = float(np.max(error)) + motion.tolerance * float(np.max(np.abs(predicted)))
    return Claim(
        MOVES.format(name),
        equation=_equation(motion),
        kind="trajectory",
        engine=engine.name,
        predicted=predicted,
        measured=measured,
        budget=ErrorBudget(worst, resolution=motion.resolution),
        parameters=parameters_of(motion.system),
        source=motion.source,
        unit="m, m/s" if isinstance(motion.system, PinOnDisc) else "m, rad, m/s, rad/s",
        note=f"To t = {motion.until:g} s from {motion.start}. Predicted: the reference at tolerance {EXACT:g}.",
    )


def sum_claims(engine: Engine, name: str, motion: Motion, states: States) -> tuple[Claim, Claim]:
    """Compare what changes in each panel with the integral of what changes it."""
    body = motion.system
    half = body.state_size // 2
    inertia = np.array(
        [body.mass, body.mass] + ([body.polar_inertia] if isinstance(body, DiscOnDisc) else [])
    )
    spins = isinstance(body, DiscOnDisc)

    def claim(
        sentence: str,
        kind: Kind,
        basis: Basis,
        unit: str,
        amounts: Callable[[FloatArray], FloatArray],
        rates: Callable[[FloatArray], FloatArray],
    ) -> Claim:
        def integrals(tolerance: float) -> tuple[FloatArray, FloatArray]:
            return gauss(rates(_at_nodes(states(tolerance))))

        measured, error = refined(
            lambda tolerance: (
                np.diff(amounts(_at_bounds(states(tolerance))), axis=0) - integrals(tolerance)[0]
            ),
            motion.tolerance,
        )
        cut = float(np.max(integrals(motion.tolerance)[1]))
        return Claim(
            sentence.format(name),
            equation=_equation(motion) if kind == "conservation" else "",
            kind=kind,
            engine=engine.name,
            predicted=np.zeros_like(measured),
            measured=measured,
            budget=ErrorBudget(
                float(np.max(error)) + cut + 2.0 * motion.tolerance, resolution=motion.resolution
            ),
            parameters=parameters_of(body),
            source=motion.source,
            unit=unit,
            note=f"What is missing in each of {len(measured)} times {PANEL:g} s. Integrals by Gauss's rule with "
            f"{len(NODES)} nodes; its error from how the Legendre coefficients of what is integrated fall. "
            "The tolerance counts as an error of both states besides.",
            basis=basis,
        )

    return (
        claim(
            KINEMATICS,
            "formula",
            "independent",
            "m, rad" if spins else "m",
            lambda found: found[..., :half],
            lambda found: found[..., half:],
        ),
        claim(
            MOMENTUM,
            "conservation",
            "reference",
            "N s, N m s" if spins else "N s",
            lambda found: inertia * found[..., half:],
            functools.partial(forces, body),
        ),
    )


def _at_bounds(states: FloatArray) -> FloatArray:
    return states[:: len(NODES) + 1]


def _at_nodes(states: FloatArray) -> FloatArray:
    """Return the states at the nodes of each panel, shape (panels, nodes, 4 or 6)."""
    return states[:-1].reshape(-1, len(NODES) + 1, states.shape[1])[:, 1:]


def gauss(rates: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the integrals of ``rates`` (panels, nodes, k) over each panel and their errors, both (panels, k).

    The rule with n nodes misses the Legendre coefficients from 2n on. They are taken to fall from one to the next as
    those from the middle of the first n to the last do, and with SAFETY: where a point of the contact comes to rest
    they fall more and more slowly, as a power of their number.
    """
    n = len(NODES)
    project = legvander(NODES, n - 1).T * WEIGHTS * (np.arange(n)[:, np.newaxis] + 0.5)
    series = np.einsum("ij,pjk->pik", project, rates)
    middle, last = (np.max(np.abs(series[:, k - 1 : k + 1]), axis=1) for k in (n // 2, n - 1))
    fall = np.divide(last, middle, out=np.zeros_like(last), where=last > 0.0) ** (1.0 / (n - 1 - n // 2))
    fall = np.minimum(fall, SLOWEST_FALL)
    return PANEL * series[:, 0], PANEL * SAFETY * last * fall ** (n + 1.5) / (1.0 - fall)


def forces(body: System, states: FloatArray) -> FloatArray:
    """Return the force in N, and of a disc the moment in N m, at ``states`` (shape (..., 4 or 6)) where it slips."""
    law, support = contact_of(body), Support.of(body)
    half, omega = body.state_size // 2, body.disc_speed

    def force(state: FloatArray) -> list[float]:
        z, v = complex(*state[:2]), complex(*state[half : half + 2])
        angle, spin = (state[2], state[-1]) if isinstance(body, DiscOnDisc) else (0.0, 0.0)
        share, arm = law.force_and_moment(v - 1j * omega * z, omega - spin, angle)
        w = z - body.offset
        total = body.friction_force * share - body.damping * v - support.secant(abs(w)) * w
        if not isinstance(body, DiscOnDisc):
            return [total.real, total.imag]
        lag = spin - body.shaft_speed
        return [total.real, total.imag, body.friction_force * arm - body.shaft_damping * lag]

    return np.apply_along_axis(force, -1, states)


def _equation(motion: Motion) -> str:
    if isinstance(motion.system, PinOnDisc):
        return "(1)"
    return "(19), (20)" if motion.system.contact_points is None else "(19), (21)"


def draw(data: Mapping[str, Data]) -> dict[str, Figure]:
    """Draw how far each motion is from the reference's over time."""
    figure, (axes,) = new_figure(width=7.0, height=4.0)
    for engine in engines_in(data):
        label = engine
        for name in MOTIONS:
            if f"{name}: times" in data[engine]:
                error = np.maximum(data[engine][f"{name}: error"], EXACT)
                axes.semilogy(data[engine][f"{name}: times"], error, **curve(engine, label))
                label = "_"
    axes.set(xlabel=axis("t", "s"), ylabel="largest difference of a component of the state")
    if data:
        axes.legend()
    return {"trajectories": figure}


STUDY = Study(
    name="trajectories",
    title="Plain motions, state by state",
    section="The engines",
    paper="Equations (1) and (19) say how a pin and a disc move. In the paper's figures mass, inertia and stiffness "
    "are all one, so that an engine which takes one for another moves as it should. Here no two parameters are "
    "equal. Each motion is compared with the reference's, and besides with nothing but the laws of force: in "
    "every quarter of a second places must change by the integral of velocity, momentum by the impulse of forces. A "
    "mistake may be confined to a corner of the parameters, so motions drawn from the whole range that the other "
    "studies use are followed besides: slow and fast discs in both senses, offsets of both signs, supports with "
    "stops, points, rings, and pins that stick, whose release (7) gives.",
    by_hand=measure_whole_range,
    draw=draw,
    figures={
        "trajectories": "Difference of each motion from the reference's at tolerance 1e-13, the largest of all "
        "components of the state; the engines at tolerance 1e-10."
    },
    seconds=6.0,
    quick=True,
    contact=True,
)
