"""Messages for damaged stores, and their repair; ``test_sweep_store_states`` damages every file."""

import errno
import json
import os
import re
import shutil
from pathlib import Path
from zipfile import ZIP_DEFLATED, ZipFile

import pytest
from long_sweeps import assert_same, content

from compare.cli import app as cli
from compare.cli.sweep import run
from compare.cli.sweep.run import STORE
from compare.sweep import store
from compare.sweep.arrays import CHECKSUM, checksum, group_content
from compare.sweep.store import SweepStore

MAP = ["sweep", "map", "pin", "--x", "offset=0:0.1:3", "--y", "mass=1:2:3", "--until", "20", "--chunk", "4"]


@pytest.fixture(scope="module", autouse=True)
def most_may_be_undecided():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(run, "MOST_UNDECIDED", 1.0)
        yield


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """Folder and contents of a finished, unpacked sweep."""
    folder = tmp_path_factory.mktemp("whole")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(store, "SMALL", 0)
        assert cli.status([*MAP, "--output", str(folder)]) == 0
    return folder, content(folder / STORE)


@pytest.fixture
def copied(whole, tmp_path, monkeypatch, capsys, undrawn):
    monkeypatch.setattr(store, "SMALL", 0)
    folder = shutil.copytree(whole[0], tmp_path / "copied")
    capsys.readouterr()
    return folder


def resumed(folder):
    return cli.status([*MAP, "--output", str(folder), "--resume"])


def redrawn(folder):
    return cli.status(["sweep", "figures", str(folder)])


def foreign(**changes):
    """Return a function that changes an array's description and corrects the checksum."""

    def described(path):
        path.write_text(json.dumps(json.loads(path.read_text()) | changes))
        SweepStore.open(path.parents[2])._group(path.parents[1].name).seal()

    return described


PICKLE = [{"name": "numcodecs.pickle"}]  # may run foreign code

DAMAGE = {
    "check": (foreign(data_type="numpy.void"), "check/time/zarr.json"),
    "result": (foreign(codecs=PICKLE), "result/time/zarr.json"),
    "curves": (foreign(storage_transformers=PICKLE), "curves/curve/zarr.json"),
    "the description of round-0": (foreign(codecs=[{"name": "bytes"}]), "round-0/end/zarr.json"),
}


def test_damage_is_reported_and_recomputed(copied, whole, capsys):
    path = copied / STORE
    for how, file in DAMAGE.values():
        how(path / file)
    assert redrawn(copied) == 2
    broken = "; ".join(DAMAGE)
    sentence = f"{str(path)!r} is damaged ({broken}); repeat the sweep with --resume to recompute it\n"
    assert capsys.readouterr() == ("", sentence)
    assert resumed(copied) == 0
    assert set(DAMAGE) == set(re.fullmatch(r"recomputed .*?: (.*)\n", capsys.readouterr().err)[1].split("; "))
    assert_same(content(path), whole[1])
    assert resumed(copied) == 0
    assert capsys.readouterr().err == ""


@pytest.mark.filterwarnings("ignore:Object at .* is not recognized")  # because zarr lists the folder
def test_additional_arrays_of_another_format_are_not_opened(copied):
    for folder in ("", "result", "result/time", "round-0/end"):
        (copied / STORE / folder / ".zarray").write_text(
            '{"zarr_format": 2, "shape": [1], "chunks": [1], "dtype": "|O", "filters": [{"id": "pickle"}]}'
        )
    assert redrawn(copied) == 0


def assert_rejected_and_kept(folder, capsys):
    left = {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    for command in (resumed, redrawn):
        assert command(folder) == 2
        out, err = capsys.readouterr()
        assert (out, err.count("\n")) == ("", 1)
        assert "damaged" in err
    assert {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()} == left


def test_a_store_with_a_damaged_plan_is_rejected_and_kept(copied, capsys):
    file = copied / STORE / "zarr.json"
    before = file.read_bytes()
    another_seed = before.replace(b'\\"seed\\": 1', b'\\"seed\\": 2')
    assert another_seed != before
    file.write_bytes(another_seed)
    assert_rejected_and_kept(copied, capsys)
    file.unlink()
    assert_rejected_and_kept(copied, capsys)


def test_a_small_sweep_is_one_file_that_is_repaired_if_possible(copied, whole, monkeypatch, capsys):
    def one_file():
        return [path for path in copied.rglob("*") if "zarr" in path.name] == [packed]

    monkeypatch.setattr(store, "SMALL", 10)
    packed = Path(f"{copied / STORE}.zip")
    assert resumed(copied) == 0
    assert one_file()
    assert_same(content(copied / STORE), whole[1])

    damaged = bytearray(packed.read_bytes())
    for name in ("round-0/states/c/1/0", "check/time/zarr.json"):
        damaged[damaged.index(name.encode()) + len(name) + 20] ^= 1
    packed.write_bytes(damaged)
    capsys.readouterr()
    assert redrawn(copied) == 2
    assert capsys.readouterr().err.startswith(f"{str(packed)!r} is ")
    assert resumed(copied) == 0
    assert_same(content(copied / STORE), whole[1])
    assert redrawn(copied) == 0
    assert one_file()

    capsys.readouterr()
    packed.write_bytes(packed.read_bytes()[:-8])
    assert_rejected_and_kept(copied, capsys)


SWAPPED = [
    ("round-0/states/c/0/0", "round-0/states/c/1/0"),
    ("result/time/c/0/0/0", "result/slip_power/c/0/0/0"),
]


@pytest.mark.parametrize(("one", "other"), SWAPPED)
def test_a_piece_in_another_place_is_damage(one, other, copied, whole, capsys):
    one, other = copied / STORE / one, copied / STORE / other
    before = one.read_bytes()
    one.write_bytes(other.read_bytes())
    other.write_bytes(before)
    assert redrawn(copied) == 2
    assert "is damaged" in capsys.readouterr().err
    assert resumed(copied) == 0
    assert_same(content(copied / STORE), whole[1])


def without(packed, names, missing):
    """Replace an archive by one that lacks a member."""
    with ZipFile(packed) as archive:
        kept = {name: archive.read(name) for name in names if name != missing}
    with ZipFile(packed, "w") as archive:
        for name, data in kept.items():
            archive.writestr(name, data)


def test_a_disk_that_fails_during_a_repair_costs_one_sentence_and_not_the_archive(
    copied, monkeypatch, capsys
):
    monkeypatch.setattr(store, "SMALL", 10)
    assert resumed(copied) == 0
    packed = Path(f"{copied / STORE}.zip")
    with ZipFile(packed) as archive:
        names = archive.namelist()
    without(packed, names, "round-0/end/c/1")
    before = packed.read_bytes()
    capsys.readouterr()

    def failing(*arguments, **options):
        raise OSError(errno.EIO, "Input/output error")

    with monkeypatch.context() as patch:
        patch.setattr("compare.sweep.files.replacing", failing)
        patch.setattr(os, "unlink", failing)
        patch.setattr(os, "rmdir", failing)
        assert resumed(copied) == 2
    err = capsys.readouterr().err
    assert (err.count("\n"), err.count(": Input/output error. Results written so far remain valid")) == (1, 1)
    assert packed.read_bytes() == before


def test_a_missing_member_of_an_archive_is_replaced(copied, whole, monkeypatch, capsys):
    monkeypatch.setattr(store, "SMALL", 10)
    assert resumed(copied) == 0
    packed = Path(f"{copied / STORE}.zip")
    with ZipFile(packed) as archive:
        names = archive.namelist()
    for missing in ("round-0/end/c/1", "round-0/end/seals/0", "check/zarr.json", "curves/curve/c/0"):
        without(packed, names, missing)
        capsys.readouterr()
        assert resumed(copied) == 0
        assert capsys.readouterr().err.startswith("recomputed damaged parts")
        with ZipFile(packed) as archive:
            assert archive.namelist() == names
        assert_same(content(copied / STORE), whole[1])


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes")
@pytest.mark.parametrize(
    "made", [lambda path: path.symlink_to("/etc/passwd"), os.mkfifo], ids=["link", "pipe"]
)
def test_links_and_pipes_in_a_store_are_refused(made, copied, capsys):
    for name in ("zarr.json", "round-0/private"):
        (copied / STORE / name).unlink(missing_ok=True)
        made(copied / STORE / name)
        assert (resumed(copied), redrawn(copied)) == (2, 2)
        assert capsys.readouterr().err.count("is a link, pipe or device") == 2


def forged(folder, **changes):
    attributes = json.loads((folder / STORE / "zarr.json").read_text())["attributes"]
    del attributes[CHECKSUM]
    attributes["plan"] = json.dumps(json.loads(attributes["plan"]) | changes)
    content = group_content(attributes | {CHECKSUM: checksum(attributes)})
    (folder / STORE / "zarr.json").write_bytes(content)


FORGED = [
    {"kind": "random basin", "start": [0.1, 0.0, 0.0, 0.0], "samples": -5, "starts": None},
    {"starts": []},
    {"starts": [[0.1, 0.0, 0.0]]},
    {"seed": "1"},
    {"seed": None},
    {"duration": "nan"},
    {"tolerance": 1.0},
    {"x": None},
    {"x": {"name": "colour", "low": 0.0, "high": 1.0, "points": 3}},
    {
        "x": {"name": "disc_speed", "low": 1.0, "high": 2.0, "points": 100_000},
        "y": {"name": "friction_force", "low": 0.1, "high": 0.2, "points": 100_000},
    },
]


@pytest.mark.parametrize("changes", FORGED)
def test_a_forged_plan_is_rejected_in_a_sentence(changes, copied, capsys):
    forged(copied, **changes)
    assert_rejected_and_kept(copied, capsys)


def test_groups_of_another_plan_are_damaged(copied, capsys):
    forged(copied, duration=21.0)
    assert redrawn(copied) == 2
    assert "is damaged (check; result; curves; the description of round-0)" in capsys.readouterr().err


def test_an_archive_is_not_unpacked_beyond_what_it_describes(copied, monkeypatch, capsys):
    monkeypatch.setattr(store, "SMALL", 10)
    assert resumed(copied) == 0
    with ZipFile(f"{copied / STORE}.zip", "a", ZIP_DEFLATED) as archive:
        archive.writestr("round-0/end/c/7", bytes(2 * store.LEAST_ROOM))
    before = sorted(copied.iterdir())
    capsys.readouterr()
    assert (resumed(copied), redrawn(copied)) == (2, 2)
    assert capsys.readouterr().err.count("but its description allows") == 2
    assert sorted(copied.iterdir()) == before


def test_a_disk_that_is_full_while_an_archive_is_unpacked_is_not_damage(copied, monkeypatch, capsys):
    monkeypatch.setattr(store, "SMALL", 10)
    assert resumed(copied) == 0
    before = sorted(copied.iterdir())
    capsys.readouterr()

    def full(*arguments):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(ZipFile, "extract", full)
    assert (resumed(copied), redrawn(copied)) == (2, 2)
    assert capsys.readouterr().err.count("No space left on device\n") == 2
    assert sorted(copied.iterdir()) == before
