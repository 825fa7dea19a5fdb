"""The stability map in theory: its curves, what they are checked against, and what they say of Fig. 11."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from compare.claims.answers import holds
from compare.claims.claim import Claim, ErrorBudget
from compare.claims.linearised_flow import ComplexArray, eigenvalues_with_rounding
from compare.claims.paper_parameters import FIG11
from compare.claims.parameters import at_each, parameters_of
from compare.claims.study import Data, Findings
from compare.studies.disc.stability_map.ends import SLOWLY_SETTLED, Start, ends_of
from reference_model.contact.contact_law import IsotropicContact, Ring, ThreeTermRing
from reference_model.formulas.disc import whirl_at
from reference_model.formulas.pin import upper_branch_margin
from reference_model.simulation import simulate
from reference_model.steady.bifurcation_curves import Boundary, Kind, ParameterPlane, boundaries, crossings
from reference_model.steady.lyapunov_coefficient import growth_by_amplitude
from reference_model.steady.stability import (
    equilibrium_eigenvalues,
    onset_load,
    turning_frame_jacobian,
    whirl_eigenvalues,
)
from reference_model.steady.steady_states import whirls
from reference_model.systems import DiscOnDisc, FloatArray, PinOnDisc

DISC = FIG11
K = DISC.natural_frequency
SOURCE = "Fig. 11 with X0 = 0; the ranges of the map are ours"

BOTH_LAWS = "(19), (20), (23)"
"""Equations of what is claimed of the ring and of (23)."""

LAWS: dict[str, IsotropicContact] = {
    "ring": Ring(DISC.contact_radius),
    "(23)": ThreeTermRing(DISC.contact_radius),
}

PLANES = {
    "load": ParameterPlane(DISC, ("disc_speed", "friction_force"), (1.005, 5e-4), (3.0, 0.08)),
    "dampers": ParameterPlane(DISC, ("damping", "shaft_damping"), (0.2, 0.002), (2.0, 0.03)),
    "speeds": ParameterPlane(DISC, ("disc_speed", "shaft_speed"), (1.005, 0.7), (2.2, 2.2)),
    "inertia": ParameterPlane(DISC, ("polar_inertia", "shaft_damping"), (0.05, 0.008), (4.0, 0.024)),
}

KINDS: tuple[Kind, ...] = ("onset", "Hopf", "fold")

FINE = 0.04
"""Largest distance between the points of a curve, in units of the ranges."""

FAR_FROM_KINK = 0.02
"""Of |U/W − 1|: nearer to where a point of the ring rests, the expansion about the whirl says nothing."""

ONSET_SPEEDS = (1.05, 1.2, 1.4, 1.5, 2.0, 3.0)
"""ω in rad/s at which the onset is found by its eigenvalues."""

NEAR = 1e-3
"""Relative distance from a border at which stability is that of either side."""

STATE_ROUNDING = 4.0 * np.finfo(float).eps
"""Relative, of the spin of a whirl that is given by its α."""

UNSTABLE_LOADS = (0.3, 0.7)
"""Loads between the fold and the Hopf point of (23), as fractions."""

BESIDE_LARGEST = ((1.1, 1.0, 1.0, 1.0, 1.1, 1.0), (1.5, 1.0, 1.0, 1.0, 1.5, 1.0))
"""Factors on the state of the larger whirl there."""

MARGINAL = "At every point of the Hopf curves a pair of eigenvalues of the whirl is imaginary"
BORDER = "Beside the Hopf curves no other eigenvalue of the whirl grows: they are borders of its stability"
FOLDS = "At every point of the fold curves an eigenvalue of the whirl is zero"
TRACED = "The traced curves cross the line of Fig. 11 where a search along it finds the boundary"
ONSET = "The centred rotation loses its stability at the closed form of the onset"
REMEDIES = "The disc of Fig. 11 has no whirl where one parameter takes it below the closed form of the onset"
BY_WHIRLS = "Along the line of Fig. 11 whirls gain and lose their stability where the map says"
HARD = "On the continuous ring the whirl always loses its stability with a jump: the cycle at the border is unstable"
FIG11_RING = "At the parameters of Fig. 11 the whirl on the continuous ring is unstable"
FIG11_THREE = (
    "At the parameters of Fig. 11 the whirl of (23) is stable: (23) does not have the instability there"
)
PIN_STABLE = "A pin has no such border: its whirl is stable for all damping wherever ω > k"
COLLAPSE = (
    "Where the whirl of (23) is unstable at the speeds of Fig. 11, motions end as rotation, not in a cycle"
)


def at(**changes: Any) -> DiscOnDisc:
    """Return the disc of Fig. 11 with some other parameters."""
    return replace(DISC, **changes)


def theory() -> Findings:
    """Trace the boundaries, check them, and compute what the figures show."""
    traced = {
        (plane, law, kind): boundaries(PLANES[plane], kind, LAWS[law], step=FINE)
        for plane in PLANES
        for law in LAWS
        for kind in KINDS
    }
    data: Data = {}
    for (plane, law, kind), curves in traced.items():
        for i, curve in enumerate(curves):
            data[f"{plane}/{law}/{kind}/{i}"] = np.column_stack((curve.parameters, curve.alpha))
    hard, hard_claim = hardness(traced)
    return Findings(
        (
            *marginal_claims(traced),
            traced_claim(traced),
            onset_claim(),
            remedies_claim(),
            by_whirls_claim(),
            hard_claim,
            *fig11_claims(),
            pin_claim(),
            collapse_claim(),
        ),
        data | hard | section(),
    )


def state_at(disc: DiscOnDisc, alpha: float, law: IsotropicContact) -> FloatArray:
    """Return the state of the whirl with tan α = R|ω − φ̇|/U, shape (6,)."""
    _, radius, spin = whirl_at(disc, alpha, law)
    return np.array([radius, 0.0, 0.0, 0.0, K * radius, spin])


def points_of(
    traced: dict[tuple[str, str, Kind], tuple[Boundary, ...]], kind: Kind
) -> Iterator[tuple[str, DiscOnDisc, float]]:
    """Yield law, disc and α for every point of the curves of a kind."""
    for (plane, law, found), curves in traced.items():
        for curve in curves if found == kind else ():
            for values, alpha in zip(curve.parameters, curve.alpha.tolist(), strict=True):
                yield law, PLANES[plane].at(values), alpha


def critical_eigenvalues(
    disc: DiscOnDisc, state: FloatArray, law: IsotropicContact
) -> tuple[ComplexArray, float]:
    """Return the eigenvalues of a whirl but for the phase, the critical ones first, and the rounding of those in 1/s.

    That is the rounding of the matrix, by the condition of the eigenvalue, and that of the state: where U and W are
    nearly the same, the slopes of friction depend on what little differs.
    """
    neighbour = state * (1.0 + STATE_ROUNDING * (np.arange(6) == 5))
    values, shifted = (
        np.array(sorted(whirl_eigenvalues(disc, which, law)[1:], key=lambda value: abs(value.real)))
        for which in (state, neighbour)
    )
    found, rounding = eigenvalues_with_rounding(turning_frame_jacobian(disc, state, law))
    error = rounding[np.argmin(np.abs(found - values[0]))]
    return values, float(error + np.min(np.abs(shifted - values[0])))


def marginal_claims(traced: dict[tuple[str, str, Kind], tuple[Boundary, ...]]) -> tuple[Claim, ...]:
    """Return how far from the imaginary axis, and from zero, the eigenvalues on the curves are."""
    real, errors, others, roundings = [], [], [], []
    for law, disc, alpha in points_of(traced, "Hopf"):
        values, error = critical_eigenvalues(disc, state_at(disc, alpha, LAWS[law]), LAWS[law])
        frequency = abs(values[0].imag)
        real.append(values[0].real / frequency)
        errors.append(error / frequency)
        others += values[2:].real.tolist()
        roundings += [error] * len(values[2:])
    zero, zero_errors = [], []
    for law, disc, alpha in points_of(traced, "fold"):
        values, error = critical_eigenvalues(disc, state_at(disc, alpha, LAWS[law]), LAWS[law])
        nearest = values[np.argmin(np.abs(values))]
        zero.append(abs(nearest) / K)
        zero_errors.append(error / K)
    where = ", ".join(f"({a}, {b})" for a, b in (plane.names for plane in PLANES.values()))
    note = f"Curves of the continuous ring and of (23) in the planes {where}."
    common: dict[str, Any] = {"engine": "theory", "parameters": parameters_of(DISC), "source": SOURCE}
    return (
        Claim(
            MARGINAL,
            equation=BOTH_LAWS,
            predicted=np.zeros(len(real)),
            measured=real,
            budget=ErrorBudget(errors, resolution=1e-10),
            note="Real part over frequency, by the Jacobian in the frame that turns with the whirl, which takes "
            f"no part in the tracing. {note} Error: rounding, by the condition of the eigenvalues.",
            **common,
        ),
        Claim(
            BORDER,
            equation=BOTH_LAWS,
            **holds(-np.array(others), roundings),
            note=f"Whether the real parts of all other eigenvalues are negative, at {len(real)} points.",
            **common,
        ),
        Claim(
            FOLDS,
            equation=BOTH_LAWS,
            predicted=np.zeros(len(zero)),
            measured=zero,
            budget=ErrorBudget(zero_errors, resolution=1e-8),
            note=f"The least eigenvalue over k. {note} Error: rounding, by the condition of the eigenvalues, "
            "which grows where a second one becomes zero.",
            **common,
        ),
    )


def traced_claim(traced: dict[tuple[str, str, Kind], tuple[Boundary, ...]]) -> Claim:
    """Return where the traced curves cross the line of Fig. 11's speed, beside a search on that line alone."""
    plane, speed = PLANES["load"], DISC.disc_speed
    predicted: list[float] = []
    measured: list[float] = []
    errors: list[float] = []
    for law in LAWS:
        coarse_curves = boundaries(plane, "Hopf", LAWS[law], step=2.0 * FINE)
        fine, coarse = (crossed(curves, speed) for curves in (traced["load", law, "Hopf"], coarse_curves))
        predicted.extend(crossings(plane, "Hopf", "disc_speed", speed, LAWS[law]))
        measured.extend(fine)
        errors.extend(np.abs(fine - coarse))
    return Claim(
        TRACED,
        equation=BOTH_LAWS,
        engine="theory",
        predicted=predicted,
        measured=measured,
        budget=ErrorBudget(errors, resolution=1e-3 * DISC.friction_force),
        parameters=parameters_of(DISC, without=("friction_force",)),
        source=SOURCE,
        unit="N",
        note="Loads of the Hopf curves of the ring and of (23), by a cubic spline through the points of the curves, "
        "and by a zero of Hurwitz' determinant over the ratio U : W. Error: the change with points at twice the "
        "distance.",
    )


def crossed(curves: Sequence[Boundary], value: float) -> FloatArray:
    """Return the second parameter where curves cross a value of the first, in increasing order."""
    found = []
    for curve in curves:
        steps = np.diff(curve.parameters / np.max(np.abs(curve.parameters), axis=0), axis=0)
        along = np.concatenate(([0.0], np.cumsum(np.linalg.norm(steps, axis=1))))
        first, second = (CubicSpline(along, column) for column in curve.parameters.T)
        found.extend(second(first.solve(value, extrapolate=False)))
    return np.sort(found)


def onset_claim() -> Claim:
    """Return the load at which an eigenvalue of the centred rotation becomes imaginary, beside the closed form."""
    predicted, measured, errors = [], [], []
    for law in LAWS.values():
        for speed in ONSET_SPEEDS:
            disc = at(disc_speed=speed)
            sticking = sticking_load(disc)

            def growth(load: float, disc: DiscOnDisc = disc, law: IsotropicContact = law) -> float:
                loaded = replace(disc, friction_force=load)
                return equilibrium_eigenvalues(loaded, rotation(loaded), law)[0].real

            load = brentq(growth, 1e-3 * sticking, (1.0 - 1e-3) * sticking, xtol=1e-15)
            step = 1e-3 * load
            slope = (growth(load + step) - growth(load - step)) / (2.0 * step)
            predicted.append(onset_load(disc, law))
            measured.append(load)
            errors.append(16.0 * np.finfo(float).eps * (K / abs(slope) + load))
    return Claim(
        ONSET,
        equation=BOTH_LAWS,
        engine="theory",
        predicted=predicted,
        measured=measured,
        budget=ErrorBudget(errors, resolution=1e-9 * DISC.friction_force),
        parameters=parameters_of(DISC, without=("friction_force", "disc_speed")),
        source=SOURCE,
        unit="N",
        note=f"By the root of the largest real part over the load, for {at_each('ω', ONSET_SPEEDS)} rad/s, on the "
        "ring and with (23), which have the same onset. Error: rounding of the eigenvalues.",
    )


def growth_of_rotation(disc: DiscOnDisc) -> float:
    """Return the largest real part in 1/s of the eigenvalues of the centred rotation on the ring."""
    return equilibrium_eigenvalues(disc, rotation(disc), LAWS["ring"])[0].real


def remedies_claim() -> Claim:
    """Return which share of each parameter makes the centred rotation stable, beside the closed form of the onset."""
    slip_speed = DISC.disc_speed - DISC.shaft_speed
    ways: dict[str, tuple[Callable[[float], DiscOnDisc], float]] = {
        "load": (lambda share: at(friction_force=share * DISC.friction_force), 0.8),
        "shaft damping": (lambda share: at(shaft_damping=share * DISC.shaft_damping), 1.5),
        "damping of the springs": (lambda share: at(damping=share * DISC.damping), 1.6),
        "slip speed": (lambda share: at(shaft_speed=DISC.disc_speed - share * slip_speed), 1.3),
    }
    predicted: list[float] = []
    measured: list[float] = []
    errors: list[float] = []
    for disc_of, end in ways.values():

        def excess(share: float, disc_of: Callable[[float], DiscOnDisc] = disc_of) -> float:
            return onset_load(disc_of(share)) / disc_of(share).friction_force - 1.0

        def growth(share: float, disc_of: Callable[[float], DiscOnDisc] = disc_of) -> float:
            return growth_of_rotation(disc_of(share))

        predicted.append(brentq(excess, 1.0, end, xtol=1e-15))
        measured.append(brentq(growth, 1.0, end, xtol=1e-15))
        slope = (growth(end) - growth(1.0)) / (end - 1.0)
        errors.append(16.0 * np.finfo(float).eps * (K / abs(slope) + 1.0))
    return Claim(
        REMEDIES,
        equation="(19), (20)",
        engine="theory",
        predicted=predicted,
        measured=measured,
        budget=ErrorBudget(errors, resolution=1e-9),
        parameters=parameters_of(DISC),
        source="Fig. 11 with X0 = 0; one parameter at a time",
        note=f"Over their values of Fig. 11: {', '.join(ways)}, where the last is ω − Ω and ω stays as it is. By the "
        "root of the largest real part. Error: rounding of the eigenvalues.",
        named={f"{name} at the onset": i for i, name in enumerate(ways)},
    )


def sticking_load(disc: DiscOnDisc) -> float:
    """Return b|ω − Ω|/R in N, from which on the centred disc sticks to the master disc for ever."""
    return disc.shaft_damping * abs(disc.disc_speed - disc.shaft_speed) / disc.contact_radius


def rotation(disc: DiscOnDisc) -> FloatArray:
    """Return the state of the centred rotation, shape (6,): the shaft overcomes the friction of the spinning ring."""
    against = disc.disc_speed - disc.shaft_speed
    relative_spin = against - math.copysign(
        disc.friction_force * disc.contact_radius / disc.shaft_damping, against
    )
    return np.array([0.0, 0.0, 0.0, 0.0, 0.0, disc.disc_speed - relative_spin])


def by_whirls_claim() -> Claim:
    """Return where the largest real part of the whirls' eigenvalues changes its sign along each parameter."""
    predicted, measured, errors, sentences = [], [], [], []
    named: dict[str, int | None] = {}
    for law in LAWS:
        for plane in PLANES.values():
            for i, name in enumerate(plane.names):
                fixed = plane.names[1 - i]
                here, at_fig11 = getattr(DISC, name), getattr(DISC, fixed)
                for value in nearest(crossings(plane, "Hopf", fixed, at_fig11, LAWS[law]), here):
                    found, error = change_of_stability(name, value, LAWS[law])
                    predicted.append(value)
                    measured.append(found)
                    errors.append(error)
                    if law == "ring":
                        named[f"{'lower' if value < here else 'upper'} {name}"] = len(measured) - 1
                    sentences.append(f"{law}: {name} {value:.4g} ({100.0 * (value / here - 1.0):+.1f} %)")
    return Claim(
        BY_WHIRLS,
        equation=BOTH_LAWS,
        engine="theory",
        predicted=predicted,
        measured=measured,
        budget=ErrorBudget(errors, resolution=1e-8),
        parameters=parameters_of(DISC),
        source="Fig. 11 with X0 = 0; one parameter at a time",
        note="The borders next to the point of Fig. 11, to either side, and how far away they are: "
        + "; ".join(dict.fromkeys(sentences))
        + ".",
        named=named,
    )


def change_of_stability(name: str, near: float, law: IsotropicContact) -> tuple[float, float]:
    """Return the value of a parameter near which the pair of a whirl crosses the imaginary axis, and its error.

    Not a number where none does.
    """

    def crossing_pair(value: float) -> tuple[float, float]:
        disc = at(**{name: value})
        pairs = (critical_eigenvalues(disc, whirl.state, law) for whirl in whirls(disc, law))
        return min(((values[0].real, error) for values, error in pairs), key=lambda pair: abs(pair[0]))

    low, high = near * (1.0 - NEAR), near * (1.0 + NEAR)
    below, above = crossing_pair(low)[0], crossing_pair(high)[0]
    if below * above > 0.0:
        return math.nan, 0.0
    value = brentq(lambda value: crossing_pair(value)[0], low, high, xtol=1e-15)
    slope = abs(above - below) / (high - low)
    return value, 2.0 * crossing_pair(value)[1] / slope + 4.0 * np.finfo(float).eps * value


def nearest(values: Sequence[float], to: float) -> list[float]:
    """Return the largest of ``values`` below and the smallest above."""
    below, above = [value for value in values if value < to], [value for value in values if value > to]
    return [*below[-1:], *above[:1]]


def hardness(traced: dict[tuple[str, str, Kind], tuple[Boundary, ...]]) -> tuple[Data, Claim]:
    """Return the first Lyapunov coefficient along the Hopf curves, and the claim on the ring."""
    data: Data = {}
    on_ring: list[float] = []
    for (plane, law, kind), curves in traced.items():
        for i, curve in enumerate(curves if kind == "Hopf" else ()):
            growth = np.full(len(curve.alpha), np.nan)
            for j, (values, alpha) in enumerate(zip(curve.parameters, curve.alpha.tolist(), strict=True)):
                if abs(1.0 / math.tan(alpha) - 1.0) > FAR_FROM_KINK:
                    disc = PLANES[plane].at(values)
                    growth[j] = growth_by_amplitude(disc, state_at(disc, alpha, LAWS[law]), LAWS[law])
            data[f"{plane}/{law}/growth/{i}"] = growth
            if law == "ring":
                on_ring += growth[np.isfinite(growth)].tolist()
    return data, Claim(
        HARD,
        equation="(19), (20)",
        engine="theory",
        **holds(on_ring),
        parameters=parameters_of(DISC),
        source=SOURCE,
        note="Whether the growth of the modulation rises with its amplitude, by the third-order terms of (19), at "
        f"each point of the Hopf curves that is farther than {FAR_FROM_KINK:g} from U = W in U : W.",
    )


def fig11_claims() -> tuple[Claim, Claim]:
    """Return on which side of the imaginary axis the whirl of Fig. 11 is, by the ring and by (23)."""
    claims = []
    for sentence, law, equation, sign in (
        (FIG11_RING, "ring", "(19), (20)", 1.0),
        (FIG11_THREE, "(23)", "(19), (23)", -1.0),
    ):
        (whirl,) = whirls(DISC, LAWS[law])
        values, error = critical_eigenvalues(DISC, whirl.state, LAWS[law])
        near = nearest(crossings(PLANES["load"], "Hopf", "disc_speed", DISC.disc_speed, LAWS[law]), np.inf)
        claims.append(
            Claim(
                sentence,
                equation=equation,
                engine="theory",
                **holds(sign * values[0].real, error),
                parameters=parameters_of(DISC),
                source="Fig. 11 with X0 = 0",
                note=f"Sign of the largest real part. Radius {whirl.radius:.5f} m, spin {whirl.spin:.5f} rad/s, "
                f"eigenvalues {values[0].real:+.5f} ± {abs(values[0].imag):.5f}i 1/s. At this speed the whirl of "
                f"this law is unstable up to μN = {near[0]:.5f} N.",
            )
        )
    ring, three_terms = claims
    return ring, three_terms


def pin_claim() -> Claim:
    """Return at how many points (16), the border of the pin's whirl, is violated where the whirl exists."""
    (low, _), (high, _) = PLANES["dampers"].lower, PLANES["dampers"].upper
    speeds = np.linspace(K * (1.0 + 1e-6), PLANES["load"].upper[0], 40)
    pins = [
        PinOnDisc(
            mass=DISC.mass,
            stiffness=DISC.stiffness,
            damping=damping,
            friction_force=DISC.friction_force,
            disc_speed=speed,
        )
        for speed in speeds.tolist()
        for damping in np.linspace(low, high, 20).tolist()
    ]
    margins = [(upper_branch_margin(pin), -whirl_eigenvalues(pin)[1].real) for pin in pins]
    return Claim(
        PIN_STABLE,
        equation="(16)",
        engine="theory",
        **holds(margins),
        parameters=parameters_of(DISC, without=("disc_speed", "damping")),
        source=SOURCE,
        note=f"Whether (16), and whether the eigenvalues say so, at {len(pins)} points over ω/k from 1 to "
        f"{speeds[-1] / K:g} and β from {low:g} to {high:g} N s/m; the load and the torsion do not matter.",
    )


def collapse_claim() -> Claim:
    """Return what motions under (23) end as where its whirl is unstable, simulated by the reference."""
    law, plane, speed = LAWS["(23)"], PLANES["load"], DISC.disc_speed
    (fold,), (hopf,) = (crossings(plane, kind, "disc_speed", speed, law) for kind in ("fold", "Hopf"))
    starts = []
    for share in UNSTABLE_LOADS:
        disc = at(friction_force=fold + share * (hopf - fold))
        largest = whirls(disc, law)[0]
        starts += [
            Start(disc, tuple((largest.state * factors).tolist()), "rotation", SLOWLY_SETTLED)
            for factors in BESIDE_LARGEST
        ]
    _, claim = ends_of(functools.partial(simulate, contact=law), "theory", COLLAPSE, starts, "(19), (23)")
    return claim


def section() -> Data:
    """Return load, radius and largest real part of the whirls of Fig. 11 over their α, for each law."""
    data: Data = {}
    alphas = np.linspace(0.45, np.pi / 2.0 - 1e-3, 240)
    for name, law in LAWS.items():
        rows = []
        for alpha in alphas.tolist():
            load, radius, _ = whirl_at(DISC, alpha, law)
            disc = at(friction_force=load)
            rows.append((load, radius, whirl_eigenvalues(disc, state_at(disc, alpha, law), law)[1].real))
        data[f"section/{name}"] = np.array(rows)
    return data
