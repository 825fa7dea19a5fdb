"""Measure the cost of exact stick between bodies that can slide sideways.

Run ``python benchmarks/planar_stick_speed.py``. Each ratio compares a run with a ring contact to a run of the same
model without it, the fastest of several of each. A swinging master drags a disc on springs, so the contact sticks and
slides several times. ``--profile`` prints where the time goes.
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


def growing(time):
    """Return a load in N that is a function of the time."""
    return 30.0 + 12.0 * math.sin(9.0 * time)


def steady(time):
    """Return a load in N that makes the same motion costlier than a constant one by calls only."""
    return 30.0


def held(mbs, node, marker, stiffness, rotation):
    """Hold a body on springs of a ``stiffness`` (N/m) and a ``rotation`` stiffness (N m/rad)."""
    ground = mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=mbs.AddObject(items.ObjectGround())))
    springs = np.diag([stiffness] * 3 + [rotation] * 3)
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
        held(mbs, node, marker, stiffness, 0.01 * stiffness)
        nodes.append(node)
    if load is not None:
        add_ring_friction(mbs, *nodes, normal_load=load, **RING, **options)
    mbs.Assemble()
    return mbs


def duration(body, load=None, **options):
    """Return the shortest processor time of a run in s, and the mode changes."""
    best, changes = math.inf, []
    for _ in range(REPEATS):
        mbs = model(body, load, **options)
        settings = exu.SimulationSettings()
        settings.solution.file.write = False
        run = settings.timeIntegration
        run.endTime, run.numberOfSteps, run.verboseMode = END, STEPS, 0
        start = time.process_time()
        if load is None:
            mbs.SolveDynamic(settings, SOLVER)
        else:
            changes = solve_dynamic(mbs, settings, SOLVER)
        best = min(best, time.process_time() - start)
    return best, changes


if __name__ == "__main__":
    exu.config.suppressWarnings = True
    for name, body in BODIES.items():
        bare, _ = duration(body)
        print(f"{name}: {bare * 1e3:.2f} ms without friction")
        cases = {"constant load": 30.0, "load of time, constant": steady, "load of time": growing}
        for case, load in cases.items():
            exact, changes = duration(body, load)
            kinds = Counter(int(change.after) for change in changes)
            print([(round(c.time, 3), int(c.after)) for c in changes])
            print(f"  {case}: {exact * 1e3:.1f} ms, ratio {exact / bare:.1f}, changes to {dict(kinds)}")
        regular, _ = duration(body, growing, regularisation=1e-3)
        print(f"  regularised: ratio {regular / bare:.1f}")
        if "--profile" in sys.argv:
            with cProfile.Profile() as profile:
                duration(body, growing)
            for order in ("cumulative", "tottime"):
                pstats.Stats(profile).sort_stats(order).print_stats(40)
