"""Fig. 4 redrawn, and the errors of both formulas over the offset."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from compare.claims.study import ByEngine, Figures
from compare.output.figures import BLACK, GREY, axis, curve, engines_in, new_figure, points
from compare.studies.pin.fig04.study import CLAIM_SPEEDS, OFFSETS, pin_at
from reference_model.formulas.pin import first_order_whirl_shift, whirl_shift
from reference_model.systems import PinOnDisc

if TYPE_CHECKING:
    from matplotlib.axes import Axes

DOTTED = (0.0, (1.0, 1.5))
FORMULAS: tuple[tuple[Callable[[PinOnDisc], tuple[float, float]], Any], ...] = (
    (whirl_shift, "-"),
    (first_order_whirl_shift, DOTTED),
)
MARKERS = dict(zip(CLAIM_SPEEDS, "os^", strict=True))


def draw(data: ByEngine) -> Figures:
    """Draw the mean of the whirl over the speed, and its distance from both formulas over the offset."""
    figure, (left, right) = new_figure(ncols=2)
    _draw_shift(left, data)
    _draw_gaps(right, data)
    return {"fig04-shift": figure}


def _draw_shift(panel: Axes, data: ByEngine) -> None:
    if "theory" in data:
        theory = data["theory"]
        for i, symbol in enumerate(("x_s", "y_s")):
            style = curve("theory", f"${symbol}$, eq. (18)", linestyle="-" if i == 0 else (0.0, (5.0, 2.0)))
            panel.plot(theory["speeds"], theory["eq18"][:, i], **style)
        exact = curve("theory", "exact first order", color=GREY, linestyle=DOTTED, linewidth=1.4)
        panel.plot(theory["speeds"], theory["first order"], **exact)
    for engine in engines_in(data):
        panel.plot(data[engine]["speeds"], data[engine]["means"], **points(engine))
    handles, labels = panel.get_legend_handles_labels()
    unique = dict(zip(labels, handles, strict=True))
    panel.legend(unique.values(), unique.keys())
    panel.set(xlabel=axis(r"\omega", "rad/s"), ylabel=axis("x_s,\\ y_s", "m"), ylim=(0.0, None))


def _draw_gaps(panel: Axes, data: ByEngine) -> None:
    for engine in engines_in(data):
        for speed, marker in MARKERS.items():
            if f"means at {speed:g}" not in data[engine]:
                continue
            means = data[engine][f"means at {speed:g}"]
            for formula, line in FORMULAS:
                gap = [
                    np.hypot(*(mean - formula(pin_at(speed, offset))))
                    for mean, offset in zip(means, OFFSETS, strict=True)
                ]
                size = 7.0 if engine == "reference" else 3.5
                style = points(engine, "", marker=marker, markersize=size, linestyle=line, linewidth=0.8)
                panel.loglog(OFFSETS, gap, **style)
    for speed, marker in MARKERS.items():
        label = f"$\\omega$ = {speed:g} rad/s"
        panel.plot([], [], ls="none", marker=marker, mfc="none", color=BLACK, label=label)
    labels = (r"from (18), $\propto X_0$", r"from the exact first order, $\propto X_0^3$")
    for (_, line), label in zip(FORMULAS, labels, strict=True):
        panel.plot([], [], color=BLACK, lw=0.8, ls=line, label=label)
    panel.set_xticks(OFFSETS, [f"{offset:g}" for offset in OFFSETS])
    panel.minorticks_off()
    panel.legend(loc="upper center", bbox_to_anchor=(0.5, -0.18), ncols=2)
    panel.set(xlabel=axis("X_0", "m"), ylabel="distance of the mean in m")
