"""What a pin can do for ever: rest in space, stick, whirl; each found as such, with its stability."""

from dataclasses import replace

from reference_model import (
    PinOnDisc,
    power_balance,
    self_centred_equilibria,
    sticking_radius,
    whirl_orbit,
    whirls,
)

pin = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=1.5, offset=0.1)

(equilibrium,) = self_centred_equilibria(pin)  # eq. 3; an empty tuple where there is none
(whirl,) = whirls(replace(pin, offset=0.0))  # eq. 11, without the offset
orbit = whirl_orbit(pin)  # with it: a periodic orbit, found by shooting
radius = sticking_radius(replace(pin, friction_force=0.12))  # eq. 9; this load is too small for it
power = power_balance(orbit.trajectory)  # of one turn of the whirl

if __name__ == "__main__":
    print(f"rests at ({equilibrium.x:.4f}, {equilibrium.y:.4f}) m, stable: {equilibrium.stable}")
    print(f"whirls at {whirl.radius:.4f} m with {whirl.frequency:.4f} rad/s, stable: {whirl.stable}")
    print(f"with the offset about {orbit.mean.round(6)} m with {orbit.frequency:.6f} rad/s")
    print(f"the drive gives {power.drive_power:.4f} W")
    print(f"sticks for ever within {radius:.4f} m once μN = 0.12 N")
