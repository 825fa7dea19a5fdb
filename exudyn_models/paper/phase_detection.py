"""Slip, pivot and stick phases, detected from the motion under the regularised law."""

import itertools
from dataclasses import replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from exudyn_models.paper.creep import WHOLE, RegularisedContact
from exudyn_models.paper.dense_output import states_at
from exudyn_models.solver.solver_run import Steps
from reference_model.systems import FloatArray
from reference_model.trajectory import Phase

NOTHING = -1
"""Marks a contact without a creeping part."""


def detected_phases(contact: RegularisedContact, steps: Steps) -> tuple[Phase, ...]:
    """Return the phases from the first to the last step, without gaps.

    Under the regularised law a sticking part creeps slower than ε while Coulomb friction could hold it. If the whole
    contact creeps, the system sticks; if one of several points creeps, the disc pivots about it. There are three
    exceptions: friction cannot hold the load, so slip passes through zero; the creep of a point ends before it has
    settled; slip after a release, which may cross ε several times, has not yet reached 2ε.

    A phase *starts* when the slip speed, extrapolated linearly from above ε, would be zero. Stick *ends* when the
    load reaches the friction limit, and a pivot when the slip speed of the point reaches its δ. These times have
    errors of first order in ε.
    """
    ratios, creeping = _creeping_parts(contact, steps)
    load = contact.load_ratios(steps.states, steps.accelerations)
    _leave_what_is_held(contact, steps.times, ratios, load, creeping)
    last = float(steps.times[-1])
    changes, times = [0], [float(steps.times[0])]
    for first, i in _runs(creeping)[:-1]:
        before, after = creeping[i - 1], creeping[i]
        if before == WHOLE:
            time = _release(steps.times, load - 1.0, first, i)
        elif after == NOTHING:
            time = _crossing(steps.times, ratios[:, before] - 1.0, i - 1)
        else:
            time = _time_of_rest(contact, steps, ratios[:, after], after, i - 1)
        changes.append(i)
        times.append(min(max(time, times[-1]), last))
    found: list[Phase] = []
    part_before = None
    for i, start, end in zip(changes, times, [*times[1:], last], strict=True):
        if start == end < last:
            continue
        if found and (start == end or creeping[i] == part_before):
            found[-1] = replace(found[-1], end=end)
        else:
            found.append(Phase(_kind(creeping[i]), start, end, states_at(steps, np.array([start]))[0]))
        part_before = creeping[i]
    return tuple(found)


def _leave_what_is_held(
    contact: RegularisedContact,
    times: FloatArray,
    ratios: FloatArray,
    load: FloatArray,
    creeping: NDArray[np.int_],
) -> None:
    released = 0
    for first, beyond in _runs(creeping):
        if creeping[first] == NOTHING:
            continue
        settled = times[min(beyond, len(creeping) - 1)] - times[first] > contact.settling_time
        if creeping[first] == WHOLE:
            hesitates = released > 0 and ratios[released:first, WHOLE].max(initial=0.0) < 2.0
            kept = _is_held(load[first:beyond], ratios[first:beyond, WHOLE]) and (settled or not hesitates)
        else:
            kept = settled
        if not kept:
            creeping[first:beyond] = NOTHING
            continue
        if creeping[first] == WHOLE and hesitates and creeping[released - 1] == WHOLE:
            creeping[released:first] = WHOLE  # slip that soon returns is not a release
        released = beyond


NEIGHBOURS = 100
"""Number of steps kept at both ends of a uniform run."""


def essential_steps(contact: RegularisedContact, steps: Steps) -> NDArray[np.bool_]:
    """Return which ``steps`` are needed to find the phases, shape (n,).

    These are the ends of each uniform run, the step of its largest slip, the last step whose load friction can hold,
    and the step whose load it holds most clearly.
    """
    ratios, creeping = _creeping_parts(contact, steps)
    load = contact.load_ratios(steps.states, steps.accelerations)
    whole = ratios[:, WHOLE]
    grip = np.where(whole > 0.0, whole + np.abs(load - whole), np.inf)
    kept = np.zeros(len(creeping), dtype=bool)
    for first, beyond in _runs(creeping):
        kept[first : first + NEIGHBOURS] = kept[max(first, beyond - NEIGHBOURS) : beyond] = True
        kept[first + int(np.argmax(whole[first:beyond]))] = True
        kept[first + int(np.argmin(grip[first:beyond]))] = True
        held = np.flatnonzero(load[first:beyond] < 1.0)
        kept[first + held[-1:]] = kept[np.minimum(first + held[-1:] + 1, len(kept) - 1)] = True
    return kept


def _creeping_parts(contact: RegularisedContact, steps: Steps) -> tuple[FloatArray, NDArray[np.int_]]:
    ratios = contact.slip_ratios(steps.states)
    below = ratios < 1.0
    return ratios, np.where(below.any(axis=1), np.argmax(below, axis=1), NOTHING)


def _kind(part: int) -> Literal["slip", "pivot", "stick"]:
    return "slip" if part == NOTHING else "stick" if part == WHOLE else "pivot"


def _runs(values: NDArray[Any]) -> list[tuple[int, int]]:
    """Return the start of every run of equal values and the index after its end."""
    edges = [0, *(np.flatnonzero(values[1:] != values[:-1]) + 1).tolist(), len(values)]
    return list(itertools.pairwise(edges))


def _time_of_rest(
    contact: RegularisedContact, steps: Steps, ratio: FloatArray, part: int, left: int
) -> float:
    """Return when the slip of ``part`` would be zero at its present rate, or the next step if it does not fall."""
    start, end = steps.times[left], steps.times[left + 1]
    rates = contact.slip_ratio_rates(steps.states[left], steps.accelerations[left])
    falls = rates[part] < 0.0 and ratio[left] > ratio[left + 1]
    return float(start - ratio[left] / rates[part]) if falls else float(end)


def _is_held(load: FloatArray, ratio: FloatArray) -> bool:
    """Return whether friction can hold a creeping system, according to all steps with slip.

    A load that friction cannot hold lets the slip pass through zero, and then its direction relative to the slip
    reverses. The limit applies in both directions.
    """
    moving = ratio > 0.0
    if not np.any(moving):
        return len(load) > 1
    return bool(np.any((ratio + np.abs(load - ratio))[moving] < 1.0))


def _release(times: FloatArray, excess: FloatArray, first: int, beyond: int) -> float:
    held = np.flatnonzero(excess[first:beyond] < 0.0)
    return _crossing(times, excess, first + int(held[-1]) if len(held) else beyond - 1)


def _crossing(times: FloatArray, values: FloatArray, left: int) -> float:
    """Return when ``values`` cross zero after step ``left``, at the latest at its end."""
    if values[left] >= 0.0 or values[left + 1] <= 0.0:
        return float(times[left + 1])
    share = values[left] / (values[left] - values[left + 1])
    return float(times[left] + share * (times[left + 1] - times[left]))
