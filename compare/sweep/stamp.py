"""What the numbers of a sweep depend on: less than all that the packages can do."""

from __future__ import annotations

from compare.store import stamp

CODE = (
    "reference_model",
    "compare.export",  # the order of a state's components
    "compare.sweep.axes",
    "compare.sweep.curves",
    "compare.sweep.distributions",
    "compare.sweep.plain",
    "compare.sweep.plan",
    "compare.sweep.quantities",
    "compare.sweep.refinement",
    "compare.sweep.results",
    "compare.sweep.run",
    "compare.sweep.sensitivity",
    "compare.sweep.shares",
    "compare.sweep.store",
    "compare.sweep.work",
)
"""The packages and modules that compute them and put them into a store."""

LIBRARIES = ("numpy", "scipy", "numba")


def sweep_stamp() -> str:
    """Return what must be the same for two parts of a sweep to belong together."""
    return stamp(code=CODE, libraries=LIBRARIES)
