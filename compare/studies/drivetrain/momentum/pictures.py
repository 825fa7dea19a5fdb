"""What the three bodies of the isolated drivetrain exchange, and how far their sum drifts."""

from __future__ import annotations

import numpy as np

from compare.claims.study import ByEngine, Figures
from compare.output.figures import BLACK, BLUE, GREEN, ORANGE, axis, new_figure
from compare.studies.drivetrain.momentum.parameters import BODIES, SOLVERS


def draw(data: ByEngine) -> Figures:
    """Draw what the three bodies exchange, and how far their sum drifts."""
    found = next((values for values in data.values() if "each" in values), None)
    if found is None:
        return {}
    figure, (exchange, drift) = new_figure(ncols=2, width=10.0, height=4.0)
    each = found["each"]
    looks = zip((*BODIES, "sum"), (BLUE, GREEN, ORANGE, BLACK), (*each.T, each.sum(axis=1)), strict=True)
    for name, colour, momentum in looks:
        exchange.plot(found["t"], momentum - momentum[0], color=colour, label=name)
    exchange.set(xlabel=axis("t", "s"), ylabel="change of angular momentum in kg m²/s")
    exchange.legend(loc="upper left")
    for name, colour, above in zip(SOLVERS, (BLUE, ORANGE), (-13, 4), strict=True):
        times, drifts = found[f"{name}: t"], found[f"{name}: drift"]
        solver = SOLVERS[name]
        drift.semilogy(times[1:], np.maximum(drifts[:, 1:].T, 1e-17), color=colour, linewidth=0.8)
        drift.axhline(solver.resolution, color=colour, linestyle="--", linewidth=1.0)
        drift.annotate(
            f"{name}: {solver.name}, {solver.steps} steps",
            (0.0, solver.resolution),
            xytext=(0, above),
            textcoords="offset points",
            color=colour,
        )
    drift.set(xlabel=axis("t", "s"), ylabel="drift over the largest part", ylim=(1e-17, 1e-6))
    return {"drivetrain-momentum": figure}
