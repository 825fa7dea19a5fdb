"""Draw the figures of the guide and of the gallery: ``python docs/make_pictures.py``.

The pictures of the gallery are those that the examples draw. Exudyn's viewer needs a display.
"""

import os
import runpy
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from compare.output.figures import new_figure, paper_style
from compare.output.limit_surface import draw_limit_surface
from reference_model.contact import Points, polygon_patch

MASTER, DISC, FRICTION = "tab:blue", "tab:orange", "tab:red"
CENTRE, SHAFT, RADIUS = 0.55 + 0.5j, 1.3 + 0.0j, 0.9
SLIP = -0.75j * CENTRE  # slip of a centre at rest


def xy(place):
    """Return the coordinates of a complex position for Matplotlib."""
    return place.real, place.imag


def arrow(panel, start, end, colour, name="", beside=0j):
    """Draw an arrow with its name next to the end."""
    look = {"arrowstyle": "-|>", "color": colour, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 15}
    panel.annotate("", xy=xy(end), xytext=xy(start), arrowprops=look)
    panel.text(*xy(end + beside), name, color=colour, ha="center", va="center", fontsize=13)


def turning(panel, centre, radius, degrees, colour, name):
    """Draw an arc with an arrowhead around a centre, from the first to the last of ``degrees``."""
    way = centre + radius * np.exp(1j * np.radians(np.linspace(*degrees, 50)))
    panel.plot(way.real, way.imag, color=colour)
    arrow(panel, way[-2], way[-1] + (way[-1] - way[-2]), colour)
    place = centre + (radius + 0.13) * np.exp(1j * np.radians(np.mean(degrees)))
    panel.text(*xy(place), name, color=colour, ha="center", va="center", fontsize=13)


figure = Figure(figsize=(6.0, 4.8), layout="constrained")
panel = figure.subplots()
panel.add_patch(Circle((0.0, 0.0), 1.75, facecolor=MASTER, edgecolor="none", alpha=0.12))
panel.add_patch(Circle(xy(CENTRE), RADIUS, fill=False, color=DISC, linewidth=7, alpha=0.5))
panel.plot(*xy(0j), "+", color=MASTER, markersize=13, markeredgewidth=2)
panel.plot(*xy(SHAFT), "kx", markersize=10, markeredgewidth=2)
panel.text(*xy(SHAFT + 0.15), "$X_0$", ha="center", va="center", fontsize=13)
panel.plot(*np.array([xy(SHAFT), xy(CENTRE)]).T, "k:", linewidth=1)
panel.plot(*xy(CENTRE), "o", color=DISC, markersize=9)
arrow(panel, 0j, CENTRE, "0.4", "$z$", -0.22 - 0.38j)
arrow(panel, CENTRE, CENTRE + SLIP, DISC, "$u$", -0.04 - 0.13j)
arrow(panel, CENTRE, CENTRE - 0.6 * SLIP, FRICTION, "$F$", -0.1 + 0.07j)
arrow(panel, 0j, 0.6 * SLIP, FRICTION, "$-F$, $-M - z\\times F$", -0.66 - 0.13j)
arrow(panel, CENTRE, CENTRE + RADIUS * np.exp(1.4j), "0.4", "$R$", 0.1 - 0.4j)
turning(panel, 0j, 1.5, (150.0, 200.0), MASTER, r"$\omega$")
turning(panel, CENTRE, 1.1, (345.0, 380.0), DISC, r"$\dot\varphi$")
turning(panel, CENTRE, 0.35, (-20.0, 60.0), FRICTION, "$M$")
panel.set(xlim=(-1.85, 1.95), ylim=(-1.8, 1.8), aspect="equal", xlabel="x", ylabel="y", xticks=[], yticks=[])


def draw_gallery(folder):
    """Let each example draw its picture."""
    examples = Path(__file__).parents[1] / "examples"
    for path in sorted(examples.glob("[01]*.py")):
        example, picture = runpy.run_path(str(path)), folder / f"{path.stem}.png"
        if "draw" in example:
            example["draw"](picture)
        elif "render" in example and os.environ.get("DISPLAY"):
            example["final_position"]()
            example["render"](picture)


if __name__ == "__main__":
    draw_gallery(Path(__file__).parent / "gallery")
    figure.savefig(Path(__file__).parent / "conventions.png", dpi=100)
    contacts = {
        "Three feet": Points([(0.05, 0.0, 0.5), (-0.03, 0.04, 0.2), (-0.02, -0.05, 0.3)]),
        "Triangle": polygon_patch([(0.0, 0.1), (-0.1, -0.05), (0.1, -0.05)], divisions=4),
    }
    with paper_style():
        limits, panels = new_figure(ncols=2)
        for panel, (name, contact) in zip(panels, contacts.items(), strict=True):
            draw_limit_surface(panel, contact)
            panel.set_title(name)
        panels[0].legend()
        limits.savefig(Path(__file__).parent / "limit_surface.png", dpi=100)
