"""Many instances in one process, checked by the address and undefined-behaviour sanitizers."""

import math
import shutil
import subprocess
from pathlib import Path

import pytest

from fmu_models import CLUTCH
from fmu_models.archive import compiler, write_sources

SOURCE = Path(__file__).with_name("instances.c")
SANITIZED = ("-std=c99", "-O0", "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all")


def test_instances_do_not_share_memory(tmp_path, needs_compiler):
    write_sources(CLUTCH, tmp_path)
    shutil.copyfile(SOURCE, tmp_path / SOURCE.name)
    program = tmp_path / "instances"
    files = [str(path) for path in sorted(tmp_path.glob("*.c"))]
    made = subprocess.run(
        [compiler(), *SANITIZED, "-o", str(program), *files, "-lm"], capture_output=True, text=True
    )
    if made.returncode and "cannot find" in made.stderr:
        pytest.skip("the compiler has no sanitizers")
    assert made.returncode == 0, made.stderr
    done = subprocess.run([str(program)], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    assert math.isfinite(float(done.stdout))
