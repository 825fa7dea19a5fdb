import re

import numpy as np
import pytest

from compare.sweep.quantities import Axis

NAMES = ("x", "vx")


def test_an_axis_has_its_ends_and_equal_steps():
    axis = Axis.parse("vx=-0.4:0.5:10", "component", NAMES)
    assert axis == Axis("vx", -0.4, 0.5, 10)
    assert (axis.values[0], axis.values[-1], len(axis.values)) == (-0.4, 0.5, 10)
    np.testing.assert_allclose(np.diff(axis.values), 0.1, rtol=1e-14)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("vx", "write it as NAME=LOW:HIGH:POINTS"),
        ("vx=1:2", "write it as NAME=LOW:HIGH:POINTS"),
        ("vz=0:1:5", "unknown component 'vz': did you mean 'vx'?"),
        ("vx=1:1:5", "vx from 1 to 1: the range must begin below its end"),
        ("vx=0:inf:5", "vx = inf: it must be finite"),
        ("vx=0:a:5", "vx = 'a': it must be a number"),
        ("vx=0:1:1", "vx with 1 points: there must be 2 to 100000"),
        ("vx=0:1:2.5", "the number of points must be a whole number"),
    ],
)
def test_what_is_no_axis_is_refused(text, words):
    with pytest.raises(ValueError, match=re.escape(words)):
        Axis.parse(text, "component", NAMES)
