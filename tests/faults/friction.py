"""Friction of the plain engine: at a point, on points, and on a continuous ring."""

import math

from faults.jit import compiled


@compiled
def on_polygon(force, make):
    """Return the point of the polygon nearest to ``force``."""
    half = math.pi / make.sides
    middle = 2.0 * half * round(math.atan2(force.imag, force.real) / (2.0 * half))
    along = complex(math.cos(middle), math.sin(middle))
    rotated = force * along.conjugate()
    if rotated.real <= 1.0:
        return force
    end = math.tan(half)
    return complex(1.0, min(max(rotated.imag, -end), end)) * along


@compiled
def at_point(slip, width, strength, make):
    """Return the friction of a slipping point per newton of its load, viscous up to the limit ``strength``."""
    wanted = -slip / width
    if make.sides > 0:
        return on_polygon(wanted / strength, make) * strength
    speed = abs(slip)
    share = abs(wanted)
    if share > strength:
        wanted *= strength / share
    return wanted * (1.0 - make.weakening * speed)


@compiled
def mean_slip(u, w):
    """Return the mean slip speed P(U, W) on a circle, ∂P/∂U and ∂P/∂W, from elliptic integrals by Gauss's AGM."""
    if u == 0.0 or w == 0.0:
        return u + w, 1.0 if u > 0.0 else 0.0, 1.0 if w > 0.0 else 0.0
    a, b = 1.0, max(abs(u - w) / (u + w), 1e-200)  # avoids the singularity at U = W
    total, power = 0.5 * 4.0 * (u / (u + w)) * (w / (u + w)), 0.5
    while a - b > 1e-15 * a:
        c = 0.5 * (a - b)
        a, b = 0.5 * (a + b), math.sqrt(a * b)
        power *= 2.0
        total += power * c * c
    first = 0.5 * math.pi / a  # K; E = K·(1 − total)
    rest = (u + w) * total
    return (
        2.0 / math.pi * (u + w) * first * (1.0 - total),
        first * (2.0 * u - rest) / (math.pi * u),
        first * (2.0 * w - rest) / (math.pi * w),
    )


@compiled
def contact(slip, spin, angle, width, strength, numbers, make):
    """Return force (N per N of μN), moment (m) and slip speed of a contact whose disc turns with ``spin``.

    ``slip`` and ``spin`` are relative to the master disc. The slip speed is the largest over the points, or the mean
    on a continuous ring.
    """
    radius = numbers.radius
    if numbers.points > 0:
        force, moment, fastest = 0j, 0.0, 0.0
        for i in range(numbers.points):
            alpha = angle + 2.0 * math.pi * i / numbers.points
            arm = radius * complex(math.cos(alpha), math.sin(alpha))
            velocity = slip + 1j * spin * arm
            friction = at_point(velocity, width, strength, make) / numbers.points
            force += friction
            moment += (arm.conjugate() * friction).imag
            fastest = max(fastest, abs(velocity))
        return force, moment, fastest
    u, w = abs(slip), radius * abs(spin)
    speed, by_slip, by_rim = mean_slip(u, w)
    if make.uncoupled:
        by_slip, by_rim = min(u / width, 1.0), min(w / width, 1.0)
    if u > w:
        by_rim *= make.moment_of_slip
    share = min(speed / width, strength) * (1.0 - make.weakening * speed)
    force = -share * by_slip * slip / u if u > 0.0 else 0j
    return force, -share * math.copysign(radius * by_rim, spin), speed
