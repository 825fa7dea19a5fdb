"""Check the language of pages, docstrings and comments: ``python builders/check_prose.py [lower]``.

The check counts constructions that CONTRIBUTING.md advises against. ``prose_budget.txt`` lists how many a file may
contain; without an entry it is none. ``lower`` reduces the budgets to the present counts and never raises them.
"""

from __future__ import annotations

import ast
import re
import sys
import tokenize
from collections.abc import Iterator
from pathlib import Path

BUDGET = "builders/prose_budget.txt"
SKIPPED = {"build", "node_modules"}
PARAGRAPH = re.compile(r"(?m)^(?![|#<!])[ *>\d.-]*(\S.*(?:\n(?! *(?:[|#*-]|\d+\. )).*\S.*)*)")
MARKS = re.compile(
    r"^(?:Of|By|With|Without|Where|Whether|Who|Whoever|What|Beside|Below which|Above which|In which|For who)\b"
    r"|(?<=[.!?] )Of\b"
    r"|\bwhat (?!if\b)(?![^.]*\?)"
    r"|\b(?:of|by|to|with|in|from|at|on|for|under|over|through|after|before|behind) (?:which|whom|whose|what)\b"
    r"|(?<!here )\b(?:is|are|was|were) no (?!longer\b|more than\b)"
    r"|\b(?:anew|besides|thereby|tells|told)\b"
)
"""Openings with a preposition, what-clauses except in questions, and words that a native speaker would avoid."""


def texts(path: Path) -> Iterator[tuple[int, str]]:
    """Yield line numbers and texts: paragraphs of a page without code and tables, or docstrings and comments."""
    if path.suffix == ".md":
        page = re.sub(r"(?ms)^ *```.*?```", lambda code: "\n" * code[0].count("\n"), path.read_text("utf-8"))
        for found in PARAGRAPH.finditer(page):
            yield page.count("\n", 0, found.start(1)) + 1, found[1]
        return
    for node in ast.walk(ast.parse(path.read_bytes())):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            for found in re.finditer(r"(?s)\S.*?(?=\n\s*\n|\Z)", str(node.value.value)):
                yield node.lineno + str(node.value.value).count("\n", 0, found.start()), found[0]
    with tokenize.open(path) as file:
        for token in tokenize.generate_tokens(file.readline):
            if token.type == tokenize.COMMENT:
                yield token.start[0], token.string.lstrip("# ")


def hits(path: Path) -> list[str]:
    """Return the line and the sentence of each construction in a file."""
    found = []
    for line, text in texts(path):
        plain = re.sub(r"\s+", " ", re.sub(r"`+[^`]*`+|\]\([^)]*\)|\"[^\"]*\"", "…", text))
        for mark in MARKS.finditer(plain):
            start = plain.rfind(". ", 0, mark.start()) + 1
            found.append(f"\n  {line}: {re.split(r'(?<=[.!?]) ', plain[start:].strip())[0][:160]}")
    return found


def main(arguments: list[str], root: Path = Path(__file__).parents[1]) -> int:
    """Check all files, or lower the budgets; return the exit status."""
    table = root / BUDGET
    lines = table.read_text("utf-8").splitlines() if table.exists() else []
    budgets = {name: int(count) for count, name in map(str.split, lines)}
    files = [path.relative_to(root) for path in [*root.glob("[a-z]*/**/*.[pm][yd]"), *root.glob("*.md")]]
    found = {path.as_posix(): hits(root / path) for path in sorted(files) if not SKIPPED & {*path.parts}}
    if arguments == ["lower"]:
        caps = budgets if table.exists() else {name: len(each) for name, each in found.items()}
        kept = [(min(len(each), caps.get(name, 0)), name) for name, each in found.items()]
        table.write_text("".join(f"{count} {name}\n" for count, name in kept if count), "utf-8")
        return 0
    above = [name for name, each in found.items() if len(each) > budgets.get(name, 0)]
    for name in above:
        count, budget = len(found[name]), budgets.get(name, 0)
        print(f"{name}: {count} unclear constructions, budget {budget}", *found[name], sep="")
    if below := [name for name, budget in budgets.items() if len(found.get(name, ())) < budget]:
        print(f"below budget: {', '.join(below)}; run python builders/check_prose.py lower")
    return 1 if above else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
