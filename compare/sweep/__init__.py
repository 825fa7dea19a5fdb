"""Many trajectories at once: basins of attraction, maps over two parameters, uncertain parameters.

What their stores need comes with the extra ``sweep``; without it an import of anything in here says so.
"""

from importlib.util import find_spec

NEEDED = ("fsspec", "xarray", "zarr")
"""Of the extra ``sweep``."""

EXTRA = "friction-discs[sweep]"

if _missing := [name for name in NEEDED if find_spec(name) is None]:
    raise ModuleNotFoundError(
        f"a sweep needs {EXTRA} (missing: {', '.join(_missing)}): pip install '{EXTRA}'", name=EXTRA
    )
