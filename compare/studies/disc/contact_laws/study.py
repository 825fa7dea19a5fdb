"""Friction in an engine, and contact laws against the integral, each other and the textbook."""

import cmath
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

import compare.studies.disc.contact_laws.theory as theory
from compare.claims import ROUNDING, TIGHTEST, Measured, Study, observed_exponent, refined
from compare.claims.parameters import FIG11
from compare.engines import Engine
from compare.studies.disc.contact_laws.theory import INNER, NUMBERS, QUADRATURE, RING, R
from compare.studies.toolkit.fig11 import SIX
from reference_model.contact.annulus import ORDER, SLOPE_ORDER, Annulus
from reference_model.systems import DiscOnDisc, FloatArray

SOURCE = "Fig. 11; the motion of the disc is our choice"

SOURCE_OF_LAWS = "R of Fig. 11; slip and spin are our choice"

RATIOS = (0.05, 0.3, 0.6, 0.8, 1.25, 1.7, 3.0, 20.0)
"""U/W, not too close to 1, where friction is not differentiable."""

SPEED, CENTRE, DIRECTION, ANGLE = 0.3, 0.05 - 0.02j, 0.4, 0.3
"""√(U² + W²) in m/s, position of the disc's centre (x + iy, m), direction of its slip and angle of the disc (rad)."""

STEP = 2e-3  # time step in s
DIFFERENCES = (
    (-25.0 / 12.0, 4.0, -3.0, 4.0 / 3.0, -1.0 / 4.0),
    (-11.0 / 6.0, 3.0, -3.0 / 2.0, 1.0 / 3.0, 0.0),
)
"""Weights of fourth and third order for the derivative at the first of five times."""

COMPARED = (*np.geomspace(1e-3, 1e3, 19).tolist(), 1.0 - 1e-3, 1.0 + 1e-3, 1.0 - 1e-6, 1.0 + 1e-6)
"""U/W of the comparison."""

RESTING, RINGS = (INNER, 0.75 * R, R), (8, 9, 10, 11, 12)
"""Radii (m) of a resting point, and numbers of rings on either side of it, few enough for errors above rounding."""

WIDTHS = (0.16, 0.12, 0.08, 0.06, 0.04, 0.03)  # widths of thin annuli as shares of their mean radius


STUDY = Study.beside(__file__, "contact-laws", source=SOURCE, seconds=1.5, quick=True, contact=True)
STUDY.provides(curves=theory.curves)


# --- Friction on a disc, from its acceleration in an engine

NOTE = (
    "F_x, F_y over μN and M over μN·R. Measured: the initial acceleration, from the velocities in the first "
    f"{4.0 * STEP:g} s. Predicted: quadrature. Error: the change from differences of the next lower order, and at "
    "a smaller tolerance."
)


@STUDY.claim(
    "Friction on the continuous ring equals the integral (20)", equation="(20)", resolution=1e-3, note=NOTE
)
def on_ring(engine: Engine, ratios: Sequence[float] = RATIOS) -> Measured:
    predicted = [theory.ring_by_quadrature(slip, rim)[0] for slip, rim in motions(ratios)]
    return friction_on(engine, FIG11, ratios, "ring", predicted)


@STUDY.claim(
    "Friction on six points equals the mean of (20) over the points, with the slip of (21)",
    equation="(21)",
    resolution=1e-3,
    note=NOTE,
)
def on_six_points(engine: Engine, ratios: Sequence[float] = RATIOS) -> Measured:
    predicted = [theory.sum_of_points(slip, rim, ANGLE, 6) for slip, rim in motions(ratios)]
    return friction_on(engine, SIX, ratios, "points6", predicted)


def motions(ratios: Sequence[float]) -> list[tuple[complex, float]]:
    """Return the slip u of the centre and R·(ω − φ̇) of the rim (m/s), for all U/W and both signs of the rim's."""
    alphas = [math.atan2(1.0, ratio) for ratio in ratios]
    return [
        (cmath.rect(SPEED * math.cos(alpha), DIRECTION), sign * SPEED * math.sin(alpha))
        for sign in (1.0, -1.0)
        for alpha in alphas
    ]


PARTS_OF_FRICTION = ("F_x", "F_y", "M")


def at_ratios(ratios: Sequence[float]) -> dict[str, list[str]]:
    return {"U/W": [f"{ratio:g}, ω {sign} φ̇" for sign in "><" for ratio in ratios]}


def friction_on(
    engine: Engine, disc: DiscOnDisc, ratios: Sequence[float], name: str, predicted: Sequence[FloatArray]
) -> Measured:
    """Compare F_x/μN, F_y/μN and M/(μN·R) with ``predicted``, shape (2n, 3).

    Friction is the initial acceleration times inertia plus the forces of springs and dampers, see (19).
    """
    inertia = np.array((disc.mass, disc.mass, disc.polar_inertia))

    def friction(tolerance: float) -> FloatArray:
        found = []
        for slip, rim in motions(ratios):
            v, spin = slip + 1j * disc.disc_speed * CENTRE, disc.disc_speed - rim / disc.contact_radius
            start = [CENTRE.real, CENTRE.imag, ANGLE, v.real, v.imag, spin]
            velocities = engine.simulate(disc, start, STEP * np.arange(5), tolerance=tolerance).states[:, 3:]
            support = disc.damping * v + disc.stiffness * (CENTRE - disc.offset)
            resisted = (support.real, support.imag, disc.shaft_damping * (spin - disc.shaft_speed))
            found.append(inertia * (np.array(DIFFERENCES) @ velocities) / STEP + resisted)
        return np.array(found) / (disc.friction_force * np.array((1.0, 1.0, disc.contact_radius)))

    found, error = refined(friction, TIGHTEST)
    # Single errors may be small by chance, so take the largest noise of all motions and the largest truncation error
    # of each motion.
    truncation = np.max(np.abs(found[:, 0] - found[:, 1]), axis=1, keepdims=True)
    along = found[:, 0, :2] @ (-math.cos(DIRECTION), -math.sin(DIRECTION))
    return Measured(
        predicted=predicted,
        value=found[:, 0],
        error=np.max(error[:, 0], axis=0) + truncation,
        size=1.0,
        at=at_ratios(ratios),
        components=PARTS_OF_FRICTION,
        system=disc,
        parameters={"x": CENTRE.real, "y": CENTRE.imag, "angle": ANGLE},
        data={"ratio": ratios, name: np.column_stack((along, found[:, 0, 2]))[: len(ratios)]},
    )


# --- Contact laws without an engine

OF_EXPANSION = (
    "Predicted: the integral (20), and the integral with the three terms of (22). Measured: the closed forms. Error: "
    "from the quadrature"
)

OF_POINTS = (
    "Found on a grid over U/W = 1/20 … 20 and φ, with repeated refinement about the best point. Error: twice "
    "the last"
)

PARTS = ("force", "moment")


@STUDY.claim(
    "The elliptic integrals of the continuous ring equal the integral (20)",
    equation="(20)",
    resolution=1e-10,
    note="F_x, F_y over μN and M over μN·R. Predicted: adaptive quadrature, whose own estimate is the error.",
)
def closed_form() -> Measured:
    rows = []
    for sign in (1.0, -1.0):
        for i, ratio in enumerate(COMPARED):
            slip = cmath.rect(ratio, i)
            integral, error = theory.ring_by_quadrature(slip, sign)
            rows.append((integral, theory.friction(RING, slip, sign), [error + ROUNDING] * 3))
    predicted, measured, errors = zip(*rows, strict=True)
    return of_laws(
        predicted=predicted,
        value=measured,
        error=errors,
        at=at_ratios(COMPARED),
        components=PARTS_OF_FRICTION,
    )


def of_laws(parameters: Mapping[str, float] | None = None, **measured: Any) -> Measured:
    return Measured(
        parameters={"contact_radius": R} | dict(parameters or {}), source=SOURCE_OF_LAWS, **measured
    )


@STUDY.claim(
    "The error of (23) reaches 0.1025 of μN in force and of μN·R in moment",
    equation="(23)",
    resolution=1e-6,
    note=f"{OF_EXPANSION}.",
)
def error_of_expansion() -> Measured:
    integrals, formulas = theory.greatest_errors_of_expansion()
    return of_laws(
        predicted=integrals[:, 1],
        value=formulas[:, 1],
        error=QUADRATURE,
        components=PARTS,
        data={"expansion_worst": formulas[:, :2]},
    )


@STUDY.claim(
    "The error of (23) is largest at U = 0.77 W in force, and at W = 0.77 U in moment",
    equation="(23)",
    resolution=1e-3,
    note=f"U/W. {OF_EXPANSION}, and the resulting uncertainty of the position of the maximum.",
)
def place_of_expansion_error() -> Measured:
    integrals, formulas = theory.greatest_errors_of_expansion()
    error = integrals[:, 2] + formulas[:, 2]
    return of_laws(predicted=integrals[:, 0], value=formulas[:, 0], error=error, components=PARTS)


@STUDY.claim(
    "The error of n points reaches 1/n + 2/π − cot(π/2n)/n of μN and of μN·R",
    equation="(21)",
    resolution=1e-3,
    note="Predicted: at U = W, the point that is about to rest contributes its full share of friction in the most "
    f"unfavourable direction, and the other points contribute a sum of sines. {OF_POINTS} step.",
)
def error_of_points(numbers: Sequence[int] = NUMBERS) -> Measured:
    found = theory.greatest_errors_of_points(numbers)
    return of_laws(
        predicted=[[1.0 / n + 2.0 / math.pi - 1.0 / (n * math.tan(0.5 * math.pi / n))] * 2 for n in numbers],
        value=found[:, :, 1],
        error=found[:, :, 2],
        at={"n": numbers},
        components=PARTS,
        data={f"points{n}_worst": one for n, one in zip(numbers, found[:, :, :2], strict=True)},
    )


@STUDY.claim(
    "The error of n points is largest where U = W and one of them comes to rest",
    equation="(21)",
    resolution=1e-3,
    note=f"U/W. {OF_POINTS} change of the position.",
)
def place_of_points_error(numbers: Sequence[int] = NUMBERS) -> Measured:
    found = theory.greatest_errors_of_points(numbers)
    return of_laws(
        predicted=np.ones(found.shape[:2]),
        value=found[:, :, 0],
        error=found[:, :, 3],
        at={"n": numbers},
        components=PARTS,
    )


OF_RINGS = (
    f"With {', '.join(map(str, RINGS))} rings on either side of the ring with the resting point, compared "
    f"with 100 rings. "
    "Errors: scatter, and the change without a next term."
)


@STUDY.claim(
    "With a resting point, the ring approximation of an annulus converges with order 12",
    kind="order",
    resolution=1.5,
    note=OF_RINGS,
)
def annulus_converges() -> Measured:
    return order_in_rings(Annulus.shares, ORDER)


@STUDY.claim(
    "The slopes of an annulus with a resting point converge with the number of rings at order 6",
    kind="order",
    resolution=1.5,
    note=OF_RINGS,
)
def slopes_converge() -> Measured:
    return order_in_rings(Annulus.slopes, SLOPE_ORDER)


def order_in_rings(function: Callable[[Annulus, float, float], Sequence[float]], order: int) -> Measured:
    # The error of Gauss's rule on powers and logarithms has even powers of 1/(n + ½).
    fineness = 1.0 / (np.array(RINGS) + 0.5)
    observed = []
    for radius in RESTING:
        exact = np.array(function(Annulus(INNER, R, rings=100), radius, 1.0))
        found = np.array([function(Annulus(INNER, R, rings=n), radius, 1.0) for n in RINGS])
        errors = np.linalg.norm(found / exact - 1.0, axis=1)
        observed.append(observed_exponent(fineness, errors, next_term=2.0, noise=ROUNDING))
    return of_orders(observed, order, at={"radius in m": RESTING}, parameters={"inner_radius": INNER})


def of_orders(observed: Sequence[tuple[float, float, float]], order: float, **more: Any) -> Measured:
    exponents, numerical, model = np.array(observed).T
    predicted, largest = np.full(len(exponents), float(order)), float(np.max(model))
    return of_laws(predicted=predicted, value=exponents, error=numerical, model=largest, **more)


@STUDY.claim(
    "A thin annulus acts like a ring; the difference is of second order in its width",
    equation="(20)",
    kind="order",
    resolution=0.1,
    note="Exponent of the width in the deviation from the ring of the mean radius, for width/R = "
    f"{', '.join(f'{width:g}' for width in WIDTHS)}. Errors: scatter, and the change without a next term.",
)
def thin_annulus() -> Measured:
    widths, slips = np.array(WIDTHS), (0.5 * R, 2.0 * R)
    observed = []
    for slip in slips:
        laws = [Annulus(R * (1.0 - width / 2.0), R * (1.0 + width / 2.0)) for width in WIDTHS]
        found = np.array([law.shares(slip, 1.0) for law in laws])
        errors = np.abs(found / np.array(RING.shares(slip, 1.0)) - 1.0)
        observed += [observed_exponent(widths, error, next_term=2.0, noise=ROUNDING) for error in errors.T]
    components = [f"{part} at U = {slip / R:g} W" for slip in slips for part in PARTS]
    return of_orders(observed, 2.0, components=components)


@STUDY.claim(
    "A spinning annulus has the moment of a disc clutch",
    unit="m",
    resolution=1e-9,
    note="M/μN of a full disc, and of an annulus from 2R/3 to R. Predicted: (2/3)(r₂³ − r₁³)/(r₂² − r₁²) under "
    "uniform pressure, (r₁ + r₂)/2 under a pressure like 1/r. Error: rounding.",
)
def in_place() -> Measured:
    predicted, measured = [], []
    for inner in (0.0, INNER):
        uniform = 2.0 / 3.0 * (R**3 - inner**3) / (R**2 - inner**2)
        predicted.append((uniform, 0.5 * (inner + R)))
        laws = (Annulus(inner, R), Annulus(inner, R, pressure=lambda radius: 1.0 / radius))
        measured.append([law.shares(0.0, 1.0).moment for law in laws])
    return of_laws(
        predicted=predicted,
        value=measured,
        error=ROUNDING * R,
        at={"r₁ in m": (0.0, INNER)},
        components=("uniform pressure", "pressure like 1/r"),
        parameters={"inner_radius": INNER},
    )
