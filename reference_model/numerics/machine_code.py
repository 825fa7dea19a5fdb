"""Machine code that was made when the package was built: looked up by content, loaded, and called as C functions are.

A kernel takes ten seconds to compile. The wheel brings it for two levels of the instruction set of x86-64, as object
files that need the C library and nothing of Python's or numba's. What they are compiled from is in their names: with
a changed source, or for arguments of another kind, none is found, and none is taken on a lesser processor. There the
kernel is compiled where it runs, and comes to the same bits. :mod:`.compiled_ahead` makes the files.
"""

from __future__ import annotations

import ctypes
import hashlib
import os
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from llvmlite import binding

from reference_model.numerics.compiled_cache import sources_digest

_AVX2 = ("avx", "avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe")
LEVELS = {
    "x86-64-v4": (*_AVX2, "avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl"),
    "x86-64-v3": _AVX2,
}
"""Levels of the instruction set, as LLVM names them, the best first; and what a processor must have for them."""

FOLDER = "built"
"""Beside the module of a kernel: a folder for each level."""


@cache
def levels_here() -> tuple[str, ...]:
    """Return the levels that this processor has, on Linux; none if numba is told to compile for another one."""
    if sys.platform != "linux" or {"NUMBA_CPU_NAME", "NUMBA_CPU_FEATURES"} & {*os.environ}:
        return ()
    features = binding.get_host_cpu_features()
    return tuple(level for level, asked in LEVELS.items() if all(features.get(one) for one in asked))


def file_for(function: Callable[..., Any], kind: str, level: str) -> Path:
    """Return where the machine code of ``function`` for arguments of a kind is, if it was made."""
    made_of = sources_digest(function.__module__), _maker(), kind
    content = hashlib.sha256(repr(made_of).encode()).hexdigest()[:16]
    return _folder(function) / level / f"{function.__name__}-{content}.o"


def machine_code(function: Callable[..., Any], kind: str) -> MachineCode | None:
    """Return ``function`` for arguments of a kind, as it was compiled beforehand; None if it was not for here."""
    for level in levels_here():
        file = file_for(function, kind, level)
        if file.exists():
            return MachineCode(file, function.__name__)
    return None


@cache
def _maker() -> str:
    return hashlib.sha256(Path(__file__).with_name("compiled_ahead.py").read_bytes()).hexdigest()


def _folder(function: Callable[..., Any]) -> Path:
    return Path(function.__code__.co_filename).parent / FOLDER


def kind_of(arguments: tuple[Any, ...]) -> str:
    """Return of what kind arguments are, and what is in them: all for which compiled code is another."""
    kinds = []
    for argument in arguments:
        if isinstance(argument, np.ndarray):
            flags = argument.flags
            kinds.append(
                f"{_written(argument.dtype)}[{argument.ndim}]{flags.c_contiguous:d}{flags.writeable:d}"
            )
        elif isinstance(argument, tuple):
            kinds.append(f"{type(argument).__name__}({kind_of(argument)})")
        else:
            kinds.append(type(argument).__name__)
    return ",".join(kinds)


@cache
def _written(dtype: np.dtype[Any]) -> str:
    return str(dtype)


class MachineCode:
    """A function of an object file.

    Parameters
    ----------
    path : Path
        Of the object file.
    name : str
        Of the function.

    """

    def __init__(self, path: Path, name: str) -> None:
        """Load it; raises ``OSError`` or ``RuntimeError`` if that can't be done."""
        binding.initialize_native_target()
        binding.initialize_native_asmprinter()
        target = binding.Target.from_default_triple().create_target_machine(jit=True)
        self._engine = binding.create_mcjit_compiler(binding.parse_assembly(""), target)
        self._engine.add_object_file(binding.ObjectFileRef.from_path(str(path)))
        self._engine.finalize_object()
        self._address = self._engine.get_function_address(name)
        self._name = name
        self._function: Any = None

    def __call__(self, *arguments: Any) -> None:
        """Call it, without Python's lock; arrays are C-contiguous, and other arguments numbers and tuples of these.

        Raises ``MemoryError`` if it says that it went wrong: nothing else can in a kernel.
        """
        flat = _flat(arguments)
        if self._function is None:
            kinds = (ctypes.c_double if type(one) is float else ctypes.c_int64 for one in flat)
            prototype = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_void_p, ctypes.c_void_p, *kinds)
            self._function = prototype(self._address)
        returned, error = ctypes.c_void_p(), ctypes.c_void_p()
        if self._function(ctypes.addressof(returned), ctypes.addressof(error), *flat):
            raise MemoryError(f"{self._name} found no memory for its work")


def _flat(arguments: tuple[Any, ...]) -> list[float]:
    """Return all numbers of arguments as compiled code takes them.

    Of an array: its owner, as whom nobody is named, twice, how many items it has, their size, where they are, its
    shape and its strides.
    """
    flat: list[float] = []
    for argument in arguments:
        if isinstance(argument, np.ndarray):
            flat += (0, 0, argument.size, argument.itemsize, argument.ctypes.data)
            flat += argument.shape
            flat += argument.strides
        elif isinstance(argument, tuple):
            flat += _flat(argument)
        else:
            flat.append(argument)
    return flat
