"""Properties of the compiled code itself: reproducible, vectorised, and compiled as rarely as possible."""

import os
import platform
import re
import subprocess
import sys
from dataclasses import replace

import numba
import numpy as np
import pytest
from numba.core.registry import cpu_target
from plain_engines import stuck_state

from compare.claims.parameters import FIG5, FIG9, FIG11
from reference_model import simulate
from reference_model.ensemble import simulate_ensemble, task
from reference_model.ensemble.core.jit import PART
from reference_model.ensemble.core.records import LANES, layout
from reference_model.ensemble.disc.kernel import run_points
from reference_model.ensemble.disc.lanes import DiscLanes, advance_with
from reference_model.ensemble.disc.slip import no_edge, points_rates, ring_edge, ring_rates
from reference_model.ensemble.pin.kernel import run_pins
from reference_model.ensemble.pin.lanes import PinLanes, _advance_in

SIX = replace(FIG11, contact_points=6)
ARM = platform.machine() in ("arm64", "aarch64")
FEATURES = cpu_target.target_context.codegen().magic_tuple()[2].split(",")
"""Features of the processor that numba compiles for."""
VECTOR_ROOT, SCALAR_ROOT = (r"fsqrt\s+v", r"fsqrt\s+d") if ARM else (r"v?sqrtpd", r"v?sqrtsd")


def random_starts(system, number):
    rng = np.random.default_rng(0)
    size = system.state_size
    starts = np.zeros((number, size))
    starts[:, 0], starts[:, size // 2] = rng.uniform(-0.3, 0.5, number), rng.uniform(-0.4, 0.4, number)
    if size == 4:
        return starts
    starts[:, 5] = rng.uniform(0.0, 1.5, number)
    return np.concatenate((starts, [stuck_state(system, 0.1, 0.0)]))


@pytest.mark.parametrize(
    ("system", "duration", "chunk"),
    [(FIG5, 80.0, 7), (FIG11, 20.0, 25), (SIX, 10.0, 25)],
    ids=["pin", "ring", "points"],
)
def test_neighbours_chunks_and_threads_do_not_change_a_single_bit(system, duration, chunk, monkeypatch):
    def results(starts, threads=1):
        return vars(simulate_ensemble(system, starts, duration=duration, threads=threads))

    def assert_same(one, other, which=slice(None)):
        for name, values in one.items():
            np.testing.assert_array_equal(values[which], other[name], err_msg=name)

    starts = random_starts(system, 60)
    order = np.random.default_rng(1).permutation(len(starts))
    together = results(starts)
    assert_same(together, results(starts[order], threads=2), order)
    assert_same(together, results(starts[17]), slice(17, 18))
    monkeypatch.setattr(task, "CHUNK", chunk)
    assert_same(together, results(starts, threads=3))


def advance_pins(lanes):
    _advance_in(lanes, LANES)


def advance_rings(lanes):
    advance_with(lanes, (), ring_rates, ring_edge, 0.0, LANES)


def advance_points(lanes):
    advance_with(lanes, (1.0, 0.0, -0.5, 0.8, -0.5, -0.8), points_rates, no_edge, 1e-3, LANES)


@pytest.mark.skipif(not ARM and "+avx2" not in FEATURES, reason="LLVM vectorises selections only with AVX2")
@pytest.mark.parametrize(
    ("advance", "lanes", "roots"),
    [(advance_pins, PinLanes, 16), (advance_rings, DiscLanes, 40), (advance_points, DiscLanes, 40)],
)
def test_step_of_all_lanes_is_vectorised(advance, lanes, roots):
    compiled = numba.njit(**PART)(advance)
    compiled.compile((numba.from_dtype(layout(lanes)),))
    code = "\n".join(compiled.inspect_asm().values())
    # Each of thirteen right-hand sides takes at least one root for a pin and three for a disc.
    assert len(re.findall(VECTOR_ROOT, code)) >= roots
    assert not re.search(SCALAR_ROOT, code)


def test_one_kernel_serves_a_single_pin_and_many():
    for parameters in ({}, {"mass": [1.0, 1.1]}):
        simulate_ensemble(FIG5, [0.1, 0.0, 0.0, 0.0], duration=1.0, parameters=parameters)
    assert len(run_pins.kinds) == 1


def test_one_kernel_serves_discs_with_and_without_stick():
    simulate(SIX, [0.1, 0.0, 0.0, 0.0, 0.0, 1.0], [0.0, 1.0], compiled=True)
    known = len(run_points.kinds)
    disc = replace(FIG9, friction_force=2.0 * FIG9.friction_force, contact_points=6)
    found = simulate(disc, stuck_state(disc, -0.02, 0.0), [0.0, 40.0], compiled=True)
    assert found.stick_phases
    assert found.phases[-1].kind == "slip"
    assert len(run_points.kinds) == known


def test_plain_reference_does_not_import_the_compiler():
    code = "import sys, reference_model; sys.exit('numba' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_a_users_setting_without_compiler_does_not_break_kernels():
    code = (
        "from compare.claims.parameters import FIG5\nfrom reference_model import simulate\n"
        "simulate(FIG5, [0.1, 0, 0, 0], [0, 1], compiled=True)"
    )
    run = subprocess.run(
        [sys.executable, "-c", code], env=os.environ | {"NUMBA_DISABLE_JIT": "1"}, check=False
    )
    assert run.returncode == 0
