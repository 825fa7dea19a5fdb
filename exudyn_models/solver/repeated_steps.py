"""States that Exudyn's implicit solvers do not restore before they repeat a step, restored here.

- Modified Newton that contracts badly starts a step over. The rates of all coordinates of first order, such as heat
  and works, stay those of the iterate that diverged (``examples/11_exudyn_first_order_rates.py``).
- A rejected step is repeated with a smaller size. Generalised-α keeps the algorithmic accelerations of the rejected
  one, which changes all velocities.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
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
    values = WITHOUT_RESTART if mbs.systemData.ODE1Size() else {}
    before = {name: getattr(newton, name) for name in values}
    try:
        for name, value in values.items():
            setattr(newton, name, value)
        yield
    finally:
        for name, value in before.items():
            setattr(newton, name, value)


@contextmanager
def user_function(mbs: Any, place: str, wrap: Callable[[Any], Any]) -> Iterator[None]:
    """Have Exudyn call what ``wrap`` makes of the model's own function, or of one that does nothing.

    ``place`` is "PreStep", "PostNewton" or "PostStep".
    """
    before = getattr(mbs, f"Get{place}UserFunction")()
    own = before["function"] if before else 0
    result = [0.0, -1.0] if place == "PostNewton" else True
    replace_by = getattr(mbs, f"Set{place}UserFunction")
    replace_by(wrap(own or (lambda mbs, t: result)))
    try:
        yield
    finally:
        replace_by(own)


@contextmanager
def restored_accelerations(mbs: Any) -> Iterator[None]:
    """Let generalised-α repeat a rejected step from the algorithmic accelerations at its start.

    Exudyn restores them when a function after Newton's method reports a discontinuity, so this one reports one, once
    for each repeated step.
    """
    last_start, spoilt = math.nan, False

    def note(mbs: Any, own: Any, t: float) -> Any:
        nonlocal last_start, spoilt
        start = mbs.systemData.GetTime(exu.ConfigurationType.StartOfStep)
        last_start, spoilt = start, start == last_start
        return own(mbs, t)

    def restore(mbs: Any, own: Any, t: float) -> Any:
        nonlocal spoilt
        was_spoilt, spoilt = spoilt, False
        return [math.inf, -1.0] if was_spoilt else own(mbs, t)

    with (
        user_function(mbs, "PreStep", lambda own: lambda mbs, t: note(mbs, own, t)),
        user_function(mbs, "PostNewton", lambda own: lambda mbs, t: restore(mbs, own, t)),
    ):
        yield
