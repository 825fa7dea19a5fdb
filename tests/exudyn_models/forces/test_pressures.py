"""An annulus brakes with the lever of its pressure, in closed form or by the moments of a function."""

import pytest
from free_bodies import coordinates, new_model, planar_body, rotor, run_explicitly

from exudyn_models import add_ring_friction

MU, LOAD = 0.3, 50.0


def towards_the_rim(radius):
    return 1.0 + 200.0 * radius**2


def levers(inner, outer):
    """Effective radii in m, by the textbook or by the moments of the pressure."""
    load = 0.5 * (outer**2 - inner**2) + 50.0 * (outer**4 - inner**4)
    uniform = 2.0 / 3.0 * (outer**3 - inner**3) / (outer**2 - inner**2)
    return {
        "uniform": uniform,
        "wear": 0.5 * (outer + inner),
        towards_the_rim: ((outer**3 - inner**3) / 3.0 + 40.0 * (outer**5 - inner**5)) / load,
        (lambda radius: 7.0): uniform,
    }


@pytest.mark.parametrize(("inner", "outer"), [(0.08, 0.12), (0.0, 0.12), (0.119, 0.12)])
@pytest.mark.parametrize("kind", ["rotor", "planar"])
@pytest.mark.parametrize("case", range(4))
def test_an_annulus_brakes_with_the_lever_of_its_pressure(inner, outer, kind, case):
    pressure, lever = list(levers(inner, outer).items())[case]
    mbs = new_model()
    disc = (
        rotor(mbs, 2.0, 10.0) if kind == "rotor" else planar_body(mbs, 1.0, 2.0, [0.0] * 3, [0.0, 0.0, 10.0])
    )
    annulus = {"inner_radius": inner, "outer_radius": outer, "pressure": pressure}
    friction = add_ring_friction(
        mbs, None, disc, friction_coefficient=MU, normal_load=LOAD, regularisation=1e-4, **annulus
    )
    assert friction.effective_radius == pytest.approx(lever, rel=1e-13)
    mbs.Assemble()
    run_explicitly(mbs, 1.0, 10)
    assert coordinates(mbs, disc)[1][-1] == pytest.approx(10.0 - MU * LOAD * lever / 2.0, rel=1e-13)
