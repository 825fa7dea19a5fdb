"""A time-stepping engine without a turntable: it passes with a friction cone and fails with a box.

cd examples && friction-discs report block --engine 10_block_on_a_plane:cone --engine 10_block_on_a_plane:box
"""

import sys
from functools import partial
from math import ceil

import numpy as np

from reference_model import Trajectory


def time_stepping(block, initial_state, times, *, step, bounded):
    """Apply the impulse that would stop the block within a step, bounded by that of μN (Moreau and Jean)."""
    m, friction = block.mass, block.friction_force
    states = [np.array(initial_state, dtype=float)]
    for span in np.diff(times):
        z, v = states[-1].view(complex).tolist()  # position and velocity, x + iy
        steps = ceil(span / step)
        h = span / steps
        for _ in range(steps):
            z += h / 2 * v
            v -= h / m * (block.stiffness * (z - block.offset) + block.damping * v)
            v += bounded(-m * v, friction * h) / m
            z += h / 2 * v
        states.append(np.array([z, v]).view(float))
    return Trajectory(block, np.array(times), np.array(states))


def in_circle(impulse, most):  # noqa: D103
    return impulse * min(1.0, most / max(abs(impulse), 1e-99))


def in_box(impulse, most):  # noqa: D103
    return complex(max(-most, min(impulse.real, most)), max(-most, min(impulse.imag, most)))


cone, box = (partial(time_stepping, bounded=law) for law in (in_circle, in_box))
for engine in (cone, box):
    engine.kinds, engine.nonlinear, engine.step = ("block",), False, 1e-3  # s


def slide(law, angle):
    """Return the motion of a block of 1 kg that starts at 1 m/s in the direction ``angle`` against μN = 1 N."""
    from reference_model import PinOnDisc

    block = PinOnDisc(mass=1.0, stiffness=0.0, damping=0.0, friction_force=1.0, disc_speed=0.0)
    return law(block, [0.0, 0.0, np.cos(angle), np.sin(angle)], np.linspace(0.0, 1.5, 31), step=0.01)


def draw(path):
    """Draw the paths of a block that starts in six directions, by both laws."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(4.0, 3.4), layout="constrained")
    panel = figure.subplots()
    for name, law, style in (("cone", cone, "C0-"), ("box", box, "C3--")):
        for number, angle in enumerate(np.radians(np.arange(0, 91, 18))):
            panel.plot(
                *slide(law, angle).states[:, :2].T,
                style,
                marker="o",
                markevery=[-1],
                label=name if number == 0 else None,
            )
    panel.set(xlabel="x in m", ylabel="y in m", aspect="equal")
    panel.legend()
    figure.savefig(path, dpi=80)


if __name__ == "__main__":
    for name, law in (("cone", cone), ("box", box)):
        print(
            f"{name}: a start at 45° ends after {np.hypot(*slide(law, np.pi / 4).at_end[:2]):.3f} m (Coulomb: 0.5 m)"
        )
    if len(sys.argv) > 1:
        draw(sys.argv[1])
