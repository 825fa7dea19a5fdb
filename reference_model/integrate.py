"""Simulation of the pin with set-valued Coulomb friction: phases of slip and stick, one after the other.

Slip is integrated by SciPy's eighth-order Runge–Kutta method with the unregularised law,

- in z and w while slip is fast, or grows;
- in slip-polar coordinates (z, ln s, θ), w = s·exp(iθ), and in the stretched time dτ = dt·√(s²+s₀²)/s
  while slip comes near to zero. There these equations are smooth and not stiff down to s = 0, where θ tends
  to the direction of the pull (a limit direction of the codimension-2 discontinuity, Antali and Stépán 2019)
  and the time that is left is s/(g − |a|). No event has to be located.

A stick phase is the closed-form rotation with the disc up to the first root of eq. 7, and slip leaves it by
the series of ``sticking.slip_from_rest``. Inside, times and lengths are scaled to order one, so that
tolerance and thresholds mean the same in any units.
"""

from __future__ import annotations

import cmath
import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import DOP853, DenseOutput

from reference_model.pin import SlipMotion
from reference_model.sticking import can_hold, release_delay, slip_from_rest
from reference_model.systems import FloatArray, PinOnDisc, checked_state, checked_times, checked_tolerance
from reference_model.trajectory import Phase, SimulationError, Solution, Trajectory

ComplexArray = NDArray[np.complex128]
Kind = Literal["slip", "stick"]
Sampler = Callable[[FloatArray], tuple[ComplexArray, ComplexArray]]

TIGHTEST = 3e-14
"""The smallest relative tolerance that SciPy's integrators take."""

MOST_STEPS = 5_000_000
"""Some minutes' work; a motion that takes more is hardly meant."""


@dataclass(frozen=True)
class Thresholds:
    """Where one description of the motion hands over to the next; results must not depend on it.

    Parameters
    ----------
    slow_slip : float
        Slip that falls below this multiple of g·T is described in slip-polar coordinates (T: unit of time).
    stretching : float
        s₀ of the stretched time as a multiple of ``slow_slip``.
    rest_time : float
        Error, in units of T, up to which the closed form for the time of coming to rest is taken.
    reversal_slip : float
        Slip speed, in units of length per T, below which slip that friction can't hold counts as turned.
    series : float
        Size of the last terms of the series by which slip starts.
    safety : float
        The integrator's tolerance as a fraction of the one asked for.

    """

    slow_slip: float = 0.5
    stretching: float = 2.0
    rest_time: float = 1e-12
    reversal_slip: float = 1e-13
    series: float = 1e-12
    safety: float = 0.05


def simulate(
    system: PinOnDisc, initial_state: ArrayLike, times: ArrayLike, *, tolerance: float = 1e-9
) -> Trajectory:
    """Return the motion of a pin under exact Coulomb friction (eq. 1 and 6).

    Parameters
    ----------
    system : PinOnDisc
        The parameters.
    initial_state : array-like of shape (4,)
        x, y in m and vx, vy in m/s at ``times[0]``. A state that turns with the disc starts stuck if friction
        can hold it.
    times : array-like of shape (n,)
        Increasing, in s.
    tolerance : float
        Relative accuracy to aim at, from 1e-14 to 1e-2.

    Returns
    -------
    Trajectory

    Raises
    ------
    ValueError
        For a state, times or tolerance that are not as above.
    SimulationError
        If the integrator gives up.

    """
    return simulate_with(Thresholds(), system, initial_state, times, tolerance=tolerance)


def simulate_with(
    thresholds: Thresholds,
    system: PinOnDisc,
    initial_state: ArrayLike,
    times: ArrayLike,
    *,
    tolerance: float = 1e-9,
) -> Trajectory:
    """Do as ``simulate`` with other thresholds, to measure that they do not matter."""
    clock = time.perf_counter()
    state = checked_state(system, initial_state)
    times = checked_times(times)
    tolerance = checked_tolerance(tolerance)
    unit = _Units.of(system, state)
    run = _Run(
        unit.motion(system),
        thresholds,
        tolerance,
        times=(times - times[0]) / unit.time,
        seconds=lambda t: float(times[0] + t * unit.time),
    )
    z = complex(state[0], state[1]) / unit.length
    v = complex(state[2], state[3]) / unit.speed
    disc = 1j * run.motion.disc_speed * z
    stuck = abs(v - disc) <= 4.0 * np.finfo(float).eps * abs(disc)  # as closely as floats can say
    run.go(z, 0j if stuck else v - disc)

    velocities = run.slip + 1j * run.motion.disc_speed * run.positions
    states = _states(run.positions * unit.length, velocities * unit.speed)
    states[0] = state
    if not np.all(np.isfinite(states)):
        raise SimulationError(
            f"the states are not finite from t = {times[np.argmin(np.isfinite(states).all(axis=1))]:g} s on: "
            "the parameters differ by too many orders of magnitude"
        )
    solution = Solution(
        method="DOP853 in slip phases with slip-polar coordinates near rest; closed-form stick phases",
        tolerance=tolerance,
        evaluations=run.evaluations,
        steps=run.steps,
        wall_time=time.perf_counter() - clock,
    )
    return Trajectory(system, times, states, _phases(run, unit, times), solution)


@dataclass(frozen=True)
class _Units:
    """Units of length and time in which the motion is of order one."""

    length: float
    time: float

    @property
    def speed(self) -> float:
        return self.length / self.time

    @classmethod
    def of(cls, pin: PinOnDisc, state: FloatArray) -> _Units:
        x, y, vx, vy = state.tolist()
        friction = pin.friction_force / pin.mass
        speed = math.hypot(vx, vy)
        rate = max(pin.natural_frequency, abs(pin.disc_speed)) or pin.damping / pin.mass
        if rate == 0.0:  # a free pin on a resting disc
            rate = friction / speed if friction > 0.0 < speed else 1.0
        length = max(math.hypot(x, y), abs(pin.offset), speed / rate, friction / rate**2)
        return cls(length if length > 0.0 else 1.0, 1.0 / rate)

    def motion(self, pin: PinOnDisc) -> SlipMotion:
        """Return the equations of motion in these units."""
        motion = SlipMotion.of(pin)
        return SlipMotion(
            damping=motion.damping * self.time,
            stiffness=motion.stiffness * self.time**2,
            friction=motion.friction * self.time**2 / self.length,
            disc_speed=motion.disc_speed * self.time,
            offset=motion.offset / self.length,
        )


@dataclass
class _Run:
    """A simulation under way, from t = 0 on; z, w and times are scaled, ``seconds`` gives the time in s."""

    motion: SlipMotion
    thresholds: Thresholds
    tolerance: float
    times: FloatArray
    seconds: Callable[[float], float]
    positions: ComplexArray = field(init=False)
    slip: ComplexArray = field(init=False)
    phases: list[tuple[Kind, float, complex, complex]] = field(default_factory=list)  # kind, start, z, w
    evaluations: int = 0
    steps: int = 0
    _recorded: int = 0

    def __post_init__(self) -> None:
        self.positions = np.empty(len(self.times), dtype=complex)
        self.slip = np.empty_like(self.positions)
        self._slow = self.thresholds.slow_slip * self.motion.friction
        self._stretching = self.thresholds.stretching * self._slow
        self._local_tolerance = max(self.thresholds.safety * self.tolerance, TIGHTEST)

    def go(self, z: complex, w: complex) -> None:
        """Run from z, w at t = 0 to the last time."""
        t, end = 0.0, float(self.times[-1])
        self._record(t, lambda _: (np.array([z]), np.array([w])))
        sticky = self.motion.friction > 0.0
        if not (sticky and w == 0.0 and self._holds_for(z) > 0.0):
            self.phases.append(("slip", t, z, w))
        elif t == end:
            self.phases.append(("stick", t, z, w))
        while t < end:
            if not sticky or abs(w) > 0.0:
                slowly = sticky and abs(w) < self._slow
                t, z, w = self._slip_slowly(t, z, w) if slowly else self._slip(t, z, w)
                continue
            held = self._holds_for(z)
            if held > 0.0:
                self.phases.append(("stick", t, z, 0j))
                t, z = self._stick(t, z, held)
                if t >= end:
                    break
                self.phases.append(("slip", t, z, 0j))
            t, z, w = self._start_slip(t, z)
            if t < end and abs(w) > 0.0:
                t, z, w = self._slip(t, z, w)

    def _holds_for(self, z: complex) -> float:
        """Return how long friction holds a pin at rest on the disc at ``z``."""
        return release_delay(self.motion, z) if can_hold(self.motion, z) else 0.0

    def _slip(self, t: float, z: complex, w: complex) -> tuple[float, complex, complex]:
        """Integrate in z and w until slip is slow and becomes slower, or to the end."""
        pull, omega, g = self.motion.pull, 1j * self.motion.disc_speed, self.motion.friction

        def rates(_: float, y: FloatArray) -> FloatArray:
            z, w = complex(y[0], y[1]), complex(y[2], y[3])
            speed = abs(w)
            acceleration = pull(z, w) - (g * w / speed if speed > 0.0 else 0.0)
            v = w + omega * z
            return np.array((v.real, v.imag, acceleration.real, acceleration.imag))

        def sampler(dense: DenseOutput) -> Sampler:
            def sample(times: FloatArray) -> tuple[ComplexArray, ComplexArray]:
                y = dense(times)
                return y[0] + 1j * y[1], y[2] + 1j * y[3]

            return sample

        solver = self._solver(rates, t, (z.real, z.imag, w.real, w.imag), float(self.times[-1]))
        while solver.status == "running":
            self._step(solver, t)
            if self._pending(solver.t):
                self._record(solver.t, sampler(solver.dense_output()))
            t, z, w = solver.t, complex(*solver.y[:2]), complex(*solver.y[2:])
            slows_down = abs(w) < self._slow and (pull(z, w) * w.conjugate()).real < g * abs(w)
            if slows_down:
                break
        self.evaluations += solver.nfev
        return t, z, w

    def _slip_slowly(self, start: float, z: complex, w: complex) -> tuple[float, complex, complex]:
        """Integrate in slip-polar coordinates and stretched time until slip is fast again or zero."""
        motion, omega, g, s0 = (
            self.motion,
            1j * self.motion.disc_speed,
            self.motion.friction,
            self._stretching,
        )
        end = float(self.times[-1])

        def rates(_: float, y: FloatArray) -> FloatArray:
            # A trial step may overshoot wildly before it is rejected: exp() must not overflow there.
            z, s, e = complex(y[0], y[1]), math.exp(min(y[2], 50.0)), cmath.exp(1j * y[3])
            w = s * e
            b = motion.pull(z, w) * e.conjugate()
            stretched = math.hypot(s, s0)
            pace = s / stretched  # dt/dτ
            v = (w + omega * z) * pace
            return np.array((v.real, v.imag, (b.real - g) / stretched, b.imag / stretched, pace))

        def sampler(dense: DenseOutput) -> Sampler:
            def sample(times: FloatArray) -> tuple[ComplexArray, ComplexArray]:
                y = dense(_stretched_times(dense, times - start, s0))
                return y[0] + 1j * y[1], np.exp(y[2] + 1j * y[3])

            return sample

        # ln s, θ and t count by their absolute error: that of t must not grow with the length of the run.
        relative = np.array((self._local_tolerance,) * 2 + (TIGHTEST,) * 3)
        y = (z.real, z.imag, math.log(abs(w)), cmath.phase(w), 0.0)
        solver = self._solver(rates, 0.0, y, math.inf, relative)
        while True:
            self._step(solver, start)
            t, z, s = start + solver.y[4], complex(*solver.y[:2]), math.exp(solver.y[2])
            e = cmath.exp(1j * solver.y[3])
            if self._pending(t):
                self._record(min(t, end), sampler(solver.dense_output()))
            if t >= end or s > 1.2 * self._slow:
                w = s * e
                break
            pull = motion.pull(z, s * e)
            limit = g - abs(pull)
            slowing = max(g - (pull * e.conjugate()).real, limit)
            if limit > 0.0:
                left = s / limit
                error = left * (slowing - limit) / slowing + left**2 * (abs(motion.disc_speed) + 1.0)
                if error < self.thresholds.rest_time:
                    z, w = self._come_to_rest(t, left, z, s * e), 0j
                    t += left
                    break
            if s < self.thresholds.reversal_slip:
                w = 0j  # head-on, or at the limit of what friction holds: over within rounding
                break
        self.evaluations += solver.nfev
        return t, z, w

    def _come_to_rest(self, t: float, left: float, z: complex, w: complex) -> complex:
        """Follow the pin through its last ``left`` of slip, which falls linearly; return where it rests."""
        omega = 1j * self.motion.disc_speed

        def sample(times: FloatArray) -> tuple[ComplexArray, ComplexArray]:
            delays = times - t
            decay = 1.0 - delays / left
            positions = z * np.exp(omega * delays) + w * delays * (1.0 + decay) / 2.0
            return positions.astype(complex), (w * decay).astype(complex)

        self._record(t + left, sample)
        return complex(sample(np.array([t + left]))[0][0])

    def _stick(self, t: float, z: complex, held: float) -> tuple[float, complex]:
        """Turn with the disc for ``held``, until friction lets go; return when and where."""
        omega = 1j * self.motion.disc_speed
        release = min(t + held, float(self.times[-1]))
        self._record(release, lambda times: (z * np.exp(omega * (times - t)), np.zeros(len(times), complex)))
        return release, z * cmath.exp(omega * (release - t))

    def _start_slip(self, t: float, z: complex) -> tuple[float, complex, complex]:
        """Follow the series by which slip grows from rest, as far as it holds or until slip ends again."""
        start = slip_from_rest(self.motion, z, tolerance=self.thresholds.series)
        self.evaluations += len(start.positions)  # each order costs about one evaluation of the pull
        stop = t + min(start.duration, start.rest)
        end = min(stop, float(self.times[-1]))
        self._record(end, lambda times: start.at(times - t))
        positions, slip = start.at(np.array([end - t]))
        rests = start.rest <= start.duration and end == stop
        return end, complex(positions[0]), 0j if rests else complex(slip[0])

    def _solver(
        self,
        rates: Callable[[float, FloatArray], FloatArray],
        t: float,
        y: tuple[float, ...],
        end: float,
        relative_tolerance: ArrayLike | None = None,
    ) -> DOP853:
        tolerance = self._local_tolerance
        relative_tolerance = tolerance if relative_tolerance is None else relative_tolerance
        return DOP853(rates, t, np.array(y), end, rtol=relative_tolerance, atol=tolerance)

    def _step(self, solver: DOP853, since: float) -> None:
        message = solver.step()
        self.steps += 1
        if self.steps > MOST_STEPS:
            raise SimulationError(
                f"more than {MOST_STEPS:,} steps up to t = {self.seconds(since):g} s: the parameters are very "
                "stiff, or the motion is very long; simulate it in parts, or with a larger tolerance"
            )
        if solver.status == "failed" or not np.all(np.isfinite(solver.y)):
            raise SimulationError(
                f"the integrator gave up after t = {self.seconds(since):g} s: "
                f"{message or 'the state is not finite'}; try a larger tolerance than {self.tolerance:g}"
            )

    def _pending(self, t: float) -> bool:
        """Tell whether a time that was asked for lies before or at ``t``."""
        return self._recorded < len(self.times) and self.times[self._recorded] <= t

    def _record(self, until: float, sample: Sampler) -> None:
        """Store the motion at the times up to ``until`` that are not yet recorded."""
        stop = int(np.searchsorted(self.times, until, side="right"))
        span = slice(self._recorded, stop)
        if stop > self._recorded:
            self.positions[span], self.slip[span] = sample(self.times[span])
            self._recorded = stop


def _stretched_times(dense: DenseOutput, delays: FloatArray, s0: float) -> FloatArray:
    """Return τ at which the time component of ``dense`` takes the values ``delays``, by Newton's method.

    Time grows monotonically with τ inside of a step; where Newton's method would leave the step it is stopped
    at its end.
    """
    first, last = dense.t_min, dense.t_max
    t_first, t_last = dense(first)[4], dense(last)[4]
    tau: FloatArray = first + (last - first) * (delays - t_first) / (t_last - t_first)
    for _ in range(50):
        y = dense(tau)
        s = np.exp(y[2])
        correction = (y[4] - delays) * np.hypot(s, s0) / s
        tau = np.clip(tau - correction, first, last)
        if np.all(np.abs(y[4] - delays) <= 4.0 * np.finfo(float).eps * max(abs(t_last), 1.0)):
            break
    return tau


def _states(z: ComplexArray, v: ComplexArray) -> FloatArray:
    states: FloatArray = np.column_stack((z.real, z.imag, v.real, v.imag))
    return states


def _phases(run: _Run, unit: _Units, times: FloatArray) -> tuple[Phase, ...]:
    starts = [run.seconds(t) for _, t, _, _ in run.phases]
    ends = [*starts[1:], times[-1]]
    omega = 1j * run.motion.disc_speed
    return tuple(
        Phase(
            kind,
            float(start),
            float(end),
            _states(np.array([z * unit.length]), np.array([(w + omega * z) * unit.speed]))[0],
        )
        for (kind, _, z, w), start, end in zip(run.phases, starts, ends, strict=True)
    )
