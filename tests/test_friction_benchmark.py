"""The benchmark file that other projects can copy: exact engines pass, and wrong friction laws fail."""

import json
import runpy
import subprocess
import sys
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from reference_model import PinOnDisc, simulate

FILE = Path(__file__).parents[1] / "examples" / "friction_benchmark.py"
BENCHMARK = runpy.run_path(str(FILE))
FREE = [case for case in BENCHMARK["cases"]() if not any(case.force)]


def stepped(case, times, box=False, strength=1.0, step=1e-3):
    """Step forces first, then friction, which can at most stop the slip."""
    z, v = complex(*case.start[:2]), complex(*case.start[2:])
    most = strength * step * case.friction / case.mass
    for _ in range(round((times[1] - times[0]) / step)):
        plate = 1j * case.plate_speed * z
        slip = v + step * (complex(*case.force) - case.stiffness * z - case.damping * v) / case.mass - plate
        if box:
            slip -= complex(*(max(-most, min(most, one)) for one in (slip.real, slip.imag)))
        else:
            slip *= max(0.0, 1.0 - most / max(abs(slip), 1e-300))
        v = plate + slip
        z += step * v
    return [case.start, (z.real, z.imag, v.real, v.imag)]


def failures(**law):
    """Return the names of the cases that a time stepper with this friction law fails."""
    results = BENCHMARK["run"](partial(stepped, **law))
    return {case["name"] for case in results["cases"] if case["grade"] == "fails"}


@pytest.mark.parametrize("case", FREE, ids=lambda case: case.name)
def test_the_exact_reference_confirms_the_closed_form(case):
    pin = PinOnDisc(
        mass=case.mass,
        stiffness=case.stiffness,
        damping=case.damping,
        friction_force=case.friction,
        disc_speed=case.plate_speed,
    )
    states = simulate(pin, case.start, [0.0, case.until]).states
    assert abs(BENCHMARK["measured"](case, states) - case.expected) < 1e-6 * case.scale


def test_a_correct_time_stepper_of_first_order_fails_nothing():
    assert failures() == set()


def test_a_box_fails_wherever_slip_is_oblique():
    names = {case.name for case in FREE if case.name.startswith(("stopping", "heading", "whirl"))}
    assert failures(box=True) == names - {"heading, 45°"}


def test_friction_two_percent_too_strong_holds_a_block_that_should_slide():
    assert {f"ramp, μ = {mu}, tan θ = 1.01 μ" for mu in (0.1, 0.3, 0.6)} <= failures(strength=1.02)


def test_the_file_runs_alone_and_prints_json(tmp_path):
    (tmp_path / "mine.py").write_text("def simulate(case, times):\n    return [case.start, case.start]\n")
    done = subprocess.run(
        [sys.executable, str(FILE), "mine:simulate"], cwd=tmp_path, capture_output=True, check=True
    )
    results = json.loads(done.stdout)
    assert len(results["cases"]) == sum(results["score"].values())
    grades = {case["name"]: case["grade"] for case in results["cases"]}
    assert grades["creep for 100 s at half load"] == "exact"
    assert grades["heading, 10°"] == grades["ramp, μ = 0.1, tan θ = 1.5 μ"] == "fails"


def test_a_number_that_is_missing_fails():
    results = BENCHMARK["run"](lambda case, times: np.full((2, 4), np.nan))
    assert results["score"]["fails"] == len(results["cases"])
    json.loads(json.dumps(results, allow_nan=False))
