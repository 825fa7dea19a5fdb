"""Eqs. (12) to (16) over speed and damping, and motions near the whirl."""

import functools
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import expm

from compare.claims import WORKING, Measured, Measurement, Study, answers_of, refined
from compare.claims.linearised_flow import eigenvalues_with_rounding, matched, real_and_imaginary
from compare.claims.parameters import CENTRED
from compare.engines import Engine
from compare.studies.toolkit.deviations import PARTS, Rates, measured_rates, settled
from compare.studies.toolkit.measuring import compared
from reference_model.formulas import pin as formulas
from reference_model.formulas.pin import characteristic_coefficients, upper_branch_margin, whirl_radius
from reference_model.steady.stability import turning_frame_jacobian, whirl_eigenvalues
from reference_model.systems import FloatArray, PinOnDisc
from reference_model.trajectory import Trajectory

SOURCE = "Fig. 4 with X0 = 0, as (11)–(16) assume; the values of ω are our choice"
K = CENTRED.natural_frequency

SPEEDS = (1.1, 1.5, 4.0)
DISPLACED, DURATION, DELAY = 1.1, 460.0, 40.0
"""Long simulations: ω in rad/s, initial radius as a multiple of (11), duration in s, and its final part, which yields
the remaining transient. The slowest deviation falls to 1e-10.
"""

STARTS, CAUGHT = (0.5, 0.8, 0.9, 1.2, 1.5, 3.0), 18.0
"""Starts on the circle (11): ω in rad/s below and above k, and the time in s until a pin sticks if ω < k."""

POINTS = ((1.05, 0.1), (1.1, 0.1), (1.5, 0.1), (2.5, 0.1), (5.0, 0.1), (1.5, 0.5), (1.5, 2.0))
FLOW_DURATION = 0.5
"""Eigenvalues: ω in rad/s and β in N s/m, and duration in s."""

DEVIATION, DEVIATION_TIMES = 1e-3, np.linspace(0.0, 60.0, 301)
"""Amplitude of the decaying deviation as a share of the radius (11), and times in s."""

RATIOS = np.asarray((np.arange(225) + 0.5) / 75.0, dtype=float)
DAMPINGS = np.geomspace(0.03, 10.0, 121)
"""Values of ω/k, also below 1, and of β/(mk), for comparing (14) to (16) with eigenvalues."""


def pin_at(speed: float, damping: float = CENTRED.damping) -> PinOnDisc:
    return replace(CENTRED, disc_speed=speed, damping=damping)


def on_circle(pin: PinOnDisc, scale: float = 1.0) -> FloatArray:
    """Return the state on the circle (11), enlarged by ``scale``. For ω < k, the circle is not a motion."""
    radius = scale * pin.friction_force / (pin.damping * K)
    return np.array([radius, 0.0, 0.0, K * radius])


def linear_deviation(times: FloatArray) -> FloatArray:
    """Return ξ/a by (12), shape (n,), from the start ξ = a, ξ̇ = ka, η = 0."""
    step = expm(formulas.variational_matrix(CENTRED) * (times[1] - times[0]))
    states = [np.array([1.0, K, 0.0])]
    for _ in times[1:]:
        states.append(step @ states[-1])
    return np.array(states)[:, 0]


@functools.cache
def grid() -> tuple[PinOnDisc, ...]:
    return tuple(pin_at(K * ratio, CENTRED.mass * K * damping) for damping in DAMPINGS for ratio in RATIOS)


@functools.cache
def largest_real_parts() -> tuple[FloatArray, FloatArray]:
    """Return the largest real part (1/s) of the roots of (13) at each point of the grid, and its rounding error."""
    values, rounding = eigenvalues_with_rounding([formulas.variational_matrix(pin) for pin in grid()])
    at = np.arange(len(values)), np.argmax(values.real, axis=1)
    return values.real[at], rounding[at]


STUDY = Study.beside(
    __file__, "whirl-stability", source=SOURCE, system=CENTRED, seconds=2.5, quick=True, contact=True
)


@STUDY.claim(
    "The corrected (13), the matrix of (12) and the Jacobian of (1) have the same eigenvalues",
    equation="(12), (13)",
    unit="1/s",
    resolution=1e-9 * K,
    note="All three eigenvalues of (12), and all four of the Jacobian in the frame that turns with the whirl, "
    "including the zero of the phase. Error: rounding, from the condition number of each eigenvalue.",
    swept=("disc_speed", "damping"),
)
def same_eigenvalues() -> Measured:
    pins = [
        pin_at(float(speed), float(damping))
        for speed in K * (1.0 + np.geomspace(0.02, 9.0, 15))
        for damping in np.geomspace(0.03, 3.0, 9)
    ]
    companion = np.zeros((len(pins), 3, 3))
    companion[:, 1:, :2] = np.eye(2)
    companion[:, :, 2] = [[-value for value in characteristic_coefficients(pin)[:0:-1]] for pin in pins]
    roots, roots_error = eigenvalues_with_rounding(companion)
    of_12, of_12_error = eigenvalues_with_rounding([formulas.variational_matrix(pin) for pin in pins])
    of_1, of_1_error = eigenvalues_with_rounding([turning_frame_jacobian(pin) for pin in pins])
    predicted = [[*own, *matched([0.0, *own], to=of)] for own, of in zip(roots, of_1, strict=True)]
    measured = [[*matched(one, to=own), *of] for one, own, of in zip(of_12, roots, of_1, strict=True)]
    errors = roots_error.max(axis=1) + np.maximum(of_12_error.max(axis=1), of_1_error.max(axis=1))
    numbers = real_and_imaginary(measured)
    return Measured(
        predicted=real_and_imaginary(predicted),
        value=numbers,
        error=np.broadcast_to(errors[:, np.newaxis, np.newaxis], numbers.shape),
        components=PARTS,
        source="Fig. 4 with X0 = 0; a grid of ω/k = 1.02 … 10 and β = 0.03 … 3 N s/m",
    )


def counted(margins: ArrayLike, errors: ArrayLike = 0.0) -> Measured:
    """Return the answers for all points of the grid; one in a thousand may be open."""
    return answers_of(
        margins,
        errors,
        may_be_open=len(DAMPINGS) * len(RATIOS) // 1000,
        source=f"assumption: a grid of {len(RATIOS)} values of ω/k = {RATIOS[0]:g} … {RATIOS[-1]:g} and "
        f"{len(DAMPINGS)} of β/(mk) = {DAMPINGS[0]:g} … {DAMPINGS[-1]:g}",
    )


def holds(margin: Callable[[PinOnDisc], float]) -> NDArray[np.bool_]:
    return np.array([margin(pin) > 0.0 for pin in grid()])


def margin_of_14(pin: PinOnDisc) -> float:
    return min(formulas.coefficient_margins(pin))


@STUDY.claim(
    "All roots of (13) have negative real parts exactly where (16) holds",
    equation="(16)",
    note="Do the condition and the eigenvalues of (12) agree at each grid point? Rounding may leave one point "
    "in a thousand undecided. Below k, this only concerns the matrix, because no whirl exists there.",
    swept=("disc_speed", "damping"),
)
def hurwitz() -> Measured:
    largest, error = largest_real_parts()
    return counted(np.where(holds(upper_branch_margin), -largest, largest), error)


@STUDY.claim(
    "Where (16) holds, (14) holds too",
    equation="(14), (16)",
    note="At each grid point. With q = 4k²m²/β² the bound of (16) is −q/(1 + q + √(1 + q²)), which is above −1 and "
    "above −q.",
    swept=("disc_speed", "damping"),
)
def implied() -> Measured:
    return counted(~holds(upper_branch_margin) | holds(margin_of_14))


@STUDY.claim(
    "(14) and (15) never hold together",
    equation="(14), (15)",
    note="At each grid point. With q = 4k²m²/β² the bound of (15) is −(1 + q + √(1 + q²))/2, which is below "
    "−min(1, q), where (14) fails.",
    swept=("disc_speed", "damping"),
)
def incompatible() -> Measured:
    return counted(~(holds(margin_of_14) & holds(formulas.lower_branch_margin)))


SETTLING = (
    f"Starts on a circle {DISPLACED:g} times as large; state after {DURATION:g} s. Error: the change at a smaller "
    f"tolerance, and the remaining transient, judged by its change in the last {DELAY:g} s."
)


def turning_speed(states: FloatArray) -> FloatArray:
    """Return ψ̇ (rad/s), shape (...), of ``states``, shape (..., 4)."""
    x, y, vx, vy = np.moveaxis(states, -1, 0)
    return np.asarray((x * vy - y * vx) / (x**2 + y**2))


@functools.lru_cache(maxsize=2)
def whirls(engine: Engine, speeds: Sequence[float]) -> Measurement:
    """Return radius (m) and frequency (rad/s) at the end of long simulations, shape (n, 2)."""

    def track(speed: float, times: list[float], tolerance: float) -> FloatArray:
        pin = pin_at(speed)
        run = engine.simulate(pin, on_circle(pin, DISPLACED), times, tolerance=tolerance)
        return np.column_stack((run.radius, turning_speed(run.states)))[1:]

    ends = [
        settled(
            functools.partial(track, speed),
            duration=DURATION,
            delay=DELAY,
            period=np.pi / K,  # approximate period of deviations in the rotating axes
            rate=-whirl_eigenvalues(pin_at(speed))[1].real,
            tolerance=WORKING / 5,  # for a resolution of 1e-9
        )
        for speed in speeds
    ]
    value, error, left = map(np.array, zip(*ends, strict=True))
    return Measurement(value, error + left)


@STUDY.claim(
    "A pin that starts near the whirl approaches its radius μN/(βk) if ω > k",
    equation="(11)",
    unit="m",
    resolution=1e-9 * whirl_radius(CENTRED),
    note=SETTLING,
    swept=("disc_speed",),
    duration=1.3e4,
)
def radius(engine: Engine, speeds: Sequence[float] = SPEEDS) -> Measured:
    return _at_end(engine, speeds, 0, whirl_radius(CENTRED))


@STUDY.claim(
    "A pin that starts near the whirl approaches its frequency k if ω > k",
    equation="(11)",
    unit="rad/s",
    resolution=1e-9 * K,
    note=SETTLING,
    friction=False,
    swept=("disc_speed",),
    duration=1.3e4,
)
def frequency(engine: Engine, speeds: Sequence[float] = SPEEDS) -> Measured:
    return _at_end(engine, speeds, 1, K)


def _at_end(engine: Engine, speeds: Sequence[float], which: int, predicted: float) -> Measured:
    found = whirls(engine, speeds)
    return Measured(
        predicted=np.full(len(speeds), predicted),
        value=found.value[:, which],
        error=found.error[:, which],
        at={"ω in rad/s": speeds},
    )


@STUDY.claim(
    "On the circle (11), friction and damping cancel if ω > k, and brake equally if ω < k",
    equation="(11)",
    resolution=1e-5,
    note="Rate of change of the angular momentum over μN·ρ_c, from a one-sided difference. By (10) this rate "
    "is sign(ω − k) − 1. According to the paper, (11) always exists: see the errata. Error: the change at "
    "a smaller "
    "tolerance and at a larger interval.",
    swept=("disc_speed",),
)
def balance(engine: Engine, starts: Sequence[float] = STARTS) -> Measured | None:
    if engine.contact_only:
        return None
    interval = 0.01  # s
    fourth_order = np.array([-25.0, 48.0, -36.0, 16.0, -3.0]) / 12.0
    pins = [pin_at(speed) for speed in starts]

    def rates_of(step: float, tolerance: float) -> FloatArray:
        motions = [(pin, on_circle(pin), step * np.arange(5)) for pin in pins]
        found = []
        for pin, run in zip(pins, engine.simulate_many(motions, tolerance=tolerance), strict=True):
            x, y, vx, vy = run.states.T
            moment = fourth_order @ (pin.mass * (x * vy - y * vx)) / step
            found.append(moment / (pin.friction_force * on_circle(pin)[0]))
        return np.array(found)

    found = refined(functools.partial(rates_of, interval), WORKING)
    wide = np.abs(rates_of(2.0 * interval, WORKING) - found.value)
    rounding = 8.0 * np.finfo(float).eps * CENTRED.mass * K / (CENTRED.damping * interval)
    return compared(
        [0.0 if speed > K else -2.0 for speed in starts],
        found,
        error=np.full(len(starts), found.largest + np.max(wide) + rounding),
        at={"ω in rad/s": starts},
    )


@STUDY.claim(
    "If ω < k, a pin that starts on the circle (11) leaves it and finally turns with the disc",
    equation="(11)",
    resolution=1e-3,
    note=f"Angular speed of the pin after {CAUGHT:g} s, over ω.",
    swept=("disc_speed",),
)
def caught(engine: Engine, starts: Sequence[float] = STARTS) -> Measured | None:
    if engine.contact_only:
        return None

    def leave(speed: float, times: ArrayLike, tolerance: float) -> Trajectory:
        return engine.simulate(pin_at(speed), on_circle(pin_at(speed)), times, tolerance=tolerance)

    below, both = [speed for speed in starts if speed < K], [0.0, CAUGHT]
    found = refined(
        lambda tolerance: [turning_speed(leave(one, both, tolerance).at_end) / one for one in below], 1e-7
    )

    def data() -> dict[str, ArrayLike]:
        times = np.linspace(0.0, CAUGHT, 181)
        leaving = [leave(speed, times, 1e-7).radius for speed in starts]
        return {"start": starts, "leaving_time": times, "leaving": leaving}

    return compared(
        np.ones(len(below)),
        found,
        error=np.full(len(below), found.largest),
        at={"ω in rad/s": below},
        data=data,
    )


@functools.lru_cache(maxsize=2)
def rates(engine: Engine, points: Sequence[tuple[float, float]]) -> Rates:
    pins = [pin_at(*point) for point in points]
    motions, predicted = [(pin, on_circle(pin)) for pin in pins], map(whirl_eigenvalues, pins)
    return measured_rates(engine, motions, predicted, duration=FLOW_DURATION, frame_speed=K)


@STUDY.claim(
    "Small deviations from the whirl evolve with the eigenvalues of (12), plus a zero for the phase",
    equation="(12)",
    unit="1/s",
    resolution=1e-6 * K,
    note=f"Central differences of the motion over {FLOW_DURATION:g} s, in the frame that turns with the whirl, "
    "extrapolated to zero. Error: the change with larger differences, and at a smaller tolerance.",
    swept=("disc_speed", "damping"),
    duration=2.7e3,
)
def eigenvalues(engine: Engine, points: Sequence[tuple[float, float]] = POINTS) -> Measured | None:
    if engine.contact_only:
        return None
    found = rates(engine, points)
    return found.compared(
        {"(ω, β)": [f"({speed:g} rad/s, {damping:g} N s/m)" for speed, damping in points]},
        source=f"{SOURCE}; β too if it is not {CENTRED.damping:g}",
        data={"point": points, "eigenvalue": real_and_imaginary(found.measured)},
    )


@STUDY.claim(
    "The whirl is stable if ω > k",
    equation="(16)",
    note="Is the real part of each measured eigenvalue negative, except for the eigenvalue of the phase?",
    friction=False,
    implied_by=eigenvalues,
    swept=("disc_speed", "damping"),
    duration=2.7e3,
)
def stable(engine: Engine, points: Sequence[tuple[float, float]] = POINTS) -> Measured | None:
    if engine.contact_only:
        return None
    return rates(engine, points).decaying(but=1, source=f"{SOURCE}; β too if it is not {CENTRED.damping:g}")


@STUDY.claim(
    "A small deviation of the radius decays as the linear equations (12) predict",
    equation="(12)",
    resolution=1e-4,
    note=f"Starts with ξ = ±a, ξ̇ = ±ka, η = 0 and a = {DEVIATION:g}·ρ_c; half the difference of the radii over a. "
    "Model error: the change at twice the amplitude a, which is three times the next order of the deviation.",
    duration=2e3,
)
def history(engine: Engine) -> Measured | None:
    if engine.contact_only:
        return None
    circle = whirl_radius(CENTRED)
    shift = np.array([circle, 0.0, K * circle, K * circle])

    def deviation(amplitude: float, tolerance: float) -> FloatArray:
        starts = (on_circle(CENTRED) + sign * amplitude * shift for sign in (1.0, -1.0))
        motions = [(CENTRED, start, DEVIATION_TIMES) for start in starts]
        outwards, inwards = (run.radius for run in engine.simulate_many(motions, tolerance=tolerance))
        return np.asarray((outwards - inwards) / (2.0 * amplitude * circle))

    found = refined(functools.partial(deviation, DEVIATION), WORKING / 10)
    twice = deviation(2.0 * DEVIATION, WORKING / 10)
    return compared(
        linear_deviation(DEVIATION_TIMES),
        found,
        error=np.full(len(DEVIATION_TIMES), found.largest),
        model=float(np.max(np.abs(twice - found.value))),
        at={"t in s": DEVIATION_TIMES},
        data={"history_time": DEVIATION_TIMES, "history": found.value},
    )
