"""Kernels that are compiled when the package is built, into the files that :mod:`.machine_code` reads.

numba translates a kernel once, and LLVM compiles it for each level of the instruction set. What of numba's own a
kernel calls, to have room for arrays, is compiled into it: no version of numba must be there where it runs.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numba
import numba.core.config
from llvmlite import binding
from numba.core.codegen import JITCPUCodegen
from numba.core.compiler_lock import global_compiler_lock

from reference_model.numerics.compiled_parts import Part
from reference_model.numerics.machine_code import file_for, kind_of

config: Any = numba.core.config  # made of the environment, so that its names are not known

ROOM_FOR_ARRAYS = """
declare ptr @malloc(i64)
declare void @free(ptr)

define ptr @NRT_MemInfo_alloc_aligned(i64 %size, i32 %align) {
  %boundary = zext i32 %align to i64
  %head = add i64 %boundary, 48
  %whole = add i64 %size, %head
  %info = call ptr @malloc(i64 %whole)
  %failed = icmp eq ptr %info, null
  br i1 %failed, label %nothing, label %something
nothing:
  ret ptr null
something:
  %start = ptrtoint ptr %info to i64
  %beyond = add i64 %start, %head
  %mask = sub i64 0, %boundary
  %aligned = and i64 %beyond, %mask
  %data = inttoptr i64 %aligned to ptr
  %destructor = getelementptr i64, ptr %info, i64 1
  %its_data = getelementptr i64, ptr %info, i64 2
  %place = getelementptr i64, ptr %info, i64 3
  %bytes = getelementptr i64, ptr %info, i64 4
  %allocator = getelementptr i64, ptr %info, i64 5
  store i64 1, ptr %info
  store ptr null, ptr %destructor
  store ptr null, ptr %its_data
  store ptr %data, ptr %place
  store i64 %size, ptr %bytes
  store ptr null, ptr %allocator
  ret ptr %info
}

define ptr @NRT_MemInfo_data_fast(ptr %info) {
  %place = getelementptr i64, ptr %info, i64 3
  %data = load ptr, ptr %place
  ret ptr %data
}

define void @NRT_MemInfo_call_dtor(ptr %info) {
  call void @free(ptr %info)
  ret void
}

define i32 @numba_attempt_nocopy_reshape(
    i64 %nd, ptr %shape, ptr %strides, i64 %newnd, ptr %newshape, ptr %newstrides, i64 %itemsize, i32 %fortran) {
entry:
  br label %next
next:
  %left = phi i64 [ %newnd, %entry ], [ %dimension, %one ]
  %stride = phi i64 [ %itemsize, %entry ], [ %wider, %one ]
  %done = icmp eq i64 %left, 0
  br i1 %done, label %end, label %one
one:
  %dimension = sub i64 %left, 1
  %its_stride = getelementptr i64, ptr %newstrides, i64 %dimension
  store i64 %stride, ptr %its_stride
  %its_length = getelementptr i64, ptr %newshape, i64 %dimension
  %length = load i64, ptr %its_length
  %wider = mul i64 %stride, %length
  br label %next
end:
  ret i32 1
}
"""
"""What stands in for numba's runtime: its record of an array's memory, and another shape of what is contiguous."""


def compile_ahead(
    function: Callable[..., Any], arguments: tuple[Any, ...], levels: tuple[str, ...]
) -> Iterator[Path]:
    """Compile ``function`` for ``arguments`` like these; yield the files, one for each of ``levels``.

    A file that is there already is left as it is; one that was made of other sources goes.
    """
    files = {level: file_for(function, kind_of(arguments), level) for level in levels}
    missing = [level for level, file in files.items() if not file.exists()]
    if missing:
        with global_compiler_lock:
            whole = _translated(function, arguments)
            for level in missing:
                code = _compiled(whole, function.__name__, level)
                _put(code, files[level], function.__name__)
    yield from files.values()


def _put(code: bytes, file: Path, name: str) -> None:
    """Write a file whole or not at all, in place of those that were made of other sources."""
    file.parent.mkdir(parents=True, exist_ok=True)
    for other in file.parent.glob(f"{name}-*.o"):
        other.unlink(missing_ok=True)
    unfinished = file.with_suffix(f".{os.getpid()}")
    unfinished.write_bytes(code)
    unfinished.replace(file)


def _translated(function: Callable[..., Any], arguments: tuple[Any, ...]) -> Any:
    """Return all that ``function`` needs in LLVM's language, for no processor in particular."""
    part = Part(function, targetoptions={"error_model": "numpy"})
    kinds = tuple(numba.typeof(argument) for argument in arguments)
    part.compile(kinds)
    result: Any = next(iter(part.overloads.values()))
    whole = result.library._get_module_for_linking()
    whole.link_in(binding.parse_assembly(ROOM_FOR_ARRAYS))
    for own in whole.functions:
        if not own.is_declaration:
            own.linkage = binding.Linkage.internal
    outermost = whole.get_function(result.fndesc.llvm_func_name)
    outermost.linkage, outermost.name = binding.Linkage.external, function.__name__
    return whole


def _compiled(whole: Any, name: str, level: str) -> bytes:
    """Return the object file for processors of a level."""
    with _for_processors(level):
        library = JITCPUCodegen(level).create_library(name)
        library.enable_object_caching()
        library.add_llvm_module(whole.clone())
        library.finalize()
        code: bytes = library._get_compiled_object()
    return code


@contextmanager
def _for_processors(level: str) -> Iterator[None]:
    """Let numba compile for them."""
    before = config.CPU_NAME, config.CPU_FEATURES
    config.CPU_NAME, config.CPU_FEATURES = level, ""
    try:
        yield
    finally:
        config.CPU_NAME, config.CPU_FEATURES = before
