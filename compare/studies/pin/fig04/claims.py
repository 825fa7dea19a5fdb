"""Fig. 4: the shift of the whirl by a small offset, eq. 18, and the exact first-order response."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from compare.claims.claim import Claim, ErrorBudget
from compare.claims.error_estimates import refined
from compare.claims.paper_parameters import FIG4
from compare.claims.parameters import parameters_of
from compare.claims.study import Data, Findings, Study
from compare.engines import Engine
from compare.figures import BLACK, GREY, axis, curve, engines_in, new_figure, points
from reference_model import Orbit, PinOnDisc, whirl_orbit
from reference_model.formulas.pin import (
    first_order_whirl_response,
    first_order_whirl_shift,
    third_order_of_whirl_shift,
    whirl_radius,
    whirl_shift,
    whirl_shift_error_limit,
)
from reference_model.systems import FloatArray

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SPEEDS = (1.15, 1.2, 1.25, 1.3, 1.4, 1.5, 1.7, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0)
"""ω in rad/s. The paper does not print its range; below 1.15 this whirl is about to end in a fold."""

CLAIM_SPEEDS = (1.2, 1.5, 3.0)

OFFSETS = (0.02, 0.01, 0.005)
"""X0 in m for the orders, far below the whirl's radius of 1.2 m."""

SHOOTING = 1e-9
"""Tolerance handed to the engine when an orbit is shot for."""

SOURCE = "Fig. 4; ω is its axis, printed without a range"

EQ18 = "(18) gives the shift of the whirl to the error that theory gives it"
RESPONSE = "Shift and second harmonic of the whirl tend to the exact first-order response as X0 → 0"
ORDER = "The error of the exact first-order response of the whirl falls like X0³"
LIMIT = "The relative error of (18) tends to its theoretical limit as X0 → 0"


def measure(
    engine: Engine, speeds: Sequence[float] = SPEEDS, claim_speeds: Sequence[float] = CLAIM_SPEEDS
) -> Findings:
    """Find the whirl for every ω and for falling offsets; compare its mean with both formulas.

    ``speeds`` are ω in rad/s, increasing; ``claim_speeds`` are those among them that claims are made for.
    """
    over_speed = np.array(_harmonics_over_speed(engine, speeds))[..., :2]  # (speed, value or error, x or y)
    claims = [_claim_of_eq18(engine, over_speed[speeds.index(speed)], speed) for speed in claim_speeds]
    data = {"speeds": np.array(speeds), "means": over_speed[:, 0]}
    for speed in claim_speeds:
        pins = [replace(FIG4, disc_speed=speed, offset=offset) for offset in OFFSETS]
        by_offset = np.array([_harmonics(engine, pin) for pin in pins])  # (offset, value or error, 4)
        claims.append(_claim_of_response(engine, pins, by_offset[:, 0], by_offset[:, 1]))
        means = by_offset[..., :2]
        claims += _claims_of_orders(engine, pins, means[:, 0], means[:, 1])
        data[f"means at {speed:g}"] = means[:, 0]
    return Findings(tuple(claims), data)


def theory() -> Findings:
    """Return both formulas over ω."""
    speeds = np.geomspace(1.08, 5.0, 200)
    pins = [replace(FIG4, disc_speed=float(speed)) for speed in speeds]
    return Findings(
        data={
            "speeds": speeds,
            "eq18": np.array([whirl_shift(pin) for pin in pins]),
            "first order": np.array([first_order_whirl_shift(pin) for pin in pins]),
        }
    )


def _harmonics_over_speed(engine: Engine, speeds: Sequence[float]) -> list[tuple[FloatArray, FloatArray]]:
    """Return ``_harmonics`` for ``speeds``, following the branch from high speed down."""
    found, guess = [], None
    for speed in reversed(speeds):
        pin = replace(FIG4, disc_speed=speed)
        guess = _orbit(engine, pin, SHOOTING, guess)
        found.append(_harmonics(engine, pin, guess))
    return found[::-1]


def _orbit(engine: Engine, pin: PinOnDisc, tolerance: float, guess: Orbit | None) -> Orbit:
    return whirl_orbit(pin, simulate=engine.simulate, tolerance=tolerance, guess=guess, samples=64)


def _harmonics(engine: Engine, pin: PinOnDisc, guess: Orbit | None = None) -> tuple[FloatArray, FloatArray]:
    """Return mean and second harmonic of x + iy over a whirl in m, and their errors; both of shape (4,).

    The second harmonic is that of a time at which the first one is real.
    """
    guess = guess or _orbit(engine, pin, SHOOTING, None)

    def harmonics(tolerance: float) -> FloatArray:
        orbit = _orbit(engine, pin, tolerance, guess)
        x, y = orbit.trajectory.states[:-1, :2].T
        _, first, second = (np.fft.fft(x + 1j * y) / len(x))[:3]
        second *= (np.conj(first) / abs(first)) ** 2
        return np.array([*orbit.mean, second.real, second.imag])

    found, error = refined(harmonics, SHOOTING)
    # A miss of the orbit shifts its mean by about as much.
    return found, error + guess.residual * float(np.max(np.abs(guess.state)))


def _claim_of_eq18(engine: Engine, mean_and_error: FloatArray, speed: float) -> Claim:
    """Eq. 18 as printed, within what theory says of its error."""
    pin = replace(FIG4, disc_speed=speed)
    mean, error = mean_and_error
    return Claim(
        f"{EQ18}, ω = {speed:g}",
        equation="(18)",
        engine=engine.name,
        predicted=np.array(whirl_shift(pin)),
        measured=mean,
        budget=ErrorBudget(error, model=error_of_eq18(pin), resolution=0.1 * pin.offset),
        parameters=parameters_of(pin),
        source=SOURCE,
        unit="m",
        note="Model error, in which there is neither a simulation nor (18) itself: the limit of its error for "
        "X0 → 0, and the third order in X0 with the geometric series of higher ones. It is "
        f"{100.0 * error_of_eq18(pin) / float(np.hypot(*first_order_whirl_shift(pin))):.2g} % of the shift.",
    )


def error_of_eq18(pin: PinOnDisc) -> float:
    """Return what (18) may be off by in m: the second harmonic, and all orders of X0 but the first.

    Orders follow each other like (X0·w/ρ_c)², w = ω/(ω − k): so much does the offset turn the slip.
    """
    turn = pin.offset / whirl_radius(pin) * pin.disc_speed / (pin.disc_speed - pin.natural_frequency)
    higher = abs(third_order_of_whirl_shift(pin)) / (1.0 - turn**2)
    return float(np.hypot(*first_order_whirl_shift(pin))) * (abs(whirl_shift_error_limit(pin)) + higher)


def _claim_of_response(
    engine: Engine, pins: list[PinOnDisc], harmonics: FloatArray, errors: FloatArray
) -> Claim:
    """Mean and second harmonic over X0, extrapolated to X0 = 0, beside the linear problem's solution."""
    pin = pins[-1]
    over_offset = harmonics / np.array(OFFSETS)[:, np.newaxis]
    coarser, extrapolated = over_offset[1:] + np.diff(over_offset, axis=0) / 3.0  # the next term is ~ X0²
    response = first_order_whirl_response(pin)
    parts = [
        response.mean.real,
        response.mean.imag,
        response.second_harmonic.real,
        response.second_harmonic.imag,
    ]
    return Claim(
        f"{RESPONSE}, ω = {pin.disc_speed:g}",
        equation="(10), (12)",
        engine=engine.name,
        predicted=np.array(parts) / pin.offset,
        measured=extrapolated,
        budget=ErrorBudget(
            2.0 * float(np.max(errors[1:])) / pin.offset,
            model=float(np.max(np.abs(extrapolated - coarser))),
            resolution=1e-4,
        ),
        parameters=parameters_of(pin),
        source=SOURCE + f"; X0 = {', '.join(f'{offset:g}' for offset in OFFSETS)} m",
        note="x and y of the mean, real and imaginary part of the second harmonic, all over X0 and extrapolated in "
        "X0²; model error: the change against the extrapolation from the two larger offsets.",
    )


def _claims_of_orders(
    engine: Engine, pins: list[PinOnDisc], means: FloatArray, errors: FloatArray
) -> tuple[Claim, Claim]:
    """Order of the error of the exact first-order response, and limit of the relative error of (18)."""
    pin = pins[-1]
    speed = pin.disc_speed
    gaps = np.array(
        [_complex(m) - complex(*first_order_whirl_shift(p)) for m, p in zip(means, pins, strict=True)]
    )
    noise = np.hypot(*errors.T) / np.abs(gaps)  # relative error of each gap
    orders = np.log2(np.abs(gaps[:-1] / gaps[1:]))
    # The error is a series in odd powers of X0, so the observed order tends to 3 like X0².
    order = orders[1] + (orders[1] - orders[0]) / 3.0
    order_claim = Claim(
        f"{ORDER}, ω = {speed:g}",
        equation="(18)",
        kind="order",
        engine=engine.name,
        predicted=3.0,
        measured=order,
        budget=ErrorBudget(
            float(noise[1] + noise[2]) / np.log(2.0),
            model=float(abs(orders[1] - orders[0])) / 3.0,
            resolution=0.05,
        ),
        parameters=parameters_of(pin),
        source=SOURCE + f"; X0 = {', '.join(f'{offset:g}' for offset in OFFSETS)} m",
        note=f"Observed orders {orders[0]:.4f} and {orders[1]:.4f}, extrapolated to X0 = 0; model error: the "
        "extrapolation's own step.",
    )
    limit = whirl_shift_error_limit(pin)
    relative = np.array(
        [complex(*whirl_shift(p)) / _complex(m) - 1.0 for m, p in zip(means, pins, strict=True)]
    )
    extrapolated = relative[2] + (relative[2] - relative[1]) / 3.0  # the next term is of the order X0²
    coarser = relative[1] + (relative[1] - relative[0]) / 3.0
    parts = np.array([extrapolated.real, extrapolated.imag])
    limit_claim = Claim(
        f"{LIMIT}, ω = {speed:g}",
        equation="(18)",
        engine=engine.name,
        predicted=np.array([limit.real, limit.imag]),
        measured=parts,
        budget=ErrorBudget(
            float(np.hypot(*errors[2])) / abs(_complex(means[2])) * 2.0,
            model=float(abs(extrapolated - coarser)),
            resolution=1e-3 * abs(limit),
        ),
        parameters=parameters_of(pin),
        source=SOURCE + f"; X0 = {', '.join(f'{offset:g}' for offset in OFFSETS)} m",
        note="Real and imaginary part of (x+iy) of (18) over the measured one, less 1, extrapolated in X0²; "
        "model error: the change against the extrapolation from the two larger offsets.",
        implied_by=order_claim.sentence,
    )
    return order_claim, limit_claim


def _complex(point: FloatArray) -> complex:
    return complex(point[0], point[1])


def draw(data: Mapping[str, Data]) -> dict[str, Figure]:
    """Fig. 4 redrawn, and the errors of both formulas over the offset."""
    figure, (left, right) = new_figure(ncols=2)
    if "theory" in data:
        theory_data = data["theory"]
        for i, symbol in enumerate(("x_s", "y_s")):
            style = curve("theory", f"${symbol}$, eq. (18)", linestyle="-" if i == 0 else (0.0, (5.0, 2.0)))
            left.plot(theory_data["speeds"], theory_data["eq18"][:, i], **style)
        exact = curve("theory", "exact first order", color=GREY, linestyle=(0.0, (1.0, 1.5)), linewidth=1.4)
        left.plot(theory_data["speeds"], theory_data["first order"], **exact)
    for engine in engines_in(data):
        left.plot(data[engine]["speeds"], data[engine]["means"], **points(engine))
    handles, labels = left.get_legend_handles_labels()
    unique = dict(zip(labels, handles, strict=True))
    left.legend(unique.values(), unique.keys())
    left.set(xlabel=axis(r"\omega", "rad/s"), ylabel=axis("x_s,\\ y_s", "m"), ylim=(0.0, None))

    for engine in engines_in(data):
        for speed, marker in zip(CLAIM_SPEEDS, "os^", strict=True):
            if f"means at {speed:g}" not in data[engine]:
                continue
            means = data[engine][f"means at {speed:g}"]
            for formula, dashes in ((whirl_shift, "-"), (first_order_whirl_shift, (0.0, (1.0, 1.5)))):
                gap = [
                    np.hypot(*(mean - formula(replace(FIG4, disc_speed=speed, offset=offset))))
                    for mean, offset in zip(means, OFFSETS, strict=True)
                ]
                size = 7.0 if engine == "reference" else 3.5
                style = points(engine, "", marker=marker, markersize=size, linestyle=dashes, linewidth=0.8)
                right.loglog(OFFSETS, gap, **style)
    for speed, marker in zip(CLAIM_SPEEDS, "os^", strict=True):
        right.plot(
            [], [], ls="none", marker=marker, mfc="none", color=BLACK, label=f"$\\omega$ = {speed:g} rad/s"
        )
    right.plot([], [], color=BLACK, lw=0.8, label=r"from (18), $\propto X_0$")
    right.plot(
        [],
        [],
        color=BLACK,
        lw=0.8,
        ls=(0.0, (1.0, 1.5)),
        label=r"from the exact first order, $\propto X_0^3$",
    )
    right.set_xticks(OFFSETS, [f"{offset:g}" for offset in OFFSETS])
    right.minorticks_off()
    right.legend(loc="upper center", bbox_to_anchor=(0.5, -0.18), ncols=2)
    right.set(xlabel=axis("X_0", "m"), ylabel="distance of the mean in m")
    return {"fig04-shift": figure}


STUDY = Study(
    name="fig04",
    title="Shift of the whirl by a small offset",
    section="The friction pin",
    paper="With a small offset X0 the whirl is approximately a circle whose centre is shifted from the axis "
    "by x_s, y_s of (18), found by balancing first harmonics. Fig. 4 compares it with simulations over ω. The "
    "offset also excites a second harmonic of the same first order, so (18) keeps a relative error however "
    "small X0 is; the exact first-order response is a linear 2×2 problem. Theory gives the limit of that error, and "
    "the third order of the shift: within both (18) must hold.",
    by_hand=measure,
    draw=draw,
    theory=theory,
    figures={
        "fig04-shift": "Left: Fig. 4 redrawn, the time mean of the whirl over ω: (18) as printed, the exact "
        "first-order response, and the periodic orbits that the engines found by shooting. Right: distance "
        "of the orbits' means from both formulas over the offset; large marks: reference, small ones: other "
        "engines."
    },
    seconds=3.0,
    quick=True,
)
