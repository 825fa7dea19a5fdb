"""Restoration of states that Exudyn's implicit solvers leave changed when they repeat a step.

- If modified Newton converges badly, the solver restarts the step, but all first-order rates keep the values of the
  diverged iterate (``examples/11_exudyn_first_order_rates.py``).
- If a step is rejected, generalised-α keeps its algorithmic accelerations, which changes all velocities.
"""

import math
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from typing import Any

import exudyn as exu

WITHOUT_RESTART: dict[str, Any] = {
    "modifiedNewtonContractivity": 1e300,
    "maxModifiedNewtonIterations": 1,
    "maxModifiedNewtonRestartIterations": 1_000_000,
    "modifiedNewtonJacUpdatePerStep": False,
}


@contextmanager
def changed(settings: Any, **values: Any) -> Iterator[None]:
    """Change ``settings`` temporarily."""
    before = {name: getattr(settings, name) for name in values}
    try:
        for name, value in values.items():
            setattr(settings, name, value)
        yield
    finally:
        for name, value in before.items():
            setattr(settings, name, value)


def newton_without_restart(mbs: Any, newton: Any) -> AbstractContextManager[None]:
    """Make modified Newton renew its Jacobian instead of restarting, if there are first-order coordinates."""
    return changed(newton, **WITHOUT_RESTART if mbs.systemData.ODE1Size() else {})


@contextmanager
def user_function(mbs: Any, place: str, wrap: Callable[[Any], Any]) -> Iterator[None]:
    """Make Exudyn call ``wrap(own)``, where ``own`` is the model's user function or a function that does nothing.

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
    """Make generalised-α repeat a rejected step from the algorithmic accelerations at its start.

    Exudyn restores them after a discontinuity, so the function after Newton's method reports one per repeated step.
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
