"""Claims."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

import compare.studies.pin.nonlinear_support.theory as theory
from compare.claims.error_estimates import TRUTH, WORKING, known, observed_exponent, refined
from compare.claims.measured import Measured
from compare.claims.parameters import CENTRED, FIG5_STARTS
from compare.claims.study import ByEngine, Figures, Study
from compare.engines import Engine
from compare.output.figures import axis, curve, engines_in, new_figure, points
from compare.studies.toolkit.pins import extent, whirl_of
from compare.studies.toolkit.steady_motion import CONVERGED, sharpness, steady_motion
from reference_model import simulate, whirls
from reference_model.formulas.harmonic_balance import whirl_by_harmonic_balance
from reference_model.formulas.pin import equilibrium_position, whirl_frequency, whirl_radius
from reference_model.systems import FloatArray, PinOnDisc

STUDY = Study.beside(
    __file__,
    "nonlinear-support",
    words={"growing_load": f"{theory.GROWING_LOADS[-1]:g}"},
    source=theory.SOURCE,
    system=CENTRED,
    seconds=3.0,
)

SUPPORTS = {"support": tuple(theory.PINS)}
"""Labels of the elements that belong to each support."""


@STUDY.claim(
    "Without offset, the whirl is the circle on which support and damper balance friction, at every friction force",
    equation="(11)",
    unit="m, rad/s",
    resolution=1e-7,
    note=f"With {theory.LAWS}. Predicted: the root of m(μN/β)² = Cρ² + C₃ρ⁴ + C_s·ρ·max(0, ρ − gap), and μN/βρ. In "
    "the paper, C₃ = C_s = 0.",
    swept=("friction_force",),
)
def circle(engine: Engine, loads: Sequence[float] = theory.LOADS) -> Measured:
    pins = [[replace(pin, friction_force=load) for load in loads] for pin in theory.PINS.values()]
    miss = 0.0

    def circles(tolerance: float) -> list[list[tuple[float, float]]]:
        nonlocal miss
        orbits = [[whirl_of(engine, pin, tolerance) for pin in row] for row in pins]
        miss = max(orbit.residual for row in orbits for orbit in row)
        return [[theory.radius_and_frequency(orbit) for orbit in row] for row in orbits]

    found = refined(circles, theory.TOLERANCE)
    radii = {f"{name} radius": found.value[i, :, 0] for i, name in enumerate(theory.PINS)}
    return Measured(
        predicted=[[(whirl_radius(pin), whirl_frequency(pin)) for pin in row] for row in pins],
        value=found.value,
        error=found.largest + miss,
        at=SUPPORTS | {"μN in N": loads},
        components=("radius in m", "frequency in rad/s"),
        data={"loads": loads, **radii},
    )


@STUDY.claim(
    "With an offset, the whirls found by shooting equal those of exact Coulomb friction",
    equation="(17)",
    kind="trajectory",
    unit="s, m",
    resolution=1e-7,
    note=f"With {theory.LAWS}. Predicted: shooting with the reference at tolerance {3.0 * TRUTH:g}.",
)
def orbit(engine: Engine) -> Measured:
    pins = [replace(pin, offset=theory.OFFSET) for pin in theory.PINS.values()]
    exact = [theory.exact_whirl(pin) for pin in pins]

    def period_and_extent(tolerance: float) -> list[list[float]]:
        orbits = [whirl_of(engine, pin, tolerance, guess) for pin, guess in zip(pins, exact, strict=True)]
        return [[one.period, *extent(one)] for one in orbits]

    found = refined(period_and_extent, theory.TOLERANCE)
    return Measured(
        predicted=[[one.period, *extent(one)] for one in exact],
        value=found.value,
        error=found.largest + max(one.residual for one in exact),
        at=SUPPORTS,
        components=("period in s", "smallest radius in m", "largest radius in m"),
        parameters={"offset": theory.OFFSET},
    )


@STUDY.claim(
    "The errors of harmonic balance in radius and frequency of the whirl fall like X0²",
    kind="order",
    resolution=0.1,
    note="This is not in the paper. The mean and one harmonic balance those of the cubic force and of friction. "
    f"Measured: exponents of their errors at X0 = {theory.OFFSETS[0]:g} … {theory.OFFSETS[-1]:g} m. The next term is "
    "of the order X0⁴, because an offset to the other side leads to the same orbit. Without offset, the balance is "
    "exact.",
    swept=("offset",),
)
def harmonic_balance(engine: Engine) -> Measured:
    pins = [replace(theory.HARDENING, offset=offset) for offset in theory.OFFSETS]
    balances = [whirl_by_harmonic_balance(pin) for pin in pins]
    balanced = np.array([(balance.radius, balance.frequency) for balance in balances])
    exact = [theory.exact_whirl(pin) for pin in pins]
    found = refined(
        lambda tolerance: [
            theory.radius_and_frequency(whirl_of(engine, pin, tolerance, guess))
            for pin, guess in zip(pins, exact, strict=True)
        ],
        WORKING / 10,
    )
    misses = np.abs(found.value - balanced).T
    exponents, numerical, model = np.transpose(
        [
            observed_exponent(np.array(theory.OFFSETS), miss, next_term=2.0, noise=noise)
            for miss, noise in zip(misses, found.error.T, strict=True)
        ]
    )
    return Measured(
        predicted=[2.0, 2.0],
        value=exponents,
        error=numerical + model,
        components=("radius", "frequency"),
        system=theory.HARDENING,
    )


@STUDY.claim(
    "A pin slides through the nonlinear range of the support as with exact Coulomb friction",
    equation="(1)",
    kind="trajectory",
    unit="m, m/s",
    resolution=1e-6,
    note=f"From (x, y, vx, vy) = {theory.SLIDING_START}, with {theory.LAWS}. Predicted: the reference at "
    f"tolerance {TRUTH:g}.",
)
def slides(engine: Engine) -> Measured:
    pins = [replace(pin, offset=theory.OFFSET) for pin in theory.PINS.values()]
    motions = [(pin, theory.SLIDING_START, theory.SLIDING_TIMES) for pin in pins]
    found = refined(
        lambda tolerance: [run.states for run in engine.simulate_many(motions, tolerance=tolerance)],
        theory.TOLERANCE,
    )
    return Measured(
        predicted=[
            simulate(pin, theory.SLIDING_START, theory.SLIDING_TIMES, tolerance=TRUTH).states for pin in pins
        ],
        value=found.value,
        error=found.largest,
        at=SUPPORTS | {"t in s": theory.SLIDING_TIMES},
        components=("x in m", "y in m", "vx in m/s", "vy in m/s"),
        parameters={"offset": theory.OFFSET},
    )


@STUDY.claim(
    "A pin sticks until the force of the support beyond its stop exceeds the holding friction",
    equation="(6), (7)",
    kind="trajectory",
    unit="s",
    resolution=1e-4,
    note=f"Predicted: the reference at tolerance {TRUTH:g}, with (6) for the force of this support.",
)
def sticks(engine: Engine) -> Measured:

    def first_stick(asked: Engine, tolerance: float) -> tuple[float, float]:
        start = FIG5_STARTS["whirl"]
        phases = asked.simulate(
            theory.STICKING, start, [0.0, theory.STICKS_BY], tolerance=tolerance
        ).stick_phases
        return (phases[0].start, phases[0].end) if phases else (math.nan, math.nan)

    found = refined(lambda tolerance: first_stick(engine, tolerance), theory.TOLERANCE)
    return Measured(
        predicted=first_stick(Engine("reference", simulate), TRUTH),
        value=found.value,
        error=known(found.value, found.largest),
        components=("stick", "release"),
        system=theory.STICKING,
        source="Fig. 5, second start; μN, ω, X0 and the support are our choice, for which the pin sticks",
    )


@STUDY.claim(
    "A pin that starts near the equilibrium comes to rest where the support force across the radius is μN",
    equation="(3)",
    unit="m",
    resolution=1e-6,
    note=f"The start is {1e3 * theory.BESIDE:g} mm away, with {theory.LAWS}. Predicted: ρ*² = X0² − d² with the "
    "deflection d under the force μN.",
)
def rests(engine: Engine) -> Measured:
    pins = [replace(pin, **theory.RESTING) for pin in theory.PINS.values()]
    places = [equilibrium_position(pin) for pin in pins]

    def ends(tolerance: float) -> list[FloatArray]:
        motions = [
            (pin, (x + theory.BESIDE, y, 0.0, 0.0), theory.REST_TIMES)
            for pin, (x, y) in zip(pins, places, strict=True)
        ]
        return [run.states[1:, :2] for run in engine.simulate_many(motions, tolerance=tolerance)]

    found = refined(ends, theory.TOLERANCE)
    # As in fig06, the slowest deviation decays like exp(−βt/2m).
    left = theory.BESIDE * math.exp(-CENTRED.damping / (2.0 * CENTRED.mass) * theory.REST_TIMES[1])
    return Measured(
        predicted=np.repeat(np.array(places)[:, np.newaxis], len(theory.REST_TIMES) - 1, axis=1),
        value=found.value,
        error=found.largest + left,
        at=SUPPORTS | {"t in s": theory.REST_TIMES[1:]},
        components=("x", "y"),
        parameters=theory.RESTING,
    )


@STUDY.claim(
    "Without damping, the whirl grows until the support turns the pin as fast as the disc, in the limit μN → 0",
    unit="m",
    resolution=1e-2,
    note="According to the paper, nonlinear radial forces usually limit the amplitude. The pin sticks when its "
    "circle turns with the disc, up to an effect of the holding friction of the order μN. Measured: value at 0 of "
    f"the parabola through the radii for μN = {', '.join(f'{load:g}' for load in theory.GROWING_LOADS)} N. "
    f"Error: its change for the straight line through the last two. With {theory.LAWS}.",
    swept=("friction_force",),
)
def growth_ends(engine: Engine) -> Measured:
    grown: dict[tuple[str, float, float], FloatArray] = {}

    def ends(tolerance: float) -> list[list[float]]:
        for name, pin in theory.PINS.items():
            for load in theory.GROWING_LOADS:
                drawn = load == theory.GROWING_LOADS[-1] and tolerance == theory.GROWN
                grown[name, load, tolerance] = growth(engine, pin, load, tolerance, 401 if drawn else 2)
        return [
            [float(grown[name, load, tolerance][-1, 1]) for load in theory.GROWING_LOADS]
            for name in theory.PINS
        ]

    found = refined(ends, theory.GROWN)
    extrapolated = [
        np.polynomial.Polynomial.fit(theory.GROWING_LOADS, radii, 2)(0.0) for radii in found.value
    ]
    straight = [
        np.polynomial.Polynomial.fit(theory.GROWING_LOADS[1:], radii[1:], 1)(0.0) for radii in found.value
    ]
    return Measured(
        predicted=[theory.end_of_growth(pin) for pin in theory.PINS.values()],
        value=extrapolated,
        error=np.abs(np.subtract(extrapolated, straight)) + theory.AMPLIFIED * np.max(found.error, axis=1),
        at=SUPPORTS,
        parameters={"damping": 0.0},
        data={f"{name} growth": grown[name, theory.GROWING_LOADS[-1], theory.GROWN] for name in theory.PINS},
    )


def growth(engine: Engine, pin: PinOnDisc, load: float, tolerance: float, samples: int) -> FloatArray:
    """Return time and radius of a pin without damping until after it has stuck, shape (samples, 2)."""
    undamped = replace(pin, damping=0.0, friction_force=load)
    times = np.linspace(0.0, theory.growing_time(undamped), samples)
    trajectory = engine.simulate(undamped, theory.first_circle(undamped), times, tolerance=tolerance)
    return np.column_stack((times, trajectory.radius))


@STUDY.claim(
    "The whirl of a disc on a hardening support satisfies the balances of force and moment",
    equation="(19), (20)",
    unit="m, rad/s",
    resolution=1e-6,
    note="Measured: the motion of the engine that repeats up to a rotation.",
    basis="reference",
)
def disc_whirl(engine: Engine) -> Measured:
    whirl = whirls(theory.DISC)[0]

    def coming_back(tolerance: float) -> list[float]:
        motion = steady_motion(engine, theory.DISC, whirl.state, tolerance)
        if motion is None:
            return [math.nan] * 3
        return [float(np.hypot(*motion.state[:2])), motion.frequency, motion.spin]

    found = refined(coming_back, theory.TOLERANCE)
    return Measured(
        predicted=[whirl.radius, whirl.frequency, whirl.spin],
        value=found.value,
        error=known(found.value, found.largest) + sharpness(theory.DISC, whirl) * CONVERGED,
        components=("radius in m", "frequency in rad/s", "spin in rad/s"),
        system=theory.DISC,
        source="Figs. 9 and 10 with X0 = 0; β, μN and C₃ are our choice",
    )


# --- Figure

LINES = {"linear": ("linear", ":"), "hardening": ("hardening", "-"), "stop": ("with a stop", "--")}
"""Label and dashes of each support."""


def draw(data: ByEngine) -> Figures:
    figure, (whirl, growing) = new_figure(ncols=2, width=10.0, height=4.0)
    if "theory" in data:
        found = data["theory"]
        for name, (label, dashes) in LINES.items():
            style = curve("theory", label) | {"linestyle": dashes}
            whirl.plot(found["load"], found[f"{name} radius"], **style)
            if name in theory.PINS:
                growing.axhline(float(found[f"{name} end"]), **style)
            else:
                growing.plot(*found[f"{name} growth"].T, **style)
    for engine in engines_in(data):
        found, label = data[engine], engine
        for name in theory.PINS:
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


STUDY.provides(figures=draw, curves=theory.curves)
