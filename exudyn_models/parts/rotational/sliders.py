"""Friction along one slip of rotors and sliders: a slider on its guide, a belt on its pulley, a tyre on the road."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from exudyn_models.forces.axial_pairs import ON_ONE_AXIS
from exudyn_models.forces.friction_laws import CONTINUOUS, NONE_HELD
from exudyn_models.forces.load_and_coefficient import Coefficient, LoadAndCoefficient, NumberOrFunction
from exudyn_models.parts.ring_friction import UNREGULARISED, checked_growth, law_on_axis
from exudyn_models.parts.rotational.couplings import RotorCoupling, add_coupling, freedoms_of, weights_of
from reference_model.systems import finite_number, positive_number


def add_slider_friction(
    mbs: Any,
    first: Any,
    second: Any,
    *,
    friction_coefficient: Coefficient,
    normal_load: NumberOrFunction,
    first_radius: float = 1.0,
    second_radius: float = 1.0,
    static_ratio: float = 1.0,
    load_gain: float | Sequence[float] = 0.0,
    load_part: Any = None,
) -> RotorCoupling:
    """Add friction along the slip v = q̇₂·R₂ − q̇₁·R₁ that sticks exactly; return its handle.

    The friction exerts F·R₂ on the second and −F·R₁ on the first freedom. The sensor ``"moment"`` is F in N, and
    ``"relative_spin"`` is v in m/s.

    Parameters
    ----------
    mbs : exudyn MainSystem
        Model, not yet assembled.
    first, second : NodeIndex, ObjectIndex or MarkerIndex
        Freedoms: a ``Node1D`` or its ``ObjectMass1D`` or ``ObjectRotationalMass1D``, or a ``MarkerNodeCoordinate`` of
        a position or an angle about a fixed axis. None is the ground.
    friction_coefficient, normal_load, static_ratio, load_gain, load_part
        Those of ``add_ring_friction``.
    first_radius, second_radius : float
        R in m of a rotor, of either sign; 1 for a position.

    Raises
    ------
    ValueError
        If a number is out of range, or a freedom is invalid.

    """
    freedoms = freedoms_of(mbs, first=first, second=second)
    radii = finite_number("first_radius", first_radius), finite_number("second_radius", second_radius)
    geometry = 1.0, CONTINUOUS, 1.0, UNREGULARISED, NONE_HELD, 1.0
    factors = LoadAndCoefficient(geometry, friction_coefficient, normal_load, static_ratio)
    weights, growth = weights_of(freedoms, (-radii[0], radii[1])), checked_growth(mbs, load_gain, load_part)
    law = law_on_axis(growth)(
        ON_ONE_AXIS[0],
        factors.without_peak(),
        weights=weights,
        reference=np.zeros(len(weights)),
        static_ratio=factors.static_ratio,
        **growth,
    )
    return add_coupling(mbs, freedoms, law)


def add_tyre(
    mbs: Any,
    wheel: Any,
    vehicle: Any,
    *,
    radius: float,
    friction_coefficient: Coefficient,
    normal_load: NumberOrFunction,
    static_ratio: float = 1.0,
) -> RotorCoupling:
    """Add a tyre with limited friction between a wheel and a vehicle; return the handle of ``add_slider_friction``.

    ``vehicle`` is the position of an ``ObjectMass1D``, ``radius`` > 0 that of the wheel in m. The tyre rolls without
    slip until the force exceeds static friction. If the coefficient depends on ``slip_speed`` in m/s, the force
    follows this slip curve. ``friction_coefficient``, ``normal_load`` and ``static_ratio`` are those of
    ``add_ring_friction``.
    """
    return add_slider_friction(
        mbs,
        wheel,
        vehicle,
        friction_coefficient=friction_coefficient,
        normal_load=normal_load,
        first_radius=positive_number("radius", radius, "m"),
        static_ratio=static_ratio,
    )
