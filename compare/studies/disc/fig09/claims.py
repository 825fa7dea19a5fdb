"""Figs. 9 and 10: radius and spin of whirl, self-centred equilibrium and sticking of the disc over the load."""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from compare.claims.answers import asked, holds
from compare.claims.claim import Claim, ErrorBudget
from compare.claims.error_estimates import COARSENING, ROUNDING, refined
from compare.claims.linearised_flow import real_and_imaginary, rotated
from compare.claims.parameters import at_each, parameters_of
from compare.claims.study import Data, Findings, Study
from compare.engines import Engine
from compare.studies.disc.fig09.pictures import draw
from compare.studies.disc.fig09.theory import (
    CENTRED,
    PAPER_LAW,
    RING,
    SOURCE,
    extent,
    first_order_shift,
    inner_orbit,
    radius_of_pin,
    spin_of_large_whirl,
    theory,
)
from compare.studies.toolkit.self_centred import equilibrium_of, with_load
from compare.studies.toolkit.steady_motion import mode_growth, sharpness, steady_motion
from compare.studies.toolkit.sticking import first_release, safest_angle, stuck
from reference_model import Orbit, simulate, whirl_orbit
from reference_model.formulas.disc import held_pin
from reference_model.formulas.pin import release_time, sticking_radius
from reference_model.steady.steady_states import SpinningEquilibrium, SpinningWhirl, whirls
from reference_model.systems import DiscOnDisc, FloatArray

CIRCLES: tuple[tuple[float, int], ...] = ((3e-4, 0), (3e-4, 1), (5e-4, 0), (1e-3, 0), (2e-3, 0), (0.2, 0))
"""μN in N, and which of the whirls without offset, the largest first: the second one is unstable."""

ORDERS = slice(2, 5)
"""Those among them whose load doubles, far from the fold."""

REST_LOADS = (0.01, 0.05, 0.09)
ORBITS = ((0.0015, 0), (0.0015, 1), (0.02, 0), (0.2, 0))
"""μN in N, and which of the whirls with the offset, the outer one first."""

OFFSETS = (0.2, 0.1, 0.05)
OFFSET_LOAD = 0.02
"""X0 in m, and μN in N of the whirls that show how they depend on it."""

STICK_LOADS = (0.12, 0.2)
INSIDE = 0.98
OUTSIDE = (1.02, 1.5)
"""Loads in N and radii, in units of (9), of discs that stick at the start."""

LATEST = 1.1
"""How long a disc outside is watched, in units of the time that (7) predicts."""

DECAY = (0.02, 60.0)
GROWTHS = ((0.01, 100.0), (0.05, 100.0), (0.09, 60.0))
"""μN in N, and how long deviations from the whirl, and from the equilibrium, are followed in s."""

DISPLACED = 1e-4
"""Of a deviation at its start, in units of the distance from the axis."""

SHOOTING = 1e-10
TIGHTEST = 1e-12
"""Tolerance of periodic motions, and of those of the reference that they are compared with."""

TOLERANCE = 3e-8
"""Of motions that stick: moderate, since a regularised law costs the more the closer it comes to Coulomb's."""

CIRCLE = "Without offset the whirl has radius, frequency and spin of the three balances, stable or not"
BY_23 = "(23) has the whirl's radius right but for an error like load⁻⁴, its spin but for one like load⁻²"
LARGE = (
    "Like load⁻² the radius tends to the pin's μN/(βk), the spin to a limit that does not depend on the load"
)
SIX_CIRCLE = "On six points the whirl without offset, in the mean, is that of exact Coulomb friction"
ORBIT = "With the offset the whirls, stable or not, are the periodic orbits of exact Coulomb friction"
SHIFTED = "The offset shifts the centre of the whirl by the first-order response, with an error like X0³"
SHRUNK = "The offset changes radius and spin of the whirl like X0²"
RESTS = "The self-centred disc rests and spins by the balance of forces and moments, stable or not"
SIX_RESTS = (
    "On six points the self-centred disc, in the mean, rests and spins as exact Coulomb friction has it"
)
GROWS = "Small deviations from the equilibrium decay at a small load and grow at larger ones, as its eigenvalues say"
DECAYS = "A disc beside the whirl comes to it with the rate of its slowest eigenvalue"
STAYS = "A disc stuck at 0.98 of the radius (9) turns with the master disc for ever"
LETS_GO = "A disc stuck at 1.02 and at 1.5 of the radius (9) is let go at the time of (7)"
SIX_LETS_GO = "A disc stuck on six points further out slips away as exact Coulomb friction has it"
COEXIST = "Sticking and a whirl that never sticks exist for the same parameters"


def on_six(disc: DiscOnDisc) -> DiscOnDisc:
    """Return ``disc`` on six points, as the paper simulated it."""
    return replace(disc, contact_points=6)


def measure(
    engine: Engine,
    orbits: Sequence[tuple[float, int]] = ORBITS,
    rest_loads: Sequence[float] = REST_LOADS,
    stick_loads: Sequence[float] = STICK_LOADS,
) -> Findings:
    """Find the steady motions at the given loads in N; of whirls, the number among those of the load too."""
    claims: list[Claim] = []
    data: Data = {
        "circle load": np.array([load for load, _ in CIRCLES]),
        "orbit load": np.array([load for load, _ in orbits]),
        "rest load": np.array(rest_loads),
        "stick load": np.array(stick_loads),
    }
    if engine.simulates(RING):
        found, error = measured_circles(engine, CENTRED)
        data["circle"] = found
        claims += [
            circle_claim(engine, found, error),
            *order_claims(engine, found[ORDERS], error[ORDERS]),
        ]
        orbit = orbit_claim(engine, orbits)
        data["orbit"] = orbit.measured
        claims += [orbit, *offset_claims(engine)]
        rest, error = measured_rests(engine, RING, rest_loads)
        data["rest"] = rest
        claims += [rest_claim(engine, rest_loads, rest, error), growth_claim(engine), decay_claim(engine)]
        stays, data["stuck"] = stays_claim(engine, stick_loads)
        claims += [stays, release_claim(engine, stick_loads), coexistence_claim(engine)]
    if engine.simulates(on_six(RING)):
        found, error = measured_circles(engine, on_six(CENTRED))
        data["six circle"] = found
        claims.append(six_circle_claim(engine, found, error))
        rest, error = measured_rests(engine, on_six(RING), rest_loads)
        data["six rest"] = rest
        claims.append(six_rest_claim(engine, rest_loads, rest, error))
        claims.append(six_release_claim(engine, stick_loads))
    return Findings(tuple(claims), data, not_simulated=engine.lacking([RING, on_six(RING)]))


# ---------------------------------------------------------------- whirls without offset: circles


def circle_of(load: float, which: int) -> SpinningWhirl:
    """Return a whirl of the ring without offset at μN = ``load`` in N, number ``which`` by falling size."""
    return whirls(with_load(CENTRED, load))[which]


def measured_circles(engine: Engine, disc: DiscOnDisc) -> tuple[FloatArray, FloatArray]:
    """Return mean radius, frequency and spin in units of μN/(βk), k and ω, shape (n, 3), and their error (n, 1)."""
    measured, error = refined(
        lambda tolerance: [_circle(engine, disc, *one, tolerance) for one in CIRCLES], SHOOTING
    )
    return measured, with_tolerance(error, [sharpness(disc, circle_of(*one)) for one in CIRCLES])


def with_tolerance(error: FloatArray, amplified: ArrayLike) -> FloatArray:
    """Return errors (n, 1) of motions found by shooting, from the changes (n, m) at a smaller tolerance.

    One number alone may be right by chance, and two flows may be the same to within the tolerance, which the motion
    shows ``amplified``.
    """
    return np.asarray(np.max(error, axis=1, keepdims=True) + SHOOTING * np.asarray(amplified)[:, np.newaxis])


def _circle(engine: Engine, disc: DiscOnDisc, load: float, which: int, tolerance: float) -> FloatArray:
    motion = steady_motion(engine, with_load(disc, load), circle_of(load, which).state, tolerance)
    if motion is None:
        return np.full(3, np.nan)
    return np.array(
        [
            float(np.hypot(*motion.mean)) / radius_of_pin(load),
            motion.frequency / disc.natural_frequency,
            motion.spin / disc.disc_speed,
        ]
    )


def circle_claim(engine: Engine, measured: FloatArray, error: FloatArray) -> Claim:
    """Compare the circles that come back with the three balances."""
    exact = [circle_of(*one) for one in CIRCLES]
    predicted = [
        (one.radius / radius_of_pin(load), one.frequency / RING.natural_frequency, one.spin / RING.disc_speed)
        for (load, _), one in zip(CIRCLES, exact, strict=True)
    ]
    return Claim(
        CIRCLE,
        equation="(19), (20)",
        engine=engine.name,
        predicted=predicted,
        measured=measured,
        budget=ErrorBudget(np.repeat(error, 3, axis=1), resolution=1e-6),
        parameters=parameters_of(CENTRED, without=("friction_force",)),
        source=SOURCE + "; X0 = 0 here",
        note=f"In units of μN/(βk), k and ω, for {at_each('μN', [load for load, _ in CIRCLES])} N, the second of the "
        "two at the same load is unstable. Measured: the state that the engine itself brings back, turned about the "
        "axis. Predicted: radial, tangential and torsional balance on the continuous ring.",
        basis="reference",
    )


def six_circle_claim(engine: Engine, measured: FloatArray, error: FloatArray) -> Claim:
    """Compare the whirls on six points with those of the reference."""
    predicted = np.array([_six_circle_of_reference(*one) for one in CIRCLES])
    beside = np.abs(predicted[:, 0] - [circle_of(*one).radius / radius_of_pin(one[0]) for one in CIRCLES])
    return Claim(
        SIX_CIRCLE,
        equation="(19)–(21)",
        kind="trajectory",
        engine=engine.name,
        predicted=predicted,
        measured=measured,
        budget=ErrorBudget(np.repeat(error, 3, axis=1), resolution=1e-6),
        parameters=parameters_of(on_six(CENTRED), without=("friction_force",)),
        source=SOURCE + "; X0 = 0 here",
        note=f"In units of μN/(βk), k and ω, for {at_each('μN', [load for load, _ in CIRCLES])} N; means over the "
        f"motion that comes back turned. Predicted by the reference at tolerance {TIGHTEST:g}. In radius it differs "
        f"from that on the ring by {np.max(beside):.1g} near the fold, and by less than 1e-9 from 0.001 N on: slip "
        "is along the circle then, at all points.",
    )


@functools.cache
def _six_circle_of_reference(load: float, which: int) -> tuple[float, ...]:
    return tuple(_circle(Engine("reference", simulate, ("points",)), on_six(CENTRED), load, which, TIGHTEST))


def order_claims(engine: Engine, measured: FloatArray, error: FloatArray) -> tuple[Claim, Claim]:
    """Return how the whirl differs from that of (23), and from its limit, at loads each twice the one before."""
    loads = [load for load, _ in CIRCLES[ORDERS]]
    approximate = [whirls(with_load(CENTRED, load), PAPER_LAW)[0] for load in loads]
    speed = RING.disc_speed
    by_23 = [
        (one.radius / radius_of_pin(load), one.spin / speed)
        for load, one in zip(loads, approximate, strict=True)
    ]
    limit = [(1.0, spin_of_large_whirl(RING) / speed)] * len(loads)
    claims = []
    for sentence, other, orders in ((BY_23, by_23, (-4.0, -2.0)), (LARGE, limit, (-2.0, -2.0))):
        gaps = np.abs(measured[:, [0, 2]] - other)
        observed, numerical, model = extrapolated(gaps, error)
        claims.append(
            Claim(
                sentence,
                equation="(23)" if sentence == BY_23 else "(11)",
                kind="order",
                engine=engine.name,
                predicted=orders,
                measured=-observed,
                budget=ErrorBudget(numerical, model=model, resolution=0.1),
                parameters=parameters_of(CENTRED, without=("friction_force",)),
                source=SOURCE + "; X0 = 0 here",
                note=f"Orders of the distance in radius and spin, for {at_each('μN', loads)} N, extrapolated; model "
                "error: the extrapolation's own step. The limit of the spin, ω − b(ω − Ω)/(b + R²βk/(2(ω − k))) = "
                f"{spin_of_large_whirl(RING):.6f} rad/s, follows from F = 1 and M = RW/(2U).",
                implied_by=CIRCLE,
            )
        )
    return claims[0], claims[1]


def extrapolated(gaps: FloatArray, error: FloatArray) -> tuple[FloatArray, FloatArray, float]:
    """Return the order of ``gaps``, shape (3, m), at a halved variable, its numerical and its model error.

    They are series in every other power, so that the order observed between neighbours tends to its limit like the
    square of the variable. ``error`` is that of the gaps, of shape (3, 1).
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        orders = np.log2(gaps[:-1] / gaps[1:])
        noise = np.nan_to_num(error / gaps, nan=math.inf)
    step = (orders[1] - orders[0]) / 3.0
    numerical = np.asarray(5.0 / 3.0 * (noise[1] + noise[2]) / math.log(2.0))
    return orders[1] + step, numerical, float(np.nan_to_num(np.max(np.abs(step))))


# ---------------------------------------------------------------- whirls with offset: periodic orbits


@functools.cache
def orbit_of_reference(load: float, which: int, offset: float = RING.offset) -> Orbit:
    """Return the reference's whirl with an offset, the outer one or the inner, unstable one."""
    disc = with_load(replace(RING, offset=offset), load)
    return whirl_orbit(disc, guess=inner_orbit(disc) if which else None, tolerance=TIGHTEST, samples=64)


def orbit_of(engine: Engine, load: float, which: int, tolerance: float, offset: float = RING.offset) -> Orbit:
    """Return the same whirl as the engine has it."""
    guess = orbit_of_reference(load, which, offset)
    return whirl_orbit(guess.system, simulate=engine.simulate, guess=guess, tolerance=tolerance, samples=64)


def sizes_of(orbit: Orbit) -> FloatArray:
    """Return period, least and greatest radius, least, greatest and mean spin, in s, m and rad/s."""
    spin = orbit.trajectory.states[:-1, -1]
    return np.array([orbit.period, *extent(orbit), np.min(spin), np.max(spin), np.mean(spin)])


def orbit_claim(engine: Engine, orbits: Sequence[tuple[float, int]]) -> Claim:
    """Compare the engine's periodic orbits with those of the reference."""
    measured, error = refined(
        lambda tolerance: [sizes_of(orbit_of(engine, *one, tolerance)) for one in orbits], SHOOTING
    )
    predicted = np.array([sizes_of(orbit_of_reference(*one)) for one in orbits])
    # The multiplier of a shift in time is 1; the one next to it tells by how much an error of the flow is amplified.
    distances = [sorted(abs(1.0 - value) for value in orbit_of_reference(*one).multipliers) for one in orbits]
    error = with_tolerance(error, predicted[:, 2] / np.array(distances)[:, 1])
    return Claim(
        ORBIT,
        equation="(19), (20)",
        kind="trajectory",
        engine=engine.name,
        predicted=predicted,
        measured=measured,
        budget=ErrorBudget(np.repeat(error, predicted.shape[1], axis=1), resolution=1e-6),
        parameters=parameters_of(RING, without=("friction_force",)),
        source=SOURCE,
        unit="s, m, rad/s",
        note="Period, least and greatest radius, least, greatest and mean spin, for "
        f"{at_each('μN', [load for load, _ in orbits])} N, the second of the two at the same load is the unstable "
        f"one. Found by shooting with the engine; predicted: the reference at tolerance {TIGHTEST:g}.",
    )


def offset_claims(engine: Engine) -> tuple[Claim, Claim]:
    """Return how the shift of the whirl, its radius and its spin depend on the offset."""

    def parts(tolerance: float) -> FloatArray:
        orbits = [orbit_of(engine, OFFSET_LOAD, 0, tolerance, offset) for offset in OFFSETS]
        return np.array([(*orbit.mean, *circle_in(orbit)) for orbit in orbits])

    measured, error = refined(parts, SHOOTING, alike=False)
    circle = circle_of(OFFSET_LOAD, 0)
    response = [first_order_shift(with_load(replace(RING, offset=offset), OFFSET_LOAD)) for offset in OFFSETS]
    shift = np.abs(measured[:, 0] + 1j * measured[:, 1] - response)[:, np.newaxis]
    change = np.abs(measured[:, 2:] - [circle.radius, circle.spin])
    claims = []
    for sentence, order, gaps, noise in (
        (SHIFTED, 3.0, shift, np.hypot(error[:, 0], error[:, 1])[:, np.newaxis]),
        (SHRUNK, 2.0, change, error[:, 2:]),
    ):
        observed, numerical, model = extrapolated(gaps, noise)
        claims.append(
            Claim(
                sentence,
                equation="(18)" if sentence == SHIFTED else "",
                kind="order",
                engine=engine.name,
                predicted=np.full(len(observed), order),
                measured=observed,
                budget=ErrorBudget(numerical, model=model, resolution=0.05),
                parameters=parameters_of(with_load(RING, OFFSET_LOAD), without=("offset",)),
                source=SOURCE,
                note=f"Orders for {at_each('X0', OFFSETS)} m, extrapolated; model error: the extrapolation's own "
                "step. Not in the paper, whose (18) is for the pin: here it is the linear response of the circle to "
                "the offset, which turns backwards in the axes that turn with it."
                if sentence == SHIFTED
                else f"Orders of the change of the first harmonic's amplitude, and of the mean spin, for "
                f"{at_each('X0', OFFSETS)} m, extrapolated; model error: the extrapolation's own step. At X0 = "
                f"{OFFSETS[1]:g} m they change by {measured[1, 2] / circle.radius - 1.0:.2g} of themselves and "
                f"{measured[1, 3] - circle.spin:.2g} rad/s.",
                basis="reference",
            )
        )
    return claims[0], claims[1]


def circle_in(orbit: Orbit) -> tuple[float, float]:
    """Return the amplitude of the first harmonic of x + iy in m, and the mean spin in rad/s."""
    states = orbit.trajectory.states[:-1]
    harmonics = np.fft.fft(states[:, 0] + 1j * states[:, 1]) / len(states)
    return float(np.abs(harmonics[1])), float(np.mean(states[:, -1]))


# ---------------------------------------------------------------- self-centred equilibria


def rest_of(load: float) -> SpinningEquilibrium:
    """Return the self-centred equilibrium of the ring at μN = ``load`` in N."""
    return equilibrium_of(with_load(RING, load))


def measured_rests(engine: Engine, disc: DiscOnDisc, loads: Sequence[float]) -> tuple[FloatArray, FloatArray]:
    """Return the means of x, y and spin in units of X0 and ω, shape (n, 3), and their error (n, 1)."""
    measured, error = refined(
        lambda tolerance: [_rest(engine, disc, load, tolerance) for load in loads], SHOOTING
    )
    return measured, with_tolerance(error, [sharpness(disc, rest_of(load)) for load in loads])


def _rest(engine: Engine, disc: DiscOnDisc, load: float, tolerance: float) -> FloatArray:
    motion = steady_motion(engine, with_load(disc, load), rest_of(load).state, tolerance)
    if motion is None:
        return np.full(3, np.nan)
    return np.array([*motion.mean / disc.offset, motion.spin / disc.disc_speed])


def rest_claim(engine: Engine, loads: Sequence[float], measured: FloatArray, error: FloatArray) -> Claim:
    """Compare the equilibria with the balance of forces and moments."""
    exact = [rest_of(load) for load in loads]
    return Claim(
        RESTS,
        equation="(19), (20)",
        engine=engine.name,
        predicted=[(one.x / RING.offset, one.y / RING.offset, one.spin / RING.disc_speed) for one in exact],
        measured=measured,
        budget=ErrorBudget(np.repeat(error, 3, axis=1), resolution=1e-7),
        parameters=parameters_of(RING, without=("friction_force",)),
        source=SOURCE,
        note=f"x, y and spin in units of X0 and ω, for {at_each('μN', loads)} N. Measured: the state that the engine "
        "itself brings back.",
        basis="reference",
    )


def six_rest_claim(engine: Engine, loads: Sequence[float], measured: FloatArray, error: FloatArray) -> Claim:
    """Compare the motions about the equilibrium on six points with those of the reference."""
    return Claim(
        SIX_RESTS,
        equation="(19)–(21)",
        kind="trajectory",
        engine=engine.name,
        predicted=[_six_rest_of_reference(load) for load in loads],
        measured=measured,
        budget=ErrorBudget(np.repeat(error, 3, axis=1), resolution=1e-7),
        parameters=parameters_of(on_six(RING), without=("friction_force",)),
        source=SOURCE,
        note=f"Means of x, y and spin in units of X0 and ω over the motion that comes back after a sixth of a turn, "
        f"for {at_each('μN', loads)} N. Predicted by the reference at tolerance {TIGHTEST:g}.",
    )


@functools.cache
def _six_rest_of_reference(load: float) -> tuple[float, ...]:
    return tuple(_rest(Engine("reference", simulate, ("points",)), on_six(RING), load, TIGHTEST))


# ---------------------------------------------------------------- simulations from beside a motion


def growth_claim(engine: Engine) -> Claim:
    """Compare the growth of deviations from the equilibrium with its slowest eigenvalue."""
    motions = [(with_load(RING, load), rest_of(load), duration) for load, duration in GROWTHS]
    displacements = [DISPLACED * RING.offset * np.eye(6)[0]] * len(motions)
    return _growth_claim(
        engine,
        GROWS,
        motions,
        displacements,
        "Not in the paper, which has this equilibrium stable at every speed: that of the pin is. The friction of a "
        "ring grows with its slip, which on a master disc faster than k drives the disc around more than β damps it.",
    )


def decay_claim(engine: Engine) -> Claim:
    """Compare the decay of a deviation from the whirl with its slowest eigenvalue."""
    load, duration = DECAY
    circle = circle_of(load, 0)
    larger = DISPLACED * np.array([1.0, 0.0, 0.0, 0.0, 1.0, 0.0]) * circle.state
    return _growth_claim(
        engine, DECAYS, [(with_load(CENTRED, load), circle, duration)], [larger], "X0 = 0 here."
    )


def _growth_claim(
    engine: Engine,
    sentence: str,
    motions: Sequence[tuple[DiscOnDisc, SpinningEquilibrium | SpinningWhirl, float]],
    displacements: Sequence[FloatArray],
    remark: str,
) -> Claim:
    def rates(tolerance: float, scale: float = 1.0) -> FloatArray:
        return real_and_imaginary(
            [
                mode_growth(engine, *motion[:2], scale * displacement, motion[2], tolerance)
                for motion, displacement in zip(motions, displacements, strict=True)
            ]
        )

    measured, error = refined(rates, SHOOTING)
    # Two flows may be the same to within the tolerance: an error of the deviation of that size.
    unseen = [[SHOOTING / (DISPLACED * duration)] for _, _, duration in motions]
    error = np.max(error + np.abs(rates(SHOOTING, 2.0) - measured), axis=1, keepdims=True) + unseen
    loads = [disc.friction_force for disc, _, _ in motions]
    predicted = [motion.eigenvalues[isinstance(motion, SpinningWhirl)] for _, motion, _ in motions]
    return Claim(
        sentence,
        equation="(19), (20)",
        engine=engine.name,
        predicted=real_and_imaginary(predicted),
        measured=measured,
        budget=ErrorBudget(np.repeat(error, 2, axis=1), resolution=1e-6),
        parameters=parameters_of(motions[0][0], without=("friction_force",)),
        source=SOURCE,
        unit="1/s",
        note=f"Real and imaginary part, for {at_each('μN', loads)} N, over "
        f"{', '.join(f'{duration:g}' for _, _, duration in motions)} s. {remark} Half the difference of two "
        f"simulations that start {DISPLACED:g} of the way from the axis to either side. Error: the change at a "
        "smaller tolerance, and with twice the deviation, which is three times what is not linear.",
        basis="reference",
    )


# ---------------------------------------------------------------- sticking


def stuck_at(disc: DiscOnDisc, share: float) -> tuple[FloatArray, float]:
    """Return the state of a disc that sticks at ``share`` of the radius (9), and when (7) lets go, in s."""
    pin = held_pin(replace(disc, contact_points=None))
    radius, angle = share * sticking_radius(pin), safest_angle(pin)
    state = np.insert(np.append(stuck(pin, radius, angle), disc.disc_speed), 2, 0.0)
    return state, release_time(pin, radius, angle) if share > 1.0 else math.inf


def stays_claim(engine: Engine, loads: Sequence[float]) -> tuple[Claim, FloatArray]:
    """Follow discs that stick inside the radius (9) for a revolution; return radius in m and spin in rad/s too."""
    revolution = 2.0 * math.pi / RING.disc_speed
    slips: dict[float, float] = {}
    found = np.empty((len(loads), 2))

    def departure(tolerance: float) -> FloatArray:
        slips[tolerance] = 0.0
        rows = []
        for i, load in enumerate(loads):
            start, _ = stuck_at(with_load(RING, load), INSIDE)
            run = engine.simulate(with_load(RING, load), start, [0.0, revolution], tolerance=tolerance)
            slips[tolerance] += sum(phase.kind != "stick" for phase in run.phases)
            away = rotated(run.at_end, -2.0 * math.pi) - start
            size = float(np.hypot(*start[:2]))
            rows.append((*away[:3] / (size, size, 1.0), away[-1] / RING.disc_speed))
            found[i] = run.radius[-1], run.at_end[-1]
        return np.array(rows)

    measured, error = refined(departure, TOLERANCE)
    # Departures of zero have no scale of their own for rounding.
    change = abs(slips[TOLERANCE / COARSENING] - slips[TOLERANCE])
    budget = np.append(np.max(error) + ROUNDING + np.zeros(measured.size), change)
    claim = Claim(
        STAYS,
        equation="(9)",
        engine=engine.name,
        predicted=np.zeros(measured.size + 1),
        measured=np.append(measured.ravel(), slips[TOLERANCE]),
        budget=ErrorBudget(budget, resolution=1e-2),
        parameters=parameters_of(RING, without=("friction_force",)),
        source=SOURCE,
        note=f"After a revolution, for {at_each('μN', loads)} N: displacement on the master disc in units of the "
        "radius, turn against it in rad, spin against it in units of ω; and the number of phases that do not stick. "
        "What holds the disc has the period of a revolution. In (9) stands the force that friction can give beside "
        "the moment b(ω − Ω). Error: the change at a smaller tolerance, by which a law that only approximates stick "
        "shows its creep.",
        basis="reference",
    )
    return claim, found


def release_claim(engine: Engine, loads: Sequence[float]) -> Claim:
    """Compare when discs outside of the radius (9) are let go with (7)."""
    cases = [(with_load(RING, load), share) for load in loads for share in OUTSIDE]

    def turns(tolerance: float) -> list[float]:
        found = []
        for disc, share in cases:
            start, release = stuck_at(disc, share)
            run = engine.simulate(disc, start, [0.0, LATEST * release], tolerance=tolerance)
            found.append(disc.disc_speed * first_release(run))
        return found

    measured, error = refined(turns, TOLERANCE)
    return Claim(
        LETS_GO,
        equation="(7)",
        engine=engine.name,
        predicted=[disc.disc_speed * stuck_at(disc, share)[1] for disc, share in cases],
        measured=measured,
        budget=ErrorBudget(float(np.max(error)) + ROUNDING, resolution=1e-2),
        parameters=parameters_of(RING, without=("friction_force",)),
        source=SOURCE,
        unit="rad",
        note="Turn of the master disc until the end of the first stick phase, after a start where the least force "
        f"holds the disc, at 1.02 and 1.5 of the radius (9) for {at_each('μN', loads)} N each. In (7) stands the "
        "force that friction can give beside the moment b(ω − Ω).",
        basis="reference",
    )


def six_release_claim(engine: Engine, loads: Sequence[float]) -> Claim:
    """Compare how far discs outside of the radius (9) have slipped on six points with the reference."""
    measured, error = refined(
        lambda tolerance: [_slipped(engine, load, tolerance) for load in loads], TOLERANCE
    )
    return Claim(
        SIX_LETS_GO,
        equation="(7)",
        kind="trajectory",
        engine=engine.name,
        predicted=[_slipped_in_reference(load) for load in loads],
        measured=measured,
        budget=ErrorBudget(np.max(error, axis=1, keepdims=True) * np.ones(3), resolution=2e-3),
        parameters=parameters_of(on_six(RING), without=("friction_force",)),
        source=SOURCE,
        note="Displacement on the master disc in units of the radius, in x and y, and spin less ω in units of ω, for "
        f"{at_each('μN', loads)} N, half as long again after the start as (7) has it for the continuous ring; at "
        f"{OUTSIDE[-1]:g} of the radius (9). By then the disc has slipped by "
        f"{', '.join(f'{math.hypot(*_slipped_in_reference(load)[:2]):.2g}' for load in loads)} of the radius. "
        f"Predicted by the reference at tolerance {TIGHTEST:g}.",
    )


def _slipped(engine: Engine, load: float, tolerance: float) -> FloatArray:
    disc = on_six(with_load(RING, load))
    start, release = stuck_at(disc, OUTSIDE[-1])
    end = 1.5 * release
    run = engine.simulate(disc, start, [0.0, end], tolerance=tolerance)
    away = rotated(run.at_end, -disc.disc_speed * end) - start
    return np.array([*away[:2] / np.hypot(*start[:2]), away[-1] / disc.disc_speed])


@functools.cache
def _slipped_in_reference(load: float) -> tuple[float, ...]:
    return tuple(_slipped(Engine("reference", simulate, ("points",)), load, TIGHTEST))


def coexistence_claim(engine: Engine) -> Claim:
    """See whether for the largest load a disc sticks for a revolution and whirls without sticking."""
    load = STICK_LOADS[-1]
    start, _ = stuck_at(with_load(RING, load), 0.5)
    orbit = orbit_of_reference(load, 0)

    def sticks_and_slides(tolerance: float) -> list[bool]:
        turn = [0.0, 2.0 * math.pi / RING.disc_speed]
        stays = engine.simulate(with_load(RING, load), start, turn, tolerance=tolerance)
        whirl = engine.simulate(orbit.system, orbit.state, [0.0, 10.0 * orbit.period], tolerance=tolerance)
        return [
            all(phase.kind == kind for phase in run.phases)
            for run, kind in ((stays, "stick"), (whirl, "slip"))
        ]

    return Claim(
        COEXIST,
        equation="(9), (11)",
        engine=engine.name,
        **holds(*asked(sticks_and_slides, TOLERANCE)),
        parameters=parameters_of(orbit.system),
        source=SOURCE,
        note="Whether a start stuck at half the radius (9) sticks all the time, for a turn, and one on the whirl "
        "slides all the time, for ten.",
    )


STUDY = Study(
    name="fig09",
    title="Steady motions of the disc over the load, and their spin (Figs. 9, 10)",
    section="The friction disc",
    paper="At ω = 1.5 and Ω = 1.25 rad/s a disc whirls, sticks, or rests self-centred, like the pin. Fig. 9 compares "
    "the steady states by (23) with simulations on six points over the load, Fig. 10 their spin, with that of "
    "sticking dashed. The conclusions have the self-centred equilibrium stable, with a basin that shrinks. The "
    "whirl follows from three balances: the radial one gives the frequency k, the tangential one the radius "
    "μN·F/(βk), the torsional one the spin. For a disc the equilibrium is not stable at all loads: friction on a "
    "ring grows with the slip along it, which feeds a circular motion where ω > k, and above a load far below "
    "C·X0 nothing but the whirl is left until sticking begins. The inner, unstable whirl bounds the basin of the "
    "equilibrium and shrinks onto it at that load.",
    by_hand=measure,
    draw=draw,
    theory=theory,
    figures={
        "fig09-radius": "Fig. 9 redrawn over logarithmic axes, and what lies near to the axis. Whirl without offset "
        "by the three balances on the continuous ring, and by (23), with the fold in which it ends; with X0 = 0.1 m "
        "the least and greatest radius of the periodic orbits, followed by the reference through the fold; the "
        "equilibrium; the radius (9) of sticking. Marks: what the engines found as periodic motions of their own, at "
        "0.98 of (9) the discs that stuck.",
        "fig10-spin": "Fig. 10 redrawn, and how the spin of the whirl tends to its limit, which does not depend on "
        "the load: like load⁻² on the ring, by (23) and with the offset too, with other factors.",
        "fig09-offset": "Where the motions end over the offset, which the paper leaves out (dotted: the value taken "
        "here): the load above which friction holds the disc on the axis beside the moment of the shaft, that at "
        "which the equilibrium loses its stability, lowest where centre and rim slip equally fast, ωX0 = R(ω − Ω); "
        "and the fold of the whirl.",
    },
    seconds=5.5,
)
