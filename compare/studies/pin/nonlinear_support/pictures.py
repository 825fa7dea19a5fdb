"""Radii of the whirl over the friction force on each support, and growth without damping."""

from __future__ import annotations

from compare.claims.study import ByEngine, Figures
from compare.output.figures import axis, curve, engines_in, new_figure, points
from compare.studies.pin.nonlinear_support.theory import PINS

LINES = {"linear": ("linear", ":"), "hardening": ("hardening", "-"), "stop": ("with a stop", "--")}
"""Label and dashes of each support."""


def draw(data: ByEngine) -> Figures:
    """Draw radii of the whirl over the friction force, and growth without damping."""
    figure, (whirl, growing) = new_figure(ncols=2, width=10.0, height=4.0)
    if "theory" in data:
        found = data["theory"]
        for name, (label, dashes) in LINES.items():
            style = curve("theory", label) | {"linestyle": dashes}
            whirl.plot(found["load"], found[f"{name} radius"], **style)
            if name in PINS:
                growing.axhline(float(found[f"{name} end"]), **style)
            else:
                growing.plot(*found[f"{name} growth"].T, **style)
    for engine in engines_in(data):
        found, label = data[engine], engine
        for name in PINS:
            whirl.plot(found["loads"], found[f"{name} radius"], **points(engine, label))
            growing.plot(*found[f"{name} growth"].T, **curve(engine, label))
            label = "_"
    whirl.set(xlabel=axis(r"\mu N", "N"), ylabel=axis(r"\rho_c", "m"), xlim=(0.0, None), ylim=(0.0, None))
    growing.set(xlabel=axis("t", "s"), ylabel=axis(r"\rho", "m"), xlim=(0.0, 150.0), ylim=(0.0, 2.0))
    whirl.set_title("Whirl without offset")
    growing.set_title("Without damping")
    handles, labels = whirl.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3)
    return {"nonlinear-support": figure}
