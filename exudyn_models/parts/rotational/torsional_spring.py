"""Torsional springs with backlash."""

from typing import Any

from exudyn_models.parts.rotational.couplings import RotorCoupling, add_coupling, freedoms_of, weights_of
from exudyn_models.solver.rows.backlash import Backlash
from reference_model.systems import finite_number, positive_number


def add_torsional_spring(
    mbs: Any, first: Any, second: Any, *, stiffness: float, damping: float = 0.0, backlash: float
) -> RotorCoupling:
    """Add a torsional spring with backlash to a model; return its handle.

    Within the ``backlash``, a total clearance in rad > 0, it transmits nothing. Beyond it, spring (``stiffness`` > 0
    in N m/rad) and damper (``damping`` >= 0 in N m s/rad) push together, but never pull. ``solve_dynamic`` locates
    each contact and separation with implicit solvers. Rotors as in ``add_gear``.

    Several springs between the same rotors make a clutch damper with stages. ``add_ring_friction`` adds hysteresis.
    """
    freedoms = freedoms_of(mbs, first=first, second=second)
    if (damping := finite_number("damping", damping)) < 0.0:
        raise ValueError(f"damping = {damping:g} N m s/rad: it must be >= 0")
    references = [0.0 if freedom is None else freedom.reference for freedom in freedoms]
    law = Backlash(
        weights=weights_of(freedoms, (-1.0, 1.0)),
        data=mbs.systemData,
        stiffness=positive_number("stiffness", stiffness, "N m/rad"),
        damping=damping,
        clearance=positive_number("backlash", backlash, "rad"),
        middle=references[1] - references[0],
    )
    return add_coupling(mbs, freedoms, law)
