"""Measure the cost of exact stick and of an energy balance in chains of rotors.

Run ``python benchmarks/drivetrain_speed.py``. Each number is a ratio of two runs of one process, the fastest of
several of each. Chains have rotors of 1 kg m² with a clutch between each two and a brake, and moments that let the
contacts stick and slip.
"""

import math
import sys
import time
from pathlib import Path

import exudyn as exu

sys.path.insert(0, str(Path(__file__).parents[1]))

from exudyn_models import add_energy_balance, add_ring_friction, solve_dynamic
from exudyn_models.solver.items import add_rotor, coordinate_marker, items

STEPS, END, REPEATS = 1000, 1.0, 5
MOMENT = 5.0  # N m, of each contact


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


def duration(contacts, **options):
    """Return the shortest processor time of a run in s, and the number of mode changes."""
    best, changes = math.inf, []
    for _ in range(REPEATS):
        mbs = chain(contacts, **options)
        settings = exu.SimulationSettings()
        settings.solution.file.write = False
        run = settings.timeIntegration
        run.endTime, run.numberOfSteps, run.verboseMode = END, STEPS, 0
        start = time.process_time()
        if options.get("native"):
            mbs.SolveDynamic(settings, exu.DynamicSolverType.TrapezoidalIndex2)
        else:
            changes = solve_dynamic(mbs, settings, exu.DynamicSolverType.TrapezoidalIndex2)
        best = min(best, time.process_time() - start)
    return best, len(changes)


if __name__ == "__main__":
    exu.config.suppressWarnings = True
    for contacts in (8, 30):
        exact, changes = duration(contacts)
        native, _ = duration(contacts, native=True)
        print(f"{contacts} contacts: exact stick {exact:.3f} s with {changes} changes of mode, ", end="")
        print(f"native friction {native:.3f} s, ratio {exact / native:.2f}")
    plain, _ = duration(30)
    balanced, _ = duration(30, balance=True)
    print(
        f"energy balance of 30 losses: {balanced:.3f} s, without {plain:.3f} s, ratio {balanced / plain:.2f}"
    )
