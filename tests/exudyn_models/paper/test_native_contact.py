"""Exudyn's built-in contact: forces by hand, errors of first order in the tolerance, and resting points."""

import cmath
import math
from dataclasses import replace

import numpy as np
import pytest
from free_bodies import exu, felt_accelerations, new_model, planar_body, rotor, settings_of

import reference_model
from compare.claims.parameters import FIG5, FIG11
from exudyn_models import add_native_friction, simulate_with_native_contact
from exudyn_models.forces.laws.places import ring_places
from reference_model.systems import DiscOnDisc

DISC = replace(FIG11, contact_points=6)
TABLE_DISC = replace(
    DISC,
    polar_inertia=0.0144,
    stiffness=0.0,
    damping=0.0,
    friction_force=0.3,
    disc_speed=0.0,
    shaft_damping=0.0,
)
THROWN = [0.0, 0.0, 0.0, 0.5, 0.2, 3.0]  # turns about one of its points before it comes to rest
CONTACT = {"friction_coefficient": 0.25, "normal_load": 2.0, "reach": 10.0}
CARRIED_ALONG = [
    0.03087753517369676, -0.12311233141527689, 5.686215448933846,
    0.18466849712291533, 0.04631630276054514, 1.5,
]  # fmt: skip
"""State of a disc that moves with the master disc, shortly before its release, because simulating rest is slow."""
RESTING = {
    "thrown": (TABLE_DISC, THROWN, 5.0),
    "released": (replace(DISC, friction_force=0.2, offset=0.1), CARRIED_ALONG, 0.2),
}
"""System, start and span in s of motions with rests or releases of single points of a disc."""
FEET = [(0.12, 0.0, 0.5), (-0.03, 0.07, 0.2), (-0.05, -0.06, 0.3)]
TOLERANCES = (1e-6, 1e-7)


@pytest.mark.parametrize("kind", ["ground", "rotor", "planar"])
@pytest.mark.parametrize(("radius", "points"), [(0.0, 1), (0.12, 6), (None, FEET)])
@pytest.mark.parametrize("epsilon", [1e-4, 1.5, 1e3])  # Coulomb friction, some of each, viscous friction
def test_forces_and_moments_on_both_bodies_obey_the_law(kind, radius, points, epsilon):
    rng = np.random.default_rng(1)
    for _ in range(4):
        mbs, (place, velocity, z, v) = new_model(), rng.normal(size=(4, 3))
        if kind == "planar":
            master = planar_body(mbs, 2.0, 0.7, place.tolist(), velocity.tolist())
        else:
            place[:2], velocity[:2] = 0.0, 0.0
            velocity[2] *= kind == "rotor"
            master = rotor(mbs, 0.7, velocity[2]) if kind == "rotor" else None
        disc = planar_body(mbs, 1.0, 0.02, z.tolist(), v.tolist())
        law = {"regularisation": epsilon, "contact_radius": radius, "contact_points": points}
        add_native_friction(mbs, master, disc, **CONTACT, **law)
        force, moment, master_moment = 0j, 0.0, 0.0
        for x, y, share in points if radius is None else ring_places(radius, points):
            arm = complex(x, y) * cmath.exp(1j * z[2])
            point = complex(*(z - place)[:2]) + arm
            slip = complex(*(v - velocity)[:2]) + 1j * v[2] * arm - 1j * velocity[2] * point
            friction = -0.5 * share * slip / max(abs(slip), epsilon)
            force += friction
            moment += (arm.conjugate() * friction).imag
            master_moment -= (point.conjugate() * friction).imag
        of_master = [-force.real / 2.0, -force.imag / 2.0, master_moment / 0.7]
        expected = [
            force.real,
            force.imag,
            moment / 0.02,
            *of_master[{"ground": 3, "rotor": 2, "planar": 0}[kind] :],
        ]
        sensors = [felt_accelerations(mbs, node) for node in (disc, master) if node is not None]
        mbs.Assemble()
        assert exu.MainSolverImplicitSecondOrder().SolveSystem(mbs, settings_of(1e-9, 1))
        found = np.hstack([mbs.GetSensorStoredData(sensor)[0, 1:] for sensor in sensors])
        np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-11)


@pytest.mark.parametrize(
    ("name", "kinds", "least", "most"),
    [
        ("thrown", ["slip", "pivot", "stick"], 0.9, 1.1),
        # Single points stay at the Coulomb limit until release; then slip grows like t² up to ε.
        ("released", ["stick", "slip"], 0.35, 0.55),
    ],
)
def test_rest_and_release_of_a_disc_have_errors_of_first_order_except_the_time_of_release(
    name, kinds, least, most
):
    disc, start, span = RESTING[name]
    exact = reference_model.simulate(disc, start, [0.0, span], tolerance=1e-11)
    assert [phase.kind for phase in exact.phases] == kinds
    states, times = [], []
    for tolerance in TOLERANCES:
        found = simulate_with_native_contact(disc, start, [0.0, span], tolerance=tolerance)
        assert [phase.kind for phase in found.phases] == kinds
        states.append(np.abs(found.at_end - exact.at_end).max())
        times.append(np.abs(found.stick_times - exact.stick_times).max())
    assert np.log10(states[0] / states[1]) == pytest.approx(1.0, abs=0.1), states
    assert least < np.log10(times[0] / times[1]) < most, times


@pytest.mark.parametrize(
    ("system", "offset", "span", "distance"),
    [
        # All start on a table at rest from the offset towards an edge of the triangle with 1 m/s: a pin without
        # spring after v·t − ½(μN/m)t², two pins on springs just before they reverse, and a disc without spin.
        (replace(FIG5, stiffness=0.0), 0.0, 10.0, 10.0 - 0.5 * 0.01 * 10.0**2),
        (FIG5, 0.0, 1.5, math.sin(1.5) - 0.01 * (1.0 - math.cos(1.5))),
        (FIG5, -1.0, 1.5, math.sin(1.5) - 0.01 * (1.0 - math.cos(1.5))),
        (replace(DISC, stiffness=0.0, contact_radius=0.5), 0.0, 1.0, 1.0 - 0.5 * 0.01),
    ],
)
def test_the_contact_persists_at_any_distance(system, offset, span, distance):
    system = replace(system, friction_force=0.01, damping=0.0, disc_speed=0.0, offset=offset)
    start = [offset, 0.0, -1.0, 0.0]
    if isinstance(system, DiscOnDisc):
        system, start = replace(system, shaft_damping=0.0), [0.0, 0.0, 0.0, -1.0, 0.0, 0.0]
    found = simulate_with_native_contact(system, start, [0.0, span])
    assert found.at_end[:2] == pytest.approx([offset - distance, 0.0], abs=1e-9)
