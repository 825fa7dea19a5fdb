"""Any text of foreign engines and files can be written and shown."""

import json
import xml.etree.ElementTree as ET

import fake_studies
import pytest
from hypothesis import given
from hypothesis import strategies as st

from compare.cli import app as cli
from compare.engines import Engine
from compare.output.outside_text import FORMULA, MOST, all_printable, one_line, printable
from compare.report.write import write_report
from compare.run.runner import run

HOSTILE = "\x1b[31mred\x9b1m \x00 \udc80 \uffff \u202e end"
UNFIT = "\x1b\x9b\x00\udc80\uffff\u202e"
SHOWN = r"\x1b[31mred\x9b1m \x00 \udc80 \uffff \u202e end"

ANYTHING = st.text(st.characters(codec=None))  # including lone surrogates


def is_clean(text):
    return text.replace("\n", "").replace("\t", "").isprintable()


@given(st.one_of(ANYTHING, ANYTHING.map(lambda text: text * 500)))
def test_any_text_can_be_encoded_shown_and_parsed_from_xml(text):
    shown = printable(text)
    assert is_clean(shown)
    assert len(shown) <= MOST
    assert printable(shown) == shown
    assert not one_line(text).startswith(FORMULA)
    element = ET.Element("text")
    element.text = shown
    assert (ET.fromstring(ET.tostring(element, "utf-8")).text or "") == shown


@given(st.text(st.characters(categories=("L", "N", "P", "S")), max_size=MOST))
def test_printable_text_is_unchanged(text):
    assert printable(text) == text


def test_unprintable_characters_are_escaped_and_a_long_text_keeps_both_ends():
    assert printable(HOSTILE) == SHOWN
    assert all_printable({HOSTILE: [HOSTILE, 1.5, None]}) == {SHOWN: [SHOWN, 1.5, None]}
    long = printable("begin" + "\x1b" * 20_000_000 + "end")
    assert (long[:9], long[-7:], len(long)) == (r"begin\x1b", r"\x1bend", MOST - 1)


class MuteError(Exception):
    def __str__(self):
        raise RuntimeError


def test_an_exception_without_text_is_named():
    assert printable(MuteError()) == "MuteError, whose text raises RuntimeError"


@pytest.mark.usefixtures("in_this_process")
def test_no_cell_of_a_table_is_a_formula(tmp_path):
    names = ["=cmd|'/C calc'!A0", "\t=1", "＝1"]
    engines = tuple(Engine(name, fake_studies.straight) for name in names)
    assert [engine.name for engine in engines] == ["'" + name.strip() for name in names]
    write_report(run((fake_studies.AGREEMENT,), engines, folder=tmp_path / "data"), tmp_path)
    (table,) = tmp_path.glob("arrays/**/*.csv")
    assert {line[0] for line in table.read_text("utf-8").splitlines()[1:]} == {"'"}


@pytest.fixture
def hostile(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code = f"def simulate(*_, **__):\n    raise ValueError({HOSTILE!a})\nsimulate.version = {HOSTILE!a}\n"
    (tmp_path / "hostile_engine.py").write_text(code)
    return "hostile_engine:simulate"


@pytest.mark.parametrize(
    ("command", "status"), [("report asking", 1), ("matrix --output out", 1), ("simulate pin", 1)]
)
@pytest.mark.usefixtures("in_this_process")
def test_hostile_text_of_an_engine_is_shown_and_written_escaped(command, status, hostile, tmp_path, capfd):
    assert cli.status([*command.split(), "--engine", hostile], (fake_studies.ASKING,)) == status
    out, err = capfd.readouterr()
    assert is_clean(out + err)
    assert SHOWN in out + err
    written = [path for kind in ("html", "json", "xml") for path in tmp_path.rglob(f"*.{kind}")]
    assert bool(written) is not command.startswith("simulate")
    for path in written:
        content = path.read_text("utf-8")
        assert not set(content) & set(UNFIT)  # the page itself contains non-breaking spaces
        if path.suffix == ".xml":
            assert SHOWN in [error.get("message") for error in ET.fromstring(content).iter("error")]


def test_a_comparison_escapes_hostile_text_of_a_report(reported, tmp_path, capsys):
    results = json.loads((reported[1] / "results.json").read_text("utf-8"))
    for study in results["studies"]:
        study["claims"] = []
        study["units"] = {HOSTILE: next(iter(study["units"].values()))}
    (tmp_path / "results.json").write_text(json.dumps(results))
    assert cli.status(["diff", str(tmp_path), str(reported[1])]) == 1
    out, _ = capsys.readouterr()
    assert is_clean(out)
    assert f"gone: agreement {SHOWN}" in out


def test_a_table_outside_of_a_report_is_not_read(reported, tmp_path, capsys):
    results = json.loads((reported[1] / "results.json").read_text("utf-8"))
    results["studies"][0]["claims"][0]["arrays"] = "../secret.csv"
    (tmp_path / "results.json").write_text(json.dumps(results))
    assert cli.status(["diff", str(tmp_path), str(reported[1])]) == 2
    assert "'../secret.csv' is not in the folder of the report" in capsys.readouterr().err
