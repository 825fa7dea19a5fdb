"""The whirl and its modes, the modulated cycle, and the branches against the offset."""

import functools
import itertools
import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial import Polynomial
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from compare.claims import TRUTH, Measurement, Study
from compare.claims.linearised_flow import ComplexArray, rotated
from compare.claims.parameters import FIG8, FIG11
from compare.engines import Engine, reference
from compare.studies.toolkit.fig11 import DISCS, RING, SOURCE, START, integrated, rates
from compare.studies.toolkit.measuring import extremes
from compare.studies.toolkit.pins import whirl_of
from compare.studies.toolkit.steady_motion import steady_motion
from reference_model import Orbit, Trajectory, self_centred_equilibria, simulate, whirl_orbit, whirls
from reference_model.contact.contact_law import IsotropicContact, ThreeTermRing
from reference_model.steady.stability import jacobian_without_angle, turning_frame_jacobian
from reference_model.systems import ANGLE, DiscOnDisc, FloatArray

EXPANSION = ThreeTermRing(RING.contact_radius)  # contact law (23)

CENTRED = f"{SOURCE}: 0 here"

EXTREMES = ("smallest radius in m", "largest radius in m", "smallest spin in rad/s", "largest spin in rad/s")

UNTIL = 700.0  # duration in s, three periods of the modulation
TIMES = np.linspace(0.0, UNTIL, 2801)

TRIED, BOTH_STABLE, SAMPLES_A_TURN = (0.0072, 0.00725, 0.0073), 0.0073, 16
"""X0 in m around the critical X0, which is interpolated; an X0 slightly above it; and samples per turn."""

STUDY = Study.beside(
    __file__,
    "fig11",
    source=f"{CENTRED}; start {START}",
    system=RING,
    seconds=5.0,
    words={"both_stable": f"{BOTH_STABLE:g}", "other_offset": f"{FIG8.offset:g}"},
)


# --- The whirl and its critical modes


@dataclass(frozen=True, eq=False)
class SteadyWhirl:
    """A whirl that is periodic up to a rotation, and its least damped pair of modes.

    On n points it has a ripple, with a period of 2π/n of the disc's turn relative to the line from the axis to its
    centre.

    - ``state``: a state on the whirl, shape (6,).
    - ``period``: in s.
    - ``turn``, ``advance``: rotation of the whirl in a period (rad), and the disc's additional rotation.
    - ``eigenvalue``: growth rate and frequency > 0 (1/s) of the pair.
    - ``mode``, ``projection``: right and left eigenvectors with product 1, shape (6,), in axes that turn with the
      whirl.
    """

    state: FloatArray
    period: float
    turn: float
    advance: float
    eigenvalue: complex
    mode: ComplexArray
    projection: ComplexArray

    @property
    def radius(self) -> float:
        """Initial distance of the centre from the axis (m)."""
        return math.hypot(*self.state[:2])

    def displaced(self, amplitude: float) -> FloatArray:
        """Return the state displaced along the mode by ``amplitude``, in units of the radius."""
        return np.asarray(self.state + amplitude * self.radius * self.mode.real)


@functools.cache
def steady_whirl(disc: DiscOnDisc, contact: IsotropicContact | None = None) -> SteadyWhirl:
    """Return the whirl without offset; on points, the whirl closest to the circle of the ring."""
    ring = replace(disc, contact_points=None)
    circle = whirls(ring, contact)[0]
    if disc.contact_points is not None:
        return _on_points(disc, circle.state)
    values, right = np.linalg.eig(turning_frame_jacobian(ring, circle.state, contact))
    mode, projection = _growing(values, right)
    period = 2.0 * math.pi / circle.frequency
    # The equations do not depend on the angle.
    return SteadyWhirl(
        circle.state,
        period,
        2.0 * math.pi,
        circle.spin * period - 2.0 * math.pi,
        next(value for value in circle.eigenvalues if value.imag > 0.0),
        np.insert(mode, ANGLE, 0.0),
        np.insert(projection, ANGLE, 0.0),
    )


def whirls_by_law() -> list[SteadyWhirl]:
    return [*(steady_whirl(disc) for disc in DISCS.values()), steady_whirl(RING, EXPANSION)]


def _on_points(disc: DiscOnDisc, guess: FloatArray) -> SteadyWhirl:
    """Return the whirl on points close to ``guess``, with modes of the return map linearised by differences."""
    motion = steady_motion(reference, disc, guess, TRUTH)
    if motion is None:
        raise RuntimeError(f"no whirl on {disc.contact_points} points near the circle of the ring")
    period, turn = motion.period, motion.frequency * motion.period

    def returned(state: FloatArray) -> FloatArray:
        return rotated(simulate(disc, state, [0.0, period], tolerance=TRUTH).at_end, -turn)

    shifts = 1e-4 * guess[0] * np.eye(disc.state_size)
    columns = [returned(motion.state + one) - returned(motion.state - one) for one in shifts]
    multipliers, right = np.linalg.eig(np.column_stack(columns) / (2e-4 * guess[0]))
    values = np.log(multipliers.astype(complex)) / period
    mode, projection = _growing(values, right)
    return SteadyWhirl(
        motion.state, period, turn, motion.spin * period - turn, _pair(values), mode, projection
    )


def _pair(values: ComplexArray) -> complex:
    return complex(max((value for value in values if value.imag > 0.0), key=lambda value: value.real))


def _growing(values: ComplexArray, right: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
    """Return right and left eigenvector of the least damped pair; (x, y) of the right eigenvector has length 1."""
    which = int(np.argmin(np.abs(values - _pair(values))))
    left = np.linalg.inv(right)[which]
    size = np.linalg.norm(right[:2, which])
    return np.asarray(right[:, which] / size), np.asarray(left * size)


# --- The modulated cycle


def modulations(states: FloatArray) -> FloatArray:
    """Return period (s), turn (rad), smallest and largest radius (m) and spin (rad/s) of each modulation, (n, 6).

    A modulation lasts from one maximum of the radius to the next; ``states`` belong to ``TIMES``.
    """
    x, y = states[:, 0], states[:, 1]
    radius, spin = CubicSpline(TIMES, np.hypot(x, y)), CubicSpline(TIMES, states[:, 5])
    angle = CubicSpline(TIMES, np.unwrap(np.arctan2(y, x)))
    turning, of_spin = (curve.derivative().roots(extrapolate=False) for curve in (radius, spin))
    largest = turning[radius(turning, 2) < 0.0]
    rows = []
    for start, end in itertools.pairwise(largest):
        radii = radius(turning[(start <= turning) & (turning <= end)])
        spins = spin([start, *of_spin[(start < of_spin) & (of_spin < end)]])
        extremes = radii.min(), radii.max(), spins.min(), spins.max()
        rows.append((end - start, angle(end) - angle(start), *extremes))
    return np.array(rows).reshape(-1, 6)


def last_modulation(states: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the last row of :func:`modulations` and its change from the previous row; NaN without two rows."""
    found = modulations(states)
    if len(found) < 2:
        return np.full(6, np.nan), np.full(6, np.nan)
    return found[-1], np.abs(found[-1] - found[-2])


@functools.cache
def predicted_modulation() -> tuple[FloatArray, FloatArray]:
    """Return the last modulation by integration of (19), and its error, shape (6,) each."""
    fine, rough = (
        last_modulation(integrated(RING, START, UNTIL, len(TIMES), tolerance)) for tolerance in (1e-12, 1e-11)
    )
    return fine[0], np.abs(rough[0] - fine[0]) + fine[1]


def extremes_of(trajectory: Trajectory) -> Measurement:
    """Return smallest and largest radius (m) and spin (rad/s), and the errors of reading them, shape (4,) each."""
    both = [extremes(values) for values in (trajectory.radius, trajectory.states[:, 5])]
    return Measurement(*np.swapaxes(both, 0, 1).reshape(2, 4))


# --- Whirl and equilibrium against the offset


def disc_at(offset: float) -> DiscOnDisc:
    return replace(FIG11, offset=offset)


def pair_modulus(multipliers: tuple[complex, ...] | ComplexArray) -> float:
    """Return the modulus of the largest conjugate pair of multipliers, NaN if there is none."""
    return max((abs(value) for value in multipliers if value.imag > 0.0), default=math.nan)


def critical_offset(engine: Engine, tolerance: float) -> tuple[float, float, float, Orbit]:
    """Return the critical X0 (m), its error, the slope of the modulus (1/m), and the middle whirl of ``TRIED``.

    A parabola through the moduli gives the X0 of modulus 1. The error is the change with a line through the two
    nearest points. Raise ``RuntimeError`` if no whirl is nearly critical.
    """
    orbits = [_whirl_of_reference()]
    for offset in TRIED:
        orbits.append(whirl_of(engine, disc_at(offset), tolerance, orbits[-1], samples=SAMPLES_A_TURN))
    orbits = orbits[1:]
    middle = TRIED[1]
    tried, moduli = (np.subtract(TRIED, middle), [pair_modulus(orbit.multipliers) - 1.0 for orbit in orbits])
    parabola = Polynomial.fit(tried, moduli, 2).convert()
    if not np.all(np.isfinite(parabola.coef)):
        raise RuntimeError(f"a whirl near offset = {middle:g} m has no pair of multipliers")
    # The parabola is not valid far from its points.
    roots = [root.real for root in parabola.roots() if root.imag == 0.0 and abs(root.real) < 0.1 * middle]
    if not roots:
        raise RuntimeError(f"no whirl near offset = {middle:g} m is critical")
    root = float(min(roots, key=abs))
    nearest = np.argsort(abs(tried - root))[:2]
    straight = float(Polynomial.fit(tried[nearest], np.take(moduli, nearest), 1).roots()[0])
    return middle + root, abs(straight - root), float(parabola.deriv()(root)), orbits[1]


@functools.cache
def _whirl_of_reference() -> Orbit:
    return whirl_orbit(disc_at(TRIED[0]), tolerance=1e-8, samples=SAMPLES_A_TURN)


@functools.cache
def critical_offset_of_reference() -> float:
    return critical_offset(reference, 1e-10)[0]


def multipliers_by_variation(disc: DiscOnDisc, near: Orbit, tolerance: float = 1e-8) -> ComplexArray:
    """Return the multipliers of the whirl of ``disc`` closest to the orbit ``near``, shape (5,).

    Newton's method integrates (19) with its linearisation. Raise ``RuntimeError`` if it does not converge.
    """

    def equations(_: float, both: FloatArray) -> FloatArray:
        jacobian = jacobian_without_angle(disc, both[:6])
        return np.concatenate((rates(disc, both[:6]), (jacobian @ both[6:].reshape(5, 5)).ravel()))

    state, period = near.state.copy(), near.period
    for _ in range(6):
        start = np.concatenate((state, np.eye(5).ravel()))
        run = solve_ivp(equations, (0.0, period), start, method="DOP853", rtol=tolerance, atol=tolerance)
        end, monodromy = run.y[:6, -1], run.y[6:, -1].reshape(5, 5)
        miss = np.delete(end - state, ANGLE)
        if float(np.max(np.abs(miss))) < 1e-10:
            return np.asarray(np.linalg.eigvals(monodromy), dtype=complex)
        by_time = np.delete(rates(disc, end), ANGLE)
        by_start = (monodromy - np.eye(5))[:, [0, 2, 3, 4]]  # y = 0 at the start
        step = np.linalg.solve(np.column_stack((by_start, by_time)), miss)
        state[[0, 3, 4, 5]] -= step[:4]
        period -= step[4]
    raise RuntimeError(f"no whirl at offset = {disc.offset:g} m next to the one at {near.system.offset:g} m")


@functools.cache
def rest_offset() -> float:
    """Return the X0 (m) above which the self-centred equilibrium is stable.

    The whirl exists up to a 0.25 % larger X0.
    """

    def rate(offset: float) -> float:
        return self_centred_equilibria(disc_at(offset))[0].eigenvalues[0].real

    return float(brentq(rate, 0.019, 0.022, xtol=1e-12))


def extents(run: Trajectory, last: int = 0) -> list[float]:
    """Return smallest and largest radius (m) and spin (rad/s) of the ``last`` samples, or of all."""
    radius, spin = run.radius[-last:], run.states[-last:, 5]
    return [radius.min(), radius.max(), spin.min(), spin.max()]
