"""The drivetrain reduced to a disc, beside the reference's."""

from __future__ import annotations

import numpy as np

from compare.claims.study import ByEngine, Figures
from compare.output.figures import BLACK, axis, curve, new_figure, points
from compare.studies.drivetrain.reduced.parameters import CASES, UNTIL


def draw(data: ByEngine) -> Figures:
    """Draw the radial motion of three cases in both engines, and the influence of the inertias."""
    found = data.get("exudyn", {})
    drawn = [name for name in list(CASES)[1:] if f"{name}: t" in found]
    if not drawn or "inertia" not in found:
        return {}
    figure, (radii, order) = new_figure(ncols=2, width=10.0, height=4.0, width_ratios=(1.5, 1.0))
    for name in drawn:
        times = found[f"{name}: t"]
        reference, mine = (np.hypot(*found[f"{name}: {key}"][:, :2].T) for key in ("reference", "states"))
        first = name == drawn[0]
        radii.plot(times, reference, **curve("reference", "reference" if first else "_", linewidth=1.6))
        radii.plot(times[::4], mine[::4], **points("exudyn", "drivetrain" if first else "_", markersize=4.0))
        radii.annotate(name, (times[-1], mine[-1]), xytext=(4, -3), textcoords="offset points", fontsize=9.0)
    radii.set(xlabel=axis("t", "s"), ylabel="radius of the disc's centre in m", ylim=(0.0, 0.05))
    radii.legend(loc="upper right", ncols=2)
    inertias, changes = found["inertia"], found["finite inertia"]
    order.loglog(inertias, changes, **points("exudyn", "drivetrain"))
    order.loglog(inertias, changes[0] * inertias[0] / inertias, color=BLACK, linewidth=0.8, label="slope −1")
    order.set(xlabel="inertia in kg m²", ylabel=f"change of the state at {UNTIL:g} s", ylim=(1e-4, 1e-2))
    order.set_xticks(inertias, [f"{inertia:g}" for inertia in inertias])
    order.minorticks_off()
    order.legend(loc="upper right")
    return {"drivetrain-reduced": figure}
