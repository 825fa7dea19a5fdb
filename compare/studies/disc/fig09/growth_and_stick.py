"""Claims on growing deviations, on stick, on six contact points, and without an engine."""

import functools
import itertools
import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

import compare.studies.disc.fig09.theory as theory
from compare.claims import COARSENING, ROUNDING, TIGHTEST, Measured, Measurement, refined
from compare.claims.error_estimates import extrapolated_order
from compare.claims.linearised_flow import real_and_imaginary, rotated
from compare.claims.measured import answers_of, asked
from compare.engines import Engine, reference
from compare.studies.disc.fig09.steady_motions import means, steady_motions
from compare.studies.disc.fig09.theory import STUDY, last_stable_load, weak_damping_load
from compare.studies.toolkit.deviations import PARTS
from compare.studies.toolkit.measuring import compared
from compare.studies.toolkit.pins import first_release
from compare.studies.toolkit.steady_motion import mode_growth, with_load
from reference_model import Trajectory, smallest_load_with_whirl
from reference_model.formulas.disc import whirl_at
from reference_model.steady.steady_states import SpinningEquilibrium, SpinningWhirl
from reference_model.systems import DiscOnDisc, FloatArray

# --- Small deviations from equilibrium and whirl

FOLLOWED = (
    f"Half the difference of two simulations that start {theory.DISPLACED:g} of the distance from the axis to either "
    "side. Error: the change at a smaller tolerance, and with twice the deviation, which is three times the "
    "nonlinear part."
)


@STUDY.claim(
    "Small deviations from the equilibrium decay at a small μN and grow at larger ones, as its eigenvalues predict",
    equation="(19), (20)",
    unit="1/s",
    resolution=1e-6,
    note=f"Over {', '.join(f'{duration:g}' for _, duration in theory.GROWTHS)} s. According to the paper, "
    f"this equilibrium is stable at every speed; only the equilibrium of the pin is. The friction of a "
    f"ring grows with its slip. "
    f"If ω > k, friction drives the disc around by more than β damps. {FOLLOWED}",
    basis="reference",
    swept=("friction_force",),
)
def deviations_grow(engine: Engine) -> Measured:
    aside = theory.DISPLACED * theory.RING.offset * np.eye(6)[0]
    loads, durations = zip(*theory.GROWTHS, strict=True)
    rests, discs = map(theory.rest_of, loads), [with_load(theory.RING, load) for load in loads]
    motions = [*zip(discs, rests, [aside] * len(discs), durations, strict=True)]
    return compared(
        real_and_imaginary([rest.eigenvalues[0] for _, rest, *_ in motions]),
        _growth(engine, motions),
        at={"μN in N": loads},
        components=PARTS,
    )


@STUDY.claim(
    "A disc near the whirl approaches it at the rate of the slowest eigenvalue",
    equation="(19), (20)",
    unit="1/s",
    resolution=1e-6,
    note=f"Over {theory.DECAY[1]:g} s. X0 = 0 here. {FOLLOWED}",
    basis="reference",
    swept=("friction_force",),
)
def whirl_attracts(engine: Engine) -> Measured:
    load, duration = theory.DECAY
    circle = theory.circle_of(load, 0)
    larger = theory.DISPLACED * np.array([1.0, 0.0, 0.0, 0.0, 1.0, 0.0]) * circle.state
    return compared(
        real_and_imaginary([circle.eigenvalues[1]]),  # the first belongs to rotation about the axis
        _growth(engine, [(with_load(theory.CENTRED, load), circle, larger, duration)]),
        at={"μN in N": [load]},
        components=PARTS,
        system=theory.CENTRED,
    )


def _growth(
    engine: Engine,
    motions: Sequence[tuple[DiscOnDisc, SpinningEquilibrium | SpinningWhirl, FloatArray, float]],
) -> Measurement:
    """Return growth rate and frequency (1/s) of small deviations, shape (n, 2).

    ``motions`` contains disc, steady motion, displacement and duration (s).
    """

    def rates(tolerance: float, scale: float = 1.0) -> FloatArray:
        found = [
            mode_growth(engine, disc, motion, scale * displacement, duration, tolerance)
            for disc, motion, displacement, duration in motions
        ]
        return real_and_imaginary(found)

    found = refined(rates, theory.ORBIT_TOLERANCE)
    # Flows that agree to within the tolerance may hide such an error.
    unseen = [[theory.ORBIT_TOLERANCE / (theory.DISPLACED * duration)] for *_, duration in motions]
    with_larger = found.plus(np.abs(rates(theory.ORBIT_TOLERANCE, 2.0) - found.value))
    return Measurement(found.value, with_larger.rows + unseen)


# --- Sticking discs

REVOLUTION = 2.0 * math.pi / theory.RING.disc_speed  # period in s of the force on a sticking disc


@STUDY.claim(
    "A disc stuck at 0.98 of the radius (9) turns with the master disc permanently",
    equation="(9)",
    resolution=1e-2,
    note="After one revolution: displacement on the master disc relative to the radius, turn relative to the "
    "master disc in rad, relative spin over ω, and the number of slip phases. The holding force has the "
    "period of a "
    "revolution. Equation (9) uses the force that remains after the moment b(ω − Ω). Error: the change at a "
    "smaller tolerance, which reveals the creep of a law that only approximates stick.",
    basis="reference",
    swept=("friction_force",),
)
def sticks(engine: Engine, loads: Sequence[float] = theory.STICK_LOADS) -> Measured:
    discs = [with_load(theory.RING, load) for load in loads]
    starts = [theory.stuck_at(disc, theory.INSIDE)[0] for disc in discs]

    @functools.cache
    def runs(tolerance: float) -> list[Trajectory]:
        motions = [(disc, start, [0.0, REVOLUTION]) for disc, start in zip(discs, starts, strict=True)]
        return engine.simulate_many(motions, tolerance=tolerance)

    def departures(tolerance: float) -> FloatArray:
        rows = []
        for run, start in zip(runs(tolerance), starts, strict=True):
            away = rotated(run.at_end, -2.0 * math.pi) - start
            size = float(np.hypot(*start[:2]))
            rows.append((*away[:3] / (size, size, 1.0), away[-1] / theory.RING.disc_speed))
        return np.array(rows)

    def slips(tolerance: float) -> float:
        return float(sum(phase.kind != "stick" for run in runs(tolerance) for phase in run.phases))

    found = refined(departures, theory.TOLERANCE)
    change = abs(slips(theory.TOLERANCE / COARSENING) - slips(theory.TOLERANCE))
    parts = ("x", "y", "turn", "spin")
    return Measured(
        predicted=np.zeros(found.value.size + 1),
        value=np.append(found.value.ravel(), slips(theory.TOLERANCE)),
        # Zero departures give no scale for the rounding error.
        error=np.append(found.largest + ROUNDING + np.zeros(found.value.size), change),
        components=[*(f"{part} at μN = {load:g} N" for load in loads for part in parts), "slip phases"],
        data={
            "stick load": loads,
            "stuck": [(run.radius[-1], run.at_end[-1]) for run in runs(theory.TOLERANCE)],
        },
    )


@STUDY.claim(
    "A disc stuck at 1.02 and at 1.5 of the radius (9) is released at the time of (7)",
    equation="(7)",
    unit="rad",
    resolution=1e-2,
    note="Turn of the master disc until the end of the first stick phase, from a start where the holding force is "
    "smallest. Equation (7) uses the force that remains after the moment b(ω − Ω).",
    basis="reference",
    swept=("friction_force",),
)
def releases(engine: Engine, loads: Sequence[float] = theory.STICK_LOADS) -> Measured:
    predicted, motions = [], []
    for load, share in itertools.product(loads, theory.OUTSIDE):
        disc = with_load(theory.RING, load)
        start, release = theory.stuck_at(disc, share)
        predicted.append(disc.disc_speed * release)
        motions.append((disc, start, [0.0, theory.LATEST * release]))

    def turns(tolerance: float) -> list[float]:
        runs = engine.simulate_many(motions, tolerance=tolerance)
        return [run.system.disc_speed * first_release(run) for run in runs]

    found = refined(turns, theory.TOLERANCE)
    cases = itertools.product(loads, theory.OUTSIDE)
    return compared(
        predicted,
        found,
        error=found.largest + ROUNDING,
        components=[f"μN = {load:g} N, {share:g} of the radius" for load, share in cases],
    )


@STUDY.claim(
    "Permanent stick and a whirl without stick exist at the same parameters",
    equation="(9), (11)",
    note="Does a start stuck at half the radius (9) stick for a whole turn, and does a start on the whirl slide for "
    "ten whole turns?",
)
def coexist(engine: Engine) -> Measured:
    load = theory.STICK_LOADS[-1]
    disc, orbit = with_load(theory.RING, load), theory.orbit_of_reference(load, 0)
    motions = [
        (disc, theory.stuck_at(disc, 0.5)[0], [0.0, REVOLUTION]),
        (orbit.system, orbit.state, [0.0, 10.0 * orbit.period]),
    ]

    def sticks_and_slides(tolerance: float) -> list[bool]:
        runs = zip(engine.simulate_many(motions, tolerance=tolerance), ("stick", "slip"), strict=True)
        return [all(phase.kind == kind for phase in run.phases) for run, kind in runs]

    return answers_of(*asked(sticks_and_slides, theory.TOLERANCE), system=orbit.system)


# --- The disc on six points, as in the paper's simulations

SIX = replace(theory.RING, contact_points=6)

BY_REFERENCE = f"Predicted by the reference at tolerance {TIGHTEST:g}."


@STUDY.claim(
    "On six points, the mean whirl without offset equals that of exact Coulomb friction",
    equation="(19)–(21)",
    kind="trajectory",
    resolution=1e-6,
    note=f"Relative to μN/(βk), k and ω; means over the motion that repeats up to a rotation. {BY_REFERENCE}",
    swept=("friction_force",),
)
def six_circles(engine: Engine, circles: tuple[tuple[float, int], ...] = theory.CIRCLES) -> Measured:
    found = steady_motions(engine, circles, 6)
    predicted = np.array([_of_reference(*one) for one in circles])
    on_ring = [theory.circle_of(*one).radius / theory.radius_of_pin(one[0]) for one in circles]
    beside = np.abs(predicted[:, 0] - on_ring)
    loads = [load for load, _ in circles]
    return compared(
        predicted,
        found,
        at={"μN in N": loads},
        components=("radius", "frequency", "spin"),
        system=replace(theory.CENTRED, contact_points=6),
        source=theory.SOURCE_CENTRED,
        note=f"Its radius differs from that on the ring by {np.max(beside):.1g} near the fold, and by less than "
        "1e-9 from 0.001 N on, where all points slip along the circle.",
        data={"six circle load": loads, "six circle": found.value},
    )


@functools.cache
def _of_reference(load: float, which: int | None) -> tuple[float, ...]:
    return tuple(means(reference, load, which, 6, TIGHTEST))


@STUDY.claim(
    "On six points, the mean position and spin of the self-centred disc equal those of exact Coulomb friction",
    equation="(19)–(21)",
    kind="trajectory",
    resolution=1e-7,
    note="Means relative to X0 and ω over the motion that repeats after a sixth of a turn. " + BY_REFERENCE,
    swept=("friction_force",),
)
def six_rests(engine: Engine, loads: Sequence[float] = theory.REST_LOADS) -> Measured:
    found = steady_motions(engine, tuple((load, None) for load in loads), 6)
    return compared(
        [_of_reference(load, None) for load in loads],
        found,
        at={"μN in N": loads},
        components=("x", "y", "spin"),
        system=SIX,
        data={"rest load": loads, "six rest": found.value},
    )


@STUDY.claim(
    "A disc on six points that is stuck beyond the radius (9) slips away as under exact Coulomb friction",
    equation="(7)",
    kind="trajectory",
    resolution=2e-3,
    note=f"Starts at {theory.OUTSIDE[-1]:g} times the radius (9). Displacement on the master disc relative to the "
    "radius, and (spin − ω)/ω, after 1.5 times the release time (7) of the continuous ring. "
    f"{BY_REFERENCE}",
    swept=("friction_force",),
)
def six_releases(engine: Engine, loads: Sequence[float] = theory.STICK_LOADS) -> Measured:
    found = refined(lambda tolerance: [_slipped(engine, load, tolerance) for load in loads], theory.TOLERANCE)
    predicted = [_slipped_in_reference(load) for load in loads]
    return compared(
        predicted,
        found,
        error=found.rows,
        at={"μN in N": loads},
        components=("x", "y", "spin"),
        system=SIX,
        note=f"By then the disc has slipped by {', '.join(f'{math.hypot(*one[:2]):.2g}' for one in predicted)} of "
        "the radius.",
    )


def _slipped(engine: Engine, load: float, tolerance: float) -> FloatArray:
    disc = with_load(SIX, load)
    start, release = theory.stuck_at(disc, theory.OUTSIDE[-1])
    end = 1.5 * release
    run = engine.simulate(disc, start, [0.0, end], tolerance=tolerance)
    away = rotated(run.at_end, -disc.disc_speed * end) - start
    return np.array([*away[:2] / np.hypot(*start[:2]), away[-1] / disc.disc_speed])


@functools.cache
def _slipped_in_reference(load: float) -> tuple[float, ...]:
    return tuple(_slipped(reference, load, TIGHTEST))


# --- Ends of whirl and equilibrium without an engine


@STUDY.claim(
    "Without offset, the whirl ends in a fold: at its smallest friction force, one of its eigenvalues passes zero",
    equation="(20), (23)",
    unit="N",
    note="Predicted: the minimum of μN over the ratio of the slip speeds of rim and centre. Measured: μN "
    "where the eigenvalue is zero, to 1e-6 of that ratio; μN is stationary there.",
    swept=("friction_force",),
)
def fold() -> Measured:
    laws = (None, theory.PAPER_LAW)
    measured = [whirl_at(theory.CENTRED, theory.marginal_ratio(law), law).load for law in laws]
    return Measured(
        predicted=[smallest_load_with_whirl(theory.CENTRED, law) for law in laws],
        value=measured,
        error=1e-12 * max(measured),
        resolution=1e-9 * max(measured),
        components=("continuous ring", "(23)"),
        system=theory.CENTRED,
    )


@STUDY.claim(
    "As β → 0, the equilibrium loses its stability where friction excites a circular motion as much as β damps it",
    resolution=0.05,
    note=f"Order in β of the error, for β = {', '.join(f'{damping:g}' for damping in theory.DAMPINGS)} N s/m, "
    "extrapolated. This is not in the paper, which states that the equilibrium is stable.",
    swept=("friction_force", "damping"),
)
def weak_damping() -> Measured:
    discs = [replace(theory.RING, damping=float(damping)) for damping in theory.DAMPINGS]
    errors = np.array([abs(weak_damping_load(one) / last_stable_load(one) - 1.0) for one in discs])
    order, numerical, model = extrapolated_order(errors, 1e-12)
    return Measured(
        predicted=1.0,
        value=order,
        error=numerical,
        model=model,
        source=f"{theory.SOURCE}; the decreasing β are our choice",
        note=f"For the β of Fig. 9, it loses its stability at {last_stable_load(theory.RING):.6f} N, or at "
        f"{weak_damping_load(theory.RING):.6f} N by this formula, far below C·X0, where stick begins.",
    )


@STUDY.claim(
    "The inner, unstable whirl shrinks onto the equilibrium where the equilibrium loses its stability",
    unit="N",
    note="This is not in the paper. Predicted: the zero of the real part of an eigenvalue of the equilibrium. "
    "Measured: μN of the reference's inner whirls by shooting, as a polynomial in the square of their size (root "
    "of the mean square distance from the centre), at zero. Model error: the change with one orbit less. The "
    "basin of the equilibrium therefore shrinks to nothing there.",
    basis="reference",
    named={"last stable load": 0},
    swept=("friction_force",),
)
def merges() -> Measured:
    load = np.array([orbit.system.friction_force for orbit in theory.orbits()])
    square = np.array([np.var(orbit.trajectory.states[:-1, :2], axis=0).sum() for orbit in theory.orbits()])
    near, far = (float(np.polyfit(square[-n:], load[-n:], n - 1)[-1]) for n in (4, 3))
    return Measured(
        predicted=last_stable_load(theory.RING),
        value=near,
        error=1e-9 * near,
        model=abs(near - far),
        resolution=0.01 * near,
        note=f"Sizes: {math.sqrt(square[-4]):.2g} to {math.sqrt(square[-1]):.2g} m.",
    )
