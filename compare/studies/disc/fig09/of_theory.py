"""Claims without an engine: ends of whirl and equilibrium by formulas and by the reference's orbits."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

import compare.studies.disc.fig09.theory as theory
from compare.claims import Measured, extrapolated_order
from compare.studies.disc.fig09.theory import STUDY, last_stable_load, weak_damping_load
from reference_model import smallest_load_with_whirl
from reference_model.contact.contact_law import IsotropicContact
from reference_model.formulas.disc import whirl_at


@STUDY.claim(
    "Without offset, the whirl ends in a fold: at its smallest friction force, one of its eigenvalues passes zero",
    equation="(20), (23)",
    unit="N",
    note="Predicted: the minimum of μN over the ratio of the slip speeds of rim and centre. Measured: μN "
    "where the eigenvalue is zero, to 1e-6 of that ratio; μN is stationary there.",
    swept=("friction_force",),
)
def fold() -> Measured:
    laws: Sequence[IsotropicContact | None] = (None, theory.PAPER_LAW)
    measured = [whirl_at(theory.CENTRED, theory.marginal_ratio(law), law).load for law in laws]
    return Measured(
        predicted=[smallest_load_with_whirl(theory.CENTRED, law) for law in laws],
        value=measured,
        error=1e-12 * max(measured),
        resolution=1e-9 * max(measured),
        components=("continuous ring", "(23)"),
        system=theory.CENTRED,
    )


@STUDY.claim(
    "As β → 0, the equilibrium loses its stability where friction excites a circular motion as much as β damps it",
    resolution=0.05,
    note=f"Order in β of the error, for β = {', '.join(f'{damping:g}' for damping in theory.DAMPINGS)} N s/m, "
    "extrapolated. This is not in the paper, which states that the equilibrium is stable.",
    swept=("friction_force", "damping"),
)
def weak_damping() -> Measured:
    discs = [replace(theory.RING, damping=float(damping)) for damping in theory.DAMPINGS]
    errors = np.array([abs(weak_damping_load(one) / last_stable_load(one) - 1.0) for one in discs])
    order, numerical, model = extrapolated_order(errors, 1e-12)
    return Measured(
        predicted=1.0,
        value=order,
        error=numerical,
        model=model,
        source=f"{theory.SOURCE}; the decreasing β are our choice",
        note=f"For the β of Fig. 9, it loses its stability at {last_stable_load(theory.RING):.6f} N, or at "
        f"{weak_damping_load(theory.RING):.6f} N by this formula, far below C·X0, where stick begins.",
    )


@STUDY.claim(
    "The inner, unstable whirl shrinks onto the equilibrium at the μN at which the equilibrium loses its stability",
    unit="N",
    note="This is not in the paper. Predicted: the zero of the real part of an eigenvalue of the equilibrium. "
    "Measured: μN of the reference's inner whirls by shooting, as a polynomial in the square of their size (root "
    "of the mean square distance from the centre), at zero. Model error: the change with one orbit less. The "
    "basin of the equilibrium therefore shrinks to nothing there.",
    basis="reference",
    named={"last stable load": 0},
    swept=("friction_force",),
)
def merges() -> Measured:
    load = np.array([orbit.system.friction_force for orbit in theory.orbits()])
    square = np.array([np.var(orbit.trajectory.states[:-1, :2], axis=0).sum() for orbit in theory.orbits()])
    near, far = (float(np.polyfit(square[-n:], load[-n:], n - 1)[-1]) for n in (4, 3))
    return Measured(
        predicted=last_stable_load(theory.RING),
        value=near,
        error=1e-9 * near,
        model=abs(near - far),
        resolution=0.01 * near,
        note=f"Sizes: {math.sqrt(square[-4]):.2g} to {math.sqrt(square[-1]):.2g} m.",
    )
