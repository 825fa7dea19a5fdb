"""Sweeps of many trajectories: basins of attraction, maps of two parameters, uncertain parameters.

Their stores need the extra ``sweep``; without it, importing this package raises ``ModuleNotFoundError``.
"""

from importlib.util import find_spec

NEEDED = ("fsspec", "xarray", "zarr")
EXTRA = "friction-discs[sweep]"

if _missing := [name for name in NEEDED if find_spec(name) is None]:
    raise ModuleNotFoundError(
        f"sweeps need {', '.join(_missing)}; install with: pip install {' '.join(_missing)}",
        name=EXTRA,
    )
