"""Program with the protocol of ``exec:`` whose first argument selects the fault in its second answer.

Its first answer is correct: everything stays where it is. An argument that names no fault is the second answer.
"""

import json
import os
import signal
import sys
import time

fault, greeting = sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else "{}"


def say(text):
    print(text, flush=True)


def answer(question):
    return {"states": [question["state"]] * len(question["times"])}


say(greeting)
for number, line in enumerate(sys.stdin):
    question = json.loads(line)
    if fault == "none" or number == 0:
        say(json.dumps(answer(question)))
    elif fault == "tells its process":
        say(json.dumps({"error": str(os.getpid())}))
    elif fault == "tells the question":
        say(json.dumps({"error": line}))
    elif fault == "hang":
        time.sleep(1000.0)
    elif fault == "hang with a child":
        os.system("sleep 1000")
    elif fault == "exit":
        print("a first line\n\nit went wrong here", file=sys.stderr, flush=True)
        sys.exit(3)
    elif fault == "crash":
        os.kill(os.getpid(), signal.SIGKILL)
    elif fault == "closed":
        os.close(1)
        time.sleep(1000.0)
    elif fault == "no end":
        while True:
            sys.stdout.write("1" * 10000)
    elif fault == "chatty":
        print("x" * 1_000_000, file=sys.stderr, flush=True)
        say(json.dumps(answer(question)))
    else:
        say(fault)
