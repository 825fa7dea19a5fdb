"""A car with a dual clutch starts on a slope, changes gear, brakes and holds, with eight contacts that stick exactly.

Ten rotors on one axis: engine, flywheel, two input shafts, two idle gears, output shaft, two wheels and the car. Two
clutches, two synchronisers, two brakes and two tyres are friction contacts. An energy balance checks the run. Pass a
path to save a figure.
"""

import math
import sys
import time

import exudyn as exu
import numpy as np
from exudyn.itemInterface import (
    LoadCoordinate,
    MarkerNodeCoordinate,
    Node1D,
    ObjectGenericODE2,
    ObjectRotationalMass1D,
    SensorNode,
)

from exudyn_models import add_energy_balance, add_ring_friction, solve_dynamic

INERTIAS = {  # kg m²
    "engine": 0.15, "flywheel": 0.05, "shaft 1": 0.02, "shaft 2": 0.02, "gear 1": 0.02, "gear 2": 0.02,
    "output": 0.05, "left wheel": 1.0, "right wheel": 1.0, "car": 126.0,  # 1400 kg on wheels of 0.3 m
}  # fmt: skip
SHAFTS = [  # two rotors, ratio of their speeds, N m/rad, N m s/rad
    ("engine", "flywheel", 1.0, 1500.0, 5.0),
    ("shaft 1", "gear 1", 3.5, 2000.0, 2.0),
    ("shaft 2", "gear 2", 2.0, 2000.0, 2.0),
    ("output", "left wheel", 4.0, 1000.0, 2.0),
    ("output", "right wheel", 4.0, 1000.0, 2.0),
]
SLOPE = 1400.0 * 9.81 * math.sin(math.radians(8.0)) * 0.3  # N m on the car
UNTIL = 7.0  # s


def ramp(time, begin, end, first, last):
    """Return a value that changes linearly from ``first`` to ``last`` between two times."""
    return first + (last - first) * min(1.0, max(0.0, (time - begin) / (end - begin)))


def pulse(time, closing, opening, height):
    """Return a value that rises to ``height`` and falls again, each linearly between two times."""
    return ramp(time, *closing, 0.0, height) - ramp(time, *opening, 0.0, height)


def braking(time):
    """Return the capacity of each brake in N m."""
    return 800.0 - pulse(time, (0.8, 1.0), (4.8, 5.0), 800.0)


CAPACITIES = {  # two rotors (None is the chassis) and the sliding moment in N m as a function of time in s
    "clutch 1": ("flywheel", "shaft 1", lambda time: pulse(time, (0.5, 1.5), (3.0, 3.3), 300.0)),
    "clutch 2": ("flywheel", "shaft 2", lambda time: pulse(time, (3.0, 3.3), (4.8, 5.0), 300.0)),
    "synchroniser 1": ("output", "gear 1", lambda time: ramp(time, 3.6, 3.7, 2000.0, 0.0)),
    "synchroniser 2": ("output", "gear 2", lambda time: ramp(time, 2.4, 2.6, 0.0, 2000.0)),
    "left brake": (None, "left wheel", braking),
    "right brake": (None, "right wheel", braking),
    "left tyre": ("car", "left wheel", lambda time: 1500.0),
    "right tyre": ("car", "right wheel", lambda time: 1500.0),
}
BREAKS = [0.5, 0.8, 1.0, 1.5, 2.4, 2.6, 3.0, 3.3, 3.6, 3.7, 4.8, 5.0]  # s, kinks of these functions


class Car:
    """The model, before a run."""

    def __init__(self):
        self.container = exu.SystemContainer()
        self.mbs = mbs = self.container.AddSystem()
        self.nodes = {name: mbs.AddNode(Node1D(initialVelocities=[0.0])) for name in INERTIAS}
        for name, inertia in INERTIAS.items():
            mbs.AddObject(ObjectRotationalMass1D(nodeNumber=self.nodes[name], inertia=inertia))
        mbs.SetNodeParameter(self.nodes["engine"], "initialVelocities", [150.0])
        mbs.SetNodeParameter(self.nodes["flywheel"], "initialVelocities", [150.0])
        for first, second, ratio, stiffness, damping in SHAFTS:
            wound = np.outer((1.0, -ratio), (1.0, -ratio))
            mbs.AddObject(
                ObjectGenericODE2(
                    nodeNumbers=[self.nodes[first], self.nodes[second]],
                    massMatrix=np.zeros((2, 2)),
                    stiffnessMatrix=stiffness * wound,
                    dampingMatrix=damping * wound,
                )
            )
        self.contacts = {
            name: add_ring_friction(
                mbs,
                None if master is None else self.nodes[master],
                self.nodes[disc],
                contact_radius=1.0,
                friction_coefficient=1.0,
                normal_load=lambda time, moment=moment: max(0.0, moment(time)),
                static_ratio=1.1,
            )
            for name, (master, disc, moment) in CAPACITIES.items()
        }
        for name, load in (("engine", self.engine_torque), ("car", lambda time: -SLOPE)):
            marker = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=self.nodes[name], coordinate=0))
            mbs.AddLoad(
                LoadCoordinate(
                    markerNumber=marker, load=1.0, loadUserFunction=lambda mbs, t, _, load=load: load(t)
                )
            )
        self.read_balance = add_energy_balance(
            mbs,
            gains={"engine": lambda mbs, t: self.engine_torque(t) * self.speed("engine")},
            losses={
                **{name: contact.power for name, contact in self.contacts.items()},
                "shafts": self.shaft_power,
                "slope": lambda mbs, t: SLOPE * self.speed("car"),
            },
            stored=[self.shaft_energy],
        )
        options = {"storeInternal": True, "writeToFile": False}
        self.modes = {name: contact.add_sensor("mode", **options) for name, contact in self.contacts.items()}
        rates = exu.OutputVariableType.Coordinates_t
        self.speeds = {
            name: mbs.AddSensor(SensorNode(nodeNumber=node, outputVariableType=rates, **options))
            for name, node in self.nodes.items()
        }
        mbs.Assemble()

    def engine_torque(self, time):
        """Return the torque of the engine in N m: idle, full load, idle."""
        return pulse(time, (0.5, 1.5), (4.8, 5.0), 150.0)

    def speed(self, name):
        """Return the speed of a rotor in rad/s."""
        return float(self.mbs.systemData.GetODE2Coordinates_t()[self.mbs.GetNodeODE2Index(self.nodes[name])])

    def twists(self, values):
        """Return the twist of each shaft from angles, or its rate from speeds."""
        at = {name: values[self.mbs.GetNodeODE2Index(node)] for name, node in self.nodes.items()}
        return np.array([at[first] - ratio * at[second] for first, second, ratio, *_ in SHAFTS])

    def shaft_power(self, mbs, t):
        """Return the power of the dampers of all shafts in W."""
        dampings = [shaft[4] for shaft in SHAFTS]
        return float(dampings @ self.twists(mbs.systemData.GetODE2Coordinates_t()) ** 2)

    def shaft_energy(self, mbs):
        """Return the energy of the springs of all shafts in J."""
        stiffnesses = [shaft[3] for shaft in SHAFTS]
        return float(stiffnesses @ self.twists(mbs.systemData.GetODE2Coordinates()) ** 2) / 2.0

    def run(self, step, solver=exu.DynamicSolverType.TrapezoidalIndex2):
        """Run the model with a ``step`` in s; return the changes of the contacts' modes."""
        settings = exu.SimulationSettings()
        settings.solution.file.write = False
        options = settings.timeIntegration
        options.verboseMode, options.endTime, options.numberOfSteps = 0, UNTIL, round(UNTIL / step)
        return solve_dynamic(self.mbs, settings, solver, breaks=BREAKS)


def draw(path):
    """Draw speeds, modes and the residual of the balance against time."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8.0, 7.0), layout="constrained")
    top, middle, bottom = figure.subplots(3, 1, sharex=True, height_ratios=(3, 2, 1))
    for name, factor in (("engine", 1.0), ("shaft 1", 1.0), ("shaft 2", 1.0), ("car", 4.0)):
        times, speeds = car.mbs.GetSensorStoredData(car.speeds[name]).T
        top.plot(times, factor * speeds, label=name if factor == 1.0 else f"{name} × {factor:g}")
    top.set(ylabel="speed in rad/s")
    top.legend(frameon=False, ncols=2)
    for row, sensor in enumerate(car.modes.values()):
        times, modes = car.mbs.GetSensorStoredData(sensor).T
        for mode, colour in ((0, "C2"), (1, "C3"), (-1, "C3"), (2, "0.85")):
            middle.fill_between(
                times, row - 0.35, row + 0.35, modes == mode, step="post", color=colour, linewidth=0
            )
    middle.set(yticks=range(len(car.contacts)), yticklabels=list(car.contacts))
    middle.set_title("green: locked, red: slips, grey: open", fontsize="small")
    bottom.plot(balance.times, balance.residual / balance.turnover)
    bottom.set(xlabel="t in s", ylabel="energy residual\nover turnover")
    figure.savefig(path, dpi=80)


car = Car()
begin = time.perf_counter()
car.changes = car.run(8e-4)
duration = time.perf_counter() - begin
balance = car.read_balance()


if __name__ == "__main__":
    print(
        f"{len(car.changes)} changes of mode, {duration / UNTIL:.3f} s of computing time per simulated second"
    )
    for name in ("clutch 1", "clutch 2", "left brake", "right brake"):
        print(f"{name}: {balance.losses[name][-1]:.0f} J of heat")
    residual = np.max(np.abs(balance.residual)) / balance.turnover
    print(f"residual of the energy balance: {residual:.1g} of the energy turnover")
    if len(sys.argv) > 1:
        draw(sys.argv[1])
