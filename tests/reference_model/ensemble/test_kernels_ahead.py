"""The kernels that a wheel brings: taken for the systems that they are for, and the same bits as compiled here."""

import runpy
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from compare.claims.paper_parameters import FIG5, FIG11
from reference_model.ensemble import simulate_ensemble
from reference_model.ensemble.core import jit
from reference_model.ensemble.disc.kernel import run_points, run_rings
from reference_model.ensemble.pin.kernel import run_pins
from reference_model.numerics.machine_code import MachineCode, levels_here

BUILDER = Path(__file__).parents[3] / "builders" / "kernels.py"
KERNELS = {
    "pin": (FIG5, run_pins),
    "ring": (FIG11, run_rings),
    "six points": (replace(FIG11, contact_points=6), run_points),
}


@pytest.fixture(scope="module")
def built():
    """Let there be the files for this processor, which ``make`` has compiled already."""
    compile_for = runpy.run_path(str(BUILDER))["compile_for"]
    for system, _ in KERNELS.values():
        compile_for(levels_here()[:1], system)


def ends_of(system, duration):
    """Return the arrays of an ensemble of random systems."""
    rng = np.random.default_rng(3)
    n = 64
    names = "mass", "stiffness", "damping", "friction_force", "disc_speed"
    parameters = {name: (getattr(system, name) or 0.1) * rng.lognormal(0.0, 0.7, n) for name in names}
    starts = rng.normal(size=(n, system.state_size))
    return vars(simulate_ensemble(system, starts, duration=duration, parameters=parameters))


@pytest.mark.parametrize(("system", "kernel"), KERNELS.values(), ids=KERNELS)
def test_it_is_taken_for_its_system(built, system, kernel, monkeypatch):
    monkeypatch.setattr(kernel, "kinds", {})
    ends_of(system, 1.0)
    assert [type(code) for code in kernel.kinds.values()] == [MachineCode]


def test_a_kernel_compiled_here_comes_to_the_same_bits(built, monkeypatch):
    """Of pins, which have most of the code; that all levels do, a smaller function shows."""
    ahead = ends_of(FIG5, 1e4)
    monkeypatch.setattr(run_pins, "kinds", {})
    monkeypatch.setattr(jit, "machine_code", lambda function, kind: None)
    here = ends_of(FIG5, 1e4)
    assert list(run_pins.kinds.values()) == [run_pins.compiled_here]
    assert len(set(here["end"])) >= 4
    for name, values in here.items():
        np.testing.assert_array_equal(ahead[name], values, err_msg=name)
