"""Cost of the protocol: an engine in its own process, ``exec:COMMAND``, compared with the same engine in this one.

Run with ``python benchmarks/exec_protocol.py``; takes about 10 s. In place of a motion, the engine generates numbers
of 17 digits, so nearly all of the time is the protocol's, at both ends. The program is in Python and, if node is
installed, also in JavaScript. Times are the shortest wall times of several calls.

Measured on two cores under other load:

| times | numbers | Python, ms more | JavaScript, ms more | allowed, ms |
|---|---|---|---|---|
| 2 | 14 | 0.03 | 0.03 | 0.21 |
| 20 | 104 | 0.09 | 0.06 | 0.30 |
| 200 | 1,004 | 0.69 | 0.41 | 1.20 |
| 2,000 | 10,004 | 6.7 | 4.0 | 10.2 |
| 20,000 | 100,004 | 74 | 44 | 100 |

On a slower processor, a number takes 1.1 µs with Python: half of it at this end, the other half in the program's json
to read and write all 17 digits.
"""

from __future__ import annotations

import json
import shlex
import shutil
import sys
import time
from collections.abc import Callable

import numpy as np
from rich.console import Console
from rich.table import Table

from compare.claims.parameters import FIG5
from compare.engines import engines
from reference_model import Trajectory
from reference_model.systems import FloatArray, System

START = (0.1, 0.0, 0.03, 0.0)

IN_JAVASCRIPT = """
const say = (answer) => process.stdout.write(JSON.stringify(answer) + "\\n");
say({});
require("readline").createInterface({ input: process.stdin }).on("line", (line) => say({
  states: JSON.parse(line).times.map((t) => [0, 1, 2, 3].map((i) => (t + 1 / 3) * Math.PI ** i)),
}));
"""

MOST_FIXED, MOST_EACH = 0.2, 1.0
"""Allowed cost of the protocol: per call in ms, and per number in µs."""


def states(times: FloatArray) -> FloatArray:
    """Return numbers with 17 digits, shape (n, 4)."""
    return np.outer(times + 1.0 / 3.0, np.pi ** np.arange(4.0))


def in_process(system: System, state: object, times: FloatArray, *, tolerance: float = 1e-9) -> Trajectory:
    """Return the same numbers as the program."""
    return Trajectory(system, times, states(times))


def program() -> None:
    """Answer questions until the input ends."""
    print("{}", flush=True)
    for line in sys.stdin:
        question = json.loads(line)
        print(json.dumps({"states": states(np.array(question["times"])).tolist()}), flush=True)


def shortest(call: Callable[[], object], repetitions: int) -> float:
    """Return the shortest time of a call in s."""
    found = []
    for _ in range(repetitions):
        start = time.perf_counter()
        call()
        found.append(time.perf_counter() - start)
    return min(found)


def main() -> None:
    """Print the table."""
    commands = {"Python": (sys.executable, __file__, "program")}
    if shutil.which("node"):
        commands["JavaScript"] = ("node", "-e", IN_JAVASCRIPT)
    programs = engines(f"exec:{shlex.join(command)}" for command in commands.values())
    table = Table(
        "times", "numbers", "in process, ms", *(f"{name}, ms more" for name in commands), "allowed, ms"
    )
    for count in (2, 20, 200, 2_000, 20_000):
        times, numbers = np.linspace(0.0, np.pi, count), 5 * count + 4
        functions = (in_process, *(engine.function for engine in programs))
        own, *others = (
            shortest(
                lambda run=run, times=times: run(FIG5, START, times, tolerance=1e-9), max(20, 4_000 // count)
            )
            for run in functions
        )
        more = [1e3 * (other - own) for other in others]
        allowed = MOST_FIXED + 1e-3 * MOST_EACH * numbers
        table.add_row(str(count), str(numbers), *(f"{value:.3f}" for value in (1e3 * own, *more, allowed)))
    Console().print(table)


if __name__ == "__main__":
    program() if sys.argv[1:] == ["program"] else main()
