"""Pages of the site that are made from the program: its modules, commands and benchmarks, citation, latest report."""

from __future__ import annotations

import ast
import html
import importlib
import inspect
import json
import re
import sys
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "docs")]
REPORT = ROOT / "report"
BENCHMARKS = ROOT / "benchmarks"
PACKAGES = ("reference_model", "exudyn_models", "fmu_models", "compare")
PAPER = ROOT / "docs" / "paper" / "paper.pdf"

TASKS = {
    "Describe a system": ("PinOnDisc", "DiscOnDisc", "FrictionJoint"),
    "Simulate a motion": (
        *("simulate", "Trajectory", "Phase", "Solution", "SimulationError", "Pushing"),
        *("exudyn_models.simulate", "exudyn_models.simulate_fixed_step"),
    ),
    "Simulate many motions": ("ensemble.simulate_ensemble", "ensemble.Ensemble", "ensemble.EndState"),
    "Choose the contact": ("Ring", "Points", "PointsOnRing", "Annulus", "ThreeTermRing"),
    "Find steady motions": (
        *("self_centred_equilibria", "SelfCentredEquilibrium", "SpinningEquilibrium", "why_no_equilibrium"),
        *("whirls", "Whirl", "SpinningWhirl", "why_no_whirl", "sticking_radius"),
    ),
    "Find periodic motions": (
        *("whirl_orbit", "stick_slip_orbits", "modulated_cycle", "Orbit", "StickSlipOrbit"),
        *("whirl_branch", "last_whirl"),
    ),
    "Find limits": (
        *(
            "smallest_load_with_whirl",
            "onset_load",
            "smallest_shock",
            "Shock",
            "basin_boundary",
            "boundary_point",
        ),
    ),
    "Check energy": (
        *("power_balance", "PowerBalance", "exudyn_models.add_energy_balance", "exudyn_models.EnergyBalance"),
        "exudyn_models.spring_energy",
    ),
    "Add friction to an Exudyn model": (
        *(
            "exudyn_models.add_ring_friction",
            "exudyn_models.RingFriction",
            "exudyn_models.add_native_friction",
        ),
        *("exudyn_models.add_radial_support", "exudyn_models.RadialSupport"),
        *("exudyn_models.add_thermal_node", "exudyn_models.ThermalNode"),
        *("exudyn_models.add_gear", "exudyn_models.add_planetary", "exudyn_models.add_differential"),
        *("exudyn_models.add_one_way_clutch", "exudyn_models.add_torsional_spring"),
        *("exudyn_models.add_slider_friction", "exudyn_models.add_tyre", "exudyn_models.RotorCoupling"),
        *("exudyn_models.add_torque", "exudyn_models.torque_table", "exudyn_models.add_torque_converter"),
        *("exudyn_models.RotorTorques", "exudyn_models.add_road_load", "exudyn_models.RoadLoad"),
        *("exudyn_models.shift_sequence", "exudyn_models.ShiftSequence"),
    ),
    "Run an Exudyn model": (
        *("exudyn_models.solve_dynamic", "exudyn_models.ModeChange", "exudyn_models.largest_stable_step"),
        *("exudyn_models.linearise", "exudyn_models.Linearisation", "exudyn_models.ContactState"),
        *("exudyn_models.eigenvalues", "exudyn_models.build_model"),
        "exudyn_models.simulate_with_native_contact",
    ),
    "Model a car": (
        *("exudyn_models.build_drivetrain", "exudyn_models.DrivetrainModel", "exudyn_models.Drivetrain"),
        *("exudyn_models.PASSENGER_CAR", "exudyn_models.four_cylinder"),
    ),
    "Export to other simulators": (
        *("fmu_models.export", "fmu_models.Exported", "fmu_models.Model", "fmu_models.Variable"),
        *("fmu_models.MODELS", "fmu_models.PIN", "fmu_models.DISC", "fmu_models.CLUTCH"),
        "fmu_models.HeadersMissingError",
    ),
}
"""Public names by task; ``reference_model`` is omitted."""


def full_name(name: str) -> str:
    """Return a name of ``TASKS`` with its package."""
    return name if name.startswith(("exudyn_models", "fmu_models")) else f"reference_model.{name}"


def tasks() -> str:
    """Return the index of the API by task, with the first sentence of each docstring."""
    lines = [
        "API by task",
        "===========",
        "",
        "This page lists the public names by task. Each links to its parameters.",
    ]
    for task, names in TASKS.items():
        lines += ["", task, "-" * len(task), "", ".. list-table::", "   :widths: 30 70", ""]
        for name in map(full_name, names):
            package, _, attribute = name.rpartition(".")
            thing = getattr(importlib.import_module(package), attribute)
            text = inspect.getdoc(thing) if callable(thing) else "Parameters or variables, ready to use."
            lines += [f"   * - :py:obj:`{attribute} <{name}>`", f"     - {_sentence(text or '')}"]
    return "\n".join(lines) + "\n"


def modules() -> str:
    """Return the map of the code: each module of the packages with the first sentence of its docstring."""
    lines = ["# Modules", "", "This page lists all modules with the first sentence of their docstrings."]
    for package in PACKAGES:
        lines += ["", f"## {package}", "", "| module | contents |", "|---|---|"]
        for path in sorted((ROOT / package).rglob("*.py")):
            name = path.relative_to(ROOT / package).as_posix().removesuffix("/__init__.py")
            lines.append(f"| `{name}` | {_sentence(_docstring(path))} |")
    return "\n".join(lines) + "\n"


def benchmarks() -> str:
    """Return the page of the benchmarks, with the figures that their docstrings contain."""
    lines = ["# Benchmarks", "", _docstring(BENCHMARKS / "tracked" / "__init__.py")]
    programs = (path for path in sorted(BENCHMARKS.glob("*.py")) if "__main__" in path.read_text("utf-8"))
    for path in programs:
        lines += ["", f"## {path.stem}", "", _docstring(path)]
    return "\n".join(lines) + "\n"


def _docstring(path: Path) -> str:
    return ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""


def _sentence(text: str) -> str:
    """Return the first sentence of a docstring on one line."""
    return re.split(r"(?<=\.)\s|\n\n", text)[0].replace("\n", " ").replace("|", r"\|")


def commands() -> str:
    """Return the reference of the command line: the help of each command."""
    import typer

    from compare.cli.app import app

    lines = [
        "# Commands",
        "",
        "This page shows what `friction-discs COMMAND --help` prints for each command.",
    ]
    for path, text in _helps(typer.main.get_command(app), "friction-discs"):
        lines += ["", f"## {path}", "", "```text", text.rstrip(), "```"]
    return "\n".join(lines) + "\n"


def _helps(command, path: str) -> Iterator[tuple[str, str]]:
    with command.make_context(path, [], resilient_parsing=True) as context:
        yield path, command.get_help(context)
    for name, part in getattr(command, "commands", {}).items():
        yield from _helps(part, f"{path} {name}")


def citation(page: str) -> str:
    """Return the page about citation with the entries of this version."""
    from cited import bibtex

    return re.sub(r"(?s)```bibtex\n.*?```", lambda _: f"```bibtex\n{bibtex()}```", page)


def footer() -> str:
    """Return version, date and commit for the end of every page."""
    from cited import version

    known = version()
    return ", ".join(filter(None, (f"Version {known['version']}", known["date"], known["commit"][:10])))


def linked_claims(text: str) -> str:
    """Return a page whose names and numbers of claims lead to the report, if there is one."""
    if not (REPORT / "results.json").exists():
        return text
    studies = json.loads((REPORT / "results.json").read_text(encoding="utf-8"))["studies"]
    names = {claim["id"] for study in studies for claim in study["claims"]}
    anchors = {name: name for name in sorted(names, reverse=True)}
    for name in sorted(names, reverse=True):  # a name of a family leads to its first member
        anchors["/".join(name.split("/")[:2])] = name

    of_headings = {name.replace("/", ""): name for name in names}

    def link(found: re.Match[str]) -> str:
        anchor = anchors.get(found[1])
        return f'<a href="report/index.html#{anchor}"><code>{found[1]}</code></a>' if anchor else found[0]

    def number(found: re.Match[str]) -> str:
        anchor = of_headings.get(found[2])
        return f'<a href="report/index.html#{anchor}">{found[1]}</a>' if anchor else found[0]

    def sentence(found: re.Match[str]) -> str:
        return (
            f'{found[1]}<a href="report/index.html#{found[2]}">{found[3]}</a>'
            if found[2] in names
            else found[0]
        )

    text = re.sub(r"\[([^]\n]*)\]\((?:findings\.md)?#([\w-]+)\)", number, text)
    text = re.sub(r"(?m)^(### (\S+/\S+)\n\n)(.+)$", sentence, text)
    return re.sub(r"(?<!\[)`([a-z0-9-]+/[a-z0-9/ .-]+)`", link, text)


def report(without: str) -> str:
    """Return the page about the latest report with its figures and captions, or the page ``without`` a report."""
    if not (REPORT / "results.json").exists():
        return without
    from compare.claims.as_json import claim_from_json
    from compare.report.quotes import filled
    from compare.report.results_json import read_results
    from compare.studies import STUDIES

    results = read_results(REPORT / "results.json")
    captions = {study.name: study.figures for study in STUDIES}
    totals = ", ".join(f"{number} {name}" for name, number in results["totals"].items() if number)
    lines = ["# Latest report", "", f'<a href="report/index.html">The report</a>: {html.escape(totals)}.', ""]
    lines += ['<a href="paper.pdf">The paper about the findings (PDF)</a>', ""] * PAPER.exists()
    for study in results["studies"]:
        names = [name for name in study["figures"] if (REPORT / "figures" / f"{name}.svg").exists()]
        lines += [f"## {html.escape(study['title'])}", ""] if names else []
        claims = [claim_from_json(claim) for claim in study["claims"]]
        for name in names:
            picture = f"report/figures/{name}.svg"
            caption = html.escape(filled(captions[study["name"]][name], claims))
            lines += [
                f'<figure><a href="report/index.html#figure/{name}"><img alt="{name}" loading="lazy" src="{picture}">'
                f"</a><figcaption>{caption}</figcaption></figure>",
                "",
            ]
    return "\n".join(lines) + "\n"
