"""The friction disc of Fig. 11: its steady whirl is unstable, and a modulated cycle takes its place."""

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
)  # on a continuous ring; contact_points=6 is the paper's own discretisation

(whirl,) = whirls(disc)  # all there are, each with its eigenvalues
(by_23,) = whirls(disc, ThreeTermRing(disc.contact_radius))  # the paper's simplified equations (23)

start = whirl.state  # x, y, angle, vx, vy, spin
start[0] += 1e-3
times = np.linspace(0.0, 1500.0, 15001)
trajectory = simulate(disc, start, times)
in_exudyn = exudyn_models.simulate(disc, start, times)

if __name__ == "__main__":
    for name, steady in (("ring", whirl), ("(23)", by_23)):
        slowest = steady.eigenvalues[1]  # the first is the zero of the phase
        print(
            f"{name}: radius {steady.radius:.6f} m, spin {steady.spin:.6f} rad/s, eigenvalue {slowest:.5f} 1/s"
        )
    print(f"there is a whirl from {onset_load(disc):.6f} N on")
    for name, motion in (("reference", trajectory), ("Exudyn", in_exudyn)):
        last = motion.radius[-2500:]  # one period of the modulation and some more
        print(f"{name}: the radius swings from {last.min():.6f} to {last.max():.6f} m")
