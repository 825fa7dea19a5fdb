"""Work for processes. Each new process imports this module, so it imports little itself."""

import os
import subprocess
import sys
import tempfile
import time


def last_words(status):
    """End this process abruptly, after two lines on its standard error."""
    os.write(2, "what comes before\nthe last word: 1 µm\n".encode())
    os._exit(status)


def speak(text):
    os.write(1, f"raw {text}\n".encode())
    print(text, flush=True)
    print(text, file=sys.stderr, flush=True)


def kill(number):
    os.kill(os.getpid(), number)


def raise_it(error):
    raise error


class Unreadable:
    def __reduce__(self):
        return raise_it, (ValueError("cannot be read"),)


def close_all_descriptors(then, *arguments):
    os.closerange(0, 200)
    then(*arguments)


def leave_a_folder_and(end, *arguments):
    tempfile.mkdtemp()
    end(*arguments)


def spoil(module):
    sys.modules[module] = None
    return os.getpid()


def start_a_child():
    return subprocess.Popen(["sleep", "3600"]).pid


def spend(seconds):
    """Use the processor for ``seconds``."""
    end = time.process_time() + seconds
    while time.process_time() < end:
        pass
