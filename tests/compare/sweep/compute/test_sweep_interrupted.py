"""A sweep that is interrupted and runs out of disk space; ``test_sweep_cluster`` kills processes."""

import resource
import signal
import sys

from long_sweeps import CHUNKS, LONG, assert_same, content, marks, resumed, status_of_signalled
from signalling_sweep import signalling_here

from compare.cli import app as cli


def times(folder):
    """Return the modification times of complete chunks."""
    chunks = folder / "sweep.zarr" / "round-0"
    return {
        mark: [(chunks / name / "c" / mark).stat().st_mtime_ns for name in ("end", "time", "steps")]
        for mark in marks(folder)
    }


def test_a_sweep_gives_the_same_results_after_an_interrupt_and_a_full_disk(
    undisturbed, undrawn, tmp_path, monkeypatch, capsys
):
    monkeypatch.setattr("compare.sweep.store.SMALL", 0)  # prevents packing
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # background processes ignore it
    with signalling_here("SIGINT", 0, 5):
        assert cli.status([*LONG, *CHUNKS, "--output", str(tmp_path)]) == 130
    signal.signal(signal.SIGINT, before)
    assert capsys.readouterr() == ("", "Interrupted. Repeat the command with --resume to continue.\n")
    written = times(tmp_path)
    assert written
    assert cli.status(["sweep", "figures", str(tmp_path)]) == 2
    assert "is not finished; repeat it with --resume to complete it" in capsys.readouterr().err

    monkeypatch.setattr(sys, "dont_write_bytecode", True)  # it would be truncated
    allowed = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100, allowed[1]))
    try:
        code = resumed(tmp_path)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, allowed)
    out, err = capsys.readouterr()
    path = tmp_path / "sweep.zarr"
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert err.startswith(f"cannot write to {str(path)!r}: File too large. Results written so far remain")
    assert times(tmp_path) == written

    assert resumed(tmp_path) == 0
    now = times(tmp_path)
    assert {mark: now[mark] for mark in written} == written  # nothing was rewritten
    assert_same(content(path), undisturbed)


def test_a_terminated_sweep_removes_its_temporary_files(tmp_path):
    assert status_of_signalled("SIGTERM", 2, tmp_path) == 130
    assert [path.name for path in tmp_path.iterdir()] == ["sweep.zarr"]
