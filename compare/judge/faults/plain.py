"""A plain engine of its own kind, which is right, and whose parts can be made wrong one by one.

It integrates eq. 1 or 19 with LSODA, which copes with the stiffness of stick; the velocities among its unknowns are
relative to the master disc, so that creep keeps its digits. Friction is viscous below a small slip speed ε, and a
contact sticks while its friction is not full. ε falls with the tolerance, so that the error of both can be estimated.
Nothing but parameters, results and the cache on disk is shared with the two engines of the project.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Literal, NamedTuple, TypeVar, cast

import numba
import numpy as np
from numpy.typing import ArrayLike
from scipy.integrate import LSODA
from scipy.optimize import brentq

from reference_model.numerics.compiled_cache import known_by_content
from reference_model.systems import (
    DiscOnDisc,
    FloatArray,
    System,
    checked_state,
    checked_times,
    checked_tolerance,
)
from reference_model.trajectory import Phase, SimulationError, Solution, Trajectory

Function = TypeVar("Function", bound=Callable[..., Any])


def compiled(function: Function) -> Function:
    """Compile ``function`` at its first call, or take what an earlier process left."""
    dispatcher = numba.njit(cache=True, error_model="numpy")(function)
    known_by_content(dispatcher)
    return cast(Function, dispatcher)


class Make(NamedTuple):
    """How the engine is made: each default is right, and each other value is one mistake.

    Parameters
    ----------
    slip_width : float
        ε in m/s is no smaller than this, whatever the tolerance.
    creep_speed : float
        Slip speed in m/s at which friction is full in stick, if that is more than ε.
    static_ratio : float
        What friction in stick can hold, over μN.
    release_delay : float
        Time in s by which stick goes on when friction can no longer hold.
    release_late : float
        Share of its time by which stick goes on when friction can no longer hold.
    weakening : float
        Share of the friction force that is lost by 1 m/s of slip speed.
    stronger_beside : float
        Share by which friction is stronger where |y| > x.
    sides, circumscribed, first_side : int, bool, float
        Number of sides of the polygon that bounds the friction force in place of the circle (0), whether it lies
        around the circle or inside, and the direction in rad of the middle of its first side.
    relative : float
        1 for friction against the velocity relative to the master disc, 0 against that of the body.
    about_anchor : bool
        Whether the velocity of the master disc is reckoned from the point at which the springs are relaxed.
    spin_in_slip : float
        Share of the spin that the slip of a contact on a circle takes part in.
    moment : float
        Factor of the moment of friction.
    moment_of_slip : float
        Factor of the moment of a ring whose centre slips faster than its rim.
    uncoupled : bool
        Whether slip and spin of a ring are resisted each as if the other were not there.
    points_turn : float
        Share of its angle by which the contact of a disc turns with it.
    points_lag : float
        Time in s by which the points' directions are behind the disc's angle.
    damping_on_slip : bool
        Whether the dampers act against the velocity relative to the master disc.
    anchor : complex
        Direction in which the offset lies.
    anchor_turns : bool
        Whether the springs turn with the master disc.
    stiffer_in_y : float
        Share by which the spring of the y axis is stiffer.
    hardening_power : float
        Of the deflection, to which the hardening is proportional.
    stop_pulls : bool
        Whether the stop acts inside of its gap too.
    stop_on_one_side : bool
        Whether there is no stop at deflections of negative x.
    coriolis : float
        Share of 2ρ̇ψ̇ in the tangential acceleration.
    energy_gain : float
        Share of its energy that a vibration at the natural frequency gains in a cycle.
    order, step : int, float
        Fixed step in s of an explicit method of order 1 or 4 in place of LSODA (0).

    """

    slip_width: float = 0.0
    creep_speed: float = 0.0
    static_ratio: float = 1.0
    release_delay: float = 0.0
    release_late: float = 0.0
    weakening: float = 0.0
    stronger_beside: float = 0.0
    sides: int = 0
    circumscribed: bool = False
    first_side: float = 0.0
    relative: float = 1.0
    about_anchor: bool = False
    spin_in_slip: float = 1.0
    moment: float = 1.0
    moment_of_slip: float = 1.0
    uncoupled: bool = False
    points_turn: float = 1.0
    points_lag: float = 0.0
    damping_on_slip: bool = False
    anchor: complex = 1.0 + 0.0j
    anchor_turns: bool = False
    stiffer_in_y: float = 0.0
    hardening_power: float = 2.0
    stop_pulls: bool = False
    stop_on_one_side: bool = False
    coriolis: float = 1.0
    energy_gain: float = 0.0
    order: int = 0
    step: float = 0.0


RIGHT = Make()


class Numbers(NamedTuple):
    """The parameters of a system; ``points`` is 0 for the continuous ring and 1 for a pin, whose radius is 0."""

    mass: float
    inertia: float
    stiffness: float
    damping: float
    friction: float
    omega: float
    offset: float
    hardening: float
    stop_gap: float
    stop_stiffness: float
    radius: float
    shaft_damping: float
    shaft_speed: float
    points: int

    @classmethod
    def of(cls, system: System) -> Numbers:
        """Return those of ``system``."""
        disc = system if isinstance(system, DiscOnDisc) else None
        return cls(
            system.mass,
            disc.polar_inertia if disc else 1.0,
            system.stiffness,
            system.damping,
            system.friction_force,
            system.disc_speed,
            system.offset,
            system.hardening,
            system.stop_gap,
            system.stop_stiffness,
            disc.contact_radius if disc else 0.0,
            disc.shaft_damping if disc else 0.0,
            disc.shaft_speed if disc else 0.0,
            (disc.contact_points or 0) if disc else 1,
        )


def steepest(numbers: Numbers) -> float:
    """Return the greatest deceleration of slip by friction, in m/s²."""
    return numbers.friction * (1.0 / numbers.mass + numbers.radius**2 / numbers.inertia)


# ---------------------------------------------------------------- friction


@compiled
def on_polygon(force: complex, make: Make) -> complex:
    """Return the force of the polygon that is nearest to ``force``."""
    half = math.pi / make.sides
    apothem = 1.0 if make.circumscribed else math.cos(half)
    angle = math.atan2(force.imag, force.real) - make.first_side
    middle = make.first_side + 2.0 * half * round(angle / (2.0 * half))
    along = complex(math.cos(middle), math.sin(middle))
    turned = force * along.conjugate()
    if turned.real <= apothem:
        return force
    end = apothem * math.tan(half)
    return complex(apothem, min(max(turned.imag, -end), end)) * along


@compiled
def at_point(slip: complex, width: float, strength: float, make: Make) -> complex:
    """Return the friction of a point that slips, per newton of its load: full up to ``strength``, viscous below."""
    wanted = -slip / width
    if make.sides > 0:
        return on_polygon(wanted / strength, make) * strength
    speed = abs(slip)
    share = abs(wanted)
    if share > strength:
        wanted *= strength / share
    return wanted * (1.0 - make.weakening * speed)


@compiled
def mean_slip(u: float, w: float) -> tuple[float, float, float]:
    """Return the mean slip speed P(U, W) on a circle, ∂P/∂U and ∂P/∂W: elliptic integrals by the means of Gauss."""
    if u == 0.0 or w == 0.0:
        return u + w, 1.0 if u > 0.0 else 0.0, 1.0 if w > 0.0 else 0.0
    a, b = 1.0, max(abs(u - w) / (u + w), 1e-200)  # the logarithm at U = W is beyond all floats
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
def contact(
    slip: complex, spin: float, angle: float, width: float, strength: float, numbers: Numbers, make: Make
) -> tuple[complex, float, float]:
    """Return force (N per N of μN), moment (m) and slip speed of a contact whose disc turns with ``spin``.

    Both ``slip`` and ``spin`` are relative to the master disc. The slip speed is that of the fastest point, or the
    mean on a continuous ring.
    """
    radius = numbers.radius
    if numbers.points > 0:
        force, moment, fastest = 0j, 0.0, 0.0
        for i in range(numbers.points):
            alpha = make.points_turn * angle + 2.0 * math.pi * i / numbers.points
            arm = radius * complex(math.cos(alpha), math.sin(alpha))
            velocity = slip + make.spin_in_slip * 1j * spin * arm
            friction = at_point(velocity, width, strength, make) / numbers.points
            force += friction
            moment += (arm.conjugate() * friction).imag
            fastest = max(fastest, abs(velocity))
        return force, moment, fastest
    u, w = abs(slip), make.spin_in_slip * radius * abs(spin)
    speed, by_slip, by_rim = mean_slip(u, w)
    if make.uncoupled:
        by_slip, by_rim = min(u / width, 1.0), min(w / width, 1.0)
    if u > w:
        by_rim *= make.moment_of_slip
    share = min(speed / width, strength) * (1.0 - make.weakening * speed)
    force = -share * by_slip * slip / u if u > 0.0 else 0j
    return force, -share * math.copysign(radius * by_rim, spin), speed


# ---------------------------------------------------------------- equations of motion


@compiled
def slip_of(y: FloatArray, numbers: Numbers, make: Make) -> tuple[complex, float]:
    """Return the velocity of the centre and the spin that friction acts against."""
    half = len(y) // 2
    slip = complex(y[half], y[half + 1])
    spin = y[5] if half == 3 else 0.0
    if make.relative != 1.0:
        slip += (1.0 - make.relative) * 1j * numbers.omega * complex(y[0], y[1])
        spin += (1.0 - make.relative) * numbers.omega
    if make.about_anchor:
        slip += 1j * numbers.omega * numbers.offset
    return slip, spin


@compiled
def support(t: float, z: complex, v: complex, numbers: Numbers, make: Make) -> complex:
    """Return the force of springs, stop and dampers."""
    anchor = numbers.offset * make.anchor
    if make.anchor_turns:
        anchor *= complex(math.cos(numbers.omega * t), math.sin(numbers.omega * t))
    deflection = z - anchor
    d = abs(deflection)
    pull = numbers.stiffness
    if d > 0.0:
        pull += numbers.hardening * d**make.hardening_power
        if (make.stop_pulls or d > numbers.stop_gap) and not (
            make.stop_on_one_side and deflection.real < 0.0
        ):
            pull += numbers.stop_stiffness * (d - numbers.stop_gap) / d
    damped = v - 1j * numbers.omega * z if make.damping_on_slip else v
    unlike = make.stiffer_in_y * numbers.stiffness * deflection.imag
    return -pull * deflection - complex(0.0, unlike) - numbers.damping * damped


@compiled
def rates(t: float, y: FloatArray, width: float, strength: float, numbers: Numbers, make: Make) -> FloatArray:
    """Return the right side of (1) or (19) for x, y, (φ,) and the velocities relative to the master disc."""
    half = len(y) // 2
    z, u = complex(y[0], y[1]), complex(y[half], y[half + 1])
    v = u + 1j * numbers.omega * z
    slip, turning = slip_of(y, numbers, make)
    angle = y[2] - make.points_lag * (y[5] + numbers.omega) if half == 3 else 0.0
    force, moment, _ = contact(slip, turning, angle, width, strength, numbers, make)
    if abs(z.imag) > z.real:
        force *= 1.0 + make.stronger_beside
    a = (numbers.friction * force + support(t, z, v, numbers, make)) / numbers.mass
    if make.energy_gain > 0.0:
        a += make.energy_gain / (2.0 * math.pi) * math.sqrt(numbers.stiffness / numbers.mass) * v
    square = z.real * z.real + z.imag * z.imag
    if make.coriolis != 1.0 and square > 0.0:
        v_polar = z.conjugate() * v  # ρ·(ρ̇ + iρψ̇)
        a += (1.0 - make.coriolis) * 2.0 * v_polar.real * v_polar.imag / square**2 * 1j * z
    a -= 1j * numbers.omega * v
    result = np.empty_like(y)
    result[0], result[1], result[half], result[half + 1] = v.real, v.imag, a.real, a.imag
    if half == 3:
        spin = y[5] + numbers.omega
        shaft = -numbers.shaft_damping * (spin - numbers.shaft_speed)
        result[2] = spin
        result[5] = (make.moment * numbers.friction * moment + shaft) / numbers.inertia
    return result


@compiled
def turned(x: FloatArray, turn: float, base: FloatArray) -> FloatArray:
    """Return the unknowns of which ``x`` is the slip since ``base``, in the frame that turned since then."""
    half = len(x) // 2
    e = complex(math.cos(turn), math.sin(turn))
    z, u = (complex(base[0] + x[0], base[1] + x[1])) * e, complex(x[half], x[half + 1]) * e
    y = x.copy()
    y[0], y[1], y[half], y[half + 1] = z.real, z.imag, u.real, u.imag
    if half == 3:
        y[2] += base[2] + turn
    return y


@compiled
def turning_rates(
    t: float,
    x: FloatArray,
    start: float,
    base: FloatArray,
    width: float,
    strength: float,
    numbers: Numbers,
    make: Make,
) -> FloatArray:
    """Return the rates of ``x`` of ``turned``, which are small in stick."""
    half, turn = len(x) // 2, numbers.omega * (t - start)
    result = rates(t, turned(x, turn, base), width, strength, numbers, make)
    a = complex(result[half], result[half + 1]) * complex(math.cos(turn), -math.sin(turn))
    a -= 1j * numbers.omega * complex(x[half], x[half + 1])
    result[:half] = x[half:]
    result[half], result[half + 1] = a.real, a.imag
    return result


@compiled
def slip_speed(y: FloatArray, numbers: Numbers, make: Make) -> float:
    """Return the slip speed of the contact."""
    slip, turning = slip_of(y, numbers, make)
    return contact(slip, turning, y[2] if len(y) == 6 else 0.0, 1.0, 1.0, numbers, make)[2]


def carried(places: FloatArray, omega: float) -> FloatArray:
    """Return the velocities of what turns with the master disc, for places of shape (..., 2) or (..., 3)."""
    velocities = np.full_like(places, omega)
    velocities[..., 0], velocities[..., 1] = -omega * places[..., 1], omega * places[..., 0]
    return velocities


@compiled
def fixed_steps(
    times: FloatArray, start: FloatArray, width: float, numbers: Numbers, make: Make
) -> FloatArray:
    """Return the states at ``times`` by Euler's method, or the classic one of Runge and Kutta."""
    states = np.empty((len(times), len(start)))
    states[0] = start
    y = start.copy()
    for i in range(1, len(times)):
        span = times[i] - times[i - 1]
        n = math.ceil(span / make.step - 1e-9)
        h = span / n
        for j in range(n):
            t = times[i - 1] + j * h
            k1 = rates(t, y, width, 1.0, numbers, make)
            if make.order == 1:
                y = y + h * k1
                continue
            k2 = rates(t + 0.5 * h, y + 0.5 * h * k1, width, 1.0, numbers, make)
            k3 = rates(t + 0.5 * h, y + 0.5 * h * k2, width, 1.0, numbers, make)
            k4 = rates(t + h, y + h * k3, width, 1.0, numbers, make)
            y = y + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        states[i] = y
    return states


# ---------------------------------------------------------------- phases


TIGHTEST = 1e-13
"""The smallest relative tolerance that LSODA is given."""

MOST_STEPS = 150_000
"""Several times what any right motion takes; what is wrong may be singular."""

SAFETY = 1e-3
"""The tolerance is of the end, not of a step."""

ACCURACY_IN_STICK = 1e-7
"""Of the slip, as a fraction of ε, and so of the force."""


def anywhere(_: FloatArray) -> float:
    """Bound nothing."""
    return math.inf


@dataclass
class _Run:
    """A simulation under way, from one phase to the next."""

    numbers: Numbers
    make: Make
    times: FloatArray
    unknowns: FloatArray
    epsilon: float
    tolerance: float
    recorded: int = 1
    evaluations: int = 0
    steps: int = 0
    phases: list[tuple[Literal["slip", "stick"], float, FloatArray]] = field(default_factory=list)

    def speed(self, y: FloatArray) -> float:
        """Return the slip speed."""
        return slip_speed(y, self.numbers, self.make)

    @property
    def glance(self) -> float:
        """Return the time in s in which what friction has to hold changes by far less than it may."""
        frequency = math.sqrt(self.numbers.stiffness / self.numbers.mass)
        return 0.02 / max(frequency, abs(self.numbers.omega), 1e-3)

    def time_to_rest(self, t: float, y: FloatArray) -> float:
        """Return the time in s that slip at the speed ε would last if friction stayed full."""
        numbers, make, speed = self.numbers, self.make, self.speed(y)
        least = self.epsilon / steepest(numbers)
        step = 1e-2 * least
        moved = self.speed(y + step * rates(t, y, self.epsilon, 1.0, numbers, make))
        slowest = 1e-3 * speed / least  # friction that can hardly hold
        return speed / max((speed - moved) / step, slowest)

    def go(self) -> None:
        """Follow the motion to its end."""
        make, t, y, end = self.make, float(self.times[0]), self.unknowns[0].copy(), float(self.times[-1])
        creep = max(self.epsilon, make.creep_speed)
        release = creep * make.static_ratio
        stuck = self.speed(y) < self.epsilon and self.numbers.friction > 0.0
        while True:
            self.phases.append(("stick" if stuck else "slip", t, y))
            if t >= end:
                return
            if stuck:
                since = t
                t, y = self.follow(
                    t, y, end, creep, make.static_ratio, lambda y: release - self.speed(y), self.glance
                )
                delay = make.release_delay + make.release_late * (t - since)
                if t < end and delay > 0.0:
                    t, y = self.follow(t, y, min(t + delay, end), creep, math.inf)
            else:
                t, y = self.follow(t, y, end, self.epsilon, 1.0, lambda y: self.speed(y) - self.epsilon)
                if t < end:  # full friction brings what is left to zero, viscous friction never does
                    t, y = self.follow(t, y, min(t + self.time_to_rest(t, y), end), self.epsilon, 1.0)
            if t >= end:
                return
            stuck = not stuck

    def follow(
        self,
        t: float,
        y: FloatArray,
        end: float,
        width: float,
        strength: float,
        inside: Callable[[FloatArray], float] = anywhere,
        longest: float = math.inf,
    ) -> tuple[float, FloatArray]:
        """Integrate until ``inside`` falls below zero, or to ``end``; return when and where that is.

        Steps are no longer than ``longest``.
        """
        local = max(SAFETY * self.tolerance, TIGHTEST)
        half = len(y) // 2
        # In stick what has slipped is small in the frame that turns, and exact; in slip that frame only costs steps.
        turning = longest < math.inf
        omega = self.numbers.omega if turning else 0.0
        start, base = t, np.concatenate((y[:half], np.zeros(half))) if turning else np.zeros(2 * half)
        law = (start, base, width, strength, self.numbers, self.make)
        slipping = law[2:]
        solver = LSODA(
            (lambda t, x: turning_rates(t, x, *law)) if turning else (lambda t, x: rates(t, x, *slipping)),
            start,
            y - base,
            end,
            rtol=local,
            atol=[0.1 * local] * half + [min(0.1 * local, ACCURACY_IN_STICK * self.epsilon)] * half,
            first_step=min(1e-6, end - start),
            max_step=longest,
        )

        def at(t: float, x: FloatArray) -> FloatArray:
            return turned(x, omega * (t - start), base)

        left = False
        while solver.status == "running" and not left:
            message = solver.step()
            self.steps += 1
            if self.steps > MOST_STEPS:
                raise SimulationError(f"more than {MOST_STEPS:,} steps up to t = {solver.t:g} s")
            if solver.status == "failed" or not np.all(np.isfinite(solver.y)):
                raise SimulationError(f"LSODA gave up at t = {solver.t:g} s: {message}")
            t, y = float(solver.t), at(solver.t, solver.y)
            left = inside(y) < 0.0
            if left or self.pending(t):
                dense = solver.dense_output()
                if left:
                    t, y = self.crossing(lambda t: at(t, dense(t)), solver.t_old, t, inside)  # noqa: B023
                stop = int(np.searchsorted(self.times, t, side="right"))
                for i in range(self.recorded, stop):
                    self.unknowns[i] = at(self.times[i], dense(self.times[i]))
                self.recorded = max(self.recorded, stop)
        self.evaluations += solver.nfev
        return t, y

    @staticmethod
    def crossing(
        at: Callable[[float], FloatArray], before: float, after: float, inside: Callable[[FloatArray], float]
    ) -> tuple[float, FloatArray]:
        """Return when and where ``inside`` fell below zero; if it was there already, after the step."""
        t = after
        if inside(at(before)) > 0.0 > inside(at(after)):
            t = float(brentq(lambda t: inside(at(t)), before, after, xtol=1e-15, rtol=1e-14))
        return t, at(t)

    def pending(self, t: float) -> bool:
        """Tell whether a time that was asked for lies before or at ``t``."""
        return self.recorded < len(self.times) and bool(self.times[self.recorded] <= t)


def simulate(
    system: System, initial_state: ArrayLike, times: ArrayLike, *, tolerance: float = 1e-9, make: Make = RIGHT
) -> Trajectory:
    """Return the motion of a pin or a disc from ``initial_state`` at all ``times``.

    ``make`` says what is wrong with the engine. Raises ``ValueError`` for a system, a state or times that make no
    sense, and ``SimulationError`` if LSODA gives up.
    """
    clock = time.perf_counter()
    start, times, tolerance = (
        checked_state(system, initial_state),
        checked_times(times),
        checked_tolerance(tolerance),
    )
    numbers = Numbers.of(system)
    # An explicit method can't have friction stop within less than a step.
    epsilon = max(10.0 * tolerance, make.slip_width, make.step * steepest(numbers))
    half = len(start) // 2
    unknowns = np.empty((len(times), 2 * half))
    unknowns[0] = start
    unknowns[0, half:] -= carried(start[:half], numbers.omega)
    run = _Run(numbers, make, times, unknowns, epsilon, tolerance)
    if make.order > 0:
        unknowns[:] = fixed_steps(times, unknowns[0], epsilon, numbers, make)
        run.phases.append(("slip", float(times[0]), unknowns[0]))
    else:
        run.go()

    def state_of(unknowns: FloatArray) -> FloatArray:
        places, relative = np.split(unknowns, 2, axis=-1)
        return np.concatenate((places, relative + carried(places, numbers.omega)), axis=-1)

    states = state_of(unknowns)
    states[0] = start
    starts = [t for _, t, _ in run.phases]
    phases = tuple(
        Phase(kind, t, end, state_of(y))
        for (kind, t, y), end in zip(run.phases, [*starts[1:], float(times[-1])], strict=True)
    )
    solution = Solution(
        "LSODA, friction viscous below ε",
        tolerance,
        run.evaluations,
        run.steps,
        time.perf_counter() - clock,
        epsilon,
    )
    return Trajectory(system, times, states, phases, solution)


simulate.kinds = ("pin", "points", "ring")  # type: ignore[attr-defined]
