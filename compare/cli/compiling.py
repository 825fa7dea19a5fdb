"""``friction-discs compile``: what else the first run of each kind would have to wait for."""

from __future__ import annotations

from compare.cli.door.progress import measurements


def compile_kernels() -> None:
    """Compile all kernels for this machine and keep them, for images and nodes of clusters.

    They are kept beside the installed modules, or in the folder that NUMBA_CACHE_DIR names.

    \b
    Example:
      friction-discs compile
    """
    from compare.run.kernels import kernels

    with measurements() as show:
        every = list(kernels())
        for done, (name, make) in enumerate(every):
            show(done, len(every), name)
            make()
    print(f"All {len(every)} kernels are compiled and kept.")
