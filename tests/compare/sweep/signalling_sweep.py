"""Sends a signal while a chunk of a sweep is being written, on machines of any speed.

``python signalling_sweep.py NAME PID CHUNK ...`` runs ``friction-discs`` with the remaining arguments. It signals a
process, 0 for itself, when its CHUNK-th chunk is partly written, or, if workers write the chunks, when the
CHUNK-th is reported. ``dask worker --preload signalling_sweep.py`` with NAME, PID and CHUNK in the variable SIGNALLED
makes a worker do the same.
"""

import os
import signal
import sys
import threading

from compare.sweep.arrays import Chunks
from compare.sweep.compute.executors import Cluster


def signalling(name, process, chunk):
    """Send the signal while this process writes its ``chunk``-th chunk; chunks are written one after the other."""
    write, lock, written = Chunks.write, threading.Lock(), 0

    def counted(self, place, results):
        nonlocal written
        with lock:
            written += 1
            if written == chunk:
                write(self, place, {"end": results["end"]})
                os.kill(process or os.getpid(), signal.Signals[name])
            return write(self, place, results)

    run = Cluster.run

    def told(self, tasks):
        for i, found in enumerate(run(self, tasks), start=1):
            if i == chunk:
                os.kill(process or os.getpid(), signal.Signals[name])
            yield found

    Chunks.write, Cluster.run = counted, told


def dask_setup(worker):
    if signalled := os.environ.get("SIGNALLED"):
        name, process, chunk = signalled.split()
        signalling(name, int(process), int(chunk))


if __name__ == "__main__":
    from compare.cli import app as cli

    signal.signal(signal.SIGINT, signal.default_int_handler)  # it is ignored in background processes
    signalling(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]))
    cli.main(sys.argv[4:])
