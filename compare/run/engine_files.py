"""The files of an engine's code. Modules are found, not imported: foreign code runs only in a process of its own."""

from __future__ import annotations

import functools
import importlib.util
import sys
from collections.abc import Callable
from importlib.machinery import ModuleSpec
from pathlib import Path
from typing import Any

from compare.engines import ByName
from compare.engines.outside.code_files import code_below

PACKAGES = ("reference_model", "exudyn_models", "fmu_models", "compare")
"""This project's own."""

SITES = {"site-packages", "dist-packages"}
"""Folders of installed packages, which do not belong to each other."""


def files_of(function: Callable[..., Any]) -> list[Path] | None:
    """Return the files of an engine's function and of the modules next to it, sorted.

    Empty for this project's functions and those of Python itself; None if there are no files to be found.
    """
    if (files := getattr(function, "files", None)) is not None:
        return sorted(files) or None
    while isinstance(function, functools.partial):
        function = function.func
    folder = function.folder if isinstance(function, ByName) else ""
    module = function.module if isinstance(function, ByName) else function.__module__
    package = module.partition(".")[0]
    if package in PACKAGES or package in sys.stdlib_module_names:
        return []
    spec = _found(package, folder)
    if spec is None:
        return None
    if spec.submodule_search_locations is not None:
        return sorted(code_below(spec.submodule_search_locations)) or None
    if spec.origin is None or not (file := Path(spec.origin)).is_file():
        return None
    return [file] if file.parent.name in SITES else sorted(code_below([file.parent]))


def _found(package: str, folder: str) -> ModuleSpec | None:
    """Return where a module or package without dots is; ``folder`` comes last, as where it is imported."""
    before = sys.path.copy()
    sys.path.extend([folder] if folder else [])
    try:
        return importlib.util.find_spec(package)
    except ValueError:  # a module of this process that came from no file
        return None
    finally:
        sys.path[:] = before
