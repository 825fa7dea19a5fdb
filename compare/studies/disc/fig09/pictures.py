"""Figures."""

from typing import Any

import numpy as np

import compare.output.figures as plots
from compare.claims import ByEngine, Data, Figures
from compare.output.figures import Axes, Figure, axis, beside, curve, engines_in, new_figure, points
from compare.studies.disc.fig09.theory import LARGEST_LOAD, RING, radius_of_pin, spin_of_large_whirl

LEAST_LOAD = 2e-4
UNSTABLE: dict[str, Any] = {
    "color": plots.GREY,
    "linestyle": (0.0, (3.0, 1.5)),
    "linewidth": 1.4,
    "zorder": 2.5,
}
WHIRL: dict[str, Any] = {"color": plots.GREEN, "linewidth": 1.6, "zorder": 2.5}
CENTRED_WHIRL: dict[str, Any] = {"color": plots.PURPLE, "linewidth": 1.2, "zorder": 2.4}
SIX: dict[str, dict[str, Any]] = {
    "reference": {"marker": "h", "markersize": 7.5},
    "exudyn": {"marker": "+", "markersize": 6.5},
}

SIX_BESIDE = 1.5

PAPER: dict[str, Any] = {"linestyle": (0.0, (1.0, 1.5)), "linewidth": 1.4}


def draw(data: ByEngine) -> Figures:
    ends = {"fig09-offset": draw_ends(data["theory"])} if "theory" in data else {}
    return {"fig09-radius": draw_radius(data), "fig10-spin": draw_spin(data)} | ends


def draw_radius(data: ByEngine) -> Figure:
    figure, (whole, near) = new_figure(ncols=2, width=11.0, height=5.0)
    if "theory" in data:
        _whirls(whole, data["theory"])
        for panel in (whole, near):
            _near_axis(panel, data["theory"])
    for engine in engines_in(data):
        found = data[engine]
        for prefix, style in _marks(engine, found):
            loads = found[f"{prefix}circle load"]
            pin = np.array([radius_of_pin(load) for load in loads])
            place = SIX_BESIDE if prefix else 0.0
            whole.plot(loads, found[f"{prefix}circle"][:, 0] * pin, transform=beside(whole, place), **style)
            radius = RING.offset * np.hypot(*found[f"{prefix}rest"].T[:2])
            for panel in (whole, near):
                shifted = beside(panel, place)
                panel.plot(found["rest load"], radius, transform=shifted, **style | {"label": ""})
        if "orbit" in found:
            whole.plot(found["orbit load"], found["orbit"][:, 1:3], **points(engine, ""))
            for panel in (whole, near):
                panel.plot(found["stick load"], found["stuck"][:, 0], **points(engine, ""))
    for panel in (whole, near):
        panel.set(xlabel=axis(r"\mu N", "N"), ylabel=axis(r"\rho", "m"))
    whole.set(xscale="log", yscale="log", xlim=(LEAST_LOAD, 1.3 * LARGEST_LOAD), ylim=(4e-3, 120.0))
    near.set(xlim=(0.0, 1.05 * LARGEST_LOAD), ylim=(0.0, 0.215))
    _legend_below(figure, whole)
    return figure


def _whirls(panel: Axes, found: Data) -> None:
    load, radius, _ = found["circles, ring"].T
    fold = int(np.argmin(load))
    panel.plot(load[: fold + 1], radius[: fold + 1], label="whirl, $X_0=0$, ring", **CENTRED_WHIRL)
    panel.plot(load[fold:], radius[fold:], **UNSTABLE | {"color": plots.PURPLE})
    load, radius, _ = found["circles, (23)"].T
    panel.plot(load, radius, **curve("theory", "whirl, $X_0=0$, eq. (23)", **PAPER))
    load, least, greatest, _ = found["orbits"].T
    fold = int(np.argmin(load))
    outer, label = np.column_stack((least, greatest))[: fold + 1], "whirl, $X_0=0.1$ m, smallest and largest"
    panel.plot(load[: fold + 1], outer, label=(label, ""), **WHIRL)


def _near_axis(panel: Axes, found: Data) -> None:
    load, least, greatest, _ = found["orbits"].T
    inner = slice(int(np.argmin(load)), None)
    panel.plot(load[inner], least[inner], label="unstable", **UNSTABLE)
    panel.plot(load[inner], greatest[inner], **UNSTABLE)
    load, radius, _ = found["rests"].T
    held = load <= found["last stable load"][0]
    panel.plot(load[held], radius[held], **curve("theory", "self-centred equilibrium", linewidth=1.4))
    panel.plot(load[~held], radius[~held], **UNSTABLE)
    load, radius = found["sticking"].T
    panel.fill_between(load, radius, color=plots.GREY, alpha=0.4, linewidth=0.0, label="sticks, (9)")


def _marks(engine: str, found: Data) -> list[tuple[str, dict[str, Any]]]:
    six = points(engine, f"{engine}, six points", **SIX.get(engine, {"markersize": 3.5}))
    both = (("", points(engine)), ("six ", six))
    return [(prefix, style) for prefix, style in both if f"{prefix}circle" in found]


def draw_spin(data: ByEngine) -> Figure:
    figure, (whole, distance) = new_figure(ncols=2, width=11.0, height=4.8)
    limit = spin_of_large_whirl(RING)
    if "theory" in data:
        _spin_by_theory(whole, distance, data["theory"], limit)
    for engine in engines_in(data):
        found = data[engine]
        for prefix, style in _marks(engine, found):
            spin = RING.disc_speed * found[f"{prefix}circle"][:, 2]
            loads = found[f"{prefix}circle load"]
            place = SIX_BESIDE if prefix else 0.0
            whole.plot(loads, spin, transform=beside(whole, place), **style)
            distance.plot(loads, spin - limit, transform=beside(distance, place), **style)
            at_rest = RING.disc_speed * found[f"{prefix}rest"][:, 2]
            style |= {"label": "", "transform": beside(whole, place)}
            whole.plot(found["rest load"], at_rest, **style)
        if "orbit" in found:
            distance.plot(found["orbit load"], found["orbit"][:, -1] - limit, **points(engine, ""))
            whole.plot(found["stick load"], found["stuck"][:, 1], **points(engine, ""))
    for panel in (whole, distance):
        panel.set(xlabel=axis(r"\mu N", "N"))
    whole.set(ylabel=axis(r"\dot\varphi", "rad/s"), xlim=(0.0, 1.05 * LARGEST_LOAD))
    distance.set(xscale="log", yscale="log", xlim=(LEAST_LOAD, 1.3 * LARGEST_LOAD), ylim=(5e-11, 1e-2))
    distance.set(ylabel=rf"$\dot\varphi$ of the whirl minus its limit {limit:.5f} in rad/s")
    _legend_below(figure, whole)
    return figure


def _spin_by_theory(whole: Axes, distance: Axes, found: Data, limit: float) -> None:
    for name, label, style in (
        ("ring", "whirl, $X_0=0$, ring", CENTRED_WHIRL),
        ("(23)", "whirl, $X_0=0$, eq. (23)", curve("theory", "", **PAPER)),
    ):
        load, _, spin = found[f"circles, {name}"].T
        fold = int(np.argmin(load))
        style = style | {"label": label}
        whole.plot(load[:fold], spin[:fold], **style)
        distance.plot(load[:fold], spin[:fold] - limit, **style)
        unstable = style if name == "(23)" else UNSTABLE | {"color": plots.PURPLE}
        distance.plot(load[fold:], spin[fold:] - limit, **unstable)
    load, _, _, spin = found["orbits"].T
    fold = int(np.argmin(load))
    for panel, zero in ((whole, 0.0), (distance, limit)):
        panel.plot(load[: fold + 1], spin[: fold + 1] - zero, label="whirl, $X_0=0.1$ m, mean", **WHIRL)
        panel.plot(load[fold:], spin[fold:] - zero, **UNSTABLE)
    load, _, spin = found["rests"].T
    held = load <= found["last stable load"][0]
    whole.plot(load[held], spin[held], **curve("theory", "self-centred equilibrium", linewidth=1.4))
    whole.plot(load[~held], spin[~held], label="unstable", **UNSTABLE)
    load, _ = found["sticking"].T
    whole.plot(load, np.full(len(load), RING.disc_speed), color=plots.BLACK, linestyle="--", label="sticking")


def draw_ends(found: Data) -> Figure:
    figure, (panel,) = new_figure(width=7.0, height=4.4)
    offset, last, stable = found["offset"], found["last load"], found["last stable"]
    panel.fill_between(offset, last, 1.0, color=plots.GREY, alpha=0.4, linewidth=0.0)
    panel.plot(offset, last, **curve("theory", linewidth=1.3))
    panel.plot(offset, stable, color=plots.GREY, linewidth=1.6)
    x, load = found["folds"].T
    panel.plot(x[1:], load[1:], color=plots.GREEN, marker="o", markersize=4.0)
    panel.plot(offset[0], load[0], color=plots.PURPLE, marker="<", clip_on=False)
    panel.axvline(RING.offset, color=plots.BLACK, linewidth=0.7, linestyle=":")
    words: dict[str, Any] = {"ha": "center", "va": "center"}
    panel.text(0.012, 0.11, "no equilibrium, stick", **words)
    panel.text(0.012, 0.004, "equilibrium unstable", **words)
    panel.text(0.16, 0.01, "equilibrium\nand whirl", **words)
    panel.text(0.15, 0.0008, "equilibrium,\nno whirl", **words)
    panel.text(0.0044, 0.0185, r"friction holds $C X_0$ and $b(\omega-\Omega)$", va="top")
    panel.text(0.085, 0.0075, "loses its stability", color=plots.GREY, rotation=51.0, ha="right", va="center")
    panel.text(0.042, 0.00058, "fold of the whirl", color=plots.GREEN, va="top")
    panel.text(0.0043, 0.97 * load[0], r"fold for $X_0=0$", color=plots.PURPLE, va="top")
    panel.set(xscale="log", yscale="log", xlim=(offset[0], offset[-1]), ylim=(1.5e-4, 0.35))
    panel.set(xlabel=axis("X_0", "m"), ylabel=axis(r"\mu N", "N"))
    return figure


def _legend_below(figure: Figure, panel: Axes) -> None:
    handles, labels = panel.get_legend_handles_labels()
    unique = dict(zip(labels, handles, strict=True))
    figure.legend(unique.values(), unique.keys(), loc="outside lower center", ncols=4)
