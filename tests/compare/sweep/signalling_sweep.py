"""Sends a signal while a chunk is being written, on machines of any speed.

``python signalling_sweep.py NAME PID CHUNK ...`` runs ``friction-discs ...`` and signals the process (0 for itself)
during the CHUNK-th chunk, or when workers report it. With ``dask worker --preload`` the variable SIGNALLED contains
these three.
"""

import os
import signal
import sys
import threading
from contextlib import contextmanager

from compare.sweep.arrays import Group
from compare.sweep.compute.executors import Cluster


def signalling(name, process, chunk):
    """Send the signal during the ``chunk``-th chunk; chunks are written one after the other."""
    write, lock, written = Group.write, threading.Lock(), 0

    def counted(self, results, region):
        nonlocal written
        with lock:
            written += self.name.startswith("round")
            if written == chunk:
                write(self, {"end": results["end"]}, region)
                os.kill(process or os.getpid(), signal.Signals[name])
            return write(self, results, region)

    run = Cluster.run

    def told(self, tasks):
        for i, found in enumerate(run(self, tasks), start=1):
            if i == chunk:
                os.kill(process or os.getpid(), signal.Signals[name])
            yield found

    Group.write, Cluster.run = counted, told


@contextmanager
def signalling_here(name, process, chunk):
    """Do the same only within this context."""
    before = Group.write, Cluster.run
    signalling(name, process, chunk)
    try:
        yield
    finally:
        Group.write, Cluster.run = before


def dask_setup(worker):
    if signalled := os.environ.get("SIGNALLED"):
        name, process, chunk = signalled.split()
        signalling(name, int(process), int(chunk))


if __name__ == "__main__":
    from compare.cli import main

    signal.signal(signal.SIGINT, signal.default_int_handler)  # it is ignored in background processes
    signalling(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]))
    main(sys.argv[4:])
