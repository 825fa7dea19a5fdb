"""``friction-discs sweep shock``: the smallest shock that leads to the whirl."""

from __future__ import annotations

import math

from compare.cli.door.command import FINE, SOMETHING_DIFFERS, BadInputError, printing, refused
from compare.cli.door.options import Settings, Tolerance, changed

AGREEMENT = 1e-6
"""Largest relative difference of both ways to find it."""


def sweep_shock(settings: Settings = None, tolerance: Tolerance = 1e-9) -> int:
    """Find the smallest shock that throws a pin from its self-centred equilibrium into the whirl.

    It is the point of the basin's boundary, the stable set of a stick–slip orbit, that is nearest in velocity. The
    ends of motions on both sides of it check that by bisection.

    \b
    Example:
      friction-discs sweep shock --set disc_speed=2
    """
    from compare.claims.paper_parameters import FIG5
    from reference_model import smallest_shock
    from reference_model.orbits.shock import by_bisection
    from reference_model.systems import PinOnDisc

    with refused():
        pin = changed(FIG5, settings or [])
    assert isinstance(pin, PinOnDisc)
    try:
        shock = smallest_shock(pin, tolerance=tolerance)
        checked = by_bisection(shock)
    except (ValueError, RuntimeError) as error:
        raise BadInputError(str(error)) from None
    difference = abs(checked / shock.speed - 1.0)
    with printing():
        print(
            f"smallest shock that leads to the whirl: {shock.impulse:.9g} N s, a change of the velocity by "
            f"{shock.speed:.9g} m/s, ({shock.vx:.6g}, {shock.vy:.6g}) m/s"
        )
        print(f"  direction: {math.degrees(shock.direction):.2f}° from the x-axis")
        print(f"  by bisection of ends: {checked:.9g} m/s, relative difference {difference:.0e}")
    return FINE if difference <= AGREEMENT else SOMETHING_DIFFERS
