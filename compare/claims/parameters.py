"""Parameter sets of the paper, and the parameters that repeat a claim."""

from collections.abc import Collection
from dataclasses import asdict, replace

import numpy as np
from numpy.typing import ArrayLike

from reference_model.systems import COLUMNS, DiscOnDisc, PinOnDisc
from reference_model.systems.joint import AnySystem

# --- Parameter sets that the paper prints.

FIG4 = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.12, disc_speed=1.5, offset=0.1)
"""Parameters of Fig. 4, which varies ω. Fig. 6 has the same parameters with ω = 1.2 and varies the load."""

CENTRED = replace(FIG4, offset=0.0)
"""Fig. 4 without offset, as (10) to (16) assume."""

FIG5 = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=1.5, offset=0.1)

FIG5_STARTS = {"equilibrium": (0.1, 0.0, 0.0, 0.0), "whirl": (0.1, 0.0, 0.03, 0.0)}
"""Initial x, y, vx, vy by the motion that they lead to."""

FIG8 = DiscOnDisc(
    mass=1.0,
    polar_inertia=1.0,
    stiffness=1.0,
    damping=0.003,
    friction_force=0.05,
    disc_speed=0.8,
    offset=0.1,
    contact_radius=0.12,
    shaft_damping=0.01,
    shaft_speed=0.5,
)
"""Parameters of Fig. 8, which varies the load; the load here is our choice.

The paper omits X0; we use the value of Figs. 4 to 6.
"""

FIG9 = replace(FIG8, disc_speed=1.5, shaft_speed=1.25)
"""Parameters of Figs. 9 and 10, "for the same parameter values as above" except the two speeds; they vary the load.

We assume β and b of Fig. 8. The paper omits X0 here, too.
"""

FIG11 = DiscOnDisc(
    mass=1.0,
    polar_inertia=1.0,
    stiffness=1.0,
    damping=0.5,
    friction_force=0.0225,
    disc_speed=1.5,
    offset=0.0,
    contact_radius=0.12,
    shaft_damping=0.015,
    shaft_speed=1.25,
)
"""Parameters of Fig. 11. The paper omits the initial conditions and X0; zero makes the whirl a circle."""


# --- Parameters that repeat a claim.

BEYOND_THE_SPRING = ("hardening", "stop_gap", "stop_stiffness")
"""Parameters of the support that are zero in the paper."""


def parameters_of(
    system: AnySystem, *, without: Collection[str] = (), **changes: float
) -> dict[str, float | str]:
    """Return the parameters of ``system`` except those in ``without``; ``changes`` adds or replaces some.

    ``contact_points`` is "continuous ring" if it is None. Zero parameters of a nonlinear support are omitted. The
    moment of a joint is a text with its points.
    """
    parameters: dict[str, float | str] = {
        name: "continuous ring" if value is None else str(value) if isinstance(value, tuple) else value
        for name, value in asdict(system).items()
        if name not in BEYOND_THE_SPRING or value != 0.0
    }
    return {name: value for name, value in parameters.items() if name not in without} | changes


def at_each(name: str, values: ArrayLike) -> str:
    """Return "name = a, b, c" for the note of a claim with these elements."""
    return f"{name} = {', '.join(f'{value:g}' for value in np.ravel(values))}"


def components_of(system: AnySystem) -> tuple[str, ...]:
    """Return the components of the state with units, such as "x in m"."""
    return tuple(f"{name} in {unit}" for name, unit in COLUMNS[type(system)])
