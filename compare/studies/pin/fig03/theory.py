"""The position of rest and its eigenvalues over the friction force, and where measured positions lose it."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from compare.claims.linearised_flow import real_and_imaginary
from compare.claims.study import Data
from compare.studies.pin.fig03.parameters import LIMIT, PIN, with_load
from reference_model.formulas.pin import equilibrium_position
from reference_model.steady.stability import equilibrium_eigenvalues
from reference_model.systems import FloatArray


def curves() -> Data:
    """Return positions of rest and their eigenvalues over μN in N."""
    loads = LIMIT * np.sin(np.linspace(0.0, 0.5 * np.pi, 181))[:-1]  # equal steps along the semicircle
    eigenvalues = [along_and_across(equilibrium_eigenvalues(with_load(load))) for load in loads[1:]]
    return {
        "position": np.vstack((positions(loads), [0.0, 0.0])),
        "eigenvalue_load": loads[1:],
        "eigenvalue": real_and_imaginary(eigenvalues),
    }


def positions(loads: Sequence[float] | FloatArray) -> FloatArray:
    """Return the positions (3) in m under μN = ``loads`` in N, shape (n, 2)."""
    return np.array([equilibrium_position(with_load(load)) for load in loads])


def along_and_across(values: Sequence[complex]) -> list[complex]:
    """Sort the four eigenvalues, those of motion along the circumference (of the support alone) first."""
    m, beta, C = PIN.mass, PIN.damping, PIN.stiffness
    along = sorted(values, key=lambda value: abs(m * value**2 + beta * value + C))
    return [
        *sorted(along[:2], key=lambda value: -value.imag),
        *sorted(along[2:], key=lambda value: (-value.imag, -value.real)),
    ]


def vanishing_load(loads: Sequence[float], places: FloatArray, error: FloatArray) -> tuple[float, float]:
    """Return the μN in N at which ρ² of the last two ``places`` reaches zero, and its error.

    By (3) ρ² is linear in (μN)².
    """
    first, last = (load**2 for load in loads[-2:])
    first_radius, last_radius = np.hypot(*places[-2:].T)
    rho_first, rho_last = first_radius**2, last_radius**2
    fall = rho_first - rho_last
    squared = last + rho_last * (last - first) / fall
    by_first = 2.0 * first_radius * error[-2] * rho_last * (last - first) / fall**2
    by_last = 2.0 * last_radius * error[-1] * rho_first * (last - first) / fall**2
    limit = math.sqrt(squared) if squared > 0.0 else math.nan
    return limit, float(abs(by_first) + abs(by_last)) / (2.0 * limit)
