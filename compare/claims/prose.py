"""The prose of a study, which people read and edit as prose: ``fig04.md`` beside ``fig04.py``, or ``study.md``.

The first heading is the title; under it stands what the paper says. "## Finding" and "## Figures" may follow, the
latter with a heading for the name of each figure and its caption::

    # Branches under increasing friction force

    Fig. 6 shows the steady motions ...

    ## Figures

    ### fig06-branches

    Fig. 6 redrawn: ...
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

NAME = "study.md"
"""Of the prose in the folder of a study that has one."""

SECTIONS = {
    "pin": "The friction pin",
    "disc": "The friction disc",
    "plane": "A plane at rest",
    "drivetrain": "The drivetrain",
    "engines": "The engines",
}
"""Of the report, by the folder in which a study lies."""


@dataclass(frozen=True)
class Prose:
    """The texts of a study.

    Parameters
    ----------
    title : str
        A line.
    paper : str
        What the paper says, in a paragraph.
    section : str
        Heading under which the overview lists the study with its neighbours.
    finding : str
        What the paper leaves open and the study answers, for the first screen; shown while all claims agree.
    figures : mapping
        Caption for each figure and animation name.

    """

    title: str
    paper: str = ""
    section: str = ""
    finding: str = ""
    figures: Mapping[str, str] = field(default_factory=dict)

    @classmethod
    def of(cls, file: Path, words: Mapping[str, str]) -> Prose:
        """Return the prose of the module ``file``, in its folder, or in the folder above it.

        ``words`` stand in it for their names in braces. Raises ``ValueError`` for a file that is not as above.
        """
        places = (file.with_suffix(".md"), *(folder / NAME for folder in file.parents[:2]))
        path = next(place for place in places if place.is_file())
        text = path.read_text(encoding="utf-8")
        for name, word in words.items():
            if f"{{{name}}}" not in text:
                raise ValueError(f"{path} has no {{{name}}}")
            text = text.replace(f"{{{name}}}", word)
        parts = re.split(r"^(#+) +(.+)$", text, flags=re.MULTILINE)
        sections = [
            (depth, title.strip(), _paragraphs(body))
            for depth, title, body in zip(parts[1::3], parts[2::3], parts[3::3], strict=True)
        ]
        (depth, title, paper), *others = sections
        group = path.parents[path.name == NAME].name
        if depth != "#" or group not in SECTIONS:
            raise ValueError(
                f"{path} must begin with a title, and lie in {', '.join(SECTIONS)}, not {group!r}"
            )
        return cls(
            title,
            paper,
            SECTIONS[group],
            next((body for depth, title, body in others if (depth, title) == ("##", "Finding")), ""),
            {title: body for depth, title, body in others if depth == "###"},
        )


def _paragraphs(text: str) -> str:
    """Return paragraphs with a line each, and an empty one between them."""
    return "\n\n".join(" ".join(part.split()) for part in re.split(r"\n\s*\n", text.strip()))


@dataclass(frozen=True)
class Table:
    """Words and numbers in rows as long as ``header``, under a ``caption``."""

    caption: str
    header: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


def slug(words: str) -> str:
    """Return ``words`` as part of a name: small letters and digits, between hyphens."""
    return "-".join("".join(c if c.isalnum() else " " for c in words).lower().split())
