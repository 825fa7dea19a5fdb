"""A program that speaks the protocol, and does as its first argument says at the second motion that is asked for.

At the first it answers as it should: everything stays where it is. It is started by the tests of ``exec:``.
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


def phases(*begun):
    told = [{"kind": kind, "start": start, "state": question["state"]} for kind, start in begun]
    return json.dumps({"states": states, "phases": told})


say(greeting)
for number, line in enumerate(sys.stdin):
    question = json.loads(line)
    states = answer(question)["states"]
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
        say(
            {
                "garbled": "step 1 done",
                "no object": "[1, 2]",
                "deep": "[" * 100_000,
                "empty": "",
                "two lines": '{"states": []}\n{"states": []}',
                "no states": '{"state": [1.0]}',
                "ragged": '{"states": [[1.0], [1.0, 2.0]]}',
                "texts": json.dumps({"states": [list(map(str, state)) for state in states]}),
                "true": json.dumps({"states": [*states[:-1], [1.0, True, 1.0, 1.0]]}),
                "huge": json.dumps({"states": [*states[:-1], [10**400, 1, 1, 1]]}),
                "escapes": '{"error": "\\ud800 \\u001b[31m"}',
                "escapes unsupported": '{"unsupported": "\\ud800 \\u001b[31m"}',
                "unordered": phases(("slip", 0.5), ("stick", 0.2)),
                "too early": phases(("slip", -1.0)),
                "true start": phases(("slip", True)),
                "words": '{"states": [["a", "b", "c", "d"]]}',
                "short": json.dumps({"states": states[:-1]}),
                "narrow": json.dumps({"states": [state[:3] for state in states]}),
                "nan": json.dumps({"states": [*states[:-1], [1.0, float("nan"), 1.0, 1.0]]}),
                "null": json.dumps({"states": [*states[:-1], [1.0, None, 1.0, 1.0]]}),
                "unsupported": '{"unsupported": "no springs here"}',
                "error": '{"error": "the step fell to nothing"}',
                "phase": json.dumps({"states": states, "phases": [{"kind": "glide"}]}),
                "phase without state": json.dumps(
                    {"states": states, "phases": [{"kind": "slip", "start": 0.0, "state": [1.0]}]}
                ),
                "phases": phases(("slip", 0.0), ("stick", 0.5)),
            }[fault]
        )
