"""Figures."""

import math
from typing import Any

import numpy as np
from scipy.linalg import expm

import compare.studies.drivetrain.frozen.theory as frozen
from compare.claims import ByEngine, Data, Figures
from compare.output.figures import BLACK, GREY, Figure, axis, curve, engines_in, new_figure, points
from compare.studies.toolkit.drivetrain_bench import passenger_car

MM = 1e3

NO_WHIRL = "#d0d0d0"
"""Hatching distinguishes it from a growth of zero."""


def draw(data: ByEngine) -> Figures:
    maps = {"drivetrain-map": draw_maps(data["theory"])} if "theory" in data else {}
    if not engines_in(data):
        return maps
    return {"drivetrain-steady": draw_steady(data), "drivetrain-modulated": draw_modulated(data)} | maps


def draw_steady(data: ByEngine) -> Figure:
    figure, (place, radius, frequency) = new_figure(ncols=3, width=13.0, height=4.0, width_ratios=(1.1, 1, 1))
    car = passenger_car()
    x0 = MM * car.offset
    semicircle = x0 / 2.0 * (1.0 + np.exp(1j * np.linspace(0.0, math.pi, 181)))
    place.plot(semicircle.real, semicircle.imag, color=GREY, lw=0.8, ls="--", label="semicircle of (4)")
    place.plot([0.0, x0], [0.0, 0.0], "+", color=BLACK, markersize=9.0, clip_on=False)
    place.annotate("engine", (0.0, 0.0), (6, 6), textcoords="offset points")
    place.annotate("shaft", (x0, 0.0), (-4, 6), textcoords="offset points", ha="right")
    if "theory" in data:
        speed, x, y = data["theory"]["rest"].T
        place.plot(MM * x, MM * y, **curve("theory", "reference, reduced disc", linewidth=1.2))
        speed, rho, kappa = data["theory"]["whirl"].T
        onset = float(data["theory"]["onset"])
        style: Any = {"xycoords": ("data", "axes fraction"), "textcoords": "offset points"}
        for panel, values in ((radius, MM * rho), (frequency, kappa / (2.0 * math.pi))):
            panel.plot(speed, values, **curve("theory", "reference, reduced disc", linewidth=1.2))
            panel.axvline(onset, color=GREY, lw=0.8, ls="--")
            panel.annotate("onset", (onset, 0.03), (4, 0), **style)
    for engine in engines_in(data):
        style = points(engine, f"{engine}, whole drivetrain", markersize=7.0, markeredgewidth=1.6)
        speed, x, y, _ = data[engine]["rest"].T
        place.plot(MM * x, MM * y, **style)
        labels = ((8, 4, "left"), (-2, -16, "center"), (-2, 8, "center"))
        for turns, where, (right, up, side) in zip(speed, MM * np.column_stack((x, y)), labels, strict=False):
            small: Any = {"textcoords": "offset points", "ha": side, "fontsize": 9.5}
            place.annotate(f"{turns:.0f} rpm", where, (right, up), **small)
        speed, rho, kappa, _ = data[engine]["whirl"].T
        radius.plot(speed, MM * rho, **style)
        frequency.plot(speed, kappa / (2.0 * math.pi), **style)
    radius.axhline(MM * car.stop_gap, color=GREY, lw=0.8)
    radius.annotate("play", (6150, MM * car.stop_gap), (0, 3), textcoords="offset points", ha="right")
    turns = np.array([3000.0, 6200.0])
    frequency.plot(turns, turns / 60.0, color=GREY, lw=0.8, label="flywheel, order 1")
    place.set(xlabel=axis("x", "mm"), ylabel=axis("y", "mm"), aspect="equal", title="At rest in space")
    place.set(xlim=(-0.02, 0.23), ylim=(-0.075, 0.125))
    for panel in (radius, frequency):
        panel.set(xlabel="engine speed in rpm")
    radius.set(ylabel=axis(r"\rho", "mm"), ylim=(0.48, 0.6), title="Whirl: radius")
    frequency.set(ylabel=axis(r"\kappa/2\pi", "Hz"), title="Whirl: frequency")
    place.legend(loc="lower center", fontsize=9.0)
    frequency.legend(loc="upper left", fontsize=9.0)
    return figure


def draw_maps(theory: Data) -> Figure:
    from matplotlib.colors import SymLogNorm

    figure, (left, right) = new_figure(ncols=2, width=12.0, height=4.4, sharey=True)
    norm = SymLogNorm(1e-3, vmin=-3.0, vmax=3.0)
    torques, gap = theory["torques"], passenger_car().stop_gap
    for panel, across, values in (
        (left, theory["speeds"], theory["over speed"]),
        (right, theory["surpluses"], theory["over surplus"]),
    ):
        look: Any = {"cmap": "RdBu_r", "norm": norm, "shading": "nearest", "rasterized": True}
        mesh = panel.pcolormesh(across, torques, values[..., 0], **look)
        panel.contour(across, torques, values[..., 1], [gap], colors=BLACK, linewidths=1.2)
        panel.set(yscale="log", ylim=(torques[0], torques[-1]), xlim=(across[0], across[-1]))
        panel.patch.set(facecolor=NO_WHIRL, hatch="///", edgecolor="white")
        panel.grid(visible=False)
    left.set(xlabel="engine speed in rpm", ylabel="torque in N m")
    left.set(title=f"Load {100.0 * frozen.SURPLUS:.0f} % more than the torque needs")
    right.set(
        xscale="log", xlabel="load / load that the torque needs − 1", title=f"At {frozen.SPEED:.0f} rpm"
    )
    for panel, words, where, colour in (
        (left, "no whirl: the clutch locks up", (0.05, 0.62), BLACK),
        (left, "on the stop", (0.62, 0.42), "white"),
        (left, "within the play, modulated", (0.42, 0.12), "white"),
        (left, "within the play,\nsteady", (0.05, 0.12), "white"),
        (right, "no whirl: the clutch locks up", (0.5, 0.85), BLACK),
        (right, "on the stop", (0.4, 0.745), BLACK),
        (right, "within the play, modulated", (0.12, 0.25), BLACK),
    ):
        panel.annotate(words, where, xycoords="axes fraction", color=colour)
    speed, torque, surplus = frozen.MODULATED
    left.plot(speed, torque, "*", color=BLACK, markersize=10.0)
    right.plot(surplus, torque, "*", color=BLACK, markersize=10.0)
    bar = figure.colorbar(
        mesh, ax=[left, right], label="growth rate of the modulation in 1/s (blue: it decays)"
    )
    bar.set_ticks([-1.0, -1e-1, -1e-2, 0.0, 1e-2, 1e-1, 1.0])
    bar.set_ticklabels(["−1", "−0.1", "−0.01", "0", "0.01", "0.1", "1"])
    return figure


def draw_modulated(data: ByEngine) -> Figure:
    figure, (radius, slip) = new_figure(nrows=2, width=9.0, height=4.6, sharex=True)
    car = passenger_car()
    for engine in engines_in(data):
        times, distance, slipping = data[engine]["modulated"].T
        radius.plot(times, MM * distance, **curve(engine, linestyle="-"))
        slip.plot(times, slipping, **curve(engine, linestyle="-"))
        shade: Any = {"where": distance > car.stop_gap, "color": GREY, "alpha": 0.25}
        for panel in (radius, slip):
            panel.fill_between(times, 0.0, 1.0, transform=panel.get_xaxis_transform(), **shade)
    whirl = frozen.whirls_of(car)[0]
    matrix = frozen.in_turning_axes(frozen.state_matrix_of(car, whirl), whirl.frequency)
    start = frozen.PUSH * whirl.radius * np.array([1.0, 0.0, 0.0, 0.0, 0.0, 0.0, whirl.frequency, 0.0])
    early = np.linspace(0.0, 1.6, 81)
    step, states = expm(matrix * early[1]), [start]
    for _ in early[1:]:
        states.append(step @ states[-1])
    linear = np.array(states)[:, 0]
    radius.plot(early, MM * (whirl.radius + linear), **curve("theory", "linearised", linewidth=1.4))
    for panel, value in ((radius, MM * whirl.radius), (slip, whirl.slip)):
        panel.axhline(value, **curve("theory", "steady whirl, unstable", linestyle=":", linewidth=1.2))
    radius.axhline(MM * car.stop_gap, color=GREY, lw=0.9)
    radius.annotate("play of the pilot bearing", (0.0, MM * car.stop_gap), (2, 3), textcoords="offset points")
    radius.set(ylabel=axis(r"\rho", "mm"), ylim=(0.0, 0.62))
    slip.set(xlabel=axis("t", "s"), ylabel="slip in rad/s")
    radius.legend(loc="upper center", bbox_to_anchor=(0.6, 0.8), fontsize=9.0)
    return figure
