"""Write ``docs/equations.md``, a table of functions and claims by equation: ``python docs/write_equations.py``.

The functions are those of the reference whose docstrings cite the equation. The claims are those declared for it, and
the corrections come from the errata. A test fails if the page is out of date.
"""

import ast
import re
from pathlib import Path

from compare.claims.errata import ERRATA, TEXT
from compare.studies import STUDIES

ROOT = Path(__file__).parents[1]
PAGE = Path(__file__).with_name("equations.md")

EQUATIONS = {
    1: "motion of the pin",
    2: "polar coordinates",
    3: "the self-centred equilibrium",
    4: "the circle of these equilibria",
    5: "the largest load with that equilibrium",
    6: "motion in stick",
    7: "friction needed to stick on a circle",
    8: "the condition for permanent stick",
    9: "the radius of permanent stick",
    10: "motion of the pin in polar coordinates",
    11: "the whirl without offset",
    12: "small deviations from the whirl",
    13: "their characteristic polynomial",
    14: "Hurwitz: first pair of stability conditions",
    15: "Hurwitz: a condition that contradicts (14)",
    16: "Hurwitz: the necessary and sufficient condition",
    17: "the whirl with a small offset: an eccentric circle",
    18: "the centre of this circle",
    19: "motion of the disc",
    20: "friction on a ring",
    21: "slip of a point of the ring",
    22: "expansion of the slip speed",
    23: "simplified friction on a ring",
    24: "spherical coordinates of the self-centred disc",
    25: "abbreviations",
    26: "equilibrium position according to (23)",
}
"""Subject of each equation."""

MOST = 4
"""Largest number of functions, and of claims per study, in a row."""

PREFERRED = ("plain", "formulas", "contact", "systems", "steady", "motion", "orbits")
"""Modules of the reference, the most useful first."""

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
    """Return the module and the name of each public object of the reference that cites an equation."""
    found = {number: [] for number in EQUATIONS}
    for path in sorted((ROOT / "reference_model").rglob("*.py")):
        module = path.relative_to(ROOT)
        if "ensemble" in module.parts:  # compiled copies
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
    """Return the sort key: equations as printed, then functions that cite few equations, then by module."""
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
    """Return the identities of the claims declared for each equation, by study."""
    found = {number: {} for number in EQUATIONS}
    for study in STUDIES:
        for declared in study.declared:
            for number in cited(declared.equation):
                known = found[number].setdefault(study.name, [])
                if (identity := declared.identity(study.name, "")) not in known:  # one of a family
                    known.append(identity)
    return found


def errata():
    """Return the errata by equation."""
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
        "This page lists the functions and claims for each equation of the paper, and [corrects](#corrected) the",
        "equations that are wrong or incomplete as printed. `friction-discs report STUDY` measures a claim, where",
        "STUDY is the part of its name before the slash. No claim covers (2), (24) and (25), which define",
        "coordinates and abbreviations. `python docs/write_equations.py` writes this page from docstrings and",
        "declared claims.",
        "",
        "| | subject | functions | claims |",
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
        f"{TEXT} `friction-discs errata` proves each correction with numbers.",
    ]
    for erratum in ERRATA:
        lines += ["", f"**{erratum.heading}.** {erratum.explanation}", "", f"- as printed: {erratum.printed}"]
        lines += [f"- correct: {erratum.correct}"]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    PAGE.write_text(text(), encoding="utf-8")
