"""The friction force μN in compiled code, where μ or N is a table or a function."""

from __future__ import annotations

import math
from typing import Any

import numba

from exudyn_models.forces.jit import Floats, compiled
from exudyn_models.forces.laws.calls import python_function, result_at, result_of_python
from exudyn_models.forces.laws.curves import coefficient_of_curve, peak_over_sliding
from exudyn_models.forces.laws.functions import LawFunction
from reference_model.systems import FloatArray

NUMBERS = 8

_types: Any = numba.types  # not fully typed
_floats: Any = Floats

LAW = _types.Tuple((_floats(_types.float64, NUMBERS), *[python_function] * 4))
"""Type of the result of ``law_of`` in compiled code."""

Law = tuple[list[float], Any, Any, Any, Any]
"""Numbers, then two functions, each followed by one that reports an error in its result."""

ABSENT = -1.0
"""Marks the arguments of an absent function."""


def law_of(
    constant: float,
    static_ratio: float,
    curve: FloatArray | None,
    coefficient: LawFunction | None,
    load: LawFunction | None,
) -> Law:
    """Return a law for ``friction_force_under``; ``constant`` is the product of the factors that are numbers."""
    numbers = [constant, static_ratio]
    numbers += [0.0, 0.0] if curve is None else [float(curve.ctypes.data), float(len(curve))]
    functions: list[Any] = []
    for function, instead in ((coefficient, curve), (load, None)):
        numbers += [ABSENT, 0.0] if function is None else [function.places, function.address]
        # The curve must live as long as its address.
        functions += [instead, None] if function is None else [function.positional, function.checked]
    first, its_check, second, seconds_check = functions
    return numbers, first, its_check, second, seconds_check


@compiled
def friction_force_under(
    law: Law, epsilon: float, t: float, radius: float, slip_speed: float, relative_spin: float
) -> float:
    """Return the friction force in N at the time t in s, for a motion as in ``ARGUMENTS`` and ε in m/s.

    Raises ``ValueError`` unless a function returns a finite number >= 0.
    """
    numbers, coefficient, checked_coefficient, load, checked_load = law
    constant, static_ratio, curve, pieces, of_coefficient, its_address, of_load, loads_address = numbers
    motion = t, radius, slip_speed, relative_spin
    force = constant
    if pieces > 0.0:
        force *= coefficient_of_curve(curve, pieces, slip_speed)
    force *= _factor(coefficient, checked_coefficient, of_coefficient, its_address, motion)
    force *= _factor(load, checked_load, of_load, loads_address, motion)
    if static_ratio > 1.0:
        force *= peak_over_sliding(slip_speed / epsilon, static_ratio)
    return force


@compiled
def _factor(
    function: Any, checked: Any, places: float, address: float, motion: tuple[float, float, float, float]
) -> float:
    if places == ABSENT:
        return 1.0
    if address != 0.0:
        result: float = result_at(address, motion[0], motion[1], motion[2], motion[3])
    else:
        result = result_of_python(function, int(places), motion[0], motion[1], motion[2], motion[3])
    if 0.0 <= result < math.inf:
        return result
    told: float = result_of_python(checked, 15, motion[0], motion[1], motion[2], motion[3])
    return told
