"""Figure."""

import numpy as np

from compare.claims import ByEngine, Data, Figures
from compare.output.figures import GREY, Axes, axis, curve, engines_in, new_figure, points
from compare.studies.pin.sticking_domain.study import OUTSIDE, RESONANCE, predicted_turns


def draw(data: ByEngine) -> Figures:
    figure, (domain, time, error) = new_figure(ncols=3, width=12.6, height=3.7)
    if "theory" in data:
        domain.semilogy(data["theory"]["speed"], data["theory"]["radius"], **curve("theory", "eq. (9)"))
        _draw_release(time, data["theory"])
    for engine in engines_in(data):
        found = data[engine]
        speed = found["speed"]
        domain.semilogy(found["searched"], found["radius"], **points(engine, f"{engine}: bisection"))
        away = np.abs(found["turn"] - predicted_turns(speed))
        for i in range(len(OUTSIDE)):
            label = engine if i == 0 else "_"
            time.semilogy(speed, found["turn"][:, i] / speed, **points(engine, label))
            error.plot(speed, away[:, i], **points(engine, label))
        budget = curve(engine, f"{engine}: error budget", linewidth=1.0, linestyle="--")
        error.plot(speed, found["turn_error"][:, 0], **budget)
    domain.axvline(RESONANCE, color=GREY, linestyle=":", linewidth=1.0, label=r"$\omega_*$")
    for panel in (domain, time, error):
        panel.set(xlabel=axis(r"\omega", "rad/s"))
    domain.set(ylabel=axis("A", "m"), title="Largest radius of permanent stick")
    domain.legend()
    time.set(ylabel=axis("t_r", "s"), title="Time until release")
    error.set_yscale("symlog", linthresh=1e-16)
    error.set_yticks([0.0, *10.0 ** np.arange(-16.0, 1.0, 4.0)])
    error.set(ylabel=axis(r"|\Delta(\omega\,t_r)|", "rad"), ylim=(-5e-17, 1.0))
    error.set(title="Deviation of the turn until release from (7)")
    for panel, place in ((time, (0.62, 0.7)), (error, (0.2, 0.24))):
        if panel.get_legend_handles_labels()[0]:
            panel.legend(loc=place)
    return {"sticking-domain": figure}


def _draw_release(panel: Axes, theory: Data) -> None:
    speed = theory["speed"]
    middle = int(np.argmin(np.abs(speed - 1.75)))
    for i, share in enumerate(OUTSIDE):
        release = theory["turn"][:, i] / speed
        panel.semilogy(speed, release, **curve("theory", "eq. (7)" if i == 0 else "_"))
        panel.annotate(
            rf"start at {share:g} $A$",
            (speed[middle], release[middle]),
            (2, 8) if i == 0 else (-4, -8),
            textcoords="offset points",
            ha="left" if i == 0 else "right",
            va="bottom" if i == 0 else "top",
            fontsize=9.5,
        )
