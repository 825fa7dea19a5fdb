"""MuJoCo as an engine: with its elliptic and pyramidal cones, and with our law as a user force.

Written for MuJoCo 4.0. The pin or disc is on two sliding joints with springs and dampers; a disc also has a hinge.
The plate is a cylinder on a hinge, too heavy to be slowed.

- Contact is soft: friction is the force within the cone that brings a + b·v nearest to zero. It acts along v + a₀/b,
  with the acceleration a₀ without friction, so b ~ 1/h causes a first-order error. At b = 2/h it acts along the slip
  at mid-step. Only the direct form of ``solref`` sets b.
- As in every convex contact model, a sliding foot rises at μ times its slip. With a small μ, zero stiffness and a
  margin above the total rise, it neither leaves the plate nor changes its load.
- The solver's tolerance is relative to the total inertia, so the heavy plate would satisfy it at once. It is 0, and
  the number of iterations is limited.

As shipped, the contact has all of MuJoCo's defaults. The feet weigh 9.81 m/s² times half the mass. A plate at rest is
fixed. A turning plate is only a hundred times heavier than the body, for the solver's tolerance, and its speed is set
before each step.

A pyramid's friction acts along the nearest world axis. A sticking pin creeps in proportion to the step with the
pyramid or Runge–Kutta steps, and to its square with the ellipse.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np

from compare.engines.live.setting import (
    JointModel,
    Model,
    Setting,
    inertia_of,
    mobility,
    our_friction,
    radius_of,
)
from reference_model.systems import DiscOnDisc, FloatArray, System

LEAST_COEFFICIENT = 1e-5  # smallest μ that MuJoCo accepts


@dataclass(frozen=True)
class _Contact:
    """Attributes of contact and solver, with b·h = ``friction_rate``; 0 leaves MuJoCo's defaults."""

    option: str = ""
    friction_rate: float = 0.0
    gravity: float = 9.81
    size: float = 1.0
    plate: float = 1e2
    pair: str = ""
    condim: int = 3

    @classmethod
    def rigid(cls, cone: str, friction_rate: float, iterations: int, condim: int = 3) -> _Contact:
        """Return a contact that converges to Coulomb's law.

        Feet and plate are much larger than the vertical motion of a foot, so it does not affect horizontal motion.
        """
        pair = 'margin="5e5" solimp="0.9999 0.9999 1 0.5 2" solref="0 -1" solreffriction="0 -1"'
        option = f'cone="{cone}" iterations="{iterations}" tolerance="0"'
        return cls(option, friction_rate, gravity=math.inf, size=1e6, plate=1e12, pair=pair, condim=condim)


class _Model(Model):
    engine = "MuJoCo"

    def build(
        self,
        state: FloatArray,
        tolerance: float,
        *,
        integrator: str = "Euler",
        contact: _Contact | None = None,
        friction: str = "our force",
    ) -> None:
        system, self.contact = self.system, contact
        self.stages = 4 if integrator == "RK4" else 1
        self.method = f"MuJoCo {mujoco.__version__}, {integrator}, {friction}"
        self.turns = contact is not None and (contact.friction_rate > 0.0 or system.disc_speed != 0.0)
        option = f'integrator="{integrator}"'
        self.model = mujoco.MjModel.from_xml_string(_xml(system, self.arms, option, contact, self.turns))
        self.data = mujoco.MjData(self.model)
        self.data.qpos[: self.half], self.data.qvel[: self.half] = np.split(state, 2)
        if self.turns:
            self.data.qvel[-1] = system.disc_speed
        if isinstance(system, DiscOnDisc):
            self.data.qfrc_applied[2] = system.shaft_damping * system.shaft_speed

    def advance(self, h: float, number: int) -> FloatArray:
        model, data = self.model, self.data
        model.opt.timestep = h
        contact = self.contact
        if contact is not None and contact.friction_rate:
            model.pair_solref[:, 1] = -1.0 / h
            model.pair_solreffriction[:, 1] = -contact.friction_rate / h
            mujoco.mj_step(model, data, nstep=number)
        elif contact is not None:
            for _ in range(number):
                if self.turns:
                    data.qvel[-1] = self.system.disc_speed
                mujoco.mj_step(model, data)
        else:
            self.epsilon = 0.5 * h * self.system.friction_force * mobility(self.system)
            with _passive_force(self._add_friction):
                mujoco.mj_step(model, data, nstep=number)
        state = np.concatenate((data.qpos[: self.half], data.qvel[: self.half]))
        # If the motion diverges, MuJoCo warns and restarts from the initial state.
        return np.full_like(state, np.nan) if any(warning.number for warning in data.warning) else state

    def work(self, steps: int) -> tuple[int, int]:
        return self.stages * steps, steps

    def _add_friction(self, _: Any, data: Any) -> None:
        state = [*data.qpos.tolist(), *data.qvel.tolist()]
        data.qfrc_passive += our_friction(self.system, self.arms, state, self.epsilon)


class _Patch(_Model):
    kinds, patch = ("ring",), True


class _Joint(JointModel):
    """A hinge with ``frictionloss``."""

    engine = "MuJoCo"
    method = f"MuJoCo {mujoco.__version__}, Euler, frictionloss"

    def build(self, state: FloatArray, tolerance: float, *, contact: _Contact, **_: Any) -> None:
        joint, self.contact = self.joint, contact
        rigid = 'solimpfriction="0.9999 0.9999 1 0.5 2"' if contact.friction_rate else ""
        flag = '<flag refsafe="disable"/>' if contact.friction_rate else ""
        self.model = mujoco.MjModel.from_xml_string(f"""<mujoco>
            <option gravity="0 0 0" {contact.option}>{flag}</option>
            <worldbody><body>
                <inertial pos="0 0 0" mass="1" diaginertia="{3 * f" {joint.inertia!r}"}"/>
                <joint type="hinge" axis="0 0 1" frictionloss="{joint.friction_moment!r}" {rigid}/>
            </body></worldbody></mujoco>""")
        self.data = mujoco.MjData(self.model)
        (self.data.qpos[0],), (self.data.qvel[0],) = np.split(state, 2)

    def turn(self, torque: float, h: float) -> tuple[float, float]:
        self.model.opt.timestep = h
        if self.contact.friction_rate:
            self.model.dof_solref[0] = 0.0, -1.0 / h
        self.data.qfrc_applied[0] = torque
        mujoco.mj_step(self.model, self.data)
        return float(self.data.qpos[0]), float(self.data.qvel[0])


def _xml(system: System, arms: list[complex], option: str, contact: _Contact | None, turns: bool) -> str:
    """Return the model, with joints in this order: pin or disc, feet, plate."""
    radius = radius_of(system) or 1.0
    inertia = inertia_of(system)
    feet, touch = (arms, contact) if contact else ([], _Contact())
    size, rigid = touch.size, touch.friction_rate > 0.0 or not contact
    # The feet take half of the largest mass that mass and inertia allow.
    foot = min(system.mass, inertia / abs(arms[0]) ** 2 if arms[0] else system.mass) / 2.0 / len(arms)
    spin = 0.1 * inertia / len(arms)
    mass = system.mass - len(feet) * foot
    inertia -= sum(foot * abs(arm) ** 2 + spin for arm in feet)
    load = system.friction_force / len(arms)
    mu = max(LEAST_COEFFICIENT / min(radius, 1.0), load / (foot * touch.gravity))
    support = f'stiffness="{system.stiffness!r}" damping="{system.damping!r}"'
    turn = (
        f'<joint type="hinge" axis="0 0 1" damping="{system.shaft_damping!r}"/>'
        if isinstance(system, DiscOnDisc)
        else ""
    )
    bodies = "".join(
        f"""<body pos="{arm.real!r} {arm.imag!r} {size}"><joint type="slide" axis="0 0 1"/>
            <inertial pos="0 0 0" mass="{foot!r}" diaginertia="{spin!r} {spin!r} {spin!r}"/>
            <geom name="{i}" type="sphere" size="{size}" contype="0"/></body>"""
        for i, arm in enumerate(feet)
    )
    pairs = "".join(
        f'<pair geom1="plate" geom2="{i}" condim="{touch.condim}" friction="{mu} {mu} {mu * radius}" {touch.pair}/>'
        for i in range(len(feet))
    )
    hinge = f'<joint type="hinge" axis="0 0 1" armature="{touch.plate * system.mass}"/>' if turns else ""
    plate = f"""<body pos="0 0 {-size}">{hinge}
        <geom name="plate" type="cylinder" size="{1e3 * size} {size}" mass="1"/></body>"""
    flag = '<flag refsafe="disable"/>' if rigid else ""
    return f"""<mujoco>
        <option {option} {touch.option} gravity="0 0 {-load / (mu * foot)!r}">{flag}</option>
        <worldbody>
            <body><inertial pos="0 0 0" mass="{mass!r}" diaginertia="{inertia!r} {inertia!r} {inertia!r}"/>
                <joint type="slide" axis="1 0 0" springref="{system.offset!r}" {support}/>
                <joint type="slide" axis="0 1 0" {support}/>{turn}{bodies}</body>
            {plate if contact else ""}
        </worldbody>
        <contact>{pairs}</contact></mujoco>"""


@contextmanager
def _passive_force(add: Callable[[Any, Any], None]) -> Iterator[None]:
    """Set MuJoCo's only, global callback for passive forces temporarily."""
    before = mujoco.get_mjcb_passive()
    mujoco.set_mjcb_passive(add)
    try:
        yield
    finally:
        mujoco.set_mjcb_passive(before)


ellipse = Setting(
    "elliptic cone",
    "with the elliptic cone and semi-implicit Euler steps, of order 1 in slip and of order 2 in stick.",
    _Model,
    {"contact": _Contact.rigid("elliptic", 2.0, 10), "friction": "elliptic cone"},
    joint=_Joint,
)
ellipse_rk4 = Setting(
    "elliptic cone, RK4",
    "with the elliptic cone and Runge–Kutta steps with b = 1e4/h, which is Coulomb's law except in stick. In stick, "
    "the friction force alternates between steps, and the error is of order 1.",
    _Model,
    {"integrator": "RK4", "contact": _Contact.rigid("elliptic", 1e4, 10), "friction": "elliptic cone"},
)
pyramid = Setting(
    "pyramidal cone",
    "with MuJoCo's default pyramid in rigid contact. It converges to the motion with friction along an axis.",
    _Model,
    {"contact": _Contact.rigid("pyramidal", 1.0, 100), "friction": "pyramidal cone"},
)
shipped = Setting(
    "as shipped",
    "with all its defaults: the pyramid, and soft contact that creeps under any load at any step.",
    _Model,
    {"contact": _Contact(), "friction": "as shipped"},
    joint=_Joint,
)
elliptic = Setting(
    "cone=elliptic alone",
    "with the elliptic cone and otherwise all its defaults: soft contact, which creeps at any step.",
    _Model,
    {"contact": _Contact('cone="elliptic"'), "friction": "elliptic cone, soft contact"},
)
condim_4 = Setting(
    "condim 4",
    "with a disc on one contact of condim 4, with friction against spin, in the elliptic cone and rigid contact.",
    _Patch,
    {"contact": _Contact.rigid("elliptic", 2.0, 10, condim=4), "friction": "condim 4"},
)
condim_6 = Setting(
    "condim 6",
    "with a disc on one contact of condim 6, which also opposes rolling.",
    _Patch,
    {"contact": _Contact.rigid("elliptic", 2.0, 10, condim=6), "friction": "condim 6"},
)
condim_4_shipped = Setting(
    "condim 4, as shipped",
    "with a disc on one contact of condim 4, in the default pyramid and soft contact.",
    _Patch,
    {"contact": _Contact(condim=4), "friction": "condim 4"},
)
our_force = Setting(
    "our force",
    "with the force −μN·v/max(|v|, ε) in place of contact, by Runge–Kutta steps. ε is half the change of slip by "
    "friction in a step; steps would be unstable in stick with 0.7 times this ε.",
    _Model,
    {"integrator": "RK4"},
)
