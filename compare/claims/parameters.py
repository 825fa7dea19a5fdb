"""The parameters of a claim, for those who want to repeat it."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import asdict

import numpy as np
from numpy.typing import ArrayLike

from reference_model.systems import COLUMNS, System

BEYOND_THE_SPRING = ("hardening", "stop_gap", "stop_stiffness")
"""Parameters of a support that are zero in the paper."""


def parameters_of(
    system: System, *, without: Collection[str] = (), **changes: float
) -> dict[str, float | str]:
    """Return the parameters of ``system`` for a claim, but those that it sweeps; ``changes`` adds or replaces some.

    A disc without contact points has "continuous ring" in their place; what no linear support has is left out.
    """
    parameters: dict[str, float | str] = {
        name: "continuous ring" if value is None else value
        for name, value in asdict(system).items()
        if name not in BEYOND_THE_SPRING or value != 0.0
    }
    return {name: value for name, value in parameters.items() if name not in without} | changes


def at_each(name: str, values: ArrayLike) -> str:
    """Return "name = a, b, c" for the note of a claim whose elements belong to these values."""
    return f"{name} = {', '.join(f'{value:g}' for value in np.ravel(values))}"


def components_of(system: System) -> tuple[str, ...]:
    """Return the components of a state with their units, "x in m"."""
    return tuple(f"{name} in {unit}" for name, unit in COLUMNS[type(system)])
