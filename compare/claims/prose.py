"""Texts of a study, from a Markdown file next to its module, such as ``fig04.md``, or from ``study.md``.

The first heading is the title, followed by the statements of the paper. The sections "## Finding" and "## Figures"
are optional; "## Figures" contains the name of each figure as a heading, and its caption::

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

SECTIONS = {
    "pin": "The friction pin",
    "disc": "The friction disc",
    "plane": "A plane at rest",
    "drivetrain": "The drivetrain",
    "engines": "The engines",
}
"""Sections of the report by the folder that contains the study."""


@dataclass(frozen=True)
class Prose:
    """The texts of a study.

    ``title`` is one line, ``paper`` the statements of the paper, ``section`` the heading of the study's group.
    While all claims agree, the first screen shows ``finding``, the answer to a question that the paper leaves open.
    ``figures`` contains captions by the names of figures and animations.
    """

    title: str
    paper: str = ""
    section: str = ""
    finding: str = ""
    figures: Mapping[str, str] = field(default_factory=dict)

    @classmethod
    def of(cls, file: Path, words: Mapping[str, str]) -> Prose:
        """Return the texts of the module ``file``, from its folder or the folder above.

        ``words`` replace their names in braces. Raises ``ValueError`` if the file is not structured as above.
        """
        places = (file.with_suffix(".md"), *(folder / NAME for folder in file.parents[:2]))
        path = next(place for place in places if place.is_file())
        text = path.read_text(encoding="utf-8")
        for name, word in words.items():
            if f"{{{name}}}" not in text:
                raise ValueError(f"{path}: {{{name}}} is missing; add it or remove {name} from words")
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
                f"{path} must begin with a title, and its folder must be one of {', '.join(SECTIONS)}, not {group!r}"
            )
        return cls(
            title,
            paper,
            SECTIONS[group],
            next((body for depth, title, body in others if (depth, title) == ("##", "Finding")), ""),
            {title: body for depth, title, body in others if depth == "###"},
        )


def _paragraphs(text: str) -> str:
    return "\n\n".join(" ".join(part.split()) for part in re.split(r"\n\s*\n", text.strip()))


@dataclass(frozen=True)
class Table:
    """A table of texts with a caption."""

    caption: str
    header: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


def slug(words: str) -> str:
    """Return ``words`` as lower-case letters and digits, joined by hyphens."""
    return "-".join("".join(c if c.isalnum() else " " for c in words).lower().split())
