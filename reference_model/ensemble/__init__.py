"""Many trajectories at once, compiled: where they end; and a single one, phase by phase.

- ``simulate``: :func:`simulate_ensemble`, the door; ``results``: what it returns;
- ``lanes``: how trajectories share a processor; ``runge_kutta``: the step; ``implicit``: that of stiff motions;
  ``compiled``: what numba is told;
- ``linear``: what both need of linear algebra;
- of a pin ``pin_slip`` (equations, rest, release), ``pin_lanes`` (its lanes), ``arc`` (the motion inside of a step),
  ``pin_ends`` with ``regions`` and ``pin_stability`` (how its end state is told), ``pin_watch`` with ``pin_book``
  and ``pin_stride`` (what is rare, done lane by lane), and ``pin`` with ``pins``, which put them together;
- of a disc ``contact_shares`` (friction), ``disc_slip``, ``disc_growth`` (slip from rest), ``disc_stride``,
  ``disc_lanes``, ``disc_kernel``, ``disc_stability`` and ``disc_regions`` (where it ends), and ``disc``, which puts
  them together;
- ``single`` with ``recording``: ``reference_model.simulate(..., compiled=True)``, from ``notes`` of kernels.

The plain :func:`reference_model.simulate` judges it: but for handing over to here when asked to, nothing there takes
anything from here.
"""

from reference_model.ensemble.end_states import EndState, Ensemble
from reference_model.ensemble.simulate import simulate_ensemble

__all__ = ["EndState", "Ensemble", "simulate_ensemble"]
