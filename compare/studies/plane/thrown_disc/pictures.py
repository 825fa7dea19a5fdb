"""Figure of the thrown discs: speeds of centre and rim over time."""

from __future__ import annotations

import numpy as np

from compare.claims.study import ByEngine, Figures
from compare.output.figures import axis, curve, engines_in, new_figure, points
from compare.studies.plane.thrown_disc.study import FULL, RING, TO_REST, WHILE_SLIDING

TAKEN = {
    "ring": (r"slides: $\mu N$", r"spins: $\mu NR$", r"both: $\frac{2}{\pi}$ of each"),
    "full disc": (
        r"slides: $\mu N$",
        r"spins: $\frac{2}{3}\,\mu NR$",
        r"both: $\frac{8}{3\pi}\,\mu N$, $\frac{8}{9\pi}\,\mu NR$",
    ),
}
"""What friction takes of the throws, in their order."""

DASHES = ("-", "--", (0.0, (1.0, 1.5)))


def draw(data: ByEngine) -> Figures:
    """Draw the speeds that are left, on a ring and on a full disc."""
    if not data:
        return {}
    figure, panels = new_figure(ncols=2, width=9.6, height=3.8, sharey=True)
    for panel, name, throws, shares in zip(
        panels, ("ring", "full disc"), (RING, FULL), (TO_REST, WHILE_SLIDING), strict=True
    ):
        for throw, taken, dashes in zip(throws, TAKEN[name], DASHES, strict=True):
            speeds = (max(throw.sliding, abs(throw.rim)), 0.0, 0.0)
            look = curve("theory", taken, linestyle=dashes, linewidth=1.2)
            panel.plot((0.0, throw.time, 1.3 * throw.time), speeds, **look)
        for engine in engines_in(data):
            if f"{name}: speeds" not in data[engine]:
                continue
            label = engine
            for throw, speeds in zip(throws, data[engine][f"{name}: speeds"], strict=True):
                panel.plot(throw.time * shares[1:], np.max(np.abs(speeds), axis=1), **points(engine, label))
                label = ""
        panel.set(xlabel=axis("t", "s"), title=f"Contact on a {name}")
        panel.legend(loc="upper right")
    panels[0].set_ylabel("speed in m/s")
    return {"thrown-disc": figure}
