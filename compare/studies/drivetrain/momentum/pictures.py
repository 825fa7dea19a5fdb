"""What the three bodies of the isolated drivetrain exchange, and how far their sum drifts."""

from __future__ import annotations

import numpy as np

from compare.claims.study import ByEngine, Figures
from compare.output.figures import BLACK, BLUE, GREEN, ORANGE, axis, new_figure


def draw(data: ByEngine) -> Figures:
    """Draw the angular momenta of the bodies of one drivetrain, and the drift of the sum in all of them."""
    found = next((values for values in data.values() if "each" in values), None)
    if found is None:
        return {}
    figure, (exchange, drift) = new_figure(ncols=2, width=10.0, height=4.0)
    each = found["each"]
    momenta = (*each.T, each.sum(axis=1))
    names, colours = ("engine", "disc", "vehicle", "sum"), (BLUE, GREEN, ORANGE, BLACK)
    for name, colour, momentum in zip(names, colours, momenta, strict=True):
        exchange.plot(found["t"], momentum - momentum[0], color=colour, label=name)
    exchange.set(xlabel=axis("t", "s"), ylabel="change of angular momentum in kg m²/s")
    exchange.legend(loc="upper left")
    for name, colour, above in (("explicit", BLUE, -13), ("implicit", ORANGE, 4)):
        times, drifts, resolution = (found[f"{name}: {key}"] for key in ("t", "drift", "resolution"))
        drift.semilogy(times[1:], np.maximum(drifts[:, 1:].T, 1e-17), color=colour, linewidth=0.8)
        drift.axhline(float(resolution), color=colour, linestyle="--", linewidth=1.0)
        drift.annotate(
            f"{name} solver",
            (0.0, float(resolution)),
            xytext=(0, above),
            textcoords="offset points",
            color=colour,
        )
    drift.set(xlabel=axis("t", "s"), ylabel="drift over the largest momentum of one body", ylim=(1e-17, 1e-6))
    return {"drivetrain-momentum": figure}
