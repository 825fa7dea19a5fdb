"""Fig. 8 and eq. 24 to 26: place and spin of the self-centred disc over the load, and where it ends."""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from scipy.interpolate import KroghInterpolator

from compare.claims.answers import asked, holds
from compare.claims.claim import Claim, ErrorBudget
from compare.claims.error_estimates import refined
from compare.claims.linearised_flow import real_and_imaginary
from compare.claims.parameters import at_each, parameters_of
from compare.claims.study import Data, Findings, Study
from compare.engines import Engine
from compare.studies.disc.fig08.pictures import draw
from compare.studies.disc.fig08.theory import (
    RING,
    equilibrium_of,
    last_load,
    place_and_spin,
    theory,
    with_load,
)
from compare.studies.toolkit.steady_motion import steady_motion
from reference_model import simulate
from reference_model.formulas.disc import places_by_26, semicircle_residual
from reference_model.steady.stability import jacobian_without_angle
from reference_model.systems import ANGLE, DiscOnDisc, FloatArray

SIX = replace(RING, contact_points=6)
"""What the paper simulated."""

LOADS = (0.01, 0.02, 0.035, 0.05, 0.065, 0.08, 0.095, 0.1, 0.104)
"""μN in N. The paper prints no range; the equilibrium ends a little above C·X0 = 0.1 N."""

DECAYS = {0.05: (700.0, 1000.0), 0.095: (250.0, 400.0)}
"""μN in N, and in s the span in which the decay is measured: late enough for small deviations."""

END_LOADS = (0.1015, 0.1025, 0.1035, 0.1044, 0.1049, 0.1052)
"""μN in N, near to where the equilibrium ends; there the distance from the axis falls to zero linearly."""

STICKING_RATIOS = (0.98, 1.02, 1.05)
"""Loads about the last one with an equilibrium, in units of it."""

STICKING_TIME = 80.0
"""In s: in that time friction takes a disc with 95 % of the speed of the master disc along, where it can."""

TOLERANCE = 1e-10

REFERENCE_TOLERANCE = 1e-12
"""Of the motions on six points that are predicted."""

SOURCE = "Fig. 8; X0 = 0.1 m as in Figs. 4 to 6, which the paper leaves out; the loads are our choice"

RESTS = "The motion that comes back is the self-centred equilibrium of the continuous ring, at every load"
CIRCLE = "The self-centred equilibria of the continuous ring lie on the semicircle (4)"
SIX_POINTS = "On six points the disc spins and rests, in the mean, as exact Coulomb friction has it"
DECAY = "A disc that starts displaced comes to the equilibrium as its slowest eigenvalue says"
ENDS = (
    "The equilibrium reaches the axis at the load at which friction holds the disc against springs and shaft"
)
STICKS = "Above that load a disc on the axis sticks to the master disc, below it does not"


def measure(
    engine: Engine,
    loads: Sequence[float] = LOADS,
    decays: Mapping[float, tuple[float, float]] = DECAYS,
    ratios: Sequence[float] = STICKING_RATIOS,
) -> Findings:
    """Find the equilibria at ``loads`` (N) on ring and six points; follow displaced discs at those of ``decays``."""
    data: Data = {"load": np.array(loads)}
    claims: list[Claim] = []
    if engine.simulates(RING):
        measured, error = measured_means(engine, RING, loads)
        data["ring"] = measured
        claims += [
            *equilibrium_claims(engine, loads, measured, error),
            decay_claim(engine, decays),
            end_claim(engine),
            sticking_claim(engine, ratios),
        ]
    if engine.simulates(SIX):
        measured, error = measured_means(engine, SIX, loads)
        data["six points"] = measured
        claims.append(six_points_claim(engine, loads, measured, error))
    return Findings(tuple(claims), data, not_simulated=engine.lacking([RING, SIX]))


# ---------------------------------------------------------------- equilibria as such


def measured_means(engine: Engine, disc: DiscOnDisc, loads: Sequence[float]) -> tuple[FloatArray, float]:
    """Return the means of x and y in m and of the spin in rad/s at all loads, shape (n, 3), and their error."""

    def means(tolerance: float) -> FloatArray:
        return np.array([_means(engine, with_load(disc, load), tolerance) for load in loads])

    found, error = refined(means, TOLERANCE)
    # One number alone may be right by chance, and two runs may coincide to within the tolerance.
    return found, float(np.max(error)) + TOLERANCE * disc.offset


def _means(engine: Engine, disc: DiscOnDisc, tolerance: float) -> FloatArray:
    """Return means of x, y and spin over the motion near to the place by (26), which is some per cent off."""
    place, *_ = places_by_26(disc)
    motion = steady_motion(engine, disc, [place.x, place.y, 0.0, 0.0, 0.0, place.spin], tolerance)
    return np.full(3, np.nan) if motion is None else np.array([*motion.mean, motion.spin])


def equilibrium_claims(
    engine: Engine, loads: Sequence[float], measured: FloatArray, error: float
) -> tuple[Claim, ...]:
    """Compare the equilibria of the ring with root finding, and with the semicircle."""
    parameters, at = parameters_of(RING, without=("friction_force",)), at_each("μN", loads)
    x, y, _ = measured.T
    # ∂(4)/∂(x, y) is twice the way from the circle's centre, so of length X0 on the circle.
    on_circle = 2.0 * np.hypot(x - RING.offset / 2.0, y) * error + error**2
    return (
        Claim(
            RESTS,
            equation="(19), (20)",
            engine=engine.name,
            predicted=[place_and_spin(with_load(RING, load)) for load in loads],
            measured=measured,
            budget=ErrorBudget(error, resolution=1e-9),
            parameters=parameters,
            source=SOURCE,
            unit="m, rad/s",
            note=f"x, y and spin for {at} N. Measured: the state that the engine itself brings back after a sixth of "
            "a turn, found from the place by (26). Predicted: balance of forces and moments. Error: the tolerance, "
            "and the change at a smaller one.",
            basis="reference",
        ),
        Claim(
            CIRCLE,
            equation="(4)",
            engine=engine.name,
            predicted=np.zeros(len(loads)),
            measured=semicircle_residual(RING, x, y),
            budget=ErrorBudget(on_circle, resolution=1e-9 * RING.offset**2),
            parameters=parameters,
            source=SOURCE,
            unit="m²",
            note="Left side minus right side of (4), at the places of the claim above.",
            implied_by=RESTS,
        ),
    )


def six_points_claim(engine: Engine, loads: Sequence[float], measured: FloatArray, error: float) -> Claim:
    """Compare the means of the motion on six points with those of the reference."""
    beside_ring = np.abs(measured - [place_and_spin(with_load(RING, load)) for load in loads])[:, 2]
    return Claim(
        SIX_POINTS,
        equation="(19)–(21)",
        kind="trajectory",
        engine=engine.name,
        predicted=[_six_points_of_reference(load) for load in loads],
        measured=measured,
        budget=ErrorBudget(error, resolution=1e-9),
        parameters=parameters_of(SIX, without=("friction_force",)),
        source=SOURCE,
        unit="m, rad/s",
        note=f"Means of x, y and spin for {at_each('μN', loads)} N, over the motion that comes back after a sixth "
        f"of a turn; predicted by the reference at tolerance {REFERENCE_TOLERANCE:g}. The spin differs from that on "
        f"the continuous ring by {np.min(beside_ring):.1g} to {np.max(beside_ring):.1g} rad/s.",
    )


@functools.cache
def _six_points_of_reference(load: float) -> tuple[float, ...]:
    return tuple(
        _means(Engine("reference", simulate, ("points",)), with_load(SIX, load), REFERENCE_TOLERANCE)
    )


# ---------------------------------------------------------------- simulations that come to the equilibrium


def decay_claim(engine: Engine, decays: Mapping[float, tuple[float, float]]) -> Claim:
    """Compare the decay of displaced discs, by load in N the span in s, with the slowest eigenvalue."""
    predicted, measured, errors = [], [], []
    for load, span in decays.items():
        disc = with_load(RING, load)
        (earlier, later), error = refined(functools.partial(_decay, engine, disc, span), 1e-9)
        predicted.append(equilibrium_of(disc).eigenvalues[0])
        measured.append(later)
        # What is not linear falls with the deviation, so that of the later half less is left than the change shows.
        errors.append(np.max(error) + np.hypot(*(later - earlier)))
    return Claim(
        DECAY,
        equation="(19), (20)",
        engine=engine.name,
        predicted=real_and_imaginary(predicted),
        measured=measured,
        budget=ErrorBudget(np.repeat(np.array(errors)[:, np.newaxis], 2, axis=1), resolution=1e-4),
        parameters=parameters_of(RING, without=("friction_force",)),
        source=SOURCE,
        unit="1/s",
        note=f"Real and imaginary part for {at_each('μN', list(decays))} N. Starts at rest where the springs are "
        "relaxed, with the spin of the shaft. Measured: growth of the slowest mode's part of the deviation, in the "
        "later half of "
        + ", ".join(f"{start:g} to {end:g} s" for start, end in decays.values())
        + ". Error: the change against the earlier half, and at a smaller tolerance.",
        basis="reference",
    )


def _decay(engine: Engine, disc: DiscOnDisc, span: tuple[float, float], tolerance: float) -> FloatArray:
    """Return real and imaginary part in 1/s of the slowest mode's growth in both halves of ``span``, shape (2, 2)."""
    rest = equilibrium_of(disc).state
    start = np.array([disc.offset, 0.0, 0.0, 0.0, 0.0, disc.shaft_speed])
    # Two samples a radian: the mode's frequency is below the natural one.
    intervals = 4 * round(0.5 * disc.natural_frequency * (span[1] - span[0]))
    times = np.linspace(*span, intervals + 1)
    states = engine.simulate(disc, start, [0.0, *times], tolerance=tolerance).states[1:]
    # The left ones: of a sum of modes they see one.
    values, vectors = np.linalg.eig(jacobian_without_angle(disc, rest).T)
    slowest = vectors[:, max(range(len(values)), key=lambda i: (values[i].real, values[i].imag))]
    part = np.delete(states - rest, ANGLE, axis=1) @ slowest
    logarithm = np.log(np.abs(part)) + 1j * np.unwrap(np.angle(part))
    earlier, later = np.diff(logarithm[[0, intervals // 2, intervals]]) / (0.5 * (span[1] - span[0]))
    return real_and_imaginary([earlier, later])


# ---------------------------------------------------------------- the end of the equilibrium


def end_claim(engine: Engine) -> Claim:
    """Extrapolate the loads of equilibria near the axis to the axis."""
    measured, error = refined(
        lambda tolerance: [_means(engine, with_load(RING, load), tolerance) for load in END_LOADS], TOLERANCE
    )
    distance = np.hypot(measured[:, 0], measured[:, 1])
    on_axis = _extrapolated(distance, END_LOADS)
    moved = [_extrapolated(distance + np.max(error) * one, END_LOADS) for one in np.eye(len(distance))]
    without_farthest = _extrapolated(distance[1:], END_LOADS[1:])
    numerical = np.sum(np.abs(np.array(moved) - on_axis)) + abs(on_axis - without_farthest)
    return Claim(
        ENDS,
        equation="(5)",
        engine=engine.name,
        predicted=last_load(RING),
        measured=on_axis,
        budget=ErrorBudget(numerical, resolution=1e-6),
        parameters=parameters_of(RING, without=("friction_force",)),
        source=SOURCE,
        unit="N",
        note=f"Measured: equilibria at {at_each('μN', END_LOADS)} N, the load as a polynomial of their distance from "
        f"the axis. A pin's would end at C·X0 = {RING.stiffness * RING.offset:g} N; of the disc's friction the "
        "moment of the shaft takes a part. Error: the change without the farthest, and at a smaller tolerance.",
        basis="reference",
    )


def _extrapolated(distances: FloatArray, loads: Sequence[float]) -> float:
    """Return the load in N of a disc on the axis, from those at several ``distances`` in m, if they differ."""
    if not np.all(np.diff(distances) < 0.0):
        return math.nan
    return float(KroghInterpolator(distances, np.array(loads))(0.0))


def sticking_claim(engine: Engine, ratios: Sequence[float]) -> Claim:
    """See at loads about the end of the equilibrium, in units of it, whether a disc on the axis sticks."""
    loads = np.array(ratios) * last_load(RING)
    start = [0.0, 0.0, 0.0, 0.0, 0.0, 0.95 * RING.disc_speed]

    def as_said(tolerance: float) -> list[bool]:
        runs = [
            engine.simulate(with_load(RING, load), start, [0.0, STICKING_TIME], tolerance=tolerance)
            for load in loads
        ]
        return [
            (run.phases[-1].kind == "stick") == (ratio > 1.0) for run, ratio in zip(runs, ratios, strict=True)
        ]

    return Claim(
        STICKS,
        equation="(5)",
        engine=engine.name,
        **holds(*asked(as_said, 1e-7)),
        parameters=parameters_of(RING, without=("friction_force",)),
        source=SOURCE,
        note=f"Whether it sticks after {STICKING_TIME:g} s, or does not, for {at_each('μN', loads)} N. Starts on the "
        "axis with 95 % of the speed of the master disc.",
        basis="reference",
    )


STUDY = Study(
    name="fig08",
    title="Place and spin of the self-centred disc",
    section="The friction disc",
    paper=(
        "A disc on the slow master disc finds a rest in space as the pin does, on the same semicircle (4), and spins "
        "about its centre at a speed between those of shaft and master disc. From the simplified equations (23) "
        "follows (26), which Fig. 8 compares with simulations on six contact points. X0 and the range of the load "
        "are left out; here X0 = 0.1 m as in Figs. 4 to 6, and others beside it. (26) as printed has a wrong "
        "bracket; the line of the figure is that of the corrected one here. Because the moment of the shaft takes "
        "a part of the friction, the equilibrium ends a little above the C·X0 of (5)."
    ),
    by_hand=measure,
    theory=theory,
    draw=draw,
    figures={
        "fig08-spin": (
            "Fig. 8 redrawn. Left: spin over the load. Middle: how far the approximation (26), six points, and each "
            "engine's ring are from the exact equilibrium on the continuous ring. Where the line of (26) as printed "
            "crosses the ring's spin, it does so by chance: its places are wrong there. Right: all equilibria "
            "lie on the semicircle."
        ),
        "fig08-offset": (
            "What the missing X0 decides. Left: spin over the load for several X0 (continuous ring; dashed: "
            "corrected (26)), up to the load where the disc comes to stick on the axis (dots). Right: that load. For "
            "a small X0 it is friction's moment against the shaft that counts, for a large one the force of springs."
        ),
    },
    seconds=2.0,
)
