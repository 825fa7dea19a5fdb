"""The picture of the matrix: how far each engine is off each exact motion, over its step."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from compare.diagnosis.findings import MOTIONS
from compare.diagnosis.ladder import HALVED, RUNGS
from compare.diagnosis.row import Row
from compare.engines import COARSENING
from compare.figures import new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MARKERS = "os^Dvx+*"


def drawn(rows: Sequence[Row]) -> Figure:
    """Return a panel for each motion that any engine was asked for, with a line for each engine."""
    names = [name for name in MOTIONS if any(name in row.motions for row in rows)]
    figure, panels = new_figure(ncols=min(4, len(names)), nrows=-(-len(names) // 4), width=11.0, height=6.0)
    for panel, name in zip(panels, names, strict=False):
        for row, marker in zip(rows, MARKERS * len(rows), strict=False):
            if name in row.motions:
                errors = np.array(row.motions[name].errors)
                panel.loglog(
                    steps_of(row)[-len(errors) :], np.maximum(errors, 1e-16), marker=marker, label=row.engine
                )
        panel.axhline(MOTIONS[name].resolution, color="0.6", linewidth=0.8, linestyle=":")
        panel.set(title=MOTIONS[name].title, xlabel="step over the finest", ylabel="largest error in m")
    for panel in panels[len(names) :]:
        panel.set_visible(False)
    lines = {str(line.get_label()): line for panel in panels for line in panel.get_lines()}
    named = [line for label, line in lines.items() if not label.startswith("_")]
    figure.legend(handles=named, loc="outside lower center", ncols=4)
    return figure


def steps_of(row: Row) -> np.ndarray:
    """Return the steps of the rungs, or the tolerances of an engine that has no step, over the finest."""
    factor = COARSENING if np.isnan(row.step) else HALVED
    return np.asarray(factor ** np.arange(RUNGS - 1, -1, -1.0))
