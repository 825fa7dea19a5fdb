"""The pin of Fig. 5: two nearly equal starts that end in different motions, and all its steady motions."""

import sys
from dataclasses import replace

import numpy as np

import exudyn_models
from reference_model import (
    PinOnDisc,
    Trajectory,
    power_balance,
    self_centred_equilibria,
    simulate,
    sticking_radius,
    whirl_orbit,
    whirls,
)

pin = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=1.5, offset=0.1)
times = np.linspace(0.0, 400.0, 4001)

to_equilibrium = simulate(pin, [0.1, 0.0, 0.00, 0.0], times)  # x, y, vx, vy
to_whirl = simulate(pin, [0.1, 0.0, 0.03, 0.0], times)
in_exudyn = exudyn_models.simulate(pin, [0.1, 0.0, 0.03, 0.0], times)  # same call, same type of result

(equilibrium,) = self_centred_equilibria(pin)  # eq. 3; an empty tuple if there is none
(whirl,) = whirls(replace(pin, offset=0.0))  # eq. 11, for zero offset
orbit = whirl_orbit(pin)  # with offset: a periodic orbit, found by shooting
radius = sticking_radius(replace(pin, friction_force=0.12))  # eq. 9; needs a larger load
power = power_balance(orbit.trajectory)  # of one turn of the whirl


def describe(trajectory: Trajectory) -> str:
    """Return the final radius and the number of stick phases in words."""
    sticks = trajectory.stick_phases
    return (
        f"radius {trajectory.radius[-1]:.6f} m after {len(sticks)} stick phases, the first from "
        f"t = {sticks[0].start:.6f} to {sticks[0].end:.6f} s"
    )


def draw(path):
    """Draw both paths in the plane and the radius against time."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8.0, 3.4), layout="constrained")
    plane, radii = figure.subplots(1, 2)
    for name, motion in (("to the equilibrium", to_equilibrium), ("to the whirl", to_whirl)):
        plane.plot(*motion.states[:, :2].T, linewidth=0.5, label=name)
        radii.plot(motion.times, motion.radius, label=name)
    plane.plot(equilibrium.x, equilibrium.y, "k+", label="equilibrium (3)")
    radii.axhline(whirl.radius, color="k", linestyle=":", label="whirl (11) without offset")
    plane.set(xlabel="x in m", ylabel="y in m", aspect="equal")
    radii.set(xlabel="t in s", ylabel="distance from the axis in m", ylim=(0.0, 1.4))
    plane.legend(fontsize="small")
    radii.legend(fontsize="small")
    figure.savefig(path, dpi=80)


if __name__ == "__main__":
    print("reference, to the equilibrium:", describe(to_equilibrium))
    print("reference, to the whirl:      ", describe(to_whirl))
    print("Exudyn, to the whirl:         ", describe(in_exudyn))
    print(f"rests at ({equilibrium.x:.4f}, {equilibrium.y:.4f}) m, stable: {equilibrium.stable}")
    print(f"whirls at {whirl.radius:.4f} m with {whirl.frequency:.4f} rad/s, stable: {whirl.stable}")
    print(f"with the offset it whirls about {orbit.mean.round(6)} m with {orbit.frequency:.6f} rad/s")
    print(f"the drive supplies {power.drive_power:.4f} W")
    print(f"sticks permanently within {radius:.4f} m if μN = 0.12 N")
    if len(sys.argv) > 1:
        draw(sys.argv[1])
