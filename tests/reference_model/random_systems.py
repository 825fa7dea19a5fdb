"""Random systems of every kind, and an independent simulation of their motions with smooth friction."""

import cmath
import math
from dataclasses import dataclass

import numpy as np
from plain_engines import in_units
from scipy.integrate import odeint
from scipy.special import ellipe, ellipkm1

from reference_model import Annulus, DiscOnDisc, PinOnDisc, Points, simulate

CONTACTS = ("pin", "ring", "points")
SUPPORTS = ("linear", "hardening", "stop", "both")
COURSES = ("dragged", "fast", "to and fro", "creeping", "thrown")
SYSTEMS = len(CONTACTS) * len(SUPPORTS) * len(COURSES)
TIMES = np.linspace(0.0, 25.0, 51)


@dataclass(frozen=True)
class RandomMotion:
    """A random system of order one in SI units, and its initial state."""

    seed: int
    system: PinOnDisc | DiscOnDisc
    start: np.ndarray

    @classmethod
    def of(cls, seed):
        """Return a motion. Seeds run through all combinations of contact, support and course; the rest is random."""
        rng = np.random.default_rng(seed)
        support, course = SUPPORTS[seed // 3 % 4], COURSES[seed // 12 % 5]
        offset = rng.choice((-1.0, 1.0)) * rng.uniform(0.1, 0.2)
        values = {
            "mass": 1.0,
            "stiffness": 1.0,
            "damping": rng.uniform(0.02, 0.15),
            "friction_force": abs(offset) * rng.uniform(0.9, 1.3),
            "disc_speed": rng.choice((-1.0, 1.0)) * rng.uniform(0.6, 0.9),
            "offset": offset,
            "hardening": rng.uniform(1.0, 8.0) if support in ("hardening", "both") else 0.0,
            "stop_gap": rng.uniform(0.1, 0.3),
            "stop_stiffness": rng.uniform(2.0, 20.0) if support in ("stop", "both") else 0.0,
        }
        shaft = {
            "polar_inertia": rng.uniform(0.01, 0.05),
            "contact_radius": rng.uniform(0.08, 0.25),
            "shaft_damping": rng.uniform(0.002, 0.01),
            "shaft_speed": values["disc_speed"] * rng.uniform(0.8, 1.2),
            "contact_points": int(rng.integers(3, 7)) if CONTACTS[seed % 3] == "points" else None,
        }
        z = 0.3 * complex(*rng.uniform(-1.0, 1.0, 2))
        slip, spin = 0.1 * complex(*rng.normal(size=2)), 0.3 * rng.normal()
        if course == "fast":
            z = offset + 0.05 * complex(*rng.normal(size=2))
            values["disc_speed"] *= 2.0
            values["friction_force"] *= 0.9
            shaft["shaft_speed"] *= 1.7
        elif course == "to and fro":
            values |= {"disc_speed": 0.0, "friction_force": rng.uniform(0.01, 0.05)}
            slip, spin, shaft["shaft_speed"] = 0j, 0.0, 0.0
        elif course == "creeping":
            values |= {"offset": 0.0, "damping": rng.uniform(2.0, 3.0)}
            values["disc_speed"] *= 0.5
            spin, shaft["shaft_damping"] = 0.0, 0.0
        elif course == "thrown":
            values |= {"disc_speed": 0.0, "stiffness": 0.0}
            slip, spin = complex(*rng.normal(size=2)), 3.0 * rng.normal()
        elif rng.random() < 0.5:
            slip, spin = 0j, 0.0
        v = slip + 1j * values["disc_speed"] * z
        start = [z.real, z.imag, rng.uniform(-3.0, 3.0), v.real, v.imag, spin + values["disc_speed"]]
        if CONTACTS[seed % 3] == "pin":
            return cls(seed, PinOnDisc(**values), np.array(start)[[0, 1, 3, 4]])
        return cls(seed, DiscOnDisc(**values, **shaft), np.array(start))

    def simulated(self, tolerance=1e-9):
        """Simulate in random units; return the trajectory, and its states at ``TIMES`` in the original units."""
        mass, length, time = 10.0 ** np.random.default_rng((self.seed, 1)).uniform(-3.0, 3.0, 3)
        half = len(self.start) // 2
        scales = np.array([length, length, 1.0][:half] + [length / time, length / time, 1.0 / time][:half])
        run = simulate(
            in_units(self.system, mass, length, time), self.start * scales, TIMES * time, tolerance=tolerance
        )
        return run, run.states / scales


def random_points(seed):
    """Return two to five points at random places, with random shares of the load."""
    rng = np.random.default_rng((seed, 2))
    shares = rng.uniform(0.2, 1.0, rng.integers(2, 6))
    x, y = rng.uniform(-0.2, 0.2, (2, len(shares)))
    return Points(np.column_stack((x, y, shares / shares.sum())).tolist())


def friction_of_points(load, places, epsilon):
    """Return force and moment of points with the law v/√(v² + ε²), as a function of slip, spin and angle."""
    loaded = [(complex(x, y), load * share) for x, y, share in places]

    def friction(u, w, angle):
        turn, force, moment = cmath.exp(1j * angle), 0j, 0.0
        for place, most in loaded:
            arm = turn * place
            slip = u + 1j * w * arm
            own = -most * slip / math.sqrt(slip.real**2 + slip.imag**2 + epsilon**2)
            force += own
            moment += (arm.conjugate() * own).imag
        return force, moment

    return friction


def friction_of_ring(disc, epsilon):
    """Return the mean of this law over the ring: the gradient of the mean of √(A − B·cos χ) with respect to U and W.

    A = U² + W² + ε² and B = 2UW.
    """
    R, load = disc.contact_radius, disc.friction_force

    def friction(u, w, _):
        U, W = abs(u), R * w
        A, B = U**2 + W**2 + epsilon**2, 2.0 * U * abs(W)
        root, rest = math.sqrt(A + B), (A - B) / (A + B)
        inverse = 2.0 / math.pi * ellipkm1(rest) / root  # mean of 1/√(A − B·cos χ)
        if B < 1e-3 * A:
            cosine = B / (4.0 * A**1.5) * (1.0 + 15.0 / 32.0 * (B / A) ** 2)
        else:  # mean of cos χ/√(A − B·cos χ)
            cosine = (A * inverse - 2.0 / math.pi * ellipe(1.0 - rest) * root) / B
        along = inverse * U - cosine * abs(W)
        return -load * along * (u / U if U > 0.0 else 0.0), -load * R * (
            inverse * W - cosine * math.copysign(U, W)
        )

    return friction


def friction_of_annulus(disc, inner, outer, epsilon):
    """Return the mean of the law of the ring over an annulus under uniform pressure, by Gauss's rule.

    The rule is split at the radius where a point may rest, and its nodes cluster there.
    """
    nodes, weights = np.polynomial.legendre.leggauss(20)
    nodes, weights = 0.5 * (nodes + 1.0), 0.5 * weights

    def friction(u, w, _):
        U, spin = abs(u), abs(w)
        split = min(max(U / spin, inner), outer) if spin > 0.0 else outer
        radii = np.concatenate([split + (end - split) * nodes**3 for end in (inner, outer)])
        widths = np.concatenate([abs(end - split) * 3.0 * nodes**2 * weights for end in (inner, outer)])
        shares = 2.0 * radii * widths / (outer**2 - inner**2)
        W = radii * spin
        A, B = U**2 + W**2 + epsilon**2, 2.0 * U * W
        # P = (2/π)·√(A + B)·E(m), m = 2B/(A + B), with dE/dm = (E − K)/(2m)
        m = 2.0 * B / (A + B)
        E, K = ellipe(m), ellipkm1((A - B) / (A + B))
        small = m < 1e-4
        slope = np.where(small, -np.pi / 8.0 * (1.0 + 0.375 * m), (E - K) / (2.0 * np.where(small, 1.0, m)))
        root = np.sqrt(A + B)
        by_m = 2.0 / np.pi * root * slope
        along = 2.0 / np.pi * E * (U + W) / root
        m_by_U = (4.0 * W - 2.0 * m * (U + W)) / (A + B)
        m_by_W = (4.0 * U - 2.0 * m * (U + W)) / (A + B)
        force, moment = along + by_m * m_by_U, radii * (along + by_m * m_by_W)
        load = disc.friction_force * shares
        return (
            -complex(load @ force) * (u / U if U > 0.0 else 0.0),
            -float(load @ moment) * math.copysign(1.0, w),
        )

    return friction


def smooth_motion(system, start, epsilon, contact=None):
    """Return states by LSODA with friction v/√(v² + ε²), of the system, of an annulus or of points ``contact``.

    Slip is an unknown to preserve the digits of creep.
    """
    omega, C, beta, m = system.disc_speed, system.stiffness, system.damping, system.mass
    disc = isinstance(system, DiscOnDisc)
    if isinstance(contact, Annulus):
        friction = friction_of_annulus(system, contact.inner_radius, contact.outer_radius, epsilon)
    elif disc and system.contact_points is None and contact is None:
        friction = friction_of_ring(system, epsilon)
    else:
        radius, points = (system.contact_radius, system.contact_points or 1) if disc else (0.0, 1)
        around = [cmath.rect(radius, 2.0 * math.pi * i / points) for i in range(points)]
        on_circle = [(arm.real, arm.imag, 1.0 / points) for arm in around]
        friction = friction_of_points(system.friction_force, contact or on_circle, epsilon)

    def rates(_, unknowns):
        x, y, ux, uy, *turning = unknowns.tolist()
        z, u = complex(x, y), complex(ux, uy)
        v = u + 1j * omega * z
        bent = z - system.offset
        d = abs(bent)
        stop = system.stop_stiffness * max(1.0 - system.stop_gap / d, 0.0) if d > 0.0 else 0.0
        angle, w = turning if disc else (0.0, 0.0)
        force, moment = friction(u, w, angle)
        a = (force - (C + system.hardening * d**2 + stop) * bent - beta * v) / m - 1j * omega * v
        if not disc:
            return [v.real, v.imag, a.real, a.imag]
        shaft = system.shaft_damping * (system.shaft_speed - omega - w)
        return [v.real, v.imag, a.real, a.imag, w + omega, (moment + shaft) / system.polar_inertia]

    half = len(start) // 2
    z, v = complex(*start[:2]), complex(*start[half : half + 2])
    u = v - 1j * omega * z
    unknowns = [z.real, z.imag, u.real, u.imag, *([start[2], start[5] - omega] if disc else [])]
    slip = 1e-5 * epsilon
    found, report = odeint(
        rates, unknowns, TIMES, tfirst=True, rtol=1e-11, atol=[1e-13, 1e-13, slip, slip, 1e-13, slip][: len(start)],
        mxstep=2_000_000, full_output=True,
    )  # fmt: skip
    assert report["message"] == "Integration successful.", report["message"]
    z, u = found[:, 0] + 1j * found[:, 1], found[:, 2] + 1j * found[:, 3]
    v = u + 1j * omega * z
    columns = [z.real, z.imag, v.real, v.imag]
    if disc:
        columns[2:2] = [found[:, 4]]
        columns.append(found[:, 5] + omega)
    return np.column_stack(columns)
