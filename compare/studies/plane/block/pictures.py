"""Figures."""

import numpy as np

from compare.claims import ByEngine, Figures
from compare.output.figures import BLACK, GREY, axis, curve, engines_in, new_figure, points
from compare.studies.plane.block.study import HEADINGS, SPEED, STOPPING_DISTANCE, direction


def draw(data: ByEngine) -> Figures:
    if not data:
        return {}
    figure, (plane, swings, velocity) = new_figure(ncols=3, width=13.2, height=4.2)
    quadrant = np.radians(np.linspace(0.0, 90.0, 91))
    plane.plot(
        STOPPING_DISTANCE * np.cos(quadrant), STOPPING_DISTANCE * np.sin(quadrant), **curve("theory", "")
    )
    for heading in HEADINGS:
        along = direction(heading)
        path = STOPPING_DISTANCE * along * np.array([0.0, 1.0])
        plane.plot(path.real, path.imag, color=BLACK, linewidth=0.6)
        boxed = STOPPING_DISTANCE * np.array([along.real, along.imag]) ** 2  # each axis stops independently
        plane.plot(*boxed, color=GREY, marker="+", linestyle="none", label="" if heading else "box")
    swings.axhspan(-1.0, 1.0, color="#eeeeee", zorder=0.5)
    if "theory" in data:
        theory = data["theory"]
        swings.plot(theory["half swings"], theory["way"], **curve("theory", "closed form"))
        velocity.plot(theory["t"], np.hypot(*theory["velocity"].T), **curve("theory", "closed form"))
        velocity.plot(theory["t"], theory["velocity"], **curve("theory", "_"))
    velocity.axhline(0.5 * SPEED, color=GREY, linewidth=0.9, linestyle=":")
    for engine in engines_in(data):
        found = data[engine]
        if "stops" in found:
            along = np.exp(1j * np.radians(HEADINGS)) * (found["stops"] @ (1.0, 1j))
            plane.plot(along.real, along.imag, **points(engine))
        if "way" in found:
            swings.plot(found["half swings"], found["way"], **points(engine))
        if "velocity" in found:
            velocity.plot(found["t"], np.hypot(*found["velocity"].T), **points(engine))
            velocity.plot(found["t"], found["velocity"], **points(engine, "_"))
    plane.set(
        xlabel=axis("x", "m"),
        ylabel=axis("y", "m"),
        aspect="equal",
        xlim=(-0.03, 0.75),
        ylim=(-0.03, 0.65),
        title="Thrown blocks stop",
    )
    swings.set(
        xlabel=axis(r"t\,/\,(\pi\sqrt{m/C})"),
        ylabel=axis(r"s\,/\,(\mu N/C)"),
        title="Released on a spring at 45 degrees",
    )
    velocity.set(xlabel=axis("t", "s"), ylabel="velocity in m/s", title=r"Thrown across a pull of $\mu N$")
    for (x, y), name in {(1.5, 0.57): "$|v|$", (1.5, 0.4): "along", (1.5, 0.13): "across"}.items():
        velocity.annotate(name, (x, y))
    for panel in (plane, swings, velocity):
        panel.legend(loc="upper right")
    return {"block": figure}
