"""Files are replaced atomically, even if writing fails."""

import builtins
import errno
import itertools
import os
import shutil
import stat
import subprocess
import sys
import zipfile

import pytest

from compare.cli import app as cli
from compare.cli.trajectory_files import WRITERS
from compare.output.text_files import LOCK, check_writable, locked, read_file, read_json, replacing
from fmu_models import archive

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


def test_an_error_of_the_disk_names_the_file(file):
    with pytest.raises(OSError, match="full") as found, replacing(file):
        raise OSError(errno.ENOSPC, "full")
    assert found.value.filename == str(file)


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


def test_several_writers_of_a_file_do_not_disturb_each_other(tmp_path):
    file = tmp_path / f"{247 * 'a'}.csv"
    with replacing(file) as first, replacing(file) as second:
        check_writable(file)
        first.write("first\n")
        second.write("second\n")
        check_writable(file)
    assert file.read_text() == "first\n"  # closed last
    assert alone(file)


HOLD = """
import sys
from pathlib import Path
from compare.output.text_files import locked
with locked(Path(sys.argv[1])):
    print("held", flush=True)
    sys.stdin.read()
"""


def test_a_folder_is_held_by_one_process_at_a_time(tmp_path, capsys):
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    with subprocess.Popen([sys.executable, "-c", HOLD, str(tmp_path)], **pipes) as other:
        assert other.stdout.readline() == b"held\n"
        for command in (["report", "fig03"], ["sweep", "basin", "pin"], ["matrix"], ["plan"]):
            before = sorted(tmp_path.iterdir())
            assert cli.status([*command, "--output", str(tmp_path)]) == 2
            assert f"process {other.pid} on " in capsys.readouterr().err
            assert sorted(tmp_path.iterdir()) == before
        other.kill()
    assert (tmp_path / LOCK).exists()
    with locked(tmp_path), pytest.raises(BlockingIOError, match=f"process {os.getpid()} "), locked(tmp_path):
        pass
    assert not list(tmp_path.iterdir())


def test_a_lock_is_not_written_through_a_link(tmp_path):
    private = tmp_path / "private"
    private.write_text(OLD)
    (tmp_path / LOCK).symlink_to(private)
    with pytest.raises(OSError, match="symbolic"), locked(tmp_path):
        pass
    assert private.read_text() == OLD


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes")
def test_only_regular_files_of_limited_size_are_read(file):
    os.mkfifo(file.with_name("pipe"))
    with pytest.raises(OSError, match="not a regular file"):
        read_file(file.with_name("pipe"))
    with pytest.raises(OSError, match="larger than 3 bytes"):
        read_file(file, most=3)


@pytest.mark.parametrize(
    "text", ["NaN", "1e999", "-Infinity", 100_000 * "[", 900 * "[" + 900 * "]", "\\xff", ""]
)
def test_only_finite_numbers_and_flat_values_are_read(text, file):
    file.write_bytes(text.encode().replace(b"\\xff", b"\xff"))
    with pytest.raises(ValueError, match=r"finite|nested|decode|Expecting"):
        read_json(file)


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


CALLS = ((builtins, "open"), (os, "replace"), (shutil, "copymode"), (zipfile.ZipFile, "write"))
WRITERS_OF_FILES = {
    "pin.csv": ["simulate", "pin", "--until", "1", "--samples", "3"],
    "pin.fmu": ["export-fmu", "pin"],
}


@pytest.mark.usefixtures("in_this_process")
@pytest.mark.parametrize("name", WRITERS_OF_FILES)
def test_a_fault_of_the_disk_at_any_call_leaves_the_older_file(name, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(archive, "compiler", lambda: None)
    path = tmp_path / name
    path.write_text(OLD)

    def counted(function):
        def call(*arguments, **options):
            nonlocal left
            below = str(tmp_path) in map(os.path.dirname, filter(None, map(str, arguments[:1])))
            left -= below or function.__name__ in ("replace", "write")
            if left == 0:
                left = -1
                raise OSError(errno.ENOSPC, "No space left on device")
            return function(*arguments, **options)

        return call

    for n in itertools.count(1):
        left = n
        with monkeypatch.context() as patch:
            for place, function in CALLS:
                patch.setattr(place, function, counted(getattr(place, function)))
            code = cli.status([*WRITERS_OF_FILES[name], "--output", str(path)])
        if left > 0:
            break
        assert code != 0, capsys.readouterr()
        assert path.read_text() == OLD
        assert alone(path)
    assert code == 0
    assert n > 2
    assert path.read_bytes() != OLD.encode()
