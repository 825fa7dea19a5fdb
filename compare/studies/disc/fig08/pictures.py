"""Curves and figures."""

from dataclasses import replace
from typing import Any

import numpy as np

from compare.claims import ByEngine, Data, Figures
from compare.output.figures import GREY, PALETTE, Axes, Figure, axis, curve, engines_in, new_figure, points
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
    figure, (spin, distance, plane) = new_figure(ncols=3, width=13.2, height=4.2)
    own = f"{RING.offset:g}"
    if "theory" in data:
        _draw_theory(spin, distance, plane, data["theory"])
    for engine in engines_in(data):
        found = data[engine]
        if "six points" in found:
            spin.plot(found["load"], found["six points"][:, 2], **points(engine, f"{engine}, six points"))
        for name, look in (("ring", {"alpha": 0.55}), ("six points", {})):
            if name in found:
                ring = np.array([place_and_spin(with_load(RING, load)) for load in found["load"]])
                away = np.maximum(np.abs(found[name] - ring)[:, 2], np.finfo(float).eps)
                distance.plot(found["load"], away, **points(engine, f"{engine}, {name}", **look))
        if "ring" in found:
            plane.plot(*found["ring"][:, :2].T, **points(engine))
    for speed, name in ((RING.disc_speed, r"master disc, $\omega$"), (RING.shaft_speed, r"shaft, $\Omega$")):
        spin.axhline(speed, color=GREY, linewidth=0.8, linestyle=":")
        spin.annotate(name, (0.001, speed), (0, -11), textcoords="offset points", fontsize=9.5)
    load, speeds = axis(r"\mu N", "N"), (RING.shaft_speed - 0.02, RING.disc_speed + 0.02)
    spin.set(
        xlabel=load, ylabel=axis(r"\dot\varphi", "rad/s"), ylim=speeds, title=rf"Fig. 8, $X_0 = {own}$ m"
    )
    distance.set(xlabel=load, ylabel="difference in rad/s", yscale="log", ylim=(1e-16, 1.0))
    distance.set(title="Spin minus spin on the continuous ring")
    plane.set(xlabel=axis("x", "m"), ylabel=axis("y", "m"), aspect="equal", title="Positions of rest")
    plane.set(xlim=(-0.005, 0.105), ylim=(-0.005, 0.066))
    spin.legend(loc="upper left", bbox_to_anchor=(0.0, 0.89), fontsize=9.0)
    distance.axhline(RESOLUTION, color=GREY, linewidth=0.9, linestyle="--", label="resolution of ring")
    distance.legend(loc="upper center", bbox_to_anchor=(0.5, -0.18), fontsize=9.0, ncols=2)
    plane.legend(loc="lower center", fontsize=9.0)
    return figure


def _draw_theory(spin: Axes, distance: Axes, plane: Axes, found: Data) -> None:
    own = f"{RING.offset:g}"
    corrected = curve("theory", "(26), corrected", linestyle=(0.0, (5.0, 2.0)), linewidth=1.2)
    printed: dict[str, Any] = {"color": GREY, "linewidth": 0.8, "label": "(26), as printed"}
    spin.plot(found[f"ring load {own}"], found[f"ring {own}"][:, 2], **curve("theory", "continuous ring"))
    spin.plot(found[f"corrected load {own}"], found[f"corrected {own}"][:, 2], **corrected)
    spin.plot(found["printed load"], found["printed"][:, 2], **printed)
    loads = found["distance load"][1:]
    distance.plot(loads, found["distance corrected"][1:, 2], **corrected)
    distance.plot(loads, found["distance printed"][1:, 2], **printed)
    plane.plot(*found[f"ring {own}"][:, :2].T, **curve("theory", "semicircle (4)"))


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
