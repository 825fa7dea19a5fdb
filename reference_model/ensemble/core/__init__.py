"""Common parts of the kernels of pins and discs: lanes, laws, requested times and convergence."""
