"""Claims without an engine: stability of the whirl under each contact law, and the motion's limit cycle."""

from __future__ import annotations

import functools

import numpy as np

import compare.studies.disc.fig11.parameters as parameters
import compare.studies.disc.fig11.whirl as whirl
from compare.claims import WORKING, Measured, answers_of, asked, refined
from compare.engines import Engine
from compare.studies.disc.fig11.offsets import end_of, error_of_monodromy
from compare.studies.disc.fig11.parameters import STUDY
from compare.studies.disc.fig11.theory import (
    disc_at,
    extremes_of,
    pair_modulus,
    predicted_modulation,
    steady_whirl,
)
from compare.studies.toolkit.fig11 import DISCS, RING, SOURCE, START
from reference_model import simulate, whirl_orbit
from reference_model.orbits import modulated_cycle
from reference_model.systems import FloatArray


@STUDY.claim(
    "Shooting finds the modulated cycle that integration approaches, periodic up to a rotation",
    equation="(19)–(21)",
    kind="trajectory",
    unit="s, rad, m, rad/s",
    resolution=1e-3,
    note="Error: the change at a smaller tolerance, and the change from the previous modulation in the integrated "
    "motion.",
)
def shooting() -> Measured:
    predicted, error = predicted_modulation()
    guess = simulate(RING, START, parameters.TIMES, tolerance=1e-7)

    def cycle(tolerance: float) -> FloatArray:
        orbit = modulated_cycle(RING, guess, tolerance=tolerance, samples=len(parameters.ROUND))
        return np.array([orbit.period, orbit.turn, *extremes_of(orbit.trajectory)])

    found = refined(cycle, 100 * WORKING, alike=False)
    return Measured(
        predicted=predicted,
        value=found.value,
        error=found.error + error,
        components=("period in s", "turn in rad", *parameters.EXTREMES),
        source=parameters.CENTRED,
    )


@STUDY.claim(
    "The whirl is unstable on the continuous ring and on six points, but stable by (23)",
    equation="(19)–(23)",
    note="The simplified equations would therefore not have shown the modulated cycle.",
    basis="reference",
    swept=("contact_points",),
)
def unstable() -> Measured:
    whirls_of = [*(steady_whirl(disc) for disc in DISCS.values()), steady_whirl(RING, parameters.EXPANSION)]
    return answers_of(
        np.array((1.0, 1.0, -1.0)) * [whirl.eigenvalue.real for whirl in whirls_of],
        source=parameters.CENTRED,
        note="Sign of the largest real part, in this order: "
        + ", ".join(f"{whirl.eigenvalue:.5f}" for whirl in whirls_of)
        + " 1/s.",
    )


@STUDY.claim(
    "By (23), a small deviation from the whirl decays as its linearisation predicts",
    equation="(23)",
    unit="1/s",
    note=f"Simulated with the reference. {whirl.NOTE}",
    basis="reference",
)
def dies_out_by_23() -> Measured:
    exact = steady_whirl(RING, parameters.EXPANSION).eigenvalue
    reference = Engine(
        "reference by (23)", functools.partial(simulate, contact=parameters.EXPANSION), ("ring",)
    )
    found = whirl.growth(reference, RING, parameters.EXPANSION)
    return Measured(
        predicted=(exact.real, exact.imag),
        value=found.value,
        error=found.error,
        resolution=5e-3 * abs(exact),
        components=("rate", "frequency"),
        parameters={"contact_points": "continuous ring by (23)"},
        source=parameters.CENTRED,
    )


@STUDY.claim(
    "Just above the critical X0, the steady whirl and the modulated motion are both stable",
    equation="(19)–(21)",
    note="Does the pair of multipliers lie inside the unit circle, and does the spin still oscillate by more "
    f"than {parameters.SWING:g} rad/s after {parameters.ENDS_UNTIL:g} s?",
    basis="reference",
)
def both_stable() -> Measured:
    orbit = whirl_orbit(disc_at(parameters.BOTH_STABLE), tolerance=WORKING)
    reference = Engine("reference", simulate, ("ring",))

    def modulated(tolerance: float) -> bool:
        _, kind = end_of(reference, parameters.BOTH_STABLE, parameters.MODULATED_THERE, tolerance)
        return kind == "modulated"

    margin, error = asked(modulated, parameters.ENDS_TOLERANCE)
    return answers_of(
        (1.0 - pair_modulus(orbit.multipliers), float(margin)),
        (error_of_monodromy(orbit), float(error)),
        system=disc_at(parameters.BOTH_STABLE),
        source=f"{SOURCE}; start {parameters.MODULATED_THERE}",
    )
