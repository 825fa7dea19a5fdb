"""Claims on the pushes, and their validation."""

from collections.abc import Sequence
from functools import cache, partial

import numpy as np

import compare.studies.plane.pushes.forward as forward
import compare.studies.plane.pushes.theory as theory
from compare.claims import Measured, Study
from compare.claims.prose import Table
from compare.claims.validation import Validation
from compare.engines import Engine
from compare.studies.plane.pushes.reduction import Push
from compare.studies.toolkit.uncertainties import Uncertainties, median_with_error, validation_of
from reference_model.contact.limit_surface import largest_wrench
from reference_model.systems import FloatArray

SOURCE = "measurements of J. Zhou (2015), see reduced.csv in the folder of this study"

STUDY = Study.beside(__file__, "pushes", source=SOURCE, seconds=15.0, only=("exudyn",))

GROUPS = {
    "three feet on the board": ("10_130_10_10_10_130", "10_90_10_10_30_130", "30_90_30_30_30_90"),
    "three feet on wood": ("wood_10_130_10_10_10_130", "wood_30_90_30_30_30_90"),
    "the whole face on the board": ("patch",),
    "the whole face on wood": ("wood_patch",),
}

HYPOTHESES: dict[str, theory.Law] = {
    "Coulomb's law, the authors' parameters": theory.coulomb,
    "pusher 10 mm above the surface": partial(theory.pushed_above, height=10.0),
    "pusher 20 mm above the surface": partial(theory.pushed_above, height=20.0),
    "sliding force 10 % larger": partial(theory.coulomb, factor=1.1),
    "centre of mass 2 mm further along x": partial(theory.coulomb, centre=theory.CENTRE + 2.0),
    "centre of mass 2 mm further along y": partial(theory.coulomb, centre=theory.CENTRE + 2.0j),
    "a third of the pressure at the edges": partial(theory.summed, at_edges=1.0 / 3.0),
    "friction rises with the slip speed to the power 0.1": partial(theory.summed, exponent=0.1),
    "friction falls with the slip speed to the power 0.1": partial(theory.summed, exponent=-0.1),
}
"""Other explanations of the error; their sizes are assumed, not fitted."""

ROUNDING = 1e-12
"""Rounding error of a wrench, relative to sliding force and pusher's radius, and of a direction in degrees."""

LIMIT = 1e-9
"""Relative error of a point on the limit surface, whose slip minimises a convex function."""


def chosen(every: int) -> list[Push]:
    """Return each push whose place in its series is a multiple of ``every``."""
    return [push for pushes in theory.by_series().values() for push in pushes[::every]]


@STUDY.claim(
    "The wrench of friction during each measured displacement is the sum over the contact points",
    unit="N",
    resolution=1e-9,
    note="The reference's contact against a sum of this study. Moments are divided by 50 mm.",
)
def sums(every: int = 1) -> Measured:
    return Measured(
        predicted=[theory.summed(push).components for push in chosen(every)],
        value=[theory.coulomb(push).components for push in chosen(every)],
        error=ROUNDING * max(theory.SLIDING_FORCES.values()),
    )


@STUDY.claim(
    "The wrench of friction during each measured displacement lies on the limit surface",
    resolution=1e-6,
    note="Largest multiple of the wrench that friction can hold at rest, by minimising over all slips.",
)
def on_limit_surface(every: int = 1) -> Measured:
    found = []
    for push in chosen(every):
        contact = theory.contact_of(push.series)
        wrench = theory.predicted(theory.Motion.of(push), contact, 1.0)
        largest, _ = largest_wrench(contact, wrench.force, wrench.moment)
        found.append(abs(largest) / abs(wrench.force))
    return Measured(predicted=np.ones(len(found)), value=found, error=LIMIT)


# --- Pushes simulated forward

EVERY = 10
"""Stride of the simulated pushes in a series."""

EPSILON = 2e-5
"""Regularisation in m/s; the hand moves at 2.45 mm/s."""


@cache
def quasi_static(steps: int = 5, hand: float = forward.HAND, every: int = EVERY) -> FloatArray:
    """Return displacements x, y and turns times ``theory.PUSHER`` (m) without inertia, shape (n, 3)."""
    return _components([forward.quasi_static(push, steps, hand) for push in chosen(every)])


def _components(motions: Sequence[tuple[complex, float]]) -> FloatArray:
    return np.array([(position.real, position.imag, theory.PUSHER * angle) for position, angle in motions])


def from_measured(poses: FloatArray, every: int) -> FloatArray:
    """Return the distances (mm) of simulated from measured final positions."""
    return apart(poses, _components([forward.measured_motion(push) for push in chosen(every)]))


def apart(poses: FloatArray, others: FloatArray) -> FloatArray:
    return np.asarray(np.linalg.norm((poses - others)[:, :2], axis=1) / theory.MM)


@STUDY.claim(
    "A body that is pushed along the measured path ends where the motion of least friction power ends",
    kind="trajectory",
    unit="m",
    resolution=3e-4,
    note="Every tenth push. The predicted motion has exact friction and no inertia. The Exudyn model has a stiff "
    "edge and regularised friction; its poses are extrapolated from two regularisations.",
)
def final_poses(engine: Engine, every: int = EVERY) -> Measured:
    predicted = quasi_static(10, every=every)
    fine, coarse = (
        _components([forward.by_exudyn(push, epsilon) for push in chosen(every)])
        for epsilon in (EPSILON, 2.0 * EPSILON)
    )
    deformed = 2.0 * max(theory.SLIDING_FORCES.values()) / forward.STIFFNESS
    value = 2.0 * fine - coarse  # the error is of first order
    return Measured(
        predicted=predicted,
        value=value,
        error=np.abs(fine - coarse) + np.abs(predicted - quasi_static(every=every)) + deformed,
        at={"push": [f"{push.series} {push.number}" for push in chosen(every)]},
        components=("x in m", "y in m", "turn times 50 mm in m"),
        data={"reference": from_measured(predicted, every), "exudyn": from_measured(value, every)},
    )


# --- The validation


def validations(every: int = EVERY) -> tuple[Validation, ...]:
    """Return the errors of the force's direction by surface and contact, of wrench and work, and of the position."""
    everything = tuple(theory.by_series())
    return (
        *(
            _of(
                series,
                theory.force_error,
                f"direction of the force, {name}",
            )
            for name, series in GROUPS.items()
        ),
        _of(everything, theory.wrench_difference, "direction of the wrench, with moments over 50 mm"),
        _of(everything, theory.work_error, "work of a push", unit="%"),
        _of_final_positions(every),
    )


def _of(series: Sequence[str], of: theory.Difference, quantity: str, unit: str = "degrees") -> Validation:
    groups = [theory.by_series()[one] for one in series]
    found = np.array([np.linalg.norm(of(push, theory.coulomb)) for pushes in groups for push in pushes])
    uncertain = Uncertainties.joined([theory.uncertainties(pushes, of) for pushes in groups])
    return validation_of(found, uncertain, quantity, unit)


def _of_final_positions(every: int) -> Validation:
    predicted = quasi_static(every=every)
    slippery, rough = (quasi_static(hand=forward.HAND + change, every=every) for change in (-0.1, 0.1))
    poses = [theory.pose_errors(pushes)[0] for pushes in theory.by_series().values() for _ in pushes[::every]]
    return validation_of(
        from_measured(predicted, every),
        Uncertainties(
            data=np.array(poses),
            input=0.5 * apart(rough, slippery),
            numerical=apart(predicted, quasi_static(10, every=every)),
        ),
        "final position of the pushed body",
        "mm",
    )


def tables() -> tuple[Table, ...]:
    return _by_series(), _of_hypotheses()


def _by_series() -> Table:
    rows = tuple((name, *_errors_of(pushes)) for name, pushes in theory.by_series().items())
    return Table(
        "Coulomb's law against the measurements. Each series has 50 pushes; ± is the standard error of a median.",
        ("series", *COLUMNS),
        rows,
    )


COLUMNS = (
    "direction of the force: median error in degrees",
    "90 % below",
    "data uncertainty",
    "input uncertainty",
    "explained in %",
    "scatter of equal pushes (pairs)",
    "direction of the wrench: median error in degrees",
    "measured over predicted work",
)


def _errors_of(pushes: tuple[Push, ...]) -> tuple[str, ...]:
    force, uncertain = theory.errors(pushes, theory.force_error), theory.uncertainties(pushes)
    return (
        _text(force),
        f"{np.percentile(force, 90):.1f}",
        f"{np.median(uncertain.data):.1f}",
        f"{np.median(uncertain.input):.1f}",
        f"{100.0 * uncertain.share_explained(force):.0f}",
        "{:.1f} ({})".format(*theory.scatter(pushes)),
        _text(theory.errors(pushes, theory.wrench_error)),
        _text(theory.errors(pushes, theory.work_ratio), digits=3),
    )


def account(pushes: Sequence[Push]) -> list[str]:
    return [
        f"{name}: " + "; ".join(map(" ".join, zip(COLUMNS, _errors_of(own), strict=True)))
        for name, own in theory.grouped(pushes).items()
    ]


def _of_hypotheses() -> Table:
    def cell(law: theory.Law, series: Sequence[str]) -> str:
        pushes = [push for one in series for push in theory.by_series()[one]]
        both = (theory.force_error, theory.work_ratio)
        angle, work = (np.median(theory.errors(pushes, of, law)) for of in both)
        return f"{angle:.1f}; {work:.3f}"

    return Table(
        "Effects of other explanations: median error of the direction in degrees; measured over predicted work.",
        ("hypothesis", *GROUPS),
        tuple((name, *(cell(law, series) for series in GROUPS.values())) for name, law in HYPOTHESES.items()),
    )


def _text(values: FloatArray, digits: int = 1) -> str:
    median, error = median_with_error(values)
    return f"{median:.{digits}f} ± {error:.{digits}f}"


STUDY.provides(tables=tables, validations=validations)
