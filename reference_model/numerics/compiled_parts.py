"""Functions that are compiled as parts of others: what only compiled code calls.

Of every function numba makes machine code of its own, in which all that it calls is optimised and written once more,
and wrappers by which Python could call it. That is most of the time that compiling takes where kernels consist of a
hundred functions. A part is left in LLVM's intermediate representation instead, without wrappers. A function that
Python calls takes up the parts that it needs, each once, and all is optimised together.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any

from llvmlite import binding
from numba.core import event, sigutils, types
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.compiler_lock import global_compiler_lock
from numba.core.compiler_machinery import register_pass
from numba.core.registry import CPUDispatcher

from reference_model.numerics.compiled_once import Kept
from reference_model.numerics.vector_width import WideLowering, with_lowering


class Part(CPUDispatcher):
    """A function that is compiled into those that call it; and by itself, and kept, if Python calls it."""

    def __init__(
        self,
        py_func: Callable[..., Any],
        locals: dict[str, Any] | None = None,
        targetoptions: dict[str, Any] | None = None,
    ) -> None:
        options = {"nopython": True, "boundscheck": None, **(targetoptions or {})}
        super().__init__(py_func, locals or {}, options, PartCompiler)

    def __call__(self, *args: Any) -> Any:
        """Call it by :attr:`called_by_python`."""
        return self.called_by_python(*args)

    @cached_property
    def called_by_python(self) -> Kept:
        """The same function, compiled for Python."""
        return Kept(self.py_func, targetoptions={"error_model": "numpy"})

    def compile(self, sig: Any) -> Any:
        """Translate for arguments of these types, which stand for all of their values."""
        with global_compiler_lock, self._compiling_counter:
            args, return_type = sigutils.normalize_signature(sig)
            args = tuple(types.unliteral(kind) for kind in args)
            if args not in self.overloads:
                with event.trigger_event(
                    "numba:compile", {"dispatcher": self, "args": args, "return_type": return_type}
                ):
                    self.add_overload(self._compiler.compile(args, return_type))  # type: ignore[attr-defined]
            return self.overloads[args].entry_point  # type: ignore[attr-defined]


class _PartLibrary(JITCodeLibrary):
    """What a part comes to; it is finished only where it is taken up."""

    def add_linking_library(self, library: Any) -> None:
        self._linking_libraries.append(library)

    def finalize(self) -> None:
        self._raise_if_finalized()
        self._finalized = True

    def _get_module_for_linking(self) -> Any:
        """Return all of what this part needs, each other part once."""
        if self._shared_module is None:
            whole, *others = self._needed({})
            self._shared_module = whole._own_module.clone()
            for other in others:  # what calls others stands before them: only what is called is linked
                part = isinstance(other, _PartLibrary)
                module = other._own_module if part else other._get_module_for_linking()
                self._shared_module.link_in(module, preserve=True)
        return self._shared_module

    def _needed(self, known: dict[Any, None]) -> dict[Any, None]:
        """Put this part, and then all that it needs, into what is ``known``; return that."""
        known[self] = None
        for library in self._linking_libraries:
            if library not in known:
                known[library] = None
                if isinstance(library, _PartLibrary):
                    library._needed(known)
        return known

    @cached_property
    def _own_module(self) -> Any:
        """Return the module of this part alone, of which there may be copies."""
        for function in self._final_module.functions:
            if not function.is_declaration and function.linkage == binding.Linkage.external:
                function.linkage = "linkonce_odr"
        return self._final_module


@register_pass(mutates_CFG=True, analysis_only=False)
class _PartLowering(WideLowering):
    """Translates into a ``_PartLibrary``."""

    _name = "part_lowering"

    def run_pass(self, state: Any) -> bool:
        target = state.targetctx
        state.library = _PartLibrary(target.codegen(), state.func_id.func_qualname)
        super().run_pass(state)
        lowered = state["cr"]
        entry = object().__reduce__  # numba finds what it has compiled by some built-in method of its own
        target.insert_user_function(entry, lowered.fndesc, [state.library])
        state["cr"] = lowered._replace(cfunc=entry)
        return True


class PartCompiler(Compiler):
    """Compiles as numba does, up to machine code; also for ``numba.extending.overload``."""

    def define_pipelines(self) -> list[Any]:
        """Return numba's passes with another one for the last step."""
        flags = self.state.flags
        flags.no_compile = flags.no_cpython_wrapper = flags.no_cfunc_wrapper = True
        (passes,) = super().define_pipelines()
        return with_lowering(passes, _PartLowering)
