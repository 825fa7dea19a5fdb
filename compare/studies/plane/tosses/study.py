"""Claims on the measured slides and on engines that repeat them, and the validation."""

import math
from collections.abc import Iterable
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

import compare.studies.plane.tosses.theory as theory
from compare.claims import Measured, Measurement, Study, answers_of, refined
from compare.claims.prose import Table
from compare.claims.validation import Validation
from compare.engines import USUAL_TOLERANCE, DeclaredLackError, Engine
from compare.foreign import recordings
from compare.studies.plane.tosses.theory import LOADS, SLOWEST, SPEEDS, Slides, box_turn, measured, share_of
from compare.studies.toolkit.free_bodies import on_a_table
from compare.studies.toolkit.measuring import recorded_cells
from compare.studies.toolkit.random_systems import state_of
from compare.studies.toolkit.uncertainties import Uncertainties, validation_of
from reference_model import Points, simulate
from reference_model.systems import DiscOnDisc, FloatArray
from reference_model.trajectory import Trajectory

SOURCE = "measurements of S. Pfrommer, M. Halm and M. Posa (2020), see slides.csv in the folder of this study"

STUDY = Study.beside(__file__, "tosses", source=SOURCE, seconds=4.0, contact=True)

SIGMAS = 2.0
"""Numbers of standard errors of a mean that a claim allows, and that exclude a load."""

EXCLUDED = 3.0

INERTIA = 0.06
"""Relative systematic error of the inertia.

Simulated bounces that last 3 to 6 ms yield an inertia that is 3 to 6 % too small.
"""

CORNERS = LOADS["four corners"]

LAWS = {"box": 0.0, "pyramid": 0.25 * math.pi}
"""Rotation (rad) of the friction polygon."""

OTHERS = ("rim", "even pressure")


def laws_in(slides: Slides) -> FloatArray:
    """Return the share of the turns by each law in the turns of ``slides``, and its standard error, shape (2, 2)."""
    return np.array([share_of(slides["turn_deg"], box_turn(slides, turned)) for turned in LAWS.values()]).T


def spins_left(spins: FloatArray, first: FloatArray) -> FloatArray:
    """Return the share of the first spin that is left at each speed and its standard error, shape (2, 5)."""
    return np.array([share_of(at_speed, first) for at_speed in spins.T]).T


@STUDY.claim(
    "The measured paths do not turn as friction within a box or a pyramid would turn them",
    resolution=0.05,
    basis="independent",
    friction=False,
    note="Factor c of turn ≈ c·(turn by the law) for both laws in the axes of the records, which have any heading. "
    "Error: two standard errors, from the scatter of the slides.",
)
def straight() -> Measured:
    found, errors = laws_in(measured())
    return Measured(
        predicted=np.zeros(2), value=found, error=SIGMAS * errors, size=1.0, at={"law": list(LAWS)}
    )


@STUDY.claim(
    "The measured deceleration does not depend on the heading of the cube",
    resolution=0.02,
    basis="independent",
    friction=False,
    note="Amplitudes of the fourth harmonic of μ in the angle between path and cube, relative to the mean; a box in "
    "the axes of the cube has 0.18. Error: two standard errors, from the scatter of the slides.",
)
def isotropic() -> Measured:
    slides = measured()
    relative = slides["mu"] / np.mean(slides["mu"]) - 1.0
    harmonics = [wave(4.0 * slides["axis"]) for wave in (np.cos, np.sin)]
    found, errors = np.transpose([share_of(relative, wave) for wave in harmonics])
    return Measured(
        predicted=np.zeros(2), value=found, error=SIGMAS * errors, size=1.0, at={"wave": ["cos", "sin"]}
    )


@STUDY.claim(
    "With the inertia from bounces, the measured spin falls with the speed as if four corners carried the load",
    resolution=0.15,
    basis="independent",
    friction=False,
    note="Share of the first spin that is left, by least squares over all slides. Predicted from the inertia and the "
    "corners that bounces yield; another inertia needs another load. The load was chosen among three; both halves "
    "of the slides confirm it. Error: two standard errors of the scatter, and the effect of 6 % of the inertia.",
)
def spin() -> Measured:
    halves = [measured().where(measured()["toss"] % 2 == half) for half in (0, 1)]
    found, errors = np.array([spins_left(each["spins"], each["spin_first"]) for each in halves]).swapaxes(
        0, 1
    )
    predicted, heavier = (
        np.array([left_by("four corners", measured().reach / math.sqrt(factor), half) for half in halves])
        for factor in (1.0, 1.0 + INERTIA)
    )
    errors = SIGMAS * errors + np.abs(heavier - predicted)
    at = {"half": ["even tosses", "odd tosses"], "v in m/s": SPEEDS}
    return Measured(predicted=predicted, value=found, error=errors, at=at)


@cache
def left_by(load: str, half_side: float, of: Slides | None = None) -> FloatArray:
    """Return the predicted share of the spin that a load leaves, shape (5,), for these or for all slides."""
    slides = of or measured()
    share, _ = spins_left(theory.predicted(slides, LOADS[load], half_side).spins, slides["spin_first"])
    return np.asarray(share)


def loads_on_the_face() -> dict[str, FloatArray]:
    return {load: left_by(load, measured().reach) for load in LOADS}


@STUDY.claim(
    "With the inertia from bounces, the spin excludes an even pressure and a load along the rim of the flat face",
    basis="independent",
    friction=False,
    note="Is the predicted share of the spin more than three standard errors from the measured one, even if the "
    "inertia is 6 % smaller? For each load on the flat face within the rounded edges, at five speeds.",
)
def excluded() -> Measured:
    share, error = spins_left(measured()["spins"], measured()["spin_first"])
    reach = measured().reach * math.sqrt(1.0 + INERTIA)
    margins = [np.abs(left_by(load, reach) - share) - EXCLUDED * error for load in OTHERS]
    return answers_of(np.ravel(margins))


@STUDY.claim(
    "To first order in the spin, the slip direction turns at −μ²gLω/v², whatever the distribution of the load",
    resolution=1e-6,
    note="Friction across the path over μ²mgLω/v, for a spin of 10⁻⁴·v/L. Model error: its square.",
)
def curls() -> Measured:
    shift, spin = np.array([0.2 * theory.HALF_SIDE]), np.array([1e-4 / theory.HALF_SIDE])
    found = [
        theory.friction(theory.HALF_SIDE * load.places[None], load.shares, np.ones(1, complex), spin, shift)[
            0
        ].imag
        / (shift * spin)
        for load in LOADS.values()
    ]
    return Measured(
        predicted=-np.ones((len(LOADS), 1)), value=found, error=1e-10, model=1e-7, at={"load": list(LOADS)}
    )


# --- Engines

FEWER = 24
"""Number of simulated slides; the slides with the fastest spin are simulated."""

TOLERANCE = 1e-6
"""Tolerance of engines with error control, whose errors are far below the measurement's."""


@cache
def fastest() -> Slides:
    slides = measured()
    return slides.where(np.argsort(-np.abs(slides["spin_first"]))[:FEWER])


def friction() -> float:
    """Return μ of the slides with little spin, which are not simulated."""
    slides = measured()
    return float(np.mean(slides["mu"][np.abs(slides["spin_first"]) < 0.5]))


def cube(slides: Slides, i: int, mu: float) -> tuple[DiscOnDisc, FloatArray, FloatArray]:
    """Return a disc on four corners in place of the cube, its first state, and times (s)."""
    radius, speed = math.sqrt(2.0) * slides.reach, slides["speed_first"][i]
    inertia = float(slides["gyration"][i]) / radius**2
    disc = on_a_table(theory.MASS, inertia, radius, mu * theory.MASS * theory.GRAVITY, points=4)
    slip = slides["slip"][i]
    start = state_of(0j, speed * np.exp(1j * slip), spin=slides["spin_first"][i])
    start[2] = slip + slides["axis"][i] + 0.25 * math.pi
    # Half of the friction brings the cube to the last speed within twice the time.
    times = np.append(np.linspace(0.0, 1.1, 40), np.linspace(1.2, 2.2, 11))
    return disc, start, speed / mu / theory.GRAVITY * times


def seen(run: Trajectory) -> FloatArray:
    """Return turn (degrees), μ, μ below over μ above 0.24 m/s, and the spins at ``SPEEDS``."""
    velocities, spins = run.states[:, 3] + 1j * run.states[:, 4], run.states[:, 5]
    turn, at_speeds = theory.seen_at(velocities, spins)
    speeds = np.abs(velocities)
    first, middle, last = np.interp([-speeds[0], -0.24, -SLOWEST], -speeds, run.times, right=np.nan)
    mu, fast = ((speeds[0] - to) / (until - first) for to, until in ((SLOWEST, last), (0.24, middle)))
    slow = (0.24 - SLOWEST) / (last - middle)
    return np.array([turn, mu / theory.GRAVITY, slow / fast, *at_speeds])


@cache
def slid(engine: Engine) -> Measurement:
    """Return the shares of box and pyramid in the turns, mean μ, mean ratio of μ, and the spins left, shape (9,)."""
    slides = fastest()
    motions = [cube(slides, i, friction()) for i in range(FEWER)]

    def numbers(tolerance: float) -> FloatArray:
        found = np.array([seen(run) for run in engine.simulate_many(motions, tolerance=tolerance)])
        shares = [share_of(found[:, 0], box_turn(slides, turned))[0] for turned in LAWS.values()]
        return np.array(
            [*shares, *np.mean(found[:, 1:3], axis=0), *spins_left(found[:, 3:], slides["spin_first"])[0]]
        )

    return refined(numbers, TOLERANCE if engine.step is None else USUAL_TOLERANCE)


@STUDY.claim(
    "A sliding cube turns by no more than the measured share of a box or a pyramid",
    kind="trajectory",
    basis="independent",
    resolution=0.1,
    friction=False,
    note="Measured like the claim on the measured paths, for the 24 slides with the fastest spin. Error: two "
    "standard errors of the measurement for 24 slides.",
)
def turns(engine: Engine) -> Measured:
    share, error = laws_in(measured()) * [[1.0], [SIGMAS * math.sqrt(len(measured()["toss"]) / FEWER)]]
    return of_engine(engine, slice(0, 2), share, error, {"law": list(LAWS)})


def of_engine(
    engine: Engine, numbers: slice, predicted: FloatArray, error: FloatArray, at: dict[str, Any]
) -> Measured:
    """Compare ``numbers`` of the engine with measured numbers and their ``error``."""
    found, errors = (each[numbers] for each in slid(engine))
    return Measured(predicted=predicted, value=found, error=error + errors, size=1.0, at=at)


@STUDY.claim(
    "A sliding cube decelerates as measured, up to the measured change of friction with speed",
    kind="trajectory",
    basis="independent",
    resolution=0.1,
    note="Mean μ of slides with a fast spin, for μ of slides with little spin; and μ below over μ above 0.24 m/s, "
    "which is 0.93. Error: two standard errors, and for the second number its distance from 1, because Coulomb's law "
    "has no such change.",
)
def decelerates(engine: Engine) -> Measured:
    slides, whole = fastest(), measured()
    rows = np.array([slides["mu"], slides["mu_slow"] / slides["mu_fast"]])
    change = np.array([0.0, 1.0 - np.mean(whole["mu_slow"] / whole["mu_fast"])])
    error = SIGMAS * rows.std(axis=1) / math.sqrt(FEWER) + change
    return of_engine(engine, slice(2, 4), rows.mean(axis=1), error, {"number": ["mean μ", "ratio of μ"]})


@STUDY.claim(
    "The spin of a sliding cube on four corners falls as measured",
    kind="trajectory",
    basis="independent",
    resolution=0.1,
    friction=False,
    note="Share of the first spin that is left when the speed has fallen, for the 24 slides with the fastest spin. "
    "The corners share the load equally. Error: two standard errors of the measurement.",
)
def spins(engine: Engine) -> Measured:
    share, error = spins_left(fastest()["spins"], fastest()["spin_first"])
    found = of_engine(engine, slice(4, None), share, SIGMAS * error, {"v in m/s": SPEEDS})
    return replace(found, data={"spins left": found.value})


SEGMENTS = 16
"""Coarser number of intervals of a slide with constant loads."""


@STUDY.claim(
    "If the load follows the deceleration, the path of a cube curls and its spin falls as predicted",
    kind="trajectory",
    unit="degrees, rad/s",
    resolution=0.1,
    note="Turn of the path, and spin at 0.2 m/s. The loads are constant in intervals of the simulation, and the "
    "result is extrapolated from two lengths of them. Predicted by Runge-Kutta steps of this study.",
)
def under_load(engine: Engine) -> Measured:
    if engine.name != "reference":
        raise DeclaredLackError(f"{engine.name} has no points with any share of the load")
    slides = fastest().where(np.array([0, FEWER // 2]))
    coarse, fine = (
        np.array([followed(slides, i, parts) for i in range(2)]) for parts in (SEGMENTS, 2 * SEGMENTS)
    )
    motion = theory.predicted(slides, CORNERS, slides.reach)
    return Measured(
        predicted=np.column_stack((motion.turn, motion.spins[:, SPEEDS.index(0.20)])),
        value=2.0 * fine - coarse,  # the error is of first order
        error=np.abs(fine - coarse),
        at={"toss": [f"{toss:.0f}" for toss in slides["toss"]]},
        components=("turn in degrees", "spin in rad/s"),
    )


def followed(slides: Slides, i: int, segments: int) -> FloatArray:
    """Return turn (degrees) and spin at 0.2 m/s in the reference, with loads that change between ``segments``."""
    mu = slides.of_constant("mean_mu")
    disc, state, _ = cube(slides, i, mu)
    state[2] -= 0.25 * math.pi
    places = slides.reach * CORNERS.places[None] - slides["offset"][i]
    until = (slides["speed_first"][i] - 0.25 * SLOWEST) / mu / theory.GRAVITY
    states = [state]
    for _ in range(segments):
        slip, spin = complex(*state[3:5]) * np.exp(-1j * state[2]), state[5]
        directions = theory.directions_of(places, np.array([slip]), np.array([spin]))
        loads = theory.loaded(places, CORNERS.shares, directions, mu * slides["height"][[i]])[0]
        points = Points([(p.real, p.imag, load) for p, load in zip(places[0].tolist(), loads, strict=True)])
        times = np.linspace(0.0, until / segments, 4)
        states.extend(simulate(disc, state, times, tolerance=TOLERANCE, contact=points).states[1:])
        state = states[-1]
    x, y, spins = np.array(states)[:, 3:].T
    turn, at_speeds = theory.seen_at(x + 1j * y, spins)
    return np.array([turn, at_speeds[SPEEDS.index(0.20)]])


# --- The validation


def validations() -> tuple[Validation, ...]:
    """Return the errors of the turn and of the spin at 0.2 m/s."""
    slides, none = measured(), np.zeros(len(measured()["toss"]))
    slope, error = (1e-3 * value for value in slides.constants["slope_mrad"])
    level, tilted = (theory.predicted(slides, CORNERS, slides.reach, slope=each) for each in (0.0, slope))
    heavier = theory.predicted(slides, CORNERS, slides.reach / math.sqrt(1.0 + INERTIA))
    at = SPEEDS.index(0.20)
    return (
        validation_of(
            np.abs(slides["turn_deg"] - tilted.turn),
            Uncertainties(slides["turn_error"], np.abs(tilted.turn - level.turn) * error / slope, none),
            "turn of the path of a sliding cube",
        ),
        validation_of(
            np.degrees(np.abs(slides["spins"] - level.spins)[:, at]),
            Uncertainties(
                *np.degrees([slides["spin_error"], np.abs(heavier.spins - level.spins)[:, at], none])
            ),
            "spin of a sliding cube at 0.2 m/s",
            "degrees/s",
        ),
    )


def tables() -> tuple[Table, ...]:
    share, error = spins_left(measured()["spins"], measured()["spin_first"])
    rows = {f"{load} of the flat face": left for load, left in loads_on_the_face().items()}
    rows |= {f"{load} of the whole side": left_by(load, theory.HALF_SIDE) for load in LOADS}
    text = "{:.3f} ({:+.1f})".format
    few = fastest()
    ratios = np.array([few["mu"], few["mu_slow"] / few["mu_fast"]])
    of_fastest = (laws_in(measured())[0], ratios.mean(axis=1), spins_left(few["spins"], few["spin_first"])[0])
    recorded = [
        (
            one.name,
            *recorded_cells(one, STUDY.name, list(RECORDED), lambda claim: _numbers(claim["measured"])),
        )
        for one in recordings()
        if STUDY.name in one.claims
    ]
    return (
        Table(
            "Share of the first spin that is left, and its distance from the measured one in standard errors.",
            ("load", *(f"at {speed:g} m/s" for speed in SPEEDS)),
            (
                ("measured", *map("{:.3f} ± {:.3f}".format, share, error)),
                *((name, *map(text, left, (left - share) / error)) for name, left in rows.items()),
            ),
        ),
        Table(
            "Recorded engines: verdict and numbers. Disc on four points, or a box of the engine "
            "(Rapier, Jolt, PhysX, Havok, cannon-es). Fixed steps are 0.5 and 0.18 ms.",
            ("Engine, setting", *RECORDED.values()),
            (("measured", *map(_numbers, of_fastest)), *recorded),
        ),
    )


RECORDED = {
    "turns": "share of a box and a pyramid in the turns",
    "decelerates": "mean μ, ratio of μ",
    "spins": f"spin left at {', '.join(f'{speed:.2f}' for speed in SPEEDS)} m/s",
}
"""Headings of the claims in the table of recorded engines."""


def _numbers(values: Iterable[float]) -> str:
    return ", ".join(f"{value:.2f}" for value in map(float, values))


STUDY.provides(tables=tables, validations=validations)
