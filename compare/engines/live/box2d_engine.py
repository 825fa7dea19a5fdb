"""Box2D as an engine, by pybox2d: friction joints, which are made for worlds that are looked at from above.

Written for Box2D 2.3 (``pip install box2d``), in single precision. See ``top_down`` for the bodies. A friction joint
bounds the length of its impulse, a cone; its greatest torque is 0 here, since contact is in points.

What Box2D leaves to choose, and why so:

- Bodies must not sleep. Of several points the velocity iterations are 50; the manual's 8 are for games.
- Angles are counted on and on, which rounds a long spin: whole turns are counted here.

There is no continuous ring of contact.
"""

from __future__ import annotations

import math

import Box2D
import numpy as np

from compare.engines.live.setting import Setting, TopDown, inertia_of
from reference_model.systems import DiscOnDisc, FloatArray

ITERATIONS = 50


class _World(TopDown):
    engine = "Box2D"
    method = f"Box2D {Box2D.__version__}, semi-implicit Euler, friction joints"

    turns = 0

    def build(self, state: FloatArray) -> None:
        system, self.world = self.system, Box2D.b2World(gravity=(0.0, 0.0), doSleep=False)
        disc = isinstance(system, DiscOnDisc)
        places, speeds = np.split(state, 2)
        self.body = self.world.CreateDynamicBody(
            position=tuple(places[:2].tolist()),
            linearVelocity=tuple(speeds[:2].tolist()),
            fixedRotation=not disc,
        )
        self.body.massData = Box2D.b2MassData(mass=system.mass, I=inertia_of(system), center=(0.0, 0.0))
        if disc:
            self.body.angle, self.body.angularVelocity = float(places[2]), float(speeds[2])
        self.partners = [self.world.CreateKinematicBody() for _ in self.arms]
        for arm, partner in zip(self.arms, self.partners, strict=True):
            self.world.CreateFrictionJoint(
                bodyA=partner,
                bodyB=self.body,
                localAnchorA=(0.0, 0.0),
                localAnchorB=(arm.real, arm.imag),
                maxForce=system.friction_force / len(self.arms),
                maxTorque=0.0,
            )

    def state(self) -> tuple[float, ...]:
        body = self.body
        angle = body.angle + 2.0 * math.pi * self.turns
        return (*body.position, angle, *body.linearVelocity, body.angularVelocity)

    def load(self, force: complex, torque: float, below: list[complex]) -> None:
        for partner, velocity in zip(self.partners, below, strict=True):
            partner.linearVelocity = (velocity.real, velocity.imag)
        self.body.ApplyForceToCenter((force.real, force.imag), True)
        self.body.ApplyTorque(torque, True)

    def step(self, h: float) -> None:
        self.load_now()
        self.world.Step(h, ITERATIONS, 0)
        if abs(self.body.angle) > math.pi:
            turn = round(self.body.angle / (2.0 * math.pi))
            self.body.angle -= 2.0 * math.pi * turn
            self.turns += turn


simulate_with_friction_joints = Setting(
    "friction joint",
    "by friction joints, in single precision: steps of order 1, until rounding grows with their number.",
    _World,
    linear=False,
    finest=2e-3,
    precision=1e-6,
)
SETTINGS = (simulate_with_friction_joints,)
