"""Examples in other languages are engines over ``exec:``."""

import shlex
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from compare.claims.claim import Verdict
from compare.claims.parameters import FIG5, FIG5_STARTS
from compare.engines import UnsupportedSystemError, engines
from compare.studies.engines.trajectories import STUDY
from reference_model import DiscOnDisc, FrictionJoint, simulate

EXAMPLES = Path(__file__).parents[1] / "examples"
COMPILER = next(filter(None, map(shutil.which, ("cc", "gcc", "clang"))), None)
NODE = shutil.which("node")

DRAWN = "with random parameters"

in_c = pytest.mark.skipif(COMPILER is None, reason="there is no C compiler")
in_javascript = pytest.mark.skipif(NODE is None, reason="there is no node")


@pytest.fixture(scope="session")
def compiled(tmp_path_factory):
    """The example in C, compiled without warnings."""
    program = tmp_path_factory.mktemp("in c") / "exec_pin"
    options = ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-O2"]
    source = EXAMPLES / "exec_pin.c"
    subprocess.run([COMPILER, *options, "-o", str(program), str(source), "-lm"], check=True)
    (engine,) = engines([f"exec:{shlex.quote(str(program))}"])
    return engine


def in_node():
    (engine,) = engines([f"exec:{shlex.join([NODE, str(EXAMPLES / 'exec_pin.js')])}"])
    return engine


@in_c
@pytest.mark.parametrize("case", ["a pin that sticks on its way", f"pins {DRAWN}"])
def test_the_pin_in_c_moves_as_the_study_of_plain_motions_claims(compiled, case):
    (claim,) = STUDY.measure(compiled, only=[f"moves/{case}"]).claims
    assert claim.verdict is Verdict.AGREES


@in_javascript
def test_the_pin_in_javascript_moves_as_the_study_of_plain_motions_claims_and_knows_no_stick():
    (claim,) = STUDY.measure(in_node(), only=[f"moves/pins on stops {DRAWN}"]).claims
    assert claim.verdict is Verdict.AGREES
    with pytest.raises(UnsupportedSystemError, match="does not simulate stick"):
        in_node().simulate(FIG5, FIG5_STARTS["whirl"], [0.0, 15.0])


def from_npm(name):
    """Return the engine of this name, or skip the test."""
    try:
        return engines([f"exec:{shlex.join([NODE, str(EXAMPLES / 'exec_contact.js'), name])}"])[0]
    except ValueError as error:
        pytest.skip(f"npm's package is not in the current folder: {error}")


@in_javascript
@pytest.mark.parametrize("name", ["rapier", "jolt", "planck", "physx", "havok"])
def test_engines_from_npm_slide_as_the_reference_does_and_better_with_a_smaller_step(name):
    engine = from_npm(name)
    start, times = (0.9, 0.0, 0.0, 0.9), np.linspace(0.0, 5.0, 6)
    exact = simulate(FIG5, start, times, tolerance=1e-12).states
    coarse, fine = (
        np.max(np.abs(engine.function(FIG5, start, times, step=h).states - exact)) for h in (8e-3, 2e-3)
    )
    assert fine < 0.4 * coarse
    if name != "planck":
        with pytest.raises(UnsupportedSystemError, match="leaves the plate, which ends 20 m from the origin"):
            engine.function(FIG5, (19.0, 0.0, 30.0, 0.0), (0.0, 0.1), step=8e-3)


JOINT = FrictionJoint(inertia=0.5, friction_moment=2.0, moment=((1.0, 0.0), (3.0, 6.0)))


@in_javascript
@pytest.mark.parametrize("name", ["rapier", "jolt", "planck", "physx", "havok"])
def test_joints_from_npm_stop_and_break_away(name):
    engine = from_npm(name)
    times = np.linspace(0.0, 3.0, 7)
    exact = simulate(JOINT, (0.1, 2.0), times).states
    coarse, fine = (
        np.max(np.abs(engine.function(JOINT, (0.1, 2.0), times, step=h).states - exact)) for h in (8e-3, 2e-3)
    )
    assert fine < 0.4 * coarse
    with pytest.raises(UnsupportedSystemError, match="one friction moment at rest and in motion"):
        engine.function(replace(JOINT, static_ratio=1.5), (0.1, 2.0), times, step=8e-3)


@in_javascript
@pytest.mark.parametrize("name", ["rapier", "jolt", "physx", "havok", "cannon"])
def test_boxes_from_npm_turn_with_the_disc_below_and_count_their_turns(name):
    held = DiscOnDisc(
        mass=1.0, polar_inertia=1.0, stiffness=1e-6, damping=0.0, friction_force=10.0, disc_speed=2.0, offset=0.0,
        contact_radius=1.0, shaft_damping=0.0, shaft_speed=0.0, contact_points=4,
    )  # fmt: skip
    start, times = (0.2, 0.0, 0.0, 0.0, 0.4, 2.0), np.linspace(0.0, 5.0, 6)
    states = from_npm(name).function(held, start, times, step=2e-3).states
    assert states[:, 2] == pytest.approx(2.0 * times, abs=0.02)
    drifts = name == "rapier"  # by a quarter of the radius per second, at any step
    assert (np.hypot(*states[:, :2].T) == pytest.approx(0.2, abs=0.02)) != drifts
    with pytest.raises(UnsupportedSystemError, match="a box has four corners"):
        from_npm(name).function(replace(held, contact_points=6), start, times, step=2e-3)
