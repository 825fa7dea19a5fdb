"""Compiled functions of this package take the widest vectors, and those of others what numba takes."""

import os
import platform
import subprocess
import sys

import pytest

PROGRAM = """
import math
import numba
from reference_model.numerics.vector_width import WideCompiler

def roots(x):
    for i in range(len(x)):
        x[i] = math.sqrt(x[i]) + 1.0

for compiler in (WideCompiler, None):
    options = {"pipeline_class": compiler} if compiler else {}
    compiled = numba.njit("(float64[::1],)", error_model="numpy", **options)(roots)
    print("zmm" in "".join(compiled.inspect_asm().values()))
"""


def registers(processor: str, features: str) -> list[str]:
    """Return whether a loop takes vectors of 512 bits here, and in a function of others."""
    environment = {**os.environ, "NUMBA_CPU_NAME": processor, "NUMBA_CPU_FEATURES": features}
    run = [sys.executable, "-c", PROGRAM]
    return subprocess.run(
        run, env=environment, check=True, capture_output=True, text=True
    ).stdout.splitlines()


@pytest.mark.skipif(platform.machine() not in ("x86_64", "AMD64"), reason="names processors of one kind")
@pytest.mark.parametrize(
    ("processor", "features", "here", "elsewhere"),
    [
        ("icelake-server", "+avx512f,+avx512vl,+avx512dq", "True", "False"),
        ("haswell", "", "False", "False"),
    ],
)
def test_vectors_are_as_wide_as_the_processor_has_them_in_functions_of_this_package_alone(
    processor, features, here, elsewhere
):
    assert registers(processor, features) == [here, elsewhere]
