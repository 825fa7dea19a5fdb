"""Discs that slide and spin on a plane at rest: a ring, points and a full disc."""

import cmath
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from compare.claims import ByEngine, Figures, Measured, Study, refined
from compare.engines import DeclaredLackError, Engine
from compare.output.figures import axis, curve, engines_in, new_figure, points
from compare.studies.toolkit.free_bodies import on_a_table
from compare.studies.toolkit.random_systems import state_of
from reference_model import simulate
from reference_model.contact.annulus import Annulus
from reference_model.systems import DiscOnDisc, FloatArray

SOURCE = "assumption: a disc of 1 kg and 0.1 m with friction of 1 N"

MASS, RADIUS, FRICTION = 1.0, 0.1, 1.0
"""m in kg, R in m and μN in N."""

DECELERATION = FRICTION / MASS
"""g in m/s² of a disc that only slides."""

SPEED = 1.0
"""Initial speed (m/s) of the centre, the rim or both."""

HEADING = 0.7
"""Direction in rad from the x axis."""


@dataclass(frozen=True)
class Throw:
    """A throw with uniform deceleration, of a disc with the inertia J/(mR²).

    ``sliding`` and ``rim`` are the initial U and W (m/s); W has the sign of the spin. ``force`` and ``moment`` of
    friction are shares of μN and μNR.
    """

    name: str
    inertia: float
    sliding: float
    rim: float
    force: float = 0.0
    moment: float = 0.0

    def disc(self, contact_points: int | None = None) -> DiscOnDisc:
        """Return the disc."""
        return on_a_table(MASS, self.inertia, RADIUS, FRICTION, contact_points)

    @property
    def state(self) -> FloatArray:
        """Initial state, shape (6,)."""
        return state_of(0j, cmath.rect(self.sliding, HEADING), spin=self.rim / RADIUS)

    @property
    def time(self) -> float:
        """Time to rest (s)."""
        if self.sliding > 0.0:
            return self.sliding / (DECELERATION * self.force)
        return abs(self.rim) * self.inertia / (DECELERATION * self.moment)

    def seen_at(self, shares: FloatArray) -> FloatArray:
        """Return distances along, across and of the rim (m) and their speeds at ``shares`` of ``time``, (n, 6)."""
        share = np.minimum(shares, 1.0)[:, np.newaxis]
        start = np.array([self.sliding, 0.0, self.rim])
        return np.hstack((start * self.time * (share - 0.5 * share**2), start * (1.0 - share)))


RING = (
    Throw("slides", 0.5, SPEED, 0.0, force=1.0),
    Throw("spins", 0.5, 0.0, -SPEED, moment=1.0),
    Throw("both", 1.0, SPEED, SPEED, force=2.0 / math.pi, moment=2.0 / math.pi),
)
"""Throws of a ring; if U = W, the share |cos χ/2| of the friction at the point χ acts along U, on average 2/π."""

POINTS: Mapping[int, tuple[Throw, ...]] = {3: RING[:2], 6: RING[:2]}
"""Throws by number of points; combined sliding and spinning has no closed form."""

FULL = (
    Throw("slides", 0.5, SPEED, 0.0, force=1.0),
    Throw("spins", 0.5, 0.0, -SPEED, moment=2.0 / 3.0),
    Throw("both", 1.0 / 3.0, SPEED, SPEED, force=8.0 / (3.0 * math.pi), moment=8.0 / (9.0 * math.pi)),
)
"""Throws of a full disc.

The force is (4/3π)·((1 + ε²)·E − (1 − ε²)·K)/ε, with the modulus ε = U/W of E and K (Farkas et al. 2003). It is 8/3π
at ε = 1.
"""

TO_REST = np.array([0.0, 0.5, 1.25])
"""Sample times as shares of the time to rest."""

WHILE_SLIDING = np.array([0.0, 0.5, 0.9])
"""Sample times of a full disc, which a regularised law need not bring to rest."""


# --- A full disc under uniform pressure

EPSILON = 100.0
"""Regularisation ε of Exudyn's part, divided by tolerance and speed; its effect on a sliding disc is of order ε²."""


def by_contact_law(throw: Throw, times: FloatArray, tolerance: float) -> FloatArray:
    law = Annulus(0.0, RADIUS)
    return np.asarray(simulate(throw.disc(), throw.state, times, tolerance=tolerance, contact=law).states)


def by_part(throw: Throw, times: FloatArray, tolerance: float) -> FloatArray:
    import exudyn_models
    from exudyn_models.solver.solver_run import solve

    def full(mbs: Any, master_node: Any, disc_node: Any, **contact: Any) -> Any:
        circle = {"contact_radius": None, "inner_radius": 0.0, "outer_radius": RADIUS}
        return exudyn_models.add_ring_friction(mbs, master_node, disc_node, **contact | circle)

    epsilon, state, states = EPSILON * tolerance * SPEED, throw.state, [throw.state]
    for span in np.diff(times).tolist():
        model = exudyn_models.build_model(throw.disc(), state, regularisation=epsilon, friction=full)
        steps = solve(model, 0.0, span, integrator="DOPRI5", step=span, tolerance=0.01 * tolerance)
        state = steps.states[-1]
        states.append(state)
    return np.array(states)


Follow = Callable[[Throw, FloatArray, float], FloatArray]
"""Function of a throw, times and a tolerance that returns states."""

FULL_DISCS: Mapping[str, tuple[Follow, float]] = {
    "reference": (by_contact_law, 1e-12),
    "exudyn": (by_part, 4e-10),
}
"""Function of each engine, and the quadrature error of its friction over μN, which the contact's module documents."""


STUDY = Study.beside(__file__, "thrown-disc", source=SOURCE, seconds=1.0, quick=True, contact=True)

SEEN = (
    "distance along in m",
    "distance across in m",
    "distance of the rim in m",
    "speed along in m/s",
    "speed across in m/s",
    "speed of the rim in m/s",
)


def in_engine(engine: Engine, points: int | None = None) -> Follow:
    def follow(throw: Throw, times: FloatArray, tolerance: float) -> FloatArray:
        return engine.simulate(throw.disc(points), throw.state, times, tolerance=tolerance).states

    return follow


def compared(
    follow: Follow,
    throws: Sequence[Throw],
    shares: FloatArray,
    name: str,
    *,
    points: int | None = None,
    error: float = 0.0,
) -> Measured:
    """Compare throws with the closed form at ``shares`` of the time to rest.

    ``name`` is the key in the figure's data, and ``error`` the error of friction over μN.
    """
    found = refined(
        lambda tolerance: np.array(
            [seen(follow(throw, throw.time * shares, tolerance)[1:]) for throw in throws]
        )
    )
    return Measured(
        predicted=[throw.seen_at(shares[1:]) for throw in throws],
        value=found.value,
        error=found.largest + error * SPEED,  # friction removes the whole speed
        at={"throw": [throw.name for throw in throws], "t over the time to rest": shares[1:]},
        components=SEEN,
        system=throws[0].disc(points),
        data={f"{name}: speeds": found.value[:, :, [3, 5]]},
    )


def seen(states: FloatArray) -> FloatArray:
    """Return distances (m) and speeds (m/s) along and across the throw and of the rim, shape (n, 6)."""
    z, v = (states[:, (0, 3)] + 1j * states[:, (1, 4)]).T * cmath.rect(1.0, -HEADING)
    rim = RADIUS * states[:, (2, 5)]
    return np.column_stack((z.real, z.imag, rim[:, 0], v.real, v.imag, rim[:, 1]))


@STUDY.claim(
    "Friction is μN on a sliding ring, μNR on a spinning ring, and 2/π of both if the ring slides and spins",
    equation="(19), (20)",
    unit="m, m/s",
    resolution=1e-6,
    note="Uniform deceleration to rest. A ring that slides and spins has J = mR², and its rim is as fast as "
    "its centre.",
    swept=("polar_inertia",),
)
def on_ring(engine: Engine) -> Measured:
    return compared(in_engine(engine), RING, TO_REST, "ring")


@STUDY.claim(
    "Friction is μN on a sliding disc on {} points, and μNR on a spinning disc",
    equation="(19), (21)",
    unit="m, m/s",
    resolution=1e-6,
    note="Uniform deceleration to rest.",
    swept=("polar_inertia",),
    each={str(points): points for points in POINTS},
)
def on_points(engine: Engine, points: int) -> Measured:
    return compared(in_engine(engine, points), POINTS[points], TO_REST, f"{points} points", points=points)


@STUDY.claim(
    "Friction is μN on a sliding full disc, ⅔·μNR on a spinning one, and less of both if the disc does both",
    equation="(19), (20)",
    unit="m, m/s",
    resolution=1e-6,
    note="Contact under uniform pressure within R. Uniform deceleration, sampled until nine tenths of the time to "
    "rest. A disc that slides and spins has J = mR²/3, and its rim is as fast as its centre; the force is "
    "then 8/3π·μN and "
    "the moment 8/9π·μNR.",
    swept=("polar_inertia",),
)
def on_full_disc(engine: Engine) -> Measured:
    if engine.name not in FULL_DISCS:
        raise DeclaredLackError(f"{engine.name} has no model of a full disc")
    follow, quadrature = FULL_DISCS[engine.name]
    return compared(follow, FULL, WHILE_SLIDING, "full disc", error=quadrature)


TAKEN = {
    "ring": (r"slides: $\mu N$", r"spins: $\mu NR$", r"both: $\frac{2}{\pi}$ of each"),
    "full disc": (
        r"slides: $\mu N$",
        r"spins: $\frac{2}{3}\,\mu NR$",
        r"both: $\frac{8}{3\pi}\,\mu N$, $\frac{8}{9\pi}\,\mu NR$",
    ),
}
"""Labels with the friction of each throw."""

DASHES = ("-", "--", (0.0, (1.0, 1.5)))


def draw(data: ByEngine) -> Figures:
    if not data:
        return {}
    figure, panels = new_figure(ncols=2, width=9.6, height=3.8, sharey=True)
    for panel, name, throws, shares in zip(
        panels, ("ring", "full disc"), (RING, FULL), (TO_REST, WHILE_SLIDING), strict=True
    ):
        for throw, taken, dashes in zip(throws, TAKEN[name], DASHES, strict=True):
            speeds = (max(throw.sliding, abs(throw.rim)), 0.0, 0.0)
            look = curve("theory", taken, linestyle=dashes, linewidth=1.2)
            panel.plot((0.0, throw.time, 1.3 * throw.time), speeds, **look)
        for engine in engines_in(data):
            if f"{name}: speeds" not in data[engine]:
                continue
            label = engine
            for throw, speeds in zip(throws, data[engine][f"{name}: speeds"], strict=True):
                panel.plot(throw.time * shares[1:], np.max(np.abs(speeds), axis=1), **points(engine, label))
                label = ""
        panel.set(xlabel=axis("t", "s"), title=f"Contact on a {name}")
        panel.legend(loc="upper right")
    panels[0].set_ylabel("speed in m/s")
    return {"thrown-disc": figure}


STUDY.provides(figures=draw)
