"""Distribution of trajectories to threads."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

CHUNK = 512
"""Number of trajectories that a thread takes at a time: lanes are rarely empty, and threads end together."""


def in_chunks(run: Callable[[int, int], None], n: int, threads: int) -> None:
    """Call ``run(first, last)`` for all of ``n`` trajectories; it must release the global interpreter lock."""
    firsts = range(0, n, CHUNK)
    if threads == 1:
        for first in firsts:
            run(first, min(first + CHUNK, n))
        return
    with ThreadPoolExecutor(min(threads, len(firsts))) as pool:
        for _ in pool.map(lambda first: run(first, min(first + CHUNK, n)), firsts):
            pass  # retrieves the result, so that an error is raised here
