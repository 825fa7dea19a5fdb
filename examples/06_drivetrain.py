"""A clutch in a drivetrain runs up from 2000 to 4000 rpm at controlled slip.

Friction centres the disc below its critical speed. Near 2900 rpm the unbalance excites it, and above about 3200 rpm
friction drives a whirl that only the stop on the shaft limits. Pass a path to save a figure.
"""

import math
import sys

import numpy as np

from exudyn_models import PASSENGER_CAR, build_drivetrain, four_cylinder

RPM = math.pi / 30.0  # rad/s
TORQUE = 150.0  # N m, engine torque
SLIP = 20.0  # rad/s, target

vehicle, engine = PASSENGER_CAR.vehicle_inertia, PASSENGER_CAR.engine_inertia
TRANSMITTED = TORQUE * vehicle / (vehicle + engine)  # N m, at equal acceleration of both sides
HOLDING = PASSENGER_CAR.normal_load(TRANSMITTED)  # N

model = build_drivetrain(
    PASSENGER_CAR,
    normal_load=lambda time: max(0.0, HOLDING * (1.0 + 0.05 * (model.slip() - SLIP))),
    regularisation=1e-3,
    engine_speed=2000.0 * RPM,
    gearbox_speed=2000.0 * RPM - SLIP,
    engine_torque=four_cylinder(TORQUE, 1.0),
    shaft_torque=TRANSMITTED,
)
motion = model.run(1.4, sample_every=1e-3, tolerance=1e-6)
speed = motion.engine_speed / RPM
x, y = motion.disc[:, :2].T
# From the engine's axis and from the shaft's axis.
radius, deflection = np.hypot(x, y), np.hypot(x - PASSENGER_CAR.offset, y)


def draw(path):
    """Draw the speeds and the deflection of the disc's centre against time."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8.0, 5.0), layout="constrained")
    speeds, ways = figure.subplots(2, 1, sharex=True, height_ratios=(1, 2))
    speeds.plot(motion.times, speed, label="engine")
    speeds.plot(motion.times, motion.disc_velocity[:, 2] / RPM, label="disc")
    speeds.set(ylabel="speed in 1/min")
    ways.plot(motion.times, 1e3 * radius, linewidth=0.7, label="from the engine's axis")
    ways.plot(motion.times, 1e3 * deflection, linewidth=0.7, label="from the shaft's axis")
    ways.axhline(1e3 * PASSENGER_CAR.stop_gap, color="k", linestyle=":", label="clearance of the shaft")
    ways.set(xlabel="t in s", ylabel="disc's centre in mm")
    for panel in (speeds, ways):
        panel.legend(loc="upper left", frameon=False)
    figure.savefig(path, dpi=80)


if __name__ == "__main__":
    for low in range(2000, 4000, 250):
        there = radius[(speed >= low) & (speed < low + 250)]
        least, most = 1e3 * there.min(), 1e3 * there.max()
        print(f"{low} to {low + 250} 1/min: {least:.3f} to {most:.3f} mm from the engine's axis")
    for name, heat in motion.energy.losses.items():
        print(f"{name}: {heat[-1]:.1f} J of heat")
    residual = np.max(np.abs(motion.energy.residual)) / motion.energy.turnover
    print(f"residual of the energy balance: {residual:.1g} of the energy turnover")
    if len(sys.argv) > 1:
        draw(sys.argv[1])
