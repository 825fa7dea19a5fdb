"""The friction disc of Fig. 11: its steady whirl is unstable, and a modulated cycle replaces it."""

import sys

import numpy as np

import exudyn_models
from reference_model import DiscOnDisc, ThreeTermRing, onset_load, simulate, whirls

disc = DiscOnDisc(
    mass=1.0,
    polar_inertia=1.0,
    stiffness=1.0,
    damping=0.5,
    friction_force=0.0225,
    disc_speed=1.5,
    contact_radius=0.12,
    shaft_damping=0.015,
    shaft_speed=1.25,
)  # on a continuous ring; the paper uses contact_points=6

(whirl,) = whirls(disc)  # all whirls, each with its eigenvalues
(by_23,) = whirls(disc, ThreeTermRing(disc.contact_radius))  # the paper's simplified equations (23)

start = whirl.state  # x, y, angle, vx, vy, spin
start[0] += 1e-3
times = np.linspace(0.0, 1500.0, 15001)
trajectory = simulate(disc, start, times)
in_exudyn = exudyn_models.simulate(disc, start, times)


def draw(path):
    """Draw the radius while the modulated cycle develops, and the cycle itself in both codes."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8.0, 3.4), layout="constrained")
    growth, cycle = figure.subplots(1, 2, width_ratios=(3, 2))
    growth.plot(times, trajectory.radius, linewidth=0.5)
    growth.axhline(whirl.radius, color="k", linestyle=":", label="unstable whirl")
    growth.set(xlabel="t in s", ylabel="radius in m")
    growth.legend()
    for name, motion, style in (("reference", trajectory, "-"), ("Exudyn", in_exudyn, "--")):
        spins = motion.states[:, 5]
        cycle.plot(motion.radius[-2500:], spins[-2500:], style, label=name)
    cycle.plot(whirl.radius, whirl.spin, "k+")
    cycle.set(xlabel="radius in m", ylabel="spin in rad/s")
    cycle.legend()
    figure.savefig(path, dpi=80)


if __name__ == "__main__":
    for name, steady in (("ring", whirl), ("(23)", by_23)):
        slowest = steady.eigenvalues[1]  # the first is zero and belongs to the phase
        print(
            f"{name}: radius {steady.radius:.6f} m, spin {steady.spin:.6f} rad/s, eigenvalue {slowest:.5f} 1/s"
        )
    print(f"the whirl starts at {onset_load(disc):.6f} N")
    for name, motion in (("reference", trajectory), ("Exudyn", in_exudyn)):
        last = motion.radius[-2500:]  # a little more than one period of the modulation
        print(f"{name}: the radius oscillates from {last.min():.6f} to {last.max():.6f} m")
    if len(sys.argv) > 1:
        draw(sys.argv[1])
