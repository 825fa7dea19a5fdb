"""``badge.svg``: how many claims agree, for somebody's README."""

from __future__ import annotations

from html import escape

from compare.report.matrix import VERDICTS, Matrix, State

LABEL = "friction-discs"

GOOD, OPEN, BAD = "#1d5c38", "#7a5200", "#9c1c1c"
"""As in the page: white letters stand out from each of them by 6.9:1 at least."""

WIDTH, MARGIN = 6.6, 12.0
"""Of a letter, and of both sides together, in pixels."""


def badge(matrix: Matrix) -> str:
    """Return an SVG that says how many verdicts agree, and in its colour whether any differs or is open."""
    counts = matrix.totals
    words = f"{counts[State.AGREES]} of {sum(counts[state] for state in (*VERDICTS, State.FAILED))} agree"
    bad = counts[State.DIFFERS] + counts[State.FAILED]
    colour = BAD if bad else OPEN if counts[State.INCONCLUSIVE] or not counts[State.AGREES] else GOOD
    left, right = (round(WIDTH * len(text) + MARGIN) for text in (LABEL, words))
    said = escape(f"{LABEL}: {words}")
    size = f'width="{left + right}" height="20"'
    return f"""<svg xmlns="http://www.w3.org/2000/svg" {size} role="img" aria-label="{said}">
<title>{said}</title>
<rect {size} rx="3" fill="#333"/>
<path d="M{left} 0h{right - 3}a3 3 0 0 1 3 3v14a3 3 0 0 1 -3 3h-{right - 3}z" fill="{colour}"/>
<g fill="#fff" font-family="Verdana,DejaVu Sans,sans-serif" font-size="11" text-anchor="middle">
<text x="{left / 2:g}" y="14">{LABEL}</text>
<text x="{left + right / 2:g}" y="14">{escape(words)}</text>
</g>
</svg>
"""
