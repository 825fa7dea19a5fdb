"""Picture of a limit surface: the forces and moments that a contact can hold."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from compare.output.figures import PALETTE, Axes, axis
from reference_model.contact import IsotropicContact, Points, largest_wrench
from reference_model.systems import FloatArray


def section(
    contact: IsotropicContact | Points, direction: float, lever: float, samples: int = 181
) -> FloatArray:
    """Return the closed curve where a plane cuts the limit surface, shape (samples, 2).

    The plane contains the moment's axis and the forces with an angle of ``direction`` in rad to the x-axis of a disc
    at φ = 0. The columns are the force along that direction in N and the moment in m, per newton of μN. The samples
    have equal angles in the plane of the force and of the moment over ``lever`` in m.
    """
    turn = complex(math.cos(direction), math.sin(direction))
    loads = np.exp(2j * math.pi * np.linspace(0.0, 1.0, samples))
    wrenches = [largest_wrench(contact, load.real * turn, lever * load.imag) for load in loads.tolist()]
    return np.array([((force * turn.conjugate()).real, moment) for force, moment in wrenches])


def draw_limit_surface(
    panel: Axes,
    contact: IsotropicContact | Points,
    directions: tuple[float, ...] = (0.0, math.pi / 2.0),
    **look: Any,
) -> None:
    """Draw the sections of a limit surface for several ``directions`` of the force, in rad.

    ``look`` are options of matplotlib for the curves. Forces are over μN, moments over μN in m.
    """
    lever = max(abs(largest_wrench(contact, 0j, sign)[1]) for sign in (1.0, -1.0))
    for i, direction in enumerate(directions):
        force, moment = section(contact, direction, lever).T
        label = f"force at {math.degrees(direction):.0f}°"
        panel.plot(force, moment, **{"color": PALETTE[i % len(PALETTE)], "label": label} | look)
    panel.set(xlabel=axis(r"F/\mu N"), ylabel=axis(r"M/\mu N", "m"))
