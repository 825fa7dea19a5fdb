"""Compiled simulation of the end states of many trajectories.

- ``simulate``: :func:`simulate_ensemble`; ``end_states``: its results;
- ``core``: lanes of trajectories in vector registers, forces, explicit steps, and steps by the core;
- ``pin``, ``disc``: slip and rest (``slip``, ``rest``), end states (``events``, ``trapping``), and ``kernel`` with
  ``driver``, which combine them. The core alone simulates nonlinear supports and laws given as ``contact``.
"""

from reference_model.ensemble.end_states import EndState, Ensemble
from reference_model.ensemble.simulate import simulate_ensemble

__all__ = ["EndState", "Ensemble", "simulate_ensemble"]
