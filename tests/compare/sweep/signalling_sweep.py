"""``friction-discs`` that sends a signal in the middle of writing a chunk, however fast or slow the machine is.

``python signalling_sweep.py NAME PID CHUNK ...`` sends the signal to a process, 0 for this one itself, when a part of
the CHUNK-th chunk from the start of this process is written; what follows are arguments of the command.
"""

import os
import signal
import sys

from compare.cli import app as cli
from compare.sweep.compute.store import Round

NUMBER = signal.Signals[sys.argv[1]]
PROCESS, CHUNK = int(sys.argv[2]) or os.getpid(), int(sys.argv[3])

write, written = Round.write, 0


class Signalling(dict):
    """Results of a chunk."""

    def items(self):
        for i, item in enumerate(super().items()):
            if i == 1:
                os.kill(PROCESS, NUMBER)
            yield item


def counted(self, chunk, results):
    global written
    written += 1
    return write(self, chunk, Signalling(results) if written == CHUNK else results)


if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.default_int_handler)  # which is ignored in the background
    Round.write = counted
    cli.main(sys.argv[4:])
