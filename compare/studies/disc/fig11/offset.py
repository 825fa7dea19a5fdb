"""For which offset the modulated cycle of Fig. 11 exists: between steady whirl and self-centred equilibrium."""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.polynomial import Polynomial
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from compare.claims.answers import asked, holds
from compare.claims.claim import Claim, ErrorBudget
from compare.claims.error_estimates import refined
from compare.claims.linearised_flow import ComplexArray
from compare.claims.paper_parameters import FIG8, FIG11
from compare.claims.parameters import at_each, parameters_of
from compare.claims.study import Findings
from compare.engines import Engine
from compare.studies.toolkit.fig11_motion import SOURCE, START, rates
from reference_model import Orbit, Trajectory, self_centred_equilibria, simulate, whirl_orbit
from reference_model.steady.stability import jacobian_without_angle
from reference_model.systems import ANGLE, DiscOnDisc, FloatArray

TRIED = (0.0072, 0.00725, 0.0073)
"""X0 in m of the whirls between which the critical one is interpolated."""

TOLERANCE = 1e-12

OFFSETS = (0.0, 0.002, 0.004, 0.006, 0.007, 0.009, 0.012, 0.015, 0.018, 0.022, FIG8.offset)
"""X0 in m of the long simulations; the last one is that of the other figures."""

UNTIL = 720.0
"""Their length in s."""

LOOKED_AT = 240.0
"""In s, at their end: a period of the modulation."""

SAMPLES_A_TURN = 16

ENDS_TOLERANCE = 1e-6
"""Of the long simulations."""

SWING = 0.005
"""In rad/s: the least swing of the spin, averaged over a turn, of a modulated motion; a tenth of that at X0 = 0."""

ORBITS_EXTENT = 1e-4
"""In m: the least swing of the radius of a motion that is none of rest."""

BOTH_STABLE = 0.0073
"""X0 in m, a little above the critical one."""

MODULATED_THERE = (0.01608, -0.00617, 0.0, 0.00943, 0.01375, 1.39531)
"""A state near the modulated motion at that offset, found by simulation while X0 was raised in small steps."""

BRANCH = np.array(
    [*np.linspace(0.0, 0.015, 11), 0.016, 0.0166, 0.0175, 0.0185, 0.0192, 0.0196, 0.0198, 0.0199, 0.01993]
)
"""X0 in m of the whirls in the figure: up to the fold at 0.019930 m, which lies beyond :func:`rest_offset`."""

KINDS = ("rest", "whirl", "modulated")

WITHOUT_ANGLE = [i for i in range(FIG11.state_size) if i != ANGLE]

CRITICAL = (
    "The whirl is unstable below a critical X0, where a pair of Floquet multipliers crosses the unit circle"
)
ENDS = (
    "The motion is modulated in the end at small offsets, a steady whirl at larger ones, and at rest beyond"
)
BOTH = "Just above the critical X0 the steady whirl and the modulated motion are both stable"


def disc_at(offset: float) -> DiscOnDisc:
    """Return the disc of Fig. 11 with another X0 in m."""
    return replace(FIG11, offset=offset)


def measure_offsets(engine: Engine, offsets: Sequence[float] = OFFSETS) -> Findings:
    """Measure the critical X0 with ``engine``, and what the motion ends in at ``offsets`` (m)."""
    critical = critical_claim(engine)
    ends, extents = ends_claim(engine, float(critical.predicted), offsets)
    return Findings((critical, ends), {"offsets": np.array(offsets), "extents": extents})


def pair_modulus(multipliers: tuple[complex, ...] | ComplexArray) -> float:
    """Return the modulus of the largest pair of conjugate multipliers; no number if there is none."""
    return max((abs(value) for value in multipliers if value.imag > 0.0), default=math.nan)


def critical_offset(engine: Engine, tolerance: float) -> tuple[float, float, float, Orbit]:
    """Return X0 in m of modulus 1, its error, the slope in 1/m, and the whirl in the middle of ``TRIED``.

    From a parabola through the moduli at ``TRIED``; the error is the change by a straight line through the two that
    are next to it, which is more than a term of third degree makes. Raises ``RuntimeError`` where there is no such
    whirl, or none that is nearly critical.
    """
    orbits: list[Orbit] = []
    for offset in TRIED:
        guess = orbits[-1] if orbits else _whirl_of_reference()
        orbits.append(
            whirl_orbit(
                disc_at(offset),
                simulate=engine.simulate,
                guess=guess,
                tolerance=tolerance,
                samples=SAMPLES_A_TURN,
            )
        )
    middle = TRIED[1]
    tried, moduli = np.subtract(TRIED, middle), [pair_modulus(orbit.multipliers) - 1.0 for orbit in orbits]
    parabola = Polynomial.fit(tried, moduli, 2).convert()
    if not np.all(np.isfinite(parabola.coef)):
        raise RuntimeError(f"a whirl near offset = {middle:g} m has no pair of multipliers")
    # So far from where it was laid a parabola says nothing any more.
    roots = [root.real for root in parabola.roots() if root.imag == 0.0 and abs(root.real) < 0.1 * middle]
    if not roots:
        raise RuntimeError(f"no whirl near offset = {middle:g} m is critical")
    root = float(min(roots, key=abs))
    nearest = np.argsort(abs(tried - root))[:2]
    straight = float(Polynomial.fit(tried[nearest], np.take(moduli, nearest), 1).roots()[0])
    return middle + root, abs(straight - root), float(parabola.deriv()(root)), orbits[1]


@functools.cache
def _whirl_of_reference() -> Orbit:
    """Return where shooting starts: the whirl at the first X0 of ``TRIED``."""
    return whirl_orbit(disc_at(TRIED[0]), tolerance=1e-8, samples=SAMPLES_A_TURN)


def critical_claim(engine: Engine) -> Claim:
    """Return the critical X0 by the multipliers of the engine's own whirl."""
    found = functools.cache(lambda tolerance: critical_offset(engine, tolerance))
    predicted, measured, error = math.nan, np.array(math.nan), np.array(math.nan)
    try:
        measured, error = refined(lambda tolerance: found(tolerance)[0], TOLERANCE)
        _, interpolation, slope, near = found(TOLERANCE)
        exact = multipliers_by_variation(disc_at(float(measured)), near)
        predicted = float(measured) - (pair_modulus(exact) - 1.0) / slope
        error = error + interpolation + _error_of_monodromy(near) / abs(slope)
    except RuntimeError:  # no whirl, or none that could be critical: no numbers
        pass
    return Claim(
        CRITICAL,
        equation="(19)–(21)",
        kind="trajectory",
        engine=engine.name,
        predicted=predicted,
        measured=measured,
        budget=ErrorBudget(np.nan_to_num(error, nan=np.inf), resolution=1e-3 * TRIED[1]),
        parameters=parameters_of(FIG11, without=("offset",)),
        source=SOURCE,
        unit="m",
        note="Measured: whirls with an offset are found by shooting with the engine, for "
        f"{at_each('X0', TRIED)} m, and their multipliers by differences. Predicted: what one step of Newton's "
        "method makes of that X0 with multipliers from the variational equations, integrated with the analytic "
        "Jacobian. Error: the change at a smaller tolerance, that by a straight line for the interpolation, and how "
        "much the linearised return map changes a shift in time.",
        named={"critical offset": 0},
    )


def _error_of_monodromy(orbit: Orbit) -> float:
    """Return about how wrong the linearised return map is: it should leave a shift in time as it is."""
    shift = np.array(rates(disc_at(orbit.system.offset), orbit.state))[WITHOUT_ANGLE]
    change = orbit.monodromy @ shift - shift
    # One direction of as many as there are states.
    return math.sqrt(len(shift)) * float(np.linalg.norm(change) / np.linalg.norm(shift))


def multipliers_by_variation(disc: DiscOnDisc, near: Orbit, tolerance: float = 1e-10) -> ComplexArray:
    """Return the multipliers, shape (5,), of the whirl of ``disc`` next to the orbit ``near``.

    The orbit is found anew, by Newton's method with the exact derivative of the flow: (19) and its linearisation
    are integrated together.
    """

    def equations(_: float, both: FloatArray) -> FloatArray:
        jacobian = jacobian_without_angle(disc, both[:6])
        return np.concatenate((rates(disc, both[:6]), (jacobian @ both[6:].reshape(5, 5)).ravel()))

    state, period = near.state.copy(), near.period
    for _ in range(6):
        start = np.concatenate((state, np.eye(5).ravel()))
        run = solve_ivp(equations, (0.0, period), start, method="DOP853", rtol=tolerance, atol=tolerance)
        end, monodromy = run.y[:6, -1], run.y[6:, -1].reshape(5, 5)
        miss = (end - state)[WITHOUT_ANGLE]
        if float(np.max(np.abs(miss))) < 1e-10:
            return np.asarray(np.linalg.eigvals(monodromy), dtype=complex)
        by_time = np.array(rates(disc, end))[WITHOUT_ANGLE]
        by_start = (monodromy - np.eye(5))[:, [0, 2, 3, 4]]  # y = 0 at the start
        step = np.linalg.solve(np.column_stack((by_start, by_time)), miss)
        state[[0, 3, 4, 5]] -= step[:4]
        period -= step[4]
    raise RuntimeError(f"no whirl at offset = {disc.offset:g} m next to the one at {near.system.offset:g} m")


@functools.cache
def rest_offset() -> float:
    """Return X0 in m at which the self-centred equilibrium becomes stable.

    The whirl goes on beyond, by a quarter of a per cent of X0.
    """

    def rate(offset: float) -> float:
        return self_centred_equilibria(disc_at(offset))[0].eigenvalues[0].real

    return float(brentq(rate, 0.019, 0.022, xtol=1e-12))


def ends_claim(engine: Engine, critical: float, offsets: Sequence[float]) -> tuple[Claim, FloatArray]:
    """Return what the motion ends in, and its least and greatest radius and spin, shape (n, 4).

    ``critical`` is the X0 in m below which it is predicted to be modulated.
    """
    extents: dict[float, list[list[float]]] = {}
    predicted = [2.0 if offset < critical else 1.0 if offset < rest_offset() else 0.0 for offset in offsets]

    def as_predicted(tolerance: float) -> list[bool]:
        ends = [_end(engine, offset, tolerance=tolerance) for offset in offsets]
        extents[tolerance] = [found for found, _ in ends]
        return [kind == expected for (_, kind), expected in zip(ends, predicted, strict=True)]

    answers = holds(*asked(as_predicted, ENDS_TOLERANCE))
    return Claim(
        ENDS,
        equation="(19)–(21)",
        engine=engine.name,
        **answers,
        parameters=parameters_of(FIG11, without=("offset",)),
        source=f"{SOURCE}; start {START}",
        note=f"{', '.join(KINDS[int(kind)] for kind in predicted)} for {at_each('X0', offsets)} m; the last one is "
        f"that of the other figures. From the last {LOOKED_AT:g} of {UNTIL:g} s: the spin, averaged over a turn, "
        f"swings by more than {SWING:g} rad/s, or the radius by more than {ORBITS_EXTENT:g} m. Predicted: from the "
        "critical X0 and from the one at which an eigenvalue of the self-centred equilibrium crosses zero.",
        basis="reference",
    ), np.array(extents[ENDS_TOLERANCE])


@functools.cache
def critical_offset_of_reference() -> float:
    """Return the critical X0 in m, from the reference."""
    return critical_offset(Engine("reference", simulate, ("ring",)), 1e-10)[0]


def _end(
    engine: Engine, offset: float, start: tuple[float, ...] = START, tolerance: float = ENDS_TOLERANCE
) -> tuple[list[float], float]:
    """Return least and greatest radius and spin in the end, and the place of its kind among ``KINDS``."""
    step = 2.0 * math.pi / FIG11.natural_frequency / SAMPLES_A_TURN
    run = engine.simulate(disc_at(offset), start, np.arange(0.0, UNTIL, step), tolerance=tolerance)
    found = _extents(run, round(LOOKED_AT / step))
    averaged = np.convolve(run.states[:, 5], np.full(SAMPLES_A_TURN, 1.0 / SAMPLES_A_TURN), "valid")
    swing = np.ptp(averaged[-round(LOOKED_AT / step) :])
    kind = "modulated" if swing > SWING else "whirl" if found[1] - found[0] > ORBITS_EXTENT else "rest"
    return found, float(KINDS.index(kind))


def _extents(run: Trajectory, last: int = 0) -> list[float]:
    """Return least and greatest radius in m and spin in rad/s, of the ``last`` samples or of all."""
    radius, spin = run.radius[-last:], run.states[-last:, 5]
    return [radius.min(), radius.max(), spin.min(), spin.max()]


def theory_of_offsets() -> Findings:
    """Compute the branches of whirl and equilibrium over X0, and check that they coexist with modulated motions."""
    orbits: list[Orbit] = []
    whirling = np.sort([*BRANCH, critical_offset_of_reference()])
    for offset in whirling:
        guess = orbits[-1].from_the_right() if orbits else None
        orbits.append(whirl_orbit(disc_at(float(offset)), guess=guess, tolerance=1e-9, samples=64))
    resting = np.sort([*np.linspace(0.0005, 0.025, 50), rest_offset()])
    rest = [self_centred_equilibria(disc_at(float(offset)))[0] for offset in resting]
    return Findings(
        (both_claim(),),
        {
            "whirl: offset": whirling,
            "whirl: extents": np.array([_extents(orbit.trajectory) for orbit in orbits]),
            "rest: offset": resting,
            "rest: place": np.array([(math.hypot(state.x, state.y), state.spin) for state in rest]),
            "critical offset": np.array(critical_offset_of_reference()),
            "rest offset": np.array(rest_offset()),
        },
    )


def both_claim() -> Claim:
    """Return that whirl and modulated motion are both stable a little above the critical X0."""
    whirl = whirl_orbit(disc_at(BOTH_STABLE))
    reference = Engine("reference", simulate, ("ring",))

    def modulated(tolerance: float) -> bool:
        _, kind = _end(reference, BOTH_STABLE, MODULATED_THERE, tolerance)
        return KINDS[int(kind)] == "modulated"

    margin, error = asked(modulated, ENDS_TOLERANCE)
    return Claim(
        BOTH,
        equation="(19)–(21)",
        engine="theory",
        **holds(
            (1.0 - pair_modulus(whirl.multipliers), float(margin)),
            (_error_of_monodromy(whirl), float(error)),
        ),
        parameters=parameters_of(disc_at(BOTH_STABLE)),
        source=f"{SOURCE}; start {MODULATED_THERE}",
        note=f"Whether the pair of multipliers lies inside of the unit circle, and whether the spin still "
        f"swings by more than {SWING:g} rad/s after {UNTIL:g} s.",
        basis="reference",
    )
