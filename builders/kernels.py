"""Compile the kernels of ensembles beforehand, as a wheel brings them: ``python builders/kernels.py [--all-levels]``.

Pins, discs on rings and on six points, each as an object file for this processor, or for all levels of the
instruction set for which there are such files. What is there already stays as it is.
"""

from __future__ import annotations

import sys
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

from reference_model.ensemble import simulate_ensemble
from reference_model.ensemble.core.jit import Outermost
from reference_model.numerics.compiled_ahead import compile_ahead
from reference_model.numerics.machine_code import LEVELS, levels_here
from reference_model.systems import DiscOnDisc, PinOnDisc, System

PIN = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=1.0, disc_speed=1.0)
RING = DiscOnDisc(
    mass=1.0, polar_inertia=1.0, stiffness=1.0, damping=0.1, friction_force=1.0, disc_speed=1.0, contact_radius=1.0,
    shaft_damping=0.1, shaft_speed=0.0,
)  # fmt: skip
SYSTEMS: tuple[System, ...] = (PIN, RING, replace(RING, contact_points=6))


def compile_for(levels: tuple[str, ...], system: System) -> list[Path]:
    """Compile the kernel in which ensembles of a system run, instead of running it; return the files."""
    files: list[Path] = []

    def compiled(kernel: Outermost, *arguments: Any) -> None:
        files.extend(compile_ahead(kernel.py_func, arguments, levels))

    with mock.patch.object(Outermost, "__call__", compiled):
        start = np.zeros((1, system.state_size))
        simulate_ensemble(system, start, duration=1.0, parameters={"mass": [1.0]})
    return files


def main() -> None:
    """Compile all, one system on each processor at a time."""
    levels = tuple(LEVELS) if "--all-levels" in sys.argv[1:] else levels_here()[:1]
    with ProcessPoolExecutor() as pool:
        for files in pool.map(partial(compile_for, levels), SYSTEMS):
            for file in files:
                print(f"{file}: {file.stat().st_size / 1e3:.0f} kB")


if __name__ == "__main__":
    main()
