"""An engine for joints with dry friction, by Moreau's time stepping.

cd examples && friction-discs matrix --engine 09_joint_engine:simulate
"""

import sys

import numpy as np

import reference_model
from reference_model import FrictionJoint, Trajectory


def simulate(joint, initial_state, times, *, step):
    """Step the spin by all other moments, then let friction change it by at most its impulse."""
    (angle, spin), states = initial_state, [initial_state]
    points = np.transpose(joint.moment or [(0.0, 0.0)])
    for span, begin in zip(np.diff(times), times, strict=False):
        number = int(np.ceil(span / step))
        h = span / number
        most = h * joint.friction_moment / joint.inertia  # the largest change of the spin by friction
        for i in range(number):
            angle += 0.5 * h * spin
            load = np.interp(begin + (i + 0.5) * h, *points) - joint.stiffness * (angle - joint.offset)
            free = spin + h * (load - joint.damping * spin) / joint.inertia
            held = spin == 0.0 and abs(free) <= joint.static_ratio * most
            spin = 0.0 if held else free - min(max(free, -most), most)
            angle += 0.5 * h * spin
        states.append((angle, spin))
    return Trajectory(joint, times, states)


simulate.kinds, simulate.step = ("joint",), 1e-3  # s

joint = FrictionJoint(inertia=0.5, friction_moment=2.0, static_ratio=1.5, moment=((0.0, 0.0), (1.0, 5.0)))
times = np.linspace(0.0, 1.0, 41)
motion = simulate(joint, (0.0, 0.0), times, step=1e-3)
exact = reference_model.simulate(joint, (0.0, 0.0), times)  # breaks away at 1.5 times 2 N m, after 0.6 s


def draw(path):
    """Draw the spin under a growing moment."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(4.5, 3.2), layout="constrained")
    panel = figure.subplots()
    panel.plot(times, exact.states[:, 1], label="reference")
    panel.plot(times, motion.states[:, 1], "k.", label="this engine")
    panel.set(xlabel="t in s", ylabel="spin in rad/s")
    panel.legend()
    figure.savefig(path, dpi=80)


if __name__ == "__main__":
    print(f"final spin {motion.at_end[1]:.6f} rad/s, exact {exact.at_end[1]:.6f} rad/s")
    if len(sys.argv) > 1:
        draw(sys.argv[1])
