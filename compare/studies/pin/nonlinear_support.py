"""A support that hardens or has a stop, which limits the amplitude."""

import functools
import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from compare.claims.error_estimates import TRUTH, WORKING, known, observed_exponent, refined
from compare.claims.measured import Measured
from compare.claims.parameters import CENTRED, FIG4, FIG5, FIG5_STARTS, FIG9, components_of
from compare.claims.study import ByEngine, Data, Figures, Study
from compare.engines import Engine, reference
from compare.output.figures import axis, curve, engines_in, new_figure, points
from compare.studies.toolkit.measuring import compared, followed
from compare.studies.toolkit.pins import BESIDE, SIZES, exact_whirl, extent, resting, sizes_of, whirl_of
from compare.studies.toolkit.steady_motion import CONVERGED, sharpness, steady_motion
from reference_model import Orbit, simulate, whirls
from reference_model.formulas.harmonic_balance import whirl_by_harmonic_balance
from reference_model.formulas.pin import whirl_frequency, whirl_radius
from reference_model.systems import PinOnDisc

HARDENING = replace(CENTRED, hardening=0.5)
STOP = replace(CENTRED, stop_gap=0.6, stop_stiffness=2.0)
PINS = {"hardening": HARDENING, "stop": STOP}
"""Fig. 4 without its offset; at all ``LOADS``, each whirl turns slower than the disc."""

LAWS = (
    f"C₃ = {HARDENING.hardening:g} N/m³ without a stop, and C_s = {STOP.stop_stiffness:g} N/m beyond "
    f"{STOP.stop_gap:g} m without C₃"
)

SOURCE = "Fig. 4, with β, μN and X0 as stated; C₃, C_s and the gap are our choice, the paper names no law"

LOADS = (0.04, 0.1, 0.2)  # μN in N; at the smallest, the pin does not reach the stop

SHIFTED = [replace(pin, offset=FIG4.offset) for pin in PINS.values()]

SUPPORTS = {"support": tuple(PINS)}  # labels of the elements

OFFSETS = (0.004, 0.005, 0.0063, 0.008, 0.01)
"""X0 in m for the order of the harmonic balance; at the largest, the next term is 5 % of the first."""

RESTING = {"offset": 0.8, "friction_force": 0.9}
"""X0 in m and μN in N, with the equilibrium in the nonlinear range of either law."""

SLIDING_START = (0.3, 0.0, 0.0, 0.2)
SLIDING_TIMES = np.linspace(0.0, 50.0, 51)

STICKING = replace(
    FIG5, friction_force=0.2, disc_speed=1.0, offset=0.15, hardening=5.0, stop_gap=0.1, stop_stiffness=1.0
)
TOLERANCE = 10 * WORKING
"""For motions whose error is then only a hundredth of the resolution."""

DISC = replace(FIG9, damping=0.1, friction_force=0.12, offset=0.0, hardening=HARDENING.hardening)

GROWING_LOADS, GROWING_FROM, GROWN = (0.12, 0.06, 0.03), 0.3, 1e-6
"""Growth without damping: μN in N, initial radius in m, and tolerance. Closer to the axis, the largest of these
friction forces holds a pin on the disc.
"""


def curves() -> Data:
    loads = np.linspace(0.0, max(LOADS), 101)[1:]
    data = {"load": loads}
    for name, pin in {"linear": CENTRED, **PINS}.items():
        data[f"{name} radius"] = np.array([whirl_radius(replace(pin, friction_force=load)) for load in loads])
    ends = {f"{name} end": np.array(end_of_growth(pin)) for name, pin in PINS.items()}
    # On a slowly growing circle with the linear spring: d(mkρ²)/dt = μNρ
    speed = GROWING_LOADS[-1] / (2.0 * CENTRED.mass * CENTRED.natural_frequency)
    times = np.linspace(0.0, 1.4 * max(ends.values()) / speed, 2)
    return data | ends | {"linear growth": np.column_stack((times, GROWING_FROM + speed * times))}


def radius_and_frequency(orbit: Orbit) -> tuple[float, float]:
    """Return the amplitude (m) of the first harmonic of x + iy, and its frequency (rad/s)."""
    x, y = orbit.trajectory.states[:-1, :2].T
    return float(np.abs(np.fft.fft(x + 1j * y)[1])) / len(x), 2.0 * math.pi / orbit.period


def end_of_growth(pin: PinOnDisc) -> float:
    """Return the radius (m) where the support turns the pin as fast as the disc turns, Cρ + ... = mω²ρ."""
    excess = pin.mass * pin.disc_speed**2 - pin.stiffness
    if pin.hardening > 0.0:
        return math.sqrt(excess / pin.hardening)
    return pin.stop_stiffness * pin.stop_gap / (pin.stop_stiffness - excess)


def first_circle(pin: PinOnDisc) -> tuple[float, float, float, float]:
    return GROWING_FROM, 0.0, 0.0, pin.natural_frequency * GROWING_FROM


@functools.cache
def growing_time(pin: PinOnDisc) -> float:
    """Return the time (s) until a pin without damping sticks, plus 0.2 s."""
    # The angular momentum grows by μNρ, and the radius is at least ``GROWING_FROM``.
    longest = pin.mass * end_of_growth(pin) ** 2 * pin.disc_speed / (pin.friction_force * GROWING_FROM)
    trajectory = simulate(pin, first_circle(pin), [0.0, longest], tolerance=GROWN)
    return trajectory.stick_phases[0].start + 0.2


STUDY = Study.beside(
    __file__,
    "nonlinear-support",
    words={"growing_load": f"{GROWING_LOADS[-1]:g}"},
    source=SOURCE,
    system=CENTRED,
    seconds=3.0,
)


@STUDY.claim(
    "Without offset, the whirl is the circle on which support and damper balance friction, at every friction force",
    equation="(11)",
    unit="m, rad/s",
    resolution=1e-7,
    note=f"With {LAWS}. Predicted: the root of m(μN/β)² = Cρ² + C₃ρ⁴ + C_s·ρ·max(0, ρ − gap), and μN/βρ. In "
    "the paper, C₃ = C_s = 0.",
    swept=("friction_force",),
)
def circle(engine: Engine, loads: Sequence[float] = LOADS) -> Measured:
    pins = [[replace(pin, friction_force=load) for load in loads] for pin in PINS.values()]
    miss = 0.0

    def circles(tolerance: float) -> list[list[tuple[float, float]]]:
        nonlocal miss
        orbits = [[whirl_of(engine, pin, tolerance) for pin in row] for row in pins]
        miss = max(orbit.residual for row in orbits for orbit in row)
        return [[radius_and_frequency(orbit) for orbit in row] for row in orbits]

    found = refined(circles, TOLERANCE)
    radii = {f"{name} radius": found.value[i, :, 0] for i, name in enumerate(PINS)}
    return compared(
        [[(whirl_radius(pin), whirl_frequency(pin)) for pin in row] for row in pins],
        found,
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
    note=f"With {LAWS}. Predicted: shooting with the reference at tolerance {3.0 * TRUTH:g}.",
)
def orbit(engine: Engine) -> Measured:
    exact = [exact_whirl(pin) for pin in SHIFTED]
    found = refined(
        lambda tolerance: [sizes_of(whirl_of(engine, one.system, tolerance, one)) for one in exact], TOLERANCE
    )
    return compared(
        [sizes_of(one) for one in exact],
        found,
        error=found.largest + max(one.residual + 2.0 * extent(one).largest for one in exact),
        at=SUPPORTS,
        components=SIZES,
        parameters={"offset": FIG4.offset},
    )


@STUDY.claim(
    "The errors of harmonic balance in radius and frequency of the whirl fall like X0²",
    kind="order",
    resolution=0.1,
    note="This is not in the paper. The mean and one harmonic of the motion balance the cubic force and friction. "
    f"Measured: exponents of their errors at X0 = {OFFSETS[0]:g} … {OFFSETS[-1]:g} m. The next term is "
    "of the order X0⁴, because an offset to the other side leads to the same orbit. Without offset, the balance is "
    "exact.",
    swept=("offset",),
)
def harmonic_balance(engine: Engine) -> Measured:
    pins = [replace(HARDENING, offset=offset) for offset in OFFSETS]
    balances = [whirl_by_harmonic_balance(pin) for pin in pins]
    balanced = np.array([(balance.radius, balance.frequency) for balance in balances])
    found = refined(
        lambda tolerance: [
            radius_and_frequency(whirl_of(engine, pin, tolerance, exact_whirl(pin))) for pin in pins
        ],
        WORKING / 10,
    )
    orders = [
        observed_exponent(np.array(OFFSETS), miss, next_term=2.0, noise=noise)
        for miss, noise in zip(np.abs(found.value - balanced).T, found.error.T, strict=True)
    ]
    exponents, numerical, model = np.transpose(orders)
    return Measured(
        predicted=[2.0, 2.0],
        value=exponents,
        error=numerical + model,
        components=("radius", "frequency"),
        system=HARDENING,
    )


@STUDY.claim(
    "A pin slides through the nonlinear range of the support as with exact Coulomb friction",
    equation="(1)",
    kind="trajectory",
    unit="m, m/s",
    resolution=1e-6,
    note=f"From (x, y, vx, vy) = {SLIDING_START}, with {LAWS}. Predicted: the reference at tolerance {TRUTH:g}.",
)
def slides(engine: Engine) -> Measured:
    motions = [(pin, SLIDING_START, SLIDING_TIMES) for pin in SHIFTED]
    found = followed(engine, motions, TOLERANCE)
    return compared(
        [simulate(*motion, tolerance=TRUTH).states for motion in motions],
        found,
        error=found.largest,
        at=SUPPORTS | {"t in s": SLIDING_TIMES},
        components=components_of(CENTRED),
        parameters={"offset": FIG4.offset},
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
        phases = asked.simulate(STICKING, start, [0.0, 2.0], tolerance=tolerance).stick_phases
        return (phases[0].start, phases[0].end) if phases else (math.nan, math.nan)

    found = refined(lambda tolerance: first_stick(engine, tolerance), TOLERANCE)
    return compared(
        first_stick(reference, TRUTH),
        found,
        error=known(found.value, found.largest),
        components=("stick", "release"),
        system=STICKING,
        source="Fig. 5, second start; μN, ω, X0 and the support are our choice, for which the pin sticks",
    )


@STUDY.claim(
    "A pin that starts near the equilibrium comes to rest where the support force across the radius is μN",
    equation="(3)",
    unit="m",
    resolution=1e-6,
    note=f"The start is {1e3 * BESIDE:g} mm away, with {LAWS}. Predicted: ρ*² = X0² − d² with the "
    "deflection d under the force μN.",
)
def rests(engine: Engine) -> Measured:
    pins = [replace(pin, **RESTING) for pin in PINS.values()]
    times = np.linspace(270.0, 280.0, 11)
    return resting(engine, pins, times, TOLERANCE, SUPPORTS, parameters=RESTING)


@STUDY.claim(
    "Without damping, the whirl grows until the support turns the pin as fast as the disc, in the limit μN → 0",
    unit="m",
    resolution=1e-2,
    note="According to the paper, nonlinear radial forces usually limit the amplitude. The pin sticks when its "
    "circle turns with the disc, up to an effect of the holding friction of the order μN. Measured: value at 0 of "
    f"the parabola through the radii for μN = {', '.join(f'{load:g}' for load in GROWING_LOADS)} N. "
    f"Error: the change with the straight line through the last two radii. With {LAWS}.",
    swept=("friction_force",),
)
def growth_ends(engine: Engine) -> Measured:
    data: Data = {}

    def radius_at_end(name: str, load: float, tolerance: float) -> float:
        pin = replace(PINS[name], damping=0.0, friction_force=load)
        drawn = load == GROWING_LOADS[-1] and tolerance == GROWN
        times = np.linspace(0.0, growing_time(pin), 401 if drawn else 2)
        radius = engine.simulate(pin, first_circle(pin), times, tolerance=tolerance).radius
        if drawn:
            data[f"{name} growth"] = np.column_stack((times, radius))
        return float(radius[-1])

    found = refined(
        lambda tolerance: [[radius_at_end(name, load, tolerance) for load in GROWING_LOADS] for name in PINS],
        GROWN,
    )
    extrapolated = [np.polynomial.Polynomial.fit(GROWING_LOADS, radii, 2)(0.0) for radii in found.value]
    straight = [np.polynomial.Polynomial.fit(GROWING_LOADS[1:], radii[1:], 1)(0.0) for radii in found.value]
    # The weights of the radii in the parabola's value at 0 are 1/3, −2 and 8/3.
    return Measured(
        predicted=[end_of_growth(pin) for pin in PINS.values()],
        value=extrapolated,
        error=np.abs(np.subtract(extrapolated, straight)) + 6.0 * np.max(found.error, axis=1),
        at=SUPPORTS,
        parameters={"damping": 0.0},
        data=data,
    )


@STUDY.claim(
    "The whirl of a disc on a hardening support satisfies the balances of force and moment",
    equation="(19), (20)",
    unit="m, rad/s",
    resolution=1e-6,
    note="Measured: the motion of the engine that repeats up to a rotation.",
    basis="reference",
)
def disc_whirl(engine: Engine) -> Measured:
    whirl = whirls(DISC)[0]

    def coming_back(tolerance: float) -> list[float]:
        motion = steady_motion(engine, DISC, whirl.state, tolerance)
        if motion is None:
            return [math.nan] * 3
        return [float(np.hypot(*motion.state[:2])), motion.frequency, motion.spin]

    found = refined(coming_back, TOLERANCE)
    return compared(
        [whirl.radius, whirl.frequency, whirl.spin],
        found,
        error=known(found.value, found.largest) + sharpness(DISC, whirl) * CONVERGED,
        components=("radius in m", "frequency in rad/s", "spin in rad/s"),
        system=DISC,
        source="Figs. 9 and 10 with X0 = 0; β, μN and C₃ are our choice",
    )


LABEL_AND_DASHES = {"linear": ("linear", ":"), "hardening": ("hardening", "-"), "stop": ("with a stop", "--")}


def draw(data: ByEngine) -> Figures:
    figure, (whirl, growing) = new_figure(ncols=2, width=10.0, height=4.0)
    if "theory" in data:
        found = data["theory"]
        for name, (label, dashes) in LABEL_AND_DASHES.items():
            style = curve("theory", label, linestyle=dashes)
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
    figure.legend(*whirl.get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return {"nonlinear-support": figure}


STUDY.provides(figures=draw, curves=curves)
