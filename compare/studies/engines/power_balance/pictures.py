"""Where the energy goes, and what the balance leaves over."""

from __future__ import annotations

from typing import Any

import numpy as np

from compare.claims.study import ByEngine, Figures
from compare.output.figures import BLACK, GREEN, GREY, ORANGE, axis, curve, engines_in, new_figure
from compare.studies.engines.power_balance.study import RESOLUTION


def draw(data: ByEngine) -> Figures:
    """Draw where the energy goes on the way to the whirl, and what is left over."""
    figure, (energies, residuals) = new_figure(ncols=2)
    looks: dict[str, dict[str, Any]] = {
        "drive work": {"color": BLACK, "linestyle": "-"},
        "friction heat": {"color": ORANGE, "linestyle": (0.0, (5.0, 1.5))},
        "damper heat": {"color": GREEN, "linestyle": (0.0, (1.0, 1.0))},
        "stored energy": {"color": GREY, "linestyle": "-"},
    }
    for rank, engine in enumerate(engines_in(data)):
        found = data[engine]
        sparse = slice(None, None, 5)
        if rank == 0:
            for name, look in looks.items():
                energies.plot(found["times"][sparse], found[name][sparse], label=name, linewidth=1.3, **look)
        size = np.maximum(np.abs(found["residual"]), 1e-16)
        residuals.semilogy(found["times"][sparse], size[sparse], **curve(engine, linewidth=1.0))
    residuals.axhline(RESOLUTION, color=BLACK, linewidth=0.8, linestyle=(0.0, (4.0, 3.0)), label="resolution")
    energies.set(xlabel=axis("t", "s"), ylabel="energy in J")
    residuals.set(xlabel=axis("t", "s"), ylabel="residual / energy turned over", ylim=(1e-14, 1e-7))
    energies.legend()
    residuals.legend(loc="lower right")
    return {"power-balance": figure}
