"""Motions that once took too many steps or missed their tolerance; a comment states each reason.

A step takes some microseconds. The bounds are 1.3 times the numbers of steps that were measured.
"""

import numpy as np
import pytest

from reference_model import DiscOnDisc, PinOnDisc, simulate


def disc(**values):
    return DiscOnDisc(**{"mass": 1.0, "stiffness": 1.0, "offset": 0.0} | values)


CREEPING_POINTS = disc(
    mass=3.3518, stiffness=1.35678, damping=13.5159, friction_force=2.59677, disc_speed=-0.33557,
    polar_inertia=51.87, contact_radius=27.074, shaft_damping=163.887, shaft_speed=0.0, contact_points=4,
)  # fmt: skip
HARD = {
    "a disc creeps while it turns about a point": (
        CREEPING_POINTS, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0], (0.0, 38.0), None, 1_400, 1e-9,
    ),
    "a disc creeps while one point hardly slips": (
        CREEPING_POINTS, [10.0, 0.0, 0.0, 0.0, 0.0, 0.0], (0.0, 38.0), None, 2_300, 1e-8,
    ),
    # Friction turns the slip at ten times the natural frequency, so stability does not limit explicit steps.
    "the direction of slip settles much faster than it changes": (
        disc(polar_inertia=0.38685601, damping=31.0448825, friction_force=48.1556219, disc_speed=3.18207915,
             contact_radius=0.0706922026, shaft_damping=1.9890612, shaft_speed=0.0530970617, contact_points=24),
        [-0.164514, 0.496446, 82.815831, -1.314042, -0.417368, 0.633226], (0.0, 4.0), None, 700, 1e-10,
    ),
    "slip turns once in many decay times of a strong damper": (
        PinOnDisc(mass=1.0, stiffness=1.0, damping=21.6236242, friction_force=27.2237607, disc_speed=2.58398372,
                  offset=8.13455119),
        [-1.14337043, 0.1767777, 0.0, 0.0], (0.0, 30.0), ["slip"], 2_000, 2e-8,
    ),
    # R = 200 κ, so the inertia of the point itself turns its first direction of slip.
    "a point far out on a light disc begins to slip": (
        disc(polar_inertia=0.0470838335426834, damping=0.9078313152049701, friction_force=0.20300231350674897,
             disc_speed=0.04933418323377579, offset=8.395805999767857, contact_radius=43.304912771594886,
             shaft_damping=0.1084058576333912, shaft_speed=33.91703697093388, contact_points=4),
        [8.37217697420397, 0.1602771829526167, 1.6415536817565413,
         0.02141761400553637, -0.0007147354594546074, 0.058912476458336485],
        (0.0, 0.1), ["pivot", "slip"], 1_000, 1e-8,
    ),
    # Collocation continued with 1,287 steps of 1e-7 T.
    "one of eleven points comes to rest": (
        disc(damping=0.03933669598513251, friction_force=42.79815743660217, offset=31.936409731463634,
             disc_speed=0.024464031679646767, polar_inertia=45.527552506407126, contact_radius=0.14069777828540544,
             contact_points=11, shaft_damping=67.17097125597903, shaft_speed=0.10625455896077723),
        [23.85388993229278, 9.823573429092436, -1.2667978787186764,
         -0.024464031679646767 * 9.823573429092436, 0.024464031679646767 * 23.85388993229278, 0.024464031679646767],
        (26.9, 48.0), ["stick", "slip", "pivot"], 200, 1e-10,
    ),
    # One point slips at 1e-9, and the disc turns about it so slowly that friction of the other points changes.
    "points slow down together with the spin": (
        disc(polar_inertia=0.03998109482112049, damping=1.4871663898968424, friction_force=0.3703489740541269,
             disc_speed=0.2576902384454173, contact_radius=31.300008177985706, contact_points=6,
             shaft_damping=2.1051544974681895, shaft_speed=2.584547264519307),
        [-0.75743052, 0.50400537, 0.07696222, 0.17785081, -0.20103693, 6.14738994],
        (0.0, 5.0), ["slip", "stick"], 950, 1e-8,
    ),
    # R = 61 κ and the rim nearly rests at one point, so Newton's method allowed steps of 1e-5 T only.
    "slip begins where friction bends strongly with its direction": (
        disc(damping=0.9122493566453166, friction_force=0.42246193396754766, offset=0.011738777525018004,
             disc_speed=-0.30831513496411733, polar_inertia=0.014227018671365579, contact_radius=7.331675604559605,
             shaft_damping=5.506612266964061, shaft_speed=-0.012909855736200413),
        [1.13282222, 1.18174411, 5.41952252, -9.11512326, -3.06168674, -0.30831513],
        (0.0, 50.0), ["slip", "stick"] * 3, 1_900, 3e-8,
    ),
    # The disc turns more and more slowly about a point whose friction is 1e-6 too small for a pivot.
    "friction can hardly hold a point": (
        disc(damping=0.5, polar_inertia=1.0, contact_radius=0.12, shaft_damping=0.015, shaft_speed=1.25,
             disc_speed=1.5, contact_points=6, friction_force=0.28453382, offset=0.12840305),
        [-0.00925065063, 0.0187610662, 1.59091343, -0.028034818, -0.013870499, 1.50093659],
        (0.0, 0.1), ["slip", "stick"], 550, 1e-11,
    ),
    # The pull exceeds friction once per turn, slightly and briefly.
    "friction hardly holds a pin once per turn": (
        PinOnDisc(mass=1.0, stiffness=1.0, damping=0.011224733781740163, friction_force=4.177781705193454,
                  disc_speed=9.397081774781364, offset=0.014432604751170697, hardening=62.05311478353729),
        [0.0746237, -0.01714718, -0.00907985, 0.09159993], (0.0, 8.0), ["slip", "stick"] * 7, 1_300, 2e-9,
    ),
}  # fmt: skip


@pytest.mark.parametrize("motion", HARD)
def test_hard_motion_reaches_its_tolerance_in_few_steps(motion):
    system, start, (first, last), kinds, most_steps, error = HARD[motion]
    times = np.linspace(first, last, 101)
    found, tight = (simulate(system, start, times, tolerance=tolerance) for tolerance in (1e-9, 1e-10))
    assert kinds is None or [phase.kind for phase in found.phases] == kinds
    assert found.solution.steps < most_steps
    assert np.abs(found.states - tight.states).max() < error
