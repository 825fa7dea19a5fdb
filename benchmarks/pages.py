"""Sections of the documentation that are written by benchmarks."""

from __future__ import annotations

import re
from pathlib import Path

DOCS = Path(__file__).parents[1] / "docs"


def write_into(page: str, program: str, text: str) -> None:
    """Write the results of ``program``, in this folder, into its section of a page.

    Raises
    ------
    ValueError
        If the page does not contain the section.

    """
    path = DOCS / page
    begin, end = f"<!-- written by benchmarks/{program} -->\n", "<!-- end -->"
    place = re.compile(f"({re.escape(begin)}).*?({re.escape(end)})", flags=re.DOTALL)
    written, count = place.subn(lambda found: found[1] + text + found[2], path.read_text("utf-8"))
    if not count:
        raise ValueError(f"{page} has no place for {program}: {begin}{end}")
    path.write_text(written, "utf-8")
