"""What foreign engines make of the paper's systems, from data recorded with them: laws, orders, errors over time."""

from __future__ import annotations

import functools
import math

import numpy as np

from compare.accuracy import COARSENING, extrapolated_order, observed_exponent
from compare.claim import Claim, ErrorBudget
from compare.engines import Engine
from compare.foreign import COLUMNS, DIGITS, Recording, recordings
from compare.foreign.cases import CASES
from compare.studies.common import parameters_of
from compare.studies.foreign_engines_laws import Law, box, pyramid, whirl_error
from compare.studies.foreign_engines_pictures import draw
from compare.study import Data, Findings, Study, Table
from reference_model.systems import FloatArray

STEPS, ERROR, CHANGE, SECONDS = (COLUMNS.index(name) for name in ("steps", "error", "change", "seconds"))

OUR_FORCE = "our force"

FIRST_ORDER = (
    "MuJoCo, elliptic cone",
    "Bullet, cone",
    "Drake, TAMSI",
    "Drake, SAP",
    "Drake, lagged",
    "DART, NSGS",
    "DART, FBF",
    "Bullet, our force",
    "DART, our force",
)
"""Settings whose steps are of order 1 where contact slides, and whose friction is Coulomb's."""

BOXES, PYRAMIDS = ("Bullet, box", "DART, Dantzig", "DART, PGS"), ("MuJoCo, pyramidal cone",)

BY_AXIS = PYRAMIDS + BOXES
"""Settings whose friction knows two axes of the world instead of a direction."""

STICKING = (
    *(name for name in FIRST_ORDER if name not in ("Drake, SAP", "Drake, lagged")),
    "MuJoCo, elliptic cone, RK4",
    "MuJoCo, our force",
)
"""Settings with Coulomb friction and steps of a fixed length, that can be halved four times before errors grow."""

SLIDES = "Steps of order 1: the error of a sliding pin falls in proportion to the step"
STICKS = "The error of a pin that sticks falls in proportion to a fixed step, whatever its order where the pin slides"
DISC = "Steps of order 1: the error of a disc on six points falls in proportion to the step"
AXES = "A pyramid or a box in place of the cone is another law: the errors of pin and disc do not fall with the step"
BULLET = "Bullet's cone is another law for a disc: the error does not fall with the step"
BOX_WHIRL = "A pin whirls by Bullet's and DART's boxes as by friction for each axis of the world"
PYRAMID_WHIRL = "A pin whirls by MuJoCo's pyramid as by friction along the nearest axis of the world"

WANTED = 1e-3
"""Error in m, the time to which is listed: the largest that shows in no picture of the paper."""

HALVED = 0.02
"""How far the quotient of two numbers of steps may be from 2, as steps divide the interval between output times."""


@functools.cache
def recorded() -> tuple[Recording, ...]:
    """Return all recordings, read once."""
    return recordings()


def measure(engine: Engine) -> Findings:
    """Find nothing: all engines of this study were measured when they were recorded."""
    return Findings()


def halvings(runs: FloatArray) -> FloatArray:
    """Return those last of ``runs`` between which the step was halved each time, shape (m, columns)."""
    ratios = runs[1:, STEPS] / runs[:-1, STEPS]
    strange = np.nonzero(np.abs(ratios - 2.0) > HALVED)[0]
    # A ladder may end in a step that is the engine's smallest.
    if strange.size and strange[-1] == len(ratios) - 1:
        return halvings(runs[:-1])
    return runs[strange[-1] + 1 :] if strange.size else runs


def _claim(
    sentence: str,
    predicted: float,
    wanted: tuple[str, ...],
    cases: tuple[str, ...],
    *,
    scatters: bool = False,
) -> Claim:
    """Return the claim that errors of the ``wanted`` settings fall like step^``predicted`` in each of ``cases``.

    Errors scatter with where in a step the contact begins to stick.
    """
    by_name = {recording.name: recording for recording in recorded()}
    runs = {(name, case): halvings(by_name[name].runs[case]) for case in cases for name in wanted}
    if scatters:
        found = [
            observed_exponent(1.0 / rows[:, STEPS], rows[:, ERROR], next_term=1.0) for rows in runs.values()
        ]
        how = "by least squares with a term smaller by one step. Model error: what that term changes; numerical "
        how += "error: 95 % interval from the scatter."
    else:
        found = [extrapolated_order(rows[:, ERROR], 0.0) for rows in runs.values()]
        how = "extrapolated to 0. Model error: the extrapolation's own step; numerical error: its change from one "
        how += "step to the next."
    orders, numerical, model = np.transpose(found)
    words = ", ".join(
        f"{name} ({case}): {order:.3f}" for (name, case), order in zip(runs, orders, strict=True)
    )
    dates = " and ".join(sorted({by_name[name].recorded for name in wanted}))
    return Claim(
        sentence,
        equation="",
        kind="order",
        engine="theory",
        predicted=np.full(len(orders), predicted),
        measured=orders,
        budget=ErrorBudget(numerical, model=float(np.max(model)), resolution=0.5),
        parameters=parameters_of(CASES[cases[0]].system),
        source=f"Recorded on {dates}; " + "; ".join(f"{case}: {CASES[case].title}" for case in cases),
        note=f"Orders observed while the step is halved, {how} {words}.",
    )


def _claim_of_whirl(sentence: str, law: Law, wanted: tuple[str, ...]) -> Claim:
    """Return the claim that the ``wanted`` settings, of order 1, are as far off the radius of (11) as ``law``."""
    by_name = {recording.name: recording for recording in recorded()}
    errors = np.array([halvings(by_name[name].runs["whirl"])[-3:, ERROR] for name in wanted])
    extrapolated = 2.0 * errors[:, 1:] - errors[:, :-1]
    rounding = 0.5 * 10.0 ** (1 - DIGITS) * errors[:, -1]
    predicted, smoothing = whirl_error(law)
    return Claim(
        sentence,
        equation="(11)",
        kind="trajectory",
        engine="theory",
        predicted=np.full(len(wanted), predicted),
        measured=extrapolated[:, -1],
        budget=ErrorBudget(
            np.abs(extrapolated[:, 1] - extrapolated[:, 0]) + 3.0 * rounding + smoothing, resolution=2e-3
        ),
        parameters=parameters_of(CASES["whirl"].system),
        source=f"Recorded: {', '.join(wanted)}",
        unit="m",
        note="How far the radius is off that of (11), recorded and extrapolated to a step of 0. Predicted by our own "
        "integration of that law, smoothed over 1e-5 m/s. Numerical error: what the last halving changes of the "
        "extrapolation, the digits that are recorded, and the change at eight times the smoothing.",
    )


def theory() -> Findings:
    """Return what the recorded ladders say of the orders, and the ladders."""
    on_disc = tuple(name for name in FIRST_ORDER if name != "Bullet, cone")
    claims = (
        _claim(SLIDES, 1.0, FIRST_ORDER, ("slip",)),
        _claim(STICKS, 1.0, STICKING, ("stick-slip",), scatters=True),
        _claim(DISC, 1.0, on_disc, ("disc",)),
        _claim(AXES, 0.0, BY_AXIS, ("slip", "disc")),
        _claim(BULLET, 0.0, ("Bullet, cone",), ("disc",)),
        _claim_of_whirl(BOX_WHIRL, box, BOXES),
        _claim_of_whirl(PYRAMID_WHIRL, pyramid, PYRAMIDS),
    )
    data: Data = {
        f"{recording.name}: {case}": runs[:, [SECONDS, ERROR]]
        for recording in recorded()
        for case, runs in recording.runs.items()
    }
    return Findings(claims, data)


def verdict(runs: FloatArray) -> str:
    """Return in words whether the finest of ``runs`` agrees with the exact motion, within its own error estimate.

    The estimate is what the last two refinements changed: with two halvings of the step three times the error that
    is left at order 1, and as large as it at order 1/2.
    """
    steps, error = runs[:, STEPS], runs[:, ERROR]
    order = math.log(error[-2] / error[-1]) / math.log(steps[-1] / steps[-2])
    estimate = float(np.sum(runs[-2:, CHANGE]))
    if error[-1] <= estimate:
        return f"agrees: {error[-1]:.1g} ± {estimate:.1g}, order {order:.1f}"
    return f"another law: {error[-1]:.2g} ± {estimate:.1g}"


def time_to(wanted: float, runs: FloatArray) -> str:
    """Return in words the processor time in ms that an error of ``wanted`` takes, between runs by powers of it."""
    good = np.nonzero(runs[:, ERROR] <= wanted)[0]
    if not good.size:
        return "not reached"
    i = int(good[0])
    if i == 0:
        return f"≤ {1e3 * runs[0, SECONDS]:.3g}"
    error, seconds = np.log(runs[i - 1 : i + 1, ERROR]), np.log(runs[i - 1 : i + 1, SECONDS])
    return f"{1e3 * math.exp(np.interp(math.log(wanted), error[::-1], seconds[::-1])):.3g}"


def tables() -> tuple[Table, ...]:
    """Return what each setting agrees to, what it costs, and how it was set."""
    titles = tuple(case.title for case in CASES.values())
    agreement = tuple(
        (recording.name, *(verdict(recording.runs[case]) for case in CASES)) for recording in recorded()
    )
    cost = tuple(
        (recording.name, *(time_to(WANTED, recording.runs[case]) for case in CASES))
        for recording in recorded()
    )
    how = tuple(
        (recording.name, recording.version, recording.says, f"{recording.recorded}, {recording.platform}")
        for recording in recorded()
    )
    return (
        Table(
            "The finest run of each setting against the exact motion, in m, the largest difference over time. "
            f"It agrees where that is within what its last two refinements, to {COARSENING:g} times less tolerance, "
            "changed (±). Orders are in the number of steps, from the last refinement.",
            ("Engine, setting", *titles),
            agreement,
        ),
        Table(f"Time in ms of one core to an error of {WANTED:g} m.", ("Engine, setting", *titles), cost),
        Table("How they were set and recorded.", ("Engine, setting", "Version", "Setting", "Recorded"), how),
    )


STUDY = Study(
    name="foreign-engines",
    title="Foreign engines",
    section="The engines",
    paper="Not in the paper. MuJoCo, Bullet, Drake and DART simulate the pin and a disc on six points with "
    "contact and friction of their own, in each setting that they offer, and with our law −μN·v/max(|v|, ε) as a "
    "user's force in place of contact. Steps and solvers are the best that we found for each. A box bounds "
    "friction for each axis of the world, which lets the pin whirl 0.24 m farther out than (11); a pyramid "
    "directs it along the nearest axis, which is 0.09 m too far in.\n\nThe numbers are no part of this run: they "
    "were recorded by one command, with our own engines beside them on the same machine, and come with the "
    "project. Exact motions are those of the reference at a tolerance of 1e-13, and (11) for the radius; so the "
    "reference is measured against itself here, and elsewhere against formulas.",
    measure=measure,
    draw=draw,
    theory=theory,
    tables=tables,
    figures={
        "foreign-engines-pin": "Error of the place of a pin, the largest over 100 s, over the time that it takes on "
        "one core. Left: it slides all the time. Right: it sticks nine times on its way to the whirl.",
        "foreign-engines-disc": "Error of the place of the first contact point of a disc on six, the largest over 50 "
        "s, over the time that it takes on one core.",
    },
    only=("theory",),
    finding="Settings of MuJoCo, Bullet, Drake and DART with a friction cone converge to Coulomb's law, but "
    "Bullet's for a pin only. Those with a box or a pyramid, two of them the engines' defaults, converge to "
    "another one: a pin whirls 0.24 m too far out or 0.09 m too far in.",
    seconds=1.0,
)
