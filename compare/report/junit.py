"""``junit.xml``: one test case for each claim and engine, for servers that show test results."""

import xml.etree.ElementTree as ET

from compare.claims.claim import Claim
from compare.report.matrix import Matrix, Row, State, failure_of, state_of
from compare.report.numbers import account, worst
from compare.run.runner import Run
from compare.run.workers import Failure


def junit(run: Run, matrix: Matrix) -> bytes:
    """Return the XML: "differs" is a failure, "failed" an error; claims without a verdict are skipped.

    Recorded engines do not test this project and are left out.
    """
    root = ET.Element("testsuites", name="friction-discs")
    for study in matrix.studies:
        suite = ET.SubElement(root, "testsuite", name=study.name)
        for row in matrix.of(study).rows:
            for column in row.cells:
                _cases(suite, run, study.name, row, column)
        drawing = run.drawings.get(study.name)
        if isinstance(drawing, Failure):
            _error(_case(suite, study.name, "figures", "drawn"), drawing.reason, drawing)
        _share_time(suite, run, study.name)
        _count(suite)
    _count(root)
    ET.indent(root)
    document: bytes = ET.tostring(root, encoding="utf-8", xml_declaration=True)
    return document


def _cases(suite: ET.Element, run: Run, study: str, row: Row, column: str) -> None:
    cell = row.cells[column]
    for claim in cell.claims:
        case = _case(suite, study, column, row.sentence)
        properties = ET.SubElement(case, "properties")
        said = {
            "id": row.identity,
            "kind": claim.kind,
            "evidence": cell.evidence,
            "implied by": cell.implied_by,
        }
        for name, value in (said | _numbers(claim)).items():
            if value:
                ET.SubElement(properties, "property", name=name, value=value)
        if state_of(claim) is State.DIFFERS:
            ET.SubElement(case, "failure", message=account(claim))
        elif state_of(claim) is State.INCONCLUSIVE:
            ET.SubElement(case, "skipped", message=f"inconclusive: {account(claim)}")
    if not cell.claims:
        case = _case(suite, study, column, row.sentence)
        if cell.state is State.FAILED:
            _error(case, cell.reason, failure_of(run, study, column, row.sentence))
        else:
            ET.SubElement(case, "skipped", message=cell.reason)


def _numbers(claim: Claim) -> dict[str, str]:
    element = worst(claim)
    numbers = {
        "predicted": element.predicted,
        "measured": element.measured,
        "difference": element.difference,
        "allowed": element.total,
        "resolution": claim.budget.resolution,
    }
    return {"element": element.name, "unit": element.unit} | {name: repr(it) for name, it in numbers.items()}


def _share_time(suite: ET.Element, run: Run, study: str) -> None:
    cases: dict[str, list[ET.Element]] = {}
    for case in suite.iter("testcase"):
        cases.setdefault(case.get("classname", ""), []).append(case)
    for name, own in cases.items():
        seconds = run.seconds.get((study, name.removeprefix(f"{study}.")), 0.0)
        for case in own:
            case.set("time", f"{seconds / len(own):.3f}")


def _case(suite: ET.Element, study: str, column: str, sentence: str) -> ET.Element:
    return ET.SubElement(suite, "testcase", classname=f"{study}.{column}", name=sentence)


def _error(case: ET.Element, reason: str, failure: object) -> None:
    error = ET.SubElement(case, "error", message=reason)
    if isinstance(failure, Failure):
        error.text = "\n".join(failure.where)


def _count(element: ET.Element) -> None:
    cases = list(element.iter("testcase"))
    element.set("tests", str(len(cases)))
    for attribute, tag in (("failures", "failure"), ("errors", "error"), ("skipped", "skipped")):
        element.set(attribute, str(sum(case.find(tag) is not None for case in cases)))
    element.set("time", f"{sum(float(case.get('time', '0')) for case in cases):.3f}")
