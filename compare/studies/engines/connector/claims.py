"""The friction connectors of the Exudyn models on their own: what they exchange, and how they are linearised.

Two discs that nothing else touches move and spin in the plane, one on the other. Friction between them is inner
force: it changes neither their momentum nor their angular momentum, wherever it acts. A connector that forgets the
moment of its force about one of the two bodies fails here; where the master's speed is prescribed nothing shows.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from compare.claims.error_estimates import ROUNDING
from compare.claims.linearised_flow import eigenvalues_with_rounding, matched, real_and_imaginary
from compare.claims.measured import Measured
from compare.claims.paper_parameters import FIG5, FIG8, FIG11
from compare.claims.study import Study
from compare.engines import Engine, UnsupportedSystemError
from compare.studies.engines.connector.model import momenta, two_discs
from compare.studies.engines.connector.parameters import EPSILON, FRICTION, RADIUS, RESOLUTION, STEPS, UNTIL
from compare.studies.engines.connector.pictures import draw
from reference_model import self_centred_equilibria
from reference_model.steady.stability import jacobian_without_angle

STUDY = Study.beside(
    __file__,
    "connector",
    source="two free discs, an assumption",
    draw=draw,
    only=("exudyn", "exudyn-native"),
    seconds=0.3,
    contact=True,
)

NATIVE = "exudyn-native"

LACKING = "the built-in contact has single points only, and Exudyn linearises it by differences"
"""What keeps ``NATIVE`` from the claims about the ring and about the linearisation."""

NOTE = (
    "Momentum in x and y, and angular momentum, each over the largest part of one body. "
    f"Exudyn's RK67 with {STEPS} steps; numerical error: the change with half of them."
)


@STUDY.claim(
    "Friction between two free discs keeps their momentum and angular momentum: ring",
    kind="conservation",
    resolution=RESOLUTION,
    note=NOTE,
)
def ring(engine: Engine) -> Measured:
    """Let two free discs rub on each other on the continuous ring."""
    from exudyn_models import add_ring_friction

    if engine.name == NATIVE:
        raise UnsupportedSystemError(LACKING)
    return _drift("ring", partial(add_ring_friction, contact_points=None))


@STUDY.claim(
    "Friction between two free discs keeps their momentum and angular momentum: six points",
    kind="conservation",
    resolution=RESOLUTION,
    note=NOTE,
)
def six_points(engine: Engine) -> Measured:
    """Let two free discs rub on each other on six points."""
    from exudyn_models import add_native_friction, add_ring_friction

    if engine.name == NATIVE:
        return _drift("six points", partial(add_native_friction, contact_points=6, reach=2.0 * UNTIL))
    return _drift("six points", partial(add_ring_friction, contact_points=6))


def _drift(contact: str, add_friction: Callable[..., Any]) -> Measured:
    times, states = two_discs(add_friction, STEPS)
    _, coarse = two_discs(add_friction, STEPS // 2)
    each = momenta(states)
    total, change = each.sum(axis=-2), np.abs(momenta(coarse).sum(axis=-2)[-1] - each.sum(axis=-2)[-1])
    scale = np.max(np.abs(each))
    return Measured(
        predicted=total[0] / scale,
        value=total[-1] / scale,
        error=change / scale + ROUNDING,
        components=("momentum along x", "momentum along y", "angular momentum"),
        parameters={
            "friction_force": FRICTION,
            "contact_radius": RADIUS,
            "contact": contact,
            "regularisation": EPSILON,
        },
        note=f"The largest part is {scale:.3g} in SI units.",
        data={
            f"{contact}: t": times,
            f"{contact}: angular momenta": each[..., 2],
            f"{contact}: drift": np.max(np.abs(total - total[0]), axis=-1) / scale,
        },
    )


@STUDY.claim(
    "Exudyn's own linearisation at the equilibrium gives the eigenvalues of the equations of motion",
    unit="1/s",
    resolution=1e-8,
    note="Real and imaginary parts of 4, 5 and 5 eigenvalues. Numerical error: rounding of both eigenvalue "
    "problems, by the condition of each eigenvalue.",
)
def linearised(engine: Engine) -> Measured:
    """Compare the eigenvalues at three equilibria with those of the Jacobian."""
    from exudyn_models import eigenvalues

    if engine.name == NATIVE:
        raise UnsupportedSystemError(LACKING)
    rotating = replace(FIG11, friction_force=0.015)
    measured, predicted, rounding, names = [], [], [], []
    for figure, system in (("Fig. 5", FIG5), ("Fig. 8", FIG8), ("Fig. 11", rotating)):
        (equilibrium,) = self_centred_equilibria(system)
        values, errors = eigenvalues_with_rounding(jacobian_without_angle(system, equilibrium.state))
        measured.append(matched(eigenvalues(system, equilibrium.state), values))
        predicted.append(values)
        rounding.append(errors)
        names += [f"{i} of {figure}" for i in range(1, len(values) + 1)]
    found, expected, error = (np.concatenate(parts) for parts in (measured, predicted, rounding))
    return Measured(
        predicted=real_and_imaginary(expected),
        value=real_and_imaginary(found),
        error=2.0 * np.column_stack((error, error)),
        at={"eigenvalue": names},
        components=("real part", "imaginary part"),
        system=FIG8,
        source="Fig. 5's pin, Fig. 8's disc, and Fig. 11's disc rotating on the axis with μN = 0.015 N",
    )
