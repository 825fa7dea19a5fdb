"""Conversion to JSON and back for numbers, arrays, dataclasses (systems, plans of sweeps) and claims.

NaN and infinity become "nan", "inf" and "-inf". All numbers are restored exactly.
"""

import math
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from types import UnionType
from typing import Any, TypeVar, get_args, get_origin, get_type_hints

import numpy as np

from compare.claims.claim import Claim, ErrorBudget

Kind = TypeVar("Kind")

TYPE = "type"


def as_json(value: Any) -> Any:
    """Return numbers, arrays, tuples, mappings and dataclasses as JSON values, others unchanged."""
    if isinstance(value, np.ndarray):
        numbers = value.astype(float).tolist()
        return numbers if np.all(np.isfinite(value)) else as_json(numbers)
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float):
        return value if math.isfinite(value) else str(value)
    if isinstance(value, Enum):
        return value.value
    if is_dataclass(value) and not isinstance(value, type):
        kinds = get_type_hints(type(value))
        return {field.name: _tag(kinds[field.name], getattr(value, field.name)) for field in fields(value)}
    if isinstance(value, Mapping):
        return {name: as_json(item) for name, item in value.items()}
    return [as_json(item) for item in value] if isinstance(value, list | tuple) else value


def from_json(kind: type[Kind], content: Mapping[str, Any]) -> Kind:
    """Return an instance of the dataclass ``kind`` from the output of ``as_json``.

    Raises ``KeyError``, ``TypeError`` or ``ValueError`` if ``content`` does not fit.
    """
    kinds = get_type_hints(kind)
    return kind(**{name: _value(kinds[name], item) for name, item in content.items()})


def _tag(kind: Any, value: Any) -> Any:
    content = as_json(value)
    tagged = value is not None and _dataclasses(kind)
    return {TYPE: type(value).__name__} | content if tagged else content


def _value(kind: Any, content: Any) -> Any:
    if possible := _dataclasses(kind):
        return from_json(
            possible[content[TYPE]], {name: item for name, item in content.items() if name != TYPE}
        )
    if is_dataclass(kind):
        return from_json(kind, content)  # type: ignore[arg-type]
    if get_origin(kind) is tuple:
        return tuple(_value(get_args(kind)[0], item) for item in content)
    if get_origin(kind) is np.ndarray:
        return np.array(content, dtype=float)
    if kind is float:
        return float(content)
    if isinstance(kind, type) and type(content) is not kind:
        raise TypeError(f"{content!r} is not of type {kind.__name__}")
    return content


def _dataclasses(kind: Any) -> dict[str, type[Any]]:
    several = get_args(kind) if get_origin(kind) is UnionType else ()
    return {one.__name__: one for one in several if isinstance(one, type) and is_dataclass(one)}


OTHERWISE = ("budget", "identity")
"""Fields of a claim that have another form in JSON."""


def claim_as_json(claim: Claim) -> dict[str, Any]:
    """Return a claim as JSON values."""
    alike = [field.name for field in fields(Claim) if field.name not in OTHERWISE]
    return {name: as_json(getattr(claim, name)) for name in alike} | {
        "difference": as_json(claim.difference),
        "numerical_error": as_json(claim.budget.numerical),
        "model_error": claim.budget.model,
        "resolution": as_json(claim.budget.resolution),
        "negligible": as_json(claim.budget.negligible),
        "doubt": claim.budget.doubt,
        "grade": "" if claim.grade is None else claim.grade.value,
        "verdict": claim.verdict.value,
        "id": claim.identity,
    }


def claim_from_json(content: dict[str, Any]) -> Claim:
    """Return the claim from the output of ``claim_as_json``."""
    alike = {field.name: content[field.name] for field in fields(Claim) if field.name in content}
    numbers = {name: float(content[name]) for name in ("resolution", "negligible", "doubt")}
    budget = ErrorBudget(content["numerical_error"], model=content["model_error"], **numbers)
    return Claim(**alike, budget=budget, identity=content["id"])
