"""The two motions of Fig. 5: nearly the same start, one ends at rest in space, the other on a large circle."""

import numpy as np

import exudyn_models
from reference_model import PinOnDisc, Trajectory, simulate

pin = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=1.5, offset=0.1)
times = np.linspace(0.0, 400.0, 4001)

to_equilibrium = simulate(pin, [0.1, 0.0, 0.00, 0.0], times)  # x, y, vx, vy
to_whirl = simulate(pin, [0.1, 0.0, 0.03, 0.0], times)
in_exudyn = exudyn_models.simulate(pin, [0.1, 0.0, 0.03, 0.0], times)  # same call, same result


def describe(trajectory: Trajectory) -> str:
    """Say where a motion ends, and how often it stuck on the way."""
    sticks = trajectory.stick_phases
    return (
        f"radius {trajectory.radius[-1]:.6f} m after {len(sticks)} stick phases, the first from "
        f"t = {sticks[0].start:.6f} to {sticks[0].end:.6f} s"
    )


if __name__ == "__main__":
    print("reference, to the equilibrium:", describe(to_equilibrium))
    print("reference, to the whirl:      ", describe(to_whirl))
    print("Exudyn, to the whirl:         ", describe(in_exudyn))
