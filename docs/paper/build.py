"""Build the paper: ``python docs/paper/build.py``.

The figures come from ``report/``. The numbers come from ``docs/numbers.json``, which ``make findings`` writes.
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


def main() -> int:
    """Write ``paper.pdf`` next to its source and return the exit status."""
    missing = [name for name in sorted(figures()) if not (FIGURES / f"{name}.svg").exists()]
    if missing:
        print(f"missing in {FIGURES}: {', '.join(missing)}; run make report first", file=sys.stderr)
        return 2
    import typst
    from cited import version

    written = SOURCE.with_suffix(".pdf")
    facts = {**version(), "widths": json.dumps(widths())}
    typst.compile(SOURCE, output=written, root=ROOT, sys_inputs=facts)
    print(written)
    return 0


if __name__ == "__main__":
    sys.exit(main())
