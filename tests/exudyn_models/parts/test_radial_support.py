"""Supports between bodies of every kind: conservation, Jacobians, sensors, and motions in closed form."""

import math

import numpy as np
import pytest
from free_bodies import coordinates, new_model, planar_body, rotor, run_explicitly
from pairs_of_bodies import (
    DISC,
    EULER,
    KINDS,
    MASTER,
    PAIRS,
    SPATIAL,
    assert_jacobian_is_that_of_exudyn,
    bodies_of,
    conserved,
    momenta_and_energy,
)
from scipy.integrate import quad

from exudyn_models import add_energy_balance, add_radial_support

ON_BODIES = [kinds for kinds in PAIRS if kinds[1] != "rotor"]
ALL_PAIRS = [(None, kind) for kind in ("planar", *SPATIAL)] + ON_BODIES
SUPPORT = {"stiffness": 3.0, "damping": 0.4, "hardening": 20.0, "offset": (0.05, -0.03)}
STOP = {"stop_gap": 0.2, "stop_stiffness": 30.0}


def supported(kinds, data=(MASTER, DISC), **support):
    mbs, nodes = bodies_of(kinds, data)
    return mbs, nodes, add_radial_support(mbs, *nodes, **support)


def in_plane(mbs, node):
    """Return x, y and angle of a disc and their rates."""
    q, q_t = coordinates(mbs, node)
    return np.hstack((q[[0, 1, -1]], q_t[[0, 1, -1]]))


@pytest.mark.parametrize(
    ("kinds", "stop"),
    [(kinds, {}) for kinds in ON_BODIES]
    + [(("planar", "planar"), STOP), (("Tait-Bryan", "rotation vector"), STOP)],
    ids=str,
)
@pytest.mark.filterwarnings("ignore:the energy balance is off")  # the test asserts how far
def test_two_bodies_conserve_momenta_and_their_energy_goes_to_springs_and_damper(kinds, stop):
    mbs, nodes, support = supported(kinds, **SUPPORT | stop)
    balance = add_energy_balance(
        mbs, gains={}, losses={"damper": support.power}, stored=[support.stored_energy]
    )
    deflection = support.add_sensor("deflection")
    mbs.Assemble()
    before, _ = momenta_and_energy(mbs, kinds, nodes)
    run_explicitly(mbs, 0.4, 500 if stop else 200)
    after, _ = momenta_and_energy(mbs, kinds, nodes)
    change = (after - before)[conserved(kinds)]
    np.testing.assert_allclose(change, 0.0, rtol=0.0, atol=1e-12 * np.abs(before).max())
    found = balance()
    assert found.losses["damper"][-1] > 0.01
    assert np.all(np.diff(found.losses["damper"]) > 0.0)
    lengths = np.linalg.norm(mbs.GetSensorStoredData(deflection)[:, 1:], axis=1)
    assert not stop or lengths.min() < STOP["stop_gap"] < lengths.max()  # every part of the law acted
    # Order 6 or 7 with steps of 2e-3 of the time scales; the kink at the stop spoils the order of one step.
    assert abs(found.residual).max() < (1e-4 if stop else 1e-10) * found.turnover


@pytest.mark.parametrize("base", [None, *KINDS, EULER])
@pytest.mark.parametrize("disc", [*(kind for kind in KINDS if kind != "rotor"), EULER])
@pytest.mark.parametrize("stop", [{}, STOP], ids=["hardening", "stop"])
def test_a_support_has_the_jacobian_that_exudyn_finds_by_differences(base, disc, stop):
    mbs, _, support = supported((base, disc), **SUPPORT | stop)
    assert_jacobian_is_that_of_exudyn(mbs, support.item)


@pytest.mark.parametrize(
    ("kinds", "law"),
    [(kinds, STOP) for kinds in ALL_PAIRS if kinds[0] != "rotor" and kinds[1] != "planar"]
    + [((None, kind), {"hardening": 0.0}) for kind in SPATIAL],  # has Exudyn's own spring
    ids=str,
)
def test_bodies_in_the_plane_move_as_planar_ones(kinds, law):
    flat_base = *MASTER[:2], [0.3, -0.2, 0.0, 0.0, 0.0, 0.1], [0.1, 0.05, 0.0, 0.0, 0.0, 2.0]
    flat_disc = *DISC[:2], [0.5, 0.1, 0.0, 0.0, 0.0, 0.4], [-0.2, 0.3, 0.0, 0.0, 0.0, -1.0]
    ends = []
    for pair in (kinds, (kinds[0] and "planar", "planar")):
        mbs, nodes, _ = supported(pair, (flat_base, flat_disc), **SUPPORT | law)
        run_explicitly(mbs, 0.4, 200)
        ends.append(np.hstack([in_plane(mbs, node) for node in nodes if node is not None]))
    np.testing.assert_allclose(ends[0], ends[1], rtol=0.0, atol=1e-13)


@pytest.mark.parametrize("gap", [0.2, 0.7])
def test_sensors_show_the_law(gap):
    mbs = new_model()
    base = planar_body(mbs, 2.0, 0.5, [1.0, 2.0, math.pi / 2.0], [0.0, 0.0, 3.0])
    # In the axes of the base, turned by 90°, the disc is at (0.5, 0.5), 0.5 from the relaxed position.
    disc = planar_body(mbs, 1.0, 0.5, [0.5, 2.5, 0.0], [-1.5, -1.3, 0.0])
    law = SUPPORT | STOP | {"offset": (0.2, 0.1), "stop_gap": gap}
    support = add_radial_support(mbs, base, disc, **law)
    shown = {name: support.add_sensor(name) for name in ("deflection", "force", "stored_energy", "power")}
    mbs.Assemble()
    found = {name: np.atleast_1d(mbs.GetSensorValues(sensor)) for name, sensor in shown.items()}

    def force_at(d):
        return 3.0 * d + 20.0 * d**3 + 30.0 * max(0.0, d - gap)

    # The point of the base under the disc moves with 3·(−0.5, −0.5), so the damper sees (0, 0.2).
    np.testing.assert_allclose(found["deflection"], [0.3, 0.4], atol=1e-15)
    share = force_at(0.5) / 0.5
    np.testing.assert_allclose(found["force"], [0.4 * share, -0.3 * share - 0.4 * 0.2, 0.0], atol=1e-14)
    assert found["stored_energy"] == pytest.approx(quad(force_at, 0.0, 0.5, points=[0.2])[0], rel=1e-12)
    assert support.stored_energy(mbs) == pytest.approx(found["stored_energy"][0], rel=1e-15)
    assert support.power(mbs, 0.0) == found["power"] == pytest.approx(0.4 * 0.2**2, rel=1e-12)


def test_a_disc_on_an_eccentric_shaft_centres_itself_above_its_critical_speed():
    # On a support that turns at the distance e from the axis r = C·e/(C − m·ω²), which changes sign at √(C/m).
    stiffness, e, end, speed = 1.0, 0.1, 3.0, 2.0
    r = stiffness * e / (stiffness - speed**2)
    mbs = new_model()
    shaft = rotor(mbs, 1e30, speed)
    disc = planar_body(mbs, 1.0, 0.5, [r, 0.0, 0.0], [0.0, speed * r, 0.0])
    add_radial_support(mbs, shaft, disc, stiffness=stiffness, damping=0.2, offset=(e, 0.0))
    run_explicitly(mbs, end, 2000)
    turn = r * np.exp(1j * speed * end)
    np.testing.assert_allclose(in_plane(mbs, disc)[:2], [turn.real, turn.imag], atol=1e-12)
