"""Branches of all motions against the friction force, and their ends."""

import functools
import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq

from compare.claims import ROUNDING, TIGHTEST, WORKING, Data, Study
from compare.claims.parameters import FIG9
from compare.studies.toolkit.pins import safest_angle, stuck
from compare.studies.toolkit.steady_motion import equilibrium_of, last_load, with_load
from reference_model import Orbit, smallest_load_with_whirl, whirl_branch, whirl_orbit
from reference_model.contact.contact_law import IsotropicContact, ThreeTermRing, contact_of
from reference_model.formulas.disc import held_pin, pin_of, whirl_at
from reference_model.formulas.pin import release_time, sticking_radius, whirl_radius
from reference_model.steady.stability import turning_frame_jacobian, whirl_eigenvalues
from reference_model.steady.steady_states import SpinningEquilibrium, SpinningWhirl, whirls
from reference_model.systems import DiscOnDisc, FloatArray

RING = FIG9
CENTRED = replace(FIG9, offset=0.0)
PAPER_LAW = ThreeTermRing(FIG9.contact_radius)  # contact law (23)

SOURCE = (
    'Fig. 9; β and b as in Fig. 8 ("the same parameter values as above"); X0 = 0.1 m as in Figs. 4 to 6 and μN '
    "are our choice, the paper omits them"
)

SOURCE_CENTRED = f"{SOURCE}; X0 = 0 here"

CIRCLES: tuple[tuple[float, int], ...] = ((3e-4, 0), (3e-4, 1), (5e-4, 0), (1e-3, 0), (2e-3, 0), (0.2, 0))
"""Whirls without offset: μN in N and number in order of decreasing size; number 1 is unstable."""

ORDERS = slice(2, 5)  # circles far from the fold; μN doubles from circle to circle

REST_LOADS = (0.01, 0.05, 0.09)
ORBITS = ((0.0015, 0), (0.0015, 1), (0.02, 0), (0.2, 0))
"""μN in N of equilibria; whirls with the offset: μN in N, and 0 for the outer or 1 for the inner whirl."""

HALVED_OFFSETS, OFFSET_LOAD = (0.2, 0.1, 0.05), 0.02
"""X0 in m and μN in N of whirls that show the effect of X0."""

STICK_LOADS, INSIDE, OUTSIDE, LATEST = (0.12, 0.2), 0.98, (1.02, 1.5), 1.1
"""Sticking discs: μN in N, initial radii as multiples of (9), and duration outside (9) as a multiple of (7)."""

DECAY, GROWTHS = (0.02, 60.0), ((0.01, 100.0), (0.05, 100.0), (0.09, 60.0))
DISPLACED = 1e-4
"""μN in N and duration in s of deviations from the whirl and from equilibria; share of the distance from the axis."""

ORBIT_TOLERANCE, TOLERANCE = WORKING / 10, 3e-8
"""For periodic and sticking motions of engines, where regularised laws close to Coulomb's are expensive."""

LARGEST_LOAD = 0.2
"""End of the axis in N, which the paper omits; sticking begins at about half of it, C·X0."""

BRANCH_START, BRANCH_END, BRANCH_STEP = 0.1, 1.0, 0.24
"""First μN of the branch in C·X0, its last crossing of the x axis in X0, and the relative decrease of crossings."""

OUTER_LOADS = (0.2, 0.1, 0.05, 0.02)  # μN in N of whirls before the branch

FOLD_START, LEAST_FOLD_START, FOLD_STEP = 0.016, 4.5e-4, 0.12
"""μN/(C·X0) slightly above the fold, the smallest μN in N, and the relative step of the branch to the fold."""

FOLD_OFFSETS = (0.008, 0.012, 0.016, 0.02, 0.024, 0.03, 0.04, 0.06, 0.1, 0.15, 0.25)
OFFSETS = np.geomspace(0.004, 0.25, 40)
"""X0 in m for the fold of the whirl and the ends of other motions."""

DAMPINGS = FIG9.damping / 2.0 ** np.arange(3, 7)


def circle_of(load: float, which: int) -> SpinningWhirl:
    """Return whirl number ``which`` (largest first) of the ring without offset at μN = ``load`` (N)."""
    return whirls(with_load(CENTRED, load))[which]


def rest_of(load: float) -> SpinningEquilibrium:
    return equilibrium_of(with_load(RING, load))


def exact_motion(load: float, which: int | None) -> SpinningWhirl | SpinningEquilibrium:
    """Return the whirl number ``which`` without offset, or for None the equilibrium with the offset."""
    return rest_of(load) if which is None else circle_of(load, which)


def disc_of(load: float, which: int | None, points: int | None) -> DiscOnDisc:
    return with_load(replace(RING if which is None else CENTRED, contact_points=points), load)


def stuck_at(disc: DiscOnDisc, share: float) -> tuple[FloatArray, float]:
    """Return the state of a disc that sticks at ``share`` of the radius (9), and its release time (7) in s."""
    pin = held_pin(replace(disc, contact_points=None))
    radius, angle = share * sticking_radius(pin), safest_angle(pin)
    state = np.insert(np.append(stuck(pin, radius, angle), disc.disc_speed), 2, 0.0)
    return state, release_time(pin, radius, angle) if share > 1.0 else math.inf


@functools.cache
def orbit_of_reference(load: float, which: int, offset: float = RING.offset) -> Orbit:
    """Return the outer whirl with an offset, or the inner, unstable one for ``which`` = 1."""
    disc = with_load(replace(RING, offset=offset), load)
    return whirl_orbit(disc, guess=inner_orbit(disc) if which else None, tolerance=TIGHTEST, samples=64)


def radius_of_pin(load: float) -> float:
    """Return μN/(βk) in m, the radius (11) of a pin's whirl."""
    return whirl_radius(pin_of(with_load(CENTRED, load)))


def spin_of_large_whirl(disc: DiscOnDisc) -> float:
    """Return the limit (rad/s) of the whirl's spin for large μN.

    Then RS is much smaller than U = (ω − k)·μN/(βk), so F = 1 and M = R²S/(2U). The torsional balance b(ω − Ω − S) =
    μN·M gives S = b(ω − Ω)/(b + R²βk/(2(ω − k))).
    """
    k = disc.natural_frequency
    friction = disc.contact_radius**2 * disc.damping * k / (2.0 * (disc.disc_speed - k))
    difference = disc.disc_speed - disc.shaft_speed
    return disc.disc_speed - disc.shaft_damping * difference / (disc.shaft_damping + friction)


def first_order_shift(disc: DiscOnDisc) -> complex:
    """Return the time mean of x + iy (m) of a disc's whirl, to first order in X0.

    In axes that turn with the circle, the acceleration k²X0 due to the offset turns backwards. The deviation is
    Re(a·exp(−iκt)) with (−iκ − A)a = k²X0·(0, 0, 1, −i, 0) and the Jacobian A. Its backward component, (a_x +
    i·a_y)/2, is fixed in space.
    """
    circle = whirls(replace(disc, offset=0.0))[0]
    jacobian = turning_frame_jacobian(replace(disc, offset=0.0), circle.state)
    pull = disc.offset * disc.natural_frequency**2 * np.array([0.0, 0.0, 1.0, -1.0j, 0.0])
    answer = np.linalg.solve(-1.0j * circle.frequency * np.eye(5) - jacobian, pull)
    return complex(answer[0] + 1.0j * answer[1]) / 2.0


def to_inner_orbits(disc: DiscOnDisc, step: float = BRANCH_STEP) -> Iterator[Orbit]:
    """Yield whirls of decreasing size, from the whirl of ``disc`` through the fold to the inner, unstable whirls."""
    outermost = whirl_orbit(disc, tolerance=ORBIT_TOLERANCE, samples=64)
    return whirl_branch(outermost, BRANCH_END * disc.offset, step=step)


def inner_orbit(disc: DiscOnDisc) -> Orbit:
    """Return the first orbit beyond the fold with a larger friction force than ``disc``."""
    orbits = to_inner_orbits(disc)
    next(orbits)
    return next(orbit for orbit in orbits if orbit.system.friction_force > disc.friction_force)


def last_stable_load(disc: DiscOnDisc) -> float:
    """Return the largest μN (N) of a stable self-centred equilibrium; its end if it is always stable."""
    end = last_load(disc)

    def growth(logarithm: float) -> float:
        return equilibrium_of(with_load(disc, math.exp(logarithm))).eigenvalues[0].real

    loads = np.linspace(math.log(1e-3 * end), math.log(end * (1.0 - 1e-6)), 16)
    for lower, upper in itertools.pairwise(loads):
        if growth(upper) > 0.0:
            return math.exp(brentq(growth, lower, upper, xtol=ROUNDING))
    return end


def smallest_load(disc: DiscOnDisc) -> float:
    """Return μN (N) at the whirl's fold, the vertex of a parabola through the orbits next to it."""
    found: list[tuple[float, float]] = []
    start = max(FOLD_START * disc.stiffness * disc.offset, LEAST_FOLD_START)
    for orbit in to_inner_orbits(with_load(disc, start), FOLD_STEP):
        found.append((math.log(orbit.state[0]), orbit.system.friction_force))
        if len(found) > 1 and found[-1][1] > found[-2][1]:
            break
    sizes, loads = np.transpose(found[-3:])
    square, linear, constant = np.polyfit(sizes, loads, 2)
    return float(constant - linear**2 / (4.0 * square))


def weak_damping_load(disc: DiscOnDisc) -> float:
    """Return the friction force (N) where the equilibrium loses its stability, to first order in β.

    Small loads leave the centre at X0, with U = ωX0 and S = ω − Ω. Friction resists a small additional slip u = ż −
    iωz by μN·F/U across U and by μN·F' along it, F' = ∂F/∂U. A motion ~ exp((ik + δ)t) then satisfies (s + μN·F/U)(s
    + μN·F') = (μN)²·(F/U)·F'·ω²/k² with s = 2mδ + β. So s = μN·σ, and δ = 0 at μN = β/σ.
    """
    slip = disc.disc_speed * disc.offset
    law = contact_of(disc)
    assert isinstance(law, IsotropicContact)
    spin = disc.disc_speed - disc.shaft_speed
    across = law.shares(slip, spin).resistance / slip
    along = law.slopes(slip, spin).resistance_by_slip
    product = across * along * ((disc.disc_speed / disc.natural_frequency) ** 2 - 1.0)
    total = across + along
    return disc.damping * (total + math.sqrt(total**2 + 4.0 * product)) / (2.0 * product)


def marginal_ratio(law: IsotropicContact | None) -> float:
    """Return the α of the whirl, tan α = R|S|/U, with a second eigenvalue of zero."""

    def growth(alpha: float) -> float:
        whirl = whirl_at(CENTRED, alpha, law)
        k = CENTRED.natural_frequency
        state = np.array([whirl.radius, 0.0, 0.0, 0.0, k * whirl.radius, whirl.spin])
        return max(value.real for value in whirl_eigenvalues(with_load(CENTRED, whirl.load), state, law)[1:])

    return float(brentq(growth, 0.1, 1.5, xtol=1e-6))


def curves(offsets: ArrayLike = OFFSETS, fold_offsets: Sequence[float] = FOLD_OFFSETS) -> Data:
    """Return all branches against μN, and where they end against X0 (the whirl at ``fold_offsets``)."""
    return circles() | smooth(orbits()) | rests_and_sticking() | ends(offsets, fold_offsets)


def circles() -> Data:
    angles = np.arctan(np.geomspace(8e-4, 1e4, 400))
    laws = {"ring": None, "(23)": PAPER_LAW}
    return {
        f"circles, {name}": np.array([whirl_at(CENTRED, alpha, law) for alpha in angles])
        for name, law in laws.items()
    }


@functools.cache
def orbits() -> tuple[Orbit, ...]:
    """Return whirls of decreasing size, from the largest μN through the fold to the equilibrium."""
    outer = [
        whirl_orbit(with_load(RING, load), tolerance=ORBIT_TOLERANCE, samples=64) for load in OUTER_LOADS
    ]
    return (*outer, *to_inner_orbits(with_load(RING, BRANCH_START * RING.stiffness * RING.offset)))


def smooth(found: Sequence[Orbit]) -> Data:
    """Return μN, smallest and largest radius, and mean spin of the ``found`` orbits and of orbits between them.

    Beyond the last orbit, its shape shrinks onto the equilibrium, with the square of its size linear in the load.
    """
    limit, per_load = spin_of_large_whirl(RING), 1.0 / (RING.damping * RING.natural_frequency)
    load = np.array([orbit.system.friction_force for orbit in found])
    spin = np.array([np.mean(orbit.trajectory.states[:-1, -1]) for orbit in found])
    places = np.array([orbit.trajectory.states[:, 0] + 1j * orbit.trajectory.states[:, 1] for orbit in found])
    shapes = places / (load * per_load)[:, np.newaxis]
    rows = np.column_stack((np.log(load), np.log(spin - limit), shapes.real, shapes.imag))
    fine = PchipInterpolator(np.arange(len(found)), rows)(np.linspace(0.0, len(found) - 1.0, 20 * len(found)))
    fine_load = np.exp(fine[:, 0])
    radius = np.hypot(*np.split(fine[:, 2:], 2, axis=1)) * (fine_load * per_load)[:, np.newaxis]

    end = last_stable_load(RING)
    rest = equilibrium_of(with_load(RING, end))
    size = np.linspace(1.0, 0.0, 20)[:, np.newaxis]
    weight, centre = size**2, np.mean(places[-1, :-1])
    shrinking = weight * centre + (1.0 - weight) * complex(rest.x, rest.y) + size * (places[-1] - centre)
    radii, share = np.vstack((radius, np.abs(shrinking))), weight[:, 0]
    loads = np.append(fine_load, share * load[-1] + (1.0 - share) * end)
    spins = np.append(limit + np.exp(fine[:, 1]), share * spin[-1] + (1.0 - share) * rest.spin)
    return {"orbits": np.column_stack((loads, radii.min(axis=1), radii.max(axis=1), spins))}


def rests_and_sticking() -> Data:
    """Return μN, radius and spin of equilibria, their largest stable μN, and μN and radius (9) of stick."""
    end = last_load(RING)
    sticking = np.geomspace(end, LARGEST_LOAD, 100)[1:]
    loads = end * np.sin(np.geomspace(1e-3, 0.5 * np.pi, 200))[:-1]  # closer where the radius is steep
    found = [(load, rest_of(load)) for load in loads]
    return {
        "rests": np.array([(load, math.hypot(one.x, one.y), one.spin) for load, one in found]),
        "last stable load": np.array([last_stable_load(RING)]),
        "sticking": np.array([(load, sticking_radius(held_pin(with_load(RING, load)))) for load in sticking]),
    }


def ends(offsets: ArrayLike, fold_offsets: Sequence[float]) -> Data:
    """Return the μN where the equilibrium ends, where it becomes unstable and where the whirl folds, against X0."""
    offsets = np.asarray(offsets, dtype=float)
    discs = [replace(RING, offset=offset) for offset in offsets.tolist()]
    folds = [(0.0, smallest_load_with_whirl(CENTRED))]
    folds += [(offset, smallest_load(replace(RING, offset=offset))) for offset in fold_offsets]
    return {
        "offset": offsets,
        "last load": np.array([last_load(disc) for disc in discs]),
        "last stable": np.array([last_stable_load(disc) for disc in discs]),
        "folds": np.array(folds),
    }


STUDY = Study.beside(
    __file__, "fig09", source=SOURCE, system=RING, seconds=7.0, words={"own": f"{RING.offset:g}"}
)
STUDY.provides(curves=curves)
