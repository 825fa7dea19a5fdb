"""Slip control: a controller sets the load on a clutch from the measured slip.

An engine drives a vehicle through a clutch. A proportional controller N = N₀ + K·(s − 5 rad/s) reduces the slip s
from 30 to 5 rad/s. The clutch transmits M = μNR at any slip, so s decays exponentially at the rate
μRK·(1/J₁ + 1/J₂).
"""

import sys

import exudyn as exu
import numpy as np
from exudyn.itemInterface import LoadCoordinate, MarkerNodeCoordinate, Node1D, ObjectRotationalMass1D

from exudyn_models import add_ring_friction, solve_dynamic

ENGINE, VEHICLE = 0.2, 0.75  # kg m²
TORQUE = 100.0  # N m, engine torque
RADIUS, FRICTION_COEFFICIENT = 0.1, 0.6  # m; two facings of μ = 0.3
START, TARGET = 30.0, 5.0  # rad/s, slip
GAIN = 50.0  # N s/rad
ARM = FRICTION_COEFFICIENT * RADIUS  # m, transmitted moment divided by load
HOLDING = TORQUE / ARM * VEHICLE / (ENGINE + VEHICLE)  # N₀ in N, holds the slip constant
RATE = ARM * GAIN * (1.0 / ENGINE + 1.0 / VEHICLE)  # 1/s

container = exu.SystemContainer()
mbs = container.AddSystem()
engine = mbs.AddNode(Node1D(initialVelocities=[150.0 + START]))
mbs.AddObject(ObjectRotationalMass1D(nodeNumber=engine, inertia=ENGINE))
vehicle = mbs.AddNode(Node1D(initialVelocities=[150.0]))
mbs.AddObject(ObjectRotationalMass1D(nodeNumber=vehicle, inertia=VEHICLE))
crank = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=engine, coordinate=0))
mbs.AddLoad(LoadCoordinate(markerNumber=crank, load=TORQUE))


def controlled_load(time):
    """Return the normal load in N. The sensor gives the slip of the disc, negative if the engine is faster."""
    slip = -mbs.GetSensorValues(rim_slip) / RADIUS
    return max(0.0, HOLDING + GAIN * (slip - TARGET))


clutch = add_ring_friction(
    mbs,
    engine,
    vehicle,
    contact_radius=RADIUS,
    friction_coefficient=FRICTION_COEFFICIENT,
    normal_load=controlled_load,
    regularisation=0.2,  # m/s, below any slip here; RK44 with this step is unstable in stick for smaller values
)
rim_slip = clutch.add_sensor("rim_slip")  # in m/s
moment = clutch.add_sensor("transmitted_moment")
mbs.Assemble()

settings = exu.SimulationSettings()
settings.solution.file.write = False
settings.solution.sensors.writePeriod = 5e-3
options = settings.timeIntegration
options.verboseMode = 0
options.endTime, options.numberOfSteps = 1.0, 200
solve_dynamic(mbs, settings, exu.DynamicSolverType.RK44)

times, slip = mbs.GetSensorStoredData(rim_slip).T * [[1.0], [-1.0 / RADIUS]]
torque = mbs.GetSensorStoredData(moment)[:, 1]
closed_form = TARGET + (START - TARGET) * np.exp(-RATE * times)


def draw(path):
    """Draw the slip and the transmitted moment against time."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.0, 3.0), layout="constrained")
    slips, moments = figure.subplots(1, 2)
    slips.plot(times, slip, label="Exudyn")
    slips.plot(times, closed_form, "k:", label="closed form")
    slips.axhline(TARGET, color="0.7", zorder=0)
    slips.set(xlabel="t in s", ylabel="slip in rad/s")
    slips.legend()
    moments.plot(times, torque)
    moments.set(xlabel="t in s", ylabel="transmitted moment in N m")
    figure.savefig(path, dpi=80)


if __name__ == "__main__":
    print("t in s  slip in rad/s  closed form  transmitted moment in N m")
    for row in list(zip(times, slip, closed_form, torque, strict=True))[::20]:
        print("{:6.1f}  {:13.8f}  {:11.8f}  {:25.4f}".format(*row))
    if len(sys.argv) > 1:
        draw(sys.argv[1])
