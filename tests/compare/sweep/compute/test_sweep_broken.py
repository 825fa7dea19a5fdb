"""Stores of which files are missing, cut, or have other contents: mended or refused, always in words."""

import json
import shutil

import numpy as np
import pytest
import zarr
from long_sweeps import assert_same, content

from compare.cli import app as cli
from compare.cli.sweep import run
from compare.cli.sweep.run import STORE
from compare.sweep.store.round import CHECKSUM, DESCRIPTION
from compare.sweep.store.store import FILES_OF_ROUND, SweepStore, _checksum, digest_of

MAP = ["sweep", "map", "pin", "--x", "offset=0:0.1:3", "--y", "mass=1:2:3", "--until", "20", "--chunk", "4"]


@pytest.fixture(scope="module", autouse=True)
def most_may_be_undecided():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(run, "MOST_UNDECIDED", 1.0)
        yield


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The folder of a finished sweep and what is in its store."""
    folder = tmp_path_factory.mktemp("whole")
    assert cli.status([*MAP, "--output", str(folder)]) == 0
    return folder, content(folder / STORE)


@pytest.fixture
def copied(whole, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("compare.sweep.show.figures.write_figures", lambda store, folder: ())
    folder = shutil.copytree(whole[0], tmp_path / "copied")
    capsys.readouterr()
    return folder


def remove(path):
    shutil.rmtree(path) if path.is_dir() else path.unlink()


def empty(path):
    path.write_bytes(b"")


def cut(path):
    path.write_bytes(path.read_bytes()[:-8])


def garble(path):
    path.write_bytes(np.random.default_rng(1).bytes(path.stat().st_size))


def with_other_numbers(path):
    """Change one number of the chunk, in a file that is whole."""
    array = zarr.open_array(str(path.parent), mode="r+")
    start = int(path.name.partition(".")[0]) * array.chunks[0]
    array[start] = array[start] + 1


def of_another_chunk(path):
    shutil.copy(path.with_name(path.name.replace("1", "0", 1)), path)


def another_seed(path):
    path.write_text(path.read_text().replace('\\"seed\\": 1', '\\"seed\\": 2'))


def foreign(**changes):
    """Return what makes an array another one, of which every checksum is right."""

    def described(path):
        path.write_text(json.dumps(json.loads(path.read_text()) | changes))
        store, group = SweepStore.open(path.parents[2]), path.parents[1].name
        names = FILES_OF_ROUND if group.startswith("round") else list(store._names(group))
        contents = {name: store.files.read(f"{group}/{name}") for name in names if name != DESCRIPTION}
        digests = {name: digest_of(content) for name, content in contents.items() if content is not None}
        (path.parents[1] / DESCRIPTION).write_text(json.dumps({CHECKSUM: _checksum(digests)}))

    described.__name__ = "foreign " + " ".join(changes)
    return described


PICKLE = {"id": "pickle"}  # runs code of whoever wrote the array

MENDED = [
    (foreign(filters=[PICKLE]), "result/time/.zarray", "result"),
    (foreign(compressor=PICKLE), "check/time/.zarray", "check"),
    (foreign(filters=[PICKLE], compressor=None, dtype="|O"), "curves/curve/.zarray", "curves"),
    (foreign(filters=[PICKLE]), "round-0/end/.zarray", "the description of round-0"),
    (remove, "round-0/end/1", "of 3 chunks of round-0 these: 1"),
    (empty, "round-0/end/1", "of 3 chunks of round-0 these: 1"),
    (garble, "round-0/time/2", "of 3 chunks of round-0 these: 2"),
    (cut, "round-0/states/1.0", "of 3 chunks of round-0 these: 1"),
    (with_other_numbers, "round-0/states/1.0", "of 3 chunks of round-0 these: 1"),
    (with_other_numbers, "round-0/steps/0", "of 3 chunks of round-0 these: 0"),
    (of_another_chunk, "round-0/states/1.0", "of 3 chunks of round-0 these: 1"),
    (of_another_chunk, "round-0/checksum/1", "of 3 chunks of round-0 these: 1"),
    (garble, "round-0/checksum/1", "of 3 chunks of round-0 these: 1"),
    (empty, "round-0/end/.zarray", "the description of round-0"),
    (garble, "round-0/.zgroup", "the description of round-0"),
    (remove, "round-0/.zattrs", "the description of round-0"),
    (remove, "round-0/component/0", "the description of round-0"),
    (remove, "round-0/time", "the description of round-0; of 3 chunks of round-0 these: 0, 1, 2"),
    (remove, "result/time/0.0.0", "result"),
    (with_other_numbers, "result/time/0.0.0", "result"),
    (cut, "result/.zattrs", "result"),
    (cut, "check/difference/0.0", "check"),
    (empty, "curves/.zgroup", "curves"),
]
NAMES = [f"{how.__name__} {file}" for how, file, _ in MENDED]


@pytest.mark.parametrize(("how", "file", "broken"), MENDED, ids=NAMES)
def test_what_is_broken_is_told_and_computed_again(how, file, broken, copied, whole, capsys):
    path = copied / STORE
    how(path / file)
    assert cli.status(["sweep", "figures", str(copied)]) == 2
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert err.startswith(
        f"{str(path)!r} is broken ({broken.partition('; ')[0]}): --resume computes that again"
    )
    assert cli.status([*MAP, "--output", str(copied), "--resume"]) == 0
    assert capsys.readouterr().err == f"{str(path)!r} was broken and is computed again: {broken}\n"
    assert_same(content(path), whole[1])
    assert cli.status([*MAP, "--output", str(copied), "--resume"]) == 0
    assert capsys.readouterr().err == ""


def test_arrays_of_another_format_beside_ours_are_not_opened(copied):
    for folder in ("", "result", "result/time", "round-0/end"):
        (copied / STORE / folder / "zarr.json").write_text(
            '{"zarr_format": 3, "codecs": [{"name": "pickle"}]}'
        )
    assert cli.status(["sweep", "figures", str(copied)]) == 0


REFUSED = [*((how, file) for file in (".zattrs", ".zgroup") for how in (empty, cut, garble, remove))]


@pytest.mark.parametrize(("how", "file"), [*REFUSED, (another_seed, ".zattrs")])
def test_a_store_whose_plan_is_broken_is_refused_and_left_as_it_is(how, file, copied, capsys):
    file = copied / STORE / file
    before = file.read_bytes()
    how(file)
    assert not file.exists() or file.read_bytes() != before
    left = {path: path.read_bytes() for path in copied.rglob("*") if path.is_file()}
    for arguments in ([*MAP, "--output", str(copied), "--resume"], ["sweep", "figures", str(copied)]):
        assert cli.status(arguments) == 2
        out, err = capsys.readouterr()
        assert (out, err.count("\n")) == ("", 1)
        assert "broken" in err
    assert {path: path.read_bytes() for path in copied.rglob("*") if path.is_file()} == left


def test_a_round_that_is_gone_is_computed_again(copied, whole, capsys):
    remove(copied / STORE / "round-0")
    assert cli.status(["sweep", "figures", str(copied)]) == 2
    assert "is not finished: --resume goes on with it" in capsys.readouterr().err
    assert cli.status([*MAP, "--output", str(copied), "--resume"]) == 0
    assert_same(content(copied / STORE), whole[1])
