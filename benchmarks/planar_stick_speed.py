"""Measure the cost of exact stick between bodies that can slide sideways.

Run ``python benchmarks/planar_stick_speed.py``. Each ratio compares a run with a ring contact to a run of the same
model without it, the fastest of several of each, by ``solve_dynamic`` and by Exudyn alone. A swinging master drags a
disc on springs. ``--profile`` also prints where the time goes.
"""

import cProfile
import math
import pstats
import sys
import time
from collections import Counter
from pathlib import Path

import exudyn as exu
import exudyn.rigidBodyUtilities
import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

from exudyn_models import add_ring_friction, solve_dynamic
from exudyn_models.solver.items import items

STEPS, END, REPEATS = 1000, 1.0, 5
SOLVER = exu.DynamicSolverType.TrapezoidalIndex2
SWINGING = [0.2, 0.1, 0.5]  # m/s, m/s, rad/s
RING = {"contact_radius": 0.1, "friction_coefficient": 0.4}

LOADS = {  # N
    "sticks and slides, constant load": 30.0,
    "sticks and slides, load of time": lambda time: 30.0 + 12.0 * math.sin(9.0 * time),
    "sticks, load of time": lambda time: 200.0 + 50.0 * math.sin(9.0 * time),
    "slides and turns, load of time": lambda time: 1.0 + 0.4 * math.sin(9.0 * time),
}


def held(mbs, marker, stiffness):
    """Hold a body on springs of this ``stiffness`` (N/m), and in N m/rad a hundredth of it."""
    ground = mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=mbs.AddObject(items.ObjectGround())))
    springs = np.diag([stiffness] * 3 + [0.01 * stiffness] * 3)
    mbs.AddObject(
        items.ObjectConnectorRigidBodySpringDamper(
            markerNumbers=[ground, marker], stiffness=springs, damping=0.002 * springs
        )
    )


def planar(mbs, mass, inertia, velocity):
    """Return node and marker of a planar body."""
    node = mbs.AddNode(items.NodeRigidBody2D(initialVelocities=velocity))
    body = mbs.AddObject(items.ObjectRigidBody2D(nodeNumber=node, mass=mass, inertia=inertia))
    return node, mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=body))


def spatial(kind):
    """Return a function that adds a body with a node of this ``kind``."""

    def add(mbs, mass, inertia, velocity):
        added = mbs.CreateRigidBody(
            inertia=exu.rigidBodyUtilities.RigidBodyInertia(mass=mass, inertiaTensor=inertia * np.eye(3)),
            nodeType=kind,
            initialVelocity=[*velocity[:2], 0.0],
            initialAngularVelocity=[0.0, 0.0, velocity[2]],
            returnDict=True,
        )
        return added["nodeNumber"], mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=added["bodyNumber"]))

    return add


BODIES = {
    "planar": planar,
    "rotation vectors": spatial(exu.NodeType.RotationRotationVector),
    "Tait-Bryan angles": spatial(exu.NodeType.RotationRxyz),
    "Euler parameters": spatial(exu.NodeType.RotationEulerParameters),
}


def model(body, load=None, **options):
    """Return two bodies on springs, with a contact if there is a ``load``."""
    mbs = exu.SystemContainer().AddSystem()
    nodes = []
    for mass, stiffness, velocity in ((20.0, 8000.0, SWINGING), (2.0, 4000.0, [0.0] * 3)):
        node, marker = body(mbs, mass, 0.01 * mass, velocity)
        held(mbs, marker, stiffness)
        nodes.append(node)
    if load is not None:
        add_ring_friction(mbs, *nodes, normal_load=load, **RING, **options)
    mbs.Assemble()
    return mbs


def duration(body, load=None, native=False, **options):
    """Return the shortest processor time of a run in s, and the mode changes."""
    best, changes = math.inf, []
    for _ in range(REPEATS):
        mbs = model(body, load, **options)
        settings = exu.SimulationSettings()
        settings.solution.file.write = False
        run = settings.timeIntegration
        run.endTime, run.numberOfSteps, run.verboseMode = END, STEPS, 0
        start = time.process_time()
        if native:
            mbs.SolveDynamic(settings, SOLVER)
        else:
            changes = solve_dynamic(mbs, settings, SOLVER)
        best = min(best, time.process_time() - start)
    return best, changes


def show(case, found, changes, bare, native):
    """Print times in s as ratios, and the modes that a contact has changed to."""
    kinds = dict(Counter(change.after.name for change in changes))
    print(f"  {case}: {found * 1e3:.1f} ms, ratios {found / bare:.1f} and {found / native:.1f} {kinds}")


if __name__ == "__main__":
    exu.config.suppressWarnings = True
    for name, body in BODIES.items():
        bare, native = duration(body)[0], duration(body, native=True)[0]
        print(f"{name}: {bare * 1e3:.1f} ms without friction, {native * 1e3:.1f} ms by Exudyn alone")

        for case, load in LOADS.items():
            show(case, *duration(body, load), bare, native)
        varying = LOADS["sticks and slides, load of time"]
        show("regularised", *duration(body, varying, regularisation=1e-3), bare, native)
        if "--profile" in sys.argv:
            with cProfile.Profile() as profile:
                duration(body, varying)
            for order in ("cumulative", "tottime"):
                pstats.Stats(profile).sort_stats(order).print_stats(40)
