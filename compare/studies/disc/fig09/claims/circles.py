"""The whirl without offset, which is a circle in axes that turn with it."""

from __future__ import annotations

import numpy as np

from compare.claims.measured import Measured
from compare.engines import Engine
from compare.studies.disc.fig09.claims.searches import circles_of, extrapolated
from compare.studies.disc.fig09.claims.study import STUDY
from compare.studies.disc.fig09.theory import (
    CENTRED,
    CIRCLES,
    ORDERS,
    PAPER_LAW,
    RING,
    SOURCE_CENTRED,
    circle_of,
    radius_of_pin,
    spin_of_large_whirl,
)
from compare.studies.toolkit.self_centred import with_load
from reference_model.steady.steady_states import whirls
from reference_model.systems import FloatArray

LOADS = [load for load, _ in CIRCLES]

OBSERVED = (
    "Orders of the distance in radius and spin, extrapolated; model error: the extrapolation's own step. The limit "
    "of the spin, ω − b(ω − Ω)/(b + R²βk/(2(ω − k))) = "
    f"{spin_of_large_whirl(RING):.6f} rad/s, follows from F = 1 and M = RW/(2U). Friction forces: "
    f"{', '.join(f'{load:g}' for load in LOADS[ORDERS])} N."
)


@STUDY.claim(
    "Without offset the whirl has radius, frequency and spin of the three balances, stable or not",
    equation="(19), (20)",
    resolution=1e-6,
    note="In units of μN/(βk), k and ω; the second of the two at the same μN is unstable. Measured: the state that "
    "the engine itself brings back, turned about the axis. Predicted: radial, tangential and torsional balance on "
    "the continuous ring.",
    basis="reference",
    swept=("friction_force",),
)
def circles(engine: Engine) -> Measured:
    """Compare the circles that come back with the three balances."""
    found = circles_of(engine, CENTRED)
    exact = [(load, circle_of(load, which)) for load, which in CIRCLES]
    return Measured(
        predicted=[
            (
                one.radius / radius_of_pin(load),
                one.frequency / RING.natural_frequency,
                one.spin / RING.disc_speed,
            )
            for load, one in exact
        ],
        value=found.value,
        error=found.error,
        at={"μN in N": LOADS},
        components=("radius", "frequency", "spin"),
        system=CENTRED,
        source=SOURCE_CENTRED,
        data={"circle load": LOADS, "circle": found.value},
    )


@STUDY.claim(
    "The error of (23) falls like (μN)⁻⁴ in the whirl's radius, and like (μN)⁻² in its spin",
    equation="(23)",
    kind="order",
    resolution=0.1,
    note=OBSERVED,
    implied_by=circles,
    swept=("friction_force",),
)
def error_of_23(engine: Engine) -> Measured:
    """Observe how the whirl differs from that of (23), at friction forces each twice the one before."""
    by_23 = [(load, whirls(with_load(CENTRED, load), PAPER_LAW)[0]) for load in LOADS[ORDERS]]
    return _orders(
        engine,
        [(one.radius / radius_of_pin(load), one.spin / RING.disc_speed) for load, one in by_23],
        (-4.0, -2.0),
    )


@STUDY.claim(
    "The whirl's radius tends to the pin's μN/(βk), its spin to a limit without μN, both like (μN)⁻²",
    equation="(11)",
    kind="order",
    resolution=0.1,
    note=OBSERVED,
    implied_by=circles,
    swept=("friction_force",),
)
def limit_of_large_loads(engine: Engine) -> Measured:
    """Observe how the whirl tends to its limit, at friction forces each twice the one before."""
    limit = (1.0, spin_of_large_whirl(RING) / RING.disc_speed)
    return _orders(engine, [limit] * len(LOADS[ORDERS]), (-2.0, -2.0))


def _orders(engine: Engine, others: list[tuple[float, float]], orders: tuple[float, float]) -> Measured:
    """Compare ``orders`` in the friction force with those in which radius and spin come near to ``others``."""
    found = circles_of(engine, CENTRED)
    gaps: FloatArray = np.abs(found.value[ORDERS][:, [0, 2]] - others)
    observed, numerical, model = extrapolated(gaps, found.error[ORDERS][:, :1])
    return Measured(
        predicted=orders,
        value=-observed,
        error=numerical,
        model=model,
        components=("radius", "spin"),
        system=CENTRED,
        source=SOURCE_CENTRED,
    )
