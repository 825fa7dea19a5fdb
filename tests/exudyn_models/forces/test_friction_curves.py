"""Words of drivetrains for a coefficient: a table over slip, a peak at rest, plates, drag apart from coast."""

from typing import Any

import exudyn as exu
import exudyn.itemInterface
import numpy as np
import pytest
from free_bodies import coordinates, rotor, run_explicitly
from pairs_of_bodies import (
    DISC,
    MASTER,
    PAIRS,
    assert_jacobian_is_derivative,
    body,
    conserved,
    momenta_and_energy,
)

from exudyn_models import add_ring_friction, solve_dynamic
from exudyn_models.forces.friction_laws import CONTINUOUS, NONE_HELD
from exudyn_models.forces.laws.curves import peak_over_sliding
from exudyn_models.forces.load_and_coefficient import LoadAndCoefficient

items: Any = exudyn.itemInterface

RING = {"contact_radius": 0.12, "friction_coefficient": 0.25, "normal_load": 2.0, "regularisation": 1e-3}
TABLE = [[0.0, 0.5], [0.05, 0.35], [0.2, 0.3], [1.0, 0.28], [40.0, 0.4]]
WORDS = {
    "table": {"friction_coefficient": TABLE},
    "peak, between ε and 2ε": {"static_ratio": 1.3, "regularisation": 0.7},
    "peak, creeping": {"static_ratio": 1.3, "regularisation": 100.0},
    "plates": {"plates": 3},
    "drag and coast": {"friction_coefficient": lambda relative_spin: 0.3 + 0.1 * np.tanh(relative_spin)},
    "all": {
        "friction_coefficient": TABLE,
        "normal_load": lambda relative_spin, radius, time: 2.0 + np.sin(relative_spin) + radius + time,
        "static_ratio": 1.2,
        "plates": 2,
    },
}


def pair_of(kinds, **contact):
    mbs = exu.SystemContainer().AddSystem()
    nodes = [body(mbs, kind, *data) for kind, data in zip(kinds, (MASTER, DISC), strict=True)]
    return mbs, nodes, add_ring_friction(mbs, *nodes, **RING | contact)


@pytest.mark.parametrize("kinds", PAIRS, ids=" on ".join)
@pytest.mark.parametrize("word", WORDS)
def test_jacobian_is_the_derivative_of_the_force_under_every_word(kinds, word):
    mbs, _, friction = pair_of(kinds, **WORDS[word])
    assert_jacobian_is_derivative(mbs, friction)


@pytest.mark.parametrize("kinds", PAIRS, ids=" on ".join)
def test_all_words_together_keep_momenta_and_turn_energy_into_heat(kinds):
    mbs, nodes, friction = pair_of(kinds, **WORDS["all"])
    heat = friction.add_sensor("heat")
    mbs.Assemble()
    before, energy_before = momenta_and_energy(mbs, kinds, nodes)
    run_explicitly(mbs, 0.05, 250)
    after, energy_after = momenta_and_energy(mbs, kinds, nodes)
    change = (after - before)[conserved(kinds)]
    np.testing.assert_allclose(change, 0.0, rtol=0.0, atol=1e-12 * np.abs(before).max())
    assert energy_before - energy_after > 0.01
    assert float(mbs.GetSensorValues(heat)) == pytest.approx(energy_before - energy_after, rel=1e-9)


def test_a_table_is_met_at_its_rows_monotone_between_and_constant_beyond():
    factors = LoadAndCoefficient((0.12, CONTINUOUS, 1.0, 1e-3, NONE_HELD, 0.12), TABLE, 1.0)

    def curve(slip_speed):
        return factors.friction_force(0.0, 0.0, slip_speed, 0.0)

    speeds, values = np.transpose(TABLE)
    np.testing.assert_allclose([curve(v) for v in speeds], values, rtol=1e-15)
    assert curve(1e6) == values[-1]
    for i in range(len(speeds) - 1):
        between = np.diff([curve(v) for v in np.linspace(speeds[i], speeds[i + 1], 101)])
        assert (np.sign(between) == np.sign(values[i + 1] - values[i])).all()
    for v in speeds[1:-1]:  # no kink at a row
        left, right = ((curve(v + s * 1e-6) - curve(v)) / (s * 1e-6) for s in (-1.0, 1.0))
        assert left == pytest.approx(right, abs=1e-3)


def test_rotors_on_one_axis_slow_down_by_the_table():
    ends = []
    for steps in (200, 400):
        mbs = exu.SystemContainer().AddSystem()
        master, disc = rotor(mbs, 0.7, 5.0), rotor(mbs, 0.02, 0.0)
        add_ring_friction(mbs, master, disc, **RING | {"friction_coefficient": [[0.0, 0.2], [1.0, 0.4]]})
        mbs.Assemble()
        run_explicitly(mbs, 0.05, steps)
        ends.append(coordinates(mbs, disc)[1][0] - coordinates(mbs, master)[1][0])
    # Two rows are a line: with r·|S| = s, ds/dt = −k·(0.2 + 0.2·s), k = r²·N·(1/J₁ + 1/J₂).
    k = 0.12**2 * 2.0 * (1.0 / 0.7 + 1.0 / 0.02)
    slip = (0.12 * 5.0 + 1.0) * np.exp(-0.2 * k * 0.05) - 1.0
    np.testing.assert_allclose(ends, -slip / 0.12, rtol=1e-12)


@pytest.mark.parametrize("spin", [3.0, -3.0])
def test_drag_and_coast_differ_by_the_sign_of_the_relative_spin(spin):
    mbs = exu.SystemContainer().AddSystem()
    disc = rotor(mbs, 0.02, spin)
    law = {"friction_coefficient": lambda relative_spin: 0.4 if relative_spin > 0.0 else 0.2}
    add_ring_friction(mbs, None, disc, **RING | law)
    mbs.Assemble()
    run_explicitly(mbs, 0.1, 100)
    deceleration = (0.4 if spin > 0.0 else 0.2) * 2.0 * 0.12 / 0.02
    assert abs(coordinates(mbs, disc)[1][0]) == pytest.approx(3.0 - 0.1 * deceleration, rel=1e-13)


@pytest.mark.parametrize("kinds", [("rotor", "rotor"), ("planar", "planar"), ("rotor", "Tait-Bryan")])
def test_n_plates_are_n_contacts(kinds):
    ends = []
    for plates in (1, 3):
        mbs, nodes, _ = pair_of(kinds, plates=plates)
        for _ in range(3 - plates):
            add_ring_friction(mbs, *nodes, **RING)
        mbs.Assemble()
        run_explicitly(mbs, 0.05, 100)
        ends.append(np.hstack([mbs.systemData.GetODE2Coordinates(), mbs.systemData.GetODE2Coordinates_t()]))
    np.testing.assert_allclose(ends[1], ends[0], rtol=0.0, atol=1e-13 * np.abs(ends[0]).max())


def slip_after_release(epsilon, static_ratio):
    """Return slip in rad/s of two rotors 20 ms after torques ∓320 N m/s·t overcome static friction of 32 N m."""
    mbs = exu.SystemContainer().AddSystem()
    nodes = rotor(mbs, 0.2, 0.0), rotor(mbs, 0.01, 0.0)
    for node, sign in zip(nodes, (-1.0, 1.0), strict=True):
        marker = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=0))
        load = items.LoadCoordinate(
            markerNumber=marker, load=sign, loadUserFunction=lambda mbs, t, sign: sign * 320.0 * t
        )
        mbs.AddLoad(load)
    contact = {"contact_radius": 0.1, "friction_coefficient": 0.4 / static_ratio, "normal_load": 800.0}
    add_ring_friction(mbs, *nodes, **contact, static_ratio=static_ratio, regularisation=epsilon)
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    options = settings.timeIntegration
    options.endTime, options.numberOfSteps, options.verboseMode = 0.12, 120, 0
    options.absoluteTolerance, options.relativeTolerance = 1e-9, 0.0
    solve_dynamic(mbs, settings, exu.DynamicSolverType.DOPRI5)
    first, second = (coordinates(mbs, node)[1][0] for node in nodes)
    return second - first


@pytest.mark.parametrize("ratio", [4.0 / 3.0, 2.0])
def test_a_contact_breaks_away_at_its_static_friction_with_an_error_of_first_order(ratio):
    sliding = 0.4 / ratio * 800.0 * 0.1
    exact = (160.0 * (0.12**2 - 0.1**2) - sliding * 0.02) * (1.0 / 0.2 + 1.0 / 0.01)
    errors = np.array([slip_after_release(epsilon, ratio) - exact for epsilon in (1e-2, 5e-3, 2.5e-3)])
    assert np.abs(errors).max() < 2e-3 * exact
    orders = np.log2(errors[:-1] / errors[1:])
    np.testing.assert_allclose(orders, 1.0, atol=0.15, err_msg=str(errors))


def test_the_peak_holds_up_to_the_regularisation_and_is_gone_at_twice_that():
    shares = np.linspace(0.0, 3.0, 301)
    values = np.array([peak_over_sliding(share, 1.5) for share in shares])
    assert (values[shares <= 1.0] == 1.5).all()
    assert (values[shares >= 2.0] == 1.0).all()
    assert (np.diff(values[(shares >= 1.0) & (shares <= 2.0)]) < 0.0).all()
    assert np.abs(np.diff([peak_over_sliding(2.0 - 1e-12, 1.5), 1.0])) < 1e-11


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"static_ratio": 0.9}, "static_ratio = 0.9: it must be >= 1, static over sliding friction"),
        ({"static_ratio": float("nan")}, "static_ratio = nan"),
        ({"plates": 0}, "plates = 0: it must be a whole number >= 1"),
        ({"plates": 1.5}, "plates = 1.5: it must be a whole number >= 1"),
        ({"friction_coefficient": [0.3, 0.2]}, "friction_coefficient = .*: it must be two or more rows"),
        ({"friction_coefficient": [[0.0, 0.3]]}, "two or more rows"),
        ({"friction_coefficient": [[0.1, 0.3], [1.0, 0.2]]}, "the first at 0 m/s"),
        ({"friction_coefficient": [[0.0, 0.3], [1.0]]}, "two or more rows"),
        ({"friction_coefficient": [[0.0, 0.3], [1.0, -0.2]]}, "all numbers must be finite and >= 0"),
        ({"friction_coefficient": [[0.0, 0.3], [0.0, 0.2]]}, "slip speeds must grow from row to row"),
        ({"normal_load": [[0.0, 0.3], [1.0, 0.2]]}, "normal_load = .*: it must be a number"),
    ],
)
def test_nonsense_is_refused_with_its_name_and_value(change, message):
    mbs = exu.SystemContainer().AddSystem()
    with pytest.raises(ValueError, match=message):
        add_ring_friction(mbs, None, rotor(mbs, 1.0, 0.0), **RING | change)
