"""MuJoCo as an engine: its elliptic and its pyramidal cone, and our law as a force of the user.

Written for MuJoCo 4.0 (``pip install mujoco``; wheels for Linux, macOS and Windows). Pin or disc is on two sliding
joints, a disc on a hinge too; springs and dampers are the joints' own. Below it are n feet, spheres on vertical
joints of their own, so that each is pressed on the plate by its weight N/n and by nothing else. The plate is a
cylinder on a hinge that turns at ω, too heavy to notice.

What MuJoCo leaves to choose, and why so:

- Contact is soft: friction is what within the cone brings (a + b·v) nearest to zero, with a compliance of 1e-4. It
  acts along v + a₀/b, with a₀ the acceleration without it, so that b ~ 1/h makes an error of first order in the step.
  At b = 2/h it acts along the slip midway in the step. Only ``solref`` in its direct form sets b.
- As in every convex contact model a foot that slides rises with μ times its slip. With a small μ, no stiffness and a
  margin that is wider than all it rises, it neither leaves the plate nor feels another load.
- The solver's own tolerance is relative to all inertia and would be met at once with the heavy plate: it is 0, and
  iterations are bounded. A pyramid takes more of them, with many points far more than an ellipse.

What it can't do: a pyramid's friction acts along the nearest axis of the world, up to 45° off, at any step. With
that and with Runge–Kutta steps a pin that sticks creeps in proportion to the step, with the ellipse to its square.
There is no continuous ring of contact.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import mujoco
import numpy as np

from compare.engines.live.setting import Model, Setting, contact_arms, inertia_of, mobility, our_friction
from reference_model.systems import DiscOnDisc, FloatArray, System

FRICTION_COEFFICIENT = 1e-5
"""μ: the least that MuJoCo takes."""

SIZE = 1e6
"""Of feet and plate in m: more than a foot sinks or rises. It acts on nothing in the plane."""


class _Model(Model):
    """MuJoCo with contact, b·h = ``friction_rate``, or with our force if there is no ``cone``."""

    engine = "MuJoCo"

    def __init__(
        self,
        system: System,
        state: FloatArray,
        _: float,
        *,
        integrator: str = "Euler",
        cone: str = "",
        friction_rate: float = 0.0,
        iterations: int = 0,
    ) -> None:
        self.system, self.cone, self.friction_rate, self.half = system, cone, friction_rate, len(state) // 2
        self.arms = contact_arms("MuJoCo", system)
        self.stages = 4 if integrator == "RK4" else 1
        friction = f"{cone} cone" if cone else "our force"
        self.method = f"MuJoCo {mujoco.__version__}, {integrator}, {friction}"
        option = f'integrator="{integrator}"' + (f' cone="{cone}" iterations="{iterations}"' if cone else "")
        self.model = mujoco.MjModel.from_xml_string(_xml(system, self.arms, option, native=bool(cone)))
        self.data = mujoco.MjData(self.model)
        self.data.qpos[: self.half], self.data.qvel[: self.half] = np.split(state, 2)
        if cone:
            self.data.qvel[-1] = system.disc_speed
        if isinstance(system, DiscOnDisc):
            self.data.qfrc_applied[2] = system.shaft_damping * system.shaft_speed

    def advance(self, h: float, number: int) -> FloatArray:
        model, data = self.model, self.data
        model.opt.timestep = h
        if self.cone:
            model.pair_solref[:, 1] = -1.0 / h
            model.pair_solreffriction[:, 1] = -self.friction_rate / h
            mujoco.mj_step(model, data, nstep=number)
        else:
            self.epsilon = 0.5 * h * self.system.friction_force * mobility(self.system)
            with _passive_force(self._add_friction):
                mujoco.mj_step(model, data, nstep=number)
        self.steps += number
        self.evaluations += self.stages * number
        state = np.concatenate((data.qpos[: self.half], data.qvel[: self.half]))
        # Where it diverges, MuJoCo warns and starts from the beginning.
        return np.full_like(state, np.nan) if any(warning.number for warning in data.warning) else state

    def _add_friction(self, _: Any, data: Any) -> None:
        state = [*data.qpos.tolist(), *data.qvel.tolist()]
        data.qfrc_passive += our_friction(self.system, self.arms, state, self.epsilon)


def _xml(system: System, arms: list[complex], option: str, *, native: bool) -> str:
    """Return the model: the joints of pin or disc first, then those of the feet, and that of the plate last."""
    disc = isinstance(system, DiscOnDisc)
    inertia = inertia_of(system)
    feet = arms if native else []
    # Half of what mass and inertia allow is in the feet.
    foot = min(system.mass, inertia / abs(arms[0]) ** 2 if disc else system.mass) / 2.0 / len(arms)
    spin = 0.1 * inertia / len(arms)
    mass = system.mass - len(feet) * foot
    inertia -= sum(foot * abs(arm) ** 2 + spin for arm in feet)
    weight = system.friction_force / FRICTION_COEFFICIENT / len(arms)
    support = f'stiffness="{system.stiffness!r}" damping="{system.damping!r}"'
    turn = (
        f'<joint type="hinge" axis="0 0 1" damping="{system.shaft_damping!r}"/>'
        if isinstance(system, DiscOnDisc)
        else ""
    )
    bodies = "".join(
        f"""<body pos="{arm.real!r} {arm.imag!r} {SIZE}"><joint type="slide" axis="0 0 1"/>
            <inertial pos="0 0 0" mass="{foot!r}" diaginertia="{spin!r} {spin!r} {spin!r}"/>
            <geom name="{i}" type="sphere" size="{SIZE}" contype="0"/></body>"""
        for i, arm in enumerate(feet)
    )
    pairs = "".join(
        f"""<pair geom1="plate" geom2="{i}" condim="3" margin="{0.5 * SIZE}" solimp="0.9999 0.9999 1 0.5 2"
            friction="{FRICTION_COEFFICIENT} {FRICTION_COEFFICIENT}" solref="0 -1" solreffriction="0 -1"/>"""
        for i in range(len(feet))
    )
    plate = f"""<body pos="0 0 {-SIZE}"><joint type="hinge" axis="0 0 1" armature="{1e12 * system.mass}"/>
        <geom name="plate" type="cylinder" size="{1e3 * SIZE} {SIZE}" mass="1"/></body>"""
    return f"""<mujoco>
        <option {option} tolerance="0" gravity="0 0 {-weight / foot!r}"><flag refsafe="disable"/></option>
        <worldbody>
            <body><inertial pos="0 0 0" mass="{mass!r}" diaginertia="{inertia!r} {inertia!r} {inertia!r}"/>
                <joint type="slide" axis="1 0 0" springref="{system.offset!r}" {support}/>
                <joint type="slide" axis="0 1 0" {support}/>{turn}{bodies}</body>
            {plate if native else ""}
        </worldbody>
        <contact>{pairs}</contact></mujoco>"""


@contextmanager
def _passive_force(add: Callable[[Any, Any], None]) -> Iterator[None]:
    """Let MuJoCo, which has one place for it in all, call ``add`` whenever it evaluates the equations of motion."""
    before = mujoco.get_mjcb_passive()
    mujoco.set_mjcb_passive(add)
    try:
        yield
    finally:
        mujoco.set_mjcb_passive(before)


simulate_elliptic = Setting(
    "elliptic cone",
    "with the elliptic cone, by semi-implicit Euler steps: of order 1 where contact slides, of order 2 where it "
    "sticks.",
    _Model,
    {"cone": "elliptic", "friction_rate": 2.0, "iterations": 10},
)
simulate_elliptic_rk4 = Setting(
    "elliptic cone, RK4",
    "with the elliptic cone, by Runge–Kutta steps with b = 1e4/h, Coulomb's law but in stick. There the friction "
    "force jumps from side to side between steps, and the error is of order 1.",
    _Model,
    {"integrator": "RK4", "cone": "elliptic", "friction_rate": 1e4, "iterations": 10},
)
simulate_pyramidal = Setting(
    "pyramidal cone",
    "with the pyramidal cone, MuJoCo's default; it converges to that of friction along an axis.",
    _Model,
    {"cone": "pyramidal", "friction_rate": 1.0, "iterations": 100},
)
simulate_with_our_force = Setting(
    "our force",
    "with −μN·v/max(|v|, ε) in place of contact, by Runge–Kutta steps. ε is half of what friction changes of the "
    "slip in a step: they would be unstable in stick with 0.7 times that.",
    _Model,
    {"integrator": "RK4"},
)
SETTINGS = (simulate_elliptic, simulate_elliptic_rk4, simulate_pyramidal, simulate_with_our_force)
