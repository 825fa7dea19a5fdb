"""What foreign engines make of the paper's systems, from data recorded with them: laws, orders, errors over time."""

from __future__ import annotations

import functools
import math

import numpy as np

from compare.claims.claim import Claim, ErrorBudget
from compare.claims.error_estimates import COARSENING, extrapolated_order, observed_exponent
from compare.claims.parameters import parameters_of
from compare.claims.study import Data, Findings, Recorded, Study, Table
from compare.engines import Engine
from compare.foreign.cases import CASES
from compare.foreign.records import COLUMNS, DIGITS, Recording, recordings
from compare.studies.engines.foreign_engines.laws import (
    Law,
    box,
    creep,
    error_of,
    pyramid,
    release_by,
    release_where,
)
from compare.studies.engines.foreign_engines.pictures import draw
from compare.studies.engines.foreign_engines.recorded import ERROR, STEPS, estimate, recorded_claims
from reference_model.systems import FloatArray

SECONDS = COLUMNS.index("seconds")

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

TANGENTS = ("Bullet, cone", "Bullet, box", "DART, NSGS", "DART, FBF", "DART, Dantzig", "DART, PGS")
"""Settings that leave no slip at all at the end of a step in which contact sticks."""

SLIDES = "Steps of order 1: the error of a sliding pin falls in proportion to the step"
STICKS = "The error of a pin that sticks falls in proportion to a fixed step, whatever its order where the pin slides"
DISC = "Steps of order 1: the error of a disc on six points falls in proportion to the step"
AXES = "A pyramid or a box in place of the cone is another law: the errors of pin and disc do not fall with the step"
BULLET = "Bullet's cone is another law for a disc: the error does not fall with the step"
BOX_WHIRL = "A pin whirls by Bullet's and DART's boxes as by friction for each axis of the world"
PYRAMID_WHIRL = "A pin whirls by MuJoCo's pyramid as by friction along the nearest axis of the world"
BOX_RELEASE = "Bullet's and DART's boxes hold a stuck pin too long, by as much as friction for each axis does"
PYRAMID_RELEASE = (
    "MuJoCo's pyramid lets a stuck pin go too early, by as much as friction along the nearest axis does"
)
HOLDS = (
    "By friction for each axis of the world a stuck pin is let go later than by Coulomb's law, by friction along the "
    "nearest axis at once"
)
CREEP = "With contact solved for no slip a stuck pin goes along tangents, outwards by ω²h/2 of its radius per second"

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
        basis="independent",
    )


def _claim_of_law(sentence: str, law: Law, case: str, wanted: tuple[str, ...]) -> Claim:
    """Return the claim that the ``wanted`` settings, of order 1, are as far off in a case as ``law``."""
    by_name = {recording.name: recording for recording in recorded()}
    errors = np.array([halvings(by_name[name].runs[case])[-3:, ERROR] for name in wanted])
    extrapolated = 2.0 * errors[:, 1:] - errors[:, :-1]
    rounding = 0.5 * 10.0 ** (1 - DIGITS) * errors[:, -1]
    predicted, smoothing = error_of(law, case)
    return Claim(
        sentence,
        equation=CASES[case].equation,
        kind="trajectory",
        engine="theory",
        predicted=np.full(len(wanted), predicted),
        measured=extrapolated[:, -1],
        budget=ErrorBudget(
            np.abs(extrapolated[:, 1] - extrapolated[:, 0]) + 3.0 * rounding + smoothing, resolution=2e-3
        ),
        parameters=parameters_of(CASES[case].system),
        source=f"Recorded: {', '.join(wanted)}; {CASES[case].title}",
        unit="m",
        note="How far it is off the exact one, recorded and extrapolated to a step of 0. Predicted by our own "
        "integration of that law, smoothed over 1e-5 m/s. Numerical error: what the last halving changes of the "
        "extrapolation, the digits that are recorded, and eight times the change at an eighth of the smoothing.",
        basis="independent",
        named={f"{case} by {name.replace(',', '')}": i for i, name in enumerate(wanted)},
    )


def _claim_of_release() -> Claim:
    """Return the claim on how much later than by Coulomb's law a stuck pin is let go by a box, and by a pyramid."""
    times, errors = np.transpose([release_by(law) for law in (box, pyramid)])
    exact = release_where(abs)
    by_axes = (
        release_where(lambda pull: max(abs(pull.real), abs(pull.imag))),
        release_where(lambda pull: abs(pull.real) + abs(pull.imag)),
    )
    return Claim(
        HOLDS,
        equation="(6), (7)",
        engine="theory",
        predicted=np.subtract(by_axes, exact),
        measured=times - exact,
        budget=ErrorBudget(errors, resolution=1e-2),
        parameters=parameters_of(CASES["release"].system),
        source=CASES["release"].title,
        unit="s",
        note="A box, then a pyramid: by our own integration of these laws, smoothed over 1e-5 m/s. Predicted: how "
        "much later the force of (6) exceeds |F_x|, |F_y| <= μN, and |F_x| + |F_y| <= μN, than F <= μN, (7). "
        "Numerical error: eight times the change at an eighth of the smoothing.",
        named={"late by a box": 0, "late by a pyramid": 1},
    )


def _claim_of_creep() -> Claim:
    """Return the claim that places go from w to (1 + iωh)·w in each step where a pin sticks."""
    by_name = {recording.name: recording for recording in recorded()}
    runs = np.concatenate([by_name[name].runs["stuck"] for name in TANGENTS])
    return Claim(
        CREEP,
        equation="",
        kind="formula",
        engine="theory",
        predicted=[creep(steps) for steps in runs[:, STEPS].astype(int)],
        measured=runs[:, ERROR],
        budget=ErrorBudget(10.0 ** (1 - DIGITS) * runs[:, ERROR], resolution=1e-4),
        parameters=parameters_of(CASES["stuck"].system),
        source=f"Recorded, all steps: {', '.join(TANGENTS)}",
        unit="m",
        note="Predicted: |(1 + iωh)ⁿ − exp(iωnh)| times the radius, which is off by ω²h/2 per second to first order. "
        "Numerical error: a unit in the last digit that is recorded.",
        basis="independent",
    )


def theory() -> Findings:
    """Return what the recorded ladders say of the orders, and the ladders."""
    on_disc = tuple(name for name in FIRST_ORDER if name != "Bullet, cone")
    claims = (
        _claim(SLIDES, 1.0, FIRST_ORDER, ("slip",)),
        _claim(STICKS, 1.0, STICKING, ("stick-slip", "release"), scatters=True),
        _claim(DISC, 1.0, on_disc, ("disc",)),
        _claim(AXES, 0.0, BY_AXIS, ("slip", "disc")),
        _claim(BULLET, 0.0, ("Bullet, cone",), ("disc",)),
        _claim_of_law(BOX_WHIRL, box, "whirl", BOXES),
        _claim_of_law(PYRAMID_WHIRL, pyramid, "whirl", PYRAMIDS),
        _claim_of_law(BOX_RELEASE, box, "release", BOXES),
        _claim_of_law(PYRAMID_RELEASE, pyramid, "release", PYRAMIDS),
        _claim_of_release(),
        _claim_of_creep(),
    )
    data: Data = {
        f"{recording.name}: {case}": runs[:, [SECONDS, ERROR]]
        for recording in recorded()
        for case, runs in recording.runs.items()
    }
    return Findings(claims, data)


def recorded_settings() -> tuple[Recorded, ...]:
    """Return what the report's matrix shows of each setting."""
    return tuple(recorded_claims(recording) for recording in recorded())


def _finest(runs: FloatArray) -> str:
    """Return in words the error in m of the finest of ``runs``, its estimate and, of several runs, the order."""
    steps, error = runs[:, STEPS], runs[:, ERROR]
    if len(runs) == 1 or not np.all(error[-2:] > 0.0):
        return f"{error[-1]:.1g}"
    order = math.log(error[-2] / error[-1]) / math.log(steps[-1] / steps[-2])
    return f"{error[-1]:.2g} ± {estimate(runs):.1g}, order {order:.1f}"


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
    """Return how far each setting is off, what it costs, and how it was set."""
    titles = tuple(case.title for case in CASES.values())
    finest = tuple(
        (recording.name, *(_finest(recording.runs[case]) for case in CASES)) for recording in recorded()
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
            "How far the finest run of each setting is off the exact motion, in m, the largest difference over time, "
            f"± what its last two refinements, to {COARSENING:g} times less tolerance, changed: from these is the "
            "verdict in the matrix. Orders are in the number of steps, from the last refinement.",
            ("Engine, setting", *titles),
            finest,
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
    "friction for each axis of the world, which lets the pin whirl {whirl by DART Dantzig, 2 digits} m farther "
    "out than (11); a pyramid directs it along the nearest axis, which is {whirl by MuJoCo pyramidal cone, 1 "
    "digit} m too far in.\n\nWhere a pin sticks, contact that is solved for no slip at the end of a step carries "
    "it along the tangent: its circle grows by ω²h/2 of its radius per second, whatever the solver. MuJoCo's "
    "ellipse acts midway in a step and leaves less than a thousandth of that. A box, which is stronger than the "
    "cone between the axes, lets the pin go {late by a box, 2 digits} s late; a pyramid, which is weaker there, "
    "does not hold it at all where it starts.\n\nThe numbers are no part of this run: they were recorded by one "
    "command, with our own engines beside them on the same machine, and come with the project. Exact motions are "
    "those of the reference at a tolerance of 1e-13, and (11) for the radius; so the reference is measured "
    "against itself here, and elsewhere against formulas.",
    by_hand=measure,
    draw=draw,
    theory=theory,
    tables=tables,
    recorded=recorded_settings,
    figures={
        "foreign-engines-pin": "Error of the place of a pin, the largest over 100 s, over the time that it takes on "
        "one core. Left: it slides all the time. Right: it sticks nine times on its way to the whirl.",
        "foreign-engines-disc": "Error of the place of the first contact point of a disc on six, the largest over 50 "
        "s, over the time that it takes on one core.",
    },
    only=("theory",),
    finding="Settings of MuJoCo, Bullet, Drake and DART with a friction cone converge to Coulomb's law, but "
    "Bullet's for a pin only. Those with a box or a pyramid, two of them the engines' defaults, converge to "
    "another one: a pin whirls {whirl by DART Dantzig, 2 digits} m too far out or "
    "{whirl by MuJoCo pyramidal cone, 1 digit} m too far in, and sticks {late by a box, 2 digits} s too long or "
    "not at all.",
    seconds=1.0,
)
