"""Newton as an engine: with its position-based and semi-implicit solvers, by Warp on the processor.

Written for Newton 1.8.0, in single precision. A ball that cannot turn is pressed on the plate by its weight N, with μ
= 1. The plate is kinematic.
"""

from dataclasses import replace
from importlib.metadata import version
from typing import Any

import newton
import numpy as np
import warp

from compare.engines.live.setting import Model, Setting, support_force
from reference_model.systems import FloatArray

warp.config.quiet = True
RADIUS, PLATE = 0.5, 1e3  # radius of the ball and half the edge length of the plate, in m


class _Model(Model):
    engine = "Newton"
    kinds, linear = ("pin",), False

    def build(self, state: FloatArray, tolerance: float, *, solver: str) -> None:
        system = self.system
        self.method = f"Newton {version('newton')}, {solver}"
        builder = newton.ModelBuilder(gravity=(0.0, 0.0, -system.friction_force / system.mass))
        touch = newton.ModelBuilder.ShapeConfig(mu=1.0, density=0.0)
        plate = builder.add_body(xform=_pose(0.0, 0.0, -1.0), is_kinematic=True)
        builder.add_shape_box(plate, hx=PLATE, hy=PLATE, hz=1.0, cfg=touch)
        x, y, vx, vy = state.tolist()
        ball = builder.add_body(xform=_pose(x, y, RADIUS), mass=system.mass, inertia=1e9 * np.eye(3))
        builder.add_shape_sphere(ball, radius=RADIUS, cfg=touch)
        with warp.ScopedDevice("cpu"):
            self.model = builder.finalize()
            self.solver = getattr(newton.solvers, f"Solver{solver}")(self.model)
            self.now, self.next = self.model.state(), self.model.state()
            self.contacts, self.control = self.model.contacts(), self.model.control()
        speeds = self.now.body_qd.numpy()  # velocity and angular velocity of each body
        speeds[plate, 5], speeds[ball, :2] = system.disc_speed, (vx, vy)
        self.plate, self.ball, self.angle = plate, ball, 0.0
        self.now.body_qd.assign(speeds)

    def _state(self) -> FloatArray:
        place, speed = self.now.body_q.numpy()[self.ball], self.now.body_qd.numpy()[self.ball]
        return np.array([*place[:2], *speed[:2]], dtype=float)

    def advance(self, h: float, number: int) -> FloatArray:
        forces = np.zeros((2, 6), dtype=np.float32)
        for _ in range(number):
            x, y, vx, vy = self._state().tolist()
            force = support_force(self.system, complex(x, y), complex(vx, vy))
            forces[self.ball, :2] = force.real, force.imag
            self.now.body_f.assign(forces)
            self.model.collide(self.now, self.contacts)
            self.solver.step(self.now, self.next, self.control, self.contacts, h)
            self.now, self.next = self.next, self.now
        return self._state()


def _pose(x: float, y: float, z: float) -> Any:
    return warp.transform((x, y, z), warp.quat_identity())


xpbd = Setting(
    "XPBD, as shipped",
    "with its position-based solver and two iterations, its default, in single precision: steps of order 1.",
    _Model,
    {"solver": "XPBD"},
    finest=2e-3,
    precision=1e-6,
)
semi_implicit = replace(
    xpbd,
    name="semi-implicit, as shipped",
    says="with contact by stiff springs and regularised friction, its defaults, in single precision.",
    options={"solver": "SemiImplicit"},
)
