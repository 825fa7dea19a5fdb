"""How to cite this version, in BibTeX: ``python docs/cited.py``.

Version, date and commit come from the package and from git, all other facts from ``CITATION.cff``.
"""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

from compare.run.provenance import commit
from reference_model import __version__

ROOT = Path(__file__).parents[1]
CFF = (ROOT / "CITATION.cff").read_text(encoding="utf-8")


def date() -> str:
    """Return the date of the commit, "" outside a repository."""
    if not (ROOT / ".git").exists():
        return ""
    command = ["git", "-C", str(ROOT), "log", "-1", "--format=%cs"]
    return subprocess.run(command, capture_output=True, encoding="utf-8").stdout.strip()


def version() -> dict[str, str]:
    """Return version, date and commit; the last two are "" if they are unknown."""
    return {"version": __version__, "date": date(), "commit": commit()}


def field(name: str) -> str:
    """Return the first value of a field of ``CITATION.cff``."""
    found = re.search(rf'^ *(?:- )?{name}: "?(.*?)"?$', CFF, re.MULTILINE)
    if found is None:
        raise ValueError(f"CITATION.cff has no field {name!r}")
    return found[1]


def bibtex() -> str:
    """Return the entries of the software and of the paper that it verifies."""
    known = version()
    software = {
        "author": f"{{{field('name')}}}",
        "title": f"{{{field('title')}}}",
        "year": known["date"][:4],
        "version": known["version"],
        "date": known["date"],
        "note": f"commit {known['commit']}" if known["commit"] else "",
    }
    paper = CFF.partition("references:")[2]
    last, first = (re.findall(rf"{name}: (.*)", paper) for name in ("family-names", "given-names"))
    about = {key: re.search(rf'\b{key}: "?(.*?)"?$', paper, re.MULTILINE)[1] for key in (
        "title", "journal", "year", "volume", "start", "end",
    )}  # fmt: skip
    article = {
        "author": " and ".join(f"{a}, {b}" for a, b in zip(last, first, strict=True)),
        **{key: about[key] for key in ("title", "journal", "year", "volume")},
        "pages": f"{about['start']}--{about['end']}",
    }
    return "\n".join((_entry("software", "friction-discs", software), _entry("article", "fidlin", article)))


def _entry(kind: str, key: str, fields: dict[str, str]) -> str:
    lines = [f"  {name} = {{{value}}},\n" for name, value in fields.items() if value]
    return f"@{kind}{{{key},\n{''.join(lines)}}}\n"


if __name__ == "__main__":
    print(bibtex())
