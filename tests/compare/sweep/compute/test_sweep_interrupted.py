"""A sweep that is interrupted, runs out of disk space and is killed."""

import signal

from long_sweeps import assert_same, content, finished_by, long_sweep, marks, resumed


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


def test_a_sweep_gives_the_same_results_after_an_interrupt_a_full_disk_and_a_kill(undisturbed, tmp_path):
    code, out, err = finished_by(long_sweep(tmp_path, signalled=("SIGINT", 0, 11)))
    assert (code, out, said(err)) == (130, "", ["Interrupted. Repeat the command with --resume to continue."])
    written = times(tmp_path)
    assert written

    code, out, err = finished_by(long_sweep(tmp_path, "--resume", limit=100))
    assert (code, out) == (2, "")
    path = tmp_path / "sweep.zarr"
    (line,) = said(err)
    assert line.startswith(f"cannot write to {str(path)!r}: File too large. Results written so far remain")
    assert times(tmp_path) == written

    code, _, _ = finished_by(long_sweep(tmp_path, "--resume", signalled=("SIGKILL", 0, 11)))
    assert code == -signal.SIGKILL
    now = times(tmp_path)
    assert len(now) == len(written) + 10
    assert {mark: now[mark] for mark in written} == written  # nothing was rewritten
    assert resumed(tmp_path) == 0
    assert_same(content(path), undisturbed)
