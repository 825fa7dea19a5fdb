"""Names that somebody types, of which one may be meant where there is none."""

from __future__ import annotations

import difflib
from collections.abc import Iterable


def one_of(kind: str, name: str, names: Iterable[str]) -> str:
    """Return ``name`` if it is among ``names``; raise ``ValueError`` that suggests the nearest otherwise."""
    names = list(names)
    if name in names:
        return name
    nearest = difflib.get_close_matches(name, names, n=1, cutoff=0.4)
    hint = f"did you mean {nearest[0]!r}?" if nearest else f"known are {', '.join(names)}"
    raise ValueError(f"unknown {kind} {name!r}: {hint}")
