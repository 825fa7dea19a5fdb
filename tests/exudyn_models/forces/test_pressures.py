"""Annuli under pressures that vary over the radius."""

import exudyn as exu
import numpy as np
import pytest
from free_bodies import coordinates, momenta, planar_body, rotor, run_explicitly
from scipy.integrate import quad

from exudyn_models import add_ring_friction
from exudyn_models.forces.friction_laws import CONTINUOUS
from exudyn_models.forces.laws.pressures import density_of, mean_radius_of
from exudyn_models.forces.slip_potential import (
    ring_potentials,
    slip_potential_gradient,
    slip_potential_of_circles,
)

MU, LOAD = 0.3, 50.0
ANNULI = [(0.08, 0.12), (0.0, 0.12), (0.119, 0.12)]


def towards_the_rim(radius):
    return 1.0 + 200.0 * radius**2


def levers(inner, outer):
    """Effective radii in m, by the textbook or by the moments of the pressure."""
    load = 0.5 * (outer**2 - inner**2) + 50.0 * (outer**4 - inner**4)
    return {
        "uniform": 2.0 / 3.0 * (outer**3 - inner**3) / (outer**2 - inner**2),
        "wear": 0.5 * (outer + inner),
        towards_the_rim: ((outer**3 - inner**3) / 3.0 + 40.0 * (outer**5 - inner**5)) / load,
        (lambda radius: 7.0): 2.0 / 3.0 * (outer**3 - inner**3) / (outer**2 - inner**2),
    }


@pytest.mark.parametrize(("inner", "outer"), ANNULI)
@pytest.mark.parametrize("kind", ["rotor", "planar"])
@pytest.mark.parametrize("case", range(4))
def test_an_annulus_brakes_with_the_lever_of_its_pressure(inner, outer, kind, case):
    pressure, lever = list(levers(inner, outer).items())[case]
    mbs = exu.SystemContainer().AddSystem()
    disc = (
        rotor(mbs, 2.0, 10.0) if kind == "rotor" else planar_body(mbs, 1.0, 2.0, [0.0] * 3, [0.0, 0.0, 10.0])
    )
    friction = add_ring_friction(
        mbs,
        None,
        disc,
        inner_radius=inner,
        outer_radius=outer,
        friction_coefficient=MU,
        normal_load=LOAD,
        regularisation=1e-4,
        pressure=pressure,
    )
    assert friction.effective_radius == pytest.approx(lever, rel=1e-13)
    mbs.Assemble()
    run_explicitly(mbs, 1.0, 10)
    assert coordinates(mbs, disc)[1][-1] == pytest.approx(10.0 - MU * LOAD * lever / 2.0, rel=1e-13)


@pytest.mark.parametrize("pressure", ["wear", towards_the_rim], ids=["wear", "function"])
@pytest.mark.parametrize("speed", [0.01, 0.05, 0.09, 0.1, 0.115, 0.13, 0.5])
def test_slip_of_an_annulus_is_the_mean_of_its_rings_by_their_share_of_the_load(pressure, speed):
    inner, outer = 0.08, 0.12

    def share(radius):
        return 1.0 if pressure == "wear" else radius * pressure(radius)

    def potential(radius):
        return ring_potentials(np.array([speed]), np.array([radius]))[0]

    points = [speed] if inner < speed < outer else None
    exact = quad(lambda r: share(r) * potential(r), inner, outer, points=points, epsabs=1e-14, epsrel=1e-12)[
        0
    ]
    exact /= quad(share, inner, outer, epsrel=1e-13)[0]
    density = density_of(pressure, inner, outer)
    assert slip_potential_of_circles(speed, 1.0, inner, outer, density) == pytest.approx(exact, rel=1e-9)


def test_a_pressure_of_a_function_that_is_constant_is_the_uniform_one():
    density = density_of(lambda radius: 3.0, 0.08, 0.12)
    for speed in (0.0, 0.03, 0.1, 1.0):
        found = slip_potential_gradient(speed, 1.0, 0.08, 0.12, density)
        assert found == pytest.approx(slip_potential_gradient(speed, 1.0, 0.08, 0.12, CONTINUOUS), rel=1e-13)
    assert mean_radius_of(density, 0.08, 0.12) == pytest.approx(0.10133333333333333, rel=1e-14)


@pytest.mark.parametrize("pressure", ["wear", towards_the_rim], ids=["wear", "function"])
def test_momenta_are_kept_under_every_pressure(pressure):
    mbs = exu.SystemContainer().AddSystem()
    master = planar_body(mbs, 2.0, 0.7, [0.3, -0.2, 0.1], [0.1, 0.05, 2.0])
    disc = planar_body(mbs, 1.0, 0.02, [0.31, -0.19, 0.4], [-0.2, 0.3, -1.0])
    add_ring_friction(
        mbs,
        master,
        disc,
        inner_radius=0.08,
        outer_radius=0.12,
        friction_coefficient=0.25,
        normal_load=2.0,
        regularisation=1e-3,
        pressure=pressure,
    )
    mbs.Assemble()
    bodies = [(master, 2.0, 0.7), (disc, 1.0, 0.02)]
    before = momenta(mbs, bodies)
    run_explicitly(mbs, 0.1, 200)
    np.testing.assert_allclose(momenta(mbs, bodies), before, rtol=0.0, atol=1e-13)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"pressure": "even"}, "pressure = 'even': it must be 'uniform', 'wear' or a function of the radius"),
        ({"pressure": lambda r: r - 0.1}, r"pressure\(0.08 m\) = -0.02: it must be >= 0"),
        ({"pressure": lambda r: 0.0}, "it must be a smooth function, > 0 somewhere"),
        ({"pressure": lambda r: 1.0 if r > 0.1 else 2.0}, "misses it by 0.2 of its largest share"),
        ({"pressure": lambda r: float("nan")}, r"pressure\(0.08 m\) = nan"),
        (
            {"pressure": "wear", "inner_radius": None, "outer_radius": None, "contact_radius": 0.1},
            "pressure = 'wear': it must be left out but for an annulus",
        ),
    ],
)
def test_what_is_no_pressure_is_refused(change, message):
    mbs = exu.SystemContainer().AddSystem()
    contact = {
        "inner_radius": 0.08,
        "outer_radius": 0.12,
        "friction_coefficient": MU,
        "normal_load": LOAD,
        "regularisation": 1e-4,
    }
    with pytest.raises(ValueError, match=message):
        add_ring_friction(mbs, None, rotor(mbs, 1.0, 0.0), **contact | change)
