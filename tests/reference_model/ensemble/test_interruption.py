"""Long compiled runs that Ctrl-C ends, and runs that are too long."""

import os
import signal
import subprocess
import sys
import threading
import time

import pytest

from compare.claims.parameters import FIG5, FIG11
from reference_model import SimulationError, simulate
from reference_model.numerics.threads import Threads

SOON = 30.0
"""Time in s for an interrupted run to end on a very busy machine; each would take minutes."""

START = """
import signal
from compare.claims.parameters import FIG5, FIG11
from reference_model.ensemble import simulate_ensemble
signal.signal(signal.SIGINT, signal.default_int_handler)  # it is ignored in background processes
"""

LONG = {
    "pins": ("simulate_ensemble(FIG5, [[0.1, 0, 0.03, 0]] * {n}, duration={t}, early_end=False)", 500_000, 1e4),
    "discs": ("simulate_ensemble(FIG11, [[0.02, 0, 0, 0, 0, 1.3]] * {n}, duration={t}, early_end=False)", 500, 1.6e6),
}  # fmt: skip


@pytest.mark.skipif(os.name == "nt", reason="Ctrl-C is sent as a POSIX signal")
@pytest.mark.parametrize("what", LONG)
def test_ctrl_c_ends_an_ensemble(what):
    call, n, t = LONG[what]
    compiled, long = call.format(n=1, t=1.0), call.format(n=n, t=t)
    code = f"{START}{compiled}\nprint('begins', flush=True)\n{long}\nprint('ended', flush=True)"
    with subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout.readline() == "begins\n"
        time.sleep(0.8)
        sent = time.monotonic()
        process.send_signal(signal.SIGINT)
        out, err = process.communicate()
        assert time.monotonic() - sent < SOON
    assert (out, process.returncode, err.splitlines()[-1]) == ("", -signal.SIGINT, "KeyboardInterrupt")


@pytest.mark.parametrize(("system", "state"), [(FIG5, [0.1, 0, 0.03, 0]), (FIG11, [0.02, 0, 0, 0, 0, 1.3])])
@pytest.mark.parametrize("compiled", [False, True])
def test_a_run_of_too_many_steps_is_refused_soon(system, state, compiled):
    with pytest.raises(SimulationError, match="because more than 20,000,000 further steps are needed"):
        simulate(system, state, [0.0, 1e9], compiled=compiled)


def test_an_exception_interrupts_python_code_in_threads():
    ended = []

    def work():
        try:
            while True:
                time.sleep(1e-3)
        except KeyboardInterrupt:
            ended.append(True)

    pool = Threads(1)
    running, waiting = pool.submit(work), pool.submit(work)
    while not running.running():
        time.sleep(1e-3)
    with pytest.raises(KeyboardInterrupt), pool:
        raise KeyboardInterrupt
    assert ended == [True]
    assert waiting.cancelled()


def test_an_exception_that_arrives_as_the_work_ends_does_not_keep_the_pool_waiting():
    class Interrupted(set):
        def discard(self, thread):
            raise KeyboardInterrupt

    pool = Threads(1)
    pool._at_work = Interrupted()
    with pytest.raises(KeyboardInterrupt):
        pool.submit(int).result()
    leaving = threading.Thread(target=pool.__exit__, args=(KeyboardInterrupt, None, None), daemon=True)
    leaving.start()
    leaving.join(SOON)
    assert not leaving.is_alive()
