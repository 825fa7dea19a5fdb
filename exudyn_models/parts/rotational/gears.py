"""Gears, planetary gears and differentials, with losses that stick exactly.

All are one mesh of two rotors in a carrier: (ω₁ − ω_c) = i·(ω₂ − ω_c). Friction of the mesh acts on the first rotor
relative to the carrier, and its limit is a share of the moment T of the mesh (``solver.rows.laws``).
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from exudyn_models.parts.rotational.couplings import RotorCoupling, add_coupling, freedoms_of, weights_of
from exudyn_models.solver.rows.laws import MeshLaw, Share
from reference_model.systems import FloatArray, finite_number, finite_numbers, shown

Efficiency = float | Sequence[float] | Sequence[Sequence[float]] | FloatArray
"""η in both directions; η and η'; or rows of |T| in N m, η and η', linear between and constant beyond them."""


def add_gear(
    mbs: Any,
    first: Any,
    second: Any,
    *,
    ratio: float,
    efficiency: Efficiency = 1.0,
    carrier: Any = None,
) -> RotorCoupling:
    """Add a gear, ω₁ − ω_c = ratio·(ω₂ − ω_c), to a model; return its handle.

    Its sensor ``"moment"`` is the moment T without losses on the first rotor. The second rotor receives −ratio·T. The
    lost moment acts between the first rotor and the carrier.

    Parameters
    ----------
    mbs : exudyn MainSystem
        Model, not yet assembled.
    first, second, carrier : NodeIndex or ObjectIndex
        Rotors, ``Node1D`` or their ``ObjectRotationalMass1D``; None is the ground.
    ratio : float
        Not zero; negative if the rotors turn against each other in the carrier.
    efficiency : float, sequence of two floats or table of shape (n, 3)
        0 < η <= 1 if the first rotor drives, and η' <= 1 if the second drives. With η' <= 0 the second rotor cannot
        drive, so the gear locks itself. A table has rows of increasing |T| in N m, η and η'.

    Raises
    ------
    ValueError
        If a number is out of range, or a rotor is invalid.

    """
    freedoms = freedoms_of(mbs, first=first, second=second, carrier=carrier)
    if (ratio := finite_number("ratio", ratio)) == 0.0:
        raise ValueError("ratio = 0: it must not be zero")
    table = _efficiencies(efficiency)
    law = MeshLaw(
        weights=weights_of(freedoms, (1.0, 0.0, -1.0)),
        data=mbs.systemData,
        constraint=weights_of(freedoms, (1.0, -ratio, ratio - 1.0)),
        lossless=bool((table[:, 1:] == 1.0).all()),
        preload=0.0,
        share=_share_of(table),
    )
    return add_coupling(mbs, freedoms, law)


def add_planetary(
    mbs: Any, sun: Any, carrier: Any, ring: Any, *, ratio: float, efficiency: Efficiency = 1.0
) -> RotorCoupling:
    """Add a planetary gear, (1 + ratio)·ω_carrier = ω_sun + ratio·ω_ring; return its handle.

    ``ratio`` > 0 is the number of teeth of the ring divided by the number of the sun. ``efficiency`` refers to the
    gear with a fixed carrier, as in ``add_gear``. Two planetary gears make a Ravigneaux gear: give the second, whose
    ``ratio`` is then negative, the same carrier and ring.
    """
    return add_gear(
        mbs, sun, ring, ratio=-finite_number("ratio", ratio), efficiency=efficiency, carrier=carrier
    )


def add_differential(
    mbs: Any, case: Any, left: Any, right: Any, *, preload: float = 0.0, ramp: float = 0.0
) -> RotorCoupling:
    """Add a differential, ω_left + ω_right = 2·ω_case; return its handle.

    Friction between both sides has the limit ``preload`` in N m plus ``ramp`` times the moment on the case. Both are
    >= 0; by default there is no friction. The sensor ``"moment"`` is half of the moment on the sides from the case.
    The sensor ``"friction"`` acts forward on the left and backward on the right.
    """
    freedoms = freedoms_of(mbs, case=case, left=left, right=right)
    for name, value in (("preload", preload), ("ramp", ramp)):
        if finite_number(name, value) < 0.0:
            raise ValueError(f"{name} = {value:g}: it must be >= 0")
    law = MeshLaw(
        weights=weights_of(freedoms, (0.0, 1.0, -1.0)),
        data=mbs.systemData,
        constraint=weights_of(freedoms, (-2.0, 1.0, 1.0)),
        lossless=preload == ramp == 0.0,
        preload=preload,
        share=lambda load, drives: 2.0 * ramp,
    )
    return add_coupling(mbs, freedoms, law)


def _efficiencies(efficiency: Efficiency) -> FloatArray:
    """Return rows of |T| in N m, η and η', shape (n, 3)."""
    numbers = finite_numbers("efficiency", efficiency)
    if numbers.ndim == 0:
        numbers = np.full(2, float(numbers))
    if numbers.shape == (2,):
        numbers = np.array([[0.0, *numbers]])
    if numbers.ndim != 2 or numbers.shape[1] != 3 or not len(numbers):
        raise ValueError(
            f"efficiency = {shown(efficiency)}: it must be a number, two numbers, or a table of shape (n, 3)"
        )
    loads, forward, backward = numbers.T
    if loads[0] < 0.0 or (np.diff(loads) <= 0.0).any():
        raise ValueError(
            f"efficiency = {shown(efficiency)}: moments in its first column must be >= 0 and increase"
        )
    if not ((forward > 0.0) & (forward <= 1.0) & (backward <= 1.0)).all():
        raise ValueError(
            f"efficiency = {shown(efficiency)}: it must be > 0 and <= 1 if the first rotor drives, and <= 1 otherwise"
        )
    return numbers


def _share_of(table: FloatArray) -> Share:
    """Return the share of |T| that friction has: 1/η − 1 if the first rotor drives, else 1 − η'."""
    loads, forward, backward = table.T
    if len(loads) == 1:
        shares = {True: float(1.0 / forward[0] - 1.0), False: float(1.0 - backward[0])}
        return lambda load, drives: shares[drives]

    def share(load: float, drives: bool) -> float:
        efficiency = float(np.interp(load, loads, forward if drives else backward))
        return 1.0 / efficiency - 1.0 if drives else 1.0 - efficiency

    return share
