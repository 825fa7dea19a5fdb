"""A support that hardens or has a stop: what limits the amplitude "in practical application"."""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from compare.claims.claim import Claim, ErrorBudget
from compare.claims.error_estimates import observed_exponent, refined
from compare.claims.paper_parameters import CENTRED, FIG5, FIG5_STARTS, FIG9
from compare.claims.parameters import at_each, parameters_of
from compare.claims.study import Data, Findings, Study
from compare.engines import Engine
from compare.figures import axis, curve, engines_in, new_figure, points
from compare.studies.toolkit.steady_motion import CONVERGED, sharpness, steady_motion
from reference_model import Orbit, simulate, whirl_orbit, whirls
from reference_model.formulas.harmonic_balance import whirl_by_harmonic_balance
from reference_model.formulas.pin import equilibrium_position, whirl_frequency, whirl_radius
from reference_model.systems import FloatArray, PinOnDisc

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HARDENING = replace(CENTRED, hardening=0.5)
STOP = replace(CENTRED, stop_gap=0.6, stop_stiffness=2.0)
PINS = {"hardening": HARDENING, "stop": STOP}
"""Fig. 4 without its offset. The circle of each turns slower than the disc at all loads below."""

LOADS = (0.04, 0.08, 0.12, 0.2)
"""μN in N; at the smallest one the pin does not reach the stop."""

OFFSET = 0.1
"""X0 in m of the orbits, that of Fig. 4."""

OFFSETS = (0.004, 0.005, 0.0063, 0.008, 0.01)
"""X0 in m for the order of the harmonic balance: its next term reaches 5 % of the first at the largest."""

RESTING = {"offset": 0.8, "friction_force": 0.9}
"""At which support and friction balance in the bend of either law."""

BESIDE = 0.005
"""In m: how far from there pins are started."""

RESTS = 400.0
"""In s, after which they have come to rest."""

SLIDING_START = (0.3, 0.0, 0.0, 0.2)
SLIDING_TIMES = np.linspace(0.0, 50.0, 51)

STICKING = replace(
    FIG5,
    friction_force=0.2,
    disc_speed=1.0,
    offset=0.15,
    hardening=5.0,
    stop_gap=0.1,
    stop_stiffness=1.0,
)
STICKS_BY = 2.0
"""In s, after which the pin of Fig. 5's second start has stuck and let go again."""

DISC = replace(FIG9, damping=0.1, friction_force=0.12, offset=0.0, hardening=HARDENING.hardening)

GROWING_LOADS = (0.12, 0.06, 0.03)
"""μN in N of pins without damping; what friction alone makes of the radius where they end falls with it."""

GROWING_FROM = 0.3
"""In m: further in, the largest of these loads holds a pin on the disc."""

FOLLOWED_ON = 0.2
"""In s: after a pin without damping has stuck."""

SHOOTING = 1e-9
BALANCED = 1e-10
GROWN = 1e-6
EXACT = 1e-13
"""Tolerances."""

SOURCE = "Fig. 4, with β, μN and X0 as stated; C₃, C_s and the gap are our choice, the paper names no law"

CIRCLE = "Without offset the whirl is the circle on which support and damper balance friction, at every load"
ORBIT = "With an offset the whirls that the engine finds by shooting are those of exact Coulomb friction"
BALANCE = "The errors of radius and frequency of the whirl by harmonic balance fall like X0²"
SLIDES = "A pin slides through the bend of the support as in exact Coulomb friction"
STICKS = "A pin sticks until the support, by now beyond its stop, pulls harder than friction can hold"
REST = "A pin started near to the equilibrium comes to rest where the support pulls by μN across its radius"
LIMIT = (
    "Without damping the support alone ends the growth: as μN → 0, where it turns the pin as fast as the disc"
)
DISC_WHIRL = "The whirl of a disc on a hardening support is that of the balances of force and moment"


def measure(engine: Engine, loads: Sequence[float] = LOADS) -> Findings:
    """Find whirls at several loads (μN in N), places of rest, and where growth without damping ends."""
    circles = circle_claim(engine, loads)
    claims = [
        circles,
        orbit_claim(engine),
        balance_claim(engine),
        sliding_claim(engine),
        sticking_claim(engine),
        rest_claim(engine),
        limit_claim(engine),
    ]
    if engine.simulates(DISC):
        claims.append(disc_claim(engine))
    data = {"loads": np.array(loads)}
    for (name, pin), found in zip(PINS.items(), circles.measured, strict=True):
        data[f"{name} radius"] = found[:, 0]
        data[f"{name} growth"] = growth(engine, pin, GROWING_LOADS[-1], GROWN)
    return Findings(tuple(claims), data, not_simulated=engine.lacking([HARDENING, DISC]))


def theory() -> Findings:
    """Evaluate the closed forms of the whirl, and follow the linear pin's growth without damping."""
    loads = np.linspace(0.0, max(LOADS), 101)[1:]
    data = {"load": loads}
    for name, pin in {"linear": CENTRED, **PINS}.items():
        data[f"{name} radius"] = np.array([whirl_radius(replace(pin, friction_force=load)) for load in loads])
    for name, pin in PINS.items():
        data[f"{name} end"] = np.array(end_of_growth(pin))
    # On a slowly growing circle of the linear spring d(mkρ²)/dt = μNρ.
    speed = GROWING_LOADS[-1] / (2.0 * CENTRED.mass * CENTRED.natural_frequency)
    times = np.linspace(0.0, 1.4 * max(end_of_growth(pin) for pin in PINS.values()) / speed, 2)
    data["linear growth"] = np.column_stack((times, GROWING_FROM + speed * times))
    return Findings(data=data)


def whirl_of(engine: Engine, pin: PinOnDisc, tolerance: float, guess: Orbit | None = None) -> Orbit:
    """Return the whirl of ``pin``, found by shooting with ``engine``."""
    return whirl_orbit(pin, simulate=engine.simulate, tolerance=tolerance, guess=guess, samples=64)


@functools.cache
def _exact_whirl(pin: PinOnDisc) -> Orbit:
    return whirl_of(Engine("reference", simulate), pin, 3.0 * EXACT)


def radius_and_frequency(orbit: Orbit) -> tuple[float, float]:
    """Return the amplitude in m of the first harmonic of x + iy, and its frequency in rad/s."""
    x, y = orbit.trajectory.states[:-1, :2].T
    return float(np.abs(np.fft.fft(x + 1j * y)[1])) / len(x), 2.0 * math.pi / orbit.period


def circle_claim(engine: Engine, loads: Sequence[float]) -> Claim:
    """Compare the whirls at ``loads`` (μN in N) with the closed form."""
    pins = [[replace(pin, friction_force=load) for load in loads] for pin in PINS.values()]
    miss = 0.0

    def found(tolerance: float) -> list[list[tuple[float, float]]]:
        nonlocal miss
        orbits = [[whirl_of(engine, pin, tolerance) for pin in row] for row in pins]
        miss = max(orbit.residual for row in orbits for orbit in row)
        return [[radius_and_frequency(orbit) for orbit in row] for row in orbits]

    measured, error = refined(found, SHOOTING)
    return Claim(
        CIRCLE,
        equation="(11)",
        engine=engine.name,
        predicted=[[(whirl_radius(pin), whirl_frequency(pin)) for pin in row] for row in pins],
        measured=measured,
        budget=ErrorBudget(float(np.max(error)) + miss, resolution=1e-7),
        parameters=parameters_of(CENTRED, friction_force=loads[-1]),
        source=SOURCE,
        unit="m, rad/s",
        note=f"Radius and frequency for {at_each('μN', loads)} N with {_laws()}. Predicted: the root of "
        "m(μN/β)² = Cρ² + C₃ρ⁴ + C_s·ρ·max(0, ρ − gap), and μN/βρ; the paper has C₃ = C_s = 0.",
    )


def _laws() -> str:
    return (
        f"C₃ = {HARDENING.hardening:g} N/m³ without a stop, and C_s = {STOP.stop_stiffness:g} N/m beyond "
        f"{STOP.stop_gap:g} m without C₃"
    )


def orbit_claim(engine: Engine) -> Claim:
    """Compare the whirls with an offset with those of the reference."""
    pins = [replace(pin, offset=OFFSET) for pin in PINS.values()]
    exact = [_exact_whirl(pin) for pin in pins]

    def found(tolerance: float) -> list[list[float]]:
        orbits = [whirl_of(engine, pin, tolerance, guess) for pin, guess in zip(pins, exact, strict=True)]
        return [_period_and_extent(orbit) for orbit in orbits]

    measured, error = refined(found, SHOOTING)
    return Claim(
        ORBIT,
        equation="(17)",
        kind="trajectory",
        engine=engine.name,
        predicted=[_period_and_extent(orbit) for orbit in exact],
        measured=measured,
        budget=ErrorBudget(float(np.max(error)) + max(orbit.residual for orbit in exact), resolution=1e-7),
        parameters=parameters_of(CENTRED, offset=OFFSET),
        source=SOURCE,
        unit="s, m",
        note=f"Period, least and greatest radius with {_laws()}. "
        f"Predicted: shooting with the reference at tolerance {3.0 * EXACT:g}.",
    )


def _period_and_extent(orbit: Orbit) -> list[float]:
    radius = orbit.trajectory.radius
    return [orbit.period, float(np.min(radius)), float(np.max(radius))]


def balance_claim(engine: Engine) -> Claim:
    """Fit the order in X0 of the error that the harmonic balance has."""
    pins = [replace(HARDENING, offset=offset) for offset in OFFSETS]
    balances = [whirl_by_harmonic_balance(pin) for pin in pins]
    balanced = np.array([(balance.radius, balance.frequency) for balance in balances])
    exact = [_exact_whirl(pin) for pin in pins]

    def found(tolerance: float) -> list[tuple[float, float]]:
        return [
            radius_and_frequency(whirl_of(engine, pin, tolerance, guess))
            for pin, guess in zip(pins, exact, strict=True)
        ]

    measured, error = refined(found, BALANCED)
    misses, noise = np.abs(measured - balanced).T, error.T
    exponents, numerical, model = np.transpose(
        [
            observed_exponent(np.array(OFFSETS), miss, next_term=2.0, noise=error)
            for miss, error in zip(misses, noise, strict=True)
        ]
    )
    return Claim(
        BALANCE,
        equation="",
        kind="order",
        engine=engine.name,
        predicted=[2.0, 2.0],
        measured=exponents,
        budget=ErrorBudget(numerical + model, resolution=0.1),
        parameters=parameters_of(HARDENING, without=("offset",)),
        source=SOURCE,
        note="Not in the paper. The mean and one harmonic, in balance with those of the cubic force and of "
        f"friction: exponents of the errors of radius and frequency at {at_each('X0', OFFSETS)} m. The next term is "
        "of X0⁴, since an offset to the other side makes the same orbit; without offset the balance is exact.",
    )


def sliding_claim(engine: Engine) -> Claim:
    """Follow pins that spiral out to the whirl."""
    pins = [replace(pin, offset=OFFSET) for pin in PINS.values()]
    measured, error = refined(
        lambda tolerance: [
            engine.simulate(pin, SLIDING_START, SLIDING_TIMES, tolerance=tolerance).states for pin in pins
        ]
    )
    return Claim(
        SLIDES,
        equation="(1)",
        kind="trajectory",
        engine=engine.name,
        predicted=[simulate(pin, SLIDING_START, SLIDING_TIMES, tolerance=EXACT).states for pin in pins],
        measured=measured,
        budget=ErrorBudget(float(np.max(error)), resolution=1e-6),
        parameters=parameters_of(CENTRED, offset=OFFSET),
        source=SOURCE,
        unit="m, m/s",
        note=f"States at all seconds to t = {SLIDING_TIMES[-1]:g} s from (x, y, vx, vy) = {SLIDING_START}, with "
        f"{_laws()}. Predicted: the reference at tolerance {EXACT:g}.",
    )


def sticking_claim(engine: Engine) -> Claim:
    """Compare when a pin comes to rest on the disc and when it lets go."""

    def first_stick(found: Engine, tolerance: float) -> tuple[float, float]:
        start = FIG5_STARTS["whirl"]
        phases = found.simulate(STICKING, start, [0.0, STICKS_BY], tolerance=tolerance).stick_phases
        return (phases[0].start, phases[0].end) if phases else (math.nan, math.nan)

    measured, error = refined(lambda tolerance: first_stick(engine, tolerance))
    return Claim(
        STICKS,
        equation="(6), (7)",
        kind="trajectory",
        engine=engine.name,
        predicted=first_stick(Engine("reference", simulate), EXACT),
        measured=measured,
        budget=ErrorBudget(np.nan_to_num(np.max(error), nan=np.inf), resolution=1e-4),
        parameters=parameters_of(STICKING),
        source="Fig. 5, second start; μN, ω, X0 and the support are our choice, so that the pin sticks",
        unit="s",
        note=f"Start and end of its stick phase. Predicted: the reference at tolerance {EXACT:g}, with (6) for the "
        "force of this support.",
    )


def rest_claim(engine: Engine) -> Claim:
    """Compare where pins come to rest with the balance of forces."""
    pins = [replace(pin, **RESTING) for pin in PINS.values()]
    places = [equilibrium_position(pin) for pin in pins]
    times = np.concatenate(([0.0], np.linspace(RESTS - 10.0, RESTS, 11)))

    def ends(tolerance: float) -> list[FloatArray]:
        return [
            engine.simulate(pin, (x + BESIDE, y, 0.0, 0.0), times, tolerance=tolerance).states[1:, :2]
            for pin, (x, y) in zip(pins, places, strict=True)
        ]

    measured, error = refined(ends)
    # As in fig06: the slowest deviation decays like exp(−βt/2m).
    left = BESIDE * math.exp(-CENTRED.damping / (2.0 * CENTRED.mass) * times[1])
    return Claim(
        REST,
        equation="(3)",
        engine=engine.name,
        predicted=np.repeat(np.array(places)[:, np.newaxis], len(times) - 1, axis=1),
        measured=measured,
        budget=ErrorBudget(float(np.max(error)) + left, resolution=1e-6),
        parameters=parameters_of(replace(CENTRED, **RESTING)),
        source=SOURCE,
        unit="m",
        note=f"x and y at eleven times from {times[1]:g} to {times[-1]:g} s, started {1e3 * BESIDE:g} mm beside, "
        f"with {_laws()}. Predicted: ρ*² = X0² − d², where the deflection d is that of the force μN.",
    )


def end_of_growth(pin: PinOnDisc) -> float:
    """Return the radius in m at which the support turns the pin as fast as the disc turns, Cρ + ... = mω²ρ."""
    excess = pin.mass * pin.disc_speed**2 - pin.stiffness
    if pin.hardening > 0.0:
        return math.sqrt(excess / pin.hardening)
    return pin.stop_stiffness * pin.stop_gap / (pin.stop_stiffness - excess)


def growth(engine: Engine, pin: PinOnDisc, load: float, tolerance: float) -> FloatArray:
    """Return time and radius of a pin without damping until it has stuck for a while, shape (n, 2)."""
    undamped = replace(pin, damping=0.0, friction_force=load)
    times = np.linspace(0.0, _growing_time(undamped), 401)
    trajectory = engine.simulate(undamped, _first_circle(undamped), times, tolerance=tolerance)
    return np.column_stack((times, trajectory.radius))


def _first_circle(pin: PinOnDisc) -> tuple[float, float, float, float]:
    """Return a state on the circle on which the linear spring carries the pin."""
    return GROWING_FROM, 0.0, 0.0, pin.natural_frequency * GROWING_FROM


@functools.cache
def _growing_time(pin: PinOnDisc) -> float:
    """Return the time in s until a pin without damping sticks, and a little more.

    Its angular momentum grows with μNρ, from a radius that is at least ``GROWING_FROM``.
    """
    end = end_of_growth(pin)
    longest = pin.mass * end**2 * pin.disc_speed / (pin.friction_force * GROWING_FROM)
    trajectory = simulate(pin, _first_circle(pin), [0.0, longest], tolerance=GROWN)
    return trajectory.stick_phases[0].start + FOLLOWED_ON


def limit_claim(engine: Engine) -> Claim:
    """Extrapolate the radius at which growth without damping ends to small loads."""

    def ends(tolerance: float) -> list[list[float]]:
        return [
            [growth(engine, pin, load, tolerance)[-1, 1] for load in GROWING_LOADS] for pin in PINS.values()
        ]

    found, error = refined(ends, GROWN)
    extrapolated = [np.polynomial.Polynomial.fit(GROWING_LOADS, radii, 2)(0.0) for radii in found]
    straight = [np.polynomial.Polynomial.fit(GROWING_LOADS[1:], radii[1:], 1)(0.0) for radii in found]
    numerical = np.abs(np.subtract(extrapolated, straight)) + AMPLIFIED * np.max(error, axis=1)
    return Claim(
        LIMIT,
        equation="",
        engine=engine.name,
        predicted=[end_of_growth(pin) for pin in PINS.values()],
        measured=extrapolated,
        budget=ErrorBudget(numerical, resolution=1e-2),
        parameters=parameters_of(CENTRED, without=("friction_force",), damping=0.0),
        source=SOURCE,
        unit="m",
        note="Not in the paper, which says that nonlinear radial forces usually limit the amplitude. The pin sticks "
        "where its circle turns with the disc but for what friction holds, which is of the order of μN. Measured: "
        f"the parabola through the radii for {at_each('μN', GROWING_LOADS)} N at 0; error: its change by the "
        f"straight line through the last two. With {_laws()}.",
    )


AMPLIFIED = 6.0
"""Sum of the sizes of the weights 1/3, −2 and 8/3 of that parabola, rounded up."""


def disc_claim(engine: Engine) -> Claim:
    """Compare the whirl of a disc with that of the balances."""
    whirl = whirls(DISC)[0]

    def found(tolerance: float) -> list[float]:
        motion = steady_motion(engine, DISC, whirl.state, tolerance)
        if motion is None:
            return [math.nan] * 3
        return [float(np.hypot(*motion.state[:2])), motion.frequency, motion.spin]

    measured, error = refined(found, SHOOTING)
    budget = np.nan_to_num(float(np.max(error)), nan=np.inf) + sharpness(DISC, whirl) * CONVERGED
    return Claim(
        DISC_WHIRL,
        equation="(19), (20)",
        engine=engine.name,
        predicted=[whirl.radius, whirl.frequency, whirl.spin],
        measured=measured,
        budget=ErrorBudget(budget, resolution=1e-6),
        parameters=parameters_of(DISC),
        source="Figs. 9 and 10 with X0 = 0; β, μN and C₃ are our choice",
        unit="m, rad/s",
        note="Radius, frequency and spin of the motion that comes back turned in the engine's own flow.",
        basis="reference",
    )


LINES = {"linear": ("linear", ":"), "hardening": ("hardening", "-"), "stop": ("with a stop", "--")}
"""Label and dashes of each support."""


def draw(data: Mapping[str, Data]) -> dict[str, Figure]:
    """Draw radii of the whirl over the load, and growth without damping."""
    figure, (whirl, growing) = new_figure(ncols=2, width=10.0, height=4.0)
    if "theory" in data:
        found = data["theory"]
        for name, (label, dashes) in LINES.items():
            style = curve("theory", label) | {"linestyle": dashes}
            whirl.plot(found["load"], found[f"{name} radius"], **style)
            if name in PINS:
                growing.axhline(float(found[f"{name} end"]), **style)
            else:
                growing.plot(*found[f"{name} growth"].T, **style)
    for engine in engines_in(data):
        found, label = data[engine], engine
        for name in PINS:
            whirl.plot(found["loads"], found[f"{name} radius"], **points(engine, label))
            growing.plot(*found[f"{name} growth"].T, **curve(engine, label))
            label = "_"
    whirl.set(xlabel=axis(r"\mu N", "N"), ylabel=axis(r"\rho_c", "m"), xlim=(0.0, None), ylim=(0.0, None))
    growing.set(xlabel=axis("t", "s"), ylabel=axis(r"\rho", "m"), xlim=(0.0, 150.0), ylim=(0.0, 2.0))
    whirl.set_title("Whirl without offset")
    growing.set_title("Without damping")
    handles, labels = whirl.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3)
    return {"nonlinear-support": figure}


STUDY = Study(
    name="nonlinear-support",
    title="A support that hardens or has a stop",
    section="The friction pin",
    paper="The paper says that in practical application the amplitude is usually limited by nonlinearities, either "
    "of the radial or of the normal forces, and names no law. Here the support has a cubic spring or a stop besides. "
    "Friction and damping set the speed of the whirl, μN/β, on every support; what is nonlinear makes its circle "
    "smaller and its frequency higher, until at some load it turns with the disc and there is no whirl any more. "
    "Without damping nothing but that ends the growth.",
    by_hand=measure,
    draw=draw,
    theory=theory,
    figures={
        "nonlinear-support": "Left: radius of the whirl without offset over the load, by the closed form (lines) and "
        "by shooting with the engines (marks). Right: growth without damping at μN = "
        f"{GROWING_LOADS[-1]:g} N; dotted: on a linear support, by the momentum that friction adds; horizontal: "
        "where the support turns the pin as fast as the disc."
    },
    seconds=8.0,
)
