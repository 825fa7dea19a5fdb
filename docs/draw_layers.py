"""Draw the layers of the packages from the actual imports: ``python docs/draw_layers.py``.

The layers are the contracts in ``pyproject.toml``, which import-linter checks. The arrows are the imports between the
modules of a package. The description in ``layers.svg`` contains its data, so a test can detect an outdated figure.
"""

import ast
import json
import tomllib
from pathlib import Path

from matplotlib import rc_context
from matplotlib.figure import Figure
from matplotlib.patches import FancyBboxPatch

ROOT = Path(__file__).parents[1]
PICTURE = Path(__file__).with_name("layers.svg")
PLACES = {
    "compare": (0.0, 2.4),
    "exudyn_models": (8.0, 0.0),
    "fmu_models": (8.0, 6.9),
    "reference_model": (13.8, 0.0),
}
"""Lower left corner of each package. A package imports only from packages to its right."""

COLOURS = {
    "compare": "tab:blue",
    "exudyn_models": "tab:orange",
    "fmu_models": "tab:red",
    "reference_model": "tab:green",
}
WIDTH, HEIGHT, LINE, GAP = 2.0, 0.6, 1.2, 0.25
"""Size of a module; distance between layers; gap between modules."""


BETWEEN = {
    ("compare", "exudyn_models"): ((6.4, 3.4), (8.3, 3.4), 0.2),
    ("compare", "fmu_models"): ((7.0, 9.9), (9.0, 9.9), 0.2),
    ("compare", "reference_model"): ((7.0, 6.1), (14.9, 6.1), 0.2),
    ("fmu_models", "reference_model"): ((12.3, 7.5), (14.9, 7.5), 0.2),
    ("exudyn_models", "reference_model"): ((12.3, 1.8), (13.7, 1.8), 0.2),
}
"""Start and end of the arrows between packages, and the height of their labels above them."""

MOST_NAMED = 3
"""Largest number of modules named next to such an arrow."""


def layers_of():
    """Return the layers of each package, top layer first, each a list of modules."""
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["importlinter"][
        "contracts"
    ]
    return {
        package: [layer.split(" | ") for layer in contract["layers"]]
        for contract in contracts
        if contract["type"] == "layers"
        for package in contract["containers"]
        if package in PLACES
    }


def imports():
    """Return the pairs of modules ("package.module") whose first member imports from the second."""
    found = set()
    for package in PLACES:
        for path in (ROOT / package).rglob("*.py"):
            here = module_of(path.relative_to(ROOT).with_suffix("").parts)
            for node in ast.walk(ast.parse(path.read_text("utf-8"))):
                names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
                if isinstance(node, ast.ImportFrom):
                    names = [f"{node.module}.{alias.name}" for alias in node.names]
                found |= {
                    (here, module_of(name.split("."))) for name in names if name.split(".")[0] in PLACES
                }
    return sorted((here, there) for here, there in found if here and there and here != there)


def module_of(parts):
    """Return "package.module" for a dotted name, or "" for a name that the package itself exports."""
    package, module = [*parts, ""][:2]
    inside = (ROOT / package / module).is_dir() or (ROOT / package / f"{module}.py").is_file()
    return f"{package}.{module}" if module and module != "__init__" and inside else ""


def drawn_from():
    """Return the contents of the figure as JSON."""
    return json.dumps({"layers": layers_of(), "imports": imports()})


def places():
    """Return the centre of each module, by "package.module"."""
    found = {}
    for package, layers in layers_of().items():
        left, low = PLACES[package]
        widest = max(map(len, layers))
        for i, modules in enumerate(reversed(layers)):
            for j, module in enumerate(modules):
                x = left + (WIDTH + GAP) * (j + 0.5 * (widest - len(modules)) + 0.5)
                found[f"{package}.{module}"] = (x, low + LINE * (i + 0.5))
    return found


def needed(arrows):
    """Return the arrows that no path through another module implies."""
    return {
        (here, there)
        for here, there in arrows
        if not any(
            (here, other) in arrows and reaches(arrows, other, there) for _, other in arrows - {(here, there)}
        )
    }


def reaches(arrows, here, there):
    """Return whether a path along ``arrows``, which have no cycles, connects two modules."""
    return any(begin == here and (end == there or reaches(arrows, end, there)) for begin, end in arrows)


def draw():
    """Return the figure."""
    middle = places()
    top = max(y for _, y in middle.values()) + LINE  # leaves room for the name of a package
    figure = Figure(figsize=(11.0, 0.58 * top), layout="constrained")
    panel = figure.subplots()
    inside = {pair for pair in imports() if pair[0].split(".")[0] == pair[1].split(".")[0]}
    for here, there in sorted(inside):
        (x, y), (to_x, to_y) = middle[here], middle[there]
        far = y - to_y > 1.5 * LINE and abs(x - to_x) < WIDTH  # bend around the modules in between
        look = {
            "arrowstyle": "-|>",
            "color": COLOURS[here.split(".")[0]],
            "alpha": 0.9 if (here, there) in needed(inside) else 0.15,
            "connectionstyle": f"arc3,rad={0.3 if far else 0.0}",
        }
        start, end = (x, y - HEIGHT / 2), (to_x, to_y + HEIGHT / 2)
        panel.annotate("", xy=end, xytext=start, arrowprops=look, zorder=1)
    for name, (x, y) in middle.items():
        package, module = name.split(".")
        corner = (x - WIDTH / 2, y - HEIGHT / 2)
        box = FancyBboxPatch(corner, WIDTH, HEIGHT, boxstyle="round,pad=0,rounding_size=0.1", zorder=2)
        box.set(facecolor="white", edgecolor=COLOURS[package], linewidth=1.5)
        panel.add_patch(box)
        panel.text(x, y, module.replace("_", " "), ha="center", va="center", fontsize=9, zorder=3)
    for package, layers in layers_of().items():
        left, low = PLACES[package]
        high = low + LINE * len(layers)
        panel.text(left, high, package, color=COLOURS[package], fontsize=13, weight="bold")
    for (package, other), ((x, y), (to_x, to_y), beside) in BETWEEN.items():
        modules = sorted(
            {there for here, there in imports() if here.startswith(package) and there.startswith(other)}
        )
        panel.annotate(
            "",
            xy=(to_x, to_y),
            xytext=(x, y),
            arrowprops={"arrowstyle": "simple", "color": "0.7"},
            zorder=0,
        )
        words = (
            "\n".join(module.split(".")[1] for module in modules)
            if len(modules) <= MOST_NAMED
            else f"{len(modules)} modules"
        )
        panel.text(
            (x + to_x) / 2, (y + to_y) / 2 + beside, words, ha="center", va="bottom", fontsize=8, color="0.4"
        )
    panel.set(xlim=(-0.2, 20.8), ylim=(-0.1, top))
    panel.axis("off")
    return figure


if __name__ == "__main__":
    with rc_context({"svg.hashsalt": "layers", "svg.fonttype": "none"}):
        draw().savefig(PICTURE, metadata={"Description": drawn_from(), "Date": None})
