"""Implicit steps of a disc in place of many short ones, in a lane that asks for them."""

from __future__ import annotations

from typing import Any

import numpy as np

from reference_model.ensemble.core.implicit import WORTH, failed, first_try, patience, stride_with
from reference_model.ensemble.core.jit import written_out
from reference_model.ensemble.core.lanes import LANES
from reference_model.ensemble.core.laws import DiscLaw
from reference_model.ensemble.disc.lanes import (
    AT_END,
    DUE,
    DURATION,
    FLAG,
    NEAR_REST,
    RATES,
    SHORT,
    STEP,
    TOLERANCE,
    TRIAL,
    USUAL,
    WATCH,
    X,
    eight_of,
    put,
    reasons,
)


@written_out
def disc_stride_with(
    scratch: Any, page: Any, item: int, lane: int, law: DiscLaw, rates: Any, edge: Any, collocate: Any
) -> None:
    """Put an implicit step in the place of the one on trial, with its flags, if that brings the disc much further.

    ``item`` is where in the page stands how long it may be. A step must not cross the ``edge`` of friction.
    """
    q, k = eight_of(scratch, lane, X), eight_of(scratch, lane, RATES)
    short = scratch[STEP * LANES + lane] * k[6]
    left = scratch[DURATION * LANES + lane] - q[6]
    least = min(WORTH * short, left)
    span = first_try(page[item], least, left)
    start = np.array((q[2], q[3], q[4]))
    z, ux, uy, r, angle, took, way, following = stride_with(
        complex(q[0], q[1]), q[5], start, start, span, least,
        scratch[TOLERANCE * LANES + lane], law, collocate,
    )  # fmt: skip
    new = (z.real, z.imag, ux, uy, r, angle, q[6] + took, q[7] + way)
    k1 = rates(new[:6], law)
    if took == 0.0 or edge(q[:6], k, law)[0] * edge(new[:6], k1, law)[0] < 0.0:
        page[item] = failed(page[item])
        scratch[SHORT * LANES + lane] = -patience(page[item])
    else:
        page[item] = following
        put(scratch, lane, new)
        for j in range(8):
            scratch[(TRIAL + RATES + j) * LANES + lane] = k1[j]
        scratch[(TRIAL + STEP) * LANES + lane] = scratch[STEP * LANES + lane]
        scratch[USUAL * LANES + lane] = 0.0
        due = new[6] >= min(scratch[DUE * LANES + lane], scratch[DURATION * LANES + lane] - AT_END)
        scratch[FLAG * LANES + lane] = reasons(
            q, k, new, k1, NEAR_REST * law.friction, due, False, scratch[WATCH * LANES + lane]
        )
