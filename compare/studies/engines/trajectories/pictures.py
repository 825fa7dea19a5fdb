"""How far engines are from the reference over time."""

from __future__ import annotations

import numpy as np

from compare.claims.error_estimates import TRUTH
from compare.claims.study import ByEngine, Figures
from compare.output.figures import axis, curve, engines_in, new_figure
from compare.studies.engines.trajectories.parameters import MOTIONS


def draw(data: ByEngine) -> Figures:
    """Draw how far each motion is from the reference's over time."""
    figure, (axes,) = new_figure(width=7.0, height=4.0)
    for engine in engines_in(data):
        label = engine
        for name in MOTIONS:
            if f"{name}: times" in data[engine]:
                error = np.maximum(data[engine][f"{name}: error"], TRUTH)
                axes.semilogy(data[engine][f"{name}: times"], error, **curve(engine, label))
                label = "_"
    axes.set(xlabel=axis("t", "s"), ylabel="largest difference of a component of the state")
    if data:
        axes.legend()
    return {"trajectories": figure}
