"""Figures."""

from compare.claims import ByEngine, Figures
from compare.output.figures import axis, curve, engines_in, new_figure, points
from compare.studies.drivetrain.joints.study import RATIO

PANELS = (
    ("stop t", "stop", "A joint stops"),
    ("ramp", "broken away", "A growing moment breaks it away"),
    ("half swings", "way", "Released on a spring"),
)


def draw(data: ByEngine) -> Figures:
    if not data:
        return {}
    figure, panels = new_figure(ncols=3, width=12.0, height=3.6)
    for panel, (x, y, title) in zip(panels, PANELS, strict=True):
        for engine in ("theory", *engines_in(data)):
            found = data.get(engine, {})
            if x in found and y in found:
                style = curve(engine, "closed form") if engine == "theory" else points(engine)
                panel.plot(found[x], found[y], **style)
        panel.set(title=title)
    stop, ramp, swings = panels
    stop.set(xlabel=axis("t", "s"), ylabel="spin in rad/s")
    ramp.set(xlabel=axis(r"M\,/\,F"), ylabel="spin in rad/s")
    ramp.axvline(RATIO, color="0.6", linewidth=0.8, linestyle=":")
    swings.set(xlabel=axis(r"t\,/\,(\pi\sqrt{J/C})"), ylabel=axis(r"\varphi\,/\,(F/C)"))
    swings.axhspan(-1.0, 1.0, color="#eeeeee", zorder=0.5)
    stop.legend(loc="upper right")
    return {"joints": figure}
