"""Contents of sweeps in this process."""

import json
import time
from dataclasses import replace

import numpy as np
import pytest
import zarr
from long_sweeps import assert_same, content, silent

from compare.claims.parameters import FIG5
from compare.sweep.compute.executors import AT_ONCE, InProcess, Task
from compare.sweep.compute.run import run
from compare.sweep.compute.work import Plain, compute, end_of, plain_trajectory
from compare.sweep.distributions import Uncertain
from compare.sweep.plan import Basin, Map, RandomBasin, Uncertainty
from compare.sweep.quantities import Axis
from compare.sweep.store import SweepStore
from compare.sweep.summary import same_ends, summary
from reference_model import simulate
from reference_model.ensemble import EndState

COMMON = {"system": FIG5, "duration": 300.0, "tolerance": 1e-9, "seed": 4}
START = (0.1, 0.0, 0.03, 0.0)
X, Y = Axis("x", -0.3, 0.5, 17), Axis("vx", -0.4, 0.4, 9)
BASIN = Basin(**COMMON, start=START, x=X, y=Y, coarse=5)
RANDOM = RandomBasin(**COMMON, start=START, x=Axis("x", -0.3, 0.5, 2), y=Axis("vx", -0.4, 0.4, 2), samples=60)
MAP = Map(
    **COMMON,
    starts=(START, (0.0, 0.0, 0.0, 0.0)),
    x=Axis("disc_speed", 1.2, 2.0, 5),
    y=Axis("friction_force", 0.05, 0.15, 4),
)


def swept(path, plan, chunk):
    store = SweepStore.create(path, plan, chunk)
    run(store, InProcess(), silent)
    return store


@pytest.fixture(scope="module")
def basin(tmp_path_factory):
    return swept(tmp_path_factory.mktemp("basin") / "s", BASIN, 50)


@pytest.mark.parametrize("plan", [BASIN, MAP], ids=lambda plan: plan.kind)
def test_chunks_of_any_size_give_the_same_store_to_the_last_bit(plan, tmp_path):
    for chunk in (17, 1000):
        swept(tmp_path / str(chunk), plan, chunk)
    assert_same(content(tmp_path / "17"), content(tmp_path / "1000"))


def test_a_basin_is_labelled_and_its_ends_equal_those_of_the_plain_reference(basin):
    result = basin.get("result")
    assert dict(result.sizes) == {"vx": 9, "x": 17, "end_state": len(EndState)}
    assert (result["x"].attrs["units"], result["vx"].attrs["units"]) == ("m", "m/s")
    assert (result["largest_radius"].attrs["units"], result["slip_power"].attrs["units"]) == ("m", "W")
    np.testing.assert_array_equal(result["x"], X.values)
    assert result["end"].attrs["flag_meanings"].split()[EndState.WHIRL] == "whirl"
    for x, vx in ((0.1, -0.1), (0.4, 0.3)):
        point = result.sel(x=x, vx=vx, method="nearest")
        motion = simulate(FIG5, [x, 0.0, vx, 0.0], np.linspace(0.0, 400.0, 401))
        circles = np.max(motion.radius[-50:]) > 0.5  # the whirl's radius is 0.9, the equilibrium's 0.044
        assert int(point["end"]) == (EndState.WHIRL if circles else EndState.SELF_CENTRED)


def test_results_of_a_basin_are_at_their_simulated_points_only(basin):
    result = basin.get("result")
    simulated = result["simulated"].values.astype(bool)
    assert 0 < np.count_nonzero(simulated) < simulated.size
    for name in ("time", "least_radius", "largest_radius", "slip_power"):
        np.testing.assert_array_equal(np.isfinite(result[name].values), simulated)
    y, x = np.nonzero(simulated)
    alone = compute(BASIN, y * X.points + x, None)
    for name in ("end", "time", "largest_radius"):
        np.testing.assert_array_equal(result[name].values[y, x], alone[name])
    assert len(np.unique(alone["time"])) > 20


def test_friction_power_of_the_whirl_is_that_of_its_slip(tmp_path):
    centred = replace(MAP, system=replace(FIG5, offset=0.0), starts=((1.0, 0.0, 0.0, 1.0),))
    result = swept(tmp_path / "s", centred, 50).get("result").sel(start=0)
    speed, load = np.meshgrid(result["disc_speed"], result["friction_force"])
    assert np.all(result["end"] == EndState.WHIRL)
    radius = load / (FIG5.damping * FIG5.natural_frequency)
    np.testing.assert_allclose(result["largest_radius"], radius, rtol=1e-3)
    np.testing.assert_allclose(
        result["slip_power"], load * (speed - FIG5.natural_frequency) * radius, rtol=1e-3
    )
    assert np.max(result["modulation"]) < 1e-3


def test_a_store_contains_its_provenance(basin):
    attributes = zarr.open_group(basin.path, mode="r").attrs
    plan = json.loads(attributes["plan"])
    assert (plan["seed"], plan["tolerance"], plan["system"]["friction_force"]) == (4, 1e-9, 0.09)
    assert json.loads(attributes["versions"])["numpy"] == np.__version__


def test_the_check_has_every_trajectory_from_its_own_round(tmp_path, monkeypatch):
    monkeypatch.setattr("compare.sweep.compute.run.CHECKED", 10**6)
    same = Plain(end=EndState.WHIRL, state=np.zeros(4))
    monkeypatch.setattr("compare.sweep.compute.run.recompute", lambda *arguments: same)
    store = swept(tmp_path / "s", BASIN, 50)
    check, result = store.get("check"), store.get("result")
    numbers = check["trajectory"].values
    np.testing.assert_array_equal(np.sort(numbers), np.flatnonzero(result["simulated"].values))
    for name in ("time", "end"):
        np.testing.assert_array_equal(check[name], result[name].values.flat[numbers])


def test_the_plain_reference_detects_a_wrong_kernel(tmp_path, monkeypatch):
    def wrong(*arguments):
        found = compute(*arguments)
        return found | {
            "states": found["states"] + [0.0, 0.0, 0.0, 0.01],
            "end": np.full_like(found["end"], EndState.STUCK),
        }

    monkeypatch.setattr("compare.sweep.compute.work.compute", wrong)
    monkeypatch.setattr("compare.sweep.compute.run.CHECKED", 2)
    store = swept(tmp_path / "s", replace(RANDOM, duration=40.0), 13)
    difference = store.get("check")["difference"].values
    np.testing.assert_allclose(difference, np.tile([0.0, 0.0, 0.0, 0.01], (len(difference), 1)), atol=1e-6)
    assert not same_ends(store)
    last = list(summary(store))[-1]
    checked = f"check of {len(difference)} trajectories by the plain reference"
    assert f"{checked}: {len(difference)} end differently" in last
    assert last.endswith("m and 1.0e-02 m/s")


def test_probability_of_the_whirl_and_its_sensitivities(tmp_path):
    varied = (
        Uncertain.parse("vx=uniform(-0.4, 0.4)", FIG5),
        Uncertain.parse("mass=uniform(0.999, 1.001)", FIG5),
    )
    plan = Uncertainty(**COMMON, start=START, varied=varied, samples=256)
    store = swept(tmp_path / "s", plan, 300)
    result = store.get("result")
    assert result.sizes["sample"] == 512  # the independent draws
    share = float(np.mean(result["end"].values == EndState.WHIRL))
    assert float(result["share"][EndState.WHIRL]) == share
    assert (
        0.0
        < float(result["share_low"][EndState.WHIRL])
        < share
        < float(result["share_high"][EndState.WHIRL])
        < 1.0
    )
    by_speed, by_mass = (result["sobol_total"].sel(uncertain=name).values for name in ("vx", "mass"))
    assert np.all(by_speed > 10.0 * np.abs(by_mass))
    for i in (0, 511):  # labelled arrays are consistent
        pin = replace(FIG5, mass=float(result["mass"][i]))
        start = [0.1, 0.0, float(result["vx"][i]), 0.0]
        motion = plain_trajectory(pin, np.array(start), 1.0, 400.0, 1e-9)
        assert end_of(motion) == int(result["end"][i])


@pytest.mark.parametrize(("compiled", "at_once"), [(True, AT_ONCE), (False, 1)])
def test_only_compiled_tasks_run_in_parallel(compiled, at_once):
    running, most = [], []

    def work(number):
        running.append(number)
        time.sleep(0.05)
        most.append(len(running))
        running.remove(number)
        return -number

    tasks = [Task(number, work, (number,), compiled) for number in range(2 * AT_ONCE)]
    assert list(InProcess().run(tasks)) == [(number, -number) for number in range(2 * AT_ONCE)]
    assert max(most) == at_once
