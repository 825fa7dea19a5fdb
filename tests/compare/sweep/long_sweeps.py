"""Sweeps of many small chunks in separate processes, and the contents of their stores."""

import resource
import subprocess
import sys
from pathlib import Path

import numpy as np
import xarray as xr
import zarr
from processes import PATIENCE, REAL, environment
from zarr.storage import ZipStore

from compare.cli import app as cli
from compare.sweep.quantities import RESULTS

LONG = ["sweep", "basin", "pin", "--random", "600", "--seed", "3", "--tolerance", "1e-6"]
SIGNALLING = Path(__file__).with_name("signalling_sweep.py")
CHUNKS = ["--chunk", "20"]
"""Arguments with many small chunks, to allow interference."""


def long_sweep(folder, *more, limit=None, signalled=None):
    """Start the command with a file-size limit in bytes.

    ``signalled`` is a signal, a process (0 for itself) and the number of the half-written chunk.
    """
    restrict = None if limit is None else lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
    command = REAL if signalled is None else [sys.executable, str(SIGNALLING), *map(str, signalled)]
    # Python would leave truncated compiled modules, and every later process would fail.
    whole = {} if limit is None else {"PYTHONDONTWRITEBYTECODE": "1"}
    return subprocess.Popen(
        [*command, *LONG, *CHUNKS, "--output", str(folder), *more],
        env=environment(**whole),
        stderr=subprocess.PIPE,
        stdout=subprocess.PIPE,
        encoding="utf-8",
        preexec_fn=restrict,
    )


def silent(what, done, total):
    """Show no progress."""


def marks(folder: Path) -> set[str]:
    chunks = folder / "sweep.zarr" / "round-0"
    there = [{path.name for path in (chunks / name / "c").glob("*")} for name in RESULTS]
    return {chunk for chunk in set.intersection(*there) if chunk.isdigit()}


def finished_by(process):
    out, err = process.communicate(timeout=PATIENCE)
    return process.returncode, out, err


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
