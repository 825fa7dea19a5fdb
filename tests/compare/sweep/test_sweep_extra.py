"""Without the extra ``sweep`` everything but sweeps works, and a sweep says what it needs."""

import subprocess

from processes import REAL, environment

CODE = """
import sys
sys.modules["zarr"] = None  # as if it were not installed
from compare.cli import app
for arguments in (["sweep", "basin", "pin"], ["sweep", "basin", "--help"], ["list"]):
    print("status", app.status(arguments))
"""


def test_a_sweep_without_its_extra_says_how_to_get_it_and_the_rest_works():
    process = subprocess.run([REAL[0], "-c", CODE], env=environment(), capture_output=True, encoding="utf-8")
    assert process.stderr == (
        "a sweep needs friction-discs[sweep] (missing: zarr): pip install 'friction-discs[sweep]'\n"
    )
    assert [line for line in process.stdout.splitlines() if line.startswith("status")] == [
        "status 2",
        "status 0",
        "status 0",
    ]
