"""Compilation of the plain engine's functions, cached on disk."""

import numba

compiled = numba.njit(cache=True, error_model="numpy")
