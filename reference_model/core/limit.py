"""The limit surface of contact points: whether friction holds a disc at rest, and how its slip begins.

Friction holds a force F and a moment M, per unit of friction and about the centre of mass, if F·u + M·w <= P(u, w)
for every slip, where P is the mean of |u + i·w·η_j| weighted by the shares of the load. This is M <= h(F) and
−M <= h(−F) with h(F) = min over u of P(u, 1) − F·u, a convex Fermat-Weber problem. If its solution is a vertex,
u = −i·η_j, the disc begins to turn about the resting point j. See :mod:`reference_model.contact.limit_surface`.
"""

import math

import numpy as np

from reference_model.core.forces.law import CENTRE, WIDTH, Law, seen_from
from reference_model.core.forces.pivot import turning
from reference_model.core.forces.rates import pull
from reference_model.core.steps.collocation import solve_linear
from reference_model.numerics.parts import part
from reference_model.systems import FloatArray

MOST_ITERATIONS = 200

SINGULAR = 1e-15
"""Smallest ratio of determinant to squared trace of a Hessian, zero for points on one line."""

ARMIJO = 1e-4
"""Smallest ratio of a step's descent to the descent that the slope predicts."""

ROUNDING = 4e-16
"""Rounding error of a mean of unit vectors."""

SMOOTH, NARROWER, STAGES = 0.5, 0.01, 4
"""First width of the smoothed kinks as a share of the growth, ratio of successive widths, and their number."""

LEAST_SLIP = 1e-100
"""Negligible slip speed that still gives friction a direction."""

AT_LIMIT = 1e-12
"""Relative excess of the friction that holds a disc which counts as rounding error."""


@part
def cost(ux: float, uy: float, fx: float, fy: float, law: Law) -> float:
    """Return P(u, 1) − F·u."""
    total, around = -fx * ux - fy * uy, law.around
    for j in range(0, len(around), WIDTH):
        vx, vy = ux - around[j + 1], uy + around[j]
        total += around[j + 2] * math.sqrt(vx * vx + vy * vy)
    return total


@part
def largest_moment(fx: float, fy: float, law: Law) -> tuple[float, float, float]:
    """Return h for a force below 1, and the slip u that belongs to it."""
    around = law.around
    mx = my = spread = 0.0
    for j in range(0, len(around), WIDTH):
        if math.sqrt((fx - around[j + 3]) ** 2 + (fy - around[j + 4]) ** 2) <= around[j + 2]:
            ux, uy = around[j + 1], -around[j]
            return cost(ux, uy, fx, fy, law), ux, uy
        mx += around[j + 2] * around[j + 1]
        my -= around[j + 2] * around[j]
    for j in range(0, len(around), WIDTH):
        spread += around[j + 2] * ((around[j + 1] - mx) ** 2 + (around[j] + my) ** 2)
    radius = math.sqrt(spread)
    # Exact for large |u| and points with the same spread in all directions.
    far = radius / (2.0 * math.sqrt(max(1.0 - math.sqrt(fx * fx + fy * fy), 1e-18)))
    ux, uy = mx + far * fx, my + far * fy
    value = cost(ux, uy, fx, fy, law)
    for _ in range(MOST_ITERATIONS):
        gx, gy = -fx, -fy
        xx = xy = yy = weights = px = py = 0.0
        for j in range(0, len(around), WIDTH):
            share, vx, vy = around[j + 2], ux - around[j + 1], uy + around[j]
            d = max(math.sqrt(vx * vx + vy * vy), 1e-300)
            ex, ey, weight = vx / d, vy / d, share / d
            gx += share * ex
            gy += share * ey
            xx += weight * ey * ey
            yy += weight * ex * ex
            xy -= weight * ex * ey
            weights += weight
            px += weight * around[j + 1]
            py -= weight * around[j]
        determinant = max(xx * yy - xy * xy, SINGULAR * (xx + yy) ** 2)
        sx, sy = (xy * gy - yy * gx) / determinant, (xy * gx - xx * gy) / determinant
        slope = ARMIJO * (gx * sx + gy * sy)
        after, halved = cost(ux + sx, uy + sy, fx, fy, law), False
        for _ in range(60):
            if not after > value + slope + 1e-15 * radius:
                break
            sx, sy, slope, halved = 0.5 * sx, 0.5 * sy, 0.5 * slope, True
            after = cost(ux + sx, uy + sy, fx, fy, law)
        if halved:
            wx, wy = (px + fx) / weights, (py + fy) / weights
            by_weiszfeld = cost(wx, wy, fx, fy, law)
            if by_weiszfeld < after:
                sx, sy, after = wx - ux, wy - uy, by_weiszfeld
        ux, uy, value = ux + sx, uy + sy, after
        moved = math.sqrt(sx * sx + sy * sy)
        if moved <= 1e-12 * math.sqrt(ux * ux + uy * uy) or math.sqrt(gx * gx + gy * gy) < ROUNDING:
            break
    return value, ux, uy


@part
def wrench(x: float, y: float, angle: float, law: Law) -> tuple[float, float, float, float]:
    """Return the force and moment per unit of friction that hold a disc at rest, and the sense of the moment.

    The force is in the frame of the disc. The sense is about the centre of the load.
    """
    ax, ay = pull(x, y, 0.0, 0.0, law)
    c, s = math.cos(angle), math.sin(angle)
    fx, fy = (c * ax + s * ay) / law.friction, (c * ay - s * ax) / law.friction
    moment = -law.shaft * law.lag / law.friction
    cx = cy = 0.0
    for j in range(0, len(law.around), WIDTH):
        cx += law.around[j + 2] * law.around[j]
        cy += law.around[j + 2] * law.around[j + 1]
    return fx, fy, moment, math.copysign(1.0, moment - (cx * fy - cy * fx))


@part
def spare_of_points(x: float, y: float, angle: float, law: Law) -> float:
    """Return a lower bound of the change of the pull that friction still holds; negative if it does not hold.

    The margin m = h − M of the moment is concave in F and at least −b where |F| = 1, with b = |M| + |c| for the
    centre c of the load. So it vanishes no closer than at (1 − |F|)·m/(m + b).
    """
    fx, fy, moment, sense = wrench(x, y, angle, law)
    left = 1.0 - math.sqrt(fx * fx + fy * fy)
    if left <= 0.0:
        return left * law.friction
    margin = largest_moment(sense * fx, sense * fy, law)[0] - sense * moment
    cx = cy = 0.0
    for j in range(0, len(law.around), WIDTH):
        cx += law.around[j + 2] * law.around[j]
        cy += law.around[j + 2] * law.around[j + 1]
    bound = abs(moment) + math.sqrt(cx * cx + cy * cy)
    return law.friction * left * margin / (abs(margin) + bound + 1e-300)


@part
def pivot_from_rest(x: float, y: float, angle: float, law: Law) -> tuple[int, float]:
    """Return the point about which a disc at rest begins to turn and the sense; the centre if all points slip."""
    for i in range(len(law.around) // WIDTH):
        for sense in (1.0, -1.0):
            about = seen_from(i, sense, law)
            ax, ay = pull(x, y, 0.0, 0.0, law)
            ar, _, _, hx, hy = turning(ax, ay, 0.0, angle, about)
            holds = math.sqrt(hx * hx + hy * hy) < law.friction * about.share
            if holds and sense * ar >= -AT_LIMIT * law.friction:
                return i, sense
    return CENTRE, 0.0


@part
def direction_of_points(x: float, y: float, angle: float, law: Law) -> tuple[float, float, float]:
    """Return the unit vector of the slip that begins at rest: the direction n where F·n − P(n) is largest.

    A search stalls where a point hardly slips, because P has a kink there. So P is smoothed, less and less, by a
    share of F·n − P(n), which therefore stays positive and quasi-concave.
    """
    fx, fy, moment, sense = wrench(x, y, angle, law)
    n = np.array((fx, fy, 0.0))
    if math.sqrt(fx * fx + fy * fy) < 1.0:
        _, ux, uy = largest_moment(sense * fx, sense * fy, law)
        n = np.array((sense * ux, sense * uy, sense))
    n = n / math.sqrt(np.dot(n, n))
    force = np.array((fx, fy, moment))
    width = SMOOTH * max(grown_along(n, force, 0.0, law)[0], 0.0)
    for _ in range(STAGES):
        n = fastest(n, force, width, law)
        width *= NARROWER
    n = fastest(n, force, 0.0, law)
    c, s = math.cos(angle), math.sin(angle)
    return float(c * n[0] - s * n[1]), float(s * n[0] + c * n[1]), float(n[2])


@part
def fastest(n: FloatArray, force: FloatArray, width: float, law: Law) -> FloatArray:
    """Return the maximum of F·n − P(n) on the unit sphere, by Newton's method from ``n``."""
    along, slope, bent = grown_along(n, force, width, law)
    for _ in range(60):
        slope = slope - np.dot(slope, n) * n
        if math.sqrt(np.dot(slope, slope)) < 1e-15:
            break
        for i in range(3):
            for k in range(3):
                bent[i, k] += n[i] * n[k]
            bent[i, i] += max(along, 0.0) + 1e-14
        step = slope.copy()
        solve_linear(bent, step)
        gain, share, better = float(np.dot(slope, step)), 1.0, False
        while share > 1e-6 and not better:
            new = n + share * step
            new = new / math.sqrt(np.dot(new, new))
            after, steeper, more = grown_along(new, force, width, law)
            better = after > along + ARMIJO * share * gain
            share *= 0.5
        if not better:
            break
        n, along, slope, bent = new, after, steeper, more
        if 2.0 * share * math.sqrt(np.dot(step, step)) < 1e-14:
            break
    return n


@part
def grown_along(
    n: FloatArray, force: FloatArray, width: float, law: Law
) -> tuple[float, FloatArray, FloatArray]:
    """Return F·n − P(n) in the frame of the disc, its gradient, and the second derivatives of P, shape (3, 3).

    The speed of each point is √(v² + width²) on the unit sphere.
    """
    slope, bent, by = force.copy(), np.zeros((3, 3)), np.zeros(3)
    for j in range(0, len(law.around), WIDTH):
        x, y, share = law.around[j], law.around[j + 1], law.around[j + 2]
        across, up = (1.0, 0.0, -y), (0.0, 1.0, x)
        vx, vy = n[0] - n[2] * y, n[1] + n[2] * x
        inverse = 1.0 / max(math.sqrt(vx * vx + vy * vy + width * width), LEAST_SLIP)
        for i in range(3):
            by[i] = (across[i] * vx + up[i] * vy + width * width * n[i]) * inverse
            slope[i] -= share * by[i]
        for i in range(3):
            for k in range(3):
                own = across[i] * across[k] + up[i] * up[k] + (width * width if i == k else 0.0)
                bent[i, k] += share * inverse * (own - by[i] * by[k])
    return float(np.dot(slope, n)), slope, bent
