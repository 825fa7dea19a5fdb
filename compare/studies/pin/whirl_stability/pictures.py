"""Curves and figures."""

from typing import Any

import numpy as np

import compare.output.figures as plots
import compare.studies.pin.whirl_stability.study as study
from compare.claims import ByEngine, Data, Figures
from compare.claims.linearised_flow import real_and_imaginary
from compare.claims.parameters import CENTRED
from compare.output.figures import Axes, Figure, axis, curve, engines_in, new_figure, points
from compare.studies.pin.whirl_stability.study import DAMPINGS, DEVIATION_TIMES, RATIOS, K
from reference_model.formulas.pin import variational_matrix
from reference_model.steady.stability import whirl_eigenvalues


def curves() -> Data:
    speeds = K * (1.0 + np.geomspace(0.01, 6.0, 240))
    return {
        "speed": speeds,
        "eigenvalue": real_and_imaginary([whirl_eigenvalues(study.pin_at(speed))[1:] for speed in speeds]),
        "ratio": RATIOS,
        "damping": DAMPINGS,
        "largest": study.largest_real_parts()[0].reshape(len(DAMPINGS), len(RATIOS)) / K,
        "deviation_time": DEVIATION_TIMES,
        "deviation": study.linear_deviation(DEVIATION_TIMES),
    }


def draw(data: ByEngine) -> Figures:
    figures = {"whirl-motions": draw_motions(data)} if engines_in(data) else {}
    if "theory" in data:
        figures["whirl-eigenvalues"] = draw_eigenvalues(data)
        figures["whirl-map"] = draw_map(data["theory"])
    return figures


def draw_motions(data: ByEngine) -> Figure:
    figure, (leaving, decay) = new_figure(ncols=2, width=9.8, height=3.6)
    _draw_leaving(leaving, data)
    _draw_decay(decay, data)
    return figure


def _draw_leaving(panel: Axes, data: ByEngine) -> None:
    # Such motions end in stick, which not every engine simulates.
    drawn = [engine for engine in engines_in(data) if "leaving_time" in data[engine]]
    small: dict[str, Any] = {"textcoords": "offset points", "va": "center", "fontsize": 9.5}
    for engine in drawn:
        found, label = data[engine], engine
        times = found["leaving_time"]
        for speed, radius in zip(found["start"], found["leaving"], strict=True):
            if engine == drawn[0] and speed < K:
                end = times[-1], radius[-1] / radius[0]
                panel.annotate(rf"$\omega = {speed / K:g}\,k$", end, (5, 0), **small)
            panel.plot(times, radius / radius[0], **curve(engine, label))
            label = "_"
    last = max((float(data[engine]["leaving_time"][-1]) for engine in drawn), default=0.0)
    above = [speed / K for engine in drawn[:1] for speed in data[engine]["start"] if speed > K]
    if above:
        ratios = ", ".join(f"{ratio:g}" for ratio in above)
        panel.annotate(rf"$\omega = {ratios}\,k$", (6.0, 1.03), fontsize=9.5)
    panel.set(xlabel=axis("t", "s"), ylabel=r"$\rho\,/\,\rho_c$", title="Starts on the circle (11)")
    panel.set(xlim=(0.0, last + 3.6), ylim=(0.0, 1.15))
    panel.legend(loc="lower left")


def _draw_decay(panel: Axes, data: ByEngine) -> None:
    for engine in engines_in(data):
        panel.plot(data[engine]["history_time"], data[engine]["history"], **curve(engine))
    if "theory" in data:
        theory = data["theory"]
        panel.plot(theory["deviation_time"], theory["deviation"], **curve("theory", "eq. (12)"))
    times = DEVIATION_TIMES
    values, vectors = np.linalg.eig(variational_matrix(CENTRED))
    shares = np.abs(np.linalg.solve(vectors, np.array([1.0, K, 0.0])) * vectors[0])
    real = np.abs(values.imag) == 0.0
    middle = shares[real] * np.exp(values[real].real * times[:, np.newaxis])
    width = np.sum(shares[~real] * np.exp(values[~real].real * times[:, np.newaxis]), axis=1)
    envelope: dict[str, Any] = {"color": plots.GREY, "linewidth": 1.0}
    label = rf"real eigenvalue: $\propto \exp({values[real][0].real:.3f}\,t)$"
    panel.plot(times, middle, **envelope, linestyle="--", label=label)
    label = rf"pair of eigenvalues: $\propto \exp({values[~real][0].real:.3f}\,t)$"
    for sign in (1.0, -1.0):
        panel.plot(times, middle[:, 0] + sign * width, **envelope, linestyle=(0.0, (1.0, 1.0)), label=label)
        label = "_"
    panel.set(
        xlabel=axis("t", "s"),
        ylabel=r"$\xi\,/\,a$",
        xlim=(0.0, times[-1]),
        title=rf"Small deviation of the radius, $\omega = {CENTRED.disc_speed / K:g}\,k$",
    )
    panel.legend(loc="upper right", fontsize=9.0)


def draw_eigenvalues(data: ByEngine) -> Figure:
    figure, (decay, oscillation) = new_figure(ncols=2, sharex=True)
    theory = data["theory"]
    for panel, part, sign in ((decay, 0, -1.0), (oscillation, 1, 1.0)):
        for which in range(3):
            line = curve("theory", "eq. (12)" if which == 0 else "_")
            panel.plot(theory["speed"] / K, sign * theory["eigenvalue"][:, which, part] / K, **line)
        for engine in engines_in(data):
            found = data[engine]
            chosen = found["point"][:, 1] == CENTRED.damping
            speed = np.repeat(found["point"][chosen, 0], 4)
            panel.plot(speed / K, sign * found["eigenvalue"][chosen][..., part].ravel() / K, **points(engine))
        panel.set(xlabel=axis(r"\omega/k"), xscale="log", xlim=(1.0, 7.2))
        panel.set_xticks([1, 1.5, 2, 3, 4, 5, 7], ["1", "1.5", "2", "3", "4", "5", "7"])
        panel.minorticks_off()
    decay.set(yscale="log", ylim=(0.02, 20.0), ylabel=r"$-\mathrm{Re}\,\lambda\,/\,k$", title="Decay")
    decay.legend()
    oscillation.set(ylabel=r"$\mathrm{Im}\,\lambda\,/\,k$", title="Oscillation")
    return figure


def draw_map(theory: Data) -> Figure:
    from matplotlib.colors import SymLogNorm

    figure, (panel,) = new_figure(width=6.4, height=4.0)
    ratio, damping, largest = theory["ratio"], theory["damping"], theory["largest"]
    levels = [-0.5, -0.2, -0.1, -0.05, -0.02, 0.0, 0.02, 0.1, 0.5, 2.0, 10.0, 50.0]
    norm = SymLogNorm(linthresh=0.02, vmin=-2.0, vmax=200.0)
    for region in (ratio < 1.0, ratio > 1.0):  # the real part jumps at ω = k
        shown = ratio[region], damping, largest[:, region], levels
        shades = panel.contourf(*shown, norm=norm, cmap="Greys", extend="both")
        panel.contour(*shown, norm=norm, colors="black", linewidths=0.3)
    figure.colorbar(shades, ax=panel, label=r"$\max\,\mathrm{Re}\,\lambda\,/\,k$", format="%g", ticks=levels)
    fine = np.geomspace(damping[0], damping[-1], 400)
    q = (2.0 / fine) ** 2
    bound = q / (1.0 + q + np.hypot(1.0, q))  # (16): ω/(ω − k) = −bound
    panel.plot(bound / (1.0 + bound), fine, color=plots.ORANGE, linewidth=2.2, label="boundary (16)")
    panel.axvline(1.0, color=plots.BLUE, linewidth=2.2, linestyle="--", label=r"$\omega = k$")
    box = {"boxstyle": "round", "facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 0.25}
    panel.annotate("the whirl exists\nand is stable", (2.0, 0.5), ha="center", fontsize=10, bbox=box)
    panel.annotate("only roots of (13):\nno whirl exists", (0.5, 0.06), ha="center", fontsize=10, bbox=box)
    panel.set(xlabel=axis(r"\omega/k"), ylabel=r"$\beta\,/\,(m k)$", yscale="log", xlim=(0.01, 2.99))
    panel.grid(visible=False)
    panel.legend(loc="upper right", frameon=True, facecolor="white", edgecolor="none", framealpha=0.85)
    return figure
