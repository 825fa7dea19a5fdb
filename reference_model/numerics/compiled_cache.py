"""Compiled functions on disk are known by the content of all that they are compiled from.

numba leaves what it has compiled in a cache, and forgets it when the file of the function changes; older versions do
when that file gets another time. But the functions and constants that it uses are compiled into it too, and they may
come from other files. Here it is forgotten when one of these has other content, and only then.
"""

from __future__ import annotations

import ast
import hashlib
import sys
from collections.abc import Iterator
from functools import cache
from importlib.util import resolve_name
from pathlib import Path
from threading import Lock
from typing import Any

OWN = ("reference_model", "exudyn_models", "compare")
"""Packages whose modules are followed, besides that of the function itself."""

PARSING = Lock()
"""Two threads that parse at once break each other off, before Python 3.12."""


def known_by_content(dispatcher: Any) -> None:
    """Let numba take ``dispatcher``'s compiled code from its cache if all of its sources are as they were."""
    dispatcher._cache._cache_file._source_stamp = sources_digest(dispatcher.py_func.__module__)


def sources_digest(module: str) -> str:
    """Return what the sources of an imported module, and of the modules that it imports, come to."""
    with PARSING:
        return _digest(module)


@cache
def _digest(module: str) -> str:
    packages = {*OWN, module.partition(".")[0]}
    found: dict[str, str] = {}
    left = [module]
    while left:
        name = left.pop()
        source = _source(name)
        if source is not None and name not in found:
            found[name] = hashlib.sha256(source).hexdigest()
            left += [other for other in _imports(name) if other.partition(".")[0] in packages]
    return hashlib.sha256(repr(sorted(found.items())).encode()).hexdigest()


@cache
def _source(module: str) -> bytes | None:
    """Return the text of an imported module, None where there is none."""
    file = getattr(sys.modules.get(module), "__file__", None)
    return Path(file).read_bytes() if file and file.endswith(".py") else None


@cache
def _imports(module: str) -> tuple[str, ...]:
    """Return the names of all that a module imports, modules or what is in them."""
    package = getattr(sys.modules[module], "__package__", "") or ""
    return tuple(_imported(ast.parse(_source(module) or b""), package))


def _imported(tree: ast.AST, package: str) -> Iterator[str]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            place = resolve_name("." * node.level + (node.module or ""), package)
            yield place
            yield from (f"{place}.{alias.name}" for alias in node.names)
