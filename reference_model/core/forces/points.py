"""Friction of contact points, which turn with the disc, and the point that comes to rest first.

The velocity of point j is v_j = v + i·r·(η_j − η)·exp(iφ), with the velocity v of the point at η. Friction, −g·q_j
along v_j, turns a small velocity fast, at rates of about g/|v_j|. Their mean, weighted by the load, stretches time.
"""

import math

import numpy as np

from reference_model.core.forces.law import CENTRE, WIDTH, Law, arm
from reference_model.numerics.parts import inlined, part
from reference_model.systems import FloatArray

CLOSE = 0.1
"""Largest slip speed of a point whose slip is an unknown, as a share of the relative speed of its neighbour."""

NONE = 1e-300


@part
def friction_of_points(
    vx: float, vy: float, r: float, angle: float, law: Law
) -> tuple[float, float, float, float]:
    """Return the acceleration by friction of the centre and of r, and the pace of stretched time."""
    c, s = math.cos(angle), math.sin(angle)
    wx, wy = c * vx + s * vy, c * vy - s * vx
    fx = fy = moment = rate = 0.0
    around = law.around
    for j in range(0, len(around), WIDTH):
        x, y, share = around[j], around[j + 1], around[j + 2]
        px, py = wx - r * (y - law.arm_y), wy + r * (x - law.arm_x)
        inverse = 1.0 / max(math.sqrt(px * px + py * py), NONE)
        px, py = px * inverse, py * inverse
        fx -= share * px
        fy -= share * py
        moment -= share * (x * py - y * px)
        rate += share * inverse
    g = law.friction
    return g * (c * fx - s * fy), g * (s * fx + c * fy), g * moment, 1.0 / (1.0 + law.stretch * rate)


@part
def turning_of_friction(vx: float, vy: float, r: float, angle: float, law: Law) -> FloatArray:
    """Return the derivatives of force and moment by vx, vy, r and the angle, shape (3, 4)."""
    c, s = math.cos(angle), math.sin(angle)
    result = np.zeros((3, 4))
    by = np.zeros(4)
    around = law.around
    for j in range(0, len(around), WIDTH):
        ax, ay = c * around[j] - s * around[j + 1], s * around[j] + c * around[j + 1]
        x, y = around[j] - law.arm_x, around[j + 1] - law.arm_y
        dx, dy = c * x - s * y, s * x + c * y
        px, py = vx - r * dy, vy + r * dx
        inverse = 1.0 / max(math.sqrt(px * px + py * py), NONE)
        px, py = px * inverse, py * inverse
        most = law.friction * around[j + 2]
        # Only the component across the slip, along (−p_y, p_x), changes friction.
        by[0], by[1], by[2], by[3] = -py, px, dy * py + dx * px, r * (dx * py - dy * px)
        for k in range(4):
            turned = -most * inverse * by[k]
            result[0, k] -= turned * py
            result[1, k] += turned * px
            result[2, k] += turned * (ax * px + ay * py)
        result[2, 3] -= most * (-ay * py - ax * px)
    return result


@part
def slowest_point(ux: float, uy: float, r: float, angle: float, law: Law) -> tuple[int, float]:
    """Return the slowest contact point and its speed, for the slip of the centre."""
    c, s = math.cos(angle), math.sin(angle)
    wx, wy = c * ux + s * uy, c * uy - s * ux
    found, least = CENTRE, math.inf
    for i in range(len(law.around) // WIDTH):
        px, py = wx - r * law.around[WIDTH * i + 1], wy + r * law.around[WIDTH * i]
        speed = math.sqrt(px * px + py * py)
        if speed < least:
            found, least = i, speed
    return found, least


@part
def point_to_follow(ux: float, uy: float, r: float, angle: float, law: Law) -> int:
    """Return the contact point that slips so slowly that its own velocity should be an unknown, or the centre."""
    point, speed = slowest_point(ux, uy, r, angle, law)
    if point != CENTRE and speed < CLOSE * abs(r) * law.around[WIDTH * point + 6]:
        return point
    return CENTRE


@inlined
def centre_slip(vx: float, vy: float, r: float, angle: float, law: Law) -> tuple[float, float]:
    """Return the slip of the centre."""
    if law.point == CENTRE:
        return vx, vy
    x, y = arm(angle, law)
    return vx + r * y, vy - r * x


@part
def of_point(ax: float, ay: float, ar: float, r: float, angle: float, law: Law) -> tuple[float, float]:
    """Return the rate of the slip of the point that ``law`` follows, from the rates of the centre and of r."""
    x, y = arm(angle, law)
    turn = r * (law.omega + r / law.gyration)
    return ax - y * ar - turn * x, ay + x * ar - turn * y


@part
def slip_of(ux: float, uy: float, r: float, angle: float, law: Law) -> tuple[float, float]:
    """Return the slip of the point that ``law`` follows, for the slip of the centre."""
    if law.point == CENTRE:
        return ux, uy
    x, y = arm(angle, law)
    return ux - r * y, uy + r * x


def around_of(places: list[tuple[float, float, float]], gyration: float) -> FloatArray:
    """Return ``Law.around`` for positions and shares of contact points, shape (7·n,)."""
    arms = np.array([complex(x, y) for x, y, _ in places]) / gyration
    shares = np.array([share for _, _, share in places])
    rows = []
    for i in range(len(arms)):
        apart = arms - arms[i]
        distance = np.where(abs(apart) > 0.0, abs(apart), 1.0)
        directions = shares * 1j * apart / distance
        force, moment = complex(directions.sum()), float((arms.conj() * directions).imag.sum())
        others = np.delete(abs(apart), i)
        rows += [arms[i].real, arms[i].imag, shares[i], force.real, force.imag, moment, float(others.min())]
    return np.array(rows)
