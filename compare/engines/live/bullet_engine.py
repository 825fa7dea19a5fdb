"""Bullet as an engine: with its friction cone on and off, and with our law as a user force.

Written for PyBullet 3.2.7, in double precision. The pin or disc is a multibody on two prismatic joints; a disc also
has a revolute joint. The plate is too heavy to be slowed.

- Disabled defaults of Bullet: a body damping of 0.04, motors in the joints, a joint speed limit of 100. With the
  settings as shipped, only the motors are off.
- The friction coefficient is the product of the coefficients of both bodies. Slop and the solver's residual threshold
  are 0.
- Springs and dampers are forces set before each step, so any support is possible.

Friction opposes the slip at the end of a step. With the cone off, it is bounded per world axis. With the cone on,
friction on a disc deviates from the direction of slip by R²·m/J, because each component has its own mobility.
"""

from importlib.metadata import version
from typing import Any

import numpy as np
import pybullet

from compare.engines.live.setting import (
    JointModel,
    Model,
    Setting,
    inertia_of,
    mobility,
    our_friction,
    radius_of,
    shaft_torque,
    support_force,
)
from reference_model.systems import DiscOnDisc, FloatArray

ITERATIONS = 50
"""Solver iterations, the default. Ten iterations change discs that stick on six points by less than 0.1 % of their
error."""


class _World(Model):
    """A world with one body, and with a plate unless friction is our force."""

    engine = "Bullet"
    most_points = 100  # PyBullet allows 128 links per body
    linear = False

    def build(self, state: FloatArray, tolerance: float, *, friction: str) -> None:
        self.state, system = state, self.system
        self.method = f"PyBullet {version('pybullet')}, semi-implicit Euler, {friction}"
        self.joints = range(self.half)
        self.load = system.friction_force / len(self.arms)
        self.native = friction != "our force"
        self.shipped = friction == "as shipped"
        self._connect(friction)
        # The feet take half of the largest mass that mass and inertia allow.
        feet = self.arms if self.native else []
        mass, inertia = system.mass, inertia_of(system)
        foot = min(mass, inertia / abs(self.arms[0]) ** 2 if self.arms[0] else mass) / 2.0 / len(self.arms)
        carriage = mass - foot * len(feet), inertia - foot * sum(abs(arm) ** 2 for arm in feet)
        weightless = [(0.0, 0.0)] * (len(self.joints) - 1)
        sphere = pybullet.createCollisionShape(pybullet.GEOM_SPHERE, radius=1.0, physicsClientId=self.client)
        self.body = self._body(
            height=1.0,
            links=[*weightless, carriage, *[(foot, 0.0)] * len(feet)],
            shapes=[-1] * len(self.joints) + [sphere] * len(feet),
            places=[0j] * len(self.joints) + feet,
            parents=[*self.joints, *[len(self.joints)] * len(feet)],
            axes=["x", "y", "turn"][: len(self.joints)] + ["z"] * len(feet),
        )
        for joint, (position, speed) in enumerate(state.reshape(2, -1).T.tolist()):
            pybullet.resetJointState(self.body, joint, position, speed, physicsClientId=self.client)
        if self.native:
            pybullet.setGravity(0.0, 0.0, -self.load / foot, physicsClientId=self.client)
            if self.patch:
                pybullet.changeDynamics(
                    self.body, self.half, spinningFriction=radius_of(system), physicsClientId=self.client
                )
            plane = pybullet.createCollisionShape(pybullet.GEOM_PLANE, physicsClientId=self.client)
            plate = self._body(0.0, [(mass, 1e12 * inertia)], [plane], [0j], [0], ["turn"])
            pybullet.resetJointState(plate, 0, 0.0, system.disc_speed, physicsClientId=self.client)

    def _connect(self, friction: str) -> None:
        self.client = pybullet.connect(pybullet.DIRECT)
        if not self.shipped:
            pybullet.setPhysicsEngineParameter(
                numSolverIterations=ITERATIONS,
                solverResidualThreshold=0.0,
                contactSlop=0.0,
                enableConeFriction=int(friction == "cone"),
                physicsClientId=self.client,
            )

    def _body(self, height: float, links: Any, shapes: Any, places: Any, parents: Any, axes: Any) -> int:
        """Return an undamped multibody without motors; ``links`` are pairs of mass and inertia."""
        none, unit = [[0.0, 0.0, 0.0]] * len(links), [[0.0, 0.0, 0.0, 1.0]] * len(links)
        vectors = {"x": [1, 0, 0], "y": [0, 1, 0], "z": [0, 0, 1], "turn": [0, 0, 1]}
        body: int = pybullet.createMultiBody(
            basePosition=[0.0, 0.0, height],
            linkMasses=[mass for mass, _ in links],
            linkCollisionShapeIndices=shapes,
            linkVisualShapeIndices=[-1] * len(links),
            linkPositions=[[place.real, place.imag, 0.0] for place in places],
            linkOrientations=unit,
            linkInertialFramePositions=none,
            linkInertialFrameOrientations=unit,
            linkParentIndices=parents,
            linkJointTypes=[
                pybullet.JOINT_REVOLUTE if axis == "turn" else pybullet.JOINT_PRISMATIC for axis in axes
            ],
            linkJointAxis=[vectors[axis] for axis in axes],
            physicsClientId=self.client,
        )
        # Settings of the whole body go to its base, because in a call for a link they discard the link's own.
        if not self.shipped:
            whole = {"linearDamping": 0.0, "angularDamping": 0.0, "maxJointVelocity": 1e9}
            awake = pybullet.ACTIVATION_STATE_DISABLE_SLEEPING
            pybullet.changeDynamics(body, -1, activationState=awake, physicsClientId=self.client, **whole)
        for link, (_, inertia) in enumerate(links):
            own = {"jointDamping": 0.0, "lateralFriction": 1.0, "localInertiaDiagonal": [inertia] * 3}
            pybullet.changeDynamics(body, link, physicsClientId=self.client, **own)
            pybullet.setJointMotorControl2(
                body, link, pybullet.VELOCITY_CONTROL, force=0.0, physicsClientId=self.client
            )
        return body

    def close(self) -> None:
        pybullet.disconnect(self.client)

    def advance(self, h: float, number: int) -> FloatArray:
        pybullet.setPhysicsEngineParameter(fixedTimeStep=h, physicsClientId=self.client)
        self.epsilon = 0.0 if self.native else h * mobility(self.system) * self.system.friction_force
        forces, torque, client = self._forces(*self.state.tolist()), pybullet.TORQUE_CONTROL, self.client
        for _ in range(number):
            pybullet.setJointMotorControlArray(
                self.body, self.joints, torque, forces=forces, physicsClientId=client
            )
            pybullet.stepSimulation(client)
            positions, speeds, _, _ = zip(
                *pybullet.getJointStates(self.body, self.joints, client), strict=True
            )
            forces = self._forces(*positions, *speeds)
        self.state = np.array([*positions, *speeds])
        return self.state

    def _forces(self, *state: float) -> list[float]:
        system = self.system
        z, v = complex(*state[:2]), complex(*state[self.half : self.half + 2])
        force = support_force(system, z, v)
        forces = [force.real, force.imag]
        if isinstance(system, DiscOnDisc):
            forces.append(shaft_torque(system, state[5]))
        if not self.native:
            friction = our_friction(system, self.arms, state, self.epsilon)
            forces = [a + b for a, b in zip(forces, friction, strict=True)]
        return forces


class _Patch(_World):
    kinds, patch = ("ring",), True


class _Joint(JointModel, _World):
    """A revolute joint with a velocity motor, whose force limit is the friction moment."""

    method = f"PyBullet {version('pybullet')}, semi-implicit Euler, joint motor"

    def build(self, state: FloatArray, tolerance: float, *, friction: str) -> None:
        self.shipped, self.h = friction == "as shipped", 0.0
        self._connect(friction)
        inertia = self.joint.inertia
        self.body = self._body(0.0, [(inertia, inertia)], [-1], [0j], [0], ["turn"])
        pybullet.resetJointState(self.body, 0, *state.tolist(), physicsClientId=self.client)

    def turn(self, torque: float, h: float) -> tuple[float, float]:
        body, client = self.body, self.client
        if h != self.h:
            pybullet.setPhysicsEngineParameter(fixedTimeStep=h, physicsClientId=client)
            motor, self.h = pybullet.VELOCITY_CONTROL, h
            pybullet.setJointMotorControl2(
                body, 0, motor, targetVelocity=0.0, force=self.joint.friction_moment, physicsClientId=client
            )
        pybullet.setJointMotorControl2(body, 0, pybullet.TORQUE_CONTROL, force=torque, physicsClientId=client)
        pybullet.stepSimulation(client)
        angle, spin, *_ = pybullet.getJointState(body, 0, client)
        return angle, spin


cone = Setting(
    "cone", "with Bullet's contact and steps of order 1.", _World, {"friction": "cone"}, joint=_Joint
)
box = Setting(
    "box",
    "with enableConeFriction off. It converges to the motion with friction bounded for each axis.",
    _World,
    {"friction": "box"},
)
shipped = Setting(
    "as shipped",
    "with all its defaults, which include a damping of the body of 0.04 and a joint speed limit of 100.",
    _World,
    {"friction": "as shipped"},
    joint=_Joint,
)
spinning = Setting(
    "spinning friction",
    "with a disc on one contact with spinning friction, and the cone.",
    _Patch,
    {"friction": "cone"},
)
our_force = Setting(
    "our force",
    "with the force −μN·v/max(|v|, ε) in place of contact, set before each step, of order 1. ε is the change of slip "
    "by friction in a step.",
    _World,
    {"friction": "our force"},
)
