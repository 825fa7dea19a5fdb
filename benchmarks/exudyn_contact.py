"""Cost of friction in Exudyn, and cost and accuracy as functions of the regularisation.

Run with ``python benchmarks/exudyn_contact.py``; prints tables. Each number is the least of several repetitions,
interleaved so that other load affects all rows equally. Compare only numbers of one run.

Calls of friction, in empty calls of a user function: two rotors on one axis 0.1, with a function of time 0.6, with
static friction 1.9, with a table 2.4; pin 1.1, six points 1.3, 24 points 1.4; Exudyn's built-in contact with a pin
1.1, six points 6.4, 24 points 26; ring 1.2, annulus 1.6, ring between spatial bodies 2.6; ring with a load of time
2.4, with Stribeck friction too 3.5; ring with a heat sensor 5.8, on two rotors 2.7, with an energy balance 2.7;
Exudyn's spring-damper 0.1, six rigid-body spring-dampers 4.1.

Alternatives for the call, in the same unit: numba's dispatch by type, 1.9 for a ring; a C callback through ctypes,
2.0 for a pin; a NumPy array in place of the list of forces, 0.15 more; Exudyn's symbolic functions, 1.0 for a pin,
but over 5 for a ring, because they evaluate shared subexpressions once per use; Exudyn's build without range checks,
no difference.
"""

from __future__ import annotations

import ctypes
import math
import time
from collections.abc import Callable
from dataclasses import replace
from types import FunctionType
from typing import Any

import exudyn as exu
import exudyn.itemInterface
import numba
import numpy as np

import reference_model
from compare.claims.parameters import FIG5, FIG11
from exudyn_models import (
    add_energy_balance,
    add_ring_friction,
    add_thermal_node,
    build_model,
    simulate,
)
from exudyn_models.forces.axial_pairs import ON_ONE_AXIS, functions_on_axis
from exudyn_models.forces.friction_laws import CONTINUOUS, NONE_HELD, Contact, ring_friction
from exudyn_models.forces.laws.places import ring_places, table_of
from exudyn_models.forces.laws.tables import number_at
from exudyn_models.forces.load_and_coefficient import LoadAndCoefficient, NumberOrFunction
from exudyn_models.parts.native_contact import add_native_friction

items: Any = exudyn.itemInterface  # its type hints do not fit its own calls

STEPS = 3_000
EVALUATIONS_PER_STEP = 5  # four stages of RK44, and the acceleration at the end of the step
REPETITIONS = 25
SECTION = {"friction_coefficient": 1.0, "normal_load": FIG5.friction_force, "regularisation": 1e-6}
PIN: dict[str, Any] = {"contact_radius": 0.0}
RING: dict[str, Any] = {"contact_radius": 0.12}
SIX_POINTS, POINTS_24 = RING | {"contact_points": 6}, RING | {"contact_points": 24}
TABLE = [[0.0, 0.3], [0.1, 0.28], [1.0, 0.25]]
ANNULUS = {"inner_radius": 0.08, "outer_radius": 0.12}

AddContact = Callable[[Any, Any, Any], Any]
"""Adds a contact to a model, between the nodes of master and disc."""


def ours(geometry: dict[str, Any], normal_load: NumberOrFunction = FIG5.friction_force) -> AddContact:
    """Return a function that adds our connector."""
    contact = SECTION | geometry | {"normal_load": normal_load}
    return lambda mbs, master, disc: add_ring_friction(mbs, master, disc, **contact)


def built_in(geometry: dict[str, Any]) -> AddContact:
    """Return a function that adds Exudyn's built-in contact between spheres and a triangle."""
    contact = SECTION | geometry | {"reach": 2.0}
    return lambda mbs, master, disc: add_native_friction(mbs, master, disc, **contact)


def native(connector: str, marker: str, count: int) -> AddContact:
    """Return a function that adds ``count`` native connectors between the ground and the disc."""

    def add(mbs: Any, master: Any, disc: Any) -> None:
        bodies = range(mbs.systemData.NumberOfObjects())
        body = next(i for i in bodies if int(mbs.GetObject(i).get("nodeNumber", -1)) == int(disc))
        ground = mbs.AddObject(items.ObjectGround())
        markers = [mbs.AddMarker(getattr(items, marker)(bodyNumber=number)) for number in (ground, body)]
        for _ in range(count):
            mbs.AddObject(getattr(items, connector)(markerNumbers=markers))

    return add


def with_force(force: Callable[..., Any], coordinates: int = 4) -> AddContact:
    """Return a function that adds our connector with another force function."""
    return lambda mbs, master, disc: mbs.AddObject(
        items.ObjectGenericODE2(
            nodeNumbers=[master, disc],
            massMatrix=np.zeros((coordinates, coordinates)),
            forceUserFunction=force,
        )
    )


def spring_damper(mbs: Any, *nodes: Any) -> None:
    """Add Exudyn's connector with the law of ``RING`` under a constant load."""
    markers = [mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=0)) for node in nodes]
    radius, friction = RING["contact_radius"], FIG5.friction_force
    mbs.AddObject(
        items.ObjectConnectorCoordinateSpringDamperExt(
            markerNumbers=markers,
            dynamicFrictionForce=friction * radius,
            frictionProportionalZone=SECTION["regularisation"] / radius,
        )
    )


def user_function(mbs: Any, *nodes: Any) -> None:
    """Add the same law as a Python function, which the package calls for any other load."""
    mounted = LoadAndCoefficient(
        on_circle(RING["contact_radius"], CONTINUOUS, 1e-6), 1.0, FIG5.friction_force
    )
    force, _ = functions_on_axis(ON_ONE_AXIS[0], mounted)
    with_force(force, coordinates=2)(mbs, *nodes)


NOTHING = [0.0] * 12


def constant(*arguments: Any) -> list[float]:
    """Return zero force, to measure the call itself."""
    return [0.0, 0.0, 0.0, 0.0]


def on_circle(radius: float, points: int, epsilon: float) -> Contact:
    """Return the contact for compiled code of a pin, of points on a circle or of the whole circle."""
    last = radius if points == CONTINUOUS else table_of(ring_places(radius, points))
    return radius, points, FIG5.friction_force, epsilon, NONE_HELD, last


def plain_python(radius: float, points: int) -> AddContact:
    """Return a function that adds our connector with the same law in plain Python."""
    law, contact = in_python(ring_friction), on_circle(radius, points, 1e-6)

    def force(mbs: Any, t: float, item: int, q: list[float], q_t: list[float]) -> list[float]:
        _, x, y, angle = q
        master_spin, vx, vy, spin = q_t
        fx, fy, moment, master_moment = law(x, y, angle, vx, vy, master_spin, spin, contact)
        return [master_moment, fx, fy, moment]

    return with_force(force)


def number_in_table(address: float, place: int) -> float:
    """Return element ``place`` of an array of floats at an address."""
    return ctypes.c_double.from_address(int(address) + 8 * place).value


def in_python(function: Any) -> Callable[..., Any]:
    """Return a compiled function, with all functions that it calls, as plain Python."""
    plain = function.py_func
    names = {
        name: in_python(value)
        if hasattr(value, "py_func")
        else number_in_table
        if value is number_at
        else value
        for name, value in plain.__globals__.items()
        if name in plain.__code__.co_names or name == "__builtins__"
    }
    return FunctionType(plain.__code__, names)


def pin_without_friction() -> tuple[Any, Any, Any]:
    """Return a model with native springs only, and its nodes."""
    without = replace(FIG5, friction_force=0.0)
    model = build_model(without, np.array([1.3, 0.0, 0.0, -1.3]), regularisation=1e-6)
    return model.mbs, exu.NodeIndex(0), exu.NodeIndex(1)


def free_spatial_bodies() -> tuple[Any, Any, Any]:
    """Return a model of two bodies without support, and their nodes."""
    mbs = exu.SystemContainer().AddSystem()
    nodes = []
    for spin in (1.5, 0.0):
        node = mbs.AddNode(
            items.NodeRigidBodyRxyz(
                referenceCoordinates=[0.0] * 6, initialVelocities=[0.0, 0.05 * spin, 0.0, 0.0, 0.0, spin]
            )
        )
        mbs.AddObject(
            items.ObjectRigidBody(nodeNumber=node, mass=1.0, inertia=[1.0, 1.0, 2.0, 0.0, 0.0, 0.0])
        )
        nodes.append(node)
    return mbs, *nodes


def two_rotors() -> tuple[Any, Any, Any]:
    """Return a model of two rotors on one axis, and their nodes."""
    mbs = exu.SystemContainer().AddSystem()
    nodes = [mbs.AddNode(items.Node1D(initialVelocities=[spin])) for spin in (1.5, 0.0)]
    for node in nodes:
        mbs.AddObject(items.ObjectRotationalMass1D(nodeNumber=node, inertia=1e3))
    return mbs, *nodes


CALL = "a user function that returns constants"
FOUR = "ring, no acceleration at the end of a step"

PLANAR: dict[str, AddContact] = {
    "no friction, native springs only": lambda mbs, master, disc: None,
    "a CartesianSpringDamper more": native("CartesianSpringDamper", "MarkerBodyPosition", 1),
    "six RigidBodySpringDampers more": native("RigidBodySpringDamper", "MarkerBodyRigid", 6),
    CALL: with_force(constant),
    "pin": ours(PIN),
    "six points": ours(SIX_POINTS),
    "24 points": ours(POINTS_24),
    "ring": ours(RING),
    "ring under a load of time": ours(RING, lambda time: FIG5.friction_force),
    "ring under a load of the radius": ours(RING, lambda radius: FIG5.friction_force),
    "ring, Stribeck and a load of time": lambda *nodes: ours(
        RING | {"friction_coefficient": stribeck}, load_of_time
    )(*nodes),
    "ring, table over slip": ours(RING | {"friction_coefficient": TABLE}),
    "ring with a sensor of its heat": lambda *nodes: ours(RING)(*nodes).add_sensor("heat"),
    "annulus": ours(ANNULUS),
    FOUR: ours(RING),
    "pin, plain Python": plain_python(0.0, 1),
    "six points, plain Python": plain_python(0.12, 6),
    "pin, built-in contact": built_in(PIN),
    "six points, built-in contact": built_in(SIX_POINTS),
    "24 points, built-in contact": built_in(POINTS_24),
}

SPATIAL: dict[str, AddContact] = {
    "two spatial bodies, no friction": lambda mbs, master, disc: None,
    "a user function of twelve coordinates": with_force(lambda *arguments: NOTHING, coordinates=12),
    "the same with a ring": ours(RING),
    "the same under a load of the radius": ours(RING, lambda radius: FIG5.friction_force),
}


def stribeck(slip_speed: float) -> float:
    """Return a coefficient that falls with the slip speed (m/s)."""
    return 0.25 + 0.05 * math.exp(-slip_speed / 0.5)


def balanced(mbs: Any, *nodes: Any) -> None:
    """Add a ring with an energy balance."""
    add_energy_balance(mbs, gains={}, losses={"friction": ours(RING)(mbs, *nodes).power})


def warming(coefficient: Any, mbs: Any, *nodes: Any) -> None:
    """Add a ring that heats a thermal node."""
    thermal = add_thermal_node(mbs, heat_capacity=8.0, conductance=4.0)
    contact = SECTION | RING | {"friction_coefficient": coefficient, "thermal_node": thermal}
    add_ring_friction(mbs, *nodes, **contact)


def fading(temperature: float) -> float:
    """Return a coefficient that falls with the temperature (°C)."""
    return 0.3 * (1.0 - 1e-3 * (temperature - 20.0))


def load_of_time(time: float) -> float:
    """Return a load in N."""
    return FIG5.friction_force


AXIAL: dict[str, AddContact] = {
    "two rotors, no friction": lambda mbs, master, disc: None,
    "the same with a ring under a constant load": ours(RING),
    "Exudyn's spring-damper with the same law": spring_damper,
    "the same law as a user function": user_function,
    "under a load of time": ours(RING, load_of_time),
    "Stribeck, load of time": ours(RING | {"friction_coefficient": stribeck}, load_of_time),
    "table over slip": ours(RING | {"friction_coefficient": TABLE}),
    "static over sliding friction": ours(RING | {"static_ratio": 1.1}),
    "with a sensor of its heat": lambda *nodes: ours(RING)(*nodes).add_sensor("heat"),
    "with an energy balance": balanced,
    "heating a thermal node": lambda *nodes: warming(0.3, *nodes),
    "with a coefficient of its temperature": lambda *nodes: warming(fading, *nodes),
}


@numba.njit
def evaluations_in_a_loop(count: int, contact: Contact, fastest: float) -> float:
    """Evaluate force and moment ``count`` times, with slip speeds of the centre up to ``fastest`` (m/s)."""
    total = 0.0
    for i in range(count):
        fx, _, moment, _ = ring_friction(
            0.0, 0.0, 0.3, fastest * (i % 1000) / 1000.0, 0.001, 0.0, 0.2, contact
        )
        total += fx + moment
    return total


def cost_of_kernels() -> None:
    """Print the time per evaluation of the compiled law, without Exudyn and without calls from Python."""
    count = 5_000
    print(f"{'compiled law, force and moment':<42}{'ns/evaluation':>15}")
    for name, radius, points in (
        ("pin", 0.0, 1),
        ("six points", 0.12, 6),
        ("24 points", 0.12, 24),
        ("continuous ring", 0.12, CONTINUOUS),
    ):
        contact = on_circle(radius, points, 1e-7)
        for where, fastest in (("around U = W", 0.048), ("U up to 20 W", 0.48)):
            best = math.inf
            for _ in range(200):
                began = time.perf_counter()
                evaluations_in_a_loop(count, contact, fastest)
                best = min(best, time.perf_counter() - began)
            print(f"{name + ', ' + where:<42}{best / count * 1e9:>15.1f}")


def seconds(model: tuple[Any, Any, Any], add_contact: AddContact, accelerations: bool = True) -> float:
    """Return the processor time in s of ``STEPS`` steps of RK44."""
    mbs, master, disc = model
    add_contact(mbs, master, disc)
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 1e9
    options = settings.timeIntegration
    options.verboseMode = 0
    options.numberOfSteps, options.endTime = STEPS, STEPS * 1e-3
    options.solverType = exu.DynamicSolverType.RK44
    options.explicit.computeEndOfStepAccelerations = accelerations
    solver: Any = exu.MainSolverExplicit()
    began = time.process_time()
    solver.SolveSystem(mbs, settings)
    return time.process_time() - began


def cost_of_contacts() -> None:
    """Print the costs per step and per evaluation, relative to no friction and to the mere call."""
    models = ((pin_without_friction, PLANAR), (free_spatial_bodies, SPATIAL), (two_rotors, AXIAL))
    best = dict.fromkeys([*PLANAR, *SPATIAL, *AXIAL], math.inf)
    for _ in range(REPETITIONS):
        for build, contacts in models:
            for name, contact in contacts.items():
                best[name] = min(best[name], seconds(build(), contact, name != FOUR) / STEPS)
    call = best[CALL] - best[next(iter(PLANAR))]
    print(f"\n{'RK44, fixed step':<42}{'us/step':>9}{'ratio':>8}{'ns/evaluation':>15}{'of the call':>13}")
    for _, contacts in models:
        bare = best[next(iter(contacts))]
        for name in contacts:
            extra = best[name] - bare
            row = f"{name:<42}{best[name] * 1e6:>9.2f}{best[name] / bare:>8.2f}"
            if name != FOUR:
                row += f"{extra / EVALUATIONS_PER_STEP * 1e9:>15.0f}{extra / call:>13.2f}"
            print(row)


def choice_of_regularisation() -> None:
    """Print error and cost of Fig. 5's second run for several ε, the reason for ε = 100·tolerance."""
    start, times = [0.1, 0.0, 0.03, 0.0], [0.0, 400.0]
    exact = reference_model.simulate(FIG5, start, times, tolerance=1e-11)
    events = np.array([(phase.start, phase.end) for phase in exact.stick_phases])
    print(
        f"\n{'ε in m/s':>9}{'evaluations':>13}{'s':>7}{'state at 400 s':>16}{'/ε':>7}"
        f"{'1st stick':>11}{'1st release':>13}{'worst event':>13}{'/ε':>7}"
    )
    for epsilon in (1e-5, 1e-6, 1e-7, 1e-8):
        found = simulate(FIG5, start, times, regularisation=epsilon)
        error = np.abs(found.at_end - exact.at_end).max()
        late = np.abs(np.array([(phase.start, phase.end) for phase in found.stick_phases]) - events)
        print(
            f"{epsilon:>9.0e}{found.solution.evaluations:>13,}{found.solution.wall_time:>7.2f}"
            f"{error:>16.1e}{error / epsilon:>7.0f}{late[0, 0]:>11.1e}{late[0, 1]:>13.1e}"
            f"{late.max():>13.1e}{late.max() / epsilon:>7.0f}"
        )


def slip_of_discs() -> None:
    """Print error and cost of Fig. 11's disc to t = 100 s, the reason for DOPRI5's tolerance."""
    print(f"\n{'disc, t = 100 s':<18}{'tolerance':>10}{'evaluations':>13}{'s':>7}{'error at the end':>18}")
    for points in (None, 6):
        disc = replace(FIG11, contact_points=points)
        start, times = [0.05, 0.0, 0.0, 0.0, 0.05, 1.3], [0.0, 100.0]
        exact = reference_model.simulate(disc, start, times, tolerance=1e-13)
        for tolerance in (1e-6, 1e-8, 1e-9, 1e-10):
            found = simulate(disc, start, times, tolerance=tolerance)
            name = "continuous ring" if points is None else f"{points} points"
            print(
                f"{name:<18}{tolerance:>10.0e}{found.solution.evaluations:>13,}"
                f"{found.solution.wall_time:>7.2f}{np.abs(found.at_end - exact.at_end).max():>18.1e}"
            )


if __name__ == "__main__":
    exu.config.printToConsole = False
    cost_of_kernels()
    cost_of_contacts()
    choice_of_regularisation()
    slip_of_discs()
