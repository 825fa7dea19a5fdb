r"""What the symbols in a figure mean: a line below its caption, from the formulas that are drawn in it.

A figure keeps the text that it draws as paths in comments of its SVG, "<!-- $\mu N$ in N -->".
"""

from __future__ import annotations

import html
import re

MEANINGS = {
    r"\mu N": ("μN", "friction force"),
    r"\omega": ("ω", "angular velocity of the disc below"),
    r"\Omega": ("Ω", "angular velocity of the shaft"),
    r"\dot\varphi": ("φ̇", "spin of the disc about its centre"),
    r"\rho": ("ρ", "distance from the axis of the disc below"),
    r"\beta": ("β", "damping of the support"),
    r"\varepsilon": ("ε", "slip below which friction is viscous"),
    r"\lambda": ("λ", "eigenvalue"),
    r"\kappa": ("κ", "angular frequency of the whirl"),
    r"\tau": ("τ", "constant of the approach"),
    r"\xi": ("ξ", "deviation of the radius"),
    r"\omega_*": ("ω*", "speed at which the radius of sticking is largest"),
    r"\rho_c": ("ρc", "radius (11) of the whirl"),
    "A": ("A", "largest radius of sticking"),
    "C": ("C", "stiffness of the support"),
    "F": ("F", "force of friction"),
    "J": ("J", "moment of inertia"),
    "M": ("M", "moment of friction about the disc's centre"),
    "R": ("R", "radius of contact"),
    "T": ("T", "period"),
    "U": ("U", "slip of the disc's centre"),
    "W": ("W", "slip of the rim about the centre"),
    "X_0": ("X0", "offset of the support from the axis"),
    "a": ("a", "displacement at the start"),
    "b": ("b", "damping of the shaft in torsion"),
    "h": ("h", "step"),
    "k": ("k", "natural frequency √(C/m)"),
    "m": ("m", "mass"),
    "s": ("s", "distance from where the spring is relaxed"),
    "t": ("t", "time"),
    "t_r": ("tr", "time until release"),
    "v": ("v", "velocity"),
    "v_0": ("v0", "speed at the start"),
    "x": ("x, y", "place in axes at rest"),
    "x_0": ("x0, ẋ0", "place and velocity at the start"),
    "x_s": ("xs, ys", "time mean of the whirl"),
}
"""How a symbol of a formula is printed on a page, and its meaning."""

ALIKE = {r"\epsilon": r"\varepsilon", "y": "x", "y_s": "x_s", r"\dot x_0": "x_0"}

_DRAWN = re.compile(r"<!-- (.*?) -->", re.DOTALL)
_FORMULA = re.compile(r"\$(.+?)\$", re.DOTALL)
_UPRIGHT = re.compile(r"\\math(?:rm|default)\{[^}]*\}+|\be(?=\^)")
_TOKEN = re.compile(r"\\mu N|\\dot\\varphi|\\dot x_0|\\[A-Za-z]+(?:_\*|_\w)?|[A-Za-z](?:_\w)?")
_COMMANDS = {
    rf"\{name}" for name in ("frac", "sqrt", "max", "ln", "exp", "propto", "infty", "pi", "pm", "Delta")
}


def symbols_of(svg: str) -> list[tuple[str, str]]:
    """Return the symbols in the formulas of a drawn figure with their meanings, in the order of ``MEANINGS``."""
    words = html.unescape(" ".join(_DRAWN.findall(svg)))
    found = {key for formula in _FORMULA.findall(words) for key in parsed(formula)[0]}
    return [meaning for key, meaning in MEANINGS.items() if key in found]


def parsed(formula: str) -> tuple[set[str], set[str]]:
    """Return which of ``MEANINGS`` a formula of TeX has, and what in it is none of them and no command."""
    known, unknown = set[str](), set[str]()
    for token in _TOKEN.findall(_UPRIGHT.sub(" ", formula)):
        for name in (token, token.split("_")[0]):  # of ω with any other index it is ω
            if ALIKE.get(name, name) in MEANINGS:
                known.add(ALIKE.get(name, name))
                break
        else:
            unknown |= {token} - _COMMANDS
    return known, unknown
