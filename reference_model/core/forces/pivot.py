"""A disc that turns about a resting contact point.

The friction λ of this point, divided by the mass, changes the velocity of the point at the rate B + Gλ. B is the rate
without it and G = 1 + (iη)⊗(iη), with the arm η. At rest λ = −G⁻¹B, up to g·q. Only r is unknown. All other points
slip in directions that turn with the disc, so their friction is constant in the frame of the disc, and slip of one
degree of freedom is not stiff.
"""

import math

from reference_model.core.forces.law import WIDTH, Law, arm
from reference_model.numerics.parts import part


@part
def turning(
    ax: float, ay: float, r: float, angle: float, law: Law
) -> tuple[float, float, float, float, float]:
    """Return the rate of r, and B and G⁻¹B for the acceleration of the centre by everything but friction."""
    c, s = math.cos(angle), math.sin(angle)
    x, y = arm(angle, law)
    g, row = law.friction * law.sense, WIDTH * law.point
    px, py = law.around[row + 3], law.around[row + 4]
    ar = -g * law.around[row + 5] - law.shaft * (r + law.lag)
    turn = r * (law.omega + r / law.gyration)
    bx = ax - g * (c * px - s * py) - y * ar - turn * x
    by = ay - g * (s * px + c * py) + x * ar - turn * y
    across = (x * by - y * bx) / (1.0 + x * x + y * y)
    return ar - across, bx, by, bx + y * across, by - x * across


@part
def first_slip(bx: float, by: float, angle: float, law: Law) -> tuple[float, float]:
    """Return the direction e of the slip of the point that friction cannot hold: B − g·q·G·e = c·e, c >= 0.

    Along and across the arm it is B_∥/(c + g·q) and B_⊥/(c + g·q·(1 + |η|²)).
    """
    x, y = arm(angle, law)
    size = math.sqrt(x * x + y * y)
    if size > 0.0:
        x, y = x / size, y / size
    else:
        x, y = 1.0, 0.0
    along, across, most = x * bx + y * by, x * by - y * bx, law.friction * law.share
    stiffer = most * (1.0 + size * size)
    # The length of e falls with c, so it is 1 between 0 and |B|.
    low, high = 0.0, math.sqrt(bx * bx + by * by)
    while math.sqrt((along / (low + most)) ** 2 + (across / (low + stiffer)) ** 2) > 1.0:
        middle = 0.5 * (low + high)
        if middle <= low or middle >= high:
            break
        if math.sqrt((along / (middle + most)) ** 2 + (across / (middle + stiffer)) ** 2) > 1.0:
            low = middle
        else:
            high = middle
    first, second = along / (low + most), across / (low + stiffer)
    ex, ey = x * first - y * second, y * first + x * second
    size = math.sqrt(ex * ex + ey * ey)
    return ex / size, ey / size
