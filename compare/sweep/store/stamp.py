"""What the numbers of a sweep depend on: less than all that the packages can do."""

from __future__ import annotations

from compare.run.stamp import stamp

CODE = (
    "reference_model",
    "compare.claims.as_json",
    "compare.output.outside_text",
    "compare.sweep.define.axes",
    "compare.sweep.compute.branches",
    "compare.sweep.compute.curves",
    "compare.sweep.store.files",
    "compare.sweep.define.distributions",
    "compare.sweep.compute.motions",
    "compare.sweep.compute.plain",
    "compare.sweep.define.plan",
    "compare.sweep.define.quantities",
    "compare.sweep.define.refinement",
    "compare.sweep.compute.results",
    "compare.sweep.store.round",
    "compare.sweep.compute.run",
    "compare.sweep.compute.sensitivity",
    "compare.claims.shares",
    "compare.sweep.store.store",
    "compare.sweep.compute.work",
)
"""The packages and modules that compute them and put them into a store."""

LIBRARIES = ("numpy", "scipy", "numba")


def sweep_stamp() -> str:
    """Return what must be the same for two parts of a sweep to belong together."""
    return stamp(code=CODE, libraries=LIBRARIES)
