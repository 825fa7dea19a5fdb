"""Claims on the borders of the map."""

import functools
import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.optimize import brentq

import compare.studies.disc.stability_map.theory as theory
from compare.claims import Measured, answers_of
from compare.claims.linearised_flow import ComplexArray
from compare.studies.disc.stability_map.theory import DISC, STUDY, growth_of_rotation
from compare.studies.toolkit.fig11 import FINE, LAWS, PLANES, curves_in
from reference_model.contact.contact_law import IsotropicContact
from reference_model.formulas.disc import pin_of
from reference_model.formulas.pin import upper_branch_margin
from reference_model.simulation import simulate
from reference_model.steady.bifurcation_curves import Kind, crossings
from reference_model.steady.lyapunov_coefficient import growth_by_amplitude
from reference_model.steady.stability import onset_load, whirl_eigenvalues
from reference_model.steady.steady_states import whirls
from reference_model.systems import DiscOnDisc, FloatArray

ONE_AT_A_TIME = "Fig. 11 with X0 = 0; one parameter at a time"

BOTH_LAWS = "(19), (20), (23)"  # equations for both the ring and (23)

FAR_FROM_KINK = 0.02
"""Smallest |U/W − 1| for the expansion about the whirl, which is invalid close to U = W."""

ONSET_SPEEDS = (1.05, 1.2, 1.4, 1.5, 2.0, 3.0)  # ω in rad/s

UNSTABLE_LOADS = (0.3, 0.7)
"""Shares of the interval of μN from the fold to the Hopf point of (23)."""

BESIDE_LARGEST = ((1.1, 1.0, 1.0, 1.0, 1.1, 1.0), (1.5, 1.0, 1.0, 1.0, 1.5, 1.0))
"""Factors on the state of the larger whirl."""


# --- Traced curves against eigenvalues, and the borders next to Fig. 11

CURVES = "Curves of the continuous ring and of (23) in the planes " + ", ".join(
    f"({first}, {second})" for first, second in (plane.names for plane in PLANES.values())
)

EPSILON = float(np.finfo(float).eps)


@functools.cache
def _spectra_on_map(kind: Kind) -> list[tuple[ComplexArray, float]]:
    return theory.spectra(kind, theory.traced())


@STUDY.claim(
    "At every point of the Hopf curves, a pair of eigenvalues of the whirl is imaginary",
    equation=BOTH_LAWS,
    resolution=1e-10,
    note="Real part over frequency. They come from the Jacobian in the frame that turns with the whirl, which "
    "the tracing of the curves does not use. {CURVES}. Error: rounding, from the condition numbers of the "
    "eigenvalues.",
)
def marginal(curves: theory.Traced | None = None) -> Measured:
    found = _spectra_on_map("Hopf") if curves is None else theory.spectra("Hopf", curves)
    frequencies = np.array([abs(values[0].imag) for values, _ in found])
    return Measured(
        predicted=np.zeros(len(found)),
        value=np.array([values[0].real for values, _ in found]) / frequencies,
        error=np.array([error for _, error in found]) / frequencies,
    )


@STUDY.claim(
    "At every point of the Hopf curves, all other eigenvalues of the whirl are stable: the curves bound its "
    "stability",
    equation=BOTH_LAWS,
    note="Are the real parts of all other eigenvalues negative?",
)
def no_other_grows() -> Measured:
    found = _spectra_on_map("Hopf")
    return answers_of(
        -np.array([value.real for values, _ in found for value in values[2:]]),
        [error for values, error in found for _ in values[2:]],
        note=f"At {len(found)} points.",
    )


@STUDY.claim(
    "At every point of the fold curves, an eigenvalue of the whirl is zero",
    equation=BOTH_LAWS,
    resolution=1e-8,
    note=f"The smallest eigenvalue over k. {CURVES}. Error: rounding, from the condition numbers of the eigenvalues, "
    "which grow where a second eigenvalue becomes zero.",
)
def folds() -> Measured:
    found = _spectra_on_map("fold")
    return Measured(
        predicted=np.zeros(len(found)),
        value=[abs(values[np.argmin(np.abs(values))]) / theory.K for values, _ in found],
        error=[error / theory.K for _, error in found],
    )


@STUDY.claim(
    "The traced curves cross the line of Fig. 11 where a search along this line finds the boundary",
    equation=BOTH_LAWS,
    unit="N",
    resolution=1e-3 * DISC.friction_force,
    note="μN of the Hopf curves, by a cubic spline through the points of the curves, and by a zero of Hurwitz' "
    "determinant over the ratio U : W. Error: the change with points at twice the distance.",
    swept=("friction_force",),
)
def crosses_line() -> Measured:
    rows: list[tuple[float, ...]] = []
    names: list[str] = []
    for law in LAWS:
        sets = theory.traced()["load", law, "Hopf"], curves_in("load", "Hopf", law, step=2.0 * FINE)
        fine, coarse = (theory.crossed(curves, DISC.disc_speed) for curves in sets)
        predicted = hopf_loads(law)
        rows.extend(zip(predicted, fine, np.abs(fine - coarse), strict=True))
        names.extend(f"{law}, crossing {1 + i}" for i in range(len(fine)))
    return _of_rows(rows, names)


def hopf_loads(law: str) -> Sequence[float]:
    """Return μN (N) of the Hopf curves at the speed of Fig. 11."""
    return crossings(PLANES["load"], "Hopf", "disc_speed", DISC.disc_speed, LAWS[law])


def _of_rows(rows: Sequence[tuple[float, ...]], components: Sequence[str], **more: Any) -> Measured:
    predicted, measured, errors = np.transpose(rows)
    return Measured(predicted=predicted, value=measured, error=errors, components=components, **more)


@STUDY.claim(
    "The centred rotation loses its stability at the onset that the closed form predicts",
    equation=BOTH_LAWS,
    unit="N",
    resolution=1e-9 * DISC.friction_force,
    note="Measured: root of the largest real part over μN; the ring and (23) have the same onset. Error: rounding "
    "of the eigenvalues.",
    swept=("friction_force", "disc_speed"),
)
def onset() -> Measured:
    rows = []
    for law in LAWS.values():
        for speed in ONSET_SPEEDS:
            disc = theory.at(disc_speed=speed)
            # Above this load, the centred disc may stick permanently.
            sticking = disc.shaft_damping * abs(disc.disc_speed - disc.shaft_speed) / disc.contact_radius

            def growth(load: float, disc: DiscOnDisc = disc, law: IsotropicContact = law) -> float:
                return growth_of_rotation(replace(disc, friction_force=load), law)

            load = brentq(growth, 1e-3 * sticking, (1.0 - 1e-3) * sticking, xtol=1e-15)
            step = 1e-3 * load
            slope = (growth(load + step) - growth(load - step)) / (2.0 * step)
            rows.append((onset_load(disc, law), load, 16.0 * EPSILON * (theory.K / abs(slope) + load)))
    return _of_rows(rows, [f"{law}, ω = {speed:g} rad/s" for law in LAWS for speed in ONSET_SPEEDS])


SLIP_SPEED = DISC.disc_speed - DISC.shaft_speed

WAYS: dict[str, tuple[Callable[[float], DiscOnDisc], float]] = {
    "load": (lambda share: theory.at(friction_force=share * DISC.friction_force), 0.8),
    "shaft damping": (lambda share: theory.at(shaft_damping=share * DISC.shaft_damping), 1.5),
    "damping of the springs": (lambda share: theory.at(damping=share * DISC.damping), 1.6),
    "slip speed": (lambda share: theory.at(shaft_speed=DISC.disc_speed - share * SLIP_SPEED), 1.3),
}
"""Discs by the share of one parameter of Fig. 11, and a share with stable rotation."""


@STUDY.claim(
    "Each parameter alone makes the centred rotation of Fig. 11 stable where the closed form of the onset predicts",
    equation="(19), (20)",
    resolution=1e-9,
    note="Parameters over their values in Fig. 11; the slip speed is ω − Ω at constant ω. Measured: root of the "
    "largest real part. Error: rounding of the eigenvalues.",
    named={f"{name} at the onset": i for i, name in enumerate(WAYS)},
)
def remedies() -> Measured:
    rows = []
    for disc_of, end in WAYS.values():

        def excess(share: float, disc_of: Callable[[float], DiscOnDisc] = disc_of) -> float:
            return onset_load(disc_of(share)) / disc_of(share).friction_force - 1.0

        def growth(share: float, disc_of: Callable[[float], DiscOnDisc] = disc_of) -> float:
            return growth_of_rotation(disc_of(share))

        predicted, measured = (brentq(zero, 1.0, end, xtol=1e-15) for zero in (excess, growth))
        slope = (growth(end) - growth(1.0)) / (end - 1.0)
        rows.append((predicted, measured, 16.0 * EPSILON * (theory.K / abs(slope) + 1.0)))
    return _of_rows(rows, tuple(WAYS), source=ONE_AT_A_TIME)


@STUDY.claim(
    "Along the line of Fig. 11, whirls gain and lose their stability where the map predicts",
    equation=BOTH_LAWS,
    resolution=1e-8,
)
def by_whirls() -> Measured:
    rows: list[tuple[float, ...]] = []
    names: list[str] = []
    named: dict[str, int | None] = {}
    for law in LAWS:
        for plane in PLANES.values():
            for fixed, name in (plane.names[::-1], plane.names):
                here = getattr(DISC, name)
                borders = crossings(plane, "Hopf", fixed, getattr(DISC, fixed), LAWS[law])
                for value in theory.nearest(borders, here):
                    if law == "ring":
                        named[f"{'lower' if value < here else 'upper'} {name}"] = len(rows)
                    rows.append((value, *theory.change_of_stability(name, value, LAWS[law])))
                    names.append(f"{law}: {name} {value:.4g} ({100.0 * (value / here - 1.0):+.1f} %)")
    distances = "; ".join(dict.fromkeys(names))
    note = f"Borders on either side of the point of Fig. 11, and their distances: {distances}."
    return _of_rows(rows, names, source=ONE_AT_A_TIME, note=note, named=named)


@STUDY.claim(
    "On the continuous ring, the whirl always loses its stability with a jump: the cycle at the border is unstable",
    equation="(19), (20)",
    note="Does the growth of the modulation increase with its amplitude, by the third-order terms of (19), at each "
    f"point of the Hopf curves farther than {FAR_FROM_KINK:g} from U = W in U : W?",
)
def jumps() -> Measured:
    data: dict[str, FloatArray] = {}
    on_ring: list[float] = []
    for (plane, law, kind), curves in theory.traced().items():
        for i, curve in enumerate(curves if kind == "Hopf" else ()):
            growth = np.full(len(curve.alpha), np.nan)
            for j, (values, alpha) in enumerate(zip(curve.parameters, curve.alpha.tolist(), strict=True)):
                if abs(1.0 / math.tan(alpha) - 1.0) > FAR_FROM_KINK:
                    disc = PLANES[plane].at(values)
                    growth[j] = growth_by_amplitude(disc, theory.state_at(disc, alpha, LAWS[law]), LAWS[law])
            data[f"{plane}/{law}/growth/{i}"] = growth
            if law == "ring":
                on_ring += growth[np.isfinite(growth)].tolist()
    return answers_of(on_ring, data=data)


(LOW, _), (HIGH, _) = PLANES["dampers"].lower, PLANES["dampers"].upper

SIGN = "Sign of the largest real part."

SPEEDS = np.linspace(theory.K * (1.0 + 1e-6), PLANES["load"].upper[0], 40)
"""ω of the pins in rad/s."""


@STUDY.claim(
    "At the parameters of Fig. 11, the whirl on the continuous ring is unstable",
    equation="(19), (20)",
    note=SIGN,
)
def unstable_on_ring() -> Measured:
    return _side("ring", 1.0)


@STUDY.claim(
    "At the parameters of Fig. 11, the whirl of (23) is stable: (23) does not show the instability",
    equation="(19), (23)",
    note=SIGN,
)
def stable_by_23() -> Measured:
    return _side("(23)", -1.0)


def _side(law: str, sign: float) -> Measured:
    (whirl,) = whirls(DISC, LAWS[law])
    values, error = theory.critical_eigenvalues(DISC, whirl.state, LAWS[law])
    return answers_of(
        sign * values[0].real,
        error,
        source="Fig. 11 with X0 = 0",
        note=f"Radius {whirl.radius:.5f} m, spin {whirl.spin:.5f} rad/s, eigenvalues {values[0].real:+.5f} "
        f"± {abs(values[0].imag):.5f}i 1/s. "
        f"At this speed the whirl of this law is unstable up to μN = {max(hopf_loads(law)):.5f} N.",
    )


@STUDY.claim(
    "A pin's whirl has no Hopf curve: it is stable at any damping wherever ω > k",
    equation="(16)",
    note=f"Do (16) and the eigenvalues confirm it, over ω/k from 1 to {SPEEDS[-1] / theory.K:g} and β from "
    f"{LOW:g} to {HIGH:g} N s/m? μN and the torsion have no effect.",
    swept=("disc_speed", "damping"),
)
def pin_is_stable() -> Measured:
    dampings = np.linspace(LOW, HIGH, 20).tolist()
    pins = [
        pin_of(DISC, damping=damping, disc_speed=speed) for speed in SPEEDS.tolist() for damping in dampings
    ]
    return answers_of([(upper_branch_margin(pin), -whirl_eigenvalues(pin)[1].real) for pin in pins])


@STUDY.claim(
    "Where the whirl of (23) is unstable at the speeds of Fig. 11, motions end as rotation, not in a cycle",
    equation="(19), (23)",
    basis="reference",
)
def collapses_by_23() -> Measured:
    law, plane, speed = LAWS["(23)"], PLANES["load"], DISC.disc_speed
    (fold,), (hopf,) = (crossings(plane, kind, "disc_speed", speed, law) for kind in ("fold", "Hopf"))
    starts = []
    for share in UNSTABLE_LOADS:
        disc = theory.at(friction_force=fold + share * (hopf - fold))
        largest = whirls(disc, law)[0]
        states = [tuple((largest.state * factors).tolist()) for factors in BESIDE_LARGEST]
        starts += [theory.Start(disc, state, "rotation", theory.SLOWLY_SETTLED) for state in states]
    _, measured = theory.ends_of(functools.partial(simulate, contact=law), starts)
    return measured
