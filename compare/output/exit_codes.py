"""Exit codes of processes, in words."""

from __future__ import annotations

import signal


def cause_of_end(code: int) -> str:
    """Return how a process with this exit code ended: by its status, or by a signal if the code is negative."""
    if code >= 0:
        return f"exit status {code}"
    return next((one.name for one in signal.Signals if one == -code), f"signal {-code}")  # some have no name
