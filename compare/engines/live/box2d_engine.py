"""Box2D as an engine, by pybox2d, with its friction joints for top-down scenes.

Written for Box2D 2.3, in single precision. See ``TopDown`` in ``setting`` for the bodies. A friction joint bounds the
length of its impulse, a cone. Its torque limit is 0 for contact at points.

- Bodies must not sleep. Several points need 50 velocity iterations.
- Box2D's angles grow without bound and lose digits in long spins, so the adapter counts whole turns.
"""

import math
from dataclasses import replace

import Box2D
import numpy as np

from compare.engines.live.setting import JointModel, Setting, TopDown, inertia_of, radius_of
from reference_model.systems import DiscOnDisc, FloatArray

ITERATIONS, RECOMMENDED = 50, (8, 3)
"""Velocity iterations; then the velocity and position iterations that Box2D's manual recommends."""


class _World(TopDown):
    engine = "Box2D"
    method = f"Box2D {Box2D.__version__}, semi-implicit Euler, friction joints"

    turns = 0

    def build(self, state: FloatArray, tolerance: float, *, shipped: bool = False) -> None:
        self.shipped, system = shipped, self.system
        self.world = Box2D.b2World(gravity=(0.0, 0.0), doSleep=shipped)
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
        limit = system.friction_force * radius_of(system) if self.patch else 0.0
        self.partners = [self.world.CreateKinematicBody(angularVelocity=system.disc_speed) for _ in self.arms]
        for arm, partner in zip(self.arms, self.partners, strict=True):
            self.world.CreateFrictionJoint(
                bodyA=partner,
                bodyB=self.body,
                localAnchorA=(0.0, 0.0),
                localAnchorB=(arm.real, arm.imag),
                maxForce=system.friction_force / len(self.arms),
                maxTorque=limit,
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
        self.world.Step(h, *(RECOMMENDED if self.shipped else (ITERATIONS, 0)))
        if abs(self.body.angle) > math.pi:
            turn = round(self.body.angle / (2.0 * math.pi))
            self.body.angle -= 2.0 * math.pi * turn
            self.turns += turn


class _Patch(_World):
    kinds, patch = ("ring",), True


class _Joint(JointModel):
    """A revolute joint with a motor of speed 0, whose torque limit is the friction moment, as in the manual."""

    engine = "Box2D"
    method = f"Box2D {Box2D.__version__}, semi-implicit Euler, joint motor"

    def build(self, state: FloatArray, tolerance: float, *, shipped: bool = False) -> None:
        self.iterations = RECOMMENDED if shipped else (ITERATIONS, 0)
        self.world = Box2D.b2World(gravity=(0.0, 0.0), doSleep=shipped)
        self.body = self.world.CreateDynamicBody(angularVelocity=self.spin)
        self.body.massData = Box2D.b2MassData(mass=1.0, I=self.joint.inertia, center=(0.0, 0.0))
        self.world.CreateRevoluteJoint(
            bodyA=self.world.CreateStaticBody(),
            bodyB=self.body,
            localAnchorA=(0.0, 0.0),
            localAnchorB=(0.0, 0.0),
            enableMotor=True,
            motorSpeed=0.0,
            maxMotorTorque=self.joint.friction_moment,
        )
        self.first = self.angle

    def turn(self, torque: float, h: float) -> tuple[float, float]:
        self.body.ApplyTorque(torque, True)
        self.world.Step(h, *self.iterations)
        return self.first + self.body.angle, self.body.angularVelocity


friction_joint = Setting(
    "friction joint",
    "by friction joints, in single precision, with steps of order 1 until accumulated rounding dominates.",
    _World,
    finest=2e-3,
    precision=1e-6,
    joint=_Joint,
)
torque = replace(
    friction_joint,
    name="friction joint with torque",
    says="with a disc on one friction joint with limits of force and torque, in single precision.",
    model=_Patch,
    joint=None,
)
shipped = replace(
    friction_joint,
    name="as shipped",
    says="by friction joints in single precision, with the recommended iterations; slow bodies fall asleep.",
    options={"shipped": True},
)
