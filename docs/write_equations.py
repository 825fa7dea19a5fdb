"""Write ``docs/equations.md``, each equation with its functions and claims: ``python docs/write_equations.py``.

The functions are those of the reference whose docstrings cite the equation. The claims are those declared for it, and
the corrections come from the errata. A test fails if the page is out of date.
"""

import ast
import re
from itertools import chain, zip_longest
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

TYPESET = {
    1: r"m\ddot x + \beta\dot x + C(x - X_0) = -\mu N\,\frac{\dot x + \omega y}{v},\quad "
    r"m\ddot y + \beta\dot y + Cy = -\mu N\,\frac{\dot y - \omega x}{v},\quad "
    r"v = \sqrt{(\dot x + \omega y)^2 + (\dot y - \omega x)^2}",
    2: r"x = \rho\cos\psi,\quad y = \rho\sin\psi",
    3: r"\rho_* = \sqrt{X_0^2 - \left(\frac{\mu N}{C}\right)^2},\quad \sin\psi_* = \frac{\mu N}{C X_0}",
    4: r"\left(x - \frac{X_0}{2}\right)^2 + y^2 = \frac{X_0^2}{4}",
    5: r"\mu N \le C X_0",
    6: r"m\ddot x + \beta\dot x + C(x - X_0) = F_{Rx},\quad m\ddot y + \beta\dot y + Cy = F_{Ry},\quad "
    r"\sqrt{F_{Rx}^2 + F_{Ry}^2} \le \mu N",
    7: r"(C - m\omega^2)^2A^2 + \beta^2\omega^2A^2 + C^2X_0^2 - 2CX_0A\left[(C - m\omega^2)\cos\psi "
    r"- \beta\omega\sin\psi\right] \le (\mu N)^2",
    8: r"A\sqrt{(C - m\omega^2)^2 + \beta^2\omega^2} + CX_0 \le \mu N",
    9: r"A \le \frac{\mu N - CX_0}{\sqrt{(C - m\omega^2)^2 + \beta^2\omega^2}}",
    10: r"m(\ddot\rho - \rho\dot\psi^2) + \beta\dot\rho + C(\rho - X_0\cos\psi) = -\mu N\,\frac{\dot\rho}{v},\quad "
    r"m(\rho\ddot\psi + 2\dot\rho\dot\psi) + \beta\rho\dot\psi + CX_0\sin\psi = "
    r"\mu N\,\frac{\rho(\omega - \dot\psi)}{v}",
    11: r"\dot\psi = k = \sqrt{\frac{C}{m}},\quad \rho_c = \frac{\mu N}{\beta k}",
    12: r"\ddot\xi + \frac{\beta}{m}\frac{\omega}{\omega - k}\dot\xi - \frac{2\mu N}{\beta}\eta = 0,\quad "
    r"\dot\eta + \frac{\beta}{m}\eta + \frac{\beta k^2}{\mu N}\left(2\dot\xi + \frac{\beta}{m}\xi\right) = 0",
    13: r"\lambda^3 + a\lambda^2 + \left(\frac{\beta^2}{m^2}\frac{\omega}{\omega - k} + 4k^2\right)\lambda "
    r"+ \frac{2k^2\beta}{m} = 0",
    14: r"\frac{\omega}{\omega - k} > -1,\quad \frac{\omega}{\omega - k} > -q,\quad "
    r"q = \left(\frac{2km}{\beta}\right)^2",
    15: r"\frac{\omega}{\omega - k} < -\frac{1}{2}\left(1 + q + \sqrt{1 + q^2}\right)",
    16: r"\frac{\omega}{\omega - k} > -\frac{1}{2}\left(1 + q - \sqrt{1 + q^2}\right)",
    17: r"x = x_s + \rho_c\cos kt,\quad y = y_s + \rho_c\sin kt",
    18: r"x_s = \frac{X_0}{1 + \frac{\beta^2\omega^2}{4mC(\omega - k)^2}},\quad "
    r"y_s = \frac{\beta\omega\,x_s}{2mk(\omega - k)}",
    19: r"m\ddot x + \beta\dot x + C(x - X_0) = F_x,\quad m\ddot y + \beta\dot y + Cy = F_y,\quad "
    r"J\ddot\varphi + b(\dot\varphi - \Omega) = M",
    20: r"F = -\frac{\mu N}{2\pi}\int_0^{2\pi}\frac{\nu_r}{|\nu_r|}\,d\chi,\quad "
    r"M = \frac{\mu NR}{2\pi}\int_0^{2\pi}\frac{\nu_{rx}\sin(\varphi + \chi) - \nu_{ry}\cos(\varphi + \chi)}"
    r"{|\nu_r|}\,d\chi",
    21: r"\nu_{rx} = \dot x + \omega y + R(\omega - \dot\varphi)\sin(\varphi + \chi),\quad "
    r"\nu_{ry} = \dot y - \omega x - R(\omega - \dot\varphi)\cos(\varphi + \chi)",
    22: r"\frac{\tilde\nu_r}{|\nu_r|} = 1 - \varepsilon,\quad "
    r"\varepsilon = \frac{R(\omega - \dot\varphi)\tilde\nu_{xy}}{\bar\nu_r^2}",
    23: r"|F| = \mu N\cos\alpha\left(1 - \frac{1}{2}\sin^2\alpha + \frac{3}{4}\cos^2\alpha\sin^2\alpha\right),\quad "
    r"M = \mu NR\sin\alpha\left(1 - \frac{1}{2}\cos^2\alpha + \frac{3}{4}\cos^2\alpha\sin^2\alpha\right),\quad "
    r"\tan\alpha = \frac{R(\omega - \dot\varphi)}{U}",
    24: r"x = A\cos\alpha\cos\theta,\quad y = A\cos\alpha\sin\theta,\quad "
    r"R(\omega - \dot\varphi) = \omega A\sin\alpha",
    25: r"\mu_0 = \frac{\mu N}{C},\quad b_0 = \frac{b\omega}{RC},\quad \delta = 1 - \frac{\Omega}{\omega}",
    26: r"\delta = \frac{A}{R}\sin\alpha + \frac{\mu_0}{b_0}\sin\alpha\left(1 - \frac{1}{2}\cos^2\alpha"
    r"\left(1 - \frac{3}{2}\sin^2\alpha\right)\right),\quad A^2 = \frac{X_0^2}{\cos^2\alpha} - \mu_0^2B^2,\quad "
    r"\cos\theta = \frac{A\cos\alpha}{X_0}",
}
"""Each equation in our notation; its content is as printed, with ``PRINTED`` below."""

PRINTED = {
    11: (r"\text{for every } \omega", r"\text{only for } \omega > k"),
    13: (
        r"a = 1 + \frac{\beta}{m}\frac{\omega}{\omega - k}",
        r"a = \frac{\beta}{m}\left(1 + \frac{\omega}{\omega - k}\right)",
    ),
    18: (
        TYPESET[18],
        r"x_s + iy_s = X_0\,\overline{\left(\frac{6 - id(w + 2)}{6 + 2d^2w + 2id(w - 1)}\right)},\quad "
        r"d = \frac{\beta}{mk},\quad w = \frac{\omega}{\omega - k}",
    ),
    22: (
        TYPESET[22],
        r"\frac{\bar\nu_r}{|\nu_r|} = 1 - \varepsilon + \frac{3}{2}\varepsilon^2,\quad "
        r"\varepsilon = \frac{R(\omega - \dot\varphi)\tilde\nu_{xy}}{\bar\nu_r^2}",
    ),
    26: (
        r"B = 1 - \frac{1}{2}\cos^2\alpha + \frac{3}{16}\sin^2\alpha",
        r"B = 1 - \frac{1}{2}\sin^2\alpha + \frac{3}{16}\sin^2 2\alpha",
    ),
}
"""Terms of the wrong equations, as printed and as corrected."""

MOST_FUNCTIONS, MOST_CLAIMS = 3, 4
"""Largest numbers of functions and of claims in a row; the search of the report finds all claims of an equation."""

PREFERRED = ("plain", "formulas", "contact", "systems", "steady", "orbits")
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
        if {"ensemble", "core"} & set(module.parts):  # compiled code
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


def _block(formula):
    return ["", "```math", formula, "```"]


def _typeset(number):
    """Return the lines that show an equation, and for a wrong one the printed and the corrected term."""
    if number not in PRINTED:
        return _block(TYPESET[number])
    printed, correct = PRINTED[number]
    lines = _block(TYPESET[number]) if printed != TYPESET[number] else []
    return [*lines, "", "As printed:", *_block(printed), "", "[Corrected](#corrected):", *_block(correct)]


def _listed(identities_by_study):
    """Return the names of claims, the first of each study before the second, and the number of further claims."""
    in_turns = chain(*zip_longest(*identities_by_study.values()))
    identities = [f"`{each}`" for each in in_turns if each]
    more = len(identities) - MOST_CLAIMS
    return ", ".join(identities[:MOST_CLAIMS]) + f" and {more} more" * (more > 0)


def text():
    """Return the page."""
    lines = [
        "# Equations",
        "",
        "This page shows each equation of the paper in our notation, the functions that compute it and claims about",
        "it. The [glossary](glossary.md#symbols) explains the symbols. `friction-discs report --claim ID` measures a",
        'claim. To find more claims about (16), search the report for "eq. 16". No claim covers (2), (24) and (25),',
        "which define coordinates and abbreviations. [`plain.py`](../reference_model/plain.py) contains the",
        "equations of motion as printed, in 98 lines. `python docs/write_equations.py` writes this page.",
    ]
    by_function, by_claim = functions(), claims()
    for number, about in EQUATIONS.items():
        named = [f"[`{name}`](../{path.as_posix()})" for path, name in by_function[number][:MOST_FUNCTIONS]]
        lines += ["", f"## ({number}) {about}", *_typeset(number), ""]
        lines += [f"- functions: {', '.join(named)}"]
        lines += [f"- claims: {_listed(by_claim[number])}"] * bool(by_claim[number])
    lines += [
        "",
        "## Corrected",
        "",
        f"{TEXT} `friction-discs errata` proves each correction with numbers.",
    ]
    for erratum in ERRATA:
        lines += ["", f"**{erratum.heading}.** {erratum.explanation}"]
        if not cited(erratum.equation):  # otherwise both forms stand above
            lines += ["", f"- as printed: {erratum.printed}", f"- correct: {erratum.correct}"]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    PAGE.write_text(text(), encoding="utf-8")
