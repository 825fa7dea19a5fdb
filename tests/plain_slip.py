"""Slip by the plain equations to rounding error, independent of all engines."""

import math

import numpy as np
from scipy.integrate import solve_ivp

from reference_model import plain
from reference_model.contact.contact_law import contact_of


def slide(system, start, times, friction=None, **options):
    """Return SciPy's solution of (1) or (19) at ``times``.

    The default friction is the contact law of the system; others have the form of ``plain.on_ring``.
    """
    law = friction or plain.by_law(system.friction_force, contact_of(system))
    options = {"method": "DOP853", "rtol": 3e-14, "atol": 1e-15, "t_eval": times} | options
    run = solve_ivp(lambda _, state: plain.rates(system, law, state), (times[0], times[-1]), start, **options)
    assert run.status >= 0, run.message
    return run


def slide_past_stop(pin, start, times):
    """Return the states at ``times``; runs end where contact with the stop begins or ends."""

    def beyond(_, state):
        return math.hypot(state[0] - pin.offset, state[1]) - pin.stop_gap

    beyond.terminal = True
    found, t, state = [np.array(start)], times[0], np.array(start)
    for end in times[1:]:
        while t < end:
            run = slide(pin, state, (t, end), events=beyond, t_eval=None)
            t, state = run.t[-1], run.y[:, -1]
            if t < end:  # away from the edge, which must not be found again
                run = slide(pin, state, (t, min(t + 1e-6, end)), t_eval=None)
                t, state = run.t[-1], run.y[:, -1]
        found.append(state)
    return np.array(found)
