"""Checks of ``results.json`` against its schema, without the package jsonschema, which users need not install."""

import functools
import json
from collections.abc import Iterator, Mapping
from importlib.resources import files
from typing import Any

TYPES: dict[str, type | tuple[type, ...]] = {
    "object": dict,
    "array": list,
    "string": str,
    "boolean": bool,
    "integer": int,
    "number": (int, float),
    "null": type(None),
}


@functools.cache
def schema() -> dict[str, Any]:
    """Return the JSON schema (draft 2020-12) of ``results.json``."""
    content = files("compare.report").joinpath("results.schema.json").read_text(encoding="utf-8")
    found: dict[str, Any] = json.loads(content)
    return found


def faults(value: Any, rule: Any, place: str = "it") -> Iterator[str]:
    """Yield the faults of a value in words, each with its place; ``rule`` is a part of :func:`schema`."""
    if rule is True or rule is False:
        yield from () if rule else (f"{place} is not part of the format",)
    elif "$ref" in rule:
        yield from faults(value, schema()["$defs"][rule["$ref"].rpartition("/")[2]], place)
    elif reason := _fault(value, rule):
        yield f"{place} must be {reason}"
    elif "anyOf" in rule:
        if all(any(faults(value, one)) for one in rule["anyOf"]):
            yield f"{place} has none of the allowed forms"
    elif "if" in rule and not any(faults(value, rule["if"])):
        yield from faults(value, rule["then"], place)
    elif isinstance(value, dict):
        yield from (f"{place} lacks {name!r}" for name in rule.get("required", ()) if name not in value)
        known, others = rule.get("properties", {}), rule.get("additionalProperties", True)
        for name, one in value.items():
            yield from faults(one, known.get(name, others), f"{place}.{name}".removeprefix("it."))
    elif isinstance(value, list):
        for i, one in enumerate(value):
            yield from faults(one, rule.get("items", True), f"{place}[{i}]")


def _fault(value: Any, rule: Mapping[str, Any]) -> str:
    kinds = rule.get("type", list(TYPES))
    kinds = [kinds] if isinstance(kinds, str) else kinds
    if not any(
        isinstance(value, TYPES[kind]) and isinstance(value, bool) <= (kind == "boolean") for kind in kinds
    ):
        return " or ".join(kinds)
    allowed = rule.get("enum", [rule["const"]] if "const" in rule else [value])
    if not any(value == one and type(value) is type(one) for one in allowed):
        return " or ".join(map(repr, allowed))
    return f">= {rule['minimum']}" if "minimum" in rule and value < rule["minimum"] else ""
