"""Where the reference's reduced disc rests on the bench, and how it whirls."""

from __future__ import annotations

from typing import TYPE_CHECKING

from compare.studies.toolkit.drivetrain_bench import Operation, facings
from reference_model import SpinningEquilibrium, SpinningWhirl, self_centred_equilibria, whirls

if TYPE_CHECKING:
    from exudyn_models import Drivetrain

RINGS = 16
"""Of the reference's annulus."""


def rest_of(car: Drivetrain, operation: Operation, rings: int = RINGS) -> SpinningEquilibrium:
    """Return the reference's equilibrium."""
    (equilibrium,) = self_centred_equilibria(operation.reduced(car), facings(car, rings))
    return equilibrium


def whirl_of(car: Drivetrain, operation: Operation, rings: int = RINGS) -> SpinningWhirl:
    """Return the reference's whirl."""
    (whirl,) = whirls(operation.reduced(car), facings(car, rings))
    return whirl
