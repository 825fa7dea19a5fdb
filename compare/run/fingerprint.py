"""What a callable depends on, as a few letters: the same ones only where it can be shown that it is the same.

A function is its code, what it holds (defaults, closure, attributes), what its global names stand for, and the files
of its module and of all that is imported there. Any other object is what ``pickle`` would write of it, which is how
it gets to another process. What is none of both has no fingerprint.
"""

from __future__ import annotations

import copyreg
import hashlib
import sys
from collections.abc import Collection, Iterator
from pathlib import Path
from types import (
    BuiltinFunctionType,
    CodeType,
    EllipsisType,
    FunctionType,
    MappingProxyType,
    MethodType,
    ModuleType,
    NoneType,
)
from typing import Any

from compare.engines import ByName, Unseen
from compare.run.code_files import CodeFiles, UnknownCodeError, located

ATOMS = (NoneType, bool, int, float, complex, str, bytes, EllipsisType)

CODE = (
    *("co_name", "co_code", "co_consts", "co_names", "co_varnames", "co_freevars", "co_cellvars", "co_flags"),
    *("co_argcount", "co_posonlyargcount", "co_kwonlyargcount"),
)
"""What a compiled function is, but for the names and numbers of its lines."""


def fingerprint(thing: Any, trusted: Collection[str] = ()) -> str:
    """Return what ``thing`` depends on; of packages that are ``trusted``, see :class:`CodeFiles`, by files alone.

    Raises
    ------
    UnknownCodeError
        If that can't be seen; the message says why.

    """
    code = CodeFiles(trusted)
    contents = _Contents(code)
    contents.add(thing)
    return hashlib.sha256(repr((contents.written, code.facts)).encode()).hexdigest()


class _Contents:
    """Writes down what an object consists of, each part once."""

    def __init__(self, code: CodeFiles) -> None:
        self.written: list[Any] = []
        self._code = code
        self._seen: dict[int, int] = {}
        self._kept: list[Any] = []  # no other object may come to have the same id

    def add(self, thing: Any) -> None:
        """Write down ``thing``."""
        if type(thing) in ATOMS:
            self.written.append((type(thing).__name__, repr(thing)))
            return
        if isinstance(thing, tuple) and type(thing) is tuple:  # whether two are one makes no difference
            self._add_all("tuple", thing)
            return
        if id(thing) in self._seen:
            self.written.append(("seen", self._seen[id(thing)]))
            return
        self._seen[id(thing)] = len(self._seen)
        self._kept.append(thing)
        if type(thing) is list:
            self._add_all("list", thing)
        elif type(thing) in (dict, MappingProxyType):
            self._add_all("dict", (part for item in thing.items() for part in item))
        elif type(thing) in (set, frozenset):  # which have no order
            parts = sorted(repr(self._alone(part)) for part in thing)
            self.written.append((type(thing).__name__, parts))
        elif isinstance(thing, CodeType):
            self._add_all("code", (getattr(thing, name) for name in CODE))
        elif isinstance(thing, FunctionType):
            self._add_function(thing)
        elif isinstance(thing, MethodType):
            self._add_all("method", (thing.__func__, thing.__self__))
        elif isinstance(thing, BuiltinFunctionType):
            self._add_built_in(thing)
        elif isinstance(thing, type):
            self._add_class(thing)
        elif isinstance(thing, ModuleType):
            self._code.add(thing.__name__)
            self.written.append(("module", thing.__name__))
        else:
            self._add_object(thing)

    def _add_all(self, kind: str, parts: Any) -> None:
        parts = tuple(parts)
        self.written.append((kind, len(parts)))
        for part in parts:
            self.add(part)

    def _alone(self, thing: Any) -> list[Any]:
        before, self.written = self.written, []
        self.add(thing)
        found, self.written = self.written, before
        return found

    def _add_function(self, function: FunctionType) -> None:
        module = str(function.__globals__.get("__name__"))
        cells = [_content(cell) for cell in function.__closure__ or ()]
        self.written.append(("function", module, function.__qualname__))
        for part in (
            function.__code__,
            function.__defaults__,
            function.__kwdefaults__,
            cells,
            vars(function),
        ):
            self.add(part)
        if not self._code.add(module):
            self.written.append(_of_file(function.__code__))
            return
        if self._code.trusts(module):
            return
        _require_file(function.__code__, module)
        names = sorted(set(_global_names(function.__code__)) & set(function.__globals__))
        self._add_all("globals", (part for name in names for part in (name, function.__globals__[name])))

    def _add_built_in(self, function: BuiltinFunctionType) -> None:
        owner = function.__self__
        if owner is not None and not isinstance(owner, ModuleType):
            self._add_all("method", (owner, function.__name__))
            return
        module = function.__module__ or "builtins"
        self._code.add(module)
        self.written.append(("built in", module, function.__qualname__))

    def _add_class(self, kind: type) -> None:
        """Write down a class: its name, the file that it is in, and what its functions and numbers are by now."""
        module, name = kind.__module__, kind.__qualname__
        if not _is_global(kind, module, name):
            raise UnknownCodeError(f"the class {kind.__name__} is made when the program runs")
        self.written.append(("class", module, name))
        if not self._code.add(module) or self._code.trusts(module):
            return
        for base in kind.__bases__:
            self.add(base)
        for key, value in sorted(vars(kind).items()):
            of_method = getattr(value, "__func__", getattr(value, "fget", value))
            made_here = isinstance(of_method, FunctionType) and Path(of_method.__code__.co_filename).exists()
            if made_here or type(value) in (*ATOMS, tuple, list, dict):
                self._add_all(key, (of_method,))

    def _add_object(self, thing: Any) -> None:
        kind = type(thing)
        if isinstance(thing, Unseen):
            raise UnknownCodeError(thing.why)
        if isinstance(thing, ByName):
            self._code.add(thing.module)
            self.written.append(("by name", thing.module, thing.function))
            if not self._code.trusts(thing.module):
                self.add(thing.imported)
            return
        function = getattr(thing, "py_func", None)
        compiled = any(base.__module__.partition(".")[0] == "numba" for base in kind.__mro__)
        if compiled and isinstance(function, FunctionType):
            self._code.add("numba")
            self._add_all("compiled", (function, dict(thing.targetoptions)))
            return
        try:
            reduce = copyreg.dispatch_table.get(kind)
            reduced = thing.__reduce_ex__(2) if reduce is None else reduce(thing)
        except Exception as error:  # whatever an object's own code raises
            raise UnknownCodeError(
                f"an object of the class {kind.__name__} can't be written down: {error}"
            ) from None
        if isinstance(reduced, str):  # the name of something that every process has
            module = getattr(thing, "__module__", None) or kind.__module__
            self.written.append(("name", module, reduced))
            if self._code.add(module):  # to what is installed, other packages may attach things of their own
                around = (getattr(thing, "__wrapped__", None), getattr(thing, "__dict__", None))
                self._add_all("around", around)
            return
        make, arguments, state, items, pairs = (*reduced, None, None, None)[:5]
        parts = (make, arguments, state, list(items or ()), list(pairs or ()))
        self.add(kind)
        self._kept.append(parts)
        self._add_all("object", parts)


def _content(cell: Any) -> Any:
    try:
        return cell.cell_contents
    except ValueError:  # empty still
        return ("empty",)


def _global_names(code: CodeType) -> Iterator[str]:
    """Yield the names that a function and those inside of it look up."""
    yield from code.co_names
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _global_names(constant)


def _is_global(thing: object, module: str, name: str) -> bool:
    found: Any = sys.modules.get(module)
    for part in name.split("."):
        found = getattr(found, part, None)
    return found is thing


def _require_file(code: CodeType, module: str) -> None:
    """Raise ``UnknownCodeError`` unless the code comes from the file of its module."""
    place = located(module)
    file = None if place is None else place.file
    if file is None or not _same_file(Path(code.co_filename), file):
        raise UnknownCodeError(f"{code.co_name} is not defined in a file")


def _of_file(code: CodeType) -> str:
    """Return what the file of an installed function comes to, "" for one that is built into Python."""
    path = Path(code.co_filename)
    return hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else ""


def _same_file(one: Path, other: Path) -> bool:
    return one.exists() and other.exists() and one.samefile(other)
