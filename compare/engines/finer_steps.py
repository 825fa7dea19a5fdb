"""Engines whose fixed step is too long for a question: they are asked again at shorter ones.

At a longer step the engine's own error may be larger than what a claim can tell. That says nothing about the engine,
and a shorter step often decides.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from typing import TypeVar

from compare.engines.engine import Engine
from compare.output.outside_text import printable

SHORTER = 4.0
"""By which steps become shorter from one time to the next."""

LONGEST = 4.0
"""Time in s that an answer is expected to take, up to which it is asked for at a shorter step."""

Answer = TypeVar("Answer")


def decided(
    engine: Engine | None, ask: Callable[[Engine | None], Answer], is_open: Callable[[Answer], bool]
) -> tuple[Answer, str]:
    """Return what ``engine`` answers, at a shorter step than its own if that leaves it open, and a note of that.

    What the engine or the question raises at the engine's own step is raised; at a shorter one the note says it.
    """
    began, share, note = time.perf_counter(), 1.0, ""
    answer = ask(engine)
    while engine is not None and engine.step is not None and is_open(answer):
        if SHORTER * (time.perf_counter() - began) > LONGEST:
            break
        began, share = time.perf_counter(), SHORTER * share
        try:
            answer = ask(replace(engine, step=engine.step / share))
        except Exception as error:  # whatever the engine may raise: its own step was no failure
            return (
                answer,
                f"At a step {share:g} times as short as the engine's own it failed: {printable(error)}",
            )
        note = f"Asked at a step {share:g} times as short as the engine's own, which leaves it open."
    return answer, note
