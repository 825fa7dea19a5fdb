"""When friction that falls with the slip lets a clutch disc vibrate, how fast that grows, and where it ends."""

from __future__ import annotations

import functools
import math

import numpy as np

from compare.claims.error_estimates import COARSENING, change_as_error
from compare.claims.measured import Measured
from compare.claims.study import Data, Study
from compare.engines import Engine
from compare.studies.drivetrain.judder.model import Judder
from compare.studies.drivetrain.judder.parameters import (
    EPSILON,
    GRADIENTS,
    GROWN,
    GROWN_UNTIL,
    ONSET,
    PERIODS,
    PERTURBED,
    PUSHED,
    RADIUS,
    SPEED,
    STICKING_TOLERANCE,
    TIMES,
    TOLERANCE,
)
from compare.studies.drivetrain.judder.pictures import draw
from compare.studies.drivetrain.judder.theory import eigenvalue, motion
from reference_model.systems import FloatArray

GRADIENT = {"fall of μ over that of onset": GRADIENTS / ONSET}


def curves() -> Data:
    """Return growth over the fall of μ, for the figure."""
    gradients = np.linspace(GRADIENTS[0], GRADIENTS[-1], 50)
    return {"gradients": gradients, "growth": np.array([eigenvalue(gradient).real for gradient in gradients])}


STUDY = Study.beside(
    __file__,
    "judder",
    source="a disc on a torsional spring, an assumption",
    draw=draw,
    curves=curves,
    only=("exudyn",),
    seconds=2.0,
)


@STUDY.claim(
    "Small vibrations of a clutch disc grow by the fall of friction with slip less the damping of its shaft",
    unit="1/s",
    resolution=1e-6,
    note="Real and imaginary part of λ in J·λ² + (D − N·R²·γ)·λ + K = 0, where μ falls by γ with the slip; by "
    "Exudyn's linearisation of the model. Numerical error: rounding of its eigenvalues.",
)
def linear(engine: Engine) -> Measured:
    """Compare the eigenvalues of the disc with the closed form."""
    exact = np.array([eigenvalue(gradient) for gradient in GRADIENTS])
    found = np.array([Judder(gradient).eigenvalue() for gradient in GRADIENTS])
    return Measured(
        predicted=np.column_stack((exact.real, exact.imag)),
        value=np.column_stack((found.real, found.imag)),
        error=1e-9 * float(np.max(np.abs(exact))),
        components=("growth", "angular frequency"),
        at=GRADIENT,
    )


@functools.lru_cache(maxsize=1)
def _motions(engine: Engine) -> tuple[FloatArray, FloatArray]:
    """Return angle and speed at ``TIMES`` for each gradient at two tolerances, both of shape (g, n, 2)."""

    def at_times(gradient: float, tolerance: float) -> FloatArray:
        run = Judder(gradient).run(float(TIMES[-1]), TIMES[1:-1].tolist(), tolerance)
        return run[np.searchsorted(run[:, 0], TIMES - 1e-12), 1:]

    found = [
        np.array([at_times(gradient, tolerance) for gradient in GRADIENTS])
        for tolerance in (TOLERANCE, TOLERANCE / COARSENING)
    ]
    return found[0], found[1]


@STUDY.claim(
    "A disc that is pushed vibrates as the closed form says, until its slip ends",
    kind="trajectory",
    resolution=1e-6,
    note=f"Deviation from rest over the largest in {PERIODS} periods, after a push of {PERTURBED:g} rad/s. Numerical "
    "error: the change with the tolerance.",
)
def vibrates(engine: Engine) -> Measured:
    """Compare angle and speed with the closed form."""
    exact = np.array([motion(gradient, TIMES) for gradient in GRADIENTS])
    size = np.max(np.abs(exact - exact[:, :1] * [1.0, 0.0]), axis=1, keepdims=True)
    found, finer = _motions(engine)
    return Measured(
        predicted=exact / size,
        value=found / size,
        error=float(np.max(change_as_error(found / size, finer / size))),
        components=("angle", "speed"),
        at={**GRADIENT, "t in s": TIMES},
    )


@STUDY.claim(
    "Judder begins where the coefficient of friction falls by D/(N·R²)",
    unit="s/m",
    resolution=1e-5 * ONSET,
    note="Where the straight line through the growth of these motions is zero. Numerical error: the change with the "
    "tolerance.",
)
def onset(engine: Engine) -> Measured:
    """Compare where the measured growth changes its sign with the closed form."""
    first, second = (_onset(found) for found in _motions(engine))
    return Measured(
        predicted=ONSET,
        value=first,
        error=float(change_as_error(np.array([first]), np.array([second]))[0]),
        named={"onset of judder": 0},
        data={"measured": _growth(_motions(engine)[0]), "at": GRADIENTS},
    )


def _growth(found: FloatArray) -> FloatArray:
    """Return the growth in 1/s of motions with the shape (g, n, 2).

    Speeds at equal intervals Δ of one linear vibration are a recurrence, v₂ = 2·e^(σΔ)·cos(ωΔ)·v₁ − e^(2σΔ)·v₀.
    """
    speeds, interval = found[..., 1], float(TIMES[1] - TIMES[0])
    growths = []
    for v in speeds:
        (_, last), *_ = np.linalg.lstsq(np.column_stack((v[1:-1], v[:-2])), v[2:], rcond=None)
        growths.append(math.log(-last) / (2.0 * interval))
    return np.array(growths)


def _onset(found: FloatArray) -> float:
    """Return the gradient in s/m at which the growth, which is a straight line over it, is zero."""
    slope, growth = np.polyfit(GRADIENTS, _growth(found), 1)
    return float(-growth / slope)


@STUDY.claim(
    "Judder that grows slowly ends in stick: once in a period the disc is as fast as the drive, and never faster",
    unit="rad/s",
    resolution=0.01,
    note=f"The largest speed of the disc from {0.5 * GROWN_UNTIL:g} to {GROWN_UNTIL:g} s, where μ falls "
    f"{GROWN / ONSET:g} times as much as at the onset. Model error: ε/R, by which a disc that sticks creeps.",
)
def sticks(engine: Engine) -> Measured:
    """Compare the largest speed of the disc with that of the drive."""
    runs = [
        Judder(GROWN, PUSHED).run(GROWN_UNTIL, tolerance=tolerance)
        for tolerance in (STICKING_TOLERANCE, STICKING_TOLERANCE / COARSENING)
    ]
    largest = [np.max(run[run[:, 0] > 0.5 * GROWN_UNTIL, 2]) for run in runs]
    return Measured(
        predicted=SPEED,
        value=largest[0],
        error=float(change_as_error(np.array(largest[:1]), np.array(largest[1:]))[0]),
        model=EPSILON / RADIUS,
        data={"grown t": runs[0][:, 0], "grown speed": runs[0][:, 2]},
    )
