"""Claims."""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.interpolate import KroghInterpolator

import compare.studies.disc.fig08.theory as theory
from compare.claims.error_estimates import ROUNDING, TIGHTEST, WORKING, Measurement, refined
from compare.claims.linearised_flow import real_and_imaginary
from compare.claims.measured import Measured, answers_of, asked
from compare.claims.study import Study
from compare.engines import Engine
from compare.studies.toolkit.steady_motion import equilibrium_of, last_load, steady_motion, with_load
from reference_model import simulate
from reference_model.formulas.disc import positions_by_26, semicircle_residual
from reference_model.steady.stability import jacobian_without_angle
from reference_model.systems import ANGLE, DiscOnDisc, FloatArray

STUDY = Study.beside(
    __file__,
    "fig08",
    source=theory.SOURCE,
    system=theory.RING,
    seconds=2.5,
    words={"own": f"{theory.RING.offset:g}"},
)
STUDY.provides(curves=theory.curves)


@functools.lru_cache(maxsize=4)
def means_of(engine: Engine, disc: DiscOnDisc, loads: Sequence[float]) -> Measurement:
    """Return the means of x and y in m and of the spin in rad/s at all μN, shape (n, 3), with one common error."""
    found = refined(
        lambda tolerance: [_means(engine, with_load(disc, load), tolerance) for load in loads],
        theory.TOLERANCE,
    )
    # A single number may be right by chance, and two runs may agree to within the tolerance.
    return Measurement(found.value, np.asarray(found.largest + theory.TOLERANCE * disc.offset))


def _means(engine: Engine, disc: DiscOnDisc, tolerance: float) -> FloatArray:
    """Return the means of x, y and spin of the steady motion found from (26), which deviates by a few per cent."""
    place, *_ = positions_by_26(disc)
    motion = steady_motion(engine, disc, [place.x, place.y, 0.0, 0.0, 0.0, place.spin], tolerance)
    return np.full(3, np.nan) if motion is None else np.array([*motion.mean, motion.spin])


@STUDY.claim(
    "On the continuous ring, the engine's steady state is the self-centred equilibrium, at every friction force",
    equation="(19), (20)",
    unit="m, rad/s",
    resolution=theory.RESOLUTION,
    note="Measured: the state that repeats after a sixth of a turn in the engine, with the position (26) as initial "
    "guess. Predicted: balance of forces and moments. Error: the tolerance, and the change at a smaller one.",
    basis="reference",
    swept=("friction_force",),
)
def rests(engine: Engine, loads: Sequence[float] = theory.LOADS) -> Measured:
    found = means_of(engine, theory.RING, loads)
    return Measured(
        predicted=[theory.place_and_spin(with_load(theory.RING, load)) for load in loads],
        value=found.value,
        error=found.error,
        at={"μN in N": loads},
        components=("x in m", "y in m", "spin in rad/s"),
        data={"load": loads, "ring": found.value},
    )


@STUDY.claim(
    "The self-centred equilibria of the continuous ring lie on the semicircle (4)",
    equation="(4)",
    unit="m²",
    resolution=1e-9 * theory.RING.offset**2,
    note="Left side minus right side of (4), at the positions of the previous claim.",
    implied_by=rests,
    swept=("friction_force",),
)
def on_semicircle(engine: Engine, loads: Sequence[float] = theory.LOADS) -> Measured:
    found = means_of(engine, theory.RING, loads)
    x, y, _ = found.value.T
    # The gradient of (4) is twice the vector from the circle's centre, of length X0 on the circle.
    error = 2.0 * np.hypot(x - theory.RING.offset / 2.0, y) * found.error + found.error**2
    return Measured(
        predicted=np.zeros(len(loads)),
        value=semicircle_residual(theory.RING, x, y),
        error=error,
        at={"μN in N": loads},
    )


@STUDY.claim(
    "A displaced disc approaches the equilibrium as the slowest eigenvalue predicts",
    equation="(19), (20)",
    unit="1/s",
    resolution=1e-4,
    note="Starts at rest at the relaxed position of the springs, with the spin of the shaft. Measured: growth of the "
    "slowest mode's share of the deviation, in the later half of "
    + ", ".join(f"{start:g} to {end:g} s" for _, (start, end) in theory.DECAYS)
    + ". Error: the change from the earlier half, and at a smaller tolerance.",
    basis="reference",
    swept=("friction_force",),
)
def decays(engine: Engine, spans: Sequence[tuple[float, tuple[float, float]]] = theory.DECAYS) -> Measured:
    """``spans`` contains μN in N and times in s."""
    measured, errors = [], []
    for load, span in spans:
        (earlier, later), error = refined(
            functools.partial(_decay, engine, with_load(theory.RING, load), span), WORKING
        )
        measured.append(later)
        # Nonlinear terms fall with the deviation, so they are smaller in the later half than the change shows.
        errors.append(np.max(error) + np.hypot(*(later - earlier)))
    return Measured(
        predicted=real_and_imaginary(
            [equilibrium_of(with_load(theory.RING, load)).eigenvalues[0] for load, _ in spans]
        ),
        value=measured,
        error=np.repeat(np.array(errors)[:, np.newaxis], 2, axis=1),
        at={"μN in N": [load for load, _ in spans]},
        components=("real part", "imaginary part"),
    )


def _decay(engine: Engine, disc: DiscOnDisc, span: tuple[float, float], tolerance: float) -> FloatArray:
    """Return real and imaginary growth rate in 1/s of the least damped mode in both halves of ``span``, (2, 2)."""
    rest = equilibrium_of(disc).state
    start = np.array([disc.offset, 0.0, 0.0, 0.0, 0.0, disc.shaft_speed])
    # Two samples per radian; the mode's frequency is below the natural frequency.
    intervals = 4 * round(0.5 * disc.natural_frequency * (span[1] - span[0]))
    times = np.linspace(*span, intervals + 1)
    states = engine.simulate(disc, start, [0.0, *times], tolerance=tolerance).states[1:]
    # Left eigenvectors project onto a single mode.
    values, vectors = np.linalg.eig(jacobian_without_angle(disc, rest).T)
    slowest = vectors[:, max(range(len(values)), key=lambda i: (values[i].real, values[i].imag))]
    part = np.delete(states - rest, ANGLE, axis=1) @ slowest
    logarithm = np.log(np.abs(part)) + 1j * np.unwrap(np.angle(part))
    earlier, later = np.diff(logarithm[[0, intervals // 2, intervals]]) / (0.5 * (span[1] - span[0]))
    return real_and_imaginary([earlier, later])


@STUDY.claim(
    "The equilibrium reaches the axis at the μN that holds the disc against springs and shaft",
    equation="(5)",
    unit="N",
    resolution=1e-6,
    note=f"Measured: equilibria at {', '.join(f'{load:g}' for load in theory.END_LOADS)} N, with μN as a polynomial "
    "of their distance from the axis. The equilibrium of a pin would end at C·X0 = "
    f"{theory.RING.stiffness * theory.RING.offset:g} N; the moment of the shaft uses part of the disc's friction. "
    "Error: the change without the farthest equilibrium, and at a smaller tolerance.",
    basis="reference",
    swept=("friction_force",),
)
def ends(engine: Engine) -> Measured:
    found = refined(
        lambda tolerance: [
            _means(engine, with_load(theory.RING, load), tolerance) for load in theory.END_LOADS
        ],
        theory.TOLERANCE,
    )
    distance = np.hypot(found.value[:, 0], found.value[:, 1])
    on_axis = _extrapolated(distance, theory.END_LOADS)
    moved = [_extrapolated(distance + found.largest * one, theory.END_LOADS) for one in np.eye(len(distance))]
    without_farthest = _extrapolated(distance[1:], theory.END_LOADS[1:])
    return Measured(
        predicted=last_load(theory.RING),
        value=on_axis,
        error=np.sum(np.abs(np.array(moved) - on_axis)) + abs(on_axis - without_farthest),
    )


def _extrapolated(distances: FloatArray, loads: Sequence[float]) -> float:
    """Return μN in N at the axis, extrapolated from ``loads`` at ``distances`` in m; NaN unless these decrease."""
    if not np.all(np.diff(distances) < 0.0):
        return math.nan
    return float(KroghInterpolator(distances, np.array(loads))(0.0))


@STUDY.claim(
    "A disc on the axis sticks to the master disc above the μN at which the equilibrium ends, but not below",
    equation="(5)",
    note=f"Does it stick, or not, after {theory.STICKING_TIME:g} s at "
    f"{', '.join(f'{ratio:g}' for ratio in theory.STICKING_RATIOS)} of this μN? Starts on the axis with 95 % of the "
    "speed of the master disc.",
    basis="reference",
    swept=("friction_force",),
)
def sticks(engine: Engine, ratios: Sequence[float] = theory.STICKING_RATIOS) -> Measured:
    """``ratios`` are in units of the μN at the end of the equilibrium."""
    loads = np.array(ratios) * last_load(theory.RING)
    start = [0.0, 0.0, 0.0, 0.0, 0.0, 0.95 * theory.RING.disc_speed]

    def as_said(tolerance: float) -> list[bool]:
        motions = [(with_load(theory.RING, load), start, [0.0, theory.STICKING_TIME]) for load in loads]
        runs = engine.simulate_many(motions, tolerance=tolerance)
        return [
            (run.phases[-1].kind == "stick") == (ratio > 1.0) for run, ratio in zip(runs, ratios, strict=True)
        ]

    return answers_of(*asked(as_said, 1e-7))


@STUDY.claim(
    "On six points, the mean position and spin of the disc equal those of exact Coulomb friction",
    equation="(19)–(21)",
    kind="trajectory",
    unit="m, rad/s",
    resolution=1e-9,
    note="Means over the motion that repeats after a sixth of a turn. Predicted: the reference at tolerance "
    f"{TIGHTEST:g}.",
    swept=("friction_force",),
)
def six_points(engine: Engine, loads: Sequence[float] = theory.LOADS) -> Measured:
    found = means_of(engine, theory.SIX, loads)
    beside_ring = np.abs(
        found.value - [theory.place_and_spin(with_load(theory.RING, load)) for load in loads]
    )[:, 2]
    return Measured(
        predicted=[_six_points_of_reference(load) for load in loads],
        value=found.value,
        error=found.error,
        at={"μN in N": loads},
        components=("x in m", "y in m", "spin in rad/s"),
        system=theory.SIX,
        note=f"The spin differs from that on the continuous ring by {np.min(beside_ring):.1g} to "
        f"{np.max(beside_ring):.1g} rad/s.",
        data={"load": loads, "six points": found.value},
    )


@functools.cache
def _six_points_of_reference(load: float) -> tuple[float, ...]:
    return tuple(_means(Engine("reference", simulate, ("points",)), with_load(theory.SIX, load), TIGHTEST))


@STUDY.claim(
    "The corrected (26) equals the equilibrium of (23), at every friction force and offset",
    equation="(26)",
    unit="m, rad/s",
    resolution=1e-12,
    note="Predicted: balance of forces and moments of (19) with (23). Error: rounding of the parameters.",
    swept=("friction_force", "offset"),
)
def corrected_26() -> Measured:
    discs = theory.grid()
    places = np.array([theory.by_26(disc) for disc in discs])
    moved = np.array(
        [theory.by_26(with_load(disc, disc.friction_force * (1.0 + ROUNDING))) for disc in discs]
    )
    return Measured(
        predicted=[theory.place_and_spin(disc, theory.PAPER_LAW) for disc in discs],
        value=places,
        error=np.abs(moved - places) + ROUNDING * theory.RING.offset,
        at={"X0, μN": [f"{disc.offset:g} m, {disc.friction_force:.4g} N" for disc in discs]},
        components=("x in m", "y in m", "spin in rad/s"),
        source=theory.SOURCE_OF_GRID,
    )


@STUDY.claim(
    "Springs and friction (23) do not balance at any position of (26) as printed",
    equation="(26)",
    note=f"Is the residual force at a position below {theory.BALANCED:g}·μN for the corrected (26), and above it for "
    "the printed one?",
    swept=("friction_force", "offset"),
)
def printed_26() -> Measured:
    discs = theory.grid()
    corrected, printed = (
        np.array([theory.unbalanced(disc, as_printed) for disc in discs]) for as_printed in (False, True)
    )
    return answers_of(
        [*(theory.BALANCED - corrected), *(printed - theory.BALANCED)],
        source=theory.SOURCE_OF_GRID,
        note=f"At {len(discs)} positions each. It is at most {np.max(corrected):.1g}·μN for the corrected one, and "
        f"{np.min(printed):.2g} to {np.max(printed):.2g}·μN for the printed one.",
    )


@STUDY.claim(
    "The corrected (26) ends at the μN at which friction (23) holds the disc against springs and shaft",
    equation="(5), (26)",
    unit="N",
    resolution=1e-9,
    note="Measured: μN and α at which the first two lines of (26) hold with A = 0.",
    swept=("friction_force", "offset"),
)
def end_of_26() -> Measured:
    discs = [replace(theory.RING, offset=offset) for offset in theory.OFFSETS]
    predicted = np.array([last_load(disc, theory.PAPER_LAW) for disc in discs])
    return Measured(
        predicted=predicted,
        value=[theory.last_load_by_26(disc) for disc in discs],
        error=2.0 * ROUNDING * predicted,
        at={"X0 in m": theory.OFFSETS},
        source=theory.SOURCE_OF_GRID,
    )
