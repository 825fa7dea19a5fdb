"""Engines whose fixed step is too long for a claim: they are asked again at shorter ones.

At a longer step the engine's own error may be larger than what a claim can tell. That says nothing about the engine,
and a shorter step often decides.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import replace

from compare.engines.engine import Engine

SHORTER = 4.0
"""By which steps become shorter from one time to the next."""

LONGEST = 4.0
"""Time in s that a claim is expected to take, up to which it is asked at a shorter step."""


def at_finer_steps(engine: Engine | None) -> Iterator[tuple[Engine | None, float]]:
    """Yield ``engine``, and by which its step is shorter: first 1, then as much more as a claim has time for.

    Only the first one where it has no fixed step. The next one is asked for after all was done with the last.
    """
    share = 1.0
    while True:
        began = time.perf_counter()
        yield engine, share
        if engine is None or engine.step is None or SHORTER * (time.perf_counter() - began) > LONGEST:
            return
        engine, share = replace(engine, step=engine.step / SHORTER), SHORTER * share
