"""The picture of the matrix: how far each engine is off each exact motion, rung by rung.

From rung to rung a fixed step is halved; a tolerance falls to an eighth. The dotted line is a tenth of what another
law would change.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from compare.diagnosis.findings import MOTIONS
from compare.diagnosis.ladder import RUNGS
from compare.diagnosis.row import Row
from compare.output.figures import new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MARKERS = "os^Dvx+*"

LEAST = 1e-16
"""In m: what is shown of less."""


def drawn(rows: Sequence[Row]) -> Figure:
    """Return a panel for each motion that any engine was asked for, with a line for each engine."""
    names = [name for name in MOTIONS if any(name in row.motions for row in rows)]
    columns = min(4, len(names))
    figure, panels = new_figure(ncols=columns, nrows=-(-len(names) // columns), width=11.0, height=6.5)
    for panel, name in zip(panels, names, strict=False):
        for row, marker in zip(rows, itertools.cycle(MARKERS), strict=False):
            if name in row.motions:
                errors = np.array(row.motions[name].errors)
                rungs = np.arange(RUNGS - len(errors), RUNGS) + 1
                panel.semilogy(rungs, np.maximum(errors, LEAST), marker=marker, label=row.engine)
        panel.axhline(MOTIONS[name].resolution, color="0.6", linewidth=0.8, linestyle=":")
        panel.set(title=name, xticks=range(1, RUNGS + 1), xlabel="rung, to finer steps", ylabel="error in m")
    for panel in panels[len(names) :]:
        panel.set_visible(False)
    lines = {str(line.get_label()): line for panel in panels for line in panel.get_lines()}
    named = [line for label, line in lines.items() if not label.startswith("_")]
    figure.legend(handles=named, loc="outside lower center", ncols=4)
    return figure
