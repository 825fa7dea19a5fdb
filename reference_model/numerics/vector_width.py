"""Vectors as wide as the processor has them, in functions of this package and in no others.

LLVM keeps to 256 bits on many processors that have 512, since their clock once fell by wide vectors. Lanes full of
arithmetic gain more than that loses: ``benchmarks/ensemble.py`` has figures. No bit of a result depends on the width.
"""

from __future__ import annotations

from typing import Any

from numba.core import lowering, typed_passes
from numba.core.compiler import Compiler
from numba.core.compiler_machinery import register_pass

WIDEST = '"prefer-vector-width"="512"'
"""An attribute of a function in LLVM; it means nothing to a processor without such vectors."""


class _WideLower(lowering.Lower):
    def setup_function(self, fndesc: Any) -> None:
        super().setup_function(fndesc)  # type: ignore[no-untyped-call]
        set.add(self.function.attributes, WIDEST)  # llvmlite's own ``add`` knows no attributes with values


@register_pass(mutates_CFG=True, analysis_only=False)  # type: ignore[no-untyped-call]
class WideLowering(typed_passes.NativeLowering):
    """Translates into functions with the widest vectors."""

    _name = "wide_lowering"

    @property
    def lowering_class(self) -> Any:
        """Return what writes the function."""
        return _WideLower


def with_lowering(passes: Any, kind: type[WideLowering]) -> list[Any]:
    """Return numba's passes with another one for the translation into LLVM's language."""
    passes.passes = [
        (kind if one is typed_passes.NativeLowering else one, what) for one, what in passes.passes
    ]
    passes._finalized = False
    passes.finalize()
    return [passes]


class WideCompiler(Compiler):
    """Compiles as numba does, with the widest vectors."""

    def define_pipelines(self) -> list[Any]:
        """Return numba's passes with that translation."""
        (passes,) = super().define_pipelines()  # type: ignore[no-untyped-call]
        return with_lowering(passes, WideLowering)
