"""Scalar data of each lane of pins, and the window that measures an end state."""

from __future__ import annotations

from typing import Annotated, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from reference_model.contact.limit_surface import ComplexArray
from reference_model.ensemble.core.checkpoints import (
    ON_THE_WAY,
    Checkpoints,
    empty_checkpoints,
    mark_requested,
)
from reference_model.ensemble.core.jit import inlined, scalar
from reference_model.ensemble.core.laws import PinLaw
from reference_model.ensemble.core.records import Record, fill, layout
from reference_model.ensemble.core.recurrence import (
    NO_WINDOW,
    Measures,
    Series,
    Window,
    measured,
    see_radius,
)
from reference_model.ensemble.pin.end_states import FORM_SIZE
from reference_model.ensemble.pin.lanes import Moment, PinLanes, position_at, slip_at
from reference_model.ensemble.pin.slip import MOST_TERMS
from reference_model.systems import FloatArray, PinOnDisc

OF_TURN, OF_RELEASE = 1, 2
"""Kinds of windows: from crossing to crossing, or from release to release."""


class TrappingRegions(Record):
    """Trapping regions in m and s, if all trajectories have the same parameters.

    ``level`` and ``form`` belong to the equilibrium. ``reach`` is the level and ``metric`` the form of the whirl,
    with its crossing ``turn`` (x, y, ẏ/k) and ``measures``. A level of 0 means unknown.
    """

    level: float
    form: Annotated[FloatArray, FORM_SIZE]
    reach: float
    turn: Annotated[FloatArray, 3]
    metric: Annotated[FloatArray, 6]
    measures: Measures


class PinMemory(Record):
    """Scalar data of a lane.

    ``tick`` is the time between checks, ``turns`` x, y and ẏ at crossings of the section, ``releases`` the radii of
    releases, ``span`` the proposed implicit step.
    """

    number: int
    length: float
    rate: float
    duration: float
    end: int
    found: Measures
    equilibrium: complex
    level: float
    form: Annotated[FloatArray, FORM_SIZE]
    tick: float
    turns: Series
    releases: Series
    window: Window
    span: float
    checkpoints: int
    passed: int


class Settings(NamedTuple):
    """Settings for scalar code; few arrays, because each costs time in every call.

    ``early`` ends a trajectory as soon as its end state is certain, ``once`` at its first crossing of the section.
    """

    tolerance: float
    early: bool
    once: bool
    regions: TrappingRegions
    series: ComplexArray
    checkpoints: Checkpoints


def no_regions() -> NDArray[Any]:
    return np.zeros(1, layout(TrappingRegions))


def settings_of(
    tolerance: float,
    early: bool = False,
    once: bool = False,
    regions: NDArray[Any] | None = None,
    checkpoints: Checkpoints | None = None,
) -> Settings:
    # The kernel is compiled for writable arrays only.
    known = no_regions() if regions is None else regions.copy()
    series = np.zeros((6, MOST_TERMS + 2), dtype=complex)
    room = empty_checkpoints(0, PinOnDisc.state_size) if checkpoints is None else checkpoints
    return Settings(tolerance, early, once, known[0], series, room)


@inlined
def keep(memory: PinMemory, least: float, largest: float, slip: float) -> None:
    fill(memory.found, Measures(least, largest, slip))


@scalar
def close_window(memory: PinMemory, end: int, t: float, way: float, radius: float) -> None:
    see_radius(memory.window, radius)
    fill(memory.found, measured(memory.window, t, way))
    memory.end, memory.window.kind = end, NO_WINDOW


@scalar
def take_checkpoint(
    memory: PinMemory, kind: float, t: float, z: complex, w: complex, law: PinLaw, settings: Settings
) -> None:
    if memory.checkpoints < settings.checkpoints.size:
        checkpoint = settings.checkpoints[memory.checkpoints]
        memory.checkpoints += 1
        checkpoint.kind, checkpoint.time = kind, t / memory.rate
        put_state(checkpoint.state, memory, z, w, law)


@scalar
def record_requested(
    lanes: PinLanes,
    moment: Moment,
    memory: PinMemory,
    lane: int,
    until: float,
    law: PinLaw,
    settings: Settings,
) -> None:
    if mark_requested(lanes, moment, memory, lane, until, settings):
        t, z, w = moment.state.time[lane], position_at(moment, lane), slip_at(moment, lane)
        take_checkpoint(memory, ON_THE_WAY, t, z, w, law, settings)


@scalar
def put_state(state: FloatArray, memory: PinMemory, z: complex, w: complex, law: PinLaw) -> None:
    length, rate = memory.length, memory.rate
    state[0], state[1] = z.real * length, z.imag * length
    state[2] = (w.real - law.disc_speed * z.imag) * length * rate
    state[3] = (w.imag + law.disc_speed * z.real) * length * rate
