"""A sweep that is interrupted and runs out of disk space; ``test_sweep_cluster`` kills processes."""

import signal

from long_sweeps import CHUNKS, LONG, assert_same, content, finished_by, long_sweep, marks, resumed
from signalling_sweep import signalling_here

from compare.cli import app as cli


def said(err):
    """Return standard error without compilation notes and warnings from old libraries."""
    lines = (line for line in err.splitlines() if not line.startswith((" ", "Compiling for this machine")))
    return [line for line in lines if "Warning" not in line]


def times(folder):
    """Return the modification times of complete chunks."""
    chunks = folder / "sweep.zarr" / "round-0"
    return {
        mark: [(chunks / name / "c" / mark).stat().st_mtime_ns for name in ("end", "time", "steps")]
        for mark in marks(folder)
    }


def test_a_sweep_gives_the_same_results_after_an_interrupt_and_a_full_disk(
    undisturbed, tmp_path, monkeypatch, capsys
):
    monkeypatch.setattr("compare.sweep.store.SMALL", 0)  # prevents packing
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # background processes ignore it
    with signalling_here("SIGINT", 0, 11):
        assert cli.status([*LONG, *CHUNKS, "--output", str(tmp_path)]) == 130
    signal.signal(signal.SIGINT, before)
    assert capsys.readouterr() == ("", "Interrupted. Repeat the command with --resume to continue.\n")
    written = times(tmp_path)
    assert written

    code, out, err = finished_by(long_sweep(tmp_path, "--resume", limit=100))
    assert (code, out) == (2, "")
    path = tmp_path / "sweep.zarr"
    (line,) = said(err)
    assert line.startswith(f"cannot write to {str(path)!r}: File too large. Results written so far remain")
    assert times(tmp_path) == written

    assert resumed(tmp_path) == 0
    now = times(tmp_path)
    assert {mark: now[mark] for mark in written} == written  # nothing was rewritten
    assert_same(content(path), undisturbed)
