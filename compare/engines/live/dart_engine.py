"""DART as an engine: with four of its contact solvers, and with our law as a user force.

Measured with 6.20.0. The pin or disc is a body on a planar joint. The motion of the plate is prescribed.

- A step is semi-implicit, of order 1. Implicit springs of joints would damp like C·h, so the support's spring is a
  force set before each step, with a quarter of the error. The dampers are the joint's.
- By default, bodies at rest fall asleep, and a second solver silently replaces the first if it fails. We turn both
  off.
- Dantzig's solver and projected Gauss–Seidel bound friction on each of two world axes; the others use the cone.
- At a solver tolerance of 1e-12 of an impulse, rounding can prevent convergence.
"""

import math
from typing import Any

import dartpy
import numpy as np

from compare.engines.live.setting import JointModel, Model, Setting, inertia_of, mobility, our_friction
from reference_model.systems import DiscOnDisc, FloatArray, System

SOLVER_TOLERANCE = 1e-10
SHARE = 0.01  # share of mass and inertia in the feet
SHIPPED = "as shipped"
PLATE = 1e4  # half the width of the plate in m


class _Model(Model):
    """A world with native contact by ``solver``, or with our force if ``solver`` is empty."""

    engine = "DART"

    def build(self, state: FloatArray, tolerance: float, *, solver: str = "") -> None:
        self.native, system = bool(solver), self.system
        self.world, self.joint = _world(system, self.arms, solver)
        self.joint.setPositions([*state[: self.half], 0.0][:3])
        self.joint.setVelocities([*state[self.half :], 0.0][:3])
        self.torque = system.shaft_damping * system.shaft_speed if isinstance(system, DiscOnDisc) else 0.0
        self.method = f"DART {dartpy.__version__}, {solver or 'our law by force'}"

    def advance(self, h: float, number: int) -> FloatArray:
        system, joint = self.system, self.joint
        self.world.setTimeStep(h)
        if not self.native:
            self.epsilon = h * mobility(system) * system.friction_force
        for _ in range(number):
            x, y, _ = joint.getPositions().tolist()
            forces = [-system.stiffness * (x - system.offset), -system.stiffness * y, self.torque]
            if not self.native:
                friction = our_friction(system, self.arms, self._state().tolist(), self.epsilon)
                forces[: self.half] = [a + b for a, b in zip(forces, friction, strict=False)]
            joint.setCommands(forces)
            self.world.step(False)
        return self._state()

    def _state(self) -> FloatArray:
        places, speeds = self.joint.getPositions(), self.joint.getVelocities()
        return np.concatenate((places[: self.half], speeds[: self.half]))


def _world(system: System, arms: list[complex], solver: str) -> tuple[Any, Any]:
    dynamics, world = dartpy.dynamics, dartpy.simulation.World()
    if solver != SHIPPED:
        _keep_awake(world)
        _choose(solver, world.getConstraintSolver())
    world.setCollisionDetector(dartpy.simulation.CollisionDetectorType.DART)
    inertia, n, share = inertia_of(system), len(arms), SHARE if solver else 0.0
    foot = share * min(system.mass, inertia / abs(arms[0]) ** 2 if arms[0] else math.inf) / n
    spin = share * inertia / n
    world.setGravity([0.0, 0.0, -system.friction_force / n / (foot or 1.0)])

    pieces = dynamics.Skeleton("disc")
    joint, body = pieces.createPlanarJointAndBodyNodePair(None, dynamics.PlanarJointProperties())
    inertia -= sum(foot * abs(arm) ** 2 + spin for arm in arms)
    body.setInertia(_inertia(system.mass - n * foot, inertia))
    body.setGravityMode(False)
    shaft = system.shaft_damping if isinstance(system, DiscOnDisc) else 0.0
    for i, damping in enumerate((system.damping, system.damping, shaft)):
        joint.setDampingCoefficient(i, damping)
    if solver:
        vertical = dynamics.PrismaticJointProperties()
        vertical.mAxis = [0.0, 0.0, 1.0]
        for arm in arms:
            guide, pad = pieces.createPrismaticJointAndBodyNodePair(body, vertical)
            guide.setTransformFromParentBodyNode(_shift(arm.real, arm.imag, 0.0))
            pad.setInertia(_inertia(foot, spin))
            # slightly below, for contact from the start
            _touching(pad, dynamics.SphereShape(1.0), 1.0 - 1e-9)
        plate, axis = dynamics.Skeleton("plate"), dynamics.RevoluteJointProperties()
        axis.mAxis = [0.0, 0.0, 1.0]
        master, body = plate.createRevoluteJointAndBodyNodePair(None, axis)
        master.setActuatorType(dynamics.ActuatorType.VELOCITY)
        master.setCommand(0, system.disc_speed)
        master.setVelocity(0, system.disc_speed)
        _touching(body, dynamics.BoxShape([2.0 * PLATE, 2.0 * PLATE, 2.0]), -1.0)
        world.addSkeleton(plate)
    world.addSkeleton(pieces)
    return world, joint


class _Joint(JointModel):
    """A revolute joint with DART's Coulomb friction."""

    engine = "DART"
    method = f"DART {dartpy.__version__}, Coulomb friction of a joint"

    def build(self, state: FloatArray, tolerance: float, *, solver: str) -> None:
        self.world, pieces = dartpy.simulation.World(), dartpy.dynamics.Skeleton("joint")
        if solver != SHIPPED:
            _keep_awake(self.world)
            _choose(solver, self.world.getConstraintSolver())
        axis = dartpy.dynamics.RevoluteJointProperties()
        axis.mAxis = [0.0, 0.0, 1.0]
        self.hinge, body = pieces.createRevoluteJointAndBodyNodePair(None, axis)
        body.setInertia(_inertia(self.joint.inertia, self.joint.inertia))
        self.hinge.setCoulombFriction(0, self.joint.friction_moment)
        self.hinge.setPosition(0, self.angle)
        self.hinge.setVelocity(0, self.spin)
        self.world.addSkeleton(pieces)

    def turn(self, torque: float, h: float) -> tuple[float, float]:
        self.world.setTimeStep(h)
        self.hinge.setCommand(0, torque)
        self.world.step(False)
        return self.hinge.getPosition(0), self.hinge.getVelocity(0)


def _keep_awake(world: Any) -> None:
    asleep = dartpy.simulation.DeactivationOptions()
    asleep.mEnabled = False
    world.setDeactivationOptions(asleep)


def _choose(solver: str, constraints: Any) -> None:
    second, kinds = constraints.getSecondaryBoxedLcpSolver(), dartpy.constraint
    constraints.setSecondaryBoxedLcpSolver(None)
    if solver == "pgs":
        second.setOption(kinds.PgsBoxedLcpSolverOption(1000, 1e-15, SOLVER_TOLERANCE, 1e-15, False))
        constraints.setBoxedLcpSolver(second)
    elif solver in ("nsgs", "fbf"):
        kind = {"nsgs": kinds.NsgsFrictionSolver, "fbf": kinds.FbfFrictionSolver}[solver]
        options = kind.Options()
        options.tolerance = SOLVER_TOLERANCE
        constraints.setBoxedLcpSolver(kind(options))


def _inertia(mass: float, polar: float) -> Any:
    return dartpy.dynamics.Inertia(mass, [0.0, 0.0, 0.0], polar * np.eye(3))


def _shift(x: float, y: float, z: float) -> Any:
    result = dartpy.math.Isometry3()
    result.set_translation([x, y, z])
    return result


def _touching(body: Any, shape: Any, height: float) -> None:
    node = body.createShapeNode(shape)
    node.setRelativeTransform(_shift(0.0, 0.0, height))
    node.createCollisionAspect()
    surface = node.createDynamicsAspect()
    surface.setFrictionCoeff(1.0)
    surface.setRestitutionCoeff(0.0)


nsgs = Setting("NSGS", "with the cone, by nonsmooth Gauss–Seidel.", _Model, {"solver": "nsgs"}, joint=_Joint)
fbf = Setting("FBF", "with the cone, by forward-backward-forward splitting.", _Model, {"solver": "fbf"})
dantzig = Setting("Dantzig", "with a box in place of the cone, by pivoting.", _Model, {"solver": "dantzig"})
shipped = Setting(
    "as shipped",
    "with all its defaults: Dantzig's solver, a box, another solver if it fails, and slow bodies fall asleep.",
    _Model,
    {"solver": SHIPPED},
    joint=_Joint,
)
pgs = Setting("PGS", "with a box in place of the cone, by projected Gauss–Seidel.", _Model, {"solver": "pgs"})
our_force = Setting(
    "our force",
    "with the force −μN·v/max(|v|, ε) in place of contact, set at the start of each step. ε is the change of slip by "
    "friction in a step; steps would be unstable with half of it.",
    _Model,
)
