"""Steady states by (23) to (26), and an engine's motions near them."""

import functools
import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.interpolate import KroghInterpolator
from scipy.optimize import root

from compare.claims.error_estimates import ROUNDING, TIGHTEST, WORKING, Measurement, refined
from compare.claims.linearised_flow import real_and_imaginary
from compare.claims.measured import Measured, answers_of, asked
from compare.claims.parameters import FIG8
from compare.claims.study import Study
from compare.engines import Engine, reference
from compare.studies.toolkit.deviations import PARTS
from compare.studies.toolkit.measuring import compared, residual_of_4
from compare.studies.toolkit.steady_motion import equilibrium_of, last_load, steady_motion, with_load
from reference_model.contact.contact_law import IsotropicContact, ThreeTermRing
from reference_model.formulas import disc as formulas
from reference_model.formulas.disc import pin_of, positions_by_26
from reference_model.steady.stability import jacobian_without_angle
from reference_model.systems import ANGLE, DiscOnDisc, FloatArray

RING = FIG8
SIX = replace(RING, contact_points=6)
"""Discs on the continuous ring (20), and on points as in the paper's simulations."""

PAPER_LAW = ThreeTermRing(FIG8.contact_radius)  # contact law (23)

SOURCE = "Fig. 8; X0 = 0.1 m as in Figs. 4 to 6, which the paper omits; the friction forces are our choice"

SOURCE_OF_GRID = "Fig. 8; friction forces and X0 are our choice, the paper omits X0"

LOADS = (0.01, 0.035, 0.065, 0.095, 0.104)
"""μN in N, which the paper omits; the equilibrium ends slightly above C·X0 = 0.1 N."""

DECAYS = ((0.05, (700.0, 1000.0)), (0.095, (250.0, 400.0)))
"""μN in N, and the time span (s) of the decay, late enough for small deviations."""

END_LOADS = (0.1015, 0.1025, 0.1035, 0.1044, 0.1049, 0.1052)
"""μN in N near the end of the equilibrium, where its distance from the axis falls linearly."""

STICKING_RATIOS, STICKING_TIME = (0.98, 1.02, 1.05), 80.0
"""μN as a multiple of the largest μN with an equilibrium, and time (s) until a disc gains the last 5 % of ω."""

OFFSETS = (0.02, 0.05, 0.1, 0.2)
"""X0 in m, which the paper omits; 0.1 m is the value of Figs. 4 to 6."""

TOLERANCE = WORKING / 10  # for motions to rest, because the claims resolve 1e-9
BALANCED = 1e-9  # largest residual force due to rounding, as a share of μN; (26) as printed leaves far more
RESOLUTION = 1e-9  # positions in m, spins in rad/s


PLACE_AND_SPIN = ("x in m", "y in m", "spin in rad/s")


def place_and_spin(disc: DiscOnDisc, contact: IsotropicContact | None = None) -> FloatArray:
    """Return the numbers named in ``PLACE_AND_SPIN`` for the self-centred equilibrium."""
    equilibrium = equilibrium_of(disc, contact)
    return np.array([equilibrium.x, equilibrium.y, equilibrium.spin])


def grid() -> list[DiscOnDisc]:
    discs = [replace(RING, offset=offset) for offset in OFFSETS]
    shares = np.linspace(0.0, 1.0, 13)[1:-1]
    return [with_load(disc, share * last_load(disc, PAPER_LAW)) for disc in discs for share in shares]


def by_26(disc: DiscOnDisc) -> FloatArray:
    """Return x, y (m) and spin (rad/s) by the corrected (26)."""
    (place,) = positions_by_26(disc)
    return np.array(place)


def unbalanced(disc: DiscOnDisc, as_printed: bool) -> float:
    """Return the residual force of springs and friction (23), as a share of μN, at the position by (26)."""
    place, *_ = positions_by_26(disc, as_printed=as_printed)
    z, omega = complex(place.x, place.y), disc.disc_speed
    friction, _ = PAPER_LAW.force_and_moment(-1j * omega * z, omega - place.spin, 0.0)
    return abs(disc.stiffness * (disc.offset - z) / disc.friction_force + friction)


def last_load_by_26(disc: DiscOnDisc) -> float:
    """Return the friction force (N) where A of (26) becomes zero."""
    difference = formulas.reduced_parameters(disc).speed_difference

    def miss(unknowns: FloatArray) -> FloatArray:
        load, alpha = unknowns
        loaded = with_load(disc, load)
        squared = formulas.squared_distance(loaded, alpha) / disc.offset**2
        return np.array([squared, formulas.speed_difference_at(loaded, 0.0, alpha) - difference])

    start = disc.stiffness * disc.offset + formulas.shaft_torque(disc) / disc.contact_radius
    return float(root(miss, [start, math.pi / 4.0], options={"xtol": ROUNDING}).x[0])


STUDY = Study.beside(
    __file__, "fig08", source=SOURCE, system=RING, seconds=2.5, words={"own": f"{RING.offset:g}"}
)


@functools.lru_cache(maxsize=4)
def means_of(engine: Engine, disc: DiscOnDisc, loads: Sequence[float]) -> Measurement:
    """Return the means of x, y (m) and spin (rad/s) at all μN, shape (n, 3), with a common error."""
    found = refined(
        lambda tolerance: [_means(engine, with_load(disc, load), tolerance) for load in loads], TOLERANCE
    )
    # Two runs may agree to within the tolerance.
    return Measurement(found.value, np.asarray(found.largest + TOLERANCE * disc.offset))


def _means(engine: Engine, disc: DiscOnDisc, tolerance: float) -> FloatArray:
    place, *_ = positions_by_26(disc)
    motion = steady_motion(engine, disc, [place.x, place.y, 0.0, 0.0, 0.0, place.spin], tolerance)
    return np.full(3, np.nan) if motion is None else np.array([*motion.mean, motion.spin])


@STUDY.claim(
    "On the continuous ring, the engine's steady state is the self-centred equilibrium, at every friction force",
    equation="(19), (20)",
    unit="m, rad/s",
    resolution=RESOLUTION,
    note="Measured: the state that repeats after a sixth of a turn in the engine, with the position (26) as initial "
    "guess. Predicted: balance of forces and moments. Error: the tolerance, and the change at a smaller one.",
    basis="reference",
    swept=("friction_force",),
)
def rests(engine: Engine, loads: Sequence[float] = LOADS) -> Measured:
    found = means_of(engine, RING, loads)
    return compared(
        [place_and_spin(with_load(RING, load)) for load in loads],
        found,
        at={"μN in N": loads},
        components=PLACE_AND_SPIN,
        data={"load": loads, "ring": found.value},
    )


@STUDY.claim(
    "The self-centred equilibria of the continuous ring lie on the semicircle (4)",
    equation="(4)",
    unit="m²",
    resolution=1e-9 * RING.offset**2,
    note="Left side minus right side of (4), at the positions of the previous claim.",
    implied_by=rests,
    friction=False,
    swept=("friction_force",),
)
def on_semicircle(engine: Engine, loads: Sequence[float] = LOADS) -> Measured:
    places, error = means_of(engine, RING, loads)
    return residual_of_4(pin_of(RING), places[:, :2], error, {"μN in N": loads})


@STUDY.claim(
    "A displaced disc approaches the equilibrium as the slowest eigenvalue predicts",
    equation="(19), (20)",
    unit="1/s",
    resolution=1e-4,
    note="Starts at rest at the relaxed position of the springs, with the spin of the shaft. Measured: growth of the "
    "slowest mode's share of the deviation, in the later half of "
    + ", ".join(f"{start:g} to {end:g} s" for _, (start, end) in DECAYS)
    + ". Error: the change from the earlier half, and at a smaller tolerance.",
    basis="reference",
    swept=("friction_force",),
)
def decays(engine: Engine, spans: Sequence[tuple[float, tuple[float, float]]] = DECAYS) -> Measured:
    """``spans`` contains μN (N) and times (s)."""
    discs = [with_load(RING, load) for load, _ in spans]
    measured, errors = [], []
    for disc, (_, span) in zip(discs, spans, strict=True):
        (earlier, later), error = refined(functools.partial(_decay, engine, disc, span), WORKING)
        measured.append(later)
        # Nonlinear terms fall with the deviation, so the change exceeds them in the later half.
        errors.append([np.max(error) + np.hypot(*(later - earlier))] * 2)
    return Measured(
        predicted=real_and_imaginary([equilibrium_of(disc).eigenvalues[0] for disc in discs]),
        value=measured,
        error=errors,
        at={"μN in N": [load for load, _ in spans]},
        components=PARTS,
    )


def _decay(engine: Engine, disc: DiscOnDisc, span: tuple[float, float], tolerance: float) -> FloatArray:
    """Return growth rate and frequency (1/s) of the slowest mode in both halves of ``span``, shape (2, 2)."""
    rest = equilibrium_of(disc).state
    start = np.array([disc.offset, 0.0, 0.0, 0.0, 0.0, disc.shaft_speed])
    # Two samples per radian; the mode is slower than the natural frequency.
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
    note=f"Measured: equilibria at {', '.join(f'{load:g}' for load in END_LOADS)} N, with μN as a polynomial "
    "of their distance from the axis. The equilibrium of a pin would end at C·X0 = "
    f"{RING.stiffness * RING.offset:g} N; the moment of the shaft uses part of the disc's friction. "
    "Error: the change without the farthest equilibrium, and at a smaller tolerance.",
    basis="reference",
    swept=("friction_force",),
)
def ends(engine: Engine) -> Measured:
    found = refined(
        lambda tolerance: [_means(engine, with_load(RING, load), tolerance) for load in END_LOADS], TOLERANCE
    )
    distance = np.hypot(*found.value[:, :2].T)
    on_axis = _extrapolated(distance, END_LOADS)
    moved = [_extrapolated(distance + found.largest * one, END_LOADS) for one in np.eye(len(distance))]
    without_farthest = _extrapolated(distance[1:], END_LOADS[1:])
    return Measured(
        predicted=last_load(RING),
        value=on_axis,
        error=np.sum(np.abs(np.array(moved) - on_axis)) + abs(on_axis - without_farthest),
    )


def _extrapolated(distances: FloatArray, loads: Sequence[float]) -> float:
    """Return μN (N) at the axis, extrapolated from ``distances`` (m); NaN unless these decrease."""
    if not np.all(np.diff(distances) < 0.0):
        return math.nan
    return float(KroghInterpolator(distances, np.array(loads))(0.0))


@STUDY.claim(
    "A disc on the axis sticks to the master disc above the μN at which the equilibrium ends, but not below",
    equation="(5)",
    note=f"Does the disc stick after {STICKING_TIME:g} s at "
    f"{', '.join(f'{ratio:g}' for ratio in STICKING_RATIOS)} times this μN? Starts on the axis with 95 % of the "
    "speed of the master disc.",
    basis="reference",
    swept=("friction_force",),
)
def sticks(engine: Engine, ratios: Sequence[float] = STICKING_RATIOS) -> Measured:
    """``ratios`` are multiples of the μN at the end of the equilibrium."""
    loads = np.array(ratios) * last_load(RING)
    start = [0.0, 0.0, 0.0, 0.0, 0.0, 0.95 * RING.disc_speed]

    def as_said(tolerance: float) -> list[bool]:
        motions = [(with_load(RING, load), start, [0.0, STICKING_TIME]) for load in loads]
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
def six_points(engine: Engine, loads: Sequence[float] = LOADS) -> Measured:
    found = means_of(engine, SIX, loads)
    beside_ring = np.abs(found.value - [place_and_spin(with_load(RING, load)) for load in loads])[:, 2]
    return compared(
        [_six_points_of_reference(load) for load in loads],
        found,
        at={"μN in N": loads},
        components=PLACE_AND_SPIN,
        system=SIX,
        note=f"The spin differs from that on the continuous ring by {np.min(beside_ring):.1g} to "
        f"{np.max(beside_ring):.1g} rad/s.",
        data={"load": loads, "six points": found.value},
    )


@functools.cache
def _six_points_of_reference(load: float) -> tuple[float, ...]:
    return tuple(_means(reference, with_load(SIX, load), TIGHTEST))


@STUDY.claim(
    "The corrected (26) equals the equilibrium of (23), at every friction force and offset",
    equation="(26)",
    unit="m, rad/s",
    resolution=1e-12,
    note="Predicted: balance of forces and moments of (19) with (23). Error: rounding of the parameters.",
    swept=("friction_force", "offset"),
)
def corrected_26() -> Measured:
    discs = grid()
    places = np.array([by_26(disc) for disc in discs])
    moved = np.array([by_26(with_load(disc, disc.friction_force * (1.0 + ROUNDING))) for disc in discs])
    return Measured(
        predicted=[place_and_spin(disc, PAPER_LAW) for disc in discs],
        value=places,
        error=np.abs(moved - places) + ROUNDING * RING.offset,
        at={"X0, μN": [f"{disc.offset:g} m, {disc.friction_force:.4g} N" for disc in discs]},
        components=PLACE_AND_SPIN,
        source=SOURCE_OF_GRID,
    )


@STUDY.claim(
    "Springs and friction (23) do not balance at any position of (26) as printed",
    equation="(26)",
    note=f"Is the residual force at a position below {BALANCED:g}·μN for the corrected (26), and above it for "
    "the printed one?",
    swept=("friction_force", "offset"),
)
def printed_26() -> Measured:
    discs = grid()
    corrected, printed = (
        np.array([unbalanced(disc, as_printed) for disc in discs]) for as_printed in (False, True)
    )
    return answers_of(
        [*(BALANCED - corrected), *(printed - BALANCED)],
        source=SOURCE_OF_GRID,
        note=f"At {len(discs)} positions each. It is at most {np.max(corrected):.1g}·μN for the corrected one, and "
        f"{np.min(printed):.2g} to {np.max(printed):.2g}·μN for the printed one.",
    )


@STUDY.claim(
    "The branch of the corrected (26) ends at the load that lets friction (23) hold the disc",
    equation="(5), (26)",
    unit="N",
    resolution=1e-9,
    note="Measured: μN and α at which the first two lines of (26) hold with A = 0.",
    swept=("friction_force", "offset"),
)
def end_of_26() -> Measured:
    discs = [replace(RING, offset=offset) for offset in OFFSETS]
    predicted = np.array([last_load(disc, PAPER_LAW) for disc in discs])
    return Measured(
        predicted=predicted,
        value=[last_load_by_26(disc) for disc in discs],
        error=2.0 * ROUNDING * predicted,
        at={"X0 in m": OFFSETS},
        source=SOURCE_OF_GRID,
    )
