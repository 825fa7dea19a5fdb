import json
import re
import xml.etree.ElementTree as ET
from collections import Counter
from dataclasses import replace
from html.parser import HTMLParser
from itertools import groupby
from urllib.parse import unquote

import fake_studies
import numpy as np
import pytest
from fake_studies import AGREEMENT, PARTLY, PIN, POINTS, RING, RING_ONLY, VERDICTS, fake, recorded, straight
from fake_studies import claim as made
from processes import ROOT

from compare.claims.as_json import claim_from_json
from compare.claims.errata import TEXT, Erratum, Evidence
from compare.claims.study import Findings
from compare.cli.app import status
from compare.engines import EVERY_KIND, Engine
from compare.report.matrix import State
from compare.report.page import summary
from compare.report.quotes import parts
from compare.report.results_json import read_results
from compare.report.write import write_report
from compare.run.runner import run
from compare.studies import STUDIES

pytestmark = pytest.mark.usefixtures("all_in_this_process")

UNDRAWN = fake(VERDICTS.name, VERDICTS.title, VERDICTS.prose.paper, fake_studies.measure_verdicts)


class Cells(HTMLParser):
    """Collects the cells of all tables: [class of table, id of body, label, text, numbers]."""

    def __init__(self, page):
        super().__init__()
        self.cells, self.links, self.ids = [], [], []
        self._table = self._body = self._label = ""
        self._open = False
        self.feed(page)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.ids += [attributes["id"]] if "id" in attributes else []
        self.links += [attributes["href"]] if "href" in attributes else []
        if tag == "table":
            self._table = attributes.get("class")
        elif tag == "tbody":
            self._body = attributes.get("id", "")
        elif tag in ("td", "th"):
            self._open = True
            self.cells.append([self._table, self._body, attributes.get("data-label"), "", []])
        elif tag == "data" and self._open:
            self.cells[-1][4].append(float(attributes["value"]))

    def handle_endtag(self, tag):
        self._open = self._open and tag not in ("td", "th")

    def handle_data(self, text):
        if self._open:
            self.cells[-1][3] += text


def claims_of(page):
    """Return the texts for each engine next to each claim, by the claim's id."""
    found = {}
    for identity, said in re.findall(
        r'<details class="claim" id="([^"]*)".*?<span class="cells">(.*?)</summary>', page, flags=re.DOTALL
    ):
        cells = said.replace("</span><span>", "\n")
        found[identity] = [
            " ".join(re.sub("<[^>]*>", "", cell).split()) for cell in cells.split("\n") if cell
        ]
    return found


@pytest.fixture(scope="module")
def page(reported):
    return (reported[1] / "index.html").read_text(encoding="utf-8").replace("\N{NO-BREAK SPACE}", " ")


@pytest.fixture(scope="module")
def cells(page):
    return Cells(page)


@pytest.fixture(scope="module")
def results(reported):
    return read_results(reported[1])


LABELS = {
    "Predicted": "predicted",
    "Measured": "measured",
    "Difference": "difference",
    "Numerical error": "numerical_error",
    "Model error": "model_error",
    "Resolution": "resolution",
}
TAGS = {"agrees": None, "differs": "failure", "inconclusive": "skipped", "failed": "error"}


def test_page_results_tables_and_junit_show_the_same_claims(results, page, cells, reported):
    """The tables contain the arrays of ``results``, which must be those of the study."""
    shown = {
        label: [it for c in cells.cells if c[0] == "claims" and c[2] == label for it in c[4]]
        for label in LABELS
    }
    root = ET.parse(reported[1] / "junit.xml").getroot()
    cases = {(case.get("classname"), case.get("name")): case for case in root.iter("testcase")}
    made_by_engine = {one.sentence: one for one in fake_studies.measure_verdicts(fake_studies.GOOD).claims}
    verdicts = Counter()
    claims = [(study["name"], claim) for study in results["studies"] for claim in study["claims"]]
    for i, (study, claim) in enumerate(claims):
        verdicts[claim["verdict"]] += 1
        decides = {"model_error": claim["model_error"], "resolution": claim["resolution"]} | claim[
            "decided_by"
        ]
        assert {name: shown[label][i] for label, name in LABELS.items()}.items() <= decides.items()
        case = cases.pop((f"{study}.{claim['engine']}", claim["sentence"]))
        said = {one.get("name"): one.get("value") for one in case.iter("property")}
        assert (said["id"], said.get("unit", "")) == (claim["id"], claim["unit"])
        for name in ("predicted", "measured", "difference", "allowed", "resolution"):
            assert float(said[name]) == decides[name]
        assert [part.tag for part in case if part.tag != "properties"] == [
            *filter(None, [TAGS[claim["verdict"]]])
        ]
        if claim["engine"] == "good" and claim["sentence"] in made_by_engine:
            back, own = claim_from_json(claim), made_by_engine[claim["sentence"]]
            for array in ("predicted", "measured"):
                np.testing.assert_array_equal(getattr(back, array), getattr(own, array))
            errors = np.broadcast_to(own.budget.numerical, own.predicted.shape)
            np.testing.assert_array_equal(back.budget.numerical, errors)
            assert back.verdict is own.verdict
    verdicts["failed"] = sum(case.find("error") is not None for case in cases.values())
    assert (
        verdicts == {"agrees": 5, "differs": 1, "inconclusive": 1, "failed": 4} == +Counter(results["totals"])
    )
    assert len(cases) == 4  # the claims of the engine that failed
    attributes = ("tests", "failures", "errors", "skipped")
    assert [root.get(name) for name in attributes] == ["11", "1", "4", "1"]
    (failure,) = root.iter("failure")
    assert failure.get("message").startswith(
        "predicted 0.1 N, measured 0.1004 N, difference 0.00040, allowed "
    )
    totals = "4 checks against independent evidence and 1 other agree, 1 differs, 1 inconclusive, 4 failed."
    assert totals in page
    unit = results["studies"][0]["units"]["failing"]
    assert unit["state"] == "failed"
    assert unit["reason"] == "the step size became too small at t = 3.2 s: try a larger tolerance"
    assert page.count(unit["reason"]) >= 2


def measure_openly(engine):
    """Return two inconclusive claims; in the first, the element nearest to failing is not the least certain one."""
    numbers = ((1e-9, [1e-9, 0.75, 1e-9]), (0.4, [0.5, 0.5, 0.5]))
    claims = (made("Open", engine.name, np.zeros(3), [off, 0.0, 0.0], errors) for off, errors in numbers)
    return Findings(tuple(claims))


def test_an_inconclusive_claim_shows_its_least_certain_element_and_a_cell_its_least_certain_claim(tmp_path):
    study = fake("open", "Open", "Any.", measure_openly)
    write_report(run((study,), (Engine("one", straight),), folder=tmp_path / "data"), tmp_path)
    page = (tmp_path / "index.html").read_text(encoding="utf-8")
    shown = [cell[4] for cell in Cells(page).cells if cell[0] == "claims" and cell[2] == "Numerical error"]
    assert shown == [[0.75], [0.5]]
    assert claims_of(page) == {"open/open": ["one ? inconclusive ×2 ± 0.75 m"]}


def test_exceptions_are_listed_below_the_totals(page):
    (listed,) = re.findall(r'<ul class="exceptions">(.*?)</ul>', page, flags=re.DOTALL)
    lines = [" ".join(re.sub("<[^>]*>", "", line).split()) for line in listed.split("</li>")][:-1]
    assert lines == [
        "! failed failing: Fig. 3: self-centring of the pin at low speed: "
        "the step size became too small at t = 3.2 s: try a larger tolerance",
        "✗ differs good: The equilibrium is lost at the load of eq. (5)",
        "? inconclusive good: The time of release follows from eq. (7)",
    ]


def test_links_have_targets_and_the_page_loads_nothing(page, cells, reported):
    for link in (re.sub(r"^\?[^#]*", "", link) for link in cells.links):
        assert (
            unquote(link[1:]) in cells.ids if link.startswith("#") else (reported[1] / unquote(link)).exists()
        )
    assert len(set(cells.ids)) == len(cells.ids)
    sources = re.findall(r'(?:src|href)="([^"]*)"', page)
    beside = ("#", "?engine=", "results.json", "junit.xml", "figures/", "arrays/")
    assert all(source.startswith(beside) for source in sources)
    assert not re.search(r"@import|url\(|fetch\(|XMLHttp|import\(|<link|https?:", page)


def test_the_page_shows_the_figures_of_the_folder(page, reported):
    files = {"fake-radius.svg": b"<?xml", "fake-motion.gif": b"GIF89a", "fake-motion.png": b"\x89PNG"}
    for name, start in files.items():
        assert (reported[1] / "figures" / name).read_bytes().startswith(start)
    assert '<img src="figures/fake-radius.svg" loading="lazy"' in page
    assert '<img src="figures/fake-motion.png" loading="lazy"' in page  # animations start on request
    assert '<a class="play" href="figures/fake-motion.gif">' in page
    assert "Radius of the equilibrium over the load: both engines on the formula (3)." in page


SAID = (
    "friction-discs report verdicts --engine good",  # command that repeats the study
    "friction-discs report agreement --engine failing",
    "towards the centre of the disc, <code>rest(load) &lt; X₀</code>.</p>",
    "mass = 1 kg, stiffness = 1 N/m, damping = 0.1 N s/m, disc_speed = 0.7 rad/s, offset = 0.1 m.",
    "assumption: any set within (5), the paper prints none for Fig. 3",
)


def test_commands_code_and_parameters_of_claims_are_on_the_page(page):
    assert [words for words in SAID if words not in page] == []


def test_the_report_does_not_reveal_its_machine(page, reported):
    for name in ("results.json", "junit.xml"):
        page += (reported[1] / name).read_text(encoding="utf-8")
    assert str(ROOT) not in page
    assert str(reported[1]) not in page


def test_junit_shares_the_time_of_an_engine_among_its_claims(tmp_path):
    result = run((UNDRAWN,), (Engine("good", straight),), folder=tmp_path / "data")
    result.seconds["verdicts", "good"] = 8.0
    write_report(result, tmp_path)
    root = ET.parse(tmp_path / "junit.xml").getroot()
    times = [float(case.get("time")) for case in root.iter("testcase") if "good" in case.get("classname")]
    assert times == [2.0] * 4
    assert float(root.get("time")) >= 8.0


@pytest.fixture(scope="module")
def partly_reported(tmp_path_factory, all_in_this_process):
    folder = tmp_path_factory.mktemp("partly")
    engines = (
        Engine("all", straight, EVERY_KIND),
        Engine("some", straight, ("pin", "points")),
        Engine("pins", straight),
    )
    result = run((PARTLY, RING_ONLY), engines, folder=folder / "data")
    return result, write_report(result, folder), folder


def test_not_simulated_is_a_separate_state(partly_reported):
    result, matrix, folder = partly_reported
    states = {
        row.sentence: {column: cell.state for column, cell in row.cells.items()}
        for row in matrix.of(matrix.studies[0]).rows
    }
    yes, no = State.AGREES, State.NOT_SIMULATED
    assert states == {
        PIN: {"all": yes, "some": yes, "pins": yes},
        POINTS: {"all": yes, "some": yes, "pins": no},
        RING: {"all": yes, "some": no, "pins": no},
    }
    assert matrix.totals == {yes: 7, no: 5}
    totals = "7 checks against independent evidence agree, 0 differ, 0 inconclusive, 5 not simulated"
    assert summary(matrix) == totals
    assert set(result.data(RING_ONLY)) == {"all"}  # other studies have no figures
    results = read_results(folder)
    assert results["totals"]["not simulated"] == 5
    units = results["studies"][1]["units"]
    assert [unit["state"] for unit in units.values()] == ["finished", "not simulated", "not simulated"]
    assert units["some"]["reason"] == "some does not simulate a disc on a continuous ring"
    root = ET.parse(folder / "junit.xml").getroot()
    assert (root.get("tests"), root.get("skipped"), root.get("errors")) == ("12", "5", "0")


def test_the_page_gives_the_reason_once_per_study_and_counts_it_separately(partly_reported):
    page = (partly_reported[2] / "index.html").read_text(encoding="utf-8")
    reason = "some does not simulate a disc on a continuous ring"
    (legend,) = re.findall(r'<dl class="legend">(.*?)</dl>', page, flags=re.DOTALL)
    assert legend.count(reason) == 1
    assert page.count(f": {reason}.") == 2  # one per study
    assert (
        page.count("2 claims: pins does not simulate a disc on single points or a disc on a continuous ring")
        == 1
    )
    overview = [" ".join(c[3].split()) for c in Cells(page).cells if c[0] == "overview" and c[2] == "some"]
    assert overview == [
        "2 of 2 agree",  # independent evidence
        "2 of 2 agree, 2 not simulated",
        "2 exact",  # grades
        "2 of 2 agree, 1 not simulated",
        "1 not simulated",
    ]
    said = [next(text for text in texts if text.startswith("some ")) for texts in claims_of(page).values()]
    assert said == ["some ✔ agrees exact"] * 2 + ["some ∅ not simulated"] * 2
    assert '<ul class="exceptions">' not in page


def test_a_reason_with_a_part_that_is_listed_already_adds_only_the_rest(partly_reported, tmp_path):
    key, (result, *_) = (RING_ONLY.name, "some"), partly_reported
    reason = result.outcomes[key].not_simulated
    more = replace(result.outcomes[key], not_simulated=f"{reason}; some is slow")
    write_report(replace(result, outcomes=result.outcomes | {key: more}), tmp_path)
    page = (tmp_path / "index.html").read_text(encoding="utf-8")
    (legend,) = re.findall(r'<dl class="legend">(.*?)</dl>', page, flags=re.DOTALL)
    assert (legend.count(reason), legend.count("some is slow")) == (1, 1)


@pytest.mark.parametrize(("study", "shown"), [(PARTLY, True), (UNDRAWN, False)])
def test_a_finding_is_on_the_first_screen_while_all_claims_of_its_study_agree(tmp_path, study, shown):
    study = replace(study, prose=replace(study.prose, finding="Straight on."))
    engines = (Engine("one", straight, EVERY_KIND), Engine("pins", straight))
    write_report(run((study,), engines, folder=tmp_path / "data"), tmp_path)
    assert ("<li>Straight on." in (tmp_path / "index.html").read_text(encoding="utf-8")) == shown


GIVEN = {
    "basins": ["0.3 m", "0.5 m", "0.4 m"],
    "fig11": ["0.1 m"],
    "drivetrain-frozen": ["10 %", "1.4 N", "0.2 N"],
}
"""Numbers of parameters in findings, which no claim measures."""


def test_numbers_of_a_finding_are_quoted_from_claims():
    found = [study for study in STUDIES if study.prose.finding]
    assert {study.name for study in found} >= {"fig11", "stability-map"}
    for study in found:
        words = "".join(literal for literal, _ in parts(study.prose.finding))
        assert re.findall(r"[\d.]*\d (?:%|N|mm|m|s|1/s)(?!\w)", words) == GIVEN.get(study.name, [])
        assert any(quoted for _, quoted in parts(study.prose.finding))


def test_captions_and_paragraphs_use_braces_only_for_quotes():
    for study in STUDIES:
        for text in (study.prose.finding, study.prose.paper, *study.figures.values()):
            assert all(quoted != "" for _, quoted in parts(text))


def test_studies_of_a_section_are_adjacent():
    sections = [study.prose.section for study in STUDIES]
    assert all(sections)
    assert [name for name, _ in groupby(sections)] == list(dict.fromkeys(sections))


def test_a_gap_is_shown_even_if_no_engine_fills_it(tmp_path):
    matrix = write_report(run((RING_ONLY,), (Engine("pins", straight),), folder=tmp_path / "data"), tmp_path)
    (row,) = matrix.rows
    assert row.cells["pins"].state is State.NOT_SIMULATED


ADAPTER = "compare/engines/live/bullet_engine.py"


def settings():
    """Return recorded results of two engines for two claims: one agrees with both, the other with neither."""
    found = []
    for name, off in {("Kite", "cone"): 0.0, ("Kite", "box"): 0.25, ("ours", ""): 1e-6}.items():
        errors = {"A pin slides": (off, 1e-3), "A disc slides": (1e-4 + off, 1e-3)}
        adapter = ADAPTER if name[0] == "Kite" else ""
        made = replace(recorded(*name, errors, resolution=0.1), adapter=adapter)
        if off == 0.25:
            why = dict.fromkeys(errors, "friction is a box")
            made = replace(made, reasons=why, costs=dict.fromkeys(errors, "100 steps, 1 s"))
        found.append(made)
    return found


@pytest.fixture(scope="module")
def recorded_reported(tmp_path_factory, all_in_this_process):
    folder = tmp_path_factory.mktemp("recorded")
    study = replace(AGREEMENT, provided=AGREEMENT.provided | {"recorded": settings})
    arguments = ["report", "--engine", "reference", "--jobs", "1", "--output", str(folder)]
    return status(arguments, (study,)), folder


def test_errors_of_recorded_engines_do_not_fail_the_report(recorded_reported):
    exit_status, folder = recorded_reported
    assert exit_status == 0
    results = read_results(folder)
    assert (results["totals"]["agrees"], results["totals"]["differs"]) == (1, 0)
    root = ET.parse(folder / "junit.xml").getroot()
    assert (root.get("tests"), root.get("failures")) == ("1", "0")
    verdicts = [claim["verdict"] for found in results["recorded"] for claim in found["claims"]]
    assert verdicts == 2 * ["agrees"] + 2 * ["differs"] + 2 * ["agrees"]


def test_recorded_engines_have_a_matrix_with_a_row_for_each_setting(recorded_reported):
    page = (recorded_reported[1] / "index.html").read_text(encoding="utf-8")
    found = Cells(page)
    source = (recorded_reported[1] / "adapters" / "bullet_engine.py.txt").read_bytes()
    assert source == (ROOT / ADAPTER).read_bytes()
    assert found.links.count("adapters/bullet_engine.py.txt") == 1
    assert found.links.count("?engine=Kite#agreement-recorded/kite") == 1
    assert "agreement-recorded/kite" in found.ids
    said = [" ".join(cell[3].split()) for cell in found.cells if cell[0] == "matrix recorded"]
    assert said == [
        *("Engine, setting", "A pin slides", "A disc slides"),
        f"Kite 1.2, 2026-01-31, adapter {ADAPTER}",
        *("cone", "✓ agrees ± 0.0010 m", "✓ agrees ± 0.0010 m"),
        *("box", *["✗ differs by 0.25 m 100 steps, 1 s friction is a box"] * 2),
        "ours 1.2, 2026-01-31",
        *("all motions", "✓ agrees ± 0.0010 m", "✓ agrees ± 0.0010 m"),
    ]
    assert 'title="friction is a box; 100 steps, 1 s"' not in page  # the best setting has no reason
    assert {link[1:] for link in found.links if link.startswith("#")} <= set(found.ids)
    assert "1 check against independent evidence agrees, 0 differ, 0 inconclusive." in page
    assert "4 agree, 2 differ, 0 inconclusive." in page


def evidence():
    return Evidence("frequency in rad/s", 1.25, 1.5, 1.25 + 1e-12)


def no_evidence():
    raise RuntimeError("no root was found")


def test_errata_show_both_forms_and_the_numbers(tmp_path):
    errata = (
        Erratum("(13)", "1 + β/m", "β·(1 + <m>)", "Because.", evidence),
        Erratum("(26)", "cos²α", "sin²α", "Because.", no_evidence),
    )
    write_report(run((), (), folder=tmp_path / "data", errata=errata), tmp_path)
    page = (tmp_path / "index.html").read_text(encoding="utf-8")
    assert "β·(1 + &lt;m&gt;)" in page
    assert TEXT in page
    numbers = [cell[4] for cell in Cells(page).cells if cell[0] == "evidence" and cell[4]]
    assert numbers == [[1.25], [1.5], [1.25 + 1e-12], [0.25], [1.25 + 1e-12 - 1.25]]
    assert "The evidence could not be computed: no root was found" in page
    written = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))["errata"]
    assert written[0]["evidence"]["printed_value"] == 1.5
    assert written[1]["evidence"] == {"failed": "no root was found"}
