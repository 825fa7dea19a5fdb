"""An eight-speed automatic shifts from third to fourth gear under load, and its converter locks up.

Its four planetary gears, two brakes and three clutches have the layout and the teeth of ZF's 8HP70. Brakes and
clutches stick exactly, and an energy balance checks the run. Pass a path to save a figure.
"""

import sys

import exudyn as exu
import numpy as np
from exudyn.itemInterface import Node1D, ObjectRotationalMass1D, SensorNode
from scipy.linalg import null_space

from exudyn_models import (
    add_energy_balance,
    add_planetary,
    add_ring_friction,
    add_road_load,
    add_torque,
    add_torque_converter,
    shift_sequence,
    solve_dynamic,
    torque_table,
)

MASS, WAY = 1700.0, 0.32 / 3.15  # kg; m of the car per rad of the output
INERTIAS = {  # kg m²; the output carries the car
    "engine": 0.2, "input": 0.06, "suns 1, 2": 0.02, "ring 1": 0.02, "carrier 1": 0.03, "ring 2": 0.02,
    "carrier 3": 0.02, "ring 3": 0.02, "output": 0.05 + MASS * WAY**2,
}  # fmt: skip
SETS = [  # sun, carrier, ring, and the ring's teeth over the sun's
    ("suns 1, 2", "carrier 1", "ring 1", 96.0 / 48.0),
    ("suns 1, 2", "input", "ring 2", 96.0 / 48.0),
    ("ring 2", "carrier 3", "ring 3", 111.0 / 69.0),
    ("ring 3", "output", "carrier 1", 85.0 / 23.0),
]
ELEMENTS = {  # brakes and clutches, and the rotors that they connect
    "A": (None, "suns 1, 2"), "B": (None, "ring 1"), "C": ("input", "ring 3"), "D": ("carrier 3", "output"),
    "E": ("ring 2", "ring 3"),
}  # fmt: skip
GEARS = dict(zip("12345678R", ("ABC", "ABE", "BCE", "BDE", "BCD", "CDE", "ACD", "ADE", "ABD"), strict=True))
FACING = {"contact_radius": 0.1, "friction_coefficient": 0.1, "plates": 5}  # 0.05 N m per newton
CONVERTER = [[0.0, 14.0, 2.1], [0.5, 14.5, 1.6], [0.87, 17.0, 1.0], [0.95, 27.0, 1.0], [1.0, np.inf, 1.0]]
ENGINE = [[100.0, 150.0], [200.0, 250.0], [400.0, 280.0], [600.0, 230.0]]  # rad/s, N m
RESISTANCE = {"mass": MASS, "rolling": 0.012, "drag_area": 0.65, "radius": WAY}
SHIFTS = shift_sequence(
    dict.fromkeys(ELEMENTS, 30e3), GEARS, start="3", shifts=[(0.5, "4")], duration=0.4
)  # N, s
LOCK_UP = 2.0, 2.5  # s, while its load rises
START, UNTIL, STEP = 70.0, 3.0, 1e-3  # rad/s of the output; s


def lock_up_load(time):
    """Return the load of the lock-up clutch in N."""
    return 20e3 * float(np.clip((time - LOCK_UP[0]) / (LOCK_UP[1] - LOCK_UP[0]), 0.0, 1.0))


def row(*weights):
    """Return the weights of rotors, by name, in a sum of speeds."""
    return np.array([sum(weight for one, weight in weights if one == name) for name in INERTIAS])


GEAR_ROWS = [row((sun, 1.0), (ring, ratio), (carrier, -1.0 - ratio)) for sun, carrier, ring, ratio in SETS]
SLIPS = {name: row((one, -1.0), (other, 1.0)) for name, (one, other) in ELEMENTS.items()}


def speeds_in(gear, output):
    """Return the speeds of all rotors but the engine in a gear."""
    rows = np.array([*GEAR_ROWS, *(SLIPS[name] for name in GEARS[gear])])
    (shape,) = null_space(rows[:, 1:]).T
    return shape * output / shape[-1]


class Car:
    """The model after its run; ``speeds`` are sensors."""

    def __init__(self):
        self.container = exu.SystemContainer()
        mbs = self.mbs = self.container.AddSystem()
        starts = speeds_in("3", START)
        self.nodes = {}
        for (name, inertia), speed in zip(INERTIAS.items(), [1.1 * starts[0], *starts], strict=True):
            self.nodes[name] = mbs.AddNode(Node1D(initialVelocities=[float(speed)]))
            mbs.AddObject(ObjectRotationalMass1D(nodeNumber=self.nodes[name], inertia=inertia))
        for *parts, ratio in SETS:
            add_planetary(mbs, *(self.nodes[part] for part in parts), ratio=ratio)
        engine = add_torque(mbs, self.nodes["engine"], torque_table(ENGINE))
        ends = self.nodes["engine"], self.nodes["input"]
        converter = add_torque_converter(mbs, *ends, table=CONVERTER)
        self.elements = {
            name: add_ring_friction(
                mbs, *(self.nodes.get(end) for end in pair), normal_load=SHIFTS.loads[name], **FACING
            )
            for name, pair in ELEMENTS.items()
        }
        self.elements["lock-up"] = add_ring_friction(mbs, *ends, normal_load=lock_up_load, **FACING)
        road = add_road_load(mbs, self.nodes["output"], **RESISTANCE)
        losses = {name: element.power for name, element in self.elements.items()}
        losses |= {"converter": converter.lost_power, "road": road.power}
        self.read_balance = add_energy_balance(mbs, gains={"engine": engine.power}, losses=losses)
        rates = exu.OutputVariableType.Coordinates_t
        options = {"storeInternal": True, "writeToFile": False}
        self.speeds = {
            name: mbs.AddSensor(SensorNode(nodeNumber=node, outputVariableType=rates, **options))
            for name, node in self.nodes.items()
        }
        settings = exu.SimulationSettings()
        settings.solution.file.write = False
        run = settings.timeIntegration
        run.endTime, run.numberOfSteps, run.verboseMode = UNTIL, round(UNTIL / STEP), 0
        breaks = [*SHIFTS.breaks, *LOCK_UP]
        solver = exu.DynamicSolverType.TrapezoidalIndex2
        self.changes = solve_dynamic(mbs, settings, solver, breaks=breaks)

    def events(self):
        """Return the time, the name and the new mode of each change of an element."""
        names = {int(element.item): name for name, element in self.elements.items()}
        return [
            (one.time, names[one.contact], int(one.after)) for one in self.changes if one.contact in names
        ]


def draw(path):
    """Draw speeds and the capacities of the elements against time."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8.0, 4.6), layout="constrained")
    top, bottom = figure.subplots(2, 1, sharex=True, height_ratios=(3, 1))
    for name in ("engine", "input", "output"):
        times, speeds = car.mbs.GetSensorStoredData(car.speeds[name]).T
        top.plot(times, speeds, label=name)
    top.set(ylabel="speed in rad/s")
    top.legend(frameon=False)
    times = np.linspace(0.0, UNTIL, 601)
    for name, load in {**{name: SHIFTS.loads[name] for name in "CD"}, "lock-up": lock_up_load}.items():
        bottom.plot(times, [load(time) / 1e3 for time in times], label=name)
    bottom.set(xlabel="t in s", ylabel="load in kN")
    bottom.legend(frameon=False)
    for time, *_ in car.events():
        top.axvline(time, color="0.8", linewidth=0.8, zorder=0)
    figure.savefig(path, dpi=80)


car = Car()
balance = car.read_balance()


if __name__ == "__main__":
    for time, name, mode in car.events():
        print(f"{time:.4f} s: {name} {'locks' if mode == 0 else 'opens' if mode == 2 else 'slips'}")
    residual = np.max(np.abs(balance.residual)) / balance.turnover
    print(f"residual of the energy balance: {residual:.1g} of the energy turnover")
    if len(sys.argv) > 1:
        draw(sys.argv[1])
