"""Measure the cost of exact stick, of heat and energy balance, and of loads of time in drivetrains.

Run ``python benchmarks/drivetrain_speed.py``. Each number is a ratio of two runs of one process, the fastest of
several of each. Chains have rotors of 1 kg m² with a clutch between each two and a brake, and moments that let the
contacts stick and slip. The planar drivetrain has six discs on elastic bearings and five rotors: each disc slips on a
rotor or the ground, and drives the next rotor by a spring.
"""

import math
import sys
import time
from functools import partial
from pathlib import Path

import exudyn as exu
import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

from exudyn_models import add_energy_balance, add_ring_friction, solve_dynamic, spring_energy
from exudyn_models.solver.items import add_rotor, coordinate_marker, items

REPEATS = 5
MOMENT = 5.0  # N m, of each contact of a chain
LOSSES, STEPS = 30, 1000
PLANAR_STEP, EVALUATIONS = 1e-4, 5  # s; evaluations in a step of RK44
RADIUS, COEFFICIENT, LOAD, EPSILON = 0.1, 0.3, 100.0, 1e-2


def chain(contacts, native=False, balance=False):
    """Return a model with this number of contacts."""
    mbs = exu.SystemContainer().AddSystem()
    rotors = [add_rotor(mbs, 1.0, 1.0 + 0.2 * (i % 3)) for i in range(contacts)]
    for i, rotor in enumerate(rotors):
        mbs.AddLoad(
            items.LoadCoordinate(
                markerNumber=coordinate_marker(mbs, rotor),
                loadUserFunction=lambda mbs, t, load, i=i: 4.0 * math.sin(6.0 * t + i),
            )
        )
    losses = {}
    for i, (one, other) in enumerate(zip([None, *rotors], rotors, strict=False)):
        if native:
            mbs.AddObject(
                items.ObjectConnectorCoordinateSpringDamperExt(
                    markerNumbers=[coordinate_marker(mbs, one), coordinate_marker(mbs, other)],
                    stickingStiffness=1e5,
                    stickingDamping=10.0,
                    dynamicFrictionForce=MOMENT,
                    frictionProportionalZone=1e-3,
                )
            )
            continue
        contact = add_ring_friction(
            mbs, one, other, contact_radius=0.1, friction_coefficient=0.5, normal_load=MOMENT / 0.05
        )
        losses[f"contact {i}"] = contact.power
    if balance:
        add_energy_balance(mbs, gains={}, losses=losses)
    mbs.Assemble()
    return mbs


def planar_drivetrain(balance=False, modes=False):
    """Return a model with regularised contacts, which two motors excite, and their sensors of mode."""
    mbs = exu.SystemContainer().AddSystem()
    bearing = mbs.AddMarker(
        items.MarkerBodyPosition(
            bodyNumber=mbs.AddObject(items.ObjectGround()), localPosition=[1e-3, 0.0, 0.0]
        )
    )
    rotors = [add_rotor(mbs, 0.05, 10.0) for _ in range(5)]
    discs, springs, gains, losses = [], [], {}, {}
    for _ in range(6):
        disc = mbs.AddNode(
            items.NodeRigidBody2D(referenceCoordinates=[0.0] * 3, initialCoordinates=[1e-3, 0.0, 0.0])
        )
        mbs.AddObject(items.ObjectRigidBody2D(nodeNumber=disc, mass=2.0, inertia=0.02))
        markers = [bearing, mbs.AddMarker(items.MarkerNodePosition(nodeNumber=disc))]
        springs.append(
            mbs.AddObject(
                items.ObjectConnectorCartesianSpringDamper(markerNumbers=markers, stiffness=[2e5, 2e5, 0.0])
            )
        )
        discs.append(disc)
    for disc, rotor in zip(discs, rotors, strict=False):
        markers = [coordinate_marker(mbs, disc, 2), coordinate_marker(mbs, rotor)]
        springs.append(
            mbs.AddObject(items.ObjectConnectorCoordinateSpringDamper(markerNumbers=markers, stiffness=200.0))
        )
    for i, frequency in ((0, 18.0), (3, 21.0)):

        def torque(mbs, t, load, pace=math.tau * frequency):
            return 15.0 * math.sin(pace * t)

        def power(mbs, t, torque=torque, place=5 + 3 * i + 2):
            return torque(mbs, t, 0.0) * mbs.systemData.GetODE2Coordinates_t().item(place)

        marker = coordinate_marker(mbs, discs[i], 2)
        mbs.AddLoad(items.LoadCoordinate(markerNumber=marker, loadUserFunction=torque))
        gains[f"motor {i}"] = power
    contacts = [
        add_ring_friction(mbs, rotor, disc, normal_load=LOAD, regularisation=EPSILON, **RING)
        for rotor, disc in zip([None, *rotors], discs, strict=True)
    ]
    sensors = [contact.add_sensor("mode") for contact in contacts if modes]
    if balance:
        for i, contact in enumerate(contacts):
            contact.add_sensor("heat")
            losses[f"contact {i}"] = contact.power
        add_energy_balance(mbs, gains=gains, losses=losses, stored=list(map(spring_energy, springs)))
    mbs.Assemble()
    return mbs, sensors


RING = {"contact_radius": RADIUS, "friction_coefficient": COEFFICIENT}


def two_rotors(load, plain=False):
    """Return a model with three contacts between two rotors, or the same law in ``plain`` Python."""
    mbs = exu.SystemContainer().AddSystem()
    rotors = add_rotor(mbs, 0.5, 50.0), add_rotor(mbs, 0.3, 10.0)

    def of_time(mbs, t, item, twist, spin, stiffness, damping, offset):
        moment = COEFFICIENT * RADIUS * load(t)
        share = spin * RADIUS / EPSILON
        return moment * (1.0 if share > 1.0 else -1.0 if share < -1.0 else share)

    def constant(mbs, t, item, twist, spin, stiffness, damping, offset):
        moment = COEFFICIENT * RADIUS * load
        share = spin * RADIUS / EPSILON
        return moment * (1.0 if share > 1.0 else -1.0 if share < -1.0 else share)

    for _ in range(3):
        if plain:
            mbs.AddObject(
                items.ObjectConnectorCoordinateSpringDamper(
                    markerNumbers=[coordinate_marker(mbs, rotor) for rotor in rotors],
                    springForceUserFunction=of_time if callable(load) else constant,
                )
            )
        else:
            add_ring_friction(mbs, *rotors, normal_load=load, regularisation=EPSILON, **RING)
    mbs.Assemble()
    return mbs


def duration(build, end, steps, solver, run=solve_dynamic):
    """Return the processor time of a run in s, and the number of mode changes."""
    mbs = build()
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    options = settings.timeIntegration
    options.endTime, options.numberOfSteps, options.verboseMode = end, steps, 0
    start = time.process_time()
    changes = run(mbs, settings, solver)
    return time.process_time() - start, len(changes) if isinstance(changes, list) else 0


def durations(*builds, end=1.0, steps=STEPS, solver=exu.DynamicSolverType.TrapezoidalIndex2, repeats=REPEATS):
    """Return the shortest times of runs that take turns, with plain Exudyn if they are native or explicit."""
    plain = exu.MainSystem.SolveDynamic
    best = [(math.inf, 0)] * len(builds)
    for _ in range(repeats):
        for i, build in enumerate(builds):
            native = getattr(build, "keywords", {}).get("native") or solver == exu.DynamicSolverType.RK44
            best[i] = min(best[i], duration(build, end, steps, solver, plain if native else solve_dynamic))
    return best


def changes_of_modes():
    """Return the number of changes of the sensors of mode in 1 s of the planar drivetrain."""
    mbs, sensors = planar_drivetrain(modes=True)
    settings = exu.SimulationSettings()
    settings.solution.file.write, settings.solution.sensors.writePeriod = False, PLANAR_STEP
    settings.timeIntegration.numberOfSteps, settings.timeIntegration.verboseMode = round(1.0 / PLANAR_STEP), 0
    solve_dynamic(mbs, settings, exu.DynamicSolverType.TrapezoidalIndex2)
    return sum(np.count_nonzero(np.diff(mbs.GetSensorStoredData(sensor)[:, 1])) for sensor in sensors)


if __name__ == "__main__":
    exu.config.suppressWarnings = True
    exu.config.printToConsole = False
    for contacts in (8, 30):
        (exact, changes), (native, _) = durations(
            partial(chain, contacts), partial(chain, contacts, native=True)
        )
        print(f"{contacts} contacts: exact stick {exact:.3f} s with {changes} changes of mode, ", end="")
        print(f"native friction {native:.3f} s, ratio {exact / native:.2f}")
    (plain, _), (balanced, _) = durations(
        partial(chain, LOSSES), partial(chain, LOSSES, balance=True), repeats=3 * REPEATS
    )
    added = 1e6 * (balanced - plain) / (STEPS * LOSSES)
    print(f"energy balance of {LOSSES} losses: {balanced:.3f} s, without {plain:.3f} s, ", end="")
    print(f"ratio {balanced / plain:.2f}, {added:.2f} μs a step and loss")
    changes, steps = changes_of_modes(), round(1.0 / PLANAR_STEP)
    (plain, _), (balanced, _) = durations(
        lambda: planar_drivetrain()[0], lambda: planar_drivetrain(balance=True)[0], steps=steps
    )
    print(
        f"planar drivetrain, {changes} changes of mode: {plain:.2f} s a second, with heat and balance ",
        end="",
    )
    print(f"{balanced:.2f} s, {1e6 * (balanced - plain) / steps:.1f} μs a step")
    for name, load in (
        ("constant", LOAD),
        ("of time", lambda time: LOAD * (1.0 + 0.5 * math.sin(30.0 * time))),
    ):
        (ours, _), (theirs, _) = durations(
            partial(two_rotors, load),
            partial(two_rotors, load, plain=True),
            solver=exu.DynamicSolverType.RK44,
            end=0.3,
            steps=3000,
            repeats=6 * REPEATS,
        )
        unit = 1e6 / (3000 * 3 * EVALUATIONS)
        print(f"load {name} on rotors: {ours * unit:.3f} μs an evaluation, plain Python ", end="")
        print(f"{theirs * unit:.3f} μs, ratio {ours / theirs:.2f}")
