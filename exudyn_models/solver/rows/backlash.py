"""Torsional springs with backlash, whose flanks touch and separate at located times."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from exudyn_models.forces.axial_pairs import SLIDING, Mode
from exudyn_models.forces.slip_kinematics import Floats
from exudyn_models.solver.rows.laws import RotaryLaw
from reference_model.systems import FloatArray

SIDES = (1, -1)
"""Flanks: pressed if the second rotor is ahead of the first, or behind it."""


@dataclass(eq=False)
class Backlash(RotaryLaw):
    """Spring and damper on each flank, beyond half of the ``clearance`` in rad, which push but never pull.

    A flank is pressed by ±φ − clearance/2, with the twist φ; ``middle`` is its part from reference coordinates. The
    moment is the stiffness times this press plus the damping times the rate of ±φ, while both are positive.
    """

    stiffness: float = field(kw_only=True)
    damping: float = field(kw_only=True)
    clearance: float = field(kw_only=True)
    middle: float = field(kw_only=True)

    def _flank(self, side: int, twist: float, rate: float) -> tuple[float, float]:
        """Return stiffness·press, and the moment in N m if the flank is pressed."""
        elastic = self.stiffness * (side * twist - self.clearance / 2.0)
        return elastic, elastic + side * self.damping * rate

    def pressed(self, twist: float, rate: float) -> Mode:
        """Return the flank that the state presses, as FORWARD or BACKWARD, or OPEN."""
        return next((Mode(side) for side in SIDES if min(self._flank(side, twist, rate)) > 0.0), Mode.OPEN)

    def margin(self, twist: float, rate: float) -> float:
        """Return a moment in N m that falls below zero when the pressed flank changes."""
        if self.slides:
            return self._flank(int(self.mode or 0), twist, rate)[1]
        return -max(min(self._flank(side, twist, rate)) for side in SIDES)

    def twist(self, q: Floats | FloatArray) -> float:
        """Return the twist in rad; ``q`` excludes reference values."""
        return super().twist(q) + self.middle

    def mode_at(self, twist: float, rate: float) -> Mode:
        """Return the pressed flank, which is constant within a step of ``solve_dynamic``."""
        return self.visible_mode if self.running else self.pressed(twist, rate)

    def moment_and_friction(self, t: float, twist: float, rate: float) -> tuple[float, float]:
        """Return the moment on the second rotor in N m, and no friction."""
        mode = self.mode_at(twist, rate)
        return -int(mode) * self._flank(int(mode), twist, rate)[1] if mode in SLIDING else 0.0, 0.0

    def energy(self, twist: float) -> float:
        """Return the energy in J of the pressed spring."""
        return max(0.0, *(self._flank(side, twist, 0.0)[0] for side in SIDES)) ** 2 / (2.0 * self.stiffness)

    def lost_power(self, t: float, twist: float, rate: float) -> float:
        """Return the power in W of the damper, or of a flank that follows the other without force."""
        elastic = sum(side * max(0.0, self._flank(side, twist, rate)[0]) for side in SIDES)
        return -(self.moment_and_friction(t, twist, rate)[0] + elastic) * rate

    def force(self, mbs: Any, t: float, item: int, q: Sequence[float], q_t: Sequence[float]) -> list[float]:
        """Return the moments on the nodes (user function of the connector)."""
        moment, _ = self.moment_and_friction(t, self.twist(q), self.slip(q, q_t))
        return [moment * weight for weight in self.weights.tolist()]

    def jacobian(
        self,
        mbs: Any,
        t: float,
        item: int,
        q: Sequence[float],
        q_t: Sequence[float],
        position_factor: float,
        velocity_factor: float,
    ) -> FloatArray:
        """Return the derivatives of minus the moments (user function of the connector)."""
        mode = self.mode_at(self.twist(q), self.slip(q, q_t))
        slope = position_factor * self.stiffness + velocity_factor * self.damping
        return (slope if mode in SLIDING else 0.0) * np.outer(self.weights, self.weights)
