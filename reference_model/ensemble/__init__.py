"""Compiled simulation: end states of many trajectories, or one trajectory phase by phase.

- ``simulate``: :func:`simulate_ensemble`, the entry point; ``end_states``: its results;
- ``core``: lanes of trajectories in a vector register (``lanes``), forces (``laws``, ``contact_shares``), explicit
  (``runge_kutta``) and implicit steps (``implicit``), dense output, convergence of distances (``convergence``), and
  the decorators for numba (``jit``);
- ``pin``: rest and release (``slip``), lanes, end states (``end_states`` with ``trapping`` and ``stability``), rare
  events in scalar code (``events`` with ``memory`` and ``stride``), and ``kernel`` with ``driver``, which combine
  them;
- ``disc``: the same modules, with ``breakaway`` for slip from rest;
- ``single_run`` with ``recording``: ``reference_model.simulate(..., compiled=True)``, from the ``checkpoints`` of
  kernels.

The plain :func:`reference_model.simulate` is the yardstick: it uses nothing of this package, except to call it on
request.
"""

from reference_model.ensemble.end_states import EndState, Ensemble
from reference_model.ensemble.simulate import simulate_ensemble

__all__ = ["EndState", "Ensemble", "simulate_ensemble"]
