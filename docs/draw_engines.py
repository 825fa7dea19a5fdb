"""Show the recorded engines: ``python docs/draw_engines.py`` draws ``engines.png`` and writes the table in README.

The picture contains all settings that move a pin, the table one row for each engine. The metadata of the picture
contains its data, so a test can detect an outdated one.
"""

import json
import math
import re
import textwrap
from pathlib import Path

from matplotlib import rc_context
from matplotlib.figure import Figure

from compare.claims import Recorded
from compare.diagnosis.row import Row
from compare.diagnosis.run import row_of
from compare.foreign import CASES
from compare.output.figures import paper_style
from compare.report.at_a_glance import best_of
from compare.report.matrix import state_of
from compare.studies.engines.foreign_engines.theory import recorded as pins
from compare.studies.engines.foreign_engines.theory import recorded_claims

PICTURE, README = Path(__file__).with_name("engines.png"), Path(__file__).parents[1] / "README.md"
PLACE = re.compile(r"(?s)(?<=<!-- engines -->\n\n).*?(?=\n\n<!-- end -->)")
COLOURS = {"✓": "#bfe3cf", "?": "#fff3bf", "✗": "#e0796b", "": "white"}
"""From light to dark, so that they also differ in grey."""

ENGINES = tuple((row_of(one), recorded_claims(one)) for one in pins())  # ours first


def law_of(row: Row) -> str:
    """Return the measured friction law in a word or two."""
    law = row.law
    if law is None:
        return "not measured"
    if not math.isnan(law.per_step):
        return "impulse per step"
    if not law.sure:
        return "unclear: creeps" if row.creep is not None and row.creep.speed > 0.0 else "unclear"
    return law.shape.split()[0]


def spin_of(row: Row) -> str:
    """Return the law of a disc that slides and spins."""
    return re.sub(r"a disc that slides and spins (has |is )?|[;:,].*", "", row.spin[0])


def cells() -> dict[str, dict[str, list[str]]]:
    """Return mark, error, order and cost of each motion by engine and setting, and the friction law."""
    table: dict[str, dict[str, list[str]]] = {}
    for row, recorded in ENGINES:
        found = table[row.engine] = {"law": ["", law_of(row), "", ""], "spin": ["", "", "", spin_of(row)]}
        for name, motion in row.motions.items():
            order = f"order {round(motion.order, 1) + 0.0:.1f}" if math.isfinite(motion.order) else ""
            found[name] = [motion.mark, f"{motion.error:.0e}", order, recorded.costs[CASES[name].sentence]]
    return table


def drawn_from() -> str:
    """Return the contents of the figure as one line of JSON."""
    return json.dumps(cells(), ensure_ascii=False)


def draw() -> Figure:
    """Return the figure of all settings."""
    table = cells()
    names = [*CASES, "law", "spin"]
    figure = Figure(figsize=(13.0, 0.36 * len(table) + 0.8), layout="constrained")
    panel = figure.subplots()
    for line, (engine, found) in enumerate(table.items()):
        for column, name in enumerate(names):
            mark, error, order, cost = found.get(name, ["", "not simulated", "", ""])
            panel.fill_between([column, column + 1], line, line + 1, color=COLOURS[mark], edgecolor="white")
            panel.text(column + 0.06, line + 0.33, mark, va="center", fontfamily="DejaVu Sans", fontsize=9)
            panel.text(column + 0.2 * bool(mark) + 0.06, line + 0.36, error, va="center", fontsize=10)
            panel.text(column + 0.96, line + 0.36, order, va="center", ha="right", fontsize=8, color="0.25")
            below = 0.5 if name == "spin" else 0.77
            said = textwrap.fill(_short(cost), 36)
            panel.text(column + 0.06, line + below, said, va="center", fontsize=8, color="0.25")
        panel.text(-0.06, line + 0.5, engine, va="center", ha="right", fontsize=10)
    for column, case in enumerate(CASES.values()):
        panel.text(column + 0.5, -0.75, case.name, va="bottom", ha="center", fontsize=10.5)
        panel.text(column + 0.5, -0.2, case.truth, va="bottom", ha="center", fontsize=9, color="0.25")
    panel.text(len(CASES) + 0.06, -0.75, "friction law", va="bottom", fontsize=10.5)
    panel.text(len(CASES) + 1.06, -0.75, "slide with spin", va="bottom", fontsize=10.5)
    panel.set(xlim=(-1.6, len(names) + 0.5), ylim=(len(table), -1.6))
    panel.axis("off")
    return figure


def _short(cost: str) -> str:
    return cost.replace(" steps per natural period", "/T").replace("a tolerance of", "tol.")


def _said(recorded: Recorded) -> str:
    """Return the mark of a setting, with the number of motions that do not agree."""
    marks = [state_of(claim).symbol for claim in recorded.claims]
    bad = [f"{mark} {marks.count(mark)}" for mark in "✗?" if mark in marks]
    return f"{', '.join(bad)} of {len(marks)}" if bad else "✓"


SHORTER = {
    r"every body loses (.*) of its speed per second": r"loses \1 of speed per s",
    r"a disc that .* the impulse that would stop each of . points": "on a disc, it stops each point",
    r"a block that should rest (creeps .*)": r"\1",
    r"its error bar of (.*) exceeds .*": r"error bar of \1",
}
"""Reasons in README, by the reasons of the findings page."""


def _why(recorded: Recorded) -> list[str]:
    """Return the main clauses of the reasons of ✗, or of ? if there is no ✗."""
    by_mark: dict[str, list[str]] = {"✗": [], "?": []}
    for claim in recorded.claims:
        why = re.split(r" with | under |[,;] ", recorded.reasons.get(claim.sentence, ""))[0]
        for reason, short in SHORTER.items():
            why = re.sub(reason, short, why)
        by_mark.get(state_of(claim).symbol, []).append(why)
    return list(dict.fromkeys(by_mark["✗"] or by_mark["?"]))


def table() -> str:
    """Return the table of README, one row for each engine, or for engines with equal rows."""
    found: dict[str, dict[Recorded, Row]] = {}
    for row, recorded in ENGINES:
        found.setdefault(recorded.engine, {})[recorded] = row
    lines: dict[str, list[str]] = {}
    for engine, rows in found.items():
        best, shipped = best_of(list(rows)), next(one for one in rows if one.shipped)
        words = (law_of(rows[one]).partition(":")[0].removeprefix("impulse ") for one in (shipped, best))
        laws = " → ".join(dict.fromkeys(words))
        why = next(iter(_why(best) + _why(shipped)), "")
        setting = f"{_said(best)} {best.setting}".strip()
        lines.setdefault(f"{_said(shipped)} | {setting} | {laws} | {why} |", []).append(engine)
    others = sorted(lines, key=lambda line: "✓?✗".index(line.split("| ")[1][0]))
    head = "| engine | as shipped | best setting | law | why not ✓ |\n" + 5 * "|---" + "|"
    return "\n".join([head, *(f"| {'<br>'.join(lines[line])} | {line}" for line in others)])


if __name__ == "__main__":
    with paper_style(), rc_context({"font.family": ["STIXGeneral", "DejaVu Sans"]}):
        draw().savefig(PICTURE, dpi=110, metadata={"Description": drawn_from(), "Software": None})
    README.write_text(PLACE.sub(lambda _: table(), README.read_text("utf-8")), "utf-8")
