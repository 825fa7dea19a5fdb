"""Joints pass through the protocols of engines."""

import json
import sys
from dataclasses import asdict

import numpy as np
import pytest

from compare.claims.parameters import components_of, parameters_of
from compare.engines import Engine, UnsupportedSystemError, engines, reference
from compare.engines.outside.json_lines import question
from reference_model import FrictionJoint, PinOnDisc, Trajectory, simulate

JOINT = FrictionJoint(
    inertia=0.5, friction_moment=2.0, static_ratio=1.5, damping=0.1, stiffness=3.0, offset=0.2,
    moment=((0.0, 1.0), (2.0, -9.0)),
)  # fmt: skip
STATE, TIMES = (0.1, -3.0), np.linspace(0.0, 4.0, 9)
EXACT = simulate(JOINT, STATE, TIMES).states
ONLY_JOINTS = Engine("mine", simulate, ("joint",), phases=False)

PROGRAM = """
import json, sys
from reference_model import FrictionJoint, simulate
print(json.dumps({"kinds": ["joint"]}), flush=True)
for line in sys.stdin:
    request = json.loads(line)
    assert request["system"].pop("kind") == "joint"
    run = simulate(FrictionJoint(**request["system"]), request["state"], request["times"])
    print(json.dumps({"states": run.states.tolist()}), flush=True)
"""


def test_engine_of_joints_simulates_nothing_else():
    assert reference.simulates(JOINT)
    assert ONLY_JOINTS.simulates(JOINT)
    assert np.all(ONLY_JOINTS.simulate(JOINT, STATE, TIMES).states == EXACT)
    pin = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.0, friction_force=1.0, disc_speed=1.0)
    assert ONLY_JOINTS.lacking([pin]) == "mine does not simulate a pin"
    assert Engine("mine", simulate).lacking([JOINT]) == "mine does not simulate a joint with friction"
    with pytest.raises(UnsupportedSystemError, match="does not simulate stick"):
        Engine("mine", simulate, ("joint",), sticks=False).simulate(JOINT, STATE, TIMES)
    with pytest.raises(RuntimeError, match="states have shape"):
        Engine(
            "mine", lambda *given, tolerance: Trajectory(JOINT, TIMES, np.zeros((9, 4))), ("joint",)
        ).simulate(JOINT, STATE, TIMES)


def test_program_receives_a_joint_with_its_moment(tmp_path):
    line = json.loads(question(JOINT, STATE, TIMES, {"tolerance": 1e-9}))
    assert line["system"] == {"kind": "joint"} | asdict(JOINT) | {"moment": [[0.0, 1.0], [2.0, -9.0]]}
    script = tmp_path / "joints.py"
    script.write_text(PROGRAM)
    (program,) = engines([f"exec:{sys.executable} {script}"])
    assert np.all(program.simulate(JOINT, STATE, TIMES).states == EXACT)


def test_files_contain_a_joint(tmp_path):
    from compare.run.plan import write_plan

    line = question(JOINT, STATE, TIMES, {"tolerance": 1e-9})
    write_plan(tmp_path, ["joint"], [line])
    (name,) = (path.stem for path in tmp_path.glob("*.json") if path.stem != "plan")
    rows = np.column_stack((TIMES, EXACT[:, ::-1]))
    np.savetxt(tmp_path / f"{name}.csv", rows, delimiter=",", header="t [s],spin [rad/s],angle [rad]")
    (files,) = engines([f"files:{tmp_path}"])
    assert np.all(files.simulate(JOINT, STATE, TIMES).states == EXACT)


@pytest.mark.parametrize("seed", range(5))
def test_joint_in_other_units_moves_the_same(seed):
    drawn = []

    def asked(system, *question, tolerance):
        drawn.append(system)
        return simulate(system, *question)

    engine = Engine("mine", asked, ("joint",), phases=False, seed=seed)
    assert engine.simulate(JOINT, STATE, TIMES).states == pytest.approx(EXACT, rel=1e-12)
    assert drawn[0] != JOINT


def test_noise_of_a_declared_precision_has_the_size_of_the_motion():
    found = Engine("mine", simulate, ("joint",), phases=False, precision=1e-4).simulate(JOINT, STATE, TIMES)
    off = abs(found.states - EXACT)
    # the start moves too, and the spring passes this on
    assert np.all(np.max(off, axis=0) < 4e-4 * np.max(abs(EXACT), axis=0))
    assert np.all(np.max(off, axis=0) > 1e-6)


def test_parameters_of_a_joint_repeat_it():
    assert parameters_of(JOINT)["moment"] == "((0.0, 1.0), (2.0, -9.0))"
    assert components_of(JOINT) == ("angle in rad", "spin in rad/s")
