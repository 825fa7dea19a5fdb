"""How functions of the plain engine are compiled: once, and kept on disk."""

import numba

compiled = numba.njit(cache=True, error_model="numpy")
