"""Build the paper: ``python docs/paper/build.py``.

The figures come from ``report/``. The numbers come from ``docs/numbers.json``, which ``make findings`` writes.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
SOURCE = Path(__file__).with_name("paper.typ")
FIGURES = ROOT / "report" / "figures"


def figures() -> list[str]:
    """Return the names of the figures in the paper."""
    return re.findall(r'#shown\("([^"]+)"', SOURCE.read_text(encoding="utf-8"))


def main() -> int:
    """Write ``paper.pdf`` next to its source and return the exit status."""
    missing = [name for name in figures() if not (FIGURES / f"{name}.svg").exists()]
    if missing:
        print(f"missing in {FIGURES}: {', '.join(missing)}; run make report first", file=sys.stderr)
        return 2
    import typst

    written = SOURCE.with_suffix(".pdf")
    typst.compile(SOURCE, output=written, root=ROOT)
    print(written)
    return 0


if __name__ == "__main__":
    sys.exit(main())
