"""The drivetrain reduced to a disc, beside the reference's."""

from __future__ import annotations

import numpy as np

from compare.claims.study import ByEngine, Figures
from compare.output.figures import BLACK, PALETTE, axis, new_figure, points
from compare.studies.drivetrain.reduced.parameters import CASES, UNTIL


def draw(data: ByEngine) -> Figures:
    """Draw the radial motion of all cases in both engines, and the influence of the inertias."""
    found = data.get("exudyn", {})
    drawn = [name for name in CASES if f"{name}: t" in found]
    if not drawn or "inertia" not in found:
        return {}
    figure, (radii, order) = new_figure(ncols=2, width=10.0, height=4.6, width_ratios=(1.5, 1.0))
    for name, colour in zip(drawn, PALETTE, strict=False):
        times = found[f"{name}: t"]
        reference, mine = (np.hypot(*found[f"{name}: {key}"][:, :2].T) for key in ("reference", "states"))
        radii.semilogy(times, reference, color=colour, linewidth=1.2, label=name)
        radii.semilogy(times[::4], mine[::4], **points("exudyn", "_", color=colour, markersize=4.0))
    radii.set(xlabel=axis("t", "s"), ylabel="radius of the disc's centre in m", ylim=(1e-3, 0.2))
    radii.legend(loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=2, fontsize=9.5)
    inertias, changes = found["inertia"], found["finite inertia"]
    order.loglog(inertias, changes, **points("exudyn", "drivetrain"))
    order.loglog(inertias, changes[0] * inertias[0] / inertias, color=BLACK, linewidth=0.8, label="slope −1")
    order.set(xlabel="inertia in kg m²", ylabel=f"change of the state at {UNTIL:g} s", ylim=(1e-4, 1e-2))
    order.set_xticks(inertias, [f"{inertia:g}" for inertia in inertias])
    order.minorticks_off()
    order.legend(loc="upper right")
    return {"drivetrain-reduced": figure}
