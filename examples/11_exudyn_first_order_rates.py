"""Exudyn's modified Newton method loses the rates of first-order coordinates when it starts a step over.

Exudyn 1.13 resets ODE1Coords to the start of the step, but not ODE1Coords_t (CSolverBase::Newton), from which the
next predictor takes h/2·ẋ (ComputeNewtonUpdate): the step begins with the rate of the iterate that diverged. It
happens with a fixed step too, wherever a Jacobian changes fast, as here. Full Newton is right.
"""

import exudyn as exu
from exudyn.itemInterface import NodeGenericODE1, ObjectGenericODE1

UNTIL, STEPS, SWITCH = 0.6, 60, 0.555


def decay(t):
    """Return λ in ẋ = −λ·x, in 1/s."""
    return 1.0 if t < SWITCH else 1000.0


def obtained(modified_newton):
    """Return x(0.6 s) by Exudyn's TrapezoidalIndex2 from x(0) = 1."""
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    node = mbs.AddNode(
        NodeGenericODE1(referenceCoordinates=[0.0], initialCoordinates=[1.0], numberOfODE1Coordinates=1)
    )
    mbs.AddObject(
        ObjectGenericODE1(nodeNumbers=[node], rhsUserFunction=lambda mbs, t, item, x: [-decay(t) * x[0]])
    )
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    run = settings.timeIntegration
    run.endTime, run.numberOfSteps, run.verboseMode = UNTIL, STEPS, 0
    run.newton.useModifiedNewton = modified_newton
    mbs.SolveDynamic(settings, exu.DynamicSolverType.TrapezoidalIndex2)
    return mbs.systemData.GetODE1Coordinates()[0]


def expected():
    """Return x(0.6 s) by the trapezoidal rule, whose first rate is 0 as in Exudyn."""
    x, rate, h = 1.0, 0.0, UNTIL / STEPS
    for step in range(1, STEPS + 1):
        x = (x + h / 2 * rate) / (1.0 + h / 2 * decay(step * h))
        rate = -decay(step * h) * x
    return x


if __name__ == "__main__":
    print(f"expected:                      x(0.6 s) = {expected():.6g}")
    print(f"obtained with full Newton:     x(0.6 s) = {obtained(False):.6g}")
    print(f"obtained with modified Newton: x(0.6 s) = {obtained(True):.6g}")
