"""Small studies and engines with known verdicts.

They have their own module because functions are sent to other processes by name.
"""

from __future__ import annotations

import os
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from compare.claims.claim import Claim, ErrorBudget
from compare.claims.parameters import FIG5, FIG11
from compare.claims.prose import Prose
from compare.claims.study import Findings, Study
from compare.claims.validation import Recorded
from compare.engines import Engine, UnsupportedSystemError
from compare.output.figures import axis, curve, engines_in, new_figure, points
from compare.output.outside_text import printable
from compare.report.animation import gif
from reference_model.trajectory import Phase, Solution, Trajectory

LOADS = np.linspace(0.0, 0.1, 21)


class Fake(Study):
    def measure(self, engine, few=None, only=()):
        try:
            return self.provided["measure"](engine)
        except UnsupportedSystemError as error:
            return Findings(not_simulated=printable(error))

    @property
    def has_theory(self):
        return "theory" in self.provided

    def measure_theory(self, few=None, only=()):
        return self.provided["theory"]()


def fake(name, title, paper, measure, *, finding="", captions=None, provided=None, **more):
    prose = Prose(title, paper, finding=finding, figures=captions or {})
    return Fake(name, prose, provided={"measure": measure, **(provided or {})}, **more)


def straight(system, initial_state, times, *, tolerance=1e-9):
    positions, velocities = np.split(np.asarray(initial_state, dtype=float), 2)
    elapsed = (np.asarray(times) - times[0])[:, np.newaxis]
    states = np.hstack((positions + velocities * elapsed, velocities + 0.0 * elapsed))
    phases = (Phase("slip", float(times[0]), float(times[-1]), np.array(initial_state, dtype=float)),)
    return Trajectory(system, np.array(times), states, phases, Solution("exact", tolerance, 1, 1, 0.0))


def failing(system, initial_state, times, *, tolerance=1e-9):
    raise RuntimeError("the step size became too small at t = 3.2 s: try a larger tolerance")


GOOD = Engine("good", straight)
ALSO_GOOD = Engine("also-good", straight)
FAILING = Engine("failing", failing)


def claim(sentence, engine, predicted, measured, numerical, **more):
    values = {
        "equation": "(3)",
        "parameters": {"mass": 1.0, "stiffness": 1.0, "damping": 0.1, "disc_speed": 0.7, "offset": 0.1},
        "source": "assumption: any set within (5), the paper prints none for Fig. 3",
        "unit": "m",
    } | more
    resolution = values.pop("resolution", 1e-6)
    budget = {name: values.pop(name) for name in ("model", "negligible", "doubt") if name in values}
    return Claim(
        sentence,
        engine=engine,
        predicted=predicted,
        measured=measured,
        budget=ErrorBudget(numerical, resolution=resolution, **budget),
        **values,
    )


def recorded(engine, setting, off, *, resolution, own=True, cases=None):
    """Return a setting; ``off`` maps sentences to deviations and errors in m."""
    claims = tuple(
        claim(sentence, f"{engine}, {setting}", 0.0, difference, error, equation="", resolution=resolution)
        for sentence, (difference, error) in off.items()
    )
    return Recorded(engine, setting, "1.2", "2026-01-31", claims, own=own, cases=cases or {})


def radius():
    return np.sqrt(0.1**2 - LOADS**2)


def measure_verdicts(engine):
    engine.simulate(FIG5, (0.0, 0.0, 1.0, 0.0), LOADS)  # a failing engine fails here
    exact, name = radius(), engine.name
    numbers = exact, exact + 4e-11 * np.cos(40 * LOADS), np.full_like(exact, 2e-10)
    semicircle = {"equation": "(4)", "note": "error estimated by a run at a quarter of the tolerance"}
    load, release = {"equation": "(5)", "unit": "N", "resolution": 1e-4}, {"equation": "(7)–(9)", "unit": "s"}
    claims = (
        claim("The pin comes to rest at the point of eq. (3)", name, 0.08, 0.08 + 3e-11, 1e-10),
        claim("Equilibria of all loads lie on the semicircle", name, *numbers, **semicircle),
        claim("The equilibrium is lost at the load of eq. (5)", name, 0.1, 0.1004, 1e-6, **load),
        claim("The time of release follows from eq. (7)", name, 2.0, 2.1, 0.5, **release),
    )
    return Findings(claims, {"load": LOADS, "radius": exact})


def theory_of_verdicts():
    exact = radius()
    identity = claim(
        "The determinant of (12) has the coefficients of (13)", "theory", 0.0, 3e-17, 1e-15, unit=""
    )
    return Findings((identity,), {"load": LOADS, "radius": exact})


def draw_verdicts(data):
    figure, (left, right) = new_figure(ncols=2)
    if "theory" in data:
        left.plot(data["theory"]["load"], data["theory"]["radius"], **curve("theory", "eq. (3)"))
    for engine in engines_in(data):
        load, value = data[engine]["load"], data[engine]["radius"]
        left.plot(load, value, **points(engine))
        right.plot(load, value * np.cos(60 * load), **curve(engine))
    left.set(xlabel=axis(r"\mu N", "N"), ylabel=axis(r"\rho_*", "m"))
    right.set(xlabel=axis("t", "s"), ylabel=axis("x", "m"))
    left.legend()
    return {"fake-radius": figure}


def animate_verdicts(data):
    figure, (axes,) = new_figure(width=3.0, height=2.4)
    (dot,) = axes.plot([0.0], [0.0], "o", color="black")
    axes.set(xlim=(-1.2, 1.2), ylim=(-1.2, 1.2), xlabel=axis("x", "m"), ylabel=axis("y", "m"))

    def update(i):
        dot.set_data([np.cos(i * np.pi / 4)], [np.sin(i * np.pi / 4)])

    return {"fake-motion": gif(figure, update, 8)}


VERDICTS = fake(
    name="verdicts",
    title="Fig. 3: self-centring of the pin at low speed",
    paper="Under friction the pin rests at a point of a semicircle over the offset (3), (4), as long as "
    "μN < C·X₀ (5).\n\nWith growing load it moves towards the centre of the disc, `rest(load) < X₀`.",
    measure=measure_verdicts,
    captions={
        "fake-radius": "Radius of the equilibrium over the load: both engines on the formula (3).",
        "fake-motion": "The motion at 0.8 rad/s.",
    },
    provided={"figures": draw_verdicts, "animations": animate_verdicts, "theory": theory_of_verdicts},
)


def measure_agreement(engine):
    agreed = claim("Half of one is a half", engine.name, 0.5, 0.5, 0.0, equation="")
    return Findings((agreed,), {"half": np.array([0.5])})


def measure_agreement_and_count(engine):
    """Append a line to the file COUNT."""
    with open(os.environ["COUNT"], "a", encoding="utf-8") as stream:
        stream.write(f"{engine.name}\n")
    return measure_agreement(engine)


def measure_an_asked_motion(engine):
    engine.simulate(FIG5, [0.1, 0.0, 0.03, 0.0], [0.0, 1.0])
    return measure_agreement(engine)


ASKING = fake("asking", "A claim that holds once a motion is there", "One half.", measure_an_asked_motion)
AGREEMENT = fake("agreement", "A claim that holds", "One half.", measure_agreement, quick=True)
COUNTED = fake("counted", "A claim that leaves a mark", "One half.", measure_agreement_and_count)


def measure_too_roughly(engine):
    return Findings((claim("Nothing is shown", engine.name, 2.0, 2.1, 0.5),))


INCONCLUSIVE = fake("inconclusive", "A rough claim", "Two.", measure_too_roughly)


def measure_death(engine):
    os._exit(7)


DEATH = fake("death", "A process that dies", "Compiled code may do so.", measure_death)


def measure_unending(engine):
    """Create the file RUNNING, then never finish, except for ``GOOD``."""
    if engine.name == GOOD.name:
        return measure_agreement(engine)
    Path(os.environ["RUNNING"]).touch()
    time.sleep(3600.0)
    return Findings()


UNENDING = fake("unending", "A study that takes too long", "An hour.", measure_unending)


PIN, POINTS, RING = (
    f"{what} on straight lines" for what in ("The pin moves", "Six points move", "The ring moves")
)
SYSTEMS = {PIN: FIG5, POINTS: replace(FIG11, contact_points=6), RING: FIG11}


def measure_what_is_promised(engine):
    mine = [sentence for sentence, system in SYSTEMS.items() if engine.simulates(system)]
    claims = tuple(
        claim(sentence, engine.name, 0.0, moved(engine, SYSTEMS[sentence]), 0.0) for sentence in mine
    )
    return Findings(claims, dict.fromkeys(mine, np.zeros(2)), engine.lacking(SYSTEMS.values()))


def moved(engine, system):
    return engine.simulate(system, [0.0] * system.state_size, [0.0, 1.0]).at_end[0]


def measure_a_ring(engine):
    """Omit the check for support, as a study of rings alone may do."""
    made = claim(RING, engine.name, 0.0, moved(engine, FIG11), 0.0)
    return Findings((made,), {"moved": made.measured})


PARTLY = fake("partly", "Pin, points and ring", "Zero.", measure_what_is_promised)
RING_ONLY = fake("ring-only", "The ring", "Zero.", measure_a_ring)


def draw_wrongly(data):
    raise KeyError("radius")


UNDRAWABLE = fake(
    "undrawable", "A figure that fails", "None.", measure_agreement, provided={"figures": draw_wrongly}
)


ALL = (VERDICTS, AGREEMENT, INCONCLUSIVE, COUNTED, DEATH, UNENDING, UNDRAWABLE, PARTLY, RING_ONLY)
