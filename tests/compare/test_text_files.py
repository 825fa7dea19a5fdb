"""Files are replaced atomically, even if writing fails."""

import errno
import os
import stat

import pytest

from compare.cli import app as cli
from compare.cli.trajectory_files import WRITERS
from compare.output.text_files import check_writable, replacing

OLD = "old\n"


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "folder" / "pin.csv"
    path.parent.mkdir()
    path.write_text(OLD)
    return path


def alone(path):
    return [one.name for one in path.parent.iterdir()] == [path.name]


def test_link_and_permissions_of_a_replaced_file_are_kept(file, tmp_path):
    file.chmod(0o640)
    link = tmp_path / "link.csv"
    link.symlink_to(file)
    with replacing(link) as stream:
        stream.write("new\n")
    assert link.is_symlink()
    assert file.read_text() == "new\n"
    assert stat.S_IMODE(file.stat().st_mode) == 0o640
    assert alone(file)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes")
def test_a_pipe_is_written_directly(tmp_path):
    """A pipe stands for all devices. A fault in the code, run by root, would replace a real one."""
    path = tmp_path / "pipe"
    os.mkfifo(path)
    reader = os.open(path, os.O_RDONLY | os.O_NONBLOCK)
    with replacing(path) as stream:
        stream.write("new\n")
    assert path.is_fifo()
    assert os.read(reader, 100) == b"new\n"
    os.close(reader)


def test_a_check_of_a_path_changes_nothing(file):
    before = file.stat()
    check_writable(file)
    check_writable(file.with_name("new.csv"))
    assert (file.stat().st_mtime_ns, file.stat().st_ino) == (before.st_mtime_ns, before.st_ino)
    assert alone(file)
    with pytest.raises(IsADirectoryError):
        check_writable(file.parent)


FAILURES = [
    (KeyboardInterrupt(), 130, "Interrupted.\n"),
    (
        OSError(errno.ENOSPC, "No space left on device"),
        2,
        "cannot write the file {path!r}: No space left on device\n",
    ),
]


@pytest.mark.usefixtures("in_this_process")
@pytest.mark.parametrize(("error", "status", "sentence"), FAILURES, ids=["Ctrl-C", "full disk"])
def test_a_half_written_motion_leaves_the_older_file_or_none(
    error, status, sentence, file, monkeypatch, capsys
):
    whole = WRITERS[file.suffix]

    def failing(trajectory, engine, stream):
        whole(trajectory, engine, stream)
        stream.flush()
        raise error

    monkeypatch.setitem(WRITERS, file.suffix, failing)
    for path in (file, file.with_name("new.csv")):
        arguments = ["simulate", "pin", "--until", "1", "--samples", "3", "--output", str(path)]
        assert cli.status(arguments) == status
        assert capsys.readouterr().err == sentence.format(path=str(path))
    assert file.read_text() == OLD
    assert alone(file)
