"""A full disc under uniform pressure, by those who have it: the reference's contact law, and Exudyn's part."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from compare.engines import Engine, UnsupportedSystemError
from compare.studies.plane.thrown_disc.parameters import RADIUS, SPEED, Throw
from reference_model import simulate
from reference_model.contact.annulus import Annulus
from reference_model.systems import FloatArray

EPSILON = 100.0
"""ε of the part over tolerance and speed; what it changes of a sliding disc is of the size ε²."""


def by_contact_law(throw: Throw, times: FloatArray, tolerance: float) -> FloatArray:
    """Return the states of a throw at ``times``, shape (n, 6), from the reference."""
    law = Annulus(0.0, RADIUS)
    return np.asarray(simulate(throw.disc(), throw.state, times, tolerance=tolerance, contact=law).states)


def by_part(throw: Throw, times: FloatArray, tolerance: float) -> FloatArray:
    """Return the states of a throw at ``times``, shape (n, 6), from a model of Exudyn with the part."""
    import exudyn_models
    from exudyn_models.solver.solver_run import solve

    def full(mbs: Any, master_node: Any, disc_node: Any, **contact: Any) -> Any:
        circle = {"contact_radius": None, "inner_radius": 0.0, "outer_radius": RADIUS}
        return exudyn_models.add_ring_friction(mbs, master_node, disc_node, **contact | circle)

    epsilon, state, states = EPSILON * tolerance * SPEED, throw.state, [throw.state]
    for span in np.diff(times).tolist():
        model = exudyn_models.build_disc_on_disc(throw.disc(), state, regularisation=epsilon, friction=full)
        steps = solve(model, 0.0, span, integrator="DOPRI5", step=span, tolerance=0.01 * tolerance)
        state = steps.states[-1]
        states.append(state)
    return np.array(states)


@dataclass(frozen=True)
class Way:
    """How an engine follows a full disc, and how well it sums up the friction of its rings, over μN."""

    follow: Callable[[Throw, FloatArray, float], FloatArray]
    quadrature: float


WAYS: Mapping[str, Way] = {"reference": Way(by_contact_law, 1e-12), "exudyn": Way(by_part, 4e-10)}
"""By the name of the engine; ``Annulus`` and ``exudyn_models.forces.slip_potential`` tell the errors."""


def way_of(engine: Engine) -> Way:
    """Return how ``engine`` follows a full disc; raise ``UnsupportedSystemError`` where it does not."""
    if engine.name not in WAYS:
        raise UnsupportedSystemError(f"{engine.name} is not asked for a full disc, which no engine promises")
    return WAYS[engine.name]
