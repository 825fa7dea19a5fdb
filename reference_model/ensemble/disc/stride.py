"""Implicit steps of a disc in place of many short ones."""

from __future__ import annotations

import numpy as np

from reference_model.ensemble.core.jit import written_out
from reference_model.ensemble.core.laws import DiscLaw
from reference_model.ensemble.core.records import put
from reference_model.ensemble.core.stepping.implicit import (
    WORTH,
    Collocation,
    failed,
    first_try,
    patience,
    stride_with,
)
from reference_model.ensemble.disc.lanes import (
    AT_END,
    NEAR_REST,
    DiscLanes,
    DiscState,
    Edge,
    Rates,
    flags_of,
    rates_at,
    state_at,
)
from reference_model.ensemble.disc.memory import DiscMemory


@written_out
def disc_stride_with(
    lanes: DiscLanes,
    memory: DiscMemory,
    lane: int,
    law: DiscLaw,
    rates: Rates,
    edge: Edge,
    collocate: Collocation,
) -> None:
    now, trial = lanes.now, lanes.trial
    state, k = state_at(now, lane), rates_at(now, lane)
    short = now.step[lane] * k.time
    left = lanes.duration[lane] - state.time
    least = min(WORTH * short, left)
    span = first_try(memory.span, least, left)
    start = np.array((state.ux, state.uy, state.r))
    z, ux, uy, r, angle, took, way, following = stride_with(
        complex(state.x, state.y),
        state.angle,
        start,
        start,
        span,
        least,
        lanes.tolerance[lane],
        law,
        collocate,
    )
    new = DiscState(z.real, z.imag, ux, uy, r, angle, state.time + took, state.way + way)
    k1 = DiscState(*rates(new[:6], law))
    if took == 0.0 or edge(state[:6], k, law)[0] * edge(new[:6], k1, law)[0] < 0.0:
        memory.span = failed(memory.span)
        lanes.short[lane] = -patience(memory.span)
    else:
        memory.span = following
        put(trial.state, lane, new)
        put(trial.rates, lane, k1)
        trial.step[lane] = now.step[lane]
        lanes.usual[lane] = 0.0
        due = new.time >= min(lanes.due[lane], lanes.duration[lane] - AT_END)
        lanes.flag[lane] = flags_of(
            state, k, new, k1, NEAR_REST * law.friction, due, False, lanes.watch[lane]
        )
