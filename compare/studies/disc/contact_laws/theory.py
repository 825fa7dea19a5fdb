"""How far the laws of contact are from each other, and from the integral that they stand for."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from compare.claims.claim import Claim, ErrorBudget
from compare.claims.error_estimates import ROUNDING, observed_exponent
from compare.claims.paper_parameters import FIG11
from compare.claims.parameters import at_each
from compare.claims.study import Data, Findings
from compare.studies.disc.contact_laws.integrals import average_of_expansion, ring_by_quadrature
from reference_model.contact.annulus import ORDER, SLOPE_ORDER, Annulus
from reference_model.contact.contact_law import Contact, PointsOnRing, Ring, ThreeTermRing
from reference_model.systems import FloatArray

R = FIG11.contact_radius
SOURCE = "R of Fig. 11; slip and spin are ours"
PARAMETERS = {"contact_radius": R}
RING, EXPANSION = Ring(R), ThreeTermRing(R)

COMPARED = (*np.geomspace(1e-3, 1e3, 19).tolist(), 1.0 - 1e-3, 1.0 + 1e-3, 1.0 - 1e-6, 1.0 + 1e-6)
"""U/W at which the closed form is compared with the integral; 1 is among them."""

NUMBERS = (6, 12, 24)
"""Of points on the ring."""

ZOOMS = 30
"""Halvings of the range in which the greatest error of points is searched."""

INNER = 2.0 / 3.0 * R
"""Inner radius of the annulus in m, whose outer one is R."""

RESTING = (INNER, 0.75 * R, R)
"""Radii of the annulus in m where a point is at rest while its convergence is observed."""

RINGS = (8, 9, 10, 11, 12)
"""On either side of that radius: as many as leave the error well above rounding."""

WIDTHS = (0.16, 0.12, 0.08, 0.06, 0.04, 0.03)
"""Of thin annuli, in units of their mean radius."""

CLOSED = "The elliptic integrals of the continuous ring equal the integral (20)"
SIZE = "(23) is off by up to 0.1025 of μN in force and of μN·R in moment"
WHERE = "(23) is off the most in force at U = 0.77 W, and in moment at W = 0.77 U"
WORST = "n points are off by up to 1/n + 2/π − cot(π/2n)/n of μN and of μN·R"
AT_REST = "n points are off the most where U = W and one of them comes to rest"
CONVERGES = "An annulus with a resting point converges with its rings at order 12"
SLOPES = "The slopes of an annulus with a resting point converge with its rings at order 6"
THIN = "A thin annulus is a ring, up to the square of its width"
IN_PLACE = "An annulus that turns in place has the moment of a disc clutch"


def friction(law: Contact, slip: complex, rim: float, angle: float = 0.0) -> FloatArray:
    """Return (F_x, F_y, M) of ``law`` in the units and for the arguments of ``contact_integrals``."""
    force, moment = law.force_and_moment(slip, rim / R, angle)
    return np.array((force.real, force.imag, moment / R))


def theory() -> Findings:
    """Compare the laws with the integrals and with each other, and compute their curves."""
    tops, expansion_claims = expansion()
    worst, points_claims = greatest_errors_of_points()
    return Findings(
        (closed_form(), *expansion_claims, *points_claims, *convergence(), thin(), in_place()),
        curves() | {"expansion_worst": tops} | {f"points{n}_worst": worst[i] for i, n in enumerate(NUMBERS)},
    )


def closed_form() -> Claim:
    """Compare the closed form of the ring with quadrature, for slip in any direction and spin of either sign."""
    predicted, measured, errors = [], [], []
    for sign in (1.0, -1.0):
        for i, ratio in enumerate(COMPARED):
            slip = ratio * complex(math.cos(i), math.sin(i))
            integral, error = ring_by_quadrature(slip, sign)
            predicted.append(integral)
            measured.append(friction(RING, slip, sign))
            errors.append([error + ROUNDING] * 3)
    return Claim(
        CLOSED,
        equation="(20)",
        engine="theory",
        predicted=predicted,
        measured=measured,
        budget=ErrorBudget(errors, resolution=1e-10),
        parameters=PARAMETERS,
        source=SOURCE,
        note=f"F_x, F_y over μN and M over μN·R, for {at_each('U/W', COMPARED)}, with ω − φ̇ > 0, then < 0. "
        "Predicted: adaptive quadrature, whose own estimate is the error.",
    )


def expansion() -> tuple[FloatArray, tuple[Claim, Claim]]:
    """Return U/W and size of the greatest errors of (23) in force and in moment, shape (2, 2), and the claims."""
    noise = 1e-11  # ten times what the quadrature is asked for

    def by_formulas(i: int) -> Callable[[float], float]:
        return lambda ratio: abs(float((friction(EXPANSION, ratio, 1.0) - friction(RING, ratio, 1.0))[i]))

    def by_integrals(i: int) -> Callable[[float], float]:
        return lambda ratio: abs(
            float((average_of_expansion(ratio, 1.0) - ring_by_quadrature(ratio, 1.0)[0])[i])
        )

    measured = np.array([top(by_formulas(i), noise) for i in (0, 2)])
    predicted = np.array([top(by_integrals(i), noise) for i in (0, 2)])
    how = (
        "Force, then moment. Predicted: the integral (20), and the same with the three terms of (22). Measured: "
        "the closed forms. Error: that of the quadrature"
    )
    return measured[:, :2], (
        Claim(
            SIZE,
            equation="(23)",
            engine="theory",
            predicted=predicted[:, 1],
            measured=measured[:, 1],
            budget=ErrorBudget(noise, resolution=1e-6),
            parameters=PARAMETERS,
            source=SOURCE,
            note=how + ".",
        ),
        Claim(
            WHERE,
            equation="(23)",
            engine="theory",
            predicted=predicted[:, 0],
            measured=measured[:, 0],
            budget=ErrorBudget(predicted[:, 2] + measured[:, 2], resolution=1e-3),
            parameters=PARAMETERS,
            source=SOURCE,
            note=how + ", and how well a top can be located with it. U/W.",
        ),
    )


def top(error: Callable[[float], float], noise: float) -> tuple[float, float, float]:
    """Return U/W where ``error`` is the largest, how large it is there, and the error of the place.

    On a parabola of curvature c, places within √(2·noise/c) of the top can't be told from it; nor does the search
    aim at better than 1e-6.
    """
    from scipy.optimize import minimize_scalar

    coarse = max(np.geomspace(1e-2, 1e2, 201).tolist(), key=error)
    found = minimize_scalar(
        lambda ratio: -error(ratio),
        bounds=(0.95 * coarse, 1.05 * coarse),
        method="bounded",
        options={"xatol": 1e-6},
    )
    place, h = float(found.x), 0.01 * coarse
    curvature = abs(error(place - h) - 2.0 * error(place) + error(place + h)) / h**2
    return place, -float(found.fun), math.sqrt(2.0 * noise / curvature) + 1e-6


def greatest_errors_of_points() -> tuple[FloatArray, tuple[Claim, Claim]]:
    """Return U/W and size of the greatest errors of points, in force and in moment, and the claims.

    The array has the shape (numbers of points, 2, 2).
    """
    found = np.array([[worst(number, part) for part in (slice(2), slice(2, 3))] for number in NUMBERS])
    predicted = [[1.0 / n + 2.0 / math.pi - 1.0 / (n * math.tan(0.5 * math.pi / n))] * 2 for n in NUMBERS]
    how = (
        f"Force, then moment, for {at_each('n', NUMBERS)}. Found on a grid over U/W = 1/20 … 20 and φ that is "
        "refined about its best place again and again"
    )
    return found[:, :, :2], (
        Claim(
            WORST,
            equation="(21)",
            engine="theory",
            predicted=predicted,
            measured=found[:, :, 1],
            budget=ErrorBudget(found[:, :, 2], resolution=1e-3),
            parameters=PARAMETERS,
            source=SOURCE,
            note="Predicted: the point that is about to rest has its full share of friction, in the direction that "
            f"hurts the most, and the others are a sum of sines at U = W. {how}. Error: twice the last step.",
        ),
        Claim(
            AT_REST,
            equation="(21)",
            engine="theory",
            predicted=np.ones(found.shape[:2]),
            measured=found[:, :, 0],
            budget=ErrorBudget(found[:, :, 3], resolution=1e-3),
            parameters=PARAMETERS,
            source=SOURCE,
            note=f"U/W. {how}. Error: twice the last change of the place.",
        ),
    )


def worst(number: int, part: slice) -> tuple[float, float, float, float]:
    """Return where the error of ``number`` points is the largest, its size, and the errors of size and place.

    The place is U/W; ``part`` selects force or moment. The largest error is next to a jump, so that a search must not
    use slopes.
    """
    law = PointsOnRing(R, number)
    centre, spans, history = np.zeros(2), np.array((math.log(20.0), math.pi / number)), []
    for _ in range(ZOOMS):
        grid = []
        for stretch in centre[0] + spans[0] * np.linspace(-1.0, 1.0, 17):
            ratio = math.exp(stretch)
            ring = friction(RING, ratio, 1.0)
            for angle in centre[1] + spans[1] * np.linspace(-1.0, 1.0, 17):
                distance = float(np.linalg.norm((friction(law, ratio, 1.0, angle) - ring)[part]))
                grid.append((distance, stretch, angle))
        size, *best = max(grid)
        centre = np.array(best)
        history.append((size, math.exp(centre[0])))
        spans *= 0.5
    (before, at), (size, place) = history[-2:]
    return place, size, 2.0 * abs(size - before) + ROUNDING, 2.0 * abs(place - at) + 2.0 * float(spans[0])


def convergence() -> tuple[Claim, Claim]:
    """Observe at which order force and moment of an annulus, and their slopes, converge."""
    # Gauss's rule on powers and logarithms has an error in even powers of 1/(n + ½).
    fineness = 1.0 / (np.array(RINGS) + 0.5)

    def claim(
        sentence: str, function: Callable[[Annulus, float, float], Sequence[float]], order: int
    ) -> Claim:
        observed = []
        for radius in RESTING:
            exact = np.array(function(Annulus(INNER, R, rings=100), radius, 1.0))
            found = np.array([function(Annulus(INNER, R, rings=n), radius, 1.0) for n in RINGS])
            errors = np.linalg.norm(found / exact - 1.0, axis=1)
            observed.append(observed_exponent(fineness, errors, next_term=2.0, noise=ROUNDING))
        exponents, numerical, model = np.array(observed).T
        return Claim(
            sentence,
            equation="",
            kind="order",
            engine="theory",
            predicted=np.full(len(RESTING), float(order)),
            measured=exponents,
            budget=ErrorBudget(numerical, model=float(np.max(model)), resolution=1.5),
            parameters=PARAMETERS | {"inner_radius": INNER},
            source=SOURCE,
            note=f"With {', '.join(map(str, RINGS))} rings on either side of the one with the point at rest, whose "
            f"{at_each('radius', RESTING)} m; against 100. Errors: scatter, and the change without a next term.",
        )

    return (
        claim(CONVERGES, Annulus.shares, ORDER),
        claim(SLOPES, Annulus.slopes, SLOPE_ORDER),
    )


def thin() -> Claim:
    """Observe how an annulus becomes a ring."""
    widths, slips = np.array(WIDTHS), (0.5 * R, 2.0 * R)
    observed = []
    for slip in slips:
        laws = [Annulus(R * (1.0 - width / 2.0), R * (1.0 + width / 2.0)) for width in WIDTHS]
        found = np.array([law.shares(slip, 1.0) for law in laws])
        errors = np.abs(found / np.array(RING.shares(slip, 1.0)) - 1.0)
        observed += [observed_exponent(widths, error, next_term=2.0, noise=ROUNDING) for error in errors.T]
    exponents, numerical, model = np.array(observed).T
    return Claim(
        THIN,
        equation="(20)",
        kind="order",
        engine="theory",
        predicted=np.full(len(exponents), 2.0),
        measured=exponents,
        budget=ErrorBudget(numerical, model=float(np.max(model)), resolution=0.1),
        parameters=PARAMETERS,
        source=SOURCE,
        note="Exponent with which the distance from the ring of the mean radius falls, of force and moment at "
        f"U = W/2, then at U = 2 W, for {at_each('width/R', WIDTHS)}. Errors: scatter, and the change without a "
        "next term.",
    )


def in_place() -> Claim:
    """Compare the moment of annuli that turn in place with the textbook."""
    predicted, measured = [], []
    for inner in (0.0, INNER):
        uniform = 2.0 / 3.0 * (R**3 - inner**3) / (R**2 - inner**2)
        predicted.append((uniform, 0.5 * (inner + R)))
        laws = (Annulus(inner, R), Annulus(inner, R, pressure=lambda radius: 1.0 / radius))
        measured.append([law.shares(0.0, 1.0).moment for law in laws])
    return Claim(
        IN_PLACE,
        equation="",
        engine="theory",
        predicted=predicted,
        measured=measured,
        budget=ErrorBudget(ROUNDING * R, resolution=1e-9),
        parameters=PARAMETERS | {"inner_radius": INNER},
        source=SOURCE,
        unit="m",
        note="M/μN of a full disc, and of an annulus from 2R/3 to R. Predicted: (2/3)(r₂³ − r₁³)/(r₂² − r₁²) under "
        "uniform pressure, (r₁ + r₂)/2 under one like 1/r. Error: rounding.",
    )


def curves() -> Data:
    """Return force along the slip and moment of all laws over U/W, of points the range over φ."""
    ratios = np.unique(np.concatenate((np.geomspace(0.05, 20.0, 241), 1.0 + np.linspace(-0.1, 0.1, 101))))
    data = {"ratio": ratios}
    for name, law in {"ring": RING, "expansion": EXPANSION, "annulus": Annulus(INNER, R)}.items():
        data[name] = np.array([friction(law, ratio, 1.0)[[0, 2]] for ratio in ratios]) * (-1.0, 1.0)
    data["expansion_error"] = np.abs(data["expansion"] - data["ring"])
    for number in NUMBERS:
        # A point rests at −π/2 if U = W.
        angles = -0.5 * math.pi + 2.0 * math.pi / number * np.arange(24) / 24
        points = PointsOnRing(R, number)
        found = np.array([[friction(points, ratio, 1.0, angle) for angle in angles] for ratio in ratios])
        exact = data["ring"][:, np.newaxis]
        data[f"points{number}"] = np.stack((found.min(axis=1), found.max(axis=1)))[:, :, [0, 2]] * (-1.0, 1.0)
        off = (
            np.hypot(found[:, :, 0] + exact[:, :, 0], found[:, :, 1]),
            np.abs(found[:, :, 2] - exact[:, :, 1]),
        )
        data[f"points{number}_error"] = np.stack([distance.max(axis=1) for distance in off], axis=1)
    return data
