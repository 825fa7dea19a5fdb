"""Simulation of many pins or discs at once."""

import os
from collections.abc import Mapping
from dataclasses import fields, replace

import numpy as np
from numpy.typing import ArrayLike

from reference_model.ensemble.end_states import Ensemble
from reference_model.ensemble.task import Task, parameter_table
from reference_model.systems import (
    FloatArray,
    PinOnDisc,
    System,
    checked_tolerance,
    finite_numbers,
    positive_number,
    require_flag,
    require_system,
    require_whole,
)

UNSUPPORTED = ("hardening", "stop_gap", "stop_stiffness")

MOST_POINTS = 24
"""Largest number of contact points: their sum is unrolled, which takes long to compile for more."""


MOST_THREADS = 1024
"""Limit of ``threads``; more than the processors have no use."""


def simulate_ensemble(
    system: System,
    initial_states: ArrayLike,
    *,
    duration: float,
    tolerance: float = 1e-9,
    parameters: Mapping[str, ArrayLike] | None = None,
    early_end: bool = True,
    threads: int | None = None,
) -> Ensemble:
    """Return the end states of many trajectories under exact Coulomb friction, by compiled, vectorised code.

    The physics is that of :func:`reference_model.simulate`. Results do not depend in any bit on other trajectories or
    the number of threads. Raises ``ValueError`` if an argument is invalid.

    Parameters
    ----------
    system
        Common parameters, with a linear support.
    initial_states : array-like of shape (n, 4) or (4,), of discs (n, 6) or (6,)
        Initial states, one per trajectory or one for all.
    duration
        In s, > 0.
    tolerance
        As in ``reference_model.simulate``. At 1e-9, of 4,000 states each of Figs. 5, 8, 9 and 11 after 100 s, half
        have errors below 4e-9 and 99 % below 1e-8; the largest is 2e-7.
    parameters
        Parameters that differ between trajectories: arrays of shape (n,) by name.
    early_end
        Whether a trajectory ends as soon as its end state is certain (:mod:`.pin.end_states`).
    threads
        Number of threads; by default one per processor.

    """
    require_system(system)
    require_supported(system)
    starts = _checked_starts(system, initial_states)
    varied = {name: _checked_parameter(system, name, values) for name, values in (parameters or {}).items()}
    _require_same_number(len(starts), varied)
    duration = positive_number("duration", duration, "s")
    tolerance = checked_tolerance(tolerance)
    if threads is None:
        threads = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    require_whole("threads", threads, least=1, most=MOST_THREADS)
    require_flag("early_end", early_end)

    task = Task(parameter_table(system, varied), starts, np.full(1, duration))
    # Each driver loads its own compiled code.
    if isinstance(system, PinOnDisc):
        from reference_model.ensemble.pin.driver import simulate_pins

        results = simulate_pins(system, task, tolerance, early_end, bool(varied), threads)
    else:
        from reference_model.ensemble.disc.driver import simulate_discs

        results = simulate_discs(system, task, tolerance, early_end, bool(varied), threads)
    return results.ensemble(varied.get("friction_force", system.friction_force))


def require_supported(system: System) -> None:
    """Raise ``ValueError`` naming the parameter if the kernels of ensembles do not support a system."""
    if not system.linear_support:
        name = next(name for name in ("hardening", "stop_stiffness") if getattr(system, name) != 0.0)
        raise ValueError(
            f"{name} = {getattr(system, name):g}: ensembles need a linear support, because they compute release and "
            "the surroundings of an equilibrium in closed form; set it to 0 or simulate single motions"
        )
    points = getattr(system, "contact_points", None) or 0
    if points > MOST_POINTS:
        raise ValueError(
            f"contact_points = {points}: ensembles support up to {MOST_POINTS}; for more use the continuous ring, "
            "contact_points = None"
        )


def _checked_starts(system: System, initial_states: ArrayLike) -> FloatArray:
    starts = np.atleast_2d(finite_numbers("initial_states", initial_states))
    if starts.ndim != 2 or starts.shape[1] != system.state_size or len(starts) == 0:
        raise ValueError(
            f"initial_states has shape {starts.shape}: {type(system).__name__} takes {system.state_size} numbers a "
            f"trajectory, shape (n, {system.state_size}) or ({system.state_size},)"
        )
    return starts


def _checked_parameter(system: System, name: str, values: ArrayLike) -> FloatArray:
    allowed = [field.name for field in fields(system) if field.name not in (*UNSUPPORTED, "contact_points")]
    if name not in allowed:
        raise ValueError(
            f"parameters: {name!r} cannot vary between trajectories; choose from {', '.join(allowed)}"
        )
    array = finite_numbers(name, values)
    if array.ndim != 1 or len(array) == 0:
        raise ValueError(
            f"parameters: {name} has shape {array.shape}: it must be a list with one number per trajectory"
        )
    for value in (array.min(), array.max()):
        replace(system, **{name: float(value)})  # type: ignore[arg-type]  # raises for invalid values
    return array


def _require_same_number(starts: int, varied: Mapping[str, FloatArray]) -> None:
    sizes = {"initial_states": starts, **{name: len(values) for name, values in varied.items()}}
    n = max(sizes.values())
    for name, size in sizes.items():
        if size != n and (name, size) != ("initial_states", 1):
            raise ValueError(f"{name} is for {size} trajectories, but there are {n}")
