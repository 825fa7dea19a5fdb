"""``judge.html``: which claims caught which fault."""

from __future__ import annotations

import math

from compare.judge.outcome import Judged, Outcome
from compare.report.numbers import with_digits
from compare.report.page import environment


def judge_page(judged: Judged, stamp: dict[str, str]) -> str:
    """Return the HTML of the judge's result."""
    return (
        environment()
        .get_template("judge.html.j2")
        .render(
            judged=judged,
            summary=summary(judged),
            stamp=stamp,
            Outcome=Outcome,
            limit=lambda value: with_digits(value, 1) if math.isfinite(value) else "not noticed",
        )
    )


def summary(judged: Judged) -> str:
    """Return the totals in words: "41 of 42 faults caught, 1 slips through; 2 of 2 right engines pass"."""
    words = []
    real = [fault for fault in judged.faults if fault.changes_physics]
    caught = sum(fault.outcome is Outcome.CAUGHT for fault in real)
    words.append(f"{caught} of {len(real)} faults caught by trajectories and by claims of another kind")
    if others := len(judged.faults) - len(real):
        words.append(f"{others} change{'s' * (others == 1)} nothing")
    passed = sum(engine.outcome is Outcome.PASSES for engine in judged.right)
    words.append(f"{passed} of {len(judged.right)} right engines pass")
    return ", ".join(words)
