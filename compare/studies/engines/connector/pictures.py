"""What two free discs exchange, and how far their momenta drift."""

from __future__ import annotations

import numpy as np

from compare.claims.study import ByEngine, Figures
from compare.output.figures import GREY, axis, curve, engines_in, new_figure
from compare.studies.engines.connector.parameters import RESOLUTION

LEAST = 1e-17


def draw(data: ByEngine) -> Figures:
    """Draw the angular momenta of both discs, and the drift of their momenta."""
    found = {engine: data[engine] for engine in engines_in(data) if "six points: t" in data[engine]}
    if not found:
        return {}
    figure, (exchange, drift) = new_figure(ncols=2, width=10.0, height=4.0)
    for engine, values in found.items():
        for contact in ("ring", "six points"):
            if f"{contact}: t" not in values:
                continue
            times, each = values[f"{contact}: t"], values[f"{contact}: angular momenta"]
            if contact == "six points":
                exchange.plot(times, each.sum(axis=1), **curve(engine))
                exchange.plot(times, each, **curve(engine, "_"))  # without a place in the legend
                parts = dict(zip(("master disc", "disc", "sum"), (*each[1], each[1].sum()), strict=True))
            look = {"linestyle": "-" if contact == "ring" else ":"}
            drift.semilogy(
                times[1:],
                np.maximum(values[f"{contact}: drift"][1:], LEAST),
                **curve(engine, f"{engine}, {contact}", **look),
            )
    for name, value in parts.items():
        exchange.annotate(
            name, (0.0, value), xytext=(2, 3 if name != "sum" else -12), textcoords="offset points"
        )
    exchange.set(xlabel=axis("t", "s"), ylabel="angular momentum in kg m²/s")
    exchange.legend()
    drift.axhline(RESOLUTION, color=GREY, linewidth=0.9, linestyle="--", label="resolution of the claim")
    drift.set(xlabel=axis("t", "s"), ylabel="drift over the largest part", ylim=(LEAST, 30.0 * RESOLUTION))
    drift.legend(loc="upper left")
    return {"connector-momenta": figure}
