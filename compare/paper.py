"""Parameter sets that the paper prints."""

from __future__ import annotations

from dataclasses import replace

from reference_model.systems import PinOnDisc

FIG4 = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.12, disc_speed=1.5, offset=0.1)
"""Fig. 4, whose axis is ω; Fig. 6 has the same parameters with ω = 1.2 and the load as its axis."""

CENTRED = replace(FIG4, offset=0.0)
"""Fig. 4 without its offset, as (10) to (16) assume."""

FIG5 = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=1.5, offset=0.1)

FIG5_STARTS = {"equilibrium": (0.1, 0.0, 0.0, 0.0), "whirl": (0.1, 0.0, 0.03, 0.0)}
"""x, y, vx, vy by what they lead to."""
