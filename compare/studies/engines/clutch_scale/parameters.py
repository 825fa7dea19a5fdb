"""The motions that are repeated at the scale of a clutch: starts and durations at the paper's scale."""

from __future__ import annotations

from dataclasses import replace

from compare.claims.paper_parameters import FIG4
from compare.studies.engines.clutch_scale.units import CLUTCH
from reference_model.systems import System

TO_REST = (0.1, 0.0, 0.0275, 0.0)
"""Near to the start that divides the motions: the pin sticks nine times before it comes to rest in space."""

UNTIL, SAMPLES = 240.0, 481
"""Time of the paper's scale, in s, in which that pin comes to rest, and how often its state is asked for."""

WHIRLING = replace(FIG4, disc_speed=1.2)
"""Fig. 6 at the friction force 0.12 N."""

REST_OF_DISC = 40.0
"""Time of the paper's scale, in s, for which the disc of Fig. 8 is left where (19) and (20) let it spin."""

CYCLE_START = (0.05, 0.0, 0.4, 0.0, 0.05, 1.3)
"""x, y, angle, vx, vy, spin at the paper's scale of a disc that spirals towards the cycle of Fig. 11, and slides."""

CYCLE_UNTIL, CYCLE_SAMPLES = 60.0, 13
"""Time of the paper's scale, in s, of the motion of Fig. 11, and how often its state is asked for."""

VELOCITIES = (0.0, 0.02, 0.0275, 0.03, 0.06)
"""vx(0) in m/s at the paper's scale of starts that go to either end."""

ENDS_TOLERANCE, ENDS_UNTIL = 1e-7, 150.0

ENSEMBLE, SEED, ENSEMBLE_UNTIL = 1000, 13, 1000.0
"""Random starts of the ensemble, and the time of the paper's scale, in s, in which each comes to its end."""

SOURCE = (
    "{}; X0 = 0.1 mm, ω = 300 rad/s and a mass of 0.5 kg are ours, all dimensionless numbers are the paper's"
)


def scaled(system: System) -> System:
    """Return ``system`` at the scale of a clutch."""
    return CLUTCH.system(system)
