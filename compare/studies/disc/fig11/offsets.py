"""Claims on motions with an offset, and on six points."""

import functools
import math
from collections.abc import Sequence

import numpy as np

import compare.studies.disc.fig11.theory as theory
from compare.claims import WORKING, Measured, Measurement, answers_of, asked, known, refined
from compare.claims.parameters import FIG8, at_each
from compare.engines import DeclaredLackError, Engine, StatesOnly, reference
from compare.studies.disc.fig11.theory import STUDY
from compare.studies.disc.fig11.whirl import GROWTH_NOTE, growth
from compare.studies.toolkit.fig11 import RING, SIX, SOURCE, START, rates
from compare.studies.toolkit.measuring import compared
from reference_model import Orbit, Trajectory, simulate, whirl_orbit
from reference_model.orbits import modulated_cycle
from reference_model.systems import ANGLE, FloatArray

ROUND = np.linspace(0.0, 300.0, 3001)  # times in s, longer than a period of the modulation
OF_RESTS = 200 * WORKING  # for motions on six points, where single points rest

OFFSETS = (0.0, 0.004, 0.007, 0.009, 0.018, 0.022, FIG8.offset)
"""X0 in m of the long simulations; the last value belongs to the other figures."""

ENDS_UNTIL, LOOKED_AT, ENDS_TOLERANCE = 720.0, 240.0, 1e-4
"""Duration in s, its evaluated end in s, a period of the modulation, and tolerance."""

SWING, ORBITS_EXTENT = 0.005, 1e-4
"""Smallest swings of a modulated motion's spin (rad/s, mean over a turn) and of a whirl's radius (m)."""

MODULATED_THERE = (0.01608, -0.00617, 0.0, 0.00943, 0.01375, 1.39531)
"""Near the modulated motion at ``theory.BOTH_STABLE``, found by raising X0 in small steps."""

KINDS = ("rest", "whirl", "modulated")


# --- Final motion against the offset


@STUDY.claim(
    "The whirl is unstable below a critical X0, where a pair of Floquet multipliers crosses the unit circle",
    equation="(19)–(21)",
    kind="trajectory",
    unit="m",
    resolution=1e-3 * theory.TRIED[1],
    note="Measured: whirls with an offset by shooting with the engine, for "
    f"{at_each('X0', theory.TRIED)} m, and their multipliers by differences. Predicted: the result of one Newton "
    "step from that X0 with multipliers from the variational equations, integrated with the "
    "analytic Jacobian. Error: the change at a smaller tolerance, the change with linear "
    "interpolation, and the change of a time shift by the linearised return map.",
    named={"critical offset": 0},
    swept=("offset",),
)
def critical(engine: Engine) -> Measured:
    return compared(*critical_of(engine), source=SOURCE)


@functools.lru_cache(maxsize=4)
def critical_of(engine: Engine) -> tuple[float, Measurement]:
    """Return the critical X0 (m) from the exact multipliers and from the engine's; NaN if there is none."""
    found = functools.cache(lambda tolerance: theory.critical_offset(engine, tolerance))
    try:
        measured, error = refined(lambda tolerance: found(tolerance)[0])
        _, interpolation, slope, near = found(WORKING)
        exact = theory.multipliers_by_variation(theory.disc_at(float(measured)), near)
    except RuntimeError:  # no whirl, or no critical whirl
        return math.nan, Measurement(np.array(math.nan), np.array(0.0))
    error = error + interpolation + error_of_monodromy(near) / abs(slope)
    predicted = float(measured) - (theory.pair_modulus(exact) - 1.0) / slope
    return predicted, Measurement(measured, known(measured, error))


def error_of_monodromy(orbit: Orbit) -> float:
    """Return an estimated relative error of the linearised return map, which should preserve a shift in time."""
    shift = np.delete(rates(theory.disc_at(orbit.system.offset), orbit.state), ANGLE)
    change = orbit.monodromy @ shift - shift
    # The shift is one of len(shift) directions.
    return math.sqrt(len(shift)) * float(np.linalg.norm(change) / np.linalg.norm(shift))


@STUDY.claim(
    "Motions end modulated at small offsets, as a steady whirl at larger offsets, and at rest beyond",
    equation="(19)–(21)",
    note=f"In the last {LOOKED_AT:g} of {ENDS_UNTIL:g} s, the spin averaged over a "
    f"turn oscillates by more than {SWING:g} rad/s, or the radius by more than "
    f"{ORBITS_EXTENT:g} m. Predicted: from the critical X0, and from the X0 at which an eigenvalue of "
    "the self-centred equilibrium crosses zero.",
    basis="reference",
    swept=("offset",),
)
def ends(engine: Engine, offsets: Sequence[float] = OFFSETS) -> Measured:
    critical, _ = critical_of(engine)
    predicted = [2 if offset < critical else 1 if offset < theory.rest_offset() else 0 for offset in offsets]
    extents: dict[float, list[list[float]]] = {}

    def as_predicted(tolerance: float) -> list[bool]:
        found = [end_of(engine, offset, tolerance=tolerance) for offset in offsets]
        extents[tolerance] = [extent for extent, _ in found]
        return [kind == KINDS[expected] for (_, kind), expected in zip(found, predicted, strict=True)]

    return answers_of(
        *asked(as_predicted, ENDS_TOLERANCE),
        note=f"{', '.join(KINDS[kind] for kind in predicted)} for {at_each('X0', offsets)} m; the "
        "last one is that of the other figures.",
        data={"offsets": offsets, "extents": extents[ENDS_TOLERANCE]},
    )


def end_of(
    engine: Engine, offset: float, start: tuple[float, ...] = START, tolerance: float = ENDS_TOLERANCE
) -> tuple[list[float], str]:
    """Return smallest and largest final radius (m) and spin (rad/s), and the kind, one of ``KINDS``."""
    turn = theory.SAMPLES_A_TURN
    step = 2.0 * math.pi / RING.natural_frequency / turn
    times, last = np.arange(0.0, ENDS_UNTIL, step), round(LOOKED_AT / step)
    run = engine.simulate(theory.disc_at(offset), start, times, tolerance=tolerance)
    found = theory.extents(run, last)
    swing = np.ptp(np.convolve(run.states[:, 5], np.full(turn, 1.0 / turn), "valid")[-last:])
    kind = "modulated" if swing > SWING else "whirl" if found[1] - found[0] > ORBITS_EXTENT else "rest"
    return found, kind


# --- The modulated motion on six points, where single points rest

NOTE = f"Within {ROUND[-1]:g} s. Predicted: the reference at 1e-11."


@STUDY.claim(
    "Single points of six, about which the disc then turns, come to rest at the times of the reference",
    equation="(19)–(21)",
    kind="trajectory",
    unit="s",
    resolution=1e-2,
    note=f"{NOTE} A missing or additional rest makes all numbers missing.",
)
def points_rest(engine: Engine) -> Measured:
    if isinstance(_run(engine, OF_RESTS), StatesOnly):
        raise DeclaredLackError(f"{engine.name} does not report when single points rest")
    predicted = rests_of_points(_reference())

    def rests(tolerance: float) -> FloatArray:
        found = rests_of_points(_run(engine, tolerance))
        return found if len(found) == len(predicted) else np.full(len(predicted), np.nan)

    found = refined(rests, OF_RESTS)

    def data() -> dict[str, FloatArray]:
        longer = engine.simulate(SIX, START, theory.TIMES, tolerance=OF_RESTS)
        return {"six points": longer.states, "six points: rests": rests_of_points(longer)}

    numbers = range(1, len(predicted) // 2 + 1)
    return compared(
        predicted,
        found,
        error=float(np.max(known(found.value, found.error))),
        components=[f"{what} of rest {i}" for i in numbers for what in ("start", "end")],
        system=SIX,
        data=data,
    )


@STUDY.claim(
    "Within 300 s, the motion on six points has the smallest and largest radius and spin of the reference",
    equation="(19)–(21)",
    kind="trajectory",
    unit="m, rad/s",
    resolution=1e-5,
    note=NOTE,
)
def extremes_on_six_points(engine: Engine) -> Measured:
    exact, read = theory.extremes_of(_reference())
    found = refined(
        lambda tolerance: theory.extremes_of(_run(engine, tolerance)).value, OF_RESTS, alike=False
    )
    error = found.largest + 2.0 * read
    return compared(exact, found, error=error, components=theory.EXTREMES, system=SIX)


def rests_of_points(trajectory: Trajectory) -> FloatArray:
    """Return start and end (s) of each rest of a single point, in order of time, shape (2·rests,)."""
    return np.ravel([(phase.start, phase.end) for phase in trajectory.phases if phase.kind == "pivot"])


@functools.lru_cache(maxsize=4)
def _run(engine: Engine, tolerance: float) -> Trajectory:
    return engine.simulate(SIX, START, ROUND, tolerance=tolerance)


@functools.cache
def _reference() -> Trajectory:
    return simulate(SIX, START, ROUND, tolerance=1e-11)


# --- Without an engine


@STUDY.claim(
    "Shooting finds the modulated cycle that integration approaches, periodic up to a rotation",
    equation="(19)–(21)",
    kind="trajectory",
    unit="s, rad, m, rad/s",
    resolution=1e-3,
    note="Error: the change at a smaller tolerance, and the change from the previous modulation in the integrated "
    "motion.",
)
def shooting() -> Measured:
    predicted, error = theory.predicted_modulation()
    guess = simulate(RING, START, theory.TIMES, tolerance=1e-7)

    def cycle(tolerance: float) -> FloatArray:
        orbit = modulated_cycle(RING, guess, tolerance=tolerance, samples=len(ROUND))
        return np.array([orbit.period, orbit.turn, *theory.extremes_of(orbit.trajectory).value])

    found = refined(cycle, 100 * WORKING, alike=False).plus(error)
    components = ("period in s", "turn in rad", *theory.EXTREMES)
    return compared(predicted, found, components=components, source=theory.CENTRED)


@STUDY.claim(
    "The whirl is unstable on the continuous ring and on six points, but stable by (23)",
    equation="(19)–(23)",
    note="The simplified equations would therefore not have shown the modulated cycle.",
    basis="reference",
    swept=("contact_points",),
)
def unstable() -> Measured:
    found = theory.whirls_by_law()
    return answers_of(
        np.array((1.0, 1.0, -1.0)) * [whirl.eigenvalue.real for whirl in found],
        source=theory.CENTRED,
        note="Sign of the largest real part, in this order: "
        + ", ".join(f"{whirl.eigenvalue:.5f}" for whirl in found)
        + " 1/s.",
    )


@STUDY.claim(
    "By (23), a small deviation from the whirl decays as its linearisation predicts",
    equation="(23)",
    unit="1/s",
    note=f"Simulated with the reference. {GROWTH_NOTE}",
    basis="reference",
)
def dies_out_by_23() -> Measured:
    exact = theory.steady_whirl(RING, theory.EXPANSION).eigenvalue
    by_23 = Engine("reference by (23)", functools.partial(simulate, contact=theory.EXPANSION), ("ring",))
    return compared(
        (exact.real, exact.imag),
        growth(by_23, RING, theory.EXPANSION),
        resolution=5e-3 * abs(exact),
        components=("rate", "frequency"),
        parameters={"contact_points": "continuous ring by (23)"},
        source=theory.CENTRED,
    )


@STUDY.claim(
    "Just above the critical X0, the steady whirl and the modulated motion are both stable",
    equation="(19)–(21)",
    note="Does the pair of multipliers lie inside the unit circle, and does the spin still oscillate by more "
    f"than {SWING:g} rad/s after {ENDS_UNTIL:g} s?",
    basis="reference",
)
def both_stable() -> Measured:
    orbit = whirl_orbit(theory.disc_at(theory.BOTH_STABLE), tolerance=WORKING)

    def modulated(tolerance: float) -> bool:
        return end_of(reference, theory.BOTH_STABLE, MODULATED_THERE, tolerance)[1] == "modulated"

    margin, error = asked(modulated, ENDS_TOLERANCE)
    return answers_of(
        (1.0 - theory.pair_modulus(orbit.multipliers), float(margin)),
        (error_of_monodromy(orbit), float(error)),
        system=orbit.system,
        source=f"{SOURCE}; start {MODULATED_THERE}",
    )
