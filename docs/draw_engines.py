"""Draw the matrix of engines, the figure in README, from the recordings: ``python docs/draw_engines.py``.

The metadata of ``engines.png`` contains its data, so a test can detect an outdated figure.
"""

import json
import textwrap
from pathlib import Path

from matplotlib.figure import Figure

from compare.diagnosis.laws import CONE
from compare.diagnosis.run import row_of
from compare.foreign import recordings
from compare.output.figures import paper_style

PICTURE = Path(__file__).with_name("engines.png")
COLUMNS = {
    "slip": "pin slides",
    "stick-slip": "pin sticks and slips",
    "whirl": "pin whirls",
    "stuck": "pin sticks permanently",
    "release": "pin releases",
    "disc": "disc on six points",
}
"""Column titles of the motions of ``compare.foreign``."""

LAW = "friction law"
COLOURS = {"✓": "#bfe3cf", "?": "#fff3bf", "✗": "#e0796b", "": "white"}
"""From light to dark, so that they also differ in grey."""


def cells():
    """Return the mark and the text of each column, by engine and setting."""
    table = {}
    for recording in recordings():  # ours first
        row = row_of(recording)
        found = table[row.engine] = {}
        for name, motion in row.motions.items():
            mark = "✗" if not motion.converges else "✓" if motion.conclusive else "?"
            found[name] = [mark, f"{motion.error:.0e}"]
        if row.law is not None and row.law.sure:
            found[LAW] = ["✓" if row.law.shape == CONE else "✗", row.law.shape.partition(":")[0].split()[0]]
    return table


def drawn_from():
    """Return the contents of the figure as one line of JSON."""
    return json.dumps(cells(), ensure_ascii=False)


def draw():
    """Return the figure."""
    table = cells()
    names = [*COLUMNS, LAW]
    figure = Figure(figsize=(9.0, 0.235 * len(table) + 1.0), layout="constrained")
    panel = figure.subplots()
    for line, (engine, found) in enumerate(table.items()):
        for column, name in enumerate(names):
            mark, text = found.get(name, ["", ""])
            panel.fill_between([column, column + 1], line, line + 1, color=COLOURS[mark], edgecolor="white")
            panel.text(column + 0.12, line + 0.5, mark, va="center", fontfamily="DejaVu Sans", fontsize=9)
            panel.text(column + 0.94, line + 0.5, text, va="center", ha="right", fontsize=9.5)
        panel.text(-0.06, line + 0.5, engine, va="center", ha="right", fontsize=10)
    for column, name in enumerate(names):
        label = textwrap.fill(COLUMNS.get(name, name), 12)
        panel.text(column + 0.5, -0.2, label, va="bottom", ha="center", fontsize=10)
    panel.set(xlim=(-1.75, len(names)), ylim=(len(table), -1.3))
    panel.axis("off")
    return figure


if __name__ == "__main__":
    with paper_style():
        draw().savefig(PICTURE, dpi=110, metadata={"Description": drawn_from(), "Software": None})
