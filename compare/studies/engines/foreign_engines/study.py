"""Claims."""

import functools
from collections.abc import Sequence

import numpy as np

import compare.studies.engines.foreign_engines.theory as theory
from compare.claims import (
    ByEngine,
    Data,
    Figures,
    Measured,
    Recorded,
    Study,
    extrapolated_order,
    observed_exponent,
)
from compare.foreign import CASES, DIGITS, ERROR, SECONDS, STEPS
from compare.output.figures import BLUE, GREY, ORANGE, Figure, new_figure
from compare.report.at_a_glance import SHIPPED, best_of

ORDER = (
    "Orders observed in successive halvings of the step, extrapolated to 0. Model error: the change due to "
    "extrapolation. Numerical error: change of the extrapolated value from one step to the next."
)
SCATTERED_ORDER = (
    "Orders observed in successive halvings of the step, by least squares with a next term of one order more, "
    "because errors scatter with the position within a step at which stick begins. Model error: the effect of that "
    "term. Numerical error: 95 % interval from the scatter."
)
SETTLED = (
    " The recorded radius is the mean from 80 to 100 s, before the motion has settled. The change that the "
    "law itself predicts until 500 s is added to both numbers."
)
LAW = (
    "Deviation from the exact motion, recorded and extrapolated to a step of 0. Predicted by our own integration of "
    "that law, smoothed over 1e-5 m/s. Numerical error: the change of the extrapolation in the last halving, the "
    "recorded digits, and eight times the change at an eighth of the smoothing."
)


def curves() -> Data:
    return {
        f"{recording.name}: {case}": runs[:, [SECONDS, ERROR]]
        for recording in theory.recorded()
        for case, runs in recording.runs.items()
    }


STUDY = Study.beside(__file__, "foreign-engines", only=("theory",), seconds=1.0)


_of_order = functools.partial(STUDY.claim, kind="order", basis="independent", resolution=0.5, note=ORDER)

_of_law = functools.partial(STUDY.claim, kind="trajectory", basis="independent", unit="m", resolution=2e-3)


@_of_order("With steps of order 1, the error of a sliding pin falls in proportion to the step")
def slides() -> Measured:
    return _orders(1.0, theory.FIRST_ORDER, ("slip",))


@STUDY.claim(
    "The error of a sticking pin falls in proportion to a fixed step, whatever the order of the integrator in slip",
    kind="order",
    basis="independent",
    resolution=0.5,
    note=SCATTERED_ORDER,
)
def sticks() -> Measured:
    return _orders(1.0, theory.STICKING, ("stick-slip", "release"), scatters=True)


@_of_order("With steps of order 1, the error of a disc on six points falls in proportion to the step")
def disc_slides() -> Measured:
    left_out = theory.SINGLE_PRECISION + theory.OFF_FOR_DISCS
    return _orders(1.0, tuple(name for name in theory.FIRST_ORDER if name not in left_out), ("disc",))


@_of_order("Engines with a friction pyramid or box do not converge for pin or disc")
def axes_stay_off() -> Measured:
    return _orders(0.0, theory.BY_AXIS, ("slip", "disc"))


@_of_order("Bullet's cone and Chipmunk's joints do not converge for a disc")
def disc_stays_off() -> Measured:
    return _orders(0.0, theory.OFF_FOR_DISCS, ("disc",))


def _orders(
    predicted: float, wanted: tuple[str, ...], cases: tuple[str, ...], *, scatters: bool = False
) -> Measured:
    by_name = {recording.name: recording for recording in theory.recorded()}
    runs = {(name, case): by_name[name].runs[case] for case in cases for name in wanted}
    found = [
        observed_exponent(1.0 / rows[:, STEPS], rows[:, ERROR], next_term=1.0)
        if scatters
        else extrapolated_order(rows[:, ERROR], 0.0)
        for rows in runs.values()
    ]
    orders, numerical, model = np.transpose(found)
    words = ", ".join(
        f"{name} ({CASES[case].name}): {order:.3f}" for (name, case), order in zip(runs, orders, strict=True)
    )
    dates = " and ".join(sorted({by_name[name].recorded for name in wanted}))
    return Measured(
        predicted=np.full(len(orders), predicted),
        value=orders,
        error=numerical,
        model=float(np.max(model)),
        components=[f"{name} ({CASES[case].name})" for name, case in runs],
        system=CASES[cases[0]].system,
        source=f"Recorded on {dates}; " + "; ".join(CASES[case].name for case in cases),
        note=f"{words}.",
    )


@_of_law(
    "With Bullet's and DART's boxes, a pin whirls as with friction that is bounded along each axis separately",
    equation=CASES["whirl"].equation,
    note=LAW + SETTLED,
)
def box_whirls() -> Measured:
    return _as_far_off_as(theory.box, "whirl", theory.BOXES)


@_of_law(
    "With MuJoCo's pyramid, a pin whirls as with friction along the nearest axis of the world",
    equation=CASES["whirl"].equation,
    note=LAW + SETTLED,
)
def pyramid_whirls() -> Measured:
    return _as_far_off_as(theory.pyramid, "whirl", theory.PYRAMIDS)


@_of_law(
    "Bullet's and DART's boxes hold a stuck pin too long, by as much as friction bounded along each axis does",
    equation=CASES["release"].equation,
    note=LAW,
)
def box_releases() -> Measured:
    return _as_far_off_as(theory.box, "release", theory.BOXES)


@_of_law(
    "MuJoCo's pyramid releases a stuck pin too early, by as much as friction along the nearest axis does",
    equation=CASES["release"].equation,
    note=LAW,
)
def pyramid_releases() -> Measured:
    return _as_far_off_as(theory.pyramid, "release", theory.PYRAMIDS)


def _as_far_off_as(law: theory.Law, case: str, wanted: tuple[str, ...]) -> Measured:
    by_name = {recording.name: recording for recording in theory.recorded()}
    errors = np.array([by_name[name].runs[case][-3:, ERROR] for name in wanted])
    extrapolated = 2.0 * errors[:, 1:] - errors[:, :-1]
    rounding = 0.5 * 10.0 ** (1 - DIGITS) * errors[:, -1]
    predicted, smoothing = theory.error_of(law, CASES[case])
    later, unsettled = theory.settling(law) if case == "whirl" else (0.0, 0.0)
    return Measured(
        predicted=np.full(len(wanted), predicted + later),
        value=extrapolated[:, -1] + later,
        error=np.abs(extrapolated[:, 1] - extrapolated[:, 0]) + 3.0 * rounding + smoothing + unsettled,
        components=wanted,
        system=CASES[case].system,
        source=f"Recorded: {', '.join(wanted)}; {CASES[case].name}",
        named={f"{case} by {name.replace(',', '')}": i for i, name in enumerate(wanted)},
    )


@STUDY.claim(
    "A box around Coulomb's cone releases a stuck pin later than the cone, and a pyramid inside it releases it at "
    "once",
    equation="(6), (7)",
    unit="s",
    resolution=1e-2,
    note="Measured by our own integration of these laws, smoothed over 1e-5 m/s. Predicted: the delay after F "
    "= μN, (7), "
    "until the force of (6) violates |F_x|, |F_y| <= μN, or |F_x| + |F_y| <= μN. Numerical error: eight times the "
    "change at an eighth of the smoothing.",
    named={"late by a box": 0, "late by a pyramid": 1},
)
def holds_longer() -> Measured:
    times, errors = np.transpose([theory.release_by(law) for law in (theory.box, theory.pyramid)])
    exact = theory.release_where(abs)
    by_axes = (
        theory.release_where(lambda pull: max(abs(pull.real), abs(pull.imag))),
        theory.release_where(lambda pull: abs(pull.real) + abs(pull.imag)),
    )
    return Measured(
        predicted=np.subtract(by_axes, exact),
        value=times - exact,
        error=errors,
        components=("by a box", "by a pyramid"),
        system=CASES["release"].system,
        source=CASES["release"].name,
    )


@STUDY.claim(
    "Contact solved for zero slip moves a stuck pin along tangents: its radius grows by the fraction ω²h/2 per "
    "second",
    basis="independent",
    unit="m",
    resolution=1e-4,
    note="Predicted: |(1 + iωh)ⁿ − exp(iωnh)| times the radius, which to first order grows by ω²h/2 per second. "
    "Numerical error: a unit in the last recorded digit.",
)
def creeps() -> Measured:
    by_name = {recording.name: recording for recording in theory.recorded()}
    runs = np.concatenate([by_name[name].runs["stuck"] for name in theory.TANGENTS])
    names = [
        f"{name}, {steps:g} steps"
        for name in theory.TANGENTS
        for steps in by_name[name].runs["stuck"][:, STEPS]
    ]
    return Measured(
        predicted=[theory.creep(steps) for steps in runs[:, STEPS].astype(int)],
        value=runs[:, ERROR],
        error=10.0 ** (1 - DIGITS) * runs[:, ERROR],
        components=names,
        system=CASES["stuck"].system,
        source=f"Recorded, all steps: {', '.join(theory.TANGENTS)}",
    )


PANELS = {
    "foreign-engines-pin": "slip",
    "foreign-engines-stick": "stick-slip",
    "foreign-engines-disc": "disc",
}
"""Motion of each figure, whose panels show one foreign engine each."""

COLUMNS = 5


def draw(data: ByEngine) -> Figures:
    if "theory" not in data:
        return {}
    settings = theory.recorded_settings()
    return {name: _by_engine(data["theory"], settings, case) for name, case in PANELS.items()}


def _by_engine(ladders: Data, settings: Sequence[Recorded], case: str) -> Figure:
    """Draw the best setting and the one as shipped in colour, other settings and the reference in grey."""
    by_engine: dict[str, list[Recorded]] = {}
    for one in settings:
        if one.setting and f"{one.engine}, {one.setting}: {case}" in ladders:
            by_engine.setdefault(one.engine, []).append(one)
    rows = -(-len(by_engine) // COLUMNS)
    figure, panels = new_figure(COLUMNS, rows, width=11.5, height=2.5 * rows, sharex=True, sharey=True)
    for panel, (engine, found) in zip(panels, by_engine.items(), strict=False):
        best = best_of(found)
        panel.loglog(*ladders[f"reference: {case}"].T, color=GREY, linestyle=":", linewidth=1.0)
        for one in sorted(found, key=lambda one: (one is best, one.shipped)):
            colour = BLUE if one is best else ORANGE if one.shipped else GREY
            name = f"{one.engine}, {one.setting}"
            runs = ladders[f"{name}: {case}"]
            panel.loglog(
                *runs.T, color=colour, marker="." if colour != GREY else "", linewidth=1.0, label=name
            )
            if colour != GREY:
                said = (
                    one.setting if colour == BLUE or one.setting == SHIPPED else f"{one.setting} (as shipped)"
                )
                place, up = (runs[-1], -1.0) if colour == BLUE else (runs[0], 1.0)
                panel.annotate(
                    said, place, xytext=(2.0, 7.0 * up), textcoords="offset points", color=colour, fontsize=8.5,
                    ha="right" if colour == BLUE else "left", va="top" if colour == BLUE else "bottom",
                )  # fmt: skip
        panel.set_title(engine)
    reference = ladders[f"reference: {case}"][-1]
    panels[0].annotate(
        "reference", reference, xytext=(6.0, 0.0), textcoords="offset points", color=GREY, fontsize=8.5
    )
    for panel in panels[len(by_engine) :]:
        panel.set_visible(False)
    figure.supxlabel("time on one core in s", fontsize=11.0)
    figure.supylabel("largest error in m", fontsize=11.0)
    return figure


STUDY.provides(figures=draw, curves=curves, tables=theory.tables, recorded=theory.recorded_settings)
