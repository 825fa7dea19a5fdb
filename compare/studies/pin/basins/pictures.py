"""Figure."""

from typing import Any

import numpy as np

from compare.claims import ByEngine, Figures
from compare.claims.parameters import FIG5_STARTS
from compare.output.figures import BLACK, GREEN, PURPLE, SKY, axis, curve, new_figure
from compare.studies.pin.basins.study import PLANE
from reference_model.ensemble import EndState


def draw(data: ByEngine) -> Figures:
    if "theory" not in data:
        return {}
    from matplotlib.colors import ListedColormap

    found = data["theory"]
    figure, (plane, orbit, share) = new_figure(ncols=3, width=13.0, height=4.0)
    whirls = found["ends"] == EndState.WHIRL
    plane.imshow(
        np.where(found["ends"] == EndState.SELF_CENTRED, 0.0, np.where(whirls, 1.0, 2.0)),
        origin="lower",
        extent=(*PLANE[0], *PLANE[1]),
        cmap=ListedColormap([SKY, "#f3ead7", PURPLE]),
        vmin=0.0,
        vmax=2.0,
        interpolation="nearest",
        aspect="equal",
    )
    plane.plot(*found["curve"].T, **curve("theory", "stable set of the saddle"))
    for x, _, vx, _ in FIG5_STARTS.values():
        plane.plot(x, vx, "+", color=BLACK, markersize=7.0)
    plane.text(0.065, -0.11, "equilibrium", ha="center")
    plane.text(-0.13, 0.25, "whirl", ha="center")
    plane.set(xlabel=axis("x_0", "m"), ylabel=axis(r"\dot x_0", "m/s"))
    plane.legend(loc="lower left")

    x, y, held = found["saddle"].T
    orbit.plot(x, y, color=BLACK, linewidth=1.0)
    orbit.plot(*np.where(held > 0.0, (x, y), np.nan), color=PURPLE, linewidth=4.0, label="sticks")
    orbit.plot(0.0, 0.0, "+", color=BLACK, markersize=8.0)
    orbit.set(xlabel=axis("x", "m"), ylabel=axis("y", "m"), aspect="equal")
    orbit.legend(loc="best")

    value, low, high = found["whirl"].T
    # No line, because the share between two speeds is unknown.
    bars = np.abs([value - low, high - value])
    style: dict[str, Any] = {"color": GREEN, "markersize": 3.5, "label": "whirl, 95 % interval"}
    share.errorbar(found["speeds"], value, bars, fmt="o", capsize=2.5, **style)
    share.set(xlabel=axis(r"\omega", "rad/s"), ylabel="share of the starts", ylim=(-0.02, 1.02))
    share.legend(loc="lower right")
    return {"basins": figure}
