"""ODE as an engine: friction along the slip, or its default box along the axes of the world.

Written for ODE 0.16 by Py3ODE, in double precision. Contact joints are at the height of the centre of mass, so
friction does not tip the body. The plate is a kinematic body that turns at ω.

- By default, ODE bounds friction in each of two directions by a constant, here μN/n, whatever the load. A direction
  along the slip, and none across it, give the cone. A bound across the slip would hold the body on its course.
- Steps are semi-implicit, so friction opposes the slip at their end. Springs, dampers and shaft are forces.
"""

import cmath
from importlib.metadata import version

import numpy as np
import ode

from compare.engines.live.setting import JointModel, Model, Setting, inertia_of, shaft_torque, support_force
from reference_model.systems import FloatArray

FMAX = 5
"""``dParamFMax`` of ODE 0.16; ``ode.ParamFMax`` of Py3ODE 1.2 is the number of an older ODE, which has no effect."""


class _World(Model):
    engine = "ODE"
    linear = False

    def build(self, state: FloatArray, tolerance: float, *, along_slip: bool) -> None:
        system, self.along_slip, self.turn = self.system, along_slip, 0.0
        self.method = f"ODE by Py3ODE {version('Py3ODE')}, semi-implicit Euler"
        self.world, self.contacts = ode.World(), ode.JointGroup()
        self.plate, self.body, mass = ode.Body(self.world), ode.Body(self.world), ode.Mass()
        mass.setParameters(system.mass, 0.0, 0.0, 0.0, *[inertia_of(system)] * 3, 0.0, 0.0, 0.0)
        self.body.setMass(mass)
        self.plate.setKinematic()
        self.plate.setAngularVel((0.0, 0.0, system.disc_speed))
        places, speeds = state.reshape(2, -1).tolist()
        self.body.setPosition((*places[:2], 0.0))
        self.body.setLinearVel((*speeds[:2], 0.0))
        if self.half > 2:
            self.turn = places[2]
            self.body.setAngularVel((0.0, 0.0, speeds[2]))

    def advance(self, h: float, number: int) -> FloatArray:
        body = self.body
        for _ in range(number):
            z, v, spin = complex(*body.getPosition()[:2]), complex(*body.getLinearVel()[:2]), self._spin()
            force = support_force(self.system, z, v)
            body.addForce((force.real, force.imag, 0.0))
            body.addTorque((0.0, 0.0, shaft_torque(self.system, spin)))
            for unturned in self.arms:
                arm = unturned * cmath.rect(1.0, self.turn)
                self._touch(z + arm, v + 1j * (spin * arm - self.system.disc_speed * (z + arm)))
            self.world.step(h)
            self.contacts.empty()
            self.turn += h * self._spin()
        places = (*body.getPosition()[:2], self.turn)[: self.half]
        return np.array([*places, *(*body.getLinearVel()[:2], self._spin())[: self.half]])

    def _spin(self) -> float:
        return float(self.body.getAngularVel()[2])

    def _touch(self, place: complex, slip: complex) -> None:
        contact = ode.Contact()
        contact.setContactGeomParams((place.real, place.imag, 0.0), (0.0, 0.0, 1.0), 0.0)
        contact.setMu(self.system.friction_force / len(self.arms))
        if self.along_slip and slip:
            contact.setMode(ode.ContactFDir1 | ode.ContactMu2)
            contact.setFDir1((slip.real / abs(slip), slip.imag / abs(slip), 0.0))
            contact.setMu2(0.0)
        ode.ContactJoint(self.world, self.contacts, contact).attach(self.body, self.plate)


class _Joint(JointModel):
    """A hinge with a motor of speed 0, whose force limit is the friction moment."""

    engine = "ODE"
    method = f"ODE by Py3ODE {version('Py3ODE')}, semi-implicit Euler, hinge motor"

    def build(self, state: FloatArray, tolerance: float, *, along_slip: bool) -> None:
        self.world, mass, inertia = ode.World(), ode.Mass(), self.joint.inertia
        self.body, self.hinge = ode.Body(self.world), ode.HingeJoint(self.world)
        mass.setParameters(inertia, 0.0, 0.0, 0.0, *[inertia] * 3, 0.0, 0.0, 0.0)
        self.body.setMass(mass)
        self.body.setAngularVel((0.0, 0.0, self.spin))
        self.hinge.attach(self.body, ode.environment)
        self.hinge.setAnchor((0.0, 0.0, 0.0))
        self.hinge.setAxis((0.0, 0.0, 1.0))
        self.hinge.setParam(FMAX, self.joint.friction_moment)

    def turn(self, torque: float, h: float) -> tuple[float, float]:
        self.body.addTorque((0.0, 0.0, torque))
        self.world.step(h)
        spin = float(self.body.getAngularVel()[2])
        return self.angle + h * spin, spin


along_slip = Setting(
    "along the slip",
    "with friction along the slip alone, by fdir1 and a mu2 of 0, which is Coulomb's cone with steps of order 1.",
    _World,
    {"along_slip": True},
    joint=_Joint,
)
shipped = Setting("as shipped", "with its default box.", _World, {"along_slip": False}, joint=_Joint)
