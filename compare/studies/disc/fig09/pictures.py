"""Figures."""

from collections.abc import Iterator
from typing import Any

import numpy as np

import compare.output.figures as plots
from compare.claims import ByEngine, Data, Figures
from compare.output.figures import Axes, Figure, axis, curve, engines_in, new_figure, points
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
PAPER: dict[str, Any] = {"linestyle": (0.0, (1.0, 1.5)), "linewidth": 1.4}


def draw(data: ByEngine) -> Figures:
    ends = {"fig09-offset": draw_ends(data["theory"])} if "theory" in data else {}
    return {"fig09-radius": draw_radius(data), "fig10-spin": draw_spin(data)} | ends


def draw_radius(data: ByEngine) -> Figure:
    figure, (panel,) = new_figure(width=8.6, height=5.6)
    if "theory" in data:
        _whirls(panel, data["theory"])
        _near_axis(panel, data["theory"])
    for engine, found, kind in _measured(data):
        loads = found[f"{kind}circle load"]
        pin = np.array([radius_of_pin(load) for load in loads])
        panel.plot(loads, found[f"{kind}circle"][:, 0] * pin, **points(engine))
        panel.plot(
            found["rest load"], RING.offset * np.hypot(*found[f"{kind}rest"].T[:2]), **points(engine, "")
        )
        if "orbit" in found:
            panel.plot(found["orbit load"], found["orbit"][:, 1:3], **points(engine, ""))
            panel.plot(found["stick load"], found["stuck"][:, 0], **points(engine, ""))
    panel.set(xlabel=axis(r"\mu N", "N"), ylabel=axis(r"\rho", "m"))
    panel.set(xscale="log", yscale="log", xlim=(LEAST_LOAD, 1.3 * LARGEST_LOAD), ylim=(4e-3, 120.0))
    panel.legend(loc="upper left")
    return figure


def _measured(data: ByEngine) -> Iterator[tuple[str, Data, str]]:
    """Yield each engine with its data and their prefix: "" on a ring, else "six " on six points."""
    for engine in engines_in(data):
        for kind in [kind for kind in ("", "six ") if f"{kind}circle" in data[engine]][:1]:
            yield engine, data[engine], kind


def _whirls(panel: Axes, found: Data) -> None:
    load, radius, _ = found["circles, ring"].T
    fold = int(np.argmin(load))
    panel.plot(load[: fold + 1], radius[: fold + 1], **CENTRED_WHIRL)
    panel.plot(load[fold:], radius[fold:], **UNSTABLE | {"color": plots.PURPLE})
    load, radius, _ = found["circles, (23)"].T
    panel.plot(load, radius, **curve("theory", "", **PAPER))
    load, least, greatest, _ = found["orbits"].T
    fold = int(np.argmin(load))
    panel.plot(load[: fold + 1], np.column_stack((least, greatest))[: fold + 1], **WHIRL)
    for words, place, colour in (
        ("whirl, $X_0=0.1$ m:\nleast and greatest radius", (2.3e-3, 0.16), plots.GREEN),
        ("whirl, $X_0=0$", (2.2e-4, 0.2), plots.PURPLE),
        ("by (23)", (2.2e-4, 0.012), plots.BLACK),
    ):
        panel.text(*place, words, color=colour, va="center", fontsize=9.5)


def _near_axis(panel: Axes, found: Data) -> None:
    load, least, greatest, _ = found["orbits"].T
    inner = slice(int(np.argmin(load)), None)
    panel.plot(load[inner], least[inner], **UNSTABLE)
    panel.plot(load[inner], greatest[inner], **UNSTABLE)
    load, radius, _ = found["rests"].T
    held = load <= found["last stable load"][0]
    panel.plot(load[held], radius[held], **curve("theory", "", linewidth=1.4))
    panel.plot(load[~held], radius[~held], **UNSTABLE)
    load, radius = found["sticking"].T
    panel.fill_between(load, radius, color=plots.GREY, alpha=0.4, linewidth=0.0)
    for words, place in {
        "self-centred equilibrium": (4.2e-4, 0.085),
        "unstable": (4.5e-3, 0.033),
        "sticks, (9)": (0.118, 0.0055),
    }.items():
        panel.text(*place, words, va="center", fontsize=9.5)


def draw_spin(data: ByEngine) -> Figure:
    figure, (whole, distance) = new_figure(ncols=2, width=11.0, height=4.8)
    limit = spin_of_large_whirl(RING)
    if "theory" in data:
        _spin_by_theory(whole, distance, data["theory"], limit)
    for engine, found, kind in _measured(data):
        spin, loads = RING.disc_speed * found[f"{kind}circle"][:, 2], found[f"{kind}circle load"]
        whole.plot(loads, spin, **points(engine))
        distance.plot(loads, spin - limit, **points(engine))
        whole.plot(found["rest load"], RING.disc_speed * found[f"{kind}rest"][:, 2], **points(engine, ""))
        if "orbit" in found:
            distance.plot(found["orbit load"], found["orbit"][:, -1] - limit, **points(engine, ""))
            whole.plot(found["stick load"], found["stuck"][:, 1], **points(engine, ""))
    for panel in (whole, distance):
        panel.set(xlabel=axis(r"\mu N", "N"))
    whole.set(ylabel=axis(r"\dot\varphi", "rad/s"), xlim=(0.0, 1.05 * LARGEST_LOAD))
    distance.set(xscale="log", yscale="log", xlim=(LEAST_LOAD, 1.3 * LARGEST_LOAD), ylim=(5e-11, 1e-2))
    distance.set(ylabel=rf"$\dot\varphi$ of the whirl minus its limit {limit:.5f} in rad/s")
    whole.legend(loc="center left")
    return figure


def _spin_by_theory(whole: Axes, distance: Axes, found: Data, limit: float) -> None:
    for name, style in (("ring", CENTRED_WHIRL), ("(23)", curve("theory", "", **PAPER))):
        load, _, spin = found[f"circles, {name}"].T
        fold = int(np.argmin(load))
        whole.plot(load[:fold], spin[:fold], **style)
        distance.plot(load[:fold], spin[:fold] - limit, **style)
        unstable = style if name == "(23)" else UNSTABLE | {"color": plots.PURPLE}
        distance.plot(load[fold:], spin[fold:] - limit, **unstable)
    load, _, _, spin = found["orbits"].T
    fold = int(np.argmin(load))
    for panel, zero in ((whole, 0.0), (distance, limit)):
        panel.plot(load[: fold + 1], spin[: fold + 1] - zero, **WHIRL)
        panel.plot(load[fold:], spin[fold:] - zero, **UNSTABLE)
    load, _, spin = found["rests"].T
    held = load <= found["last stable load"][0]
    whole.plot(load[held], spin[held], **curve("theory", "", linewidth=1.4))
    whole.plot(load[~held], spin[~held], **UNSTABLE)
    load, _ = found["sticking"].T
    whole.plot(load, np.full(len(load), RING.disc_speed), color=plots.BLACK, linestyle="--")
    for panel, words, place, colour in (
        (whole, "sticking", (0.15, 1.49), plots.BLACK),
        (whole, "whirl", (0.15, 1.262), plots.GREEN),
        (whole, "self-centred equilibrium", (0.025, 1.271), plots.BLACK),
        (whole, "unstable", (0.093, 1.35), plots.GREY),
        (distance, "$X_0=0.1$ m, mean", (1.4e-2, 1e-5), plots.GREEN),
        (distance, "$X_0=0$", (3e-4, 5e-6), plots.PURPLE),
        (distance, "$X_0=0$ by (23)", (5.5e-4, 7e-4), plots.BLACK),
    ):
        panel.text(*place, words, color=colour, fontsize=9.5, va="center")


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
