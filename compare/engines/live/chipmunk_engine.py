"""Chipmunk as an engine: pivot joints with a force limit.

Written for pymunk 7.3, in double precision. See ``TopDown`` in ``setting`` for the bodies. As in Chipmunk's tank
demo, friction is a pivot joint whose force limit bounds the length of the impulse, a cone.

- A pivot joint would also pull its two anchors together; a ``max_bias`` of 0 disables that.
- Chipmunk updates positions before velocities, so forces set before a step would feed energy to springs and have
  eight times the error. They are set in the velocity update.
- Several points need 50 iterations, five times the default.
"""

from typing import Any

import pymunk

from compare.engines.live.setting import JointModel, Setting, TopDown, inertia_of, radius_of
from reference_model.systems import DiscOnDisc, FloatArray

ITERATIONS = 50


class _Space(TopDown):
    engine = "Chipmunk"
    method = f"pymunk {pymunk.version}, semi-implicit Euler, pivot joints with a greatest force"

    def build(self, state: FloatArray, tolerance: float, *, shipped: bool = False) -> None:
        self.shipped, system = shipped, self.system
        self.space = pymunk.Space()
        if not self.shipped:
            self.space.iterations = ITERATIONS
        disc = isinstance(system, DiscOnDisc)
        self.body = pymunk.Body(system.mass, inertia_of(system) if disc else float("inf"))
        places, speeds = state.reshape(2, -1).tolist()
        self.body.position, self.body.velocity = tuple(places[:2]), tuple(speeds[:2])
        if disc:
            self.body.angle, self.body.angular_velocity = places[2], speeds[2]
        if not self.shipped:
            self.body.velocity_func = self._change_velocity
        self.space.add(self.body)
        self.partners = [pymunk.Body(body_type=pymunk.Body.KINEMATIC) for _ in self.arms]
        for arm, partner in zip(self.arms, self.partners, strict=True):
            joint = pymunk.PivotJoint(partner, self.body, (0.0, 0.0), (arm.real, arm.imag))
            joint.max_bias, joint.max_force = 0.0, system.friction_force / len(self.arms)
            self.space.add(partner, joint)
            if self.patch:
                gear = pymunk.GearJoint(partner, self.body, 0.0, 1.0)
                gear.max_bias, gear.max_force = 0.0, system.friction_force * radius_of(system)
                partner.angular_velocity = system.disc_speed
                self.space.add(gear)

    def state(self) -> tuple[float, ...]:
        body = self.body
        return (*body.position, body.angle, *body.velocity, body.angular_velocity)

    def load(self, force: complex, torque: float, below: list[complex]) -> None:
        for partner, velocity in zip(self.partners, below, strict=True):
            partner.velocity = velocity.real, velocity.imag
        self.body.force, self.body.torque = (force.real, force.imag), torque

    def step(self, h: float) -> None:
        if self.shipped:
            self.load_now()
        self.space.step(h)

    def _change_velocity(self, body: Any, gravity: Any, damping: float, h: float) -> None:
        self.load_now()
        pymunk.Body.update_velocity(body, gravity, damping, h)


class _Patch(_Space):
    kinds, patch = ("ring",), True


class _Joint(JointModel):
    """A body with a motor of speed 0, whose force limit is the friction moment."""

    engine = "Chipmunk"
    method = f"pymunk {pymunk.version}, semi-implicit Euler, motor with a force limit"

    def build(self, state: FloatArray, tolerance: float, *, shipped: bool = False) -> None:
        self.space = pymunk.Space()
        self.body = pymunk.Body(1.0, self.joint.inertia)
        self.body.angle, self.body.angular_velocity = self.angle, self.spin
        self.space.add(self.body)
        self.h = 0.0

    def turn(self, torque: float, h: float) -> tuple[float, float]:
        if h != self.h:  # a motor starts each step with its last impulse, whatever the step
            self.space.remove(*self.space.constraints)
            motor = pymunk.SimpleMotor(self.space.static_body, self.body, 0.0)
            motor.max_force, self.h = self.joint.friction_moment, h
            self.space.add(motor)
        self.body.torque = torque
        self.space.step(h)
        return self.body.angle, self.body.angular_velocity


pivot = Setting(
    "pivot joint",
    "by pivot joints with a force limit, as in its top-down tank demo, with steps of order 1.",
    _Space,
    joint=_Joint,
)
gear = Setting(
    "pivot and gear joint",
    "with a disc on one pivot joint and one gear joint, whose force limits stand for friction in the tank demo.",
    _Patch,
)
shipped = Setting(
    "as shipped",
    "by pivot joints with a force limit, with ten iterations, its default, and forces set before each step.",
    _Space,
    {"shipped": True},
    joint=_Joint,
)
