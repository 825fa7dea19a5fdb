"""Fig. 4: the shift of the whirl by a small offset, (18), and the exact first-order response."""

import functools
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from compare.claims import WORKING, ByEngine, Data, Figures, Measured, Measurement, Study, refined
from compare.claims.parameters import FIG4
from compare.engines import Engine
from compare.output.figures import BLACK, GREY, Axes, axis, curve, engines_in, new_figure, points
from compare.studies.toolkit.pins import whirl_of
from reference_model import Orbit, PinOnDisc
from reference_model.formulas import pin as formulas
from reference_model.formulas.pin import first_order_whirl_response, first_order_whirl_shift, whirl_shift
from reference_model.systems import FloatArray

SPEEDS = (1.15, 1.2, 1.25, 1.3, 1.4, 1.5, 1.7, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0)
"""ω in rad/s, which the paper omits; below 1.15 rad/s this whirl is close to its fold."""

CLAIM_SPEEDS = (1.2, 1.5, 3.0)  # ω in rad/s

OFFSETS = (0.02, 0.01, 0.005)
"""X0 in m, each half of the previous value and far below the whirl's radius of 1.2 m."""

SHIFT_TOLERANCE = 1e3 * WORKING  # loose, because (18) has an error of a few per cent

SOURCE = "Fig. 4; ω is its axis, printed without a range"
SOURCE_OF_OFFSETS = f"{SOURCE}; X0 = {', '.join(f'{offset:g}' for offset in OFFSETS)} m"


def pin_at(speed: float, offset: float = FIG4.offset) -> PinOnDisc:
    return replace(FIG4, disc_speed=float(speed), offset=offset)


def curves() -> Data:
    speeds = np.geomspace(1.08, 5.0, 200)
    return {
        "speeds": speeds,
        "eq18": np.array([whirl_shift(pin_at(speed)) for speed in speeds]),
        "first order": np.array([first_order_whirl_shift(pin_at(speed)) for speed in speeds]),
    }


def error_of_eq18(pin: PinOnDisc) -> float:
    """Return a bound of the error of (18) in m: the second harmonic, and all orders of X0 except the first.

    Successive orders have the ratio (X0·w/ρ_c)² with w = ω/(ω − k).
    """
    turn = pin.offset / formulas.whirl_radius(pin) * pin.disc_speed / (pin.disc_speed - pin.natural_frequency)
    higher = abs(formulas.third_order_of_whirl_shift(pin)) / (1.0 - turn**2)
    share = abs(formulas.whirl_shift_error_limit(pin)) + higher
    return float(np.hypot(*first_order_whirl_shift(pin))) * share


STUDY = Study.beside(__file__, "fig04", source=SOURCE, seconds=1.5, quick=True)

AT_SPEEDS = {f"{speed:g}": speed for speed in CLAIM_SPEEDS}


@STUDY.claim(
    "The shift of the whirl equals (18) within its theoretical error, ω = {}",
    equation="(18)",
    unit="m",
    note="The model error uses neither a simulation nor (18) itself. It is the limit of the relative error of (18) "
    "for X0 → 0, plus the third order in X0 with the geometric series of higher orders.",
    each=AT_SPEEDS,
    friction=False,
)
def shift(engine: Engine, speed: float, speeds: Sequence[float] = SPEEDS) -> Measured:
    pin = pin_at(speed)
    means = over_speed(engine, speeds)
    share = 100.0 * error_of_eq18(pin) / float(np.hypot(*first_order_whirl_shift(pin)))
    return Measured(
        predicted=whirl_shift(pin),
        value=means.value[speeds.index(speed)],
        error=means.error[speeds.index(speed)],
        model=error_of_eq18(pin),
        resolution=0.1 * pin.offset,
        components=("x", "y"),
        system=pin,
        note=f"The model error is {share:.2g} % of the shift.",
        data={"speeds": speeds, "means": means.value},
    )


@STUDY.claim(
    "The shift and the second harmonic of the whirl tend to the exact first-order response as X0 → 0, ω = {}",
    equation="(10), (12)",
    resolution=1e-4,
    note="All values are divided by X0 and extrapolated in X0². Model error: the change from the extrapolation by "
    "the two larger offsets.",
    each=AT_SPEEDS,
    friction=False,
    duration=800.0,
)
def response(engine: Engine, speed: float) -> Measured:
    pin = pin_at(speed, OFFSETS[-1])
    found = over_offset(engine, speed)
    coarser, extrapolated = towards_zero(found.value / np.array(OFFSETS)[:, np.newaxis])
    mean, second = first_order_whirl_response(pin)
    return Measured(
        predicted=np.array([mean.real, mean.imag, second.real, second.imag]) / pin.offset,
        value=extrapolated,
        error=2.0 * float(np.max(found.error[1:])) / pin.offset,
        model=float(np.max(np.abs(extrapolated - coarser))),
        components=("mean x", "mean y", "real part of the second harmonic", "its imaginary part"),
        system=pin,
        source=SOURCE_OF_OFFSETS,
    )


@STUDY.claim(
    "The error of the exact first-order response of the whirl falls like X0³, ω = {}",
    equation="(18)",
    kind="order",
    resolution=0.05,
    each=AT_SPEEDS,
    friction=False,
    duration=800.0,
)
def order(engine: Engine, speed: float) -> Measured:
    means = over_offset(engine, speed)
    exact = [complex(*first_order_whirl_shift(pin_at(speed, offset))) for offset in OFFSETS]
    gaps = means.value[:, 0] + 1j * means.value[:, 1] - exact
    noise = np.hypot(*means.error[:, :2].T) / np.abs(gaps)  # relative
    orders = np.log2(np.abs(gaps[:-1] / gaps[1:]))
    # The error is a series in odd powers of X0, so the observed order tends to 3 like X0².
    (extrapolated,) = towards_zero(orders)
    return Measured(
        predicted=3.0,
        value=extrapolated,
        error=float(noise[1] + noise[2]) / np.log(2.0),
        model=float(abs(orders[1] - orders[0])) / 3.0,
        note=f"Observed orders {orders[0]:.4f} and {orders[1]:.4f}, extrapolated to X0 = 0. Model error: the change "
        "due to extrapolation.",
        data={f"means at {speed:g}": means.value[:, :2]},
        system=pin_at(speed, OFFSETS[-1]),
        source=SOURCE_OF_OFFSETS,
    )


@STUDY.claim(
    "The relative error of (18) tends to its theoretical limit as X0 → 0, ω = {}",
    equation="(18)",
    note="(x + iy) of (18) over the measured one, minus 1, extrapolated in X0². Model error: the change from the "
    "extrapolation by the two larger offsets.",
    implied_by=order,
    each=AT_SPEEDS,
    friction=False,
    duration=800.0,
)
def limit(engine: Engine, speed: float) -> Measured:
    pin = pin_at(speed, OFFSETS[-1])
    means = over_offset(engine, speed)
    measured = means.value[:, 0] + 1j * means.value[:, 1]
    shifts = [complex(*whirl_shift(pin_at(speed, offset))) for offset in OFFSETS]
    relative = np.array([shift / mean - 1.0 for shift, mean in zip(shifts, measured.tolist(), strict=True)])
    coarser, extrapolated = towards_zero(relative)
    predicted = formulas.whirl_shift_error_limit(pin)
    return Measured(
        predicted=[predicted.real, predicted.imag],
        value=[extrapolated.real, extrapolated.imag],
        error=float(np.hypot(*means.error[2, :2])) / abs(measured[2]) * 2.0,
        model=float(abs(extrapolated - coarser)),
        resolution=1e-3 * abs(predicted),
        components=("real part", "imaginary part"),
        system=pin,
        source=SOURCE_OF_OFFSETS,
    )


def towards_zero(values: FloatArray) -> FloatArray:
    """Return the limits of ``values``, shape (n, ...), at successively halved offsets, from pairs of neighbours.

    The next term is of the order X0².
    """
    return np.asarray(values[1:] + np.diff(values, axis=0) / 3.0)


@functools.lru_cache(maxsize=2)
def over_speed(engine: Engine, speeds: Sequence[float]) -> Measurement:
    """Return the means of the whirls (m), shape (n, 2), on the branch from high to low speed."""
    found, guess = [], None
    for speed in reversed(speeds):
        guess = whirl_of(engine, pin_at(speed), SHIFT_TOLERANCE, guess)
        found.append(harmonics(engine, pin_at(speed), SHIFT_TOLERANCE, guess))
    return Measurement(*(np.array(each)[::-1, :2] for each in zip(*found, strict=True)))


@functools.lru_cache(maxsize=len(CLAIM_SPEEDS))
def over_offset(engine: Engine, speed: float) -> Measurement:
    found = [harmonics(engine, pin_at(speed, offset), WORKING) for offset in OFFSETS]
    return Measurement(*(np.array(each) for each in zip(*found, strict=True)))


def harmonics(engine: Engine, pin: PinOnDisc, tolerance: float, guess: Orbit | None = None) -> Measurement:
    """Return mean and second harmonic of x + iy over a whirl (m), shape (4,).

    The phase of the second harmonic refers to a time when the first harmonic is real.
    """
    first_orbit = guess or whirl_of(engine, pin, tolerance)

    def found(tolerance: float) -> FloatArray:
        orbit = whirl_of(engine, pin, tolerance, first_orbit)
        x, y = orbit.trajectory.states[:-1, :2].T
        _, first, second = (np.fft.fft(x + 1j * y) / len(x))[:3]
        second *= (np.conj(first) / abs(first)) ** 2
        return np.array([*orbit.mean, second.real, second.imag])

    # A residual of the orbit shifts its mean by about the same amount.
    return refined(found, tolerance).plus(first_orbit.residual * float(np.max(np.abs(first_orbit.state))))


DOTTED = (0.0, (1.0, 1.5))
FORMULAS: tuple[tuple[Callable[[PinOnDisc], tuple[float, float]], Any], ...] = (
    (whirl_shift, "-"),
    (first_order_whirl_shift, DOTTED),
)
MARKERS = dict(zip(CLAIM_SPEEDS, "os^", strict=True))


def draw(data: ByEngine) -> Figures:
    figure, (left, right) = new_figure(ncols=2)
    _draw_shift(left, data)
    _draw_gaps(right, data)
    return {"fig04-shift": figure}


def _draw_shift(panel: Axes, data: ByEngine) -> None:
    if "theory" in data:
        theory = data["theory"]
        for i, symbol in enumerate(("x_s", "y_s")):
            style = curve("theory", f"${symbol}$, eq. (18)", linestyle="-" if i == 0 else (0.0, (5.0, 2.0)))
            panel.plot(theory["speeds"], theory["eq18"][:, i], **style)
        exact = curve("theory", color=GREY, linestyle=DOTTED, linewidth=1.4)
        exact["label"] = ["exact first order", "_"]
        panel.plot(theory["speeds"], theory["first order"], **exact)
    for engine in engines_in(data):
        style = points(engine) | {"label": [engine, "_"]}
        panel.plot(data[engine]["speeds"], data[engine]["means"], **style)
    panel.legend()
    panel.set(xlabel=axis(r"\omega", "rad/s"), ylabel=axis("x_s,\\ y_s", "m"), ylim=(0.0, None))


def _draw_gaps(panel: Axes, data: ByEngine) -> None:
    for engine in engines_in(data):
        for speed, marker in MARKERS.items():
            if f"means at {speed:g}" not in data[engine]:
                continue
            means = data[engine][f"means at {speed:g}"]
            for formula, line in FORMULAS:
                expected = [formula(pin_at(speed, offset)) for offset in OFFSETS]
                gap = np.hypot(*(means - expected).T)
                size = 7.0 if engine == "reference" else 3.5
                style = points(engine, "", marker=marker, markersize=size, linestyle=line, linewidth=0.8)
                panel.loglog(OFFSETS, gap, **style)
    for speed, marker in MARKERS.items():
        label = f"$\\omega$ = {speed:g} rad/s"
        panel.plot([], [], ls="none", marker=marker, mfc="none", color=BLACK, label=label)
    labels = (r"from (18), $\propto X_0$", r"from the exact first order, $\propto X_0^3$")
    for (_, line), label in zip(FORMULAS, labels, strict=True):
        panel.plot([], [], color=BLACK, lw=0.8, ls=line, label=label)
    panel.set_xticks(OFFSETS, [f"{offset:g}" for offset in OFFSETS])
    panel.minorticks_off()
    panel.legend(loc="upper center", bbox_to_anchor=(0.5, -0.18), ncols=2)
    panel.set(xlabel=axis("X_0", "m"), ylabel="distance of the mean in m")


STUDY.provides(figures=draw, curves=curves)
