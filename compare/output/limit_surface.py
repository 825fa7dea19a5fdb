"""Picture of a limit surface: the forces and moments that a contact can hold."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from compare.output.figures import PALETTE, Axes, axis
from reference_model.contact import IsotropicContact, Points, largest_wrench

SAMPLES = 181


def draw_limit_surface(
    panel: Axes,
    contact: IsotropicContact | Points,
    directions: Sequence[float] = (0.0, math.pi / 2.0),
    **look: Any,
) -> None:
    """Draw the curves where planes through the axis of the moment cut the limit surface of a disc at φ = 0.

    The force has an angle of ``directions`` in rad to the x-axis. Forces and moments are divided by μN, so moments
    are in m.
    """
    lever = max(abs(largest_wrench(contact, 0j, sign)[1]) for sign in (1.0, -1.0))
    loads = np.exp(2j * math.pi * np.linspace(0.0, 1.0, SAMPLES)).tolist()
    for i, direction in enumerate(directions):
        turn = complex(math.cos(direction), math.sin(direction))
        held = [largest_wrench(contact, load.real * turn, lever * load.imag) for load in loads]
        options = {"color": PALETTE[i % len(PALETTE)], "label": f"force at {math.degrees(direction):.0f}°"}
        along = [(force * turn.conjugate()).real for force, _ in held]
        panel.plot(along, [moment for _, moment in held], **options | look)
    panel.set(xlabel=axis(r"F/\mu N"), ylabel=axis(r"M/\mu N", "m"))
