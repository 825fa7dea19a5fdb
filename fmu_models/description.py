"""``modelDescription.xml`` of a model for FMI 2.0 and 3.0, and ``buildDescription.xml`` for FMI 3.0."""

import hashlib
from collections.abc import Sequence
from xml.etree import ElementTree as Xml

from fmu_models.variables import Model, Variable

VERSIONS = {2: "2.0", 3: "3.0"}

UNITS: dict[str, dict[str, int]] = {
    "s": {"s": 1},
    "m": {"m": 1},
    "m/s": {"m": 1, "s": -1},
    "m/s2": {"m": 1, "s": -2},
    "rad": {"rad": 1},
    "rad/s": {"rad": 1, "s": -1},
    "rad/s2": {"rad": 1, "s": -2},
    "kg": {"kg": 1},
    "kg.m2": {"kg": 1, "m": 2},
    "N": {"kg": 1, "m": 1, "s": -2},
    "N.m": {"kg": 1, "m": 2, "s": -2},
    "N/m": {"kg": 1, "s": -2},
    "N/m3": {"kg": 1, "m": -2, "s": -2},
    "N.s/m": {"kg": 1, "s": -1},
    "N.m.s/rad": {"kg": 1, "m": 2, "s": -1, "rad": -1},
    "J": {"kg": 1, "m": 2, "s": -2},
    "W": {"kg": 1, "m": 2, "s": -3},
}
"""Exponents of the base units in each unit of a variable."""

CAUSALITY = {
    "time": "independent",
    "parameter": "parameter",
    "state": "output",
    "derivative": "local",
    "input": "input",
    "output": "output",
    "local": "local",
    "event": "output",
}
TYPES = {
    2: {"real": "Real", "whole": "Integer", "boolean": "Boolean"},
    3: {"real": "Float64", "whole": "Int32", "boolean": "Boolean"},
}
UNTIL = "100"
"""End of the default experiment in s."""


def token_of(model: Model) -> str:
    """Return the token that library and description must share."""
    return "{" + hashlib.sha256(repr(model).encode()).hexdigest()[:32] + "}"


def description(model: Model, fmi: int, sources: Sequence[str]) -> bytes:
    """Return ``modelDescription.xml`` for FMI 2 or 3 of a model with the C files ``sources``."""
    root = Xml.Element(
        "fmiModelDescription",
        {
            "fmiVersion": VERSIONS[fmi],
            "modelName": f"friction-discs {model.name}",
            {2: "guid", 3: "instantiationToken"}[fmi]: token_of(model),
            "description": model.about,
            "generationTool": "friction-discs",
        },
    )
    events = sum(one.name == "indicator" for one in model.variables)
    if fmi == 2:
        root.set("numberOfEventIndicators", str(events))
    _interfaces(root, model, fmi, sources)
    _units(root, model)
    categories = Xml.SubElement(root, "LogCategories")
    for name in ("error", "warning"):
        Xml.SubElement(categories, "Category", name=name)
    Xml.SubElement(root, "DefaultExperiment", startTime="0", stopTime=UNTIL, tolerance="1e-11")
    variables = Xml.SubElement(root, "ModelVariables")
    for place, one in enumerate(model.variables):
        _variable(variables, model, place, one, fmi)
    _structure(root, model, fmi)
    Xml.indent(root)
    return bytes(Xml.tostring(root, encoding="utf-8", xml_declaration=True))


def build_description(model: Model, sources: Sequence[str]) -> bytes:
    """Return ``buildDescription.xml`` for FMI 3."""
    root = Xml.Element("fmiBuildDescription", fmiVersion="3.0")
    configuration = Xml.SubElement(root, "BuildConfiguration", modelIdentifier=model.name)
    files = Xml.SubElement(configuration, "SourceFileSet", language="C99")
    for name in sources:
        Xml.SubElement(files, "SourceFile", name=name)
    Xml.indent(root)
    return bytes(Xml.tostring(root, encoding="utf-8", xml_declaration=True))


def _interfaces(root: Xml.Element, model: Model, fmi: int, sources: Sequence[str]) -> None:
    state = "FMUstate" if fmi == 2 else "FMUState"
    shared = {
        "modelIdentifier": model.name,
        f"canGetAndSet{state}": "true",
        f"canSerialize{state}": "true",
        "providesDirectionalDerivative" if fmi == 2 else "providesDirectionalDerivatives": "true",
    }
    alone = {"canHandleVariableCommunicationStepSize": "true", "maxOutputDerivativeOrder": "1"}
    if fmi == 3:
        alone |= {"providesIntermediateUpdate": "true", "mightReturnEarlyFromDoStep": "true"}
    for name, more in (("ModelExchange", {}), ("CoSimulation", alone)):
        interface = Xml.SubElement(root, name, shared | more)
        if fmi == 2:
            files = Xml.SubElement(interface, "SourceFiles")
            for source in sources:
                Xml.SubElement(files, "File", name=source)


def _units(root: Xml.Element, model: Model) -> None:
    definitions = Xml.SubElement(root, "UnitDefinitions")
    for name in dict.fromkeys(one.unit for one in model.variables if one.unit):
        unit = Xml.SubElement(definitions, "Unit", name=name)
        Xml.SubElement(unit, "BaseUnit", {base: str(power) for base, power in UNITS[name].items()})


def _variable(parent: Xml.Element, model: Model, place: int, one: Variable, fmi: int) -> None:
    variability = "continuous"
    if one.role == "parameter":
        variability = "fixed"
    elif one.type != "real" or one.role == "event":
        variability = "discrete"
    known = {
        "name": one.name,
        "valueReference": str(place),
        "description": one.about,
        "causality": CAUSALITY[one.role],
        "variability": variability,
    }
    if one.role in ("parameter", "state"):
        known["initial"] = "exact"
    elif one.role in ("output", "derivative", "local", "event"):
        known["initial"] = "calculated"
    typed = {"unit": one.unit} if one.unit else {}
    if one.settable and one.type != "boolean":
        typed |= {"min": _text(one, one.least), "max": _text(one, one.most)}
    if one.settable and one.start is not None:
        typed["start"] = _text(one, one.start)
    if one.role == "derivative":
        of = [other.name for other in model.variables].index(one.derivative_of)
        typed["derivative"] = str(of + 1 if fmi == 2 else of)
    if fmi == 2:
        Xml.SubElement(Xml.SubElement(parent, "ScalarVariable", known), TYPES[2][one.type], typed)
    else:
        Xml.SubElement(parent, TYPES[3][one.type], known | typed)


def _text(one: Variable, value: float) -> str:
    if one.type == "boolean":
        return "true" if value else "false"
    return str(int(value)) if one.type == "whole" else repr(float(value))


def _structure(root: Xml.Element, model: Model, fmi: int) -> None:
    structure = Xml.SubElement(root, "ModelStructure")
    places = {one.name: place for place, one in enumerate(model.variables)}
    outputs = model.having("state", "output", "event")
    unknowns = [*model.having("output", "event"), *model.derivatives]
    indicators = [one for one in model.variables if one.name == "indicator"]
    groups: tuple[tuple[str, str, Sequence[Variable]], ...] = (
        ("Outputs", "Output", outputs),
        ("Derivatives", "ContinuousStateDerivative", model.derivatives),
        ("InitialUnknowns", "InitialUnknown", sorted(unknowns, key=lambda one: places[one.name])),
    )
    for name, newer, variables in groups:
        if fmi == 2:
            group = Xml.SubElement(structure, name)
            for one in variables:
                Xml.SubElement(group, "Unknown", index=str(places[one.name] + 1))
        else:
            for one in variables:
                Xml.SubElement(structure, newer, valueReference=str(places[one.name]))
    if fmi == 3:
        for one in indicators:
            Xml.SubElement(structure, "EventIndicator", valueReference=str(places[one.name]))
