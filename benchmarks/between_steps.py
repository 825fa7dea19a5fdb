"""Accuracy of the plain reference between steps compared with that at the end of a run, on random motions.

Run with ``python benchmarks/between_steps.py [count] [first]``. Each motion is one of ``random_systems``, with a
damping ratio of 0.1 to 10, for 30 units of time at 1,001 requested times. It is compared with the same motion at a
hundredth of the tolerance. Another run ends at the time of the largest difference, where it needs no interpolant.
All differences are relative to the sizes of ``random_systems``.
"""

from __future__ import annotations

import math
import signal
import sys
from dataclasses import replace

import numpy as np
from random_systems import LONGEST, break_off, random_system, sizes_of

from reference_model import SimulationError, simulate
from reference_model.systems import FloatArray, System

LASTS, SAMPLES = 30.0, 1001
WORSE = 2.0
"""Ratio of the differences above which the interpolant is the cause."""


def random_motion(seed: int) -> tuple[System, FloatArray]:
    """Return a system with a damping ratio log-uniform in 0.1 to 10, and an initial state."""
    system, state = random_system(seed)
    ratio = 10.0 ** np.random.default_rng([seed, 1]).uniform(-1.0, 1.0)
    return replace(system, damping=2.0 * float(ratio)), state


def measure(seed: int) -> tuple[float, float]:
    """Return the largest difference at requested times and that of a run which ends there; NaN if a run fails."""
    system, state = random_motion(seed)
    times = np.linspace(0.0, LASTS, SAMPLES)
    signal.setitimer(signal.ITIMER_PROF, LONGEST)
    try:
        found, tight = (
            simulate(system, state, times, tolerance=tolerance).states for tolerance in (1e-9, 1e-11)
        )
        sizes = sizes_of(system, tight)
        differences = np.max(abs(found - tight) / sizes, axis=1)
        worst = max(int(np.argmax(differences)), 1)
        ended = simulate(system, state, [0.0, times[worst]]).at_end
    except (TimeoutError, SimulationError):
        return math.nan, math.nan
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
    return float(differences[worst]), float(np.max(abs(ended - tight[worst]) / sizes))


def main() -> None:
    """Print each motion that is less accurate between steps than at the end of a run, and a summary."""
    signal.signal(signal.SIGPROF, break_off)
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 500
    first = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    found = np.full((count, 2), math.nan)
    for i in range(count):
        between, at_end = found[i] = measure(first + i)
        if not between <= 1e-9 and not between < WORSE * at_end:
            print(f"{first + i}: {between:.1e} between steps, {at_end:.1e} at the end of a run", flush=True)
    done = found[np.isfinite(found).all(axis=1)]
    levels = (0.5, 0.9, 0.99, 1.0)
    for name, values in zip(("between steps", "at ends of runs"), done.T, strict=True):
        quantiles = zip(levels, np.quantile(values, levels), strict=True)
        print(f"{name}: " + ", ".join(f"{level:.0%} {value:.1e}" for level, value in quantiles))
    blamed = (done[:, 0] > 1e-9) & (done[:, 0] > WORSE * done[:, 1])
    worst = done[blamed, 0].max(initial=0.0)
    print(
        f"{count} motions, {count - len(done)} not done; the interpolant's fault: {blamed.sum()}, at most {worst:.1e}"
    )


if __name__ == "__main__":
    main()
