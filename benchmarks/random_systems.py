"""Time and accuracy of the reference on random systems of all kinds, with four decades of every parameter.

Run with ``python benchmarks/random_systems.py [--compiled] [--tolerance 1e-9] [count] [first]``; a thousand take
about an hour, compiled some minutes. Each motion lasts for 50 natural periods, with 501 requested times. Every tenth
ends instead at an event, exactly or one rounding error before or after it. It is compared with the same motion at a
hundredth of the tolerance, and with a motion whose start differs by 1e-9 of its size, because unstable motions
diverge. All differences are relative to the motion's extent and speed, or to the units of ``simulate`` if these are
larger. ``--compiled`` selects compiled runs.
"""

from __future__ import annotations

import argparse
import math
import signal
import time
from types import FrameType

import numpy as np

from reference_model import DiscOnDisc, PinOnDisc, SimulationError, simulate
from reference_model.core.units import Units
from reference_model.systems import FloatArray, System
from reference_model.trajectory import Trajectory

PERIODS, SAMPLES = 50, 501
LONGEST = 60.0  # limit on the processor time of a run in s
POINTS = (3, 4, 6, 12, 24)


def random_system(seed: int) -> tuple[System, FloatArray]:
    """Return a system with m = C = 1, all other parameters log-uniform in 0.01 to 100, and a state of random size."""
    rng = np.random.default_rng(seed)

    def any_size() -> float:
        return float(10.0 ** rng.uniform(-2.0, 2.0))

    def sometimes() -> float:
        return any_size() if rng.random() < 0.5 else 0.0

    sign = float(rng.choice((-1.0, 1.0)))
    common = {
        "mass": 1.0,
        "stiffness": 1.0,
        "damping": any_size(),
        "friction_force": any_size(),
        "disc_speed": sign * any_size(),
        "offset": sometimes(),
    }
    if rng.random() < 0.25:
        common |= {"hardening": any_size()}
    elif rng.random() < 0.25:
        common |= {"stop_gap": any_size(), "stop_stiffness": any_size()}
    size = any_size()
    if seed % 3 == 0:
        return PinOnDisc(**common), size * rng.normal(size=4)
    points = int(rng.choice(POINTS)) if seed % 3 == 1 else None
    disc = DiscOnDisc(
        **common,
        polar_inertia=any_size(),
        contact_radius=any_size(),
        shaft_damping=any_size() if rng.random() < 0.8 else 0.0,
        shaft_speed=sign * any_size(),
        contact_points=points,
    )
    state = size * rng.normal(size=6)
    state[5] = disc.disc_speed if rng.random() < 0.3 else sign * any_size()
    return disc, state


def sizes_of(system: System, states: FloatArray) -> FloatArray:
    """Return the magnitude of each component of a motion, shape (4,) or (6,), equal for x and y and for vx and vy."""
    unit, d = Units.of(system, states[0]), system.state_size // 2
    place, speed = (np.hypot(*states[:, at : at + 2].T).max() for at in (0, d))
    sizes = np.repeat((max(place, unit.length), max(speed, unit.speed)), d)
    if isinstance(system, DiscOnDisc):
        angle, spin = np.max(abs(states[:, [2, 5]]), axis=0)
        rim = unit.speed / math.sqrt(system.polar_inertia / system.mass)
        sizes[2], sizes[5] = max(angle, 1.0), max(spin, rim)
    return sizes


def end_of(seed: int, found: Trajectory) -> float:
    """Return the end time; for every tenth seed, the start of a phase or the float before or after it."""
    events = [phase.start for phase in found.phases if phase.start > 0.0]
    if seed % 10 or not events:
        return float(found.times[-1])
    rng = np.random.default_rng(seed)
    return float(np.nextafter(event := rng.choice(events), event + rng.integers(-1, 2)))


def break_off(_: int, frame: FrameType | None) -> None:
    """Raise ``TimeoutError``; this handles the signal for the time limit of a run."""
    raise TimeoutError


def measure(seed: int, compiled: bool, tolerance: float) -> tuple[str, float, int, float, float]:
    """Return outcome, time in s, steps, difference from the tight run, and growth of an initial difference."""
    system, state = random_system(seed)
    times = np.linspace(0.0, PERIODS * 2.0 * math.pi, SAMPLES)
    signal.setitimer(signal.ITIMER_PROF, LONGEST)
    began = time.process_time()
    try:
        found = simulate(system, state, times, tolerance=tolerance, compiled=compiled)
        if (end := end_of(seed, found)) < times[-1]:
            times = np.linspace(0.0, end, SAMPLES)
            found = simulate(system, state, times, tolerance=tolerance, compiled=compiled)
    except TimeoutError:
        return "broken off", time.process_time() - began, 0, math.nan, math.nan
    except SimulationError as error:
        return f"given up: {error}", time.process_time() - began, 0, math.nan, math.nan
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
    seconds = time.process_time() - began
    sizes = sizes_of(system, found.states)
    if seconds > 2.0:
        return "done", seconds, found.solution.steps, math.nan, math.nan
    difference = growth = math.nan
    signal.setitimer(signal.ITIMER_PROF, LONGEST)
    try:
        tight = simulate(system, state, times, tolerance=0.01 * tolerance, compiled=compiled)
        aside = simulate(system, state + 1e-9 * sizes, times, tolerance=tolerance, compiled=compiled)
        difference = float(np.max(abs(found.states - tight.states) / sizes))
        growth = float(np.max(abs(found.states - aside.states) / sizes)) / 1e-9
    except (TimeoutError, SimulationError):
        pass
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
    return "done", seconds, found.solution.steps, difference, growth


def _warm() -> None:
    """Compile the core."""
    system, state = random_system(0)
    simulate(system, state, (0.0, 1e-3), compiled=True)


def main() -> None:
    """Print each run that fails, is slow or inaccurate, and a summary."""
    signal.signal(signal.SIGPROF, break_off)
    parser = argparse.ArgumentParser()
    parser.add_argument("--compiled", action="store_true")
    parser.add_argument("--tolerance", type=float, default=1e-9)
    parser.add_argument("count", type=int, nargs="?", default=100)
    parser.add_argument("first", type=int, nargs="?", default=0)
    options = parser.parse_args()
    count, first, compiled, tolerance = options.count, options.first, options.compiled, options.tolerance
    allowed = 0.5 if compiled else 5.0
    if compiled:
        _warm()
    results = []
    for seed in range(first, first + count):
        result = measure(seed, compiled, tolerance)
        results.append(result)
        outcome, seconds, steps, difference, growth = result
        if outcome != "done" or seconds > allowed or difference > 10.0 * tolerance * max(1.0, growth):
            print(
                f"{seed}: {outcome}, {seconds:.2f} s, {steps} steps, {difference:.1e}, growth {growth:.1e}",
                flush=True,
            )
    seconds = np.array([result[1] for result in results])
    differences = np.array([result[3] for result in results])
    median, most = np.quantile(seconds, (0.5, 0.99))
    print(f"{count} runs: median {median:.3f} s, 99 % {most:.2f} s, slowest {seconds.max():.2f} s")
    print(
        f"above {allowed} s: {np.sum(seconds > allowed)}; not done: {sum(result[0] != 'done' for result in results)}"
    )
    print(
        "difference from the tight run: "
        + ", ".join(f"{q:.0%} {np.nanquantile(differences, q):.1e}" for q in (0.5, 0.9, 0.99, 1.0))
    )


if __name__ == "__main__":
    main()
