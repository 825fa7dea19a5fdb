"""A car accelerates with one driven wheel on ice, with an open differential, a preload, and ramps.

Ramps press the plates of a limited slip differential with the moment that it transmits, without a delay. All contacts
stick exactly: the plates, and both tyres. Pass a path to save a figure.
"""

import sys

import exudyn as exu
from exudyn.itemInterface import Node1D, ObjectMass1D, ObjectRotationalMass1D, SensorNode

from exudyn_models import add_differential, add_energy_balance, add_torque, add_tyre, solve_dynamic

CAR, WHEEL, CASE = 1400.0, 1.2, 0.4  # kg, kg m², kg m²
RADIUS, LOAD = 0.3, 3500.0  # m, N on each driven wheel
ICE, ROAD = 0.1, 0.9  # friction coefficients of the left and the right tyre
TORQUE = 300.0  # N m/s on the case, from 0 s on
DIFFERENTIALS = {  # preload in N m, ramp
    "open": (0.0, 0.0),
    "preload of 50 N m": (50.0, 0.0),
    "ramps": (20.0, 0.3),
}
UNTIL, STEP = 2.5, 1e-3  # s


class Start:
    """A start with one differential; ``speeds`` are sensors of wheels and car."""

    def __init__(self, preload, ramp):
        self.container = exu.SystemContainer()
        mbs = self.mbs = self.container.AddSystem()
        self.nodes = {name: mbs.AddNode(Node1D()) for name in ("case", "left", "right", "car")}
        for name, inertia in (("case", CASE), ("left", WHEEL), ("right", WHEEL)):
            mbs.AddObject(ObjectRotationalMass1D(nodeNumber=self.nodes[name], inertia=inertia))
        mbs.AddObject(ObjectMass1D(nodeNumber=self.nodes["car"], mass=CAR))
        engine = add_torque(mbs, self.nodes["case"], lambda time, angle, speed: TORQUE * time)
        sides = self.nodes["left"], self.nodes["right"]
        self.differential = add_differential(mbs, self.nodes["case"], *sides, preload=preload, ramp=ramp)
        self.tyres = [
            add_tyre(
                mbs, wheel, self.nodes["car"], radius=RADIUS, friction_coefficient=grip, normal_load=LOAD
            )
            for wheel, grip in zip(sides, (ICE, ROAD), strict=True)
        ]
        parts = {"plates": self.differential, "left tyre": self.tyres[0], "right tyre": self.tyres[1]}
        self.read_balance = add_energy_balance(
            mbs, gains={"engine": engine.power}, losses={name: part.power for name, part in parts.items()}
        )
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
        self.changes = solve_dynamic(mbs, settings, exu.DynamicSolverType.TrapezoidalIndex2)

    def end(self, name):
        """Return the final speed of a rotor in rad/s, or that of the car in m/s."""
        return float(self.mbs.GetSensorValues(self.speeds[name]))


def draw(path):
    """Draw the speeds of wheels and car against time."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8.0, 3.4), layout="constrained")
    for panel, (name, start) in zip(
        figure.subplots(1, len(starts), sharey=True), starts.items(), strict=True
    ):
        for part, factor in (("left", RADIUS), ("right", RADIUS), ("car", 1.0)):
            times, speeds = start.mbs.GetSensorStoredData(start.speeds[part]).T
            label = part if part == "car" else f"{part} wheel"
            panel.plot(times, factor * speeds, label=label, linestyle="--" if part == "car" else "-")
        panel.axvline(start.changes[0].time, color="0.7", linewidth=1)
        panel.set(title=name, xlabel="t in s")
    figure.axes[0].set(ylabel="speed in m/s")
    figure.axes[0].legend(frameon=False)
    figure.savefig(path, dpi=80)


starts = {name: Start(*numbers) for name, numbers in DIFFERENTIALS.items()}


if __name__ == "__main__":
    for name, start in starts.items():
        print(f"{name}: {start.end('car'):.2f} m/s after {UNTIL:g} s", end="; ")
        print(f"the left wheel spins after {start.changes[0].time:.3f} s", end="; ")
        heat = start.read_balance().losses
        print(
            f"{heat['left tyre'][-1] / 1e3:.1f} kJ on the ice, {heat['plates'][-1] / 1e3:.1f} kJ in the plates"
        )
    if len(sys.argv) > 1:
        draw(sys.argv[1])
