"""Write ``docs/equations.md``: who has which equation of the paper; run as ``python docs/write_equations.py``.

Functions are those of the reference whose docstrings cite an equation, claims those that are declared for it, and
what is wrong as printed is from the errata. A test tells when the table is out of date.
"""

import ast
import re
from pathlib import Path

from compare.claims.errata import ERRATA
from compare.studies import STUDIES

ROOT = Path(__file__).parents[1]
PAGE = Path(__file__).with_name("equations.md")

EQUATIONS = {
    1: "motion of the pin",
    2: "polar coordinates",
    3: "the self-centred equilibrium",
    4: "the circle on which it lies",
    5: "the greatest load with that equilibrium",
    6: "motion in stick",
    7: "friction needed to stick on a circle",
    8: "when it sticks for ever",
    9: "the circle in which it does",
    10: "motion of the pin in polar coordinates",
    11: "the whirl without offset",
    12: "small motions about it",
    13: "their characteristic polynomial",
    14: "Hurwitz: a first pair of conditions for stability",
    15: "Hurwitz: one that contradicts (14)",
    16: "Hurwitz: the one that is necessary and sufficient",
    17: "the whirl with a small offset: a circle beside the axis",
    18: "where its centre is",
    19: "motion of the disc",
    20: "friction on a ring",
    21: "slip of a point of the ring",
    22: "expansion of the slip speed",
    23: "simplified friction on a ring",
    24: "spherical coordinates of the self-centred disc",
    25: "abbreviations",
    26: "where it rests, by (23)",
}
"""What each is about."""

MOST = 4
"""Functions, and claims of a study, that are named."""

PREFERRED = ("plain", "formulas", "contact", "systems", "steady", "motion", "orbits")
"""Rooms of the reference in which one looks first."""

CITED = re.compile(r"\((\d+)\)(?:(?: to |–)\((\d+)\))?|\b[Ee]qs?\. (\d+(?:(?:, | and | to |–)\d+)*)")
ALIKE = re.compile(r"(\d+)(?:(?: to |–)(\d+))?")


def cited(text):
    """Return the numbers of equations that a text cites, "eq. 19 to 21" or "(14)–(16)"."""
    found = set()
    for first, last, listed in CITED.findall(text):
        for low, high in ALIKE.findall(listed) if listed else [(first, last)]:
            found |= set(range(int(low), int(high or low) + 1))
    return found & set(EQUATIONS)


def functions():
    """Return for each equation what is public in the reference and cites it: the module and the name."""
    found = {number: [] for number in EQUATIONS}
    for path in sorted((ROOT / "reference_model").rglob("*.py")):
        module = path.relative_to(ROOT)
        if "ensemble" in module.parts:  # the same once more, compiled
            continue
        tree = ast.parse(path.read_text(encoding="utf-8"))
        for node in tree.body:
            if not isinstance(node, (ast.FunctionDef, ast.ClassDef)) or node.name.startswith("_"):
                continue
            inside = [(f"{node.name}.", each) for each in node.body if isinstance(node, ast.ClassDef)]
            for owner, each in [("", node), *inside]:
                if isinstance(each, (ast.FunctionDef, ast.ClassDef)) and not each.name.startswith("_"):
                    numbers = cited(ast.get_docstring(each) or "")
                    for number in numbers:
                        found[number].append((len(numbers), module, owner + each.name))
    return {
        number: [(module, name) for _, module, name in sorted(set(each), key=_first)]
        for number, each in found.items()
    }


def _first(function):
    """Return the order of functions: as printed first, then those about few equations, then by their rooms."""
    numbers, module, name = function
    room = module.parts[1].removesuffix(".py")
    return (
        room != "plain",
        numbers,
        PREFERRED.index(room) if room in PREFERRED else len(PREFERRED),
        str(module),
        name,
    )


def claims():
    """Return for each equation the identities of the claims that are declared for it, by study."""
    found = {number: {} for number in EQUATIONS}
    for study in STUDIES:
        for declared in study.declared:
            for number in cited(declared.equation):
                known = found[number].setdefault(study.name, [])
                if (identity := declared.identity(study.name, "")) not in known:  # of a family once
                    known.append(identity)
    return found


def errata():
    """Return what is wrong as printed, by equation."""
    found = {}
    for erratum in ERRATA:
        for number in cited(erratum.equation):
            found.setdefault(number, []).append(erratum)
    return found


def text():
    """Return the page."""
    lines = [
        "# Equations",
        "",
        "Which function and which claim has each equation of the paper. `python docs/write_equations.py` writes this",
        "page from docstrings and declared claims. A claim is measured by `friction-discs report STUDY`, where STUDY",
        "stands before the stroke. What is wrong or incomplete as printed is [corrected](#corrected) below. (2),",
        "(24) and (25) define coordinates and abbreviations: no claim is about them.",
        "",
        "| | about | functions | claims |",
        "|---|---|---|---|",
    ]
    by_function, by_claim, wrong = functions(), claims(), errata()
    for number, about in EQUATIONS.items():
        named = [f"[`{name}`](../{path.as_posix()})" for path, name in by_function[number][:MOST]]
        claimed = []
        for identities in by_claim[number].values():
            more = len(identities) - MOST
            claimed.append(
                ", ".join(f"`{each}`" for each in identities[:MOST]) + (f" and {more} more" * (more > 0))
            )
        corrected = ", [corrected](#corrected)" * (number in wrong)
        lines.append(
            f"| ({number}) | {about}{corrected} | {', '.join(named) or '–'} | {'; '.join(claimed) or '–'} |"
        )
    lines += [
        "",
        "## Corrected",
        "",
        "`friction-discs errata` shows each of these with the numbers that prove it.",
    ]
    for erratum in ERRATA:
        lines += ["", f"**{erratum.heading}.** {erratum.explanation}", "", f"- as printed: {erratum.printed}"]
        lines += [f"- as it has to be: {erratum.correct}"]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    PAGE.write_text(text(), encoding="utf-8")
