"""Figures."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

import compare.output.figures as plots
from compare.claims import ByEngine, Data, Figures
from compare.output.figures import Figure, axis, curve, engine_style, engines_in, new_figure
from compare.report.animation import gif
from compare.studies.drivetrain.run_up.study import order_spectrum
from compare.studies.toolkit.drivetrain_bench import RPM, centre, natural_frequency, passenger_car
from reference_model.systems import FloatArray

MM = 1e3

CYAN = "#58e0ff"

SHOWN, ENLARGED, OPEN = (2000.0, 3100.0, 5000.0), 50.0, 0.7
"""Speeds in rpm, magnification of radial motion, and angle in rad that turns the cut of the cover to the viewer."""

FRAMES, SIZE, STEP = 15, (330, 280), math.radians(48.0)
"""Slow motions: number of frames, size in pixels, and rotation of the engine per frame in rad."""


def draw(data: ByEngine) -> Figures:
    if not engines_in(data):
        return {}
    return {
        "drivetrain-run-up": draw_run_up(data),
        "drivetrain-waterfall": draw_waterfall(data),
        "drivetrain-picture": draw_pictures(data),
    }


def draw_run_up(data: ByEngine) -> Figure:
    figure, (radius, slip) = new_figure(nrows=2, width=9.0, height=6.0, sharex=True, height_ratios=(3, 1))
    car = passenger_car()
    for engine in engines_in(data):
        found = data[engine]
        style: dict[str, Any] = {"color": engine_style(engine).colour, "lw": 0.0}
        band = envelope(found, MM * np.abs(centre(found["disc"])))
        radius.fill_between(*band, alpha=0.35, label=f"{engine}: smallest to largest", **style)
        slip.fill_between(*envelope(found, found["slip"]), alpha=0.5, **style)
    if "theory" in data:
        theory = data["theory"]
        speed, rest = theory["rest"].T
        radius.plot(speed / RPM, MM * rest, **curve("theory", "reference: at rest in space", linewidth=1.4))
        for sign, label in ((1.0, "with the unbalance"), (-1.0, "_")):
            swing = np.abs(rest + sign * theory["unbalance"])
            radius.plot(speed / RPM, MM * swing, **curve("theory", label, linestyle="--"))
        speed, whirl, _ = theory["whirl"].T
        look = curve("theory", "reference: whirl", color=plots.BLUE, linewidth=1.6)
        radius.plot(speed / RPM, MM * whirl, **look)
        for sign, label in ((1.0, "shifted by the offset"), (-1.0, "_")):
            look = curve("theory", label, color=plots.BLUE, linestyle="--")
            radius.plot(speed / RPM, MM * (whirl + sign * car.offset), **look)
        onset, k = theory["onset"] / RPM
        for panel in (radius, slip):
            panel.axvline(k, color=plots.GREY, lw=0.8, ls=":")
            panel.axvline(onset, color=plots.GREY, lw=0.8, ls="--")
        radius.annotate("$k$", (k, 0.9), (-3, 0), ha="right", textcoords="offset points")
        radius.annotate("onset", (onset, 0.9), (3, 0), textcoords="offset points")
    radius.set(ylabel="distance of the disc's centre\nfrom the engine's axis in mm", ylim=(0.0, 0.96))
    slip.set(xlabel="engine speed in rpm", ylabel="slip in rad/s", xlim=(800.0, 6000.0))
    radius.legend(loc="upper left", fontsize=9.0)
    return figure


def envelope(found: Data, values: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return speed (rpm), smallest and largest value for every two turns of the engine."""
    angle, speed = found["engine"].T
    starts = np.unique(np.floor(angle / (4.0 * math.pi)), return_index=True)[1]
    middle = np.add.reduceat(speed, starts) / np.diff(np.append(starts, len(speed)))
    return middle / RPM, np.minimum.reduceat(values, starts), np.maximum.reduceat(values, starts)


def draw_waterfall(data: ByEngine) -> Figure:
    """Draw the spectrum of x + iy against the engine's speed; backward motion has a negative frequency."""
    engine = engines_in(data)[0]
    figure, (panel,) = new_figure(width=9.5, height=5.4)
    speed, orders, amplitude = order_spectrum(data[engine])
    level = 20.0 * np.log10(np.maximum(amplitude, 1e-9) / 1e-6)
    frequency = orders[:, np.newaxis] * speed / (2.0 * math.pi)
    places = np.broadcast_to(speed / RPM, frequency.shape), frequency
    shades: dict[str, Any] = {"cmap": "magma", "vmin": 0.0, "vmax": 58.0, "shading": "gouraud"}
    mesh = panel.pcolormesh(*places, level, rasterized=True, **shades)
    figure.colorbar(mesh, label="amplitude in dB over 1 μm")
    across = np.array([speed[0], speed[-1]]) / RPM
    own = natural_frequency(passenger_car()) / (2.0 * math.pi)
    light: dict[str, Any] = {"color": "white", "lw": 0.8}
    panel.plot(across, across / 60.0, ls="--", **light)
    panel.plot(across, across / 30.0, ls=":", **light)
    panel.axhline(own, ls="-.", **light)
    for words, where in (
        ("engine, order 1", (2450.0, 24.0)),
        ("engine, order 2: firing", (2150.0, 107.0)),
        (r"natural frequency $k/2\pi$", (4900.0, own - 12.0)),
        ("at rest in space", (1700.0, 5.0)),
    ):
        panel.annotate(words, where, color="white")
    if "theory" in data:
        turns, _, whirl = data["theory"]["whirl"].T
        panel.plot(turns / RPM, whirl / (2.0 * math.pi), color=CYAN, lw=1.2)
        panel.annotate("whirl of the reference", (3000.0, 75.0), color=CYAN)
    panel.set(xlabel="engine speed in rpm", xlim=across)
    panel.set(ylabel="frequency in Hz (negative: backwards)", ylim=(-130.0, 200.0))
    panel.grid(visible=False)
    return figure


def draw_pictures(data: ByEngine) -> Figure:
    from exudyn_models.drivetrain.picture import draw_drivetrain

    found = data[engines_in(data)[0]]
    figure, panels = new_figure(ncols=len(SHOWN), width=11.0, height=3.4)
    look: dict[str, Any] = {"engine_angle": OPEN, "magnification": ENLARGED, "size": (660, 560)}
    for panel, turns in zip(panels, SHOWN, strict=True):
        _, disc = motion_at(found, time_of(found, turns))
        panel.imshow(draw_drivetrain(passenger_car(), disc=disc, **look))
        panel.set_axis_off()
        panel.set_title(f"{turns:.0f} rpm", loc="center")
    return figure


def time_of(found: Data, turns: float) -> float:
    """Return the time when the engine's speed without its ripple reaches ``turns`` (rpm)."""
    angle, times = found["engine"][:, 0], found["times"]
    smooth = np.polyfit(times, angle, 4)
    return float(np.interp(turns * RPM, np.polyval(np.polyder(smooth), times), times))


def motion_at(found: Data, time: float) -> tuple[float, FloatArray]:
    near = slice(*np.searchsorted(found["times"], [time - 0.01, time + 0.01]))
    times = found["times"][near]
    angle = float(CubicSpline(times, found["engine"][near, 0])(time))
    return angle, np.asarray(CubicSpline(times, found["disc"][near])(time))


def animations(data: ByEngine) -> dict[str, bytes]:
    """Draw slow motions at three speeds: the drivetrain, and the orbit of the disc's centre."""
    if not engines_in(data):
        return {}
    from exudyn_models.drivetrain.picture import draw_drivetrain

    found = data[engines_in(data)[0]]
    car = passenger_car()
    figure, (picture, orbit) = new_figure(ncols=2, width=7.6, height=3.5, width_ratios=(1.15, 1))
    around = np.exp(1j * np.linspace(0.0, 2.0 * math.pi, 121))
    x0 = MM * car.offset
    stop = x0 + MM * car.stop_gap * around
    orbit.plot(stop.real, stop.imag, color=plots.GREY, lw=0.8, label="play")
    orbit.plot([0.0], [0.0], "+", color=plots.BLACK, markersize=9.0, label="engine's axis")
    orbit.plot([x0], [0.0], "x", color=plots.GREY, markersize=7.0, label="shaft's axis")
    (trail,) = orbit.plot([], [], color=plots.ORANGE, lw=1.2)
    (dot,) = orbit.plot([], [], "o", color=plots.ORANGE, markersize=6.0)
    orbit.set(xlabel=axis("x", "mm"), ylabel=axis("y", "mm"), aspect="equal")
    orbit.set(xlim=(-0.75, 0.95), ylim=(-0.85, 0.85))
    orbit.legend(loc="lower center", ncols=3, fontsize=8.0, handlelength=1.0, columnspacing=0.8)
    stages = [(turns, time_of(found, turns)) for turns in SHOWN]
    image = picture.imshow(np.full((*SIZE[::-1], 3), 255, dtype=np.uint8))
    picture.set_axis_off()
    title = picture.set_title(" ", loc="center")

    def update(frame: int) -> None:
        turns, start = stages[frame // FRAMES]
        times = start + np.arange(frame % FRAMES + 1) * STEP / (turns * RPM)
        angle, disc = motion_at(found, times[-1])
        image.set_data(draw_drivetrain(car, engine_angle=angle, disc=disc, magnification=ENLARGED, size=SIZE))
        title.set_text(f"{turns:.0f} rpm")
        near = (found["times"] > start) & (found["times"] <= times[-1])
        z = MM * np.append(centre(found["disc"][near]), complex(*disc[:2]))
        trail.set_data(z.real, z.imag)
        dot.set_data([z[-1].real], [z[-1].imag])

    moving = (image, title, trail, dot)
    return {"drivetrain-turning": gif(figure, update, FRAMES * len(SHOWN), moving=moving, fps=12.0)}
