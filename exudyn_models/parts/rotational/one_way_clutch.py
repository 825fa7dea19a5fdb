"""One-way clutches, also called freewheels."""

from typing import Any

from exudyn_models.parts.rotational.couplings import RotorCoupling, add_coupling, freedoms_of, weights_of
from exudyn_models.solver.rows.laws import OneWayLaw


def add_one_way_clutch(mbs: Any, driver: Any, driven: Any) -> RotorCoupling:
    """Add a one-way clutch to a model; return its handle.

    The ``driven`` rotor may be faster than the ``driver``, but never slower: the clutch then locks, with any positive
    moment on the driven rotor. If the driven rotor is slower at the start, an impact equalises both speeds. Rotors as
    in ``add_gear``; None is the ground.
    """
    freedoms = freedoms_of(mbs, driver=driver, driven=driven)
    return add_coupling(
        mbs, freedoms, OneWayLaw(weights=weights_of(freedoms, (-1.0, 1.0)), data=mbs.systemData)
    )
