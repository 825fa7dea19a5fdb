"""The recorded ladders of runs with ever smaller tolerance, and what is read off them."""

from __future__ import annotations

import functools

import numpy as np

from compare.foreign.records import STEPS, Recording, recordings
from compare.studies.engines.foreign_engines.parameters import HALVED
from reference_model.systems import FloatArray


@functools.cache
def recorded() -> tuple[Recording, ...]:
    """Return all recordings, read once."""
    return recordings()


def halvings(runs: FloatArray) -> FloatArray:
    """Return those last of ``runs`` between which the step was halved each time, shape (m, columns)."""
    ratios = runs[1:, STEPS] / runs[:-1, STEPS]
    strange = np.nonzero(np.abs(ratios - 2.0) > HALVED)[0]
    # A ladder may end in a step that is the engine's smallest.
    if strange.size and strange[-1] == len(ratios) - 1:
        return halvings(runs[:-1])
    return runs[strange[-1] + 1 :] if strange.size else runs
