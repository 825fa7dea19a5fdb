"""A baseline: which claims are known to fail, so that a server tells only of what is new.

A file for people to read and edit::

    {"format": "friction-discs baseline", "version": 1,
     "known": [{"claim": "fig05/slides", "engine": "mine", "state": "differs", "why": "issue 12"}]}
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

from compare.output.outside_text import all_printable
from compare.output.text_files import write_text
from compare.report.machines.comparison import Key

FORMAT, VERSION = "friction-discs baseline", 1


def read_baseline(path: Path) -> frozenset[Key]:
    """Return the claims, or studies, and engines that are known to fail.

    Raises ``ValueError`` for a file that is not there or is none.
    """
    try:
        content = all_printable(json.loads(path.read_text(encoding="utf-8")))
        if (content["format"], content["version"]) == (FORMAT, VERSION):
            return frozenset((str(one["claim"]), str(one["engine"])) for one in content["known"])
    except OSError as error:
        raise ValueError(f"can't read {str(path)!r}: {error.strerror}") from None
    except (ValueError, KeyError, TypeError):
        pass
    raise ValueError(f"{str(path)!r} is no baseline: diff --write-baseline writes one")


def write_baseline(path: Path, failures: Mapping[Key, str]) -> None:
    """Write the ``failures``, by claim or study and engine, with an empty reason to be filled in."""
    known = [
        {"claim": claim, "engine": engine, "state": state, "why": ""}
        for (claim, engine), state in sorted(failures.items())
    ]
    content = {"format": FORMAT, "version": VERSION, "known": known}
    write_text(path, json.dumps(content, indent=1, ensure_ascii=False) + "\n")
