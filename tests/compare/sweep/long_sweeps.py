"""Sweeps of many small chunks, and the contents of their stores."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import xarray as xr
import zarr
from processes import PATIENCE, environment
from zarr.storage import ZipStore

from compare.cli import app as cli
from compare.sweep.quantities import RESULTS

LONG = ["sweep", "basin", "pin", "--random", "180", "--seed", "3", "--tolerance", "1e-6"]
SIGNALLING = Path(__file__).with_name("signalling_sweep.py")
CHUNKS = ["--chunk", "20"]
"""Arguments with many small chunks, to allow interference."""


def status_of_signalled(name, chunk, folder, *more):
    """Return the status of a process that signals itself when workers report the ``chunk``-th chunk."""
    signalled = [sys.executable, str(SIGNALLING), name, "0", str(chunk)]
    command = [*signalled, *LONG, *CHUNKS, "--output", str(folder), *more]
    return subprocess.run(command, env=environment(), capture_output=True, timeout=PATIENCE).returncode


def silent(what, done, total):
    """Show no progress."""


def marks(folder: Path) -> set[str]:
    chunks = folder / "sweep.zarr" / "round-0"
    there = [{path.name for path in (chunks / name / "c").glob("*")} for name in RESULTS]
    return {chunk for chunk in set.intersection(*there) if chunk.isdigit()}


def resumed(folder, *more):
    """Complete the sweep in this process and return the exit status."""
    return cli.status([*LONG, *CHUNKS, "--output", str(folder), "--resume", *more])


def content(path):
    """Return all arrays of a store by group and name."""
    archive = Path(f"{path}.zip")
    store = ZipStore(archive, mode="r") if archive.exists() else path
    return {
        (group, name): values.values
        for group in sorted(zarr.open_group(store, mode="r").group_keys())
        for name, values in xr.open_zarr(store, group=group, consolidated=False).variables.items()
    }


def assert_same(one, other):
    assert one.keys() == other.keys()
    for key, values in one.items():
        np.testing.assert_array_equal(values, other[key], err_msg=str(key))
