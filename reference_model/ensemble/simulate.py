"""Simulation of many pins or discs at once."""

import os
from collections.abc import Mapping
from dataclasses import fields, replace

import numpy as np
from numpy.typing import ArrayLike

from reference_model.contact.contact_law import Contact, contact_of
from reference_model.core.single import is_compilable
from reference_model.ensemble.end_states import Ensemble
from reference_model.ensemble.task import OF_SUPPORT, Task, parameter_table
from reference_model.systems import (
    FloatArray,
    PinOnDisc,
    System,
    checked_tolerance,
    finite_numbers,
    positive_number,
    require_flag,
    require_kind,
    require_system,
    require_whole,
)

MOST_POINTS = 24
"""Largest number of contact points in lanes: their sum is unrolled, which takes long to compile for more."""


MOST_THREADS = 1024
"""Limit of ``threads``; more threads than processors are useless."""


def simulate_ensemble(
    system: System,
    initial_states: ArrayLike,
    *,
    duration: float,
    tolerance: float = 1e-9,
    parameters: Mapping[str, ArrayLike] | None = None,
    contact: Contact | None = None,
    early_end: bool = True,
    threads: int | None = None,
) -> Ensemble:
    """Return the end states of many trajectories under exact Coulomb friction, by compiled, vectorised code.

    The physics is the same as in :func:`reference_model.simulate`. Results are bitwise independent of the other
    trajectories and of ``threads``. Raises ``ValueError`` if an argument is invalid.

    Parameters
    ----------
    system
        Common parameters.
    initial_states : array-like of shape (n, 4) or (4,), of discs (n, 6) or (6,)
        Initial states, one per trajectory or one for all.
    duration
        In s, > 0.
    tolerance
        As in ``reference_model.simulate``. At 1e-9, of 4,000 states each of Figs. 5, 8, 9 and 11 after 100 s, half
        have errors below 4e-9 and 99 % below 1e-8; the largest is 2e-7.
    parameters
        Parameters that differ between trajectories: arrays of shape (n,) by name.
    contact
        As in ``reference_model.simulate``; a law of your own is not possible.
    early_end
        Whether a trajectory ends as soon as its end state is certain (:mod:`.pin.end_states`).
    threads
        Number of threads; by default one per processor.

    """
    require_system(system)
    starts = _checked_starts(system, initial_states)
    parameters = {} if parameters is None else parameters
    require_kind("parameters", parameters, Mapping)
    varied = {name: _checked_parameter(system, name, values) for name, values in parameters.items()}
    _require_same_number(len(starts), varied)
    in_lanes = _in_lanes(system, contact) and not varied.keys() & set(OF_SUPPORT)
    duration, tolerance = positive_number("duration", duration, "s"), checked_tolerance(tolerance)
    threads = _processors() if threads is None else threads
    require_whole("threads", threads, least=1, most=MOST_THREADS)
    require_flag("early_end", early_end)
    task = Task(parameter_table(system, varied, () if in_lanes else OF_SUPPORT), starts, np.full(1, duration))
    if not in_lanes:
        from reference_model.ensemble.disc.driver import simulate_any

        results = simulate_any(system, contact, task, tolerance, early_end, threads)
    elif isinstance(system, PinOnDisc):
        from reference_model.ensemble.pin.driver import simulate_pins

        results = simulate_pins(system, task, tolerance, early_end, bool(varied), threads)
    else:
        from reference_model.ensemble.disc.driver import simulate_discs

        results = simulate_discs(system, task, tolerance, early_end, bool(varied), threads)
    return results.ensemble(varied.get("friction_force", system.friction_force))


def _processors() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _in_lanes(system: System, contact: Contact | None) -> bool:
    """Return whether lanes support a system; raise ``ValueError`` if no compiled code supports its contact."""
    if not is_compilable(contact_of(system, contact)):
        raise ValueError(
            f"contact = {contact}: ensembles support a Ring, Points, and an Annulus under uniform pressure that is "
            "not very thin; simulate single motions"
        )
    few = (getattr(system, "contact_points", None) or 0) <= MOST_POINTS
    return system.linear_support and contact is None and few


def _checked_starts(system: System, initial_states: ArrayLike) -> FloatArray:
    starts = np.atleast_2d(finite_numbers("initial_states", initial_states))
    if starts.ndim != 2 or starts.shape[1] != system.state_size or len(starts) == 0:
        raise ValueError(
            f"initial_states has shape {starts.shape}: {type(system).__name__} takes {system.state_size} numbers a "
            f"trajectory, shape (n, {system.state_size}) or ({system.state_size},)"
        )
    return starts


def _checked_parameter(system: System, name: str, values: ArrayLike) -> FloatArray:
    allowed = [field.name for field in fields(system) if field.name != "contact_points"]
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
