"""The picture and README's table show the recorded results of the engines."""

import runpy

import pytest
from PIL import Image
from processes import ROOT


@pytest.fixture(scope="module")
def script():
    return runpy.run_path(str(ROOT / "docs" / "draw_engines.py"))


def test_the_picture_and_the_table_of_the_engines_are_current(script):
    with Image.open(script["PICTURE"]) as picture:
        assert picture.info["Description"] == script["drawn_from"](), "run python docs/draw_engines.py"
    assert script["PLACE"].search(script["README"].read_text("utf-8"))[0] == script["table"]()


def test_a_mark_means_convergence_to_the_exact_motion_and_a_law_has_a_word(script):
    cells = script["cells"]()
    assert {mark for found in cells.values() for mark, *_ in [found["law"]]} == {""}
    laws = {engine: found["law"][1] for engine, found in cells.items()}
    assert [laws[one] for one in ("reference", "exudyn", "exudyn-native")] == ["cone"] * 3
    assert laws["MuJoCo, pyramidal cone"] == "pyramid"
    assert laws["MuJoCo, as shipped"] == laws["MuJoCo, cone=elliptic alone"] == "unclear: creeps"
    assert cells["MuJoCo, cone=elliptic alone"]["stuck"][0] == "✗"
    assert "" not in laws.values()
    mark, error, order, cost = cells["Bullet, cone"]["disc"]
    assert (mark, error, order) == ("✗", "3e-04", "order 0.1")
    assert cost == "7,000 steps per natural period, 2 s"
    *_, spin = cells["Bullet, cone"]["spin"]
    assert spin == "friction along the impulse that would stop each of 6 points by axis"


def test_the_table_says_why_an_engine_does_not_agree(script):
    lines = {line.split("|")[1].strip(): line for line in script["table"]().splitlines()}
    assert "| ✓ | ✓ | cone |" in lines["reference<br>exudyn<br>exudyn-native"]
    assert "| ✗ 1 of 6 cone | cone |" in lines["Bullet"]
    assert lines["Bullet"].endswith("| on a disc, it stops each point by axis |")
    assert lines["Jolt"].endswith("| loses 4.9 to 5.1 % of speed per s |")
    assert lines["Chipmunk"].endswith("| on a disc, it stops each point alone |")
    assert "| ? 1 of 5 | ✓ contact |" in lines["Rapier"]
    assert lines["Rapier"].endswith("| error bar of 0.17 m |")
    assert all(
        line.rstrip().endswith("|  |") == ("✗" not in line and "?" not in line)
        for line in lines.values()
        if "---" not in line and "why" not in line
    )
