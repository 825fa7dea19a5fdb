"""The friction force μN in compiled code, where μ or N is a table or a function."""

import math
from typing import Any

import numba
import numpy as np

from exudyn_models.forces.jit import compiled
from exudyn_models.forces.laws.calls import number_at, python_objects, result_at, result_of_python
from exudyn_models.forces.laws.curves import coefficient_of_curve, peak_over_sliding
from exudyn_models.forces.laws.functions import LawFunction, bits_of
from reference_model.systems import FloatArray

_types: Any = numba.types  # not fully typed

LAW = _types.Tuple((_types.float64, python_objects))
"""Type of the result of ``law_of`` in compiled code."""

READS = 8
"""Place of the arguments of all factors, as bits, in the numbers of a law."""

Law = tuple[float, tuple[Any, ...]]
"""Address of numbers, and objects: two functions, each followed by a function that reports an error in its result."""

ABSENT = -1.0
"""Marks the arguments of an absent function."""

DIFFERENCE = 1e-5
"""Relative step of the central differences of μN."""

SLOWEST = 1e-9
"""Slip speed in m/s below which this step stays constant."""

AT_REST = 1e-200
"""Relative spin in rad/s of a contact at rest that is about to slide."""


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
    for function in (coefficient, load):
        numbers += [ABSENT, 0.0] if function is None else [function.places, function.address]
        functions += [None, None] if function is None else [function.positional, function.checked]
    reads = {name for function in (coefficient, load) if function for name in function.arguments}
    if static_ratio > 1.0 or curve is not None:
        reads.add("slip_speed")
    table = np.array([*numbers, bits_of(reads)])
    return float(table.ctypes.data), (*functions, table, curve)  # arrays live as long as their addresses


@compiled
def friction_force_under(
    law: Law, epsilon: float, t: float, radius: float, slip_speed: float, relative_spin: float
) -> float:
    """Return the friction force in N at the time t in s, for a motion as in ``ARGUMENTS`` and ε in m/s.

    Raises ``ValueError`` unless a function returns a finite number >= 0.
    """
    numbers, _ = law
    motion = t, radius, slip_speed, relative_spin
    force, static_ratio, pieces = number_at(numbers, 0), number_at(numbers, 1), number_at(numbers, 3)
    if pieces > 0.0:
        force *= coefficient_of_curve(number_at(numbers, 2), pieces, slip_speed)
    for which in range(2):
        force *= _factor(law, which, motion)
    if static_ratio > 1.0:
        force *= peak_over_sliding(slip_speed / epsilon, static_ratio)
    return float(force)


@compiled
def friction_force_slopes(
    law: Law, epsilon: float, rim: float, t: float, radius: float, slip_speed: float, relative_spin: float
) -> tuple[float, float, float]:
    """Return ∂(μN)/∂(radius, slip speed, relative spin) in N/m, N s/m and N s, by central differences.

    ``rim`` is the largest radius of the contact in m. The other arguments are the same as in
    ``friction_force_under``.
    """
    motion, slowest = (radius, slip_speed, relative_spin), max(epsilon, SLOWEST)
    slowest_spin = slowest / rim if rim > 0.0 else 1.0
    return (
        _slope(law, epsilon, t, motion, 0, max(radius, rim)) if radius > 0.0 else 0.0,  # none on the axis
        _slope(law, epsilon, t, motion, 1, max(slip_speed, slowest)),
        _slope(law, epsilon, t, motion, 2, max(abs(relative_spin), slowest_spin)),
    )


@compiled
def _slope(
    law: Law, epsilon: float, t: float, motion: tuple[float, float, float], i: int, scale: float
) -> float:
    if not int(number_at(law[0], READS)) >> (i + 1) & 1:
        return 0.0
    low, high = motion[i] - DIFFERENCE * scale, motion[i] + DIFFERENCE * scale
    if motion[i] >= 0.0:  # the coefficient may jump at rest
        low = max(AT_REST, low)
    else:
        high = min(-AT_REST, high)
    radius, slip_speed, spin = motion
    change = 0.0
    for value, sign in ((high, 1.0), (low, -1.0)):
        r, v, s = value if i == 0 else radius, value if i == 1 else slip_speed, value if i == 2 else spin
        change += sign * friction_force_under(law, epsilon, t, r, v, s)
    return float(change / (high - low))


@compiled
def _factor(law: Law, which: int, motion: tuple[float, float, float, float]) -> float:
    numbers, functions = law
    places, address = number_at(numbers, 4 + 2 * which), number_at(numbers, 5 + 2 * which)
    if places == ABSENT:
        return 1.0
    if address != 0.0:
        result: float = result_at(address, motion[0], motion[1], motion[2], motion[3])
    else:
        result = result_of_python(
            functions, 2 * which, int(places), motion[0], motion[1], motion[2], motion[3]
        )
    if 0.0 <= result < math.inf:
        return result
    told: float = result_of_python(functions, 2 * which + 1, 15, motion[0], motion[1], motion[2], motion[3])
    return told
