"""Common parts of the kernels of pins and discs."""
