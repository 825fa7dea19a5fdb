"""Sweeps of many small chunks as processes, so that there is time to interfere, and what is in their stores."""

import resource
import subprocess
import sys
from pathlib import Path

import numpy as np
import xarray as xr
from processes import PATIENCE, REAL, environment

from compare.cli import app as cli

LONG = ["sweep", "basin", "pin", "--random", "1200", "--seed", "3", "--tolerance", "1e-6"]
SIGNALLING = Path(__file__).with_name("signalling_sweep.py")
CHUNKS = ["--chunk", "20"]
"""Many small chunks, so that there is time to interfere."""


def long_sweep(folder, *more, limit=None, signalled=None):
    """Start the command; ``limit`` is the largest file in bytes that it may write.

    ``signalled`` are name of a signal, process (0 for itself) and number of the chunk that is half written then.
    """
    restrict = None if limit is None else lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
    command = REAL if signalled is None else [sys.executable, str(SIGNALLING), *map(str, signalled)]
    # Python leaves compiled modules that are cut off there, at which every later process fails.
    whole = {} if limit is None else {"PYTHONDONTWRITEBYTECODE": "1"}
    return subprocess.Popen(
        [*command, *LONG, *CHUNKS, "--output", str(folder), *more],
        env=environment(**whole),
        stderr=subprocess.PIPE,
        stdout=subprocess.PIPE,
        encoding="utf-8",
        preexec_fn=restrict,
    )


def marks(folder: Path) -> set[str]:
    """Return the files that mark written chunks."""
    written = folder / "sweep.zarr" / "round-0" / "checksum"
    return {path.name for path in written.iterdir() if path.name.isdigit()} if written.exists() else set()


def finished_by(process):
    out, err = process.communicate(timeout=PATIENCE)
    return process.returncode, out, err


def resumed(folder, *more):
    """Do the rest in this process, which has all libraries loaded, and return the exit status."""
    return cli.status([*LONG, *CHUNKS, "--output", str(folder), "--resume", *more])


def content(path):
    """Return all arrays of a store but for the marks of chunks, by group and name."""
    groups = sorted(group.name for group in path.iterdir() if group.is_dir())
    return {
        (group, name): values.values
        for group in groups
        for name, values in xr.open_zarr(path, group=group, consolidated=False).variables.items()
        if name != "checksum"
    }


def assert_same(one, other):
    assert one.keys() == other.keys()
    for key, values in one.items():
        np.testing.assert_array_equal(values, other[key], err_msg=str(key))
