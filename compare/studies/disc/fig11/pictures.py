"""Curves and figures."""

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import CubicSpline

import compare.output.figures as plots
import compare.studies.disc.fig11.theory as theory
from compare.claims import ByEngine, Data, Figures
from compare.output.figures import Axes, Figure, axis, curve, engine_style, engines_in, new_figure, points
from compare.studies.disc.fig11.theory import TIMES, disc_at, extents
from compare.studies.toolkit.fig11 import DISCS, RING, START, integrated
from reference_model import Orbit, self_centred_equilibria, simulate, whirl_orbit
from reference_model.systems import FloatArray

BRANCH = np.array(
    [*np.linspace(0.0, 0.015, 11), 0.016, 0.0166, 0.0175, 0.0185, 0.0192, 0.0196, 0.0198, 0.0199, 0.01993]
)
"""X0 in m of the whirls, up to the fold at 0.019930 m, where the equilibrium is stable."""

K = RING.natural_frequency

EXPANDED = "(23)"

ENLARGED = 20.0  # factor on x in the paper's figure

SIDE_BANDS = 5

SETTLED = 230.0  # start of sections and spectra in s

X0_AXIS = 0.025


def curves(whirling: ArrayLike = BRANCH) -> Data:
    found = theory.whirls_by_law()
    return {
        "eigenvalues": np.array([(whirl.eigenvalue.real, whirl.eigenvalue.imag) for whirl in found]),
        "whirls": np.array([(whirl.radius, whirl.state[-1]) for whirl in found]),
        "modulation": theory.predicted_modulation()[0],
        "cycle": integrated(RING, START, theory.UNTIL, len(TIMES), 1e-12),
        "(23)": simulate(RING, START, TIMES, tolerance=1e-8, contact=theory.EXPANSION).states,
        **branches(whirling),
    }


def branches(whirling: ArrayLike) -> Data:
    critical, last = theory.critical_offset_of_reference(), theory.rest_offset()
    orbits: list[Orbit] = []
    offsets = np.sort(np.append(whirling, critical))
    for offset in offsets:
        guess = orbits[-1].from_the_right() if orbits else None
        orbits.append(whirl_orbit(disc_at(float(offset)), guess=guess, tolerance=1e-9, samples=64))
    resting = np.sort([*np.linspace(0.0005, 0.025, 50), last])
    rest = [self_centred_equilibria(disc_at(float(offset)))[0] for offset in resting]
    return {
        "whirl: offset": offsets,
        "whirl: extents": np.array([extents(orbit.trajectory) for orbit in orbits]),
        "rest: offset": resting,
        "rest: place": np.array([(math.hypot(state.x, state.y), state.spin) for state in rest]),
        "critical offset": np.array(critical),
        "rest offset": np.array(last),
    }


def draw(data: ByEngine) -> Figures:
    figures = {"fig11-history": draw_histories(data)} if data else {}
    if any(words in data[engine] for engine in engines_in(data) for words in DISCS):
        figures["fig11-section"] = draw_section(data)
        figures["fig11-growth"] = draw_growth(data)
    if "theory" in data:
        figures["fig11-offset"] = draw_offsets(data)
    return figures


def histories(data: ByEngine, words: str) -> dict[str, FloatArray]:
    return {name: data[name][words] for name in (*engines_in(data), "theory") if words in data.get(name, {})}


def draw_histories(data: ByEngine) -> Figure:
    figure, panels = new_figure(
        ncols=3, nrows=2, width=13.0, height=6.0, sharex=True, sharey="row", height_ratios=(3, 2)
    )
    for column, words in enumerate(("six points", "the continuous ring", EXPANDED)):
        both, alone = panels[column], panels[3 + column]
        for rank, (name, states) in enumerate(histories(data, words).items()):
            who = "reference" if name == "theory" else name
            if rank == 0:
                x, spin = ENLARGED * states[:, 0], states[:, 5]
                both.plot(TIMES, x, color=plots.GREEN, linewidth=0.7, label=r"$20\,x$ in m")
                both.plot(TIMES, spin, color=plots.BLACK, linewidth=2.6, label=r"$\dot\varphi$ in rad/s")
                alone.plot(TIMES, spin, color=plots.BLACK, linewidth=1.6, label=who)
                times = data[name].get(f"{words}: rests", np.zeros(0)).reshape(-1, 2).mean(axis=1)
                if times.size:
                    rests = times, np.interp(times, TIMES, states[:, 5])
                    alone.plot(*rests, "o", color=plots.PURPLE, zorder=5.0, label="a point rests")
            else:
                sparse = slice(40 * (rank - 1), None, 80)
                alone.plot(TIMES[sparse], states[sparse, 5], **points(who))
        both.set_title(words[:1].upper() + words[1:] + (", reference only" if words == EXPANDED else ""))
        alone.set(xlabel=axis("t", "s"), xlim=(0.0, TIMES[-1]))
        if alone.lines:
            alone.legend(loc="upper right", ncols=3, borderaxespad=0.1)
    panels[0].set(ylabel=r"$\dot\varphi$ and $20\,x$", ylim=(-0.95, 1.95))
    panels[3].set(ylabel=axis(r"\dot\varphi", "rad/s"), ylim=(1.36, 1.437))
    if panels[0].lines:
        panels[0].legend(loc="upper right", ncols=2, borderaxespad=0.1)
    return figure


def draw_section(data: ByEngine) -> Figure:
    figure, (lines, sections) = new_figure(ncols=2, width=13.0, height=4.2)
    draw_spectrum(lines, data)
    if "theory" in data:
        x, y, _, _, _, spin = data["theory"]["cycle"][TIMES > SETTLED].T
        sections.plot(np.hypot(x, y), spin, **curve("theory", "whole cycle on the ring"))
        cross: Any = {"linestyle": "none", "marker": "+", "markersize": 9.0, "markeredgewidth": 1.8}
        on_ring, _, by_23 = data["theory"]["whirls"]
        sections.plot(*on_ring, color=plots.BLACK, label="unstable whirl", **cross)
        sections.plot(*by_23, color=plots.PURPLE, label="stable whirl by (23)", **cross)
    for name, states in histories(data, "the continuous ring").items():
        sections.plot(*section(states), **points(name, f"{name}, ring", markersize=4.0))
    for name, states in [*histories(data, "six points").items()][:1]:
        small: Any = {"color": plots.GREY, "markersize": 3.0, "zorder": 1.0}
        sections.plot(*section(states), ".", label=f"{name}, six points", **small)
    if "theory" in data:
        dots = section(data["theory"][EXPANDED], 0.0)
        sections.plot(*dots, ".-", color=plots.PURPLE, markersize=2.0, linewidth=0.5)
    sections.set(xlabel=axis(r"\rho", "m"), ylabel=axis(r"\dot\varphi", "rad/s"))
    sections.set(title="Section $y=0$, $x>0$: once a turn")
    if sections.lines:
        sections.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=9.0)
    return figure


def draw_spectrum(panel: Axes, data: ByEngine) -> None:
    floor = 1e-4
    for name, states in [*histories(data, "six points").items()][:1]:
        frequency, amplitude = spectrum(states[TIMES > SETTLED])
        style: dict[str, Any] = {"color": plots.GREY, "linewidth": 1.0}
        panel.semilogy(frequency / K, amplitude, label=f"{name}, six points (Hann window)", **style)
    if "theory" in data:
        period, turn = data["theory"]["modulation"][:2]
        carrier, modulation = turn / period / K, 2.0 * math.pi / period / K
        lines = carrier + modulation * np.arange(-SIDE_BANDS, SIDE_BANDS + 1)
        for rank, (name, states) in enumerate(histories(data, "the continuous ring").items()):
            heights = harmonics(states, period, turn / period)
            panel.semilogy(lines, heights, **points(name, f"{name}, ring"))
            if rank == 0:
                panel.vlines(lines, floor, heights, color=engine_style(name).colour, linewidth=1.0)
                top = float(np.max(heights))
                style = {"textcoords": "offset points", "ha": "center", "fontsize": 9.5}
                panel.annotate(f"carrier {carrier:.4f} $k$", (carrier, top), (0, 26), **style)
                between = (carrier + modulation, 1.6 * top), (carrier, 1.6 * top)
                panel.annotate("", *between, arrowprops={"arrowstyle": "<->", "linewidth": 0.8})
                where = carrier + 1.1 * modulation, 1.5 * top
                panel.annotate(rf"$2\pi/T$, $T$ = {period:.1f} s", where, fontsize=9.5, va="center")
    panel.set(xlabel=r"frequency of $x + \mathrm{i}y$ divided by $k$", ylabel="amplitude in m")
    panel.set(xlim=(0.83, 1.17), ylim=(floor, 0.4), title="Carrier and side bands")
    if panel.lines:
        panel.legend(loc="upper left", fontsize=9.0)


def spectrum(states: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return angular frequencies (rad/s) near k and amplitudes of x + iy (m), with a Hann window."""
    window = np.hanning(len(states))
    padded = 8 * len(states)
    amplitude = np.abs(np.fft.fft(window * (states[:, 0] + 1j * states[:, 1]), padded)) / np.sum(window)
    frequency = 2.0 * math.pi * np.fft.fftfreq(padded, TIMES[1])
    order = np.argsort(frequency)
    near = order[np.abs(frequency[order] / K - 1.0) < 0.3]
    return frequency[near], amplitude[near]


def harmonics(states: FloatArray, period: float, carrier: float) -> FloatArray:
    """Return the amplitudes (m) of x + iy at the carrier and its side bands, shape (2·SIDE_BANDS + 1,).

    The cycle is periodic in axes that turn with the carrier.
    """
    times = TIMES[-1] - period + period * np.arange(4096) / 4096.0
    z = CubicSpline(TIMES, states[:, 0] + 1j * states[:, 1])(times) * np.exp(-1j * carrier * times)
    coefficients = np.fft.fft(z) / len(z)
    return np.abs(coefficients[np.arange(-SIDE_BANDS, SIDE_BANDS + 1)])


def section(states: FloatArray, after: float = SETTLED) -> tuple[FloatArray, FloatArray]:
    """Return radius (m) and spin (rad/s) at each crossing of the positive x axis later than ``after`` (s)."""
    x, y, spin = (CubicSpline(TIMES, states[:, i]) for i in (0, 1, 5))
    crossings = y.roots(extrapolate=False)
    crossings = crossings[(x(crossings) > 0.0) & (crossings > after)]
    return x(crossings), spin(crossings)


def draw_growth(data: ByEngine) -> Figure:
    figure, panels = new_figure(ncols=2, width=10.5, height=3.8, sharey=True)
    for row, (panel, words) in enumerate(zip(panels, DISCS, strict=True)):
        for name in engines_in(data):
            if f"{words}: departure" in data[name]:
                times, sizes = data[name][f"{words}: departure"].T
                panel.semilogy(times, sizes, **curve(name))
        if "theory" in data:
            rate, frequency = data["theory"]["eigenvalues"][row]
            times = np.array([0.0, 640.0 if row == 0 else 440.0])
            style = curve("theory", rf"$\propto \exp({rate:.5f}\,t)$, linearised", linewidth=1.2)
            panel.semilogy(times, 5e-4 * np.exp(rate * times), **style)
            value = rf"$\lambda = {rate:.5f} \pm {frequency:.5f}\,\mathrm{{i}}$ 1/s"
            panel.annotate(value, (0.97, 0.30), xycoords="axes fraction", ha="right")
        panel.set(xlabel=axis("t", "s"), title=words[:1].upper() + words[1:], xlim=(0.0, None))
        if panel.lines:
            panel.legend(loc="lower right", fontsize=9.0)
    panels[0].set_ylabel("deviation from the whirl,\nrelative to its radius")
    return figure


def draw_offsets(data: ByEngine) -> Figure:
    figure, panels = new_figure(ncols=2, width=11.5, height=4.2)
    theory = data["theory"]
    critical, rest = float(theory["critical offset"]), float(theory["rest offset"])
    for panel, place, top in ((panels[0], 0, 0.0475), (panels[1], 1, 1.437)):
        both = slice(2 * place, 2 * place + 2)
        offsets = theory["whirl: offset"]
        look = curve("theory", linewidth=1.4)
        for label, dash, shown in (
            ("whirl", "-", offsets >= critical),
            ("whirl, unstable", ":", offsets <= critical),
        ):
            look |= {"label": (label, "_"), "linestyle": dash}
            panel.plot(offsets[shown], theory["whirl: extents"][shown, both], **look)
        offsets = theory["rest: offset"]
        for label, dash, shown in (
            ("self-centred equilibrium", "-", offsets >= rest),
            ("the same, unstable", ":", offsets <= rest),
        ):
            look = curve("theory", label, color=plots.GREY, linewidth=1.8, linestyle=dash)
            panel.plot(offsets[shown], theory["rest: place"][shown, place], **look)
        for engine in engines_in(data):
            if "extents" in data[engine]:
                ends = data[engine]["extents"][:, both]
                panel.plot(np.repeat(data[engine]["offsets"], 2), ends.ravel(), **points(engine))
        for middle, words in (
            (0.5 * critical, "modulated"),
            (0.5 * (critical + rest), "steady whirl"),
            (0.5 * (rest + X0_AXIS), "rest"),
        ):
            panel.annotate(words, (middle, top), ha="center", va="center", fontsize=10.5)
        for offset in (critical, rest):
            panel.axvline(offset, color=plots.GREY, linewidth=0.8, linestyle="--")
        panel.set(xlabel=axis("X_0", "m"), xlim=(0.0, X0_AXIS))
    panels[0].set(ylabel=axis(r"\rho", "m") + ", smallest and largest", ylim=(0.0, 0.05))
    panels[1].set(ylabel=axis(r"\dot\varphi", "rad/s") + ", smallest and largest", ylim=(1.325, 1.442))
    panels[0].legend(loc="upper center", bbox_to_anchor=(0.61, 0.92), fontsize=9.0)
    return figure
