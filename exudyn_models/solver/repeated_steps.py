"""States that Exudyn's implicit solvers do not restore before they repeat a step.

Exudyn 1.13 repeats a step in two ways, and either one loses a state from the start of the step:

- Modified Newton that contracts badly starts the step over. The rates of all coordinates of first order, such as heat
  and works, stay those of the iterate that diverged (``examples/11_exudyn_first_order_rates.py``).
- A rejected step is repeated with a smaller size. Generalised-α keeps the algorithmic accelerations of the rejected
  one, which changes all velocities.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import exudyn as exu

WITHOUT_RESTART = {
    "modifiedNewtonContractivity": 1e300,
    "maxModifiedNewtonIterations": 1,  # then a new Jacobian for each iteration, as full Newton has it
    "maxModifiedNewtonRestartIterations": 1_000_000,
    "modifiedNewtonJacUpdatePerStep": False,
}


@contextmanager
def newton_without_restart(mbs: Any, newton: Any) -> Iterator[None]:
    """Let modified Newton renew its Jacobian in place of a restart if the model has coordinates of first order."""
    if mbs.systemData.ODE1Size() == 0:
        yield
        return
    before = {name: getattr(newton, name) for name in WITHOUT_RESTART}
    try:
        for name, value in WITHOUT_RESTART.items():
            setattr(newton, name, value)
        yield
    finally:
        for name, value in before.items():
            setattr(newton, name, value)


@contextmanager
def restored_accelerations(mbs: Any) -> Iterator[None]:
    """Let generalised-α repeat a rejected step from the algorithmic accelerations at its start.

    Exudyn restores them when a function after Newton's method reports a discontinuity, so this one reports one, once,
    for each repeated step. The functions that the model itself has there are still called.
    """
    hooks: Any = mbs.GetPreStepUserFunction(), mbs.GetPostNewtonUserFunction()
    own_pre_step, own_post_newton = (hook["function"] if hook else 0 for hook in hooks)
    last_start, spoilt = math.nan, False

    def pre_step(mbs: Any, t: float) -> bool:
        nonlocal last_start, spoilt
        start = mbs.systemData.GetTime(exu.ConfigurationType.StartOfStep)
        last_start, spoilt = start, start == last_start
        return bool(own_pre_step(mbs, t)) if own_pre_step else True

    def post_newton(mbs: Any, t: float) -> Any:
        nonlocal spoilt
        if spoilt:
            spoilt = False
            return [math.inf, -1.0]
        return own_post_newton(mbs, t) if own_post_newton else [0.0, -1.0]

    mbs.SetPreStepUserFunction(pre_step)
    mbs.SetPostNewtonUserFunction(post_newton)
    try:
        yield
    finally:
        mbs.SetPreStepUserFunction(own_pre_step)
        mbs.SetPostNewtonUserFunction(own_post_newton)
