"""Claims on whirls and on the self-centred equilibrium."""

import functools
import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

import compare.studies.disc.fig09.theory as theory
from compare.claims import TIGHTEST, Measured, Measurement, known, refined
from compare.engines import Engine
from compare.studies.disc.fig09.theory import STUDY
from compare.studies.toolkit.measuring import compared, extremes
from compare.studies.toolkit.pins import SIZES, extent, sizes_of, whirl_of
from compare.studies.toolkit.steady_motion import sharpness, steady_motion, with_load
from reference_model import Orbit
from reference_model.steady.steady_states import whirls
from reference_model.systems import FloatArray

# --- Steady motions of an engine, and orders of small gaps


Cases = tuple[tuple[float, int | None], ...]
"""μN in N, and the number of a whirl without offset or None for the equilibrium with the offset."""


@functools.lru_cache(maxsize=8)
def steady_motions(engine: Engine, cases: Cases, points: int | None = None) -> Measurement:
    found = refined(
        lambda tolerance: [means(engine, *case, points, tolerance) for case in cases], theory.ORBIT_TOLERANCE
    )
    return with_tolerance(
        found, [sharpness(theory.disc_of(*case, points), theory.exact_motion(*case)) for case in cases]
    )


def means(engine: Engine, load: float, which: int | None, points: int | None, tolerance: float) -> FloatArray:
    """Return the means over a steady motion, NaN if none is found.

    They are radius, frequency and spin of a whirl, divided by μN/(βk), k and ω, or x, y and spin at rest, divided by
    X0 and ω.
    """
    disc = theory.disc_of(load, which, points)
    motion = steady_motion(engine, disc, theory.exact_motion(load, which).state, tolerance)
    if motion is None:
        return np.full(3, np.nan)
    place, spin = motion.mean, motion.spin / disc.disc_speed
    if which is None:
        return np.array([*place / disc.offset, spin])
    frequency = motion.frequency / disc.natural_frequency
    return np.array([float(np.hypot(*place)) / theory.radius_of_pin(load), frequency, spin])


def with_tolerance(found: Measurement, amplified: ArrayLike) -> Measurement:
    """Return motions found by shooting, shape (n, m), with one error for all numbers of a motion.

    It includes the tolerance times ``amplified``, because two flows may agree to within it.
    """
    return Measurement(
        found.value, found.rows + theory.ORBIT_TOLERANCE * np.asarray(amplified)[:, np.newaxis]
    )


def extrapolated(gaps: FloatArray, error: FloatArray) -> tuple[FloatArray, FloatArray, float]:
    """Return the order of ``gaps``, shape (3, m), at a variable halved twice, its numerical and its model error.

    The order converges like the square of the variable.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        orders = np.log2(gaps[:-1] / gaps[1:])
        noise = error / gaps
    step = (orders[1] - orders[0]) / 3.0
    numerical = np.asarray(5.0 / 3.0 * (noise[1] + noise[2]) / math.log(2.0))
    order = orders[1] + step
    return order, known(order, numerical), float(np.nan_to_num(np.max(np.abs(step))))


# --- The whirl without offset

LOADS = [load for load, _ in theory.CIRCLES]

OBSERVED = (
    "Orders of the deviations of radius and spin, extrapolated. Model error: the change due to extrapolation. The "
    "limit of the spin, ω − b(ω − Ω)/(b + R²βk/(2(ω − k))) = "
    f"{theory.spin_of_large_whirl(theory.RING):.6f} rad/s, follows from F = 1 and M = RW/(2U). Friction forces: "
    f"{', '.join(f'{load:g}' for load in LOADS[theory.ORDERS])} N."
)


@STUDY.claim(
    "Without offset, the whirl has the radius, frequency and spin of the three balances, stable or not",
    equation="(19), (20)",
    resolution=1e-6,
    note="Relative to μN/(βk), k and ω; the second of two whirls at the same μN is unstable. Measured: the state "
    "that repeats in the engine up to a rotation. Predicted: radial, tangential and torsional balance on the "
    "continuous ring.",
    basis="reference",
    swept=("friction_force",),
)
def circles(engine: Engine) -> Measured:
    found = steady_motions(engine, theory.CIRCLES)
    exact = [(load, theory.circle_of(load, which)) for load, which in theory.CIRCLES]
    k, omega = theory.RING.natural_frequency, theory.RING.disc_speed
    return compared(
        [
            (one.radius / theory.radius_of_pin(load), one.frequency / k, one.spin / omega)
            for load, one in exact
        ],
        found,
        at={"μN in N": LOADS},
        components=("radius", "frequency", "spin"),
        system=theory.CENTRED,
        source=theory.SOURCE_CENTRED,
        data={"circle load": LOADS, "circle": found.value},
    )


@STUDY.claim(
    "The error of (23) falls like (μN)⁻⁴ in the whirl's radius, and like (μN)⁻² in its spin",
    equation="(23)",
    kind="order",
    resolution=0.1,
    note=OBSERVED,
    implied_by=circles,
    swept=("friction_force",),
)
def error_of_23(engine: Engine) -> Measured:
    by_23 = []
    for load in LOADS[theory.ORDERS]:
        one = whirls(with_load(theory.CENTRED, load), theory.PAPER_LAW)[0]
        by_23.append((one.radius / theory.radius_of_pin(load), one.spin / theory.RING.disc_speed))
    return _orders_of_loads(engine, by_23, (-4.0, -2.0))


@STUDY.claim(
    "The whirl's radius tends to the pin's μN/(βk), its spin to a limit; both deviations are proportional to (μN)⁻²",
    equation="(11)",
    kind="order",
    resolution=0.1,
    note=OBSERVED,
    implied_by=circles,
    swept=("friction_force",),
)
def limit_of_large_loads(engine: Engine) -> Measured:
    limit = (1.0, theory.spin_of_large_whirl(theory.RING) / theory.RING.disc_speed)
    return _orders_of_loads(engine, [limit] * len(LOADS[theory.ORDERS]), (-2.0, -2.0))


def _orders_of_loads(
    engine: Engine, others: Sequence[tuple[float, float]], orders: Sequence[float]
) -> Measured:
    found = steady_motions(engine, theory.CIRCLES)
    gaps: FloatArray = np.abs(found.value[theory.ORDERS][:, [0, 2]] - others)
    of_both = {"components": ("radius", "spin"), "source": theory.SOURCE_CENTRED}
    return _orders(gaps, found.error[theory.ORDERS][:, :1], orders, system=theory.CENTRED, **of_both)


def _orders(gaps: FloatArray, noise: FloatArray, orders: Sequence[float], **more: Any) -> Measured:
    observed, numerical, model = extrapolated(gaps, noise)
    value = np.sign(orders) * observed
    return Measured(predicted=orders, value=value, error=numerical, model=model, **more)


# --- Whirls with an offset

EXTRAPOLATED = (
    f"X0 = {', '.join(f'{offset:g}' for offset in theory.HALVED_OFFSETS)} m, extrapolated. Model error: the change "
    "due to extrapolation."
)


@STUDY.claim(
    "With the offset, the whirls equal the periodic orbits of exact Coulomb friction, stable or not",
    equation="(19), (20)",
    kind="trajectory",
    unit="s, m, rad/s",
    resolution=1e-6,
    note="The second of two whirls at the same μN is unstable. Measured: shooting with the engine. Predicted: "
    f"the reference at tolerance {TIGHTEST:g}.",
    swept=("friction_force",),
)
def orbits(engine: Engine, whirls: Sequence[tuple[float, int]] = theory.ORBITS) -> Measured:
    """``whirls`` contains μN (N) and the number of each whirl."""
    exact = [theory.orbit_of_reference(*one) for one in whirls]
    predicted = np.array([sizes_and_spins(orbit) for orbit in exact])
    found = refined(
        lambda tolerance: [sizes_and_spins(orbit_of(engine, *one, tolerance)) for one in whirls],
        theory.ORBIT_TOLERANCE,
    )
    # The multiplier of a shift in time is 1; the next closest shows the amplification of errors of the flow.
    distances = [sorted(abs(1.0 - value) for value in orbit.multipliers) for orbit in exact]
    found = with_tolerance(found, predicted[:, 2] / np.array(distances)[:, 1])
    loads = [load for load, _ in whirls]
    read = max(max(extent(orbit).largest, spins_of(orbit).largest) for orbit in exact)
    return compared(
        predicted,
        found.plus(2.0 * read),
        at={"μN in N": loads},
        components=(*SIZES, "smallest spin in rad/s", "largest spin in rad/s", "mean spin in rad/s"),
        data={"orbit load": loads, "orbit": found.value},
    )


def orbit_of(
    engine: Engine, load: float, which: int, tolerance: float, offset: float = theory.RING.offset
) -> Orbit:
    guess = theory.orbit_of_reference(load, which, offset)
    return whirl_of(engine, guess.system, tolerance, guess)


def sizes_and_spins(orbit: Orbit) -> FloatArray:
    """Return the numbers of ``SIZES``, and the smallest, largest and mean spin (rad/s)."""
    return np.array([*sizes_of(orbit), *spins_of(orbit).value, np.mean(orbit.trajectory.states[:-1, -1])])


def spins_of(orbit: Orbit) -> Measurement:
    """Return the smallest and largest spin, and the errors of reading them from samples (rad/s)."""
    return extremes(orbit.trajectory.states[:, -1], periodic=True)


@functools.lru_cache(maxsize=4)
def parts(engine: Engine) -> Measurement:
    """Return x, y of the centre, amplitude of the first harmonic, mean spin at ``HALVED_OFFSETS``, shape (3, 4)."""

    def found(tolerance: float) -> FloatArray:
        rows = []
        for offset in theory.HALVED_OFFSETS:
            whirl = orbit_of(engine, theory.OFFSET_LOAD, 0, tolerance, offset)
            x, y, *_, spin = whirl.trajectory.states[:-1].T
            rows.append((*whirl.mean, np.abs(np.fft.fft(x + 1j * y) / len(x))[1], np.mean(spin)))
        return np.array(rows)

    return refined(found, theory.ORBIT_TOLERANCE, alike=False)


@STUDY.claim(
    "The offset shifts the centre of the whirl by the first-order response, with an error like X0³",
    equation="(18)",
    kind="order",
    resolution=0.05,
    note=f"Order for {EXTRAPOLATED} This is not in the paper, whose (18) is for the pin. Here the shift is the "
    "linear response of the circle to the offset, which turns backwards in the axes that turn with the circle.",
    basis="reference",
    swept=("offset",),
)
def offset_shifts(engine: Engine) -> Measured:
    found = parts(engine)
    disc = with_load(theory.RING, theory.OFFSET_LOAD)
    response = [theory.first_order_shift(replace(disc, offset=offset)) for offset in theory.HALVED_OFFSETS]
    gaps = np.abs(found.value[:, 0] + 1j * found.value[:, 1] - response)[:, np.newaxis]
    noise = np.hypot(found.error[:, 0], found.error[:, 1])[:, np.newaxis]
    return _orders(gaps, noise, (3.0,), components=("shift",), system=disc)


@STUDY.claim(
    "The offset changes radius and spin of the whirl like X0²",
    kind="order",
    resolution=0.05,
    note=f"Orders of the change of the first harmonic's amplitude, and of the mean spin, for {EXTRAPOLATED}",
    basis="reference",
    swept=("offset",),
)
def offset_changes_size(engine: Engine) -> Measured:
    found, circle = parts(engine), theory.circle_of(theory.OFFSET_LOAD, 0)
    _, _, radius, spin = found.value[1]
    gaps = np.abs(found.value[:, 2:] - [circle.radius, circle.spin])
    return _orders(
        gaps,
        found.error[:, 2:],
        (2.0, 2.0),
        components=("radius", "spin"),
        system=with_load(theory.RING, theory.OFFSET_LOAD),
        note=f"At X0 = {theory.HALVED_OFFSETS[1]:g} m, the radius changes by {radius / circle.radius - 1.0:.2g} of "
        f"itself and the spin by {spin - circle.spin:.2g} rad/s.",
    )


@STUDY.claim(
    "Position and spin of the self-centred disc satisfy the balance of forces and moments, stable or not",
    equation="(19), (20)",
    resolution=1e-7,
    note="Relative to X0 and ω. Measured: the state that repeats in the engine.",
    basis="reference",
    swept=("friction_force",),
)
def rests(engine: Engine, loads: Sequence[float] = theory.REST_LOADS) -> Measured:
    found = steady_motions(engine, tuple((load, None) for load in loads))
    exact, scales = (
        map(theory.rest_of, loads),
        (theory.RING.offset, theory.RING.offset, theory.RING.disc_speed),
    )
    return compared(
        [np.divide((one.x, one.y, one.spin), scales) for one in exact],
        found,
        at={"μN in N": loads},
        components=("x", "y", "spin"),
        data={"rest load": loads, "rest": found.value},
    )
