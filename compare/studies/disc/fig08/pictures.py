"""Curves and figures."""

from dataclasses import replace
from typing import Any

import numpy as np

from compare.claims import ByEngine, Data, Figures
from compare.output.figures import (
    BLACK,
    GREY,
    PALETTE,
    Axes,
    Figure,
    axis,
    curve,
    engines_in,
    new_figure,
    points,
)
from compare.studies.disc.fig08.study import OFFSETS, PAPER_LAW, RESOLUTION, RING, place_and_spin
from compare.studies.toolkit.steady_motion import last_load, with_load
from reference_model.contact.contact_law import IsotropicContact
from reference_model.formulas.disc import positions_by_26, shaft_torque
from reference_model.systems import DiscOnDisc, FloatArray


def curves(count: int = 121) -> Data:
    def balanced(
        loads: FloatArray, disc: DiscOnDisc = RING, law: IsotropicContact | None = None
    ) -> FloatArray:
        return np.array([place_and_spin(with_load(disc, load), law) for load in loads])

    def printed(loads: FloatArray) -> FloatArray:
        return np.array([positions_by_26(with_load(RING, load), as_printed=True)[0] for load in loads])

    data: Data = {"offset": np.array(OFFSETS), "end offset": np.geomspace(0.002, 0.5, 61)}
    for offset in OFFSETS:
        disc = replace(RING, offset=offset)
        for name, law in (("ring", None), ("corrected", PAPER_LAW)):
            # Denser towards the end, where the spin rises steeply.
            loads = last_load(disc, law) * np.sin(np.linspace(0.0, 0.5 * np.pi, count))[:-1]
            data |= {f"{name} load {offset:g}": loads, f"{name} {offset:g}": balanced(loads, disc, law)}
    loads = np.linspace(0.0, 1.08 * last_load(RING), count)
    shared = data[f"ring load {RING.offset:g}"]
    shared = shared[shared < last_load(RING, PAPER_LAW)]
    return data | {
        "printed load": loads,
        "printed": printed(loads),
        "distance load": shared,
        "distance corrected": np.abs(balanced(shared, law=PAPER_LAW) - balanced(shared)),
        "distance printed": np.abs(printed(shared) - balanced(shared)),
        "end": np.array([last_load(replace(RING, offset=offset)) for offset in data["end offset"]]),
    }


def draw(data: ByEngine) -> Figures:
    offsets = {"fig08-offset": draw_offsets(data["theory"])} if "theory" in data else {}
    return {"fig08-spin": draw_spin(data)} | offsets if data else {}


def draw_spin(data: ByEngine) -> Figure:
    figure, (spin, distance) = new_figure(ncols=2, width=10.6, height=4.4)
    own = f"{RING.offset:g}"
    if "theory" in data:
        _draw_theory(spin, distance, data["theory"])
    for engine in engines_in(data):
        found = data[engine]
        if "six points" in found:
            spin.plot(found["load"], found["six points"][:, 2], **points(engine))
        for name in {"ring", "six points"} & set(found):
            ring = np.array([place_and_spin(with_load(RING, load)) for load in found["load"]])
            away = np.maximum(np.abs(found[name] - ring)[:, 2], np.finfo(float).eps)
            distance.plot(found["load"], away, **points(engine))
    for speed, name in ((RING.disc_speed, r"master disc, $\omega$"), (RING.shaft_speed, r"shaft, $\Omega$")):
        spin.axhline(speed, color=GREY, linewidth=0.8, linestyle=":")
        spin.annotate(name, (0.001, speed), (0, -11), textcoords="offset points", fontsize=9.5)
    load, speeds = axis(r"\mu N", "N"), (RING.shaft_speed - 0.02, RING.disc_speed + 0.02)
    spin.set(
        xlabel=load, ylabel=axis(r"\dot\varphi", "rad/s"), ylim=speeds, title=rf"Fig. 8, $X_0 = {own}$ m"
    )
    distance.set(xlabel=load, ylabel="difference in rad/s", yscale="log", ylim=(1e-16, 1.0))
    distance.set(title="Spin minus spin on the continuous ring")
    distance.axhline(RESOLUTION, color=GREY, linewidth=0.9, linestyle="--")
    for panel, words, place, colour in (
        (spin, "(26) as printed", (0.087, 0.636), GREY),
        (spin, "(26) corrected", (0.042, 0.672), BLACK),
        (spin, "ring", (0.047, 0.585), BLACK),
        (distance, "(26), corrected and as printed", (0.02, 5e-2), BLACK),
        (distance, "six points", (0.04, 2e-6), BLACK),
        (distance, "resolution of the claim", (0.0, 3e-10), GREY),
        (distance, "simulated ring", (0.04, 2e-12), BLACK),
    ):
        panel.text(*place, words, color=colour, fontsize=9.5)
    spin.legend(loc="center left", fontsize=9.5)
    return figure


def _draw_theory(spin: Axes, distance: Axes, found: Data) -> None:
    own = f"{RING.offset:g}"
    corrected = curve("theory", "", linestyle=(0.0, (5.0, 2.0)), linewidth=1.2)
    printed: dict[str, Any] = {"color": GREY, "linewidth": 0.8}
    spin.plot(found[f"ring load {own}"], found[f"ring {own}"][:, 2], **curve("theory", ""))
    spin.plot(found[f"corrected load {own}"], found[f"corrected {own}"][:, 2], **corrected)
    spin.plot(found["printed load"], found["printed"][:, 2], **printed)
    loads = found["distance load"][1:]
    distance.plot(loads, found["distance corrected"][1:, 2], **corrected)
    distance.plot(loads, found["distance printed"][1:, 2], **printed)


def draw_offsets(theory: Data) -> Figure:
    figure, (spin, end) = new_figure(ncols=2, width=9.8, height=3.9)
    for offset, colour in zip(theory["offset"], PALETTE, strict=False):
        ring, ring_load = theory[f"ring {offset:g}"], theory[f"ring load {offset:g}"]
        look: dict[str, Any] = {"color": colour, "linewidth": 1.4}
        spin.plot(ring_load, ring[:, 2], label=rf"$X_0 = {offset:g}$ m", **look)
        loads, corrected = theory[f"corrected load {offset:g}"], theory[f"corrected {offset:g}"]
        spin.plot(loads, corrected[:, 2], linestyle=(0.0, (4.0, 2.0)), **(look | {"linewidth": 1.0}))
        last = last_load(replace(RING, offset=float(offset)))
        spin.plot(last, RING.disc_speed, marker="o", color=colour, markersize=5.0)
        end.plot(offset, last, marker="o", color=colour, markersize=5.0, zorder=5.0)
    spin.plot([], [], color=GREY, linewidth=1.0, linestyle=(0.0, (4.0, 2.0)), label="(26), corrected")
    spin.set(xlabel=axis(r"\mu N", "N"), ylabel=axis(r"\dot\varphi", "rad/s"), title="Spin up to the end")
    spin.legend(loc="lower right")
    offsets = theory["end offset"]
    moment = shaft_torque(RING) / RING.contact_radius
    end.loglog(offsets, theory["end"], **curve("theory", "disc"))
    end.loglog(offsets, RING.stiffness * offsets, color=GREY, linewidth=1.0, label=r"pin (5), $C X_0$")
    end.axhline(moment, color=GREY, linewidth=1.0, linestyle=":", label=r"$b(\omega-\Omega)/R$")
    end.set(xlabel=axis("X_0", "m"), ylabel=axis(r"\mu N", "N"))
    end.set(title="Largest friction force with an equilibrium")
    end.legend(loc="upper left")
    return figure
