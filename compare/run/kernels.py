"""All that is compiled when it is needed first: in an image, or on a node of a cluster, better beforehand."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from compare.claims.paper_parameters import FIG5, FIG11
from reference_model.systems import System

SYSTEMS: dict[str, System] = {
    "a pin": FIG5,
    "a disc on a ring": FIG11,
    "a disc on six points": replace(FIG11, contact_points=6),
}


def kernels() -> Iterator[tuple[str, Callable[[], Any]]]:
    """Yield what each is for, and what compiles it if it is not kept yet."""
    from exudyn_models import simulate as simulate_by_exudyn
    from reference_model import simulate

    for name, system in SYSTEMS.items():
        start = np.full(system.state_size, 0.01)
        yield f"runs of {name}", partial(simulate, system, start, (0.0, 0.1), compiled=True)
        yield f"{name} in Exudyn", partial(simulate_by_exudyn, system, start, (0.0, 0.01), tolerance=1e-6)
    yield from _friction_on_pairs()


def _friction_on_pairs() -> Iterator[tuple[str, Callable[[], Any]]]:
    """Yield the user functions for friction; they differ by the number of coordinates, and by whether μN is one."""
    from exudyn_models.forces.slip_kinematics import GROUND, PLANAR, ROTOR, TAIT_BRYAN

    names = {GROUND: "the ground", ROTOR: "rotor", PLANAR: "planar body", TAIT_BRYAN: "body in space"}
    for kinds in (
        (GROUND, ROTOR),
        (ROTOR, ROTOR),
        (GROUND, PLANAR),
        (GROUND, TAIT_BRYAN),
        (ROTOR, PLANAR),
        (ROTOR, TAIT_BRYAN),
        (PLANAR, ROTOR),
        (PLANAR, PLANAR),
        (PLANAR, TAIT_BRYAN),
        (TAIT_BRYAN, TAIT_BRYAN),
    ):
        between = f"friction between {names[kinds[0]]} and {names[kinds[1]]}"
        yield between, partial(_call_both, kinds, 0.1)
        yield f"{between}, of the slip", partial(_call_both, kinds, [[0.0, 0.1], [1.0, 0.1]])


def _call_both(kinds: tuple[int, int], coefficient: Any) -> None:
    """Call force and Jacobian, which compiles them."""
    from exudyn_models.forces.friction_laws import CONTINUOUS, NONE_HELD
    from exudyn_models.forces.load_and_coefficient import LoadAndCoefficient
    from exudyn_models.forces.slip_kinematics import SIZES
    from exudyn_models.forces.user_functions import force_and_jacobian

    size = SIZES[kinds[0]] + SIZES[kinds[1]]
    ring = 0.1, CONTINUOUS, 1.0, 1e-3, NONE_HELD, 0.1
    force, jacobian = force_and_jacobian(kinds, np.zeros(size), LoadAndCoefficient(ring, coefficient, 1.0))
    motion = None, 0.0, 0, [0.1] * size, [0.1] * size
    force(*motion)
    jacobian(*motion, 0.0, 1.0)
