r"""Style of all figures: sizes, fonts, and a fixed colour, line and marker for each engine.

Example of a study's ``draw``::

    from compare.output.figures import curve, new_figure, points

    def draw(data):
        figure, (left, right) = new_figure(ncols=2)         # always a flat tuple, row by row
        if "theory" in data:
            left.plot(data["theory"]["load"], data["theory"]["radius"], **curve("theory", "eq. (3)"))
        for engine in engines_in(data):                     # without "theory", in a fixed order
            left.plot(data[engine]["load"], data[engine]["radius"], **points(engine))
        left.set(xlabel=axis(r"\mu N", "N"), ylabel=axis(r"\rho_*", "m"))
        left.legend()
        return {"fig03-radius": figure}

Formulas are thin black lines above the engines' broad lines (``curve``) or hollow marks (``points``), so coinciding
results remain visible. Import matplotlib only inside functions, because the command line must start without it.
"""

import io
import zlib
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

if TYPE_CHECKING:
    import matplotlib.axes
    import matplotlib.figure

Axes: TypeAlias = "matplotlib.axes.Axes"
Figure: TypeAlias = "matplotlib.figure.Figure"

BLACK = "#000000"
BLUE = "#0b4f7d"
ORANGE = "#d9730d"
GREEN = "#086d3f"
PURPLE = "#ce4bb8"
SKY = "#57b4ff"
GREY = "#888888"
PALETTE = (BLUE, ORANGE, GREEN, PURPLE, SKY, GREY)
"""Colours that differ in pairs for a deuteranope too, and whose neighbours also differ in grey."""

PANEL_WIDTH = 4.4
PANEL_HEIGHT = 3.3
"""Size of one panel in inches."""

PAPER: dict[Any, Any] = {
    "font.family": "STIXGeneral",
    "mathtext.fontset": "stix",
    "font.size": 11.0,
    "axes.labelsize": 12.0,
    "axes.titlesize": 11.0,
    "axes.titlelocation": "left",
    "axes.linewidth": 0.7,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "axes.grid": True,
    "grid.color": "#e4e4e4",
    "grid.linewidth": 0.6,
    "xtick.direction": "out",
    "ytick.direction": "out",
    "xtick.major.width": 0.7,
    "ytick.major.width": 0.7,
    "axes.prop_cycle": f"cycler(color={PALETTE})",
    "lines.linewidth": 1.3,
    "lines.markersize": 5.0,
    "legend.frameon": False,
    "legend.fontsize": 10.0,
    "figure.dpi": 100.0,
    "savefig.dpi": 200.0,
    "figure.facecolor": "white",
    "svg.fonttype": "path",  # the same letters on every machine
    "svg.hashsalt": "friction-discs",  # the same file from the same numbers
    "path.simplify_threshold": 0.2,
}


@dataclass(frozen=True)
class EngineStyle:
    """Colour, dash pattern, marker and line width of one engine."""

    colour: str
    line: str | tuple[float, tuple[float, ...]]
    marker: str
    width: float


_STYLES = {
    "theory": EngineStyle(BLACK, "-", "", 0.8),
    "reference": EngineStyle(BLUE, "-", "o", 2.4),
    "exudyn": EngineStyle(ORANGE, (0.0, (4.0, 2.0)), "x", 1.6),
    "exudyn-native": EngineStyle(GREEN, (0.0, (1.0, 1.2)), "s", 1.6),
}
_OTHERS = (
    EngineStyle(PURPLE, (0.0, (6.0, 1.5, 1.0, 1.5)), "^", 1.6),
    EngineStyle(SKY, (0.0, (2.0, 2.0)), "D", 1.6),
)


@contextmanager
def paper_style() -> Iterator[None]:
    """Apply ``PAPER`` to figures drawn and saved inside, and matplotlib's defaults, not the user's settings."""
    from matplotlib import style

    with style.context(["default", PAPER]):
        yield


def new_figure(
    ncols: int = 1,
    nrows: int = 1,
    *,
    width: float | None = None,
    height: float | None = None,
    **subplots: Any,
) -> tuple[Figure, tuple[Axes, ...]]:
    """Return a figure and its axes, row by row in a flat tuple.

    ``width`` and ``height`` are in inches; the defaults fit the number of panels. ``subplots`` are arguments of
    ``Figure.subplots``.
    """
    import matplotlib.figure
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    with paper_style():
        size = (width or ncols * PANEL_WIDTH + 0.6 * (ncols == 1), height or nrows * PANEL_HEIGHT)
        figure = matplotlib.figure.Figure(figsize=size, layout="constrained")
        FigureCanvasAgg(figure)
        return figure, tuple(figure.subplots(nrows, ncols, squeeze=False, **subplots).flat)


def engine_style(engine: str) -> EngineStyle:
    """Return the style of an engine or of "theory"."""
    return _STYLES.get(engine) or _OTHERS[zlib.crc32(engine.encode()) % len(_OTHERS)]


def curve(engine: str, label: str | None = None, **changes: Any) -> dict[str, Any]:
    """Return the arguments of ``Axes.plot`` for a line of ``engine``."""
    style = engine_style(engine)
    return {
        "color": style.colour,
        "linestyle": style.line,
        "linewidth": style.width,
        "zorder": 4.0 if engine == "theory" else 2.0 if engine == "reference" else 3.0,
        "label": label if label is not None else engine,
    } | changes


def points(engine: str, label: str | None = None, **changes: Any) -> dict[str, Any]:
    """Return the arguments of ``Axes.plot`` for hollow marks of ``engine`` without a line."""
    style = engine_style(engine)
    return {
        "color": style.colour,
        "linestyle": "none",
        "marker": style.marker or ".",
        "markerfacecolor": "none",
        "markersize": 7.0 if engine == "reference" else 5.5,
        "zorder": 3.0,
        "label": label if label is not None else engine,
    } | changes


def engines_in(data: Iterable[str]) -> tuple[str, ...]:
    """Return the engines among the keys of ``data``: reference, exudyn, then others by name."""
    names = [name for name in data if name != "theory"]
    order = list(_STYLES)
    return tuple(sorted(names, key=lambda name: (order.index(name) if name in order else len(order), name)))


def axis(symbol: str, unit: str = "") -> str:
    r"""Return the label of an axis, for example ``axis(r"\mu N", "N")``; omit the unit of dimensionless numbers."""
    return f"${symbol}$ in {unit}" if unit else f"${symbol}$"


def saved(figure: Figure) -> tuple[bytes, bytes]:
    """Return the figure as SVG and as PNG, reproducible to the byte."""
    png = io.BytesIO()
    with paper_style():
        figure.savefig(png, format="png", metadata={"Software": None})
    return as_svg(figure), png.getvalue()


def as_svg(figure: Figure) -> bytes:
    """Return the figure as SVG, reproducible to the byte."""
    from matplotlib.backends.backend_svg import FigureCanvasSVG

    svg = io.BytesIO()
    canvas: Any = FigureCanvasSVG(figure)
    with paper_style():  # faster than ``savefig``, which draws the figure twice
        figure.set_dpi(PAPER["savefig.dpi"])  # for rasterised parts
        canvas.print_svg(svg, metadata={"Date": None})
    return svg.getvalue()
