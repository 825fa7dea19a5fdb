"""Eq. 12 to 16 against each other: the conditions of stability."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from compare.claims.linearised_flow import eigenvalues_with_rounding, matched, real_and_imaginary
from compare.claims.measured import Measured, answers_of
from compare.studies.pin.whirl_stability.claims.study import STUDY
from compare.studies.pin.whirl_stability.parameters import DAMPINGS, RATIOS, K, pin_at
from compare.studies.pin.whirl_stability.theory import grid, largest_real_parts
from compare.studies.toolkit.deviations import PARTS
from reference_model.formulas.pin import (
    characteristic_coefficients,
    coefficient_margins,
    lower_branch_margin,
    upper_branch_margin,
    variational_matrix,
)
from reference_model.steady.stability import turning_frame_jacobian

BoolArray = NDArray[np.bool_]


@STUDY.claim(
    "Corrected (13), the matrix of (12) and the Jacobian of (1) have the same eigenvalues",
    equation="(12), (13)",
    unit="1/s",
    resolution=1e-9 * K,
    note="All three eigenvalues of (12), and all four of the Jacobian in the frame that turns with the whirl, one of "
    "which is the zero of the phase. Error: rounding, by the condition of each eigenvalue.",
    swept=("disc_speed", "damping"),
)
def same_eigenvalues() -> Measured:
    """Compare the roots of corrected (13) with the eigenvalues of (12) and of the Jacobian of (1)."""
    pins = [
        pin_at(float(speed), float(damping))
        for speed in K * (1.0 + np.geomspace(0.02, 9.0, 15))
        for damping in np.geomspace(0.03, 3.0, 9)
    ]
    companion = np.zeros((len(pins), 3, 3))
    companion[:, 1:, :2] = np.eye(2)
    companion[:, :, 2] = [[-value for value in characteristic_coefficients(pin)[:0:-1]] for pin in pins]
    roots, roots_error = eigenvalues_with_rounding(companion)
    of_12, of_12_error = eigenvalues_with_rounding([variational_matrix(pin) for pin in pins])
    of_1, of_1_error = eigenvalues_with_rounding([turning_frame_jacobian(pin) for pin in pins])
    predicted, measured, errors = [], [], []
    for i in range(len(pins)):
        predicted.append([*roots[i], *matched([0.0, *roots[i]], of_1[i])])
        measured.append([*matched(of_12[i], roots[i]), *of_1[i]])
        errors.append(np.max(roots_error[i]) + max(np.max(of_12_error[i]), np.max(of_1_error[i])))
    numbers = real_and_imaginary(measured)
    return Measured(
        predicted=real_and_imaginary(predicted),
        value=numbers,
        error=np.broadcast_to(np.array(errors)[:, np.newaxis, np.newaxis], numbers.shape),
        components=PARTS,
        source="Fig. 4 with X0 = 0; a grid of ω/k = 1.02 … 10 and β = 0.03 … 3 N s/m",
    )


def counted(margins: ArrayLike, errors: ArrayLike = 0.0) -> Measured:
    """Return in how many points of the grid a statement holds; one in a thousand may be open."""
    return answers_of(
        margins,
        errors,
        may_be_open=len(DAMPINGS) * len(RATIOS) // 1000,
        source=f"assumption: a grid of {len(RATIOS)} values of ω/k = {RATIOS[0]:g} … {RATIOS[-1]:g} and "
        f"{len(DAMPINGS)} of β/(mk) = {DAMPINGS[0]:g} … {DAMPINGS[-1]:g}",
    )


def in_14() -> BoolArray:
    """Return at which points of the grid (14) holds."""
    return np.array([min(coefficient_margins(pin)) > 0.0 for pin in grid()])


def in_16() -> BoolArray:
    """Return at which points of the grid (16) holds."""
    return np.array([upper_branch_margin(pin) > 0.0 for pin in grid()])


@STUDY.claim(
    "All roots of (13) have negative real parts exactly where (16) holds",
    equation="(16)",
    note="Whether the condition and the eigenvalues of (12) say the same at each grid point; rounding may leave one "
    "in a thousand open. Below k this is about the matrix only: no whirl exists there.",
    swept=("disc_speed", "damping"),
)
def hurwitz() -> Measured:
    """Compare (16) with the largest real part of the eigenvalues."""
    largest, error = largest_real_parts()
    return counted(np.where(in_16(), -largest, largest), error)


@STUDY.claim(
    "Where (16) holds, (14) holds too",
    equation="(14), (16)",
    note="At each grid point. With q = 4k²m²/β² the bound of (16) is −q/(1 + q + √(1 + q²)), which is above −1 and "
    "above −q.",
    swept=("disc_speed", "damping"),
)
def implied() -> Measured:
    """Look for points where (16) holds without (14)."""
    return counted(~in_16() | in_14())


@STUDY.claim(
    "(14) and (15) never hold together",
    equation="(14), (15)",
    note="At each grid point. With q = 4k²m²/β² the bound of (15) is −(1 + q + √(1 + q²))/2, which is below "
    "−min(1, q), where (14) fails.",
    swept=("disc_speed", "damping"),
)
def incompatible() -> Measured:
    """Look for points where both hold."""
    in_15 = np.array([lower_branch_margin(pin) > 0.0 for pin in grid()])
    return counted(~(in_14() & in_15))
