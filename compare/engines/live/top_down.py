"""What engines of the plane share: a world that is looked at from above, where contact with the disc is a joint.

Such an engine has no third axis along which a load could press. Its authors let things that are looked at from above
slide by a joint between two bodies that removes their relative velocity with no more than a greatest force, which
here is N/n at each point of contact. The second body is a kinematic one for each point: it has the velocity that the
disc below has there. Springs, dampers and the shaft are forces, so that any support will do. All of that is set anew
in each step. Steps are semi-implicit, of order 1.
"""

from __future__ import annotations

import cmath

import numpy as np

from compare.engines.live.setting import Model, contact_arms, shaft_torque, support_force
from reference_model.systems import FloatArray, System


class TopDown(Model):
    """A body with a kinematic partner for each point of contact; the subclass knows the engine."""

    def __init__(self, system: System, state: FloatArray, _: float) -> None:
        self.system, self.arms = system, contact_arms(self.engine, system)
        self.half = len(state) // 2
        self.build(state)

    def build(self, state: FloatArray) -> None:
        """Make body, partners and joints."""
        raise NotImplementedError

    def state(self) -> tuple[float, ...]:
        """Return x, y, angle, vx, vy and spin of the body."""
        raise NotImplementedError

    def load(self, force: complex, torque: float, below: list[complex]) -> None:
        """Set force and torque on the body, and the velocities ``below`` of its partners."""
        raise NotImplementedError

    def step(self, h: float) -> None:
        """Take a step of ``h`` s, and call ``load_now`` before velocities change."""
        raise NotImplementedError

    def load_now(self) -> None:
        """Set the forces, and the velocities of the partners, that belong to the state now."""
        system = self.system
        x, y, angle, vx, vy, spin = self.state()
        turned, z = cmath.rect(1.0, angle), complex(x, y)
        below = [1j * system.disc_speed * (z + arm * turned) for arm in self.arms]
        self.load(support_force(system, z, complex(vx, vy)), shaft_torque(system, spin), below)

    def advance(self, h: float, number: int) -> FloatArray:
        """Take ``number`` steps of ``h`` s, and return the state."""
        for _ in range(number):
            self.step(h)
        self.steps += number
        self.evaluations += number
        places, speeds = np.split(np.array(self.state()), 2)
        return np.concatenate((places[: self.half], speeds[: self.half]))
