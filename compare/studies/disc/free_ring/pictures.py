"""Figures."""

import numpy as np

from compare.claims import ByEngine, Figures
from compare.output.figures import GREY, curve, engines_in, new_figure, points
from compare.studies.disc.free_ring.theory import deviation

LEAST_DEVIATION = 1e-8
"""Smallest |ln U/W| in the figure; smaller values show an engine's tolerance."""


def draw(data: ByEngine) -> Figures:
    if not data:
        return {}
    figure, (plane, approach, ratio) = new_figure(ncols=3, width=13.2, height=4.2)
    plane.plot([0.0, 0.7], [0.0, 0.7], color=GREY, linewidth=1.0, linestyle=":", label="ratio 1")
    law = np.linspace(0.0, 22.0, 101)
    approach.semilogy(law, deviation(law), **curve("theory", r"$8\,e^{-2}\exp(-\tau/t)$"))
    if "theory" in data:
        ratio.loglog(data["theory"]["inertia"], data["theory"]["ratio"], **curve("theory", "closed form"))
    for engine in engines_in(data):
        found = data[engine]
        style = curve(engine)
        for sliding, rim, place in zip(found["sliding"], found["rim"], found["approach"], strict=True):
            largest = np.hypot(sliding[0], rim[0])
            plane.plot(rim / largest, sliding / largest, **style)
            away = np.abs(np.log(sliding / rim))
            seen = (away > LEAST_DEVIATION) & (place > 0.0)
            approach.semilogy(place[seen], away[seen], **style)
            style |= {"label": "_"}
        ends = [*found["ratio"], found["ratio of rings"]]
        ratio.plot([*found["inertia"], 1.0], ends, **points(engine))
    plane.set(xlabel=r"$R\,|\dot\varphi|\,/\,v_0$", ylabel=r"$|v|\,/\,v_0$", aspect="equal")
    plane.set(xlim=(0.0, 1.02), ylim=(0.0, 1.02), title=r"Speeds of rim and centre, $J = mR^2$")
    approach.set(title=r"Approach to the ratio 1, $J = mR^2$")
    approach.set(xlabel=r"$\tau\,/\,t$, $t$: time until the ring rests", xlim=(0.0, 22.0))
    approach.set(ylabel=r"$|\ln(|v|\,/\,R\dot\varphi)|$", ylim=(LEAST_DEVIATION, 20.0))
    ticks = [0.5, 0.7, 1.0, 1.4, 2.0]
    ratio.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    values = [0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0]
    ratio.set_yticks(values, [f"{value:g}" for value in values])
    ratio.minorticks_off()
    for limit in (0.5, 2.0):
        ratio.axvline(limit, color=GREY, linewidth=0.9, linestyle="--")
    ratio.annotate(r"$\infty$", (0.46, 5.0), ha="center", fontsize=13)
    ratio.annotate("0", (2.2, 0.19), ha="center", fontsize=12)
    ratio.set(xlabel=r"$J\,/\,mR^2$", ylabel=r"final $|v|\,/\,R\dot\varphi$", title="Final ratio")
    ratio.set(xlim=(0.42, 2.4), ylim=(0.1, 10.0))
    plane.legend(loc="upper right")
    approach.legend(loc="upper right")
    ratio.legend(loc="lower left", bbox_to_anchor=(0.13, 0.05))
    return {"free-ring": figure}
