"""The README's first figure shows the recorded results of the engines."""

import runpy

from PIL import Image
from processes import ROOT


def test_the_picture_of_the_engines_is_current():
    script = runpy.run_path(str(ROOT / "docs" / "draw_engines.py"))
    with Image.open(script["PICTURE"]) as picture:
        assert picture.info["Description"] == script["drawn_from"](), "run python docs/draw_engines.py"


def test_the_picture_marks_a_friction_law_that_is_not_a_cone():
    cells = runpy.run_path(str(ROOT / "docs" / "draw_engines.py"))["cells"]()
    assert cells["MuJoCo, pyramidal cone"]["friction law"] == ["✗", "pyramid"]
    assert {mark for mark, _ in cells["reference"].values()} == {"✓"}
