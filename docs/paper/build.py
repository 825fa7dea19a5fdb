"""Build the paper: ``python docs/paper/build.py``.

The figures come from ``report/``. The numbers come from ``docs/numbers.json``, which ``make findings`` writes. The
script also updates them in ``paper.md``, the paper about the software for the Journal of Open Source Software, where
a comment after each number names it.
"""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "docs")]
SOURCE = Path(__file__).with_name("paper.typ")
FIGURES = ROOT / "report" / "figures"
ABOUT_SOFTWARE = SOURCE.with_name("paper.md")
NUMBERS = ROOT / "docs" / "numbers.json"
NAMED = re.compile(r"[^\s(]+<!-- (.+?) -->")
"""A number in ``paper.md`` with its name in ``docs/numbers.json``."""
SMALLEST_LETTERS = 7.1
"""Size in pt of the smallest letters of a figure in print."""


def figures() -> list[str]:
    """Return the names of the figures in the paper."""
    return re.findall(r'#shown\("([^"]+)"', SOURCE.read_text(encoding="utf-8"))


def needed_width(svg: str) -> float:
    """Return the width in pt that a figure by Matplotlib needs for letters of ``SMALLEST_LETTERS``."""
    width = float(re.search(r'width="([\d.]+)pt"', svg)[1])
    sizes = [100.0 * float(size) for size in re.findall(r"scale\(([\d.]+) -\1\)", svg)]
    return width * SMALLEST_LETTERS / min(sizes)


def widths() -> dict[str, float]:
    """Return the needed width of each figure in pt."""
    return {name: needed_width((FIGURES / f"{name}.svg").read_text(encoding="utf-8")) for name in figures()}


def filled(text: str) -> str:
    """Return ``paper.md`` with the numbers of ``docs/numbers.json``."""
    numbers = json.loads(NUMBERS.read_text(encoding="utf-8"))
    return NAMED.sub(lambda found: f"{numbers[found[1]]['text']}<!-- {found[1]} -->", text)


def main() -> int:
    """Update ``paper.md``, write ``paper.pdf`` next to its source and return the exit status."""
    missing = [name for name in sorted(figures()) if not (FIGURES / f"{name}.svg").exists()]
    if missing:
        print(f"missing in {FIGURES}: {', '.join(missing)}; run make report first", file=sys.stderr)
        return 2
    ABOUT_SOFTWARE.write_text(filled(ABOUT_SOFTWARE.read_text(encoding="utf-8")), encoding="utf-8")
    import typst
    from cited import version

    written = SOURCE.with_suffix(".pdf")
    facts = {**version(), "widths": json.dumps(widths())}
    typst.compile(SOURCE, output=written, root=ROOT, sys_inputs=facts)
    print(written)
    return 0


if __name__ == "__main__":
    sys.exit(main())
