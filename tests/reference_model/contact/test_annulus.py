"""Friction of an annulus against integrals over its rings; a study measures its orders of convergence."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from reference_model.contact.annulus import Annulus
from reference_model.contact.contact_law import Ring

INNER, OUTER = 0.08, 0.12
FACING = Annulus(INNER, OUTER)
# At S = 1 the resting radius is U: inside the annulus, at its edges, just outside and far outside.
SLIPS = [0.0, 0.03, 0.08, 0.0801, 0.119999, 0.1201, 0.3]


@pytest.mark.parametrize("inner", [0.0, INNER])
@pytest.mark.parametrize(
    "pressure", [None, lambda r: 1.0 / r, lambda r: 1.0 + 50.0 * r**2], ids=["uniform", "worn", "rising"]
)
def test_friction_of_an_annulus_is_the_integral_over_its_rings(inner, pressure):
    weight = pressure or (lambda _: 1.0)
    for slip in SLIPS:
        kink = [slip] if inner < slip < OUTER else None

        def integral(function, kink=kink):
            return quad(function, inner, OUTER, points=kink, epsabs=1e-15, epsrel=1e-13, limit=200)[0]

        def rings(radius, slip=slip):
            return Ring(radius).shares(slip, 1.0)

        load = integral(lambda r: weight(r) * r)
        force = integral(lambda r: weight(r) * r * rings(r).resistance) / load
        moment = integral(lambda r: weight(r) * r * rings(r).moment) / load
        for spin in (1.0, -1.0):
            found = Annulus(inner, OUTER, pressure=pressure).shares(slip, spin)
            assert found.resistance == pytest.approx(force, abs=1e-11), slip
            assert found.moment == pytest.approx(math.copysign(moment, spin), abs=1e-11 * OUTER), slip


@pytest.mark.parametrize("gap", [0.0, 1e-16, 1e-14, 1e-9])
@pytest.mark.parametrize("end", [INNER, OUTER])
def test_slopes_are_finite_and_continuous_where_the_ring_at_an_edge_has_a_resting_point(gap, end):
    at_edge = np.array(FACING.slopes(end, 1.0))
    # The change of the slope is of order gap·ln(gap)/width.
    change = 30.0 * gap / (OUTER - INNER) / end + 1e-12
    for side in (1.0, -1.0):
        found = FACING.slopes(end * (1.0 + side * gap), 1.0)
        assert np.array(found) == pytest.approx(at_edge, abs=change)
