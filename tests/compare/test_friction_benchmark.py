"""The benchmark file that other projects can copy: exact engines pass, and wrong friction laws fail."""

import inspect
import json
import runpy
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from compare.cli import app as cli
from compare.diagnosis import friction_benchmark
from compare.diagnosis.run import benchmarked
from compare.engines import reference
from compare.run.statuses import FINE, NOTHING_SHOWN, SOMETHING_DIFFERS

FILE = Path(friction_benchmark.__file__)
BENCHMARK = runpy.run_path(str(FILE))
FREE = [case for case in BENCHMARK["cases"]() if not (any(case.force) or case.radius)]


def stepped(case, times, box=False, strength=1.0, step=1e-3):
    """Step forces first, then friction, which can at most stop the slip."""
    z, v = complex(*case.start[:2]), complex(*case.start[2:])
    mass, ratio, growth = case.inertia or case.mass, case.static_ratio, case.growth
    most = strength * step * case.friction / mass
    for i in range(round((times[1] - times[0]) / step)):
        plate = 1j * case.plate_speed * z
        pull = complex(*case.force) + growth * i * step
        slip = v + step * (pull - case.stiffness * z - case.damping * v) / mass - plate
        if v == plate and abs(slip) <= ratio * most:
            slip = 0j
        elif box:
            slip -= complex(*(max(-most, min(most, one)) for one in (slip.real, slip.imag)))
        else:
            slip *= max(0.0, 1.0 - most / max(abs(slip), 1e-300))
        v = plate + slip
        z += step * v
    return [case.start, (z.real, z.imag, v.real, v.imag)]


def failures(without=None, **law):
    """Return the names of the cases that a time stepper with this friction law fails; it ignores ``without``."""

    def simulate(case, times):
        if case.radius:
            raise NotImplementedError
        return stepped(replace(case, **(without or {})), times, **law)

    results = BENCHMARK["run"](simulate)
    return {case["name"] for case in results["cases"] if case["grade"] == "fails"}


def test_the_exact_reference_confirms_every_closed_form():
    results = benchmarked(reference)
    assert results["score"] == {"exact": 25, "good": 0, "fair": 0, "fails": 0, "not simulated": 0}


def test_no_spring_begins_far_beyond_its_motion():
    """Engines in single precision round coordinates; one that does so at 10 m resolves 1 μm."""
    reaches = []

    class Watched:
        def simulate(self, system, start, times):
            reaches.append(abs(system.offset))
            return reference.simulate(system, start, times)

    benchmarked(Watched())
    assert 9.0 <= max(reaches) < 9.81 * 2.0**2  # the farthest fall in the 2 s of a ramp, twice


def test_the_command_prints_and_writes_the_benchmark(tmp_path, monkeypatch, capsys, in_this_process):
    (tmp_path / "stepper.py").write_text(
        inspect.getsource(stepped)
        + "\nfrom types import SimpleNamespace\nimport numpy as np\nfrom reference_model import Trajectory\n"
        + "def simulate(pin, start, times, *, step):\n"
        + "    case = SimpleNamespace(start=start, friction=pin.friction_force, mass=pin.mass, damping=pin.damping,\n"
        + "        force=(pin.stiffness * pin.offset, 0.0), stiffness=pin.stiffness, plate_speed=pin.disc_speed,\n"
        + "        inertia=0.0, static_ratio=1.0, growth=0.0)\n"
        + "    states = stepped(case, times, step=step, strength=1.5)\n"
        + "    return Trajectory(pin, np.array(times), np.array(states))\n"
        + "simulate.step = 1e-2\n"
    )
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    options = ["--benchmark", "--engine", "reference", "--engine", "stepper:simulate", "--output", "found"]
    assert cli.status(["matrix", *options]) == 1
    printed = capsys.readouterr().out
    assert "25 exact, 0 good, 0 fair, 0 fails, 0 not simulated" in printed
    written = json.loads((tmp_path / "found" / "benchmark.json").read_text(encoding="utf-8"))
    grades = {case["name"]: case["grade"] for case in written["stepper:simulate"]["cases"]}
    assert grades["ramp, μ = 0.1, tan θ = 1.01 μ"] == grades["stopping distance, 1 kg"] == "fails"
    assert grades["heading, 10°"] == "exact"
    assert grades["thrown spinning ring"] == "not simulated"


def test_a_correct_time_stepper_of_first_order_fails_nothing():
    assert failures() == set()


def test_a_box_fails_wherever_slip_is_oblique():
    names = {case.name for case in FREE if case.name.startswith(("stopping", "heading", "whirl"))}
    assert failures(box=True) == names - {"heading, 45°"}


@pytest.mark.parametrize(("strength", "slope"), [(1.02, 1.01), (0.9, 0.99)])
def test_friction_of_wrong_strength_holds_or_releases_a_block_on_a_slope(strength, slope):
    assert {f"ramp, μ = {mu}, tan θ = {slope} μ" for mu in (0.1, 0.3, 0.6)} <= failures(strength=strength)


@pytest.mark.parametrize(
    ("without", "strength", "failing"),
    [
        ({"static_ratio": 1.0}, 1.0, {"breakaway"}),
        ({}, 1.02, {"stop", "breakaway", "turned back"}),
        ({"growth": 0.0}, 1.0, {"breakaway"}),
        ({"force": (0.0, 0.0)}, 1.0, {"turned back"}),
    ],
)
def test_a_joint_with_another_law_fails(without, strength, failing):
    found = failures(without, strength=strength)
    assert {name for name in found if name.startswith("joint")} == {f"joint, {name}" for name in failing}


def test_the_file_runs_alone_and_prints_json(tmp_path):
    (tmp_path / "mine.py").write_text("def simulate(case, times):\n    return [case.start, case.start]\n")
    done = subprocess.run(
        [sys.executable, str(FILE), "mine:simulate"], cwd=tmp_path, capture_output=True, check=False
    )
    assert done.returncode == 1
    assert " fails, 0 not simulated" in done.stderr.decode()
    results = json.loads(done.stdout)
    assert len(results["cases"]) == sum(results["score"].values())
    grades = {case["name"]: case["grade"] for case in results["cases"]}
    assert grades["creep for 100 s at half load"] == "exact"
    assert grades["heading, 10°"] == grades["ramp, μ = 0.1, tan θ = 1.5 μ"] == "fails"


@pytest.mark.parametrize(
    ("error", "status"), [(NotImplementedError, NOTHING_SHOWN), (RuntimeError, SOMETHING_DIFFERS)]
)
def test_an_engine_that_raises_in_every_case_has_no_status_of_success(error, status):
    def simulate(case, times):
        raise error("no")

    results = BENCHMARK["run"](simulate)
    assert BENCHMARK["status"](results) == status
    assert results["cases"][0]["reason"] == f"{error.__name__}('no')"


def test_half_of_the_cases_are_enough():
    exact = benchmarked(reference)["cases"]
    for left_out, status in ((12, FINE), (13, NOTHING_SHOWN)):
        score = {"exact": len(exact) - left_out, "fails": 0, "not simulated": left_out}
        assert BENCHMARK["status"]({"score": score}) == status


def test_a_number_that_is_missing_fails():
    results = BENCHMARK["run"](lambda case, times: np.full((2, 4), np.nan))
    assert results["score"]["fails"] == len(results["cases"])
    json.loads(json.dumps(results, allow_nan=False))
