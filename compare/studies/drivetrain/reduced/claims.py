"""The drivetrain with the paper's disc for a clutch: what the model gives where engine and vehicle can't be slowed.

With an engine and a vehicle of endless inertia, a clutch with one ring for a facing and a damper alone for a
torsional spring, the drivetrain is a ``DiscOnDisc``: flywheel and gearbox are the paper's master disc and shaft. The
model is the same that runs up and launches; the reference knows nothing of it.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from compare.claims.claim import Claim, ErrorBudget
from compare.claims.error_estimates import observed_exponent, refined
from compare.claims.paper_parameters import FIG8, FIG11
from compare.claims.parameters import at_each, parameters_of
from compare.claims.study import Data, Findings, Study
from compare.engines import Engine
from compare.figures import BLACK, axis, curve, new_figure, points
from compare.studies.toolkit.fig11_motion import START
from reference_model import Annulus, simulate
from reference_model.contact.contact_law import Contact
from reference_model.systems import DiscOnDisc, FloatArray

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ENDLESS = 1e30
"""kg m²: a torque of 1 N m changes the speed of such a rotor by less than its last digit."""

INERTIAS = np.array([250.0, 500.0, 1000.0, 2000.0])
"""kg m² of engine and vehicle, where they are slowed."""

UNTIL = 50.0
"""In s."""

TOLERANCE = 2e-12
"""Of Exudyn's DOPRI5 in m, rad, m/s and rad/s, and of the reference."""

ORDER_TOLERANCE = 1e-9
"""Of DOPRI5 where inertias change much more."""

LARGEST_STEP = 1.0
"""In s: so large that the tolerance decides."""

EPSILON = 1e-6
"""m/s; these discs slip faster all the time, so that the law is that of Coulomb."""


@dataclass(frozen=True)
class Case:
    """A disc, its start (x, y in m, angle in rad, and rates), source of both, and the facing's inner radius in m."""

    disc: DiscOnDisc
    start: tuple[float, ...]
    source: str
    inner_radius: float

    @property
    def contact(self) -> Contact | None:
        """The law of the reference."""
        radius = self.disc.contact_radius
        return None if self.inner_radius == radius else Annulus(self.inner_radius, radius)


R = FIG11.contact_radius
CYCLE = Case(FIG11, START, "Fig. 11 with X0 = 0, started on its cycle", R)
CASES = {
    "Fig. 8": Case(
        FIG8,
        (FIG8.offset, 0.0, 0.0, 0.0, 0.0, FIG8.shaft_speed),
        "Fig. 8 with X0 = 0.1 as in Figs. 4 to 6",
        R,
    ),
    "the modulated cycle of Fig. 11": CYCLE,
    "Fig. 11 with an offset": Case(replace(FIG11, offset=0.02), START, "Fig. 11, X0 = 0.02 m by choice", R),
    "a facing of finite width": Case(FIG11, START, "Fig. 11, inner radius 0.08 m by choice", 0.08),
    "a support that hardens": Case(
        replace(FIG11, hardening=300.0), START, "Fig. 11, half as stiff again at 0.04 m, by choice", R
    ),
    "a support with a stop": Case(
        replace(FIG11, stop_gap=0.03, stop_stiffness=5.0), START, "Fig. 11, a stop at 0.03 m by choice", R
    ),
}

Run = Callable[..., tuple[FloatArray, FloatArray]]
"""``drivetrain_motion``, or what remembers it."""

SENTENCE = "A drivetrain that is reduced to a friction disc moves as the reference does: {}"
ORDER = "What engine and vehicle of finite inertia change in the modulated cycle falls like 1/inertia"


def measure(engine: Engine, cases: Mapping[str, Case] = CASES, inertias: FloatArray = INERTIAS) -> Findings:
    """Run every case for 50 s in the drivetrain, and the modulated cycle with finite inertias too."""
    data: Data = {}
    run = functools.cache(drivetrain_motion)
    claims = [_claim(engine, name, case, run, data) for name, case in cases.items()]
    if len(inertias):
        claims.append(_claim_of_order(engine, inertias, run, data))
    return Findings(tuple(claims), data)


def drivetrain_motion(
    case: Case, tolerance: float, inertia: float = ENDLESS
) -> tuple[FloatArray, FloatArray]:
    """Return times in s, and x, y, angle and their rates of the clutch disc at them, shape (n, 6)."""
    import exudyn as exu

    from exudyn_models import Drivetrain, build_drivetrain

    disc = case.disc
    model = build_drivetrain(
        Drivetrain(
            engine_inertia=inertia,
            vehicle_inertia=inertia,
            disc_mass=disc.mass,
            disc_inertia=disc.polar_inertia,
            inner_radius=case.inner_radius,
            outer_radius=disc.contact_radius,
            faces=1,
            friction_coefficient=1.0,
            offset=disc.offset,
            radial_stiffness=disc.stiffness,
            radial_damping=disc.damping,
            hardening=disc.hardening,
            stop_gap=disc.stop_gap,
            stop_stiffness=disc.stop_stiffness,
            torsional_stiffness=0.0,
            torsional_damping=disc.shaft_damping,
        ),
        normal_load=disc.friction_force,
        regularisation=EPSILON,
        engine_speed=disc.disc_speed,
        gearbox_speed=disc.shaft_speed,
    )
    data: Any = model.mbs.systemData
    first = model.mbs.GetNodeODE2Index(model.disc)
    initial = exu.ConfigurationType.Initial
    for values, get, put in (
        (case.start[:3], data.GetODE2Coordinates, data.SetODE2Coordinates),
        (case.start[3:], data.GetODE2Coordinates_t, data.SetODE2Coordinates_t),
    ):
        coordinates = get(initial)
        coordinates[first : first + 3] = values
        put(coordinates, initial)
    motion = model.run(UNTIL, sample_every=0.25, largest_step=LARGEST_STEP, tolerance=tolerance)
    return motion.times, np.hstack((motion.disc, motion.disc_velocity))


def _claim(engine: Engine, name: str, case: Case, run: Run, data: Data) -> Claim:
    times, states = run(case, TOLERANCE)

    def in_drivetrain(tolerance: float) -> FloatArray:
        return np.asarray(run(case, tolerance)[1][-1])

    def in_reference(tolerance: float) -> FloatArray:
        return simulate(case.disc, case.start, times, tolerance=tolerance, contact=case.contact).states

    measured, error = refined(in_drivetrain, TOLERANCE)
    predicted, error_of_reference = refined(in_reference, TOLERANCE)
    # An error oscillates as the motion does: those of the plane and those of the turning are taken together.
    together = (error + error_of_reference[-1]).reshape(2, 3)
    together[:, :2], together[:, 2] = together[:, :2].max(), together[:, 2].max()
    data[f"{name}: t"], data[f"{name}: states"], data[f"{name}: reference"] = times, states, predicted
    return Claim(
        SENTENCE.format(name),
        equation="(19)",
        kind="trajectory",
        engine=engine.name,
        predicted=predicted[-1],
        measured=measured,
        budget=ErrorBudget(together.ravel(), resolution=1e-7),
        parameters=parameters_of(case.disc, inner_radius=case.inner_radius),
        source=case.source,
        note=f"x, y, angle and their rates at t = {UNTIL:g} s, in SI units. Error: the change of both between a "
        f"tolerance of {TOLERANCE:g} and eight times that, the largest of centre and of turning.",
    )


def _claim_of_order(engine: Engine, inertias: FloatArray, run: Run, data: Data) -> Claim:
    def end(tolerance: float, inertia: float = ENDLESS) -> FloatArray:
        return np.asarray(run(CYCLE, tolerance, inertia)[1][-1])

    endless = end(ORDER_TOLERANCE)
    errors = [float(np.linalg.norm(end(ORDER_TOLERANCE, inertia) - endless)) for inertia in inertias]
    data["inertia"], data["finite inertia"] = inertias, np.array(errors)
    noise = 2.0 * float(np.linalg.norm(endless - end(TOLERANCE)))
    order, numerical, model = observed_exponent(
        1.0 / inertias[::-1], data["finite inertia"][::-1], next_term=1.0, noise=noise
    )
    return Claim(
        ORDER,
        equation="(19)",
        kind="order",
        engine=engine.name,
        predicted=1.0,
        measured=order,
        budget=ErrorBudget(numerical, model=model, resolution=0.02),
        parameters=parameters_of(FIG11),
        source=CYCLE.source,
        note=f"The change of the disc's state at t = {UNTIL:g} s; {at_each('inertia in kg m²', inertias)}. "
        "Numerical error: scatter about the power law, and the runs' own errors; model error: its next term.",
    )


def draw(data: Mapping[str, Data]) -> dict[str, Figure]:
    """Draw the radial motion of three cases in both engines, and the influence of the inertias."""
    found = data.get("exudyn", {})
    drawn = [name for name in list(CASES)[1:] if f"{name}: t" in found]
    if not drawn or "inertia" not in found:
        return {}
    figure, (radii, order) = new_figure(ncols=2, width=10.0, height=4.0, width_ratios=(1.5, 1.0))
    for name in drawn:
        times = found[f"{name}: t"]
        reference, mine = (np.hypot(*found[f"{name}: {key}"][:, :2].T) for key in ("reference", "states"))
        first = name == drawn[0]
        radii.plot(times, reference, **curve("reference", "reference" if first else "_", linewidth=1.6))
        radii.plot(times[::4], mine[::4], **points("exudyn", "drivetrain" if first else "_", markersize=4.0))
        radii.annotate(name, (times[-1], mine[-1]), xytext=(4, -3), textcoords="offset points", fontsize=9.0)
    radii.set(xlabel=axis("t", "s"), ylabel="radius of the disc's centre in m", ylim=(0.0, 0.05))
    radii.legend(loc="upper right", ncols=2)
    inertias, changes = found["inertia"], found["finite inertia"]
    order.loglog(inertias, changes, **points("exudyn", "drivetrain"))
    order.loglog(inertias, changes[0] * inertias[0] / inertias, color=BLACK, linewidth=0.8, label="slope −1")
    order.set(xlabel="inertia in kg m²", ylabel=f"change of the state at {UNTIL:g} s", ylim=(1e-4, 1e-2))
    order.set_xticks(inertias, [f"{inertia:g}" for inertia in inertias])
    order.minorticks_off()
    order.legend(loc="upper right")
    return {"drivetrain-reduced": figure}


STUDY = Study(
    name="drivetrain-reduced",
    title="The drivetrain, reduced to the paper's disc",
    section="The drivetrain",
    paper="The friction disc of (19) to (21) is what a dry clutch is between an engine and a vehicle that are too "
    "heavy to be slowed. So the model of a drivetrain must give its motion, with the facings, the support and the "
    "eccentric shaft that the drivetrain has: Figs. 8 and 11 inside of a larger model.",
    by_hand=measure,
    draw=draw,
    figures={
        "drivetrain-reduced": "Left: radial motion of the clutch disc in the drivetrain (marks) and of the "
        "reference's disc (lines), from the same start. Right: what changes in the modulated cycle where engine and "
        "vehicle have a finite inertia."
    },
    only=("exudyn",),
    seconds=4.5,
)
