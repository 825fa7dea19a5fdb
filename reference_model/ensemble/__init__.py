"""Many trajectories at once, compiled: where they end; and a single one, phase by phase.

- ``simulate``: :func:`simulate_ensemble`, the door; ``end_states``: what it returns;
- ``core``: how trajectories share a processor (``lanes``), the forces (``laws``, ``contact_shares``), the step
  (``runge_kutta``) and that of stiff motions (``implicit``), the motion inside of a step (``dense_output``), when a
  series of distances has converged (``convergence``), what numba is told (``jit``);
- ``pin``: its equations, rest and release (``slip``), its lanes, how its end state is told (``end_states`` with
  ``trapping`` and ``stability``), what is rare and done lane by lane (``events`` with ``memory`` and ``stride``), and
  ``kernel`` with ``driver``, which put them together;
- ``disc``: the same, with ``breakaway`` for slip from rest;
- ``single_run`` with ``recording``: ``reference_model.simulate(..., compiled=True)``, from the ``checkpoints`` of
  kernels.

The plain :func:`reference_model.simulate` judges it: but for handing over to here when asked to, nothing there takes
anything from here.
"""

from reference_model.ensemble.end_states import EndState, Ensemble
from reference_model.ensemble.simulate import simulate_ensemble

__all__ = ["EndState", "Ensemble", "simulate_ensemble"]
