"""Messages for damaged stores, and their repair; ``test_sweep_store_states`` damages every file."""

import json
import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from long_sweeps import assert_same, content

from compare.cli import app as cli
from compare.cli.sweep import run
from compare.cli.sweep.run import STORE
from compare.sweep import store
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


def remove(path):
    shutil.rmtree(path) if path.is_dir() else path.unlink()


def changed(change):
    """Return a function that replaces the content of a file."""
    return lambda path: path.write_bytes(change(path.read_bytes()))


EMPTY, CUT = changed(lambda old: b""), changed(lambda old: old[:-8])
GARBLED = changed(lambda old: np.random.default_rng(1).bytes(len(old)))
ANOTHER_SEED = changed(lambda old: old.replace(b'\\"seed\\": 1', b'\\"seed\\": 2'))
ONE_BIT = changed(lambda old: old[: (half := len(old) // 2)] + bytes([old[half] ^ 1]) + old[half + 1 :])


def foreign(**changes):
    """Return a function that changes an array's description and corrects the checksum."""

    def described(path):
        path.write_text(json.dumps(json.loads(path.read_text()) | changes))
        SweepStore.open(path.parents[2])._group(path.parents[1].name).seal()

    return described


PICKLE = [{"name": "numcodecs.pickle"}]  # may run foreign code

DAMAGE = [
    {
        "check": (foreign(data_type="numpy.void"), "check/time/zarr.json"),
        "result": (foreign(codecs=PICKLE), "result/time/zarr.json"),
        "curves": (foreign(storage_transformers=PICKLE), "curves/curve/zarr.json"),
        "round-0: chunk 1 (of 3)": (EMPTY, "round-0/end/c/1"),
    },
    {
        "curves": (ONE_BIT, "curves/curve/c/0"),
        "the description of round-0": (foreign(codecs=[{"name": "bytes"}]), "round-0/end/zarr.json"),
    },
]


@pytest.mark.parametrize("damage", DAMAGE)
def test_damage_is_reported_and_recomputed(damage, copied, whole, capsys):
    path = copied / STORE
    for how, file in damage.values():
        before = (path / file).read_bytes()
        how(path / file)
        assert (path / file).read_bytes() != before
    assert cli.status(["sweep", "figures", str(copied)]) == 2
    broken = "; ".join(damage)
    sentence = f"{str(path)!r} is damaged ({broken}); repeat the sweep with --resume to recompute it\n"
    assert capsys.readouterr() == ("", sentence)
    assert cli.status([*MAP, "--output", str(copied), "--resume"]) == 0
    assert set(damage) == set(re.fullmatch(r"recomputed .*?: (.*)\n", capsys.readouterr().err)[1].split("; "))
    assert_same(content(path), whole[1])
    assert cli.status([*MAP, "--output", str(copied), "--resume"]) == 0
    assert capsys.readouterr().err == ""


@pytest.mark.filterwarnings("ignore:Object at .* is not recognized")  # because zarr lists the folder
def test_additional_arrays_of_another_format_are_not_opened(copied):
    for folder in ("", "result", "result/time", "round-0/end"):
        (copied / STORE / folder / ".zarray").write_text(
            '{"zarr_format": 2, "shape": [1], "chunks": [1], "dtype": "|O", "filters": [{"id": "pickle"}]}'
        )
    assert cli.status(["sweep", "figures", str(copied)]) == 0


@pytest.mark.parametrize("how", [GARBLED, remove, ANOTHER_SEED])
def test_a_store_with_a_damaged_plan_is_rejected_and_kept(how, copied, capsys):
    file = copied / STORE / "zarr.json"
    before = file.read_bytes()
    how(file)
    assert not file.exists() or file.read_bytes() != before
    assert_refused(copied, capsys)


def assert_refused(folder, capsys):
    left = {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    for arguments in ([*MAP, "--output", str(folder), "--resume"], ["sweep", "figures", str(folder)]):
        assert cli.status(arguments) == 2
        out, err = capsys.readouterr()
        assert (out, err.count("\n")) == ("", 1)
        assert "damaged" in err
    assert {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()} == left


def test_missing_parts_are_recomputed(copied, whole, capsys):
    remove(copied / STORE / "round-0/end/c/1")
    assert cli.status(["sweep", "figures", str(copied)]) == 2
    assert "is not finished; repeat it with --resume to complete it" in capsys.readouterr().err
    assert cli.status([*MAP, "--output", str(copied), "--resume"]) == 0
    assert_same(content(copied / STORE), whole[1])


@pytest.fixture
def packed(copied, monkeypatch, capsys):
    monkeypatch.setattr(store, "SMALL", 10)
    assert cli.status([*MAP, "--output", str(copied), "--resume"]) == 0
    capsys.readouterr()
    return Path(f"{copied / STORE}.zip")


def test_a_small_sweep_is_one_file(packed, whole):
    assert [path for path in packed.parent.rglob("*") if "zarr" in path.name] == [packed]
    assert_same(content(packed.with_suffix("")), whole[1])


def test_a_partly_damaged_file_is_repaired(packed, whole, capsys):
    damaged = bytearray(packed.read_bytes())
    for name in ("round-0/states/c/1/0", "check/time/zarr.json"):
        damaged[damaged.index(name.encode()) + len(name) + 20] ^= 1
    packed.write_bytes(damaged)
    assert cli.status(["sweep", "figures", str(packed.parent)]) == 2
    assert capsys.readouterr().err.startswith(f"{str(packed)!r} is ")
    assert cli.status([*MAP, "--output", str(packed.parent), "--resume"]) == 0
    assert_same(content(packed.with_suffix("")), whole[1])
    assert cli.status(["sweep", "figures", str(packed.parent)]) == 0
    assert [path for path in packed.parent.rglob("*") if "zarr" in path.name] == [packed]


@pytest.mark.parametrize("how", [EMPTY, CUT])
def test_a_damaged_archive_is_rejected_and_kept(how, packed, capsys):
    how(packed)
    assert_refused(packed.parent, capsys)
