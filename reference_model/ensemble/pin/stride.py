"""Implicit steps of a pin in place of many short ones, in a lane that asks for them."""

from __future__ import annotations

from typing import Any

import numpy as np

from reference_model.ensemble.core.implicit import (
    WORTH,
    collocate_pin,
    failed,
    first_try,
    patience,
    stride_with,
)
from reference_model.ensemble.core.jit import scalar
from reference_model.ensemble.core.lanes import LANES
from reference_model.ensemble.core.laws import DiscLaw, PinLaw, pull
from reference_model.ensemble.pin.lanes import (
    DUE,
    FLAG,
    KX,
    SHARE,
    SHORT,
    SLOW,
    STEP,
    TIME,
    TOLERANCE,
    TRIAL,
    WATCH,
    WAY,
    X,
    place_of,
    put_motion,
    reasons,
    slip_of,
)
from reference_model.ensemble.pin.memory import DURATION, SPAN


@scalar
def stride(scratch: Any, page: Any, lane: int, law: PinLaw) -> None:
    """Put an implicit step in the place of the one on trial, with its flags, if that brings the pin much further."""
    t, share = scratch[TIME * LANES + lane], scratch[SHARE * LANES + lane]
    short = scratch[STEP * LANES + lane] * share
    z, w = place_of(scratch, lane, 0), slip_of(scratch, lane, 0)
    left = page[DURATION] - t
    least = min(WORTH * short, left)
    span = first_try(page[SPAN], least, left)
    start, guess = np.array((w.real, w.imag)), np.array((w.real, w.imag))
    if law.friction * span > abs(w):  # drawn to the direction of the pull by far
        a = pull(z, w, law)
        guess[0], guess[1] = abs(w) / abs(a) * a.real, abs(w) / abs(a) * a.imag
    z, wx, wy, _, _, took, way, following = stride_with(
        z, 0.0, start, guess, span, least, scratch[TOLERANCE * LANES + lane],
        DiscLaw(
            law.stiffness, law.damping, law.friction, law.disc_speed, law.offset, law.stretching, law.free,
            0.0, 0.0, 0.0, 0.0, (),
        ),
        collocate_pin,
    )  # fmt: skip
    page[SPAN] = following if took > 0.0 else failed(page[SPAN])
    if took == 0.0:
        scratch[SHORT * LANES + lane] = -patience(page[SPAN])
        return
    y, k = np.empty(4), np.empty(6)
    for i in range(4):
        y[i] = scratch[(X + i) * LANES + lane]
    for i in range(6):
        k[i] = scratch[(KX + i) * LANES + lane]
    put_motion(scratch, lane, z, complex(wx, wy), law)
    later = t + took if took < left else page[DURATION]
    scratch[(TRIAL + TIME) * LANES + lane] = later
    scratch[(TRIAL + STEP) * LANES + lane] = scratch[
        STEP * LANES + lane
    ]  # the step on trial tells nothing of it
    scratch[(TRIAL + WAY) * LANES + lane] = scratch[WAY * LANES + lane] + way
    after, rates = np.array((z.real, z.imag, wx, wy)), np.empty(4)
    for i in range(4):
        rates[i] = scratch[(TRIAL + KX + i) * LANES + lane]
    due, watch = scratch[DUE * LANES + lane], scratch[WATCH * LANES + lane]
    scratch[FLAG * LANES + lane] = reasons(
        y, k, after, rates, later, due, scratch[SLOW * LANES + lane], watch
    )
