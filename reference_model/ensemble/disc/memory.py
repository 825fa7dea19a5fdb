"""Scalar data of each lane of discs."""

from __future__ import annotations

from typing import Annotated, Any, NamedTuple

from numpy.typing import NDArray

from reference_model.ensemble.core.checkpoints import ON_THE_WAY, Checkpoints, mark_requested
from reference_model.ensemble.core.jit import scalar
from reference_model.ensemble.core.records import Record
from reference_model.ensemble.core.recurrence import Measures, Series, Window
from reference_model.ensemble.disc.lanes import DiscLanes, Moment, state_at
from reference_model.systems import FloatArray

OF_TURN, OF_PEAK = 1, 2
"""Kinds of windows: from one largest x, or one largest radius, to the next."""


class Region(Record):
    """A neighbourhood that no motion leaves, in m and s: where a quadratic form is below its level.

    ``circle`` is 1 about a whirl, in coordinates that turn with the centre (ρ, v along and across the radius, r, 0),
    and 0 about an equilibrium, in (x, y, vx, vy, r). ``form`` is the upper half of the form, row by row.
    """

    circle: int
    centre: Annotated[FloatArray, 5]
    form: Annotated[FloatArray, 15]
    level: float
    measures: Measures


class DiscMemory(Record):
    """Scalar data of a lane, with the motion at ``checks``, at the largest x (``turns``) and the largest radius."""

    number: int
    length: float
    rate: float
    end: int
    found: Measures
    tick: float
    checks: Series
    turns: Series
    peaks: Series
    window: Window
    span: float
    checkpoints: int
    passed: int


class DiscSettings(NamedTuple):
    """Settings for scalar code; ``checkpoints`` are those of a single trajectory, empty if not requested."""

    tolerance: float
    early: bool
    around: tuple[float, ...]
    regions: NDArray[Any]
    checkpoints: Checkpoints


@scalar
def record_requested(
    lanes: DiscLanes, moment: Moment, memory: DiscMemory, lane: int, until: float, settings: DiscSettings
) -> None:
    if mark_requested(lanes, moment, memory, lane, until, settings):
        take_checkpoint(lanes, moment, memory, lane, ON_THE_WAY, settings)


@scalar
def take_checkpoint(
    lanes: DiscLanes, moment: Moment, memory: DiscMemory, lane: int, kind: float, settings: DiscSettings
) -> None:
    if memory.checkpoints < settings.checkpoints.size:
        checkpoint = settings.checkpoints[memory.checkpoints]
        memory.checkpoints += 1
        checkpoint.kind, checkpoint.time = kind, moment.state.time[lane] / memory.rate
        put_state(checkpoint.state, lanes, moment, memory, lane)


@scalar
def put_state(state: FloatArray, lanes: DiscLanes, moment: Moment, memory: DiscMemory, lane: int) -> None:
    length, rate = memory.length, memory.rate
    there = state_at(moment, lane)
    omega, curling = lanes.law.disc_speed[lane], lanes.law.curling[lane]
    state[0], state[1], state[2] = there.x * length, there.y * length, there.angle
    state[3] = (there.ux - omega * there.y) * length * rate
    state[4] = (there.uy + omega * there.x) * length * rate
    state[5] = (omega + curling * there.r) * rate
