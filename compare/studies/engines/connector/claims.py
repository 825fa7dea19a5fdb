"""The friction connectors of the Exudyn models on their own: what they exchange, and how they are linearised.

Two discs that nothing else touches move and spin in the plane, one on the other. Friction between them is inner
force: it changes neither their momentum nor their angular momentum, wherever it acts. A connector that forgets the
moment of its force about one of the two bodies fails here; where the master's speed is prescribed nothing shows.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from compare.claims.claim import Claim, ErrorBudget
from compare.claims.error_estimates import ROUNDING
from compare.claims.linearised_flow import (
    ComplexArray,
    eigenvalues_with_rounding,
    matched,
    real_and_imaginary,
)
from compare.claims.paper_parameters import FIG5, FIG8, FIG11
from compare.claims.parameters import parameters_of
from compare.claims.study import Data, Findings, Study
from compare.engines import Engine
from compare.figures import axis, curve, engines_in, new_figure
from reference_model import self_centred_equilibria
from reference_model.steady.stability import jacobian_without_angle
from reference_model.systems import FloatArray, System

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOMENTA = "Friction between two free discs keeps their momentum and angular momentum"
LINEARISED = "Exudyn's own linearisation at the equilibrium gives the eigenvalues of the equations of motion"


@dataclass(frozen=True)
class Body:
    """A free disc: mass in kg, inertia in kg m², place and angle, velocities and spin."""

    mass: float
    inertia: float
    place: tuple[float, float, float]
    velocity: tuple[float, float, float]


BODIES = (
    Body(2.0, 0.5, (0.4, -0.2, 0.3), (0.1, 0.2, 3.0)),
    Body(1.0, 0.08, (0.55, -0.05, 1.0), (-0.2, 0.1, -2.0)),
)
"""The master disc and the disc on it."""

FRICTION, RADIUS, EPSILON = 0.3, 0.12, 1e-3
"""μN in N, R in m, and ε in m/s, above which the discs slip all the time."""

STEPS = 6000
UNTIL = 10.0
"""Steps, and the last time in s."""


def measure(engine: Engine) -> Findings:
    """Let two free discs rub on each other, on the ring where the connector has it and on six points."""
    from exudyn_models import add_native_friction, add_ring_friction, eigenvalues

    adders: dict[str, Callable[..., Any]]
    if engine.name == "exudyn-native":
        reach = 2.0 * UNTIL
        adders = {"six points": partial(add_native_friction, contact_points=6, reach=reach)}
    else:
        adders = {
            "ring": partial(add_ring_friction, contact_points=None),
            "six points": partial(add_ring_friction, contact_points=6),
        }
    data: Data = {}
    claims = [_claim_of_two_discs(engine, name, add, data) for name, add in adders.items()]
    if engine.name == "exudyn":
        claims.append(_claim_of_linearisation(engine, eigenvalues))
        return Findings(tuple(claims), data)
    return Findings(
        tuple(claims),
        data,
        not_simulated="the built-in contact has single points only, and Exudyn linearises it by differences",
    )


def two_discs(add_friction: Callable[..., Any], steps: int) -> tuple[FloatArray, FloatArray]:
    """Return times in s and x, y, angle, vx, vy, spin of master and disc at 101 of them, shape (101, 2, 6)."""
    import exudyn as exu
    import exudyn.itemInterface

    items: Any = exudyn.itemInterface
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    nodes = []
    for body in BODIES:
        node = mbs.AddNode(
            items.NodeRigidBody2D(initialCoordinates=list(body.place), initialVelocities=list(body.velocity))
        )
        mbs.AddObject(items.ObjectRigidBody2D(nodeNumber=node, mass=body.mass, inertia=body.inertia))
        nodes.append(node)
    add_friction(
        mbs,
        *nodes,
        contact_radius=RADIUS,
        friction_coefficient=1.0,
        normal_load=FRICTION,
        regularisation=EPSILON,
    )
    variables = exu.OutputVariableType
    sensors = [
        mbs.AddSensor(
            items.SensorNode(
                nodeNumber=node, outputVariableType=variable, storeInternal=True, writeToFile=False
            )
        )
        for node in nodes
        for variable in (variables.Coordinates, variables.Coordinates_t)
    ]
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = UNTIL / 100
    options = settings.timeIntegration
    options.endTime, options.numberOfSteps, options.verboseMode = UNTIL, steps, 0
    options.solverType = exu.DynamicSolverType.RK67
    exu.config.printToConsole = False
    solver: Any = exu.MainSolverExplicit()
    if not solver.SolveSystem(mbs, settings):
        raise RuntimeError("Exudyn's RK67 gave up on two free discs")
    stored = [np.array(mbs.GetSensorStoredData(sensor)) for sensor in sensors]
    states = np.stack([np.hstack((stored[2 * i][:, 1:], stored[2 * i + 1][:, 1:])) for i in range(2)], axis=1)
    return stored[0][:, 0], states


def momenta(states: FloatArray) -> FloatArray:
    """Momentum in kg m/s and angular momentum about the origin in kg m²/s of each body, shape (..., 2, 3)."""
    mass = np.array([body.mass for body in BODIES])
    inertia = np.array([body.inertia for body in BODIES])
    x, y, _, vx, vy, spin = np.moveaxis(states, -1, 0)
    return np.stack((mass * vx, mass * vy, mass * (x * vy - y * vx) + inertia * spin), axis=-1)


def _claim_of_two_discs(engine: Engine, contact: str, add_friction: Callable[..., Any], data: Data) -> Claim:
    times, states = two_discs(add_friction, STEPS)
    _, coarse = two_discs(add_friction, STEPS // 2)
    each = momenta(states)
    total, change = each.sum(axis=-2), np.abs(momenta(coarse).sum(axis=-2)[-1] - each.sum(axis=-2)[-1])
    scale = np.max(np.abs(each))
    data[f"{contact}: t"], data[f"{contact}: angular momenta"] = times, each[..., 2]
    data[f"{contact}: drift"] = np.max(np.abs(total - total[0]), axis=-1) / scale
    parameters: dict[str, float | str] = {
        "friction_force": FRICTION,
        "contact_radius": RADIUS,
        "contact": contact,
        "regularisation": EPSILON,
    }
    source = "two free discs, an assumption"
    return Claim(
        f"{MOMENTA}: {contact}",
        equation="",
        kind="conservation",
        engine=engine.name,
        predicted=total[0] / scale,
        measured=total[-1] / scale,
        budget=ErrorBudget(change / scale + ROUNDING, resolution=1e-12),
        parameters=parameters,
        source=source,
        note=f"Momentum in x and y, and angular momentum, each over the largest part of one body, {scale:.3g} "
        f"in SI units. Exudyn's RK67 with {STEPS} steps; numerical error: the change with half of them.",
    )


def _claim_of_linearisation(
    engine: Engine, eigenvalues: Callable[[System, FloatArray], ComplexArray]
) -> Claim:
    rotating = replace(FIG11, friction_force=0.015)
    measured, predicted, rounding = [], [], []
    for system in (FIG5, FIG8, rotating):
        (equilibrium,) = self_centred_equilibria(system)
        values, errors = eigenvalues_with_rounding(jacobian_without_angle(system, equilibrium.state))
        measured.append(matched(eigenvalues(system, equilibrium.state), values))
        predicted.append(values)
        rounding.append(errors)
    found, expected, error = (np.concatenate(parts) for parts in (measured, predicted, rounding))
    return Claim(
        LINEARISED,
        equation="",
        engine=engine.name,
        predicted=real_and_imaginary(expected),
        measured=real_and_imaginary(found),
        budget=ErrorBudget(2.0 * np.column_stack((error, error)), resolution=1e-8),
        parameters=parameters_of(FIG8),
        source="Fig. 5's pin, Fig. 8's disc, and Fig. 11's disc rotating on the axis with μN = 0.015 N",
        unit="1/s",
        note="Real and imaginary parts of 4, 5 and 5 eigenvalues. Numerical error: rounding of both eigenvalue "
        "problems, by the condition of each eigenvalue.",
    )


def draw(data: Mapping[str, Data]) -> dict[str, Figure]:
    """Draw the angular momenta of both discs, and the drift of their momenta."""
    found = {engine: data[engine] for engine in engines_in(data) if "six points: t" in data[engine]}
    if not found:
        return {}
    figure, (exchange, drift) = new_figure(ncols=2, width=10.0, height=4.0)
    for engine, values in found.items():
        for contact in ("ring", "six points"):
            if f"{contact}: t" not in values:
                continue
            times, each = values[f"{contact}: t"], values[f"{contact}: angular momenta"]
            if contact == "six points":
                exchange.plot(times, each.sum(axis=1), **curve(engine))
                exchange.plot(times, each, **curve(engine, "_"))  # without a place in the legend
                parts = dict(zip(("master disc", "disc", "sum"), (*each[1], each[1].sum()), strict=True))
            look = {"linestyle": "-" if contact == "ring" else ":"}
            drift.semilogy(
                times[1:],
                np.maximum(values[f"{contact}: drift"][1:], 1e-17),
                **curve(engine, f"{engine}, {contact}", **look),
            )
    for name, value in parts.items():
        exchange.annotate(
            name, (0.0, value), xytext=(2, 3 if name != "sum" else -12), textcoords="offset points"
        )
    exchange.set(xlabel=axis("t", "s"), ylabel="angular momentum in kg m²/s")
    exchange.legend()
    drift.set(xlabel=axis("t", "s"), ylabel="drift over the largest part", ylim=(1e-17, 1e-9))
    drift.legend(loc="upper left")
    return {"connector-momenta": figure}


STUDY = Study(
    name="connector",
    title="The friction connector on its own",
    section="The engines",
    paper="Not in the paper. Whoever takes the connector into a larger model relies on its reaction on the master: "
    "the opposite force, and its moment about the master's own centre. Between two free discs both show at once, as "
    "momentum and angular momentum that do not change. The linearisation is what an engineer gets from Exudyn.",
    by_hand=measure,
    draw=draw,
    figures={
        "connector-momenta": "Two free discs that rub on each other. Left: angular momentum of each about the "
        "origin, and their sum, on six points. Right: how far the momenta drift (the larger of linear and angular).",
    },
    only=("exudyn", "exudyn-native"),
    seconds=0.3,
    contact=True,
)
