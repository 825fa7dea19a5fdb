"""Drake as an engine: three contact solvers, two integrators, and our law as a force.

Measured with 1.51.1. The pin or disc is a body on a planar joint, with a sphere at each contact point, deep in a
plate that turns at ω. Contact is compliant and heights are fixed, so stiffness times depth is the load N/n in any
motion.

- A step of the discrete solvers is semi-implicit, of order 1. For integrators, friction grows smoothly up to a slip
  of ε and is Coulomb's beyond.
- ε is 1e-3·h or 1e-2·√tolerance, in m/s with rates in 1/s. SAP has its own, 5e-4·h·μN/m as measured in stick.
- The convex solvers stop at a residual of 1e-6 of the total momentum. A heavy master would hide all friction, so for
  the integrators it is light and driven by the gain of its motor. cenic ignores this gain, so a torque through a
  stiff damper drives its master. Below h = 2e-3/rate errors grow.
- On a half-space, Drake crashes with twenty or more spheres, so the plate is a box.
- Drake's springs between bodies act along a line, so the support is a bushing.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from pydrake.geometry import (
    AddCompliantHydroelasticPropertiesForHalfSpace,
    AddContactMaterial,
    AddRigidHydroelasticProperties,
    Box,
    Cylinder,
    HalfSpace,
    ProximityProperties,
    Sphere,
)
from pydrake.math import RigidTransform
from pydrake.multibody.plant import AddMultibodyPlant, CoulombFriction, MultibodyPlantConfig
from pydrake.multibody.tree import (
    FixedOffsetFrame,
    LinearBushingRollPitchYaw,
    PdControllerGains,
    PlanarJoint,
    RevoluteJoint,
    SpatialInertia,
    UnitInertia,
)
from pydrake.systems.analysis import ApplySimulatorConfig, Simulator, SimulatorConfig
from pydrake.systems.framework import DiagramBuilder, LeafSystem

from compare.engines.live.setting import (
    JointModel,
    Model,
    Setting,
    contact_arms,
    inertia_of,
    our_friction,
    radius_of,
    rate,
)
from reference_model.systems import DiscOnDisc, FloatArray, System
from reference_model.trajectory import SimulationError

DEPTH = 1e3
"""Depth of the spheres in the plate in m. SAP lets sliding bodies rise by μ·h times the slip (μ = 1): far less."""

RADIUS = 1e-3  # radius of the spheres in m
FACET = 2.0 * math.pi / 100
"""Angle in rad of an edge of the cylinder's mesh."""

STIFF = 1e9
"""Gain of a motor in 1/s, times the inertia."""

PLATE = 1e5  # edge length of the plate in m


@dataclass(frozen=True)
class _Scheme:
    """A discrete ``solver`` or an ``integrator``, with a heavy or a ``driven`` master.

    A ``hydroelastic`` contact is the flat end of a cylinder, which stands for a ring.
    """

    solver: str = ""
    integrator: str = ""
    driven: bool = False
    our_force: bool = False
    hydroelastic: bool = False


class _Plant:
    """The bodies and a simulator, for one step size in s (0: chosen by the integrator)."""

    def __init__(self, system: System, scheme: _Scheme, step: float, tolerance: float) -> None:
        self.system, self.step, builder = system, step, DiagramBuilder()
        inertia, fastest = inertia_of(system), rate(system)
        self.epsilon = 1e-3 * fastest * step if step else 1e-2 * math.sqrt(tolerance)
        if scheme.solver == "sap":
            self.epsilon = 5e-4 * step * system.friction_force / system.mass
        contact = "hydroelastic" if scheme.hydroelastic else "point"
        config = MultibodyPlantConfig(time_step=step, contact_model=contact, use_sampled_output_ports=False)
        config.stiction_tolerance = self.epsilon or 1.0
        if step:
            config.discrete_contact_approximation, config.sap_near_rigid_threshold = scheme.solver, 0.0
        self.plant, _ = AddMultibodyPlant(config, builder)
        self.plant.mutable_gravity_field().set_gravity_vector(np.zeros(3))
        shaft, shaft_speed = 0.0, 0.0
        if isinstance(system, DiscOnDisc):
            shaft, shaft_speed = system.shaft_damping, system.shaft_speed
        unit, none = UnitInertia(*np.full(3, inertia / system.mass)), np.zeros(3)
        world = self.plant.world_frame()
        body = self.plant.AddRigidBody("disc", SpatialInertia(system.mass, none, unit))
        master_mass = system.mass * ((1e-2 if step else 1.0) if scheme.driven else 1e12)
        master = self.plant.AddRigidBody("master", SpatialInertia(master_mass, none, unit))
        damping = (system.damping, system.damping, shaft)
        self.joint = self.plant.AddJoint(PlanarJoint("disc", world, body.body_frame(), damping))
        drive = 1e6 * inertia * fastest if scheme.driven and not step else 0.0
        axle = RevoluteJoint("master", world, master.body_frame(), (0.0, 0.0, 1.0), drive)
        self.master = self.plant.AddJoint(axle)
        rest = self.plant.AddFrame(FixedOffsetFrame("rest", world, RigidTransform([system.offset, 0.0, 0.0])))
        spring = (none, none, np.full(3, system.stiffness), none)
        self.plant.AddForceElement(LinearBushingRollPitchYaw(rest, body.body_frame(), *spring))
        if not scheme.our_force and system.friction_force > 0.0:
            (self._touch_flat if scheme.hydroelastic else self._touch)(body, master)
        if scheme.driven and step:
            motor = self.plant.AddJointActuator("motor", self.master)
            motor.set_controller_gains(PdControllerGains(p=0.0, d=STIFF * inertia * fastest))
        self.plant.Finalize()
        steady = np.zeros(self.plant.num_velocities())
        steady[self.joint.velocity_start() + 2] = shaft * shaft_speed
        steady[self.master.velocity_start()] = drive * system.disc_speed
        forces = self.plant.get_applied_generalized_force_input_port()
        if scheme.our_force:
            friction = builder.AddSystem(_OurFriction(self, steady))
            builder.Connect(self.plant.get_state_output_port(), friction.get_input_port())
            builder.Connect(friction.get_output_port(), forces)
        self.simulator = Simulator(builder.Build())
        if scheme.integrator:
            accuracy = max(0.1 * tolerance, 1e-13)
            how = SimulatorConfig(
                integration_scheme=scheme.integrator, max_step_size=1.0 / fastest, accuracy=accuracy
            )
            ApplySimulatorConfig(how, self.simulator)
        self.context = self.plant.GetMyMutableContextFromRoot(self.simulator.get_mutable_context())
        if scheme.driven and step:
            speed = self.plant.get_desired_state_input_port(motor.model_instance())
            speed.FixValue(self.context, [0.0, system.disc_speed])
        if not scheme.our_force:
            forces.FixValue(self.context, steady)

    def _touch(self, body: Any, master: Any) -> None:
        material, arms = ProximityProperties(), contact_arms("Drake", self.system)
        in_series = 2.0 * self.system.friction_force / len(arms) / DEPTH
        AddContactMaterial(0.0, in_series, CoulombFriction(1.0, 1.0), material)
        material.AddProperty("material", "relaxation_time", 0.0)
        place = RigidTransform([0.0, 0.0, -0.5 * PLATE])
        self.plant.RegisterCollisionGeometry(master, place, Box(PLATE, PLATE, PLATE), "plate", material)
        for i, arm in enumerate(arms):
            place = RigidTransform([arm.real, arm.imag, RADIUS - DEPTH])
            self.plant.RegisterCollisionGeometry(body, place, Sphere(RADIUS), f"{i}", material)

    def _touch_flat(self, body: Any, master: Any) -> None:
        """Press a rigid cylinder into a soft half-space, whose pressure is modulus times depth over thickness."""
        radius, (hard, soft) = radius_of(self.system), (ProximityProperties(), ProximityProperties())
        for material in (hard, soft):
            AddContactMaterial(0.0, None, CoulombFriction(1.0, 1.0), material)
            material.AddProperty("material", "relaxation_time", 0.0)
        sides = 2.0 * math.pi / FACET
        modulus = self.system.friction_force / (0.5 * sides * math.sin(FACET) * radius**2)
        AddCompliantHydroelasticPropertiesForHalfSpace(1.0, modulus, soft)
        AddRigidHydroelasticProperties(FACET * radius, hard)
        height = RigidTransform([0.0, 0.0, radius - 1.0])  # the flat end is 1 m deep
        self.plant.RegisterCollisionGeometry(master, RigidTransform(), HalfSpace(), "plate", soft)
        self.plant.RegisterCollisionGeometry(body, height, Cylinder(radius, 2.0 * radius), "foot", hard)

    def start(self, state: FloatArray) -> None:
        """Set the initial state."""
        self.steps, self.time, half = 0, 0.0, len(state) // 2
        self.joint.set_translation(self.context, state[:2])
        self.joint.set_translational_velocity(self.context, state[half : half + 2])
        if half == 3:
            self.joint.set_rotation(self.context, state[2])
            self.joint.set_angular_velocity(self.context, state[5])
        self.master.set_angular_rate(self.context, self.system.disc_speed)
        self.simulator.get_mutable_context().SetTime(0.0)
        self.simulator.Initialize()

    def advance(self, duration: float, steps: int) -> FloatArray:
        """Return the state ``duration`` seconds later, after ``steps`` of a discrete solver."""
        self.steps, self.time = self.steps + steps, self.time + duration
        # Ending half a step early completes all steps, whatever the rounding.
        self.simulator.AdvanceTo((self.steps - 0.5) * self.step if self.step else self.time)
        joint, context, half = self.joint, self.context, self.system.state_size // 2
        place = [*joint.get_translation(context), joint.get_rotation(context)]
        speed = [*joint.get_translational_velocity(context), joint.get_angular_velocity(context)]
        return np.array([*place[:half], *speed[:half]])


class _OurFriction(LeafSystem):  # type: ignore[misc]
    """Friction −μN·v/max(|v|, ε) at each point, plus ``steady`` forces on the joints."""

    def __init__(self, model: _Plant, steady: FloatArray) -> None:
        super().__init__()
        self.model, self.steady, self.arms = model, steady, contact_arms("Drake", model.system)
        self.DeclareVectorInputPort("state", model.plant.num_multibody_states())
        self.DeclareVectorOutputPort("forces", len(steady), self._forces)

    def _forces(self, context: Any, output: Any) -> None:
        state, plant, joint = self.get_input_port().Eval(context), self.model.plant, self.model.joint
        places = state[joint.position_start() :][:3].tolist()
        speeds = state[plant.num_positions() + joint.velocity_start() :][:3].tolist()
        system, forces = self.model.system, self.steady.copy()
        friction = our_friction(system, self.arms, [*places, *speeds], self.model.epsilon)
        forces[joint.velocity_start() :][:3] += friction
        output.SetFromVector(forces)


class _Motion(Model):
    """A motion through one plant per step size, because Drake fixes the step of a plant."""

    engine = "Drake"

    def build(self, state: FloatArray, tolerance: float, *, scheme: _Scheme) -> None:
        self.scheme, self.state, self.tolerance = scheme, state, tolerance
        self.plants: dict[float, _Plant] = {}
        self.plant: Any = None
        force = ", our force" if scheme.our_force else ""
        self.method = f"Drake {scheme.solver or scheme.integrator}{force}"

    def advance(self, h: float, number: int) -> FloatArray:
        step = float(f"{h:.9g}") if self.scheme.solver else 0.0
        if step not in self.plants:
            self.plants[step] = _Plant(self.system, self.scheme, step, self.tolerance)
        if self.plant is not self.plants[step]:
            self.plant = self.plants[step]
            self.plant.start(self.state)
            self.epsilon = self.plant.epsilon
        try:
            self.state = self.plant.advance(h * number, number)
        except RuntimeError as error:
            raise SimulationError(f"Drake failed: {error}") from error
        return self.state

    def work(self, steps: int) -> tuple[int, int]:
        if self.scheme.integrator and self.plant:
            integrator = self.plant.simulator.get_integrator()
            steps = integrator.get_num_steps_taken()
            return integrator.get_num_derivative_evaluations() or steps, steps
        return steps, steps


class _Patch(_Motion):
    kinds, patch = ("ring",), True


class _Joint(JointModel):
    """A joint with a motor of speed 0, whose effort limit is the friction moment, because joints have no friction."""

    engine = "Drake"

    def build(self, state: FloatArray, tolerance: float, *, scheme: _Scheme) -> None:
        self.solver, self.h, self.method = scheme.solver, 0.0, f"Drake {scheme.solver}, motor"

    def _start(self, h: float) -> None:
        """Build a plant that starts here, because Drake fixes the step of a plant."""
        builder, inertia, self.h, self.steps = DiagramBuilder(), self.joint.inertia, h, 0
        config = MultibodyPlantConfig(time_step=h, use_sampled_output_ports=False)
        config.discrete_contact_approximation, config.sap_near_rigid_threshold = self.solver, 0.0
        plant, _ = AddMultibodyPlant(config, builder)
        body = plant.AddRigidBody("body", SpatialInertia(inertia, np.zeros(3), UnitInertia(1.0, 1.0, 1.0)))
        plant.mutable_gravity_field().set_gravity_vector(np.zeros(3))
        axle = RevoluteJoint("axle", plant.world_frame(), body.body_frame(), (0.0, 0.0, 1.0))
        self.axle = plant.AddJoint(axle)
        motor = plant.AddJointActuator("motor", self.axle, self.joint.friction_moment)
        motor.set_controller_gains(PdControllerGains(p=0.0, d=STIFF * inertia))
        plant.Finalize()
        self.simulator = Simulator(builder.Build())
        self.context = plant.GetMyMutableContextFromRoot(self.simulator.get_mutable_context())
        plant.get_desired_state_input_port(motor.model_instance()).FixValue(self.context, np.zeros(2))
        self.torque = plant.get_applied_generalized_force_input_port()
        self.axle.set_angle(self.context, self.angle)
        self.axle.set_angular_rate(self.context, self.spin)
        self.simulator.Initialize()

    def turn(self, torque: float, h: float) -> tuple[float, float]:
        if h != self.h:
            self._start(h)
        self.steps += 1
        self.torque.FixValue(self.context, [torque])
        self.simulator.AdvanceTo((self.steps - 0.5) * h)  # completes all steps, whatever the rounding
        return self.axle.get_angle(self.context), self.axle.get_angular_rate(self.context)


tamsi = Setting(
    "TAMSI",
    "with TAMSI and steps of order 1. Drake plans to remove it.",
    _Motion,
    {"scheme": _Scheme("tamsi")},
)
sap = Setting(
    "SAP",
    "with SAP and steps of order 1. It does not improve below a tolerance of 1e-5.",
    _Motion,
    {"scheme": _Scheme("sap", driven=True)},
    finest=2e-3,
    joint=_Joint,
)
lagged = Setting(
    "lagged",
    "with Drake's default, as shipped, and steps of order 1. It does not improve below a tolerance of 1e-5. "
    '"similar" differs from it only if normal forces change, so its results are the same here.',
    _Motion,
    {"scheme": _Scheme("lagged", driven=True)},
    finest=2e-3,
    joint=_Joint,
)
hydroelastic = Setting(
    "hydroelastic",
    "with a disc whose flat face is a hydroelastic contact, by SAP and steps of order 1.",
    _Patch,
    {"scheme": _Scheme("sap", driven=True, hydroelastic=True)},
    finest=2e-3,
)
cenic = Setting(
    "cenic",
    "with the convex solver under error control. Its error falls unevenly, roughly like √tolerance.",
    _Motion,
    {"scheme": _Scheme(integrator="cenic", driven=True)},
    step=None,
)
runge_kutta = Setting(
    "Runge–Kutta 5",
    "with contact as a force and explicit steps of order 5, which shorten to ε·m/μN in stick.",
    _Motion,
    {"scheme": _Scheme(integrator="runge_kutta5")},
    step=None,
)
our_force = Setting(
    "our force",
    "with the force −μN·v/max(|v|, ε) in place of contact, by the same steps of order 5.",
    _Motion,
    {"scheme": _Scheme(integrator="runge_kutta5", our_force=True)},
    step=None,
)
