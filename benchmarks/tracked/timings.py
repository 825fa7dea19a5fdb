"""Times and numbers of evaluations that ``asv`` records; the programs in ``benchmarks/`` measure them."""

from __future__ import annotations

import sys
from functools import partial
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).parents[1]))
import ensemble
import reference_evaluations
import single_runs

from reference_model import simulate


class SingleMotions:
    """Time of one motion, at 501 times."""

    params = (list(single_runs.MOTIONS), [False, True])
    param_names = ("motion", "compiled")
    timeout = 600.0  # includes compiling the core, once on a machine

    def setup(self, motion: str, compiled: bool) -> None:
        """Prepare the call, and compile or load the core."""
        system, start, duration = single_runs.MOTIONS[motion]
        times = np.linspace(0.0, duration, 501)
        self.run = partial(simulate, system, start, times, compiled=compiled)
        self.run()

    def time_motion(self, motion: str, compiled: bool) -> None:
        """Simulate the motion."""
        self.run()


class Ensembles:
    """Time of 10,000 starts of Fig. 5 on all processors."""

    params = ("full_length", "early_end")
    param_names = ("way",)
    timeout = 600.0

    def setup(self, way: str) -> None:
        """Prepare the starts, and compile or load the kernels."""
        self.run, self.states = getattr(ensemble, way), ensemble.starts(10_000)
        self.run(self.states[:64])

    def time_ensemble(self, way: str) -> None:
        """Simulate the starts."""
        self.run(self.states)


class Evaluations:
    """Evaluations of the right-hand side that a motion of Fig. 5 needs; they do not depend on the machine's load."""

    params = (["this_reference", "plain_events", "regularised"], [0, 1])
    param_names = ("way", "start")
    unit = "evaluations"

    def track_evaluations(self, way: str, start: int) -> int:
        """Count them."""
        return getattr(reference_evaluations, way)(reference_evaluations.STARTS[start])[0]
