"""Exudyn's modified Newton method loses the rates of first-order coordinates when it restarts a step.

Exudyn 1.13 resets ODE1Coords to the start of the step, but not ODE1Coords_t (CSolverBase::Newton). The next predictor
h/2·ẋ (ComputeNewtonUpdate) therefore uses the rate of the diverged iterate. This also happens with a fixed step,
wherever a Jacobian changes rapidly, as here. Full Newton is correct.
"""

import sys

import exudyn as exu
from exudyn.itemInterface import NodeGenericODE1, ObjectGenericODE1

STEPS, STEP = 60, 0.01


def rate(t, x):
    """Return ẋ in 1/s, a decay whose rate increases a thousandfold."""
    return -x if t < 0.555 else -1000.0 * x


def obtained(modified_newton):
    """Return the final x from Exudyn's TrapezoidalIndex2 with x(0) = 1."""
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    coordinates = {"referenceCoordinates": [0.0], "initialCoordinates": [1.0], "numberOfODE1Coordinates": 1}
    node = mbs.AddNode(NodeGenericODE1(**coordinates))
    mbs.AddObject(
        ObjectGenericODE1(nodeNumbers=[node], rhsUserFunction=lambda mbs, t, item, x: [rate(t, x[0])])
    )
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    run = settings.timeIntegration
    run.endTime, run.numberOfSteps, run.newton.useModifiedNewton = STEPS * STEP, STEPS, modified_newton
    mbs.SolveDynamic(settings, exu.DynamicSolverType.TrapezoidalIndex2)
    return mbs.systemData.GetODE1Coordinates()[0]


def expected():
    """Return the final x from the trapezoidal rule with an initial rate of 0, as in Exudyn."""
    x, before = 1.0, 0.0
    for step in range(1, STEPS + 1):
        x = (x + STEP / 2 * before) / (1.0 - STEP / 2 * rate(step * STEP, 1.0))
        before = rate(step * STEP, x)
    return x


def draw(path):
    """Draw the final value with both iterations next to the expected one."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(5.2, 2.0), layout="constrained")
    panel = figure.subplots()
    finals = (obtained(True), obtained(False), expected())
    bars = panel.barh(("modified Newton", "full Newton", "expected"), finals, color=("C3", "C2", "0.5"))
    panel.bar_label(bars, fmt="%.3f", padding=3)
    panel.axvline(0.0, color="k", linewidth=0.8)
    panel.set(xlabel=f"x after {STEPS * STEP:g} s (dimensionless); it decays from 1", xlim=(-2.6, 0.5))
    figure.savefig(path, dpi=80)


if __name__ == "__main__":
    print(
        f"expected {expected():.6g}; obtained with full Newton {obtained(False):.6g}, modified {obtained(True):.6g}"
    )
    if len(sys.argv) > 1:
        draw(sys.argv[1])
