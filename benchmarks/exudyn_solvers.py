"""Effects of solver, step and regularisation on a clutch that slips and then sticks.

Run with ``python benchmarks/exudyn_solvers.py``; prints more rows of the table in docs/friction-in-your-own-model.md.
"""

from __future__ import annotations

import time
import warnings
from contextlib import redirect_stdout

import exudyn as exu
import numpy as np
from exudyn.itemInterface import Node1D, NodeRigidBody2D, ObjectRigidBody2D, ObjectRotationalMass1D

from exudyn_models import add_energy_balance, add_radial_support, add_ring_friction, solve_dynamic

RUNS = (
    ("DOPRI5", 1e-2, 1e-3),
    ("DOPRI5", 1e-3, 1e-3),
    ("RK44", 1e-2, 5e-5),
    ("RK44", 1e-2, 1e-4),
    ("TrapezoidalIndex2", 1e-2, 1e-4),
    ("TrapezoidalIndex2", 1e-3, 1e-4),
    ("TrapezoidalIndex2", 1e-3, 1e-3),
    ("TrapezoidalIndex2", None, 1e-4),
    ("TrapezoidalIndex2", None, 1e-3),
)
"""Solver, ε in m/s or None for exact stick, and largest step in s."""

UNTIL = 0.15
"""End of the simulation in s; the clutch sticks from 0.065 s on."""


def run(solver: str, regularisation: float | None, step: float) -> None:
    """Simulate a flywheel that drags a disc on an eccentric shaft until both turn together; print a row."""
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    flywheel = mbs.AddNode(Node1D(initialVelocities=[100.0]))
    mbs.AddObject(ObjectRotationalMass1D(nodeNumber=flywheel, inertia=0.2))
    disc = mbs.AddNode(NodeRigidBody2D(initialCoordinates=[0.001, 0.0, 0.0]))
    mbs.AddObject(ObjectRigidBody2D(nodeNumber=disc, mass=0.6, inertia=0.01))
    shaft = add_radial_support(mbs, None, disc, stiffness=1e4, damping=20.0, offset=(0.001, 0.0))
    clutch = add_ring_friction(
        mbs,
        flywheel,
        disc,
        contact_radius=0.1,
        friction_coefficient=0.3,
        normal_load=lambda time: min(800.0, 16e3 * time),
        regularisation=regularisation,
    )
    losses = {"friction": clutch.power, "shaft": shaft.power}
    read_balance = add_energy_balance(mbs, gains={}, losses=losses, stored=[shaft.stored_energy])
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    options = settings.timeIntegration
    options.endTime, options.numberOfSteps, options.verboseMode = UNTIL, round(UNTIL / step), 0
    options.absoluteTolerance, options.relativeTolerance = 1e-8, 0.0
    began = time.perf_counter()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # because the table shows the residual
        solve_dynamic(mbs, settings, getattr(exu.DynamicSolverType, solver))
        balance = read_balance()
    seconds = time.perf_counter() - began
    iteration = mbs.sys["dynamicSolver"].it
    lost = np.max(np.abs(balance.residual)) / balance.turnover
    counts = f"{iteration.currentStepIndex - 1:>9,}{iteration.newtonStepsCount:>9,}"
    if regularisation is None:  # Exudyn counts those of the last part of such a run
        counts = f"{'':18}"
    print(
        f"{solver:<18}{regularisation or 0.0:>9.0e}{step:>10.0e}{counts}{seconds:>7.2f}"
        f"{balance.losses['friction'][-1]:>12.6f}{lost:>13.0e}"
    )


if __name__ == "__main__":
    exu.config.printToConsole = False
    print(f"{'solver':<18}{'ε in m/s':>9}{'step in s':>10}{'steps':>9}{'Newton':>9}{'s':>7}", end="")
    print(f"{'heat in J':>12}{'energy lost':>13}")
    for arguments in RUNS:
        with redirect_stdout(None):  # compiles
            run(*arguments)
        run(*arguments)
