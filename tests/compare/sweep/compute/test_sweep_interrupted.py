"""Sweeps that are killed, interrupted or run out of disk space."""

import signal
from shutil import copytree

import pytest
from long_sweeps import assert_same, content, finished_by, long_sweep, marks, resumed


@pytest.fixture(scope="module")
def interrupted(undisturbed, tmp_path_factory):
    """Folder, exit status and output of an interrupted sweep."""
    folder = tmp_path_factory.mktemp("interrupted")
    return folder, finished_by(long_sweep(folder, signalled=("SIGINT", 0, 11)))


@pytest.fixture
def unfinished(interrupted, tmp_path):
    return copytree(interrupted[0], tmp_path / "unfinished")


def test_a_keyboard_interrupt_is_reported(interrupted):
    code, out, err = interrupted[1]
    assert (code, out, said(err)) == (130, "", ["Interrupted. Repeat the command with --resume to continue."])


def said(err):
    """Return standard error without compilation notes and warnings from old libraries."""
    lines = (line for line in err.splitlines() if not line.startswith((" ", "Compiling for this machine")))
    return [line for line in lines if "Warning" not in line]


def test_a_sweep_gives_the_same_results_after_an_interrupt_and_a_kill(undisturbed, unfinished):
    written = times(unfinished)
    process = long_sweep(unfinished, "--resume", signalled=("SIGKILL", 0, 11))
    assert finished_by(process)[0] == -signal.SIGKILL
    now = times(unfinished)
    assert len(now) == len(written) + 10
    assert {mark: now[mark] for mark in written} == written  # nothing was rewritten
    assert resumed(unfinished) == 0
    assert_same(content(unfinished / "sweep.zarr"), undisturbed)


def times(folder):
    """Return the modification times of complete chunks."""
    chunks = folder / "sweep.zarr" / "round-0"
    return {
        mark: [(chunks / name / "c" / mark).stat().st_mtime_ns for name in ("end", "time", "steps")]
        for mark in marks(folder)
    }


def test_a_full_disk_is_reported_and_written_results_stay_valid(undisturbed, unfinished):
    before = marks(unfinished)
    code, out, err = finished_by(long_sweep(unfinished, "--resume", limit=100))
    assert (code, out) == (2, "")
    path = unfinished / "sweep.zarr"
    (line,) = said(err)
    assert line.startswith(f"cannot write to {str(path)!r}: File too large. Results written so far remain")
    assert marks(unfinished) == before
    assert resumed(unfinished) == 0
    assert_same(content(path), undisturbed)
