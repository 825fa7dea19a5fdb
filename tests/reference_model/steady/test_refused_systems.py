import math
from dataclasses import replace

import pytest

from compare.claims.parameters import FIG5, FIG8, FIG11
from reference_model import basin_boundary, boundary_point, simulate, stick_slip_orbits, whirl_orbit
from reference_model.contact.contact_law import Pin, Ring
from reference_model.formulas.disc import pin_of
from reference_model.orbits import modulated_cycle
from reference_model.steady.bifurcation_curves import ParameterPlane, boundaries, crossings
from reference_model.steady.lyapunov_coefficient import growth_by_amplitude
from reference_model.steady.stability import (
    equilibrium_eigenvalues,
    onset_load,
    sliding_jacobian,
    turning_frame_jacobian,
    whirl_eigenvalues,
)
from reference_model.steady.steady_states import self_centred_equilibria, smallest_load_with_whirl, whirls

PIN = pin_of(FIG11)
SIX, OFFSET = replace(FIG11, contact_points=6), replace(FIG11, offset=0.1)
SPEED_LOAD = ("disc_speed", "friction_force"), (1.3, 0.001), (3.0, 0.08)
PLANE = ParameterPlane(FIG11, *SPEED_LOAD)


def near_the_onset():
    disc = replace(FIG11, friction_force=0.0206)
    return disc, whirls(disc)[0].state


STEADY = [
    *((f, (SIX,), "contact_points = 6") for f in (self_centred_equilibria, whirls, onset_load, whirl_orbit)),
    *((f, (PIN, Ring(0.1)), "a pin has point contact") for f in (self_centred_equilibria, whirls)),
    *((f, (OFFSET,), r"offset = 0\.1 m") for f in (whirls, smallest_load_with_whirl, onset_load)),
    (whirls, (FIG5,), r"offset = 0\.1 m.*whirl_orbit"),
    (smallest_load_with_whirl, (replace(FIG11, damping=0.0),), "damping = 0"),
    (smallest_load_with_whirl, (replace(FIG11, stiffness=0.0),), "stiffness = 0"),
    (smallest_load_with_whirl, (replace(FIG11, disc_speed=1.0),), "disc_speed = 1"),
    (onset_load, (replace(FIG11, shaft_damping=0.0),), "shaft_damping = 0 N m s/rad"),
    (onset_load, (replace(FIG11, shaft_speed=1.5),), "disc_speed - shaft_speed = 0 rad/s"),
    (sliding_jacobian, (FIG5, [0.25, 0.0, 0.0, 0.375]), "slip = 0 m/s: the pin is at rest"),
    (sliding_jacobian, (SIX, [0.25, 0.0, 0.0, 0.0, 0.375, 1.5]), "at rest"),
    (sliding_jacobian, (FIG5, [0.1, 0.0, 0.0, 0.0], Pin()), "a pin has point contact"),
    (turning_frame_jacobian, (FIG11,), "state = None: a disc may have several whirls"),
    (whirl_eigenvalues, (FIG11, [0.1, 0.2, 0.0, 0.0, 0.1, 1.0]), r"x = 0\.1 m, y = 0\.2 m"),
    (whirl_eigenvalues, (SIX, [0.1, 0.0, 0.0, 0.0, 0.1, 1.0]), "contact_points = 6"),
    (equilibrium_eigenvalues, (FIG8,), "state = None"),
    (equilibrium_eigenvalues, (replace(FIG5, friction_force=0.1),), r"0\.1 N = stiffness.*does not slide"),
    (growth_by_amplitude, near_the_onset(), "must be one of a complex pair"),
    (ParameterPlane, (OFFSET, *SPEED_LOAD), r"offset = 0\.1 m"),
    (ParameterPlane, (FIG11, ("disc_speed", "contact_points"), *SPEED_LOAD[1:]), "two of mass"),
    (ParameterPlane, (FIG11, ("mass", "stiffness"), (0.4, 0.5), (2.0, 1.0)), r"natural frequency 1\.58"),
    *(
        (ParameterPlane, (FIG11, SPEED_LOAD[0], lower, upper), message)
        for lower, upper, message in (
            ((1.3, 0.001), (1.2, 0.08), r"disc_speed from 1\.3 to 1\.2: the range"),
            ((0.9, 0.001), (3.0, 0.08), r"disc_speed = 0\.9 rad/s: the whirl exists"),
            ((-3.0, 0.001), (3.0, 0.08), "there is no whirl at rest"),
            ((1.3, 0.0), (3.0, 0.08), "friction_force = 0"),
        )
    ),
    (boundaries, (PLANE, "hopf"), "kind = 'hopf': it must be one of Hopf, fold, onset"),
    (crossings, (PLANE, "Hopf", "damping", 0.5), "name = 'damping': it must be one of disc_speed and"),
    (crossings, (PLANE, "Hopf", "disc_speed", 4.0), r"disc_speed = 4: it must lie between 1\.3 and 3"),
    (boundaries, (ParameterPlane(SIX, *SPEED_LOAD), "Hopf"), "contact_points = 6"),
]


def short_motion(until):
    return simulate(FIG11, [0.02, 0.0, 0.0, 0.0, 0.0, 1.3], [0.0, 0.5 * until, until])


SADDLE = stick_slip_orbits(FIG5, tolerance=1e-6, samples=2)[0]
IN_ONE_BASIN = (0.1, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0)
ORBITS = [
    (whirl_orbit, {"system": replace(FIG11, friction_force=0.018)}, r"a whirl exists only above 0\.020"),
    (whirl_orbit, {"system": replace(FIG5, disc_speed=-0.5)}, r"disc_speed = -0\.5 rad/s: the whirl exists"),
    *(
        (whirl_orbit, {"system": FIG11, name: value}, message)
        for name, value, message in (
            ("guess", "near", "guess = 'near': it must be Orbit or Whirl or None"),
            ("guess", whirls(PIN)[0], r"DiscOnDisc takes 6 numbers, not shape \(4,\)"),
            ("samples", 2.5, r"samples = 2\.5: it must be a whole number >= 1"),
            ("samples", 10**9, "samples = 1000000000: it must be a whole number >= 1 and <= 1000000"),
            ("at_crossing", math.nan, "at_crossing = nan: it must be finite"),
            ("at_crossing", "here", "at_crossing = 'here': it must be a number"),
        )
    ),
    *(
        (modulated_cycle, {"system": system, "guess": guess}, message)
        for system, guess, message in (
            (FIG11, None, "guess = None: it must be Orbit or Trajectory"),
            (FIG11, short_motion(1.0), "does not recur by t = 1 s: no two of"),
            (SIX, short_motion(1.0), "contact_points = 6: periodic orbits"),
            (OFFSET, short_motion(1.0), r"offset = 0\.1 m: a modulated cycle"),
        )
    ),
    (
        boundary_point,
        dict(zip(("orbit", "first", "second"), (SADDLE, *IN_ONE_BASIN), strict=True)),
        "same motion",
    ),
    (stick_slip_orbits, {"pin": FIG11}, "must be a PinOnDisc"),
    (stick_slip_orbits, {"pin": FIG5, "tolerance": 1.0}, "tolerance = 1: it must lie between"),
    (stick_slip_orbits, {"pin": FIG5, "samples": 0}, "samples = 0: it must be a whole number >= 1"),
    *(
        (basin_boundary, {"orbit": SADDLE, "ranges": ((-0.3, 0.5), (-0.4, 0.4)), name: value}, message)
        for name, value, message in (
            ("orbit", FIG5, "must be a StickSlipOrbit"),
            ("components", ("x", "x"), "they must be two of x, y, vx, vy"),
            ("components", ("x", "spin"), "they must be two of x, y, vx, vy"),
            ("ranges", ((0.0, 0.1), (0.2, 0.2)), r"range of vx = 0\.2 to 0\.2: it must increase"),
            ("ranges", ((0.0, math.nan), (0.2, 0.3)), r"ranges\[0, 1\] = nan: it must be finite"),
            ("ranges", ((0.0, 0.1),), "two pairs of numbers"),
            ("others", (0.0, 0.0), r"others = \(0\.0, 0\.0\): PinOnDisc takes 4 numbers"),
            ("cells", 1, "cells = 1: it must be a whole number >= 2"),
        )
    ),
]


@pytest.mark.parametrize(("function", "arguments", "message"), STEADY + ORBITS)
def test_system_without_a_steady_motion_or_an_orbit_is_refused(function, arguments, message):
    with pytest.raises(ValueError, match=message):
        function(**arguments) if isinstance(arguments, dict) else function(*arguments)
