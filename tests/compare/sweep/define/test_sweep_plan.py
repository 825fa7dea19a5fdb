import json

import numpy as np
import pytest

from compare.claims.parameters import FIG5, FIG11
from compare.sweep.distributions import Uncertain
from compare.sweep.plan import (
    Basin,
    Continuation,
    Map,
    RandomBasin,
    Uncertainty,
    plan_as_json,
    plan_from_json,
)
from compare.sweep.quantities import Axis

PIN = {"system": FIG5, "duration": 100.0, "tolerance": 1e-9, "seed": 4}
DISC = PIN | {"system": FIG11}
X, Y = Axis("x", -0.3, 0.5, 7), Axis("vx", -0.4, 0.4, 5)

VARIED = tuple(
    Uncertain.parse(text, FIG5)
    for text in ("offset=normal(0.1, 0.01)", "friction_force=uniform(0.05, 0.1)", "vy=normal(0, 0.1)")
)
PLANS = {
    "basin": Basin(**PIN, start=(0.0, 0.1, 0.2, 0.3), x=X, y=Y, coarse=3),
    "random basin": RandomBasin(**PIN, start=(0.0, 0.1, 0.2, 0.3), x=X, y=Y, samples=35),
    "map": Map(
        **DISC,
        starts=((0.1, 0.0, 0.0, 0.0, 0.0, 1.0), (0.2, 0.0, 0.0, 0.0, 0.0, 1.0)),
        x=Axis("disc_speed", 1.0, 2.0, 4),
        y=Axis("polar_inertia", 0.5, 1.0, 3),
    ),
    "continuation": Continuation(
        **PIN,
        start=(0.0,) * 4,
        x=Axis("disc_speed", 1.05, 3.0, 4),
        varied=(Uncertain("x", "uniform", (-0.3, 0.5)), Uncertain("vx", "uniform", (-0.4, 0.4))),
        samples=7,
    ),
    "uncertainty": Uncertainty(**PIN, start=(0.1, 0.0, 0.03, 0.0), varied=VARIED, samples=7),
}
SIZE = {"basin": 35, "random basin": 35, "map": 24, "continuation": 28, "uncertainty": 35}


@pytest.mark.parametrize("kind", PLANS)
@pytest.mark.parametrize("chunk", [1, 11])
def test_a_plan_from_json_has_the_same_trajectories_in_any_chunk(kind, chunk):
    plan, size = plan_from_json(json.loads(json.dumps(plan_as_json(PLANS[kind])))), SIZE[kind]
    assert plan == PLANS[kind]
    states, parameters = plan.trajectories(range(size))
    for first in range(0, size, chunk):
        part = slice(first, min(first + chunk, size))
        some, differing = plan.trajectories(range(size)[part])
        np.testing.assert_array_equal(some, states[part])
        assert differing.keys() == parameters.keys()
        for name, values in differing.items():
            np.testing.assert_array_equal(values, parameters[name][part])


def test_a_basin_has_every_pair_of_values_of_its_axes_with_the_rest_fixed():
    states, parameters = PLANS["basin"].trajectories(np.arange(35))
    assert parameters == {}
    np.testing.assert_array_equal(states[:, 0].reshape(5, 7), np.tile(X.values, (5, 1)))
    np.testing.assert_array_equal(states[:, 2].reshape(5, 7), np.tile(Y.values[:, None], (1, 7)))
    np.testing.assert_array_equal(states[:, [1, 3]], np.tile([0.1, 0.3], (35, 1)))


def test_a_map_has_every_pair_of_parameters_from_every_start():
    plan = PLANS["map"]
    states, parameters = plan.trajectories(range(24))
    np.testing.assert_array_equal(
        states[:, 0].reshape(2, 3, 4), np.array([0.1, 0.2])[:, None, None] + np.zeros((3, 4))
    )
    for values in parameters["disc_speed"].reshape(6, 4):
        np.testing.assert_array_equal(values, plan.x.values)
    for values in parameters["polar_inertia"].reshape(2, 3, 4).transpose(0, 2, 1).reshape(8, 3):
        np.testing.assert_array_equal(values, plan.y.values)


def test_a_continuation_has_the_same_starts_at_each_value():
    plan = PLANS["continuation"]
    states, parameters = plan.trajectories(range(28))
    np.testing.assert_array_equal(states.reshape(4, 7, 4), np.tile(states[:7], (4, 1, 1)))
    np.testing.assert_array_equal(parameters["disc_speed"], np.repeat(plan.x.values, 7))


def test_random_starts_lie_in_their_ranges_and_fill_them():
    plan = RandomBasin(**PIN, start=(0.0, 0.1, 0.2, 0.3), x=X, y=Y, samples=4000)
    states, _ = plan.trajectories(range(4000))
    for column, axis in ((0, X), (2, Y)):
        values = (states[:, column] - axis.low) / (axis.high - axis.low)
        assert 0.0 <= np.min(values) < 0.01
        assert 0.99 < np.max(values) < 1.0


def test_each_mixture_of_an_uncertainty_has_one_quantity_of_the_second_draw():
    plan = PLANS["uncertainty"]
    states, parameters = plan.trajectories(range(35))
    table = np.stack((parameters["offset"], parameters["friction_force"], states[:, 3])).reshape(3, 7, 5)
    for i, values in enumerate(table):
        first, second, *mixtures = values.T
        assert np.all(first != second)
        for j, mixture in enumerate(mixtures):
            np.testing.assert_array_equal(mixture, second if i == j else first)
    np.testing.assert_array_equal(states[:, :3], np.tile([0.1, 0.0, 0.03], (35, 1)))


def test_an_axis_has_its_ends_and_equal_steps():
    axis = Axis.parse("vx=-0.4:0.5:10", "component", ("x", "vx"))
    assert axis == Axis("vx", -0.4, 0.5, 10)
    assert (axis.values[0], axis.values[-1], len(axis.values)) == (-0.4, 0.5, 10)
    np.testing.assert_allclose(np.diff(axis.values), 0.1, rtol=1e-14)
