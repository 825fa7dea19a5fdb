"""Plain motions: state by state beside the reference, and whether velocities and forces add up along them.

In the paper's parameters m, J and C are one: an engine that takes one for the other moves as it should. Here no two
parameters are equal, so that each has a part of its own in the motion.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.polynomial.legendre import leggauss, legvander

from compare.accuracy import SAFETY, refined
from compare.claim import Basis, Claim, ErrorBudget, Kind
from compare.engines import EVERY_KIND, Engine
from compare.paper import FIG5, FIG5_STARTS
from compare.report.style import axis, curve, engines_in, new_figure
from compare.studies.common import parameters_of
from compare.study import Data, Findings, Study
from reference_model import DiscOnDisc, PinOnDisc, simulate
from reference_model.contact import contact_of
from reference_model.support import Support
from reference_model.systems import FloatArray, System

if TYPE_CHECKING:
    from matplotlib.figure import Figure

States = Callable[[float], FloatArray]
"""Gives the states at ``times_of(motion)`` that an engine finds at a tolerance."""

EXACT = 1e-13
"""Tolerance of the reference."""

PANEL = 0.25
"""Length in s of the pieces of time over which forces are integrated."""

NODES, WEIGHTS = leggauss(10)
"""Of Gauss's rule, on (−1, 1): forces are integrated to rounding where no point of the contact comes to rest."""

SLOWEST_FALL = 0.9
"""Largest ratio of neighbouring Legendre coefficients of what is integrated."""

PIN = PinOnDisc(mass=1.3, stiffness=2.1, damping=0.17, friction_force=0.11, disc_speed=1.9, offset=0.07)

STIFFENING = replace(PIN, hardening=0.4, stop_gap=0.2, stop_stiffness=0.2)

DISC = DiscOnDisc(
    mass=1.3,
    polar_inertia=0.7,
    stiffness=2.1,
    damping=0.4,
    friction_force=0.055,
    disc_speed=1.9,
    offset=0.03,
    contact_radius=0.15,
    shaft_damping=0.02,
    shaft_speed=0.8,
)

SIX = replace(DISC, contact_points=6)

OTHER_WAY = replace(DISC, damping=0.15, disc_speed=-1.9, shaft_speed=-1.6)


@dataclass(frozen=True)
class Motion:
    """Parameters, start, length in s, whether it sticks on its way, resolution in SI units, and where it is from.

    ``tolerance`` is that of the engine.
    """

    system: System
    start: tuple[float, ...]
    until: float
    sticks: bool = False
    tolerance: float = 1e-10
    resolution: float = 1e-7
    source: str = (
        "parameters of which no two are equal, and a start from which nothing sticks, are our choice"
    )


DISC_START = (0.06, 0.01, 0.2, -0.01, 0.02, 0.9)

MOTIONS = {
    "a pin": Motion(PIN, (0.6, 0.1, -0.2, 0.5), 20.0),
    "a pin inside the play of its stop, with the disc turning the other way": Motion(
        replace(PIN, disc_speed=-PIN.disc_speed, stop_gap=1.0, stop_stiffness=0.2),
        (0.6, 0.1, -0.1, -0.6),
        20.0,
    ),
    "a pin on a support that hardens, beyond its stop": Motion(STIFFENING, (0.6, 0.1, -0.2, 0.5), 20.0),
    "a pin that sticks on its way": Motion(
        FIG5,
        FIG5_STARTS["whirl"],
        15.0,
        sticks=True,
        tolerance=1e-9,
        resolution=1e-5,
        source="Fig. 5, second start",
    ),
    "a disc on the continuous ring": Motion(DISC, DISC_START, 20.0),
    "a disc on six points": Motion(SIX, DISC_START, 20.0),
    "a disc on the continuous ring, all turning the other way": Motion(
        OTHER_WAY, (0.3, 0.1, 0.3, 0.05, -0.4, -1.7), 20.0
    ),
}
"""Nowhere but in the pin that sticks does a point of the contact come to rest: there friction has a bend."""

ONE_OF_EACH_KIND = ("a pin", "a pin that sticks on its way", "a disc on six points")
"""What an engine is asked for that differs from another in its contact alone."""

MOVES = "It moves state by state as the reference does: {}"
KINEMATICS = "Places and angle change by the integrals of velocity and spin: {}"
MOMENTUM = "Momentum and spin change by the impulses of friction, springs and dampers: {}"


def measure(engine: Engine, motions: Mapping[str, Motion] = MOTIONS) -> Findings:
    """Follow each motion that the engine simulates."""
    claims: list[Claim] = []
    data: Data = {}
    if engine.contact_only:
        motions = {name: motion for name, motion in motions.items() if name in ONE_OF_EACH_KIND}
    for name, motion in motions.items():
        if not engine.simulates(motion.system) or (motion.sticks and not engine.sticks):
            continue
        states = functools.cache(functools.partial(run, engine, motion))
        claims.append(movement_claim(engine, name, motion, states))
        if not motion.sticks:  # there friction holds, and is none of the contact's law
            claims += sum_claims(engine, name, motion, states)
        data[f"{name}: times"] = times_of(motion)
        data[f"{name}: error"] = np.max(np.abs(states(motion.tolerance) - run_of_reference(motion)), axis=1)
    lacking = engine.lacking(motion.system for motion in motions.values())
    if not lacking and not engine.sticks:
        lacking = f"{engine.name} does not simulate stick"
    return Findings(tuple(claims), data, not_simulated=lacking)


def times_of(motion: Motion) -> FloatArray:
    """Return bounds and Gauss nodes of all panels in their order: each panel begins with a bound."""
    bounds = np.linspace(0.0, motion.until, round(motion.until / PANEL) + 1)
    places = np.concatenate(([0.0], 0.5 + 0.5 * NODES))
    return np.append(bounds[:-1, np.newaxis] + PANEL * places, motion.until)


def run(engine: Engine, motion: Motion, tolerance: float) -> FloatArray:
    """Return the states at ``times_of(motion)``."""
    return engine.simulate(motion.system, motion.start, times_of(motion), tolerance=tolerance).states


@functools.cache
def run_of_reference(motion: Motion) -> FloatArray:
    """Return the states at ``times_of(motion)`` by the reference at its tightest."""
    return run(Engine("reference", simulate, EVERY_KIND), motion, EXACT)


def movement_claim(engine: Engine, name: str, motion: Motion, states: States) -> Claim:
    """Compare all states with the reference's."""
    measured, error = refined(states, motion.tolerance)
    predicted = run_of_reference(motion)
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
    "every quarter of a second places must change by the integral of velocity, momentum by the impulse of forces.",
    measure=measure,
    draw=draw,
    figures={
        "trajectories": "Difference of each motion from the reference's at tolerance 1e-13, the largest of all "
        "components of the state; the engines at tolerance 1e-10."
    },
    seconds=3.0,
    quick=True,
    contact=True,
)
