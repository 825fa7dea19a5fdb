"""Figures and animations of a motion with matplotlib."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from reference_model.systems import ANGLE, DiscOnDisc, FloatArray, System, positive_number

if TYPE_CHECKING:
    import matplotlib.animation
    import matplotlib.figure

Figure: TypeAlias = "matplotlib.figure.Figure"
FuncAnimation: TypeAlias = "matplotlib.animation.FuncAnimation"

MOTION, STICK, GREY = "#0b4f7d", "#d9730d", "#7f7f7f"
FRAMES_PER_SECOND, MOST_FRAMES = 25, 100_000


def figure_of(
    system: System,
    times: FloatArray,
    states: FloatArray,
    slip_speed: FloatArray,
    stick_spans: FloatArray,
    figure: Figure | None = None,
) -> Figure:
    """Draw path, radius, slip speed and, for a disc, spin; ``stick_spans`` has shape (n, 2), in s."""
    figure = figure or _pyplot().figure(figsize=(9.0, 5.2), layout="constrained")
    curves = [("radius ρ [m]", np.hypot(*states.T[:2])), ("slip speed [m/s]", slip_speed)]
    if isinstance(system, DiscOnDisc):
        curves.append(("spin [rad/s]", states[:, -1]))
    grid = figure.add_gridspec(len(curves), 2)
    path = figure.add_subplot(
        grid[:, 0], aspect="equal", adjustable="datalim", xlabel="x [m]", ylabel="y [m]"
    )
    x, y = states.T[:2]
    path.plot(x, y, color=MOTION, linewidth=0.9, label="path of the centre")
    for start, end in stick_spans:
        inside = (start <= times) & (times <= end)
        path.plot(x[inside], y[inside], color=STICK, linewidth=2.0)
    path.plot(x[0], y[0], "o", color=MOTION, label="start")
    path.plot(0.0, 0.0, "+", color="black", markersize=9.0, label="axis of the master disc")
    if system.offset:
        path.plot(system.offset, 0.0, "x", color=GREY, label="relaxed springs")
    rows: list[Any] = []
    for i, (label, values) in enumerate(curves):
        axes = figure.add_subplot(grid[i, 1], sharex=rows[0] if rows else None, ylabel=label)
        axes.plot(times, values, color=MOTION, linewidth=0.9)
        for start, end in stick_spans:
            axes.axvspan(start, end, color=STICK, alpha=0.25, linewidth=0.0)
        axes.tick_params(labelbottom=i == len(curves) - 1)
        rows.append(axes)
    if isinstance(system, DiscOnDisc):
        rows[-1].axhline(system.disc_speed, color=GREY, linestyle="--", label="spin of the master disc")
    rows[-1].set_xlabel("time t [s]")
    if len(stick_spans):
        path.plot([], [], color=STICK, linewidth=2.0, label="stick")
    figure.legend(loc="outside lower center", ncols=3, frameon=False, fontsize="small")
    return figure


def animation_of(
    system: System,
    times: FloatArray,
    states: FloatArray,
    places: Iterable[tuple[float, ...]] | None = None,
    speed: float = 1.0,
) -> FuncAnimation:
    """Animate the pin or the disc in the fixed frame."""
    speed = positive_number("speed", speed, "s/s")
    if (times[-1] - times[0]) * FRAMES_PER_SECOND > speed * MOST_FRAMES:
        raise ValueError(f"speed = {speed:g} s/s: more than {MOST_FRAMES:,} frames; use a larger speed")
    plt = _pyplot()
    from matplotlib.animation import FuncAnimation

    arms = _contact_places(system, places)
    moments = np.arange(times[0], times[-1] + 1e-9 * speed, speed / FRAMES_PER_SECOND)
    frames = np.column_stack([np.interp(moments, times, column) for column in states.T])
    figure, axes = plt.subplots(figsize=(5.0, 5.0), layout="constrained")
    ring = system.contact_radius if isinstance(system, DiscOnDisc) and places is None else 0.0
    size = 1.1 * (np.hypot(*states.T[:2]).max() + max(ring, abs(arms).max())) or 1.0
    axes.set(xlim=(-size, size), ylim=(-size, size), aspect="equal", xlabel="x [m]", ylabel="y [m]")
    axes.add_patch(plt.Circle((0.0, 0.0), size / 1.05, facecolor="#eeeeee", edgecolor=GREY))
    (spoke,) = axes.plot([], [], color=GREY, linewidth=0.8, label="master disc")
    (trail,) = axes.plot([], [], color=MOTION, linewidth=0.6, alpha=0.5, label="path of the centre")
    (body,) = axes.plot([], [], color=STICK, linewidth=1.5, label="contact ring" if ring else "")
    label = "contact points" if len(arms) > 1 else "centre" if ring else "pin"
    (contacts,) = axes.plot([], [], "o", color=STICK, markersize=4.0, label=label)
    circle = ring * np.exp(1j * np.linspace(0.0, 2.0 * math.pi, 121))

    def show(i: int) -> tuple[Any, ...]:
        centre = complex(*frames[i, :2])
        turn = np.exp(1j * frames[i, ANGLE]) if isinstance(system, DiscOnDisc) else 1.0
        direction = np.exp(1j * system.disc_speed * (moments[i] - moments[0])) * size / 1.05
        spoke.set_data([0.0, direction.real], [0.0, direction.imag])
        trail.set_data(frames[: i + 1, 0], frames[: i + 1, 1])
        outline = centre + turn * np.append(circle, 0.0)
        body.set_data(outline.real, outline.imag)
        touching = centre + turn * arms
        contacts.set_data(touching.real, touching.imag)
        axes.set_title(f"t = {moments[i]:.2f} s", loc="left")
        return spoke, trail, body, contacts

    axes.legend(loc="upper right", fontsize="small")
    figure.draw_without_rendering()
    figure.set_layout_engine("none")  # a layout for each frame would take 40 % of the time
    return FuncAnimation(figure, show, frames=len(moments), interval=1000.0 / FRAMES_PER_SECOND)


def _contact_places(system: System, places: Iterable[tuple[float, ...]] | None) -> Any:
    if places is not None:
        return np.array([complex(*place[:2]) for place in places])
    if isinstance(system, DiscOnDisc) and system.contact_points:
        n = system.contact_points
        return system.contact_radius * np.exp(2j * math.pi * np.arange(n) / n)
    return np.zeros(1, complex)


def _pyplot() -> Any:
    try:
        import matplotlib.pyplot
    except ImportError:
        raise ModuleNotFoundError("figures need matplotlib; use: pip install matplotlib") from None
    return matplotlib.pyplot
