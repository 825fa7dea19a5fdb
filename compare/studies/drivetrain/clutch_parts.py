"""Two rotors and a clutch in Exudyn: judder, heat, temperature and the energy balance."""

import math
from typing import Any

import numpy as np

from compare.claims import COARSENING, ByEngine, Data, Figures, Measured, Study, change_as_error
from compare.engines import Engine
from compare.output.figures import GREY, Axes, axis, curve, engines_in, new_figure, points
from compare.studies.toolkit.rotors import Rotors
from reference_model.systems import FloatArray

# Judder: a drive drags a disc on a torsional spring, and friction falls with the slip speed.

INERTIA, STIFFNESS, DAMPING = 0.02, 300.0, 0.1
"""Inertia of the disc in kg m², and its shaft in N m/rad and N m s/rad: 19 Hz, 2 % damping."""

SPEED, DRIVE_INERTIA = 50.0, 1e12
"""Speed in rad/s and inertia in kg m²; friction slows the drive by only 1e-11 rad/s²."""

RADIUS, LOAD, COEFFICIENT = 0.1, 1000.0, 0.5
"""Contact radius in m, load in N, and coefficient at the steady slip speed."""

STEADY_MOMENT, STEADY_SLIP = COEFFICIENT * LOAD * RADIUS, RADIUS * SPEED
"""Friction moment in N m and slip speed in m/s, with the shaft wound up and at rest."""

ONSET = DAMPING / (RADIUS**2 * LOAD)
"""Negative slope of the coefficient (s/m); friction then feeds in the power that the damper dissipates."""

GRADIENTS = ONSET * np.array([-1.0, 0.0, 0.5, 0.9, 1.1, 2.0, 4.0])
"""Negative slopes in s/m."""

EPSILON, PERTURBED = 1e-4, 0.1
"""ε in m/s, without effect because the disc does not stick, and the disc's initial speed in rad/s."""

PERIODS = 10
TIMES = np.linspace(0.0, PERIODS * 2.0 * math.pi * math.sqrt(INERTIA / STIFFNESS), 41)
"""Times in s, four per period of the undamped vibration."""

# Heat: a clutch engages between an engine and a vehicle and warms the linings, whose friction fades.

INERTIAS, SLIP = (0.2, 1.5), 200.0
"""Inertias of engine and vehicle in kg m², and initial slip in rad/s."""

RING, PRESSED = 0.1, 3000.0
"""Contact radius in m and load in N."""

COLD_COEFFICIENT, FADE = 0.33, 2e-3
"""Coefficient at ambient temperature, and its relative loss per K."""

CAPACITY, CONDUCTANCE, SURROUNDINGS = 60.0, 20.0, 20.0
"""Heat capacity of the linings in J/K, heat loss in W/K and ambient temperature in °C."""

CREEP, NEARLY_HOLDS = 1e-2, 1.0
"""ε in m/s, 0.1 rad/s at this radius, and the slip in rad/s that ends the slipping time."""

ENGAGED, UNTIL = (np.arange(1.0, 18.0) * 0.02).round(2), 0.6
"""Times in s during slip, and a time after lock-up."""

SLOW_SLIP, HEAVY, HELD = 20.0, 1e12, np.arange(1.0, 21.0) * 2.0
"""Sustained slip: slip in rad/s, inertias in kg m² and times in s."""

MOMENT = COLD_COEFFICIENT * PRESSED * RING
REDUCED = INERTIAS[0] * INERTIAS[1] / (INERTIAS[0] + INERTIAS[1])
HEAT = 0.5 * REDUCED * SLIP**2
"""Moment of cold friction in N m, effective inertia in kg m², and energy of the slip in J."""

BOTH, LEFT_OUT = (1e-10, 1e-10 / COARSENING), 2e-13
"""Tolerances of explicit steps, and fraction of a run's span that ``solve_dynamic`` skips at each break."""


def slipping_time(end: float) -> float:
    """Return the time (s) until the slip of the engaging clutch has fallen to ``end`` (rad/s).

    If no heat is lost, C·(T − T₀) is the energy that ½·J·S² has lost. So J·dS/dt = −M·(b + c·S²) with c = k·J/(2C)
    and b = 1 − c·S₀²; the solution is a tangent.
    """
    c = FADE * REDUCED / (2.0 * CAPACITY)
    b = 1.0 - c * SLIP**2
    turned = math.atan(SLIP * math.sqrt(c / b)) - math.atan(end * math.sqrt(c / b))
    return turned * REDUCED / (MOMENT * math.sqrt(b * c))


def cold_slipping_time(end: float) -> float:
    return (SLIP - end) * REDUCED / MOMENT


def held(times: FloatArray) -> FloatArray:
    """Return the temperature (°C) with sustained slip; in the limit, the loss equals the heat."""
    power = MOMENT * SLOW_SLIP
    rate = CONDUCTANCE + FADE * power
    return SURROUNDINGS + power / rate * (1.0 - np.exp(-rate / CAPACITY * times))


def juddering(gradient: float) -> Rotors:
    """Return a drive and a disc, with a friction coefficient of slope −``gradient`` (s/m)."""
    from exudyn_models import add_ring_friction

    rotors = Rotors((DRIVE_INERTIA, INERTIA), (SPEED, PERTURBED), STEADY_MOMENT / STIFFNESS)
    items, mbs = rotors.items, rotors.mbs
    ends = [rotors.marker(node) for node in (mbs.AddNode(items.NodePointGround()), rotors.nodes[1])]
    shaft = items.CoordinateSpringDamper(markerNumbers=ends, stiffness=STIFFNESS, damping=DAMPING)
    mbs.AddObject(shaft)
    add_ring_friction(
        mbs,
        *rotors.nodes,
        contact_radius=RADIUS,
        friction_coefficient=lambda slip_speed: COEFFICIENT - gradient * (slip_speed - STEADY_SLIP),
        normal_load=LOAD,
        regularisation=EPSILON,
    )
    return rotors


def heating(
    inertias: tuple[float, float], start: float, conductance: float, tolerance: float, times: FloatArray
) -> FloatArray:
    """Return time (s), speeds of both rotors, temperature (°C) and lost heat (J) after each step, shape (n, 5).

    The initial slip is ``start`` (rad/s); the steps hit all ``times``.
    """
    from exudyn_models import add_ring_friction, add_thermal_node

    def fading(temperature: Any) -> Any:
        return COLD_COEFFICIENT * (1.0 - FADE * (temperature - SURROUNDINGS))

    rotors = Rotors(inertias, (start, 0.0))
    losses = {"conductance": conductance, "surroundings": SURROUNDINGS}
    lining = add_thermal_node(rotors.mbs, heat_capacity=CAPACITY, **losses)
    add_ring_friction(
        rotors.mbs,
        *rotors.nodes,
        contact_radius=RING,
        friction_coefficient=fading,
        normal_load=PRESSED,
        regularisation=CREEP,
        thermal_node=lining,
    )
    rotors.sensors.append(lining.add_sensor())
    return rotors.run(float(times[-1]), 100, tolerance=tolerance, breaks=times[:-1].tolist())


def curves() -> Data:
    falls, slips, later = np.linspace(-1.0, 4.0, 50), np.linspace(SLIP, 0.0, 100), np.linspace(0.0, 40.0, 100)
    return {
        "falls": falls,
        "growth": (falls - 1.0) * DAMPING / (2.0 * INERTIA),
        "slips": slips,
        "t": np.array([slipping_time(slip) for slip in slips]),
        "cold t": np.array([cold_slipping_time(slip) for slip in slips]),
        "held t": later,
        "held": held(later),
    }


SOURCE = "two rotors with a clutch (assumption)"
STUDY = Study.beside(__file__, "clutch-parts", source=SOURCE, only=("exudyn",), seconds=4.0)


@STUDY.claim(
    "Judder begins when the friction coefficient falls with slip speed at a rate above D/(N·R²)",
    unit="s/m",
    resolution=1e-5 * ONSET,
    note=f"Root of a straight line through the growth rates of {len(GRADIENTS)} simulated vibrations of {PERIODS} "
    f"periods each, after a push of {PERTURBED:g} rad/s. Numerical error: the change with the tolerance.",
)
def onset(engine: Engine) -> Measured:
    growths = [np.array([_growth(gradient, tolerance) for gradient in GRADIENTS]) for tolerance in BOTH]
    lines = [np.polyfit(GRADIENTS, growth, 1) for growth in growths]
    first, second = (-np.atleast_1d(growth) / slope for slope, growth in lines)
    return Measured(
        predicted=ONSET,
        value=first[0],
        error=change_as_error(first, second)[0],
        named={"onset of judder": 0},
        data={"measured falls": GRADIENTS / ONSET, "measured growth": growths[0]},
    )


def _growth(gradient: float, tolerance: float) -> float:
    """Return the growth rate in 1/s.

    Speeds of a linear vibration at equal intervals Δ satisfy v₂ = 2·e^(σΔ)·cos(ωΔ)·v₁ − e^(2σΔ)·v₀.
    """
    until, breaks = float(TIMES[-1]), TIMES[1:-1].tolist()
    run = juddering(gradient).run(until, round(until / 1e-3), tolerance=tolerance, breaks=breaks)
    v = run[np.searchsorted(run[:, 0], TIMES - 1e-12), 2]
    (_, last), *_ = np.linalg.lstsq(np.column_stack((v[1:-1], v[:-2])), v[2:], rcond=None)
    return math.log(-last) / (2.0 * float(TIMES[1] - TIMES[0]))


@STUDY.claim(
    "Fading friction prolongs the slip of an engaging clutch by the factor that the closed form predicts",
    resolution=1e-5,
    note=f"Time until the slip is {NEARLY_HOLDS:g} rad/s, divided by the same time for cold friction. Numerical "
    "error: the change with the tolerance, plus the change if the interpolation omits every other step.",
)
def takes_longer(engine: Engine) -> Measured:
    runs = [heating(INERTIAS, SLIP, 0.0, tolerance, np.append(ENGAGED, UNTIL)) for tolerance in BOTH]
    cold = cold_slipping_time(NEARLY_HOLDS)
    found, finer, sparse = (_time_of_slip(run) / cold for run in (*runs, runs[0][::2]))
    shown = runs[0][runs[0][:, 0] < ENGAGED[-1]][::10]
    return Measured(
        predicted=slipping_time(NEARLY_HOLDS) / cold,
        value=found,
        error=change_as_error(np.array([found]), np.array([finer]))[0] + abs(sparse - found),
        named={"slipping time over that of cold friction": 0},
        data={"engaged t": shown[:, 0], "engaged slip": shown[:, 1] - shown[:, 2]},
    )


def _time_of_slip(run: FloatArray) -> float:
    return float(np.interp(-NEARLY_HOLDS, run[:, 2] - run[:, 1], run[:, 0]))


@STUDY.claim(
    "The temperature of a clutch with sustained slip approaches its steady value exponentially",
    kind="trajectory",
    unit="°C",
    resolution=1e-6,
    note=f"Rotors of {HEAVY:g} kg m² maintain the slip while friction fades. Numerical error: the change with the "
    f"tolerance. Model error: the slip that the rotors lose, and the fraction {LEFT_OUT:g} of its span that the run "
    "skips at each of these times.",
)
def settles(engine: Engine) -> Measured:
    runs = [heating((HEAVY, HEAVY), SLOW_SLIP, CONDUCTANCE, tolerance, HELD) for tolerance in BOTH]
    # The last step before a break ends slightly early.
    found, finer = (run[np.searchsorted(run[:, 0], HELD - 1e-9), 3] for run in runs)
    span = float(HELD[-1])
    skipped = len(HELD[:-1]) * LEFT_OUT * span * (MOMENT * SLOW_SLIP / CAPACITY)
    return Measured(
        predicted=held(HELD),
        value=found,
        error=np.max(change_as_error(found, finer)),
        model=skipped + MOMENT / CONDUCTANCE * (2.0 * MOMENT * span / HEAVY),
        at={"t in s": HELD},
        data={"measured t": HELD, "measured temperature": found},
    )


@STUDY.claim(
    "The energy of two rotors, the heat in the linings and the lost heat have a constant sum",
    kind="conservation",
    unit="J",
    resolution=1e-8 * HEAT,
    basis="self-check",  # the heat comes from the friction law of the model itself
    friction=False,
    note="Largest deviation after any step, from slip to stick, with heat loss. Numerical error: the change with the "
    "tolerance, plus rounding, which grows like the square root of the number of steps.",
)
def balance(engine: Engine) -> Measured:
    start = 0.5 * INERTIAS[0] * SLIP**2
    runs = [heating(INERTIAS, SLIP, CONDUCTANCE, tolerance, np.array([UNTIL])) for tolerance in BOTH]
    sums = (
        0.5 * run[:, 1:3] ** 2 @ np.array(INERTIAS) + CAPACITY * (run[:, 3] - SURROUNDINGS) + run[:, 4]
        for run in runs
    )
    found, finer = (np.max(np.abs(each - start), keepdims=True) for each in sums)
    rounding = 8.0 * np.finfo(float).eps * start * math.sqrt(len(runs[1]))
    error = change_as_error(found, finer)[0] + rounding
    return Measured(predicted=0.0, value=found[0], error=error, size=start)


def draw(data: ByEngine) -> Figures:
    if not data:
        return {}
    judder, (growth,) = new_figure(width=5.5, height=3.6)
    growth.axhline(0.0, color=GREY, linewidth=0.6)
    _both(growth, data, ("falls", "growth"), ("measured falls", "measured growth"))
    growth.set(xlabel="negative slope of μ against slip speed, relative to the onset")
    growth.set(ylabel="growth rate in 1/s")
    growth.legend(loc="upper left")

    heat, (slips, temperatures) = new_figure(ncols=2, width=10.0, height=3.6)
    theory = data.get("theory", {})
    if "cold t" in theory:
        slips.plot(theory["cold t"], theory["slips"], color=GREY, linestyle="--", label="cold friction")
    _both(slips, data, ("t", "slips"), ("engaged t", "engaged slip"))
    _both(temperatures, data, ("held t", "held"), ("measured t", "measured temperature"))
    slips.set(xlabel=axis("t", "s"), ylabel="slip in rad/s", title="Engagement", ylim=(0.0, None))
    temperatures.set(xlabel=axis("t", "s"), ylabel="temperature in °C", title="Sustained slip")
    slips.legend(fontsize=8.5)
    return {"clutch-parts-judder": judder, "clutch-parts-heat": heat}


def _both(panel: Axes, data: ByEngine, closed_form: tuple[str, str], measured: tuple[str, str]) -> None:
    for name in ("theory", *engines_in(data)):
        x, y = closed_form if name == "theory" else measured
        found = data.get(name, {})
        if y in found:
            style = curve(name, "closed form") if name == "theory" else points(name)
            panel.plot(found[x], found[y], **style)


STUDY.provides(figures=draw, curves=curves)
