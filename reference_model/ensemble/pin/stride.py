"""Implicit steps of a pin in place of many short ones."""

from __future__ import annotations

import numpy as np

from reference_model.ensemble.core.jit import written_out
from reference_model.ensemble.core.laws import DiscLaw, PinLaw, pull
from reference_model.ensemble.core.stepping.implicit import (
    WORTH,
    collocate_pin,
    failed,
    first_try,
    patience,
    stride_with,
)
from reference_model.ensemble.pin.lanes import (
    PinLanes,
    flags_of,
    position_at,
    put_motion,
    rates_at,
    slip_at,
    state_at,
)
from reference_model.ensemble.pin.memory import PinMemory


@written_out
def stride(lanes: PinLanes, memory: PinMemory, lane: int, law: PinLaw) -> None:
    """Replace the trial step by an implicit step if that goes much further."""
    now, trial = lanes.now, lanes.trial
    t, share = now.state.time[lane], now.rates.time[lane]
    short = now.step[lane] * share
    z, w = position_at(now, lane), slip_at(now, lane)
    left = memory.duration - t
    least = min(WORTH * short, left)
    span = first_try(memory.span, least, left)
    start, guess = np.array((w.real, w.imag)), np.array((w.real, w.imag))
    if law.friction * span > abs(w):  # slaved to the direction of the pull
        a = pull(z, w, law)
        guess[0], guess[1] = abs(w) / abs(a) * a.real, abs(w) / abs(a) * a.imag
    z, wx, wy, _, _, took, way, following = stride_with(
        z, 0.0, start, guess, span, least, lanes.tolerance[lane],
        DiscLaw(
            (), law.stiffness, law.damping, law.friction, law.disc_speed, law.offset, law.stretching, law.free,
            0.0, 0.0, 0.0, 0.0,
        ),
        collocate_pin,
    )  # fmt: skip
    memory.span = following if took > 0.0 else failed(memory.span)
    if took == 0.0:
        lanes.short[lane] = -patience(memory.span)
        return
    put_motion(trial, lane, z, complex(wx, wy), law)
    trial.state.time[lane] = t + took if took < left else memory.duration
    trial.step[lane] = now.step[lane]  # the trial step gives no estimate
    trial.state.way[lane] = now.state.way[lane] + way
    lanes.flag[lane] = flags_of(
        state_at(now, lane), rates_at(now, lane), state_at(trial, lane), rates_at(trial, lane),
        lanes.due[lane], lanes.slow[lane], lanes.watch[lane],
    )  # fmt: skip
