"""Notebooks of the gallery, generated from the examples; Sphinx executes them for the site."""

from __future__ import annotations

import ast
import re
from pathlib import Path

EXAMPLES = Path(__file__).parents[2] / "examples"
DRAWN = 'from IPython.display import Image\n\ndraw("picture.png")\nImage("picture.png")\n'


def notebooks() -> dict[str, str]:
    """Return the examples in jupytext's percent format by name."""
    return {path.stem: notebook(path.name, path.read_text("utf-8")) for path in sorted(EXAMPLES.glob("*.py"))}


def notebook(name: str, source: str) -> str:
    """Return an example as a notebook that shows the docstring as text and the picture below the results.

    Statements of the main part that depend on arguments of the command line are left out.
    """
    tree, lines = ast.parse(source), source.splitlines()
    about, *body, main = tree.body
    text = f"# {name}\n\n{ast.get_docstring(tree)}\n\nThis notebook is generated from `examples/{name}`.\n"
    code = re.sub(r"(?m)^import sys\n", "", "\n".join(lines[about.end_lineno : main.lineno - 1]))
    parts = ["\n".join(lines[each.lineno - 1 : each.end_lineno]) for each in main.body]
    results = "\n".join(part for part in parts if "sys.argv" not in part)
    cells = [code, re.sub(r"(?m)^    ", "", results)]
    cells += [DRAWN for each in body if getattr(each, "name", "") == "draw"]
    described = "".join(f"# {line}\n" for line in ("%% [markdown]", *text.splitlines()))
    return described + "".join(f"# %%\n{cell.strip()}\n" for cell in cells if cell.strip())


def linked(gallery: str, names: list[str]) -> str:
    """Return the page of the gallery with links to the notebooks and to their files."""
    for name in names:
        links = f'([notebook](notebooks/{name}.py), <a href="notebooks/{name}.ipynb" download>download</a>)'
        gallery = gallery.replace(
            f"(source/examples/{name}.py.md)**", f"(source/examples/{name}.py.md)** {links}"
        )
    places = "\n".join(f"notebooks/{name}" for name in names)
    return f"{gallery}\n```{{toctree}}\n:hidden:\n\n{places}\n```\n"
