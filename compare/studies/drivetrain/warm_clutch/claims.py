"""A clutch with a temperature: how far an engagement warms it, how its friction fades, and where the heat is."""

from __future__ import annotations

import functools

import numpy as np

from compare.claims.error_estimates import COARSENING, change_as_error
from compare.claims.measured import Measured
from compare.claims.study import Data, Study
from compare.engines import Engine
from compare.studies.drivetrain.warm_clutch.model import Run, run
from compare.studies.drivetrain.warm_clutch.parameters import (
    CAPACITY,
    CONDUCTANCE,
    ENGAGED,
    HEAVY,
    HELD,
    INERTIAS,
    LEFT_OUT,
    NEARLY_HOLDS,
    SLIP,
    SLOW_SLIP,
    SURROUNDINGS,
    TOLERANCE,
    UNTIL,
)
from compare.studies.drivetrain.warm_clutch.pictures import draw
from compare.studies.drivetrain.warm_clutch.theory import (
    HEAT,
    MOMENT,
    REDUCED,
    cold_slipping_time,
    held,
    slip,
    slipping_time,
    warmed,
)
from reference_model.systems import FloatArray

BOTH = (TOLERANCE, TOLERANCE / COARSENING)
OF_TOLERANCE = (
    "Numerical error: the change with the tolerance. Model error: what the run leaves out, 2e-13 of its span, "
    "where it is broken off to be looked at."
)


def curves() -> Data:
    """Return slip and temperature by the closed forms, for the figure."""
    t = np.linspace(0.0, slipping_time(0.0), 100)
    later = np.linspace(0.0, HELD[-1], 100)
    return {"t": t, "slip": slip(t), "warmed": warmed(slip(t)), "later": later, "held": held(later)}


STUDY = Study.beside(
    __file__,
    "warm-clutch",
    source="a clutch that heats its linings, an assumption",
    draw=draw,
    curves=curves,
    only=("exudyn",),
    seconds=2.0,
)


@functools.lru_cache(maxsize=1)
def _engaged(engine: Engine) -> tuple[Run, Run]:
    first, second = (run(INERTIAS, SLIP, 0.0, np.append(ENGAGED, UNTIL), tolerance) for tolerance in BOTH)
    return first, second


def _error(found: FloatArray, finer: FloatArray) -> float:
    return float(np.max(change_as_error(found, finer)))


def _left_out(ends: FloatArray, rate: float) -> float:
    """Return by how much a quantity with at most this rate changes in the times that a run leaves out at breaks."""
    return len(ends[:-1]) * LEFT_OUT * float(ends[-1]) * rate


@STUDY.claim(
    "Friction that fades as it warms up slows the slip of two rotors as the closed form says",
    kind="trajectory",
    unit="rad/s",
    resolution=1e-6,
    note=OF_TOLERANCE,
)
def slips(engine: Engine) -> Measured:
    """Compare the slip with the closed form."""
    coarse, fine = (one.at(ENGAGED).slip for one in _engaged(engine))
    return Measured(
        predicted=slip(ENGAGED),
        value=coarse,
        error=_error(coarse, fine),
        model=_left_out(np.append(ENGAGED, UNTIL), MOMENT / REDUCED),
        at={"t in s": ENGAGED},
        data={"engaged t": ENGAGED, "engaged slip": coarse},
    )


@STUDY.claim(
    "A clutch that engages warms up by the energy lost in slip over the heat capacity",
    kind="trajectory",
    unit="°C",
    resolution=1e-6,
    note=f"{OF_TOLERANCE} Nothing goes to the surroundings.",
)
def warms(engine: Engine) -> Measured:
    """Compare the temperature with the closed form."""
    coarse, fine = (one.at(ENGAGED).temperature for one in _engaged(engine))
    return Measured(
        predicted=warmed(slip(ENGAGED)),
        value=coarse,
        error=_error(coarse, fine),
        model=_left_out(np.append(ENGAGED, UNTIL), MOMENT * SLIP / CAPACITY),
        at={"t in s": ENGAGED},
        data={"engaged temperature": coarse},
    )


@STUDY.claim(
    "Friction that fades lets a clutch slip longer, by the ratio that the closed form says",
    resolution=1e-5,
    note=f"Time until the slip is {NEARLY_HOLDS:g} rad/s over that of friction that stays cold. Numerical error: the "
    "change with the tolerance; and with every other step, between which the slip is taken as straight.",
)
def takes_longer(engine: Engine) -> Measured:
    """Compare the time of the engagement with the closed form."""
    cold = cold_slipping_time(NEARLY_HOLDS)
    coarse, fine = (_time_of(one.times, one.slip) / cold for one in _engaged(engine))
    first = _engaged(engine)[0]
    sparse = _time_of(first.times[::2], first.slip[::2]) / cold
    return Measured(
        predicted=slipping_time(NEARLY_HOLDS) / cold,
        value=coarse,
        error=_error(np.array([coarse]), np.array([fine])) + abs(sparse - coarse),
        named={"slipping time over that of cold friction": 0},
    )


def _time_of(times: FloatArray, slips: FloatArray) -> float:
    """Return when slip comes to ``NEARLY_HOLDS``."""
    return float(np.interp(-NEARLY_HOLDS, -slips, times))


@STUDY.claim(
    "A clutch that goes on slipping warms up exponentially until fading friction heats as much as is lost",
    kind="trajectory",
    unit="°C",
    resolution=1e-6,
    note=f"{OF_TOLERANCE} The slip is held by rotors of {HEAVY:g} kg m²; what they lose of it is in "
    "the model error.",
)
def settles(engine: Engine) -> Measured:
    """Compare the temperature with the closed form."""
    coarse, fine = (
        run((HEAVY, HEAVY), SLOW_SLIP, CONDUCTANCE, HELD, tolerance).at(HELD).temperature
        for tolerance in BOTH
    )
    lost = 2.0 * MOMENT * float(HELD[-1]) / HEAVY
    return Measured(
        predicted=held(HELD),
        value=coarse,
        error=_error(coarse, fine),
        model=_left_out(HELD, MOMENT * SLOW_SLIP / CAPACITY) + MOMENT / CONDUCTANCE * lost,
        at={"t in s": HELD},
        data={"held t": HELD, "held temperature": coarse},
    )


@STUDY.claim(
    "The energies of the rotors and of the warm linings and the heat lost to the surroundings keep their sum",
    kind="conservation",
    unit="J",
    resolution=1e-8 * HEAT,
    note="The largest deviation at any step, with a loss, from slip into stick. Numerical error: of integration, as "
    "seen from the change with the tolerance, and rounding, which grows as the root of the number of steps.",
)
def balance(engine: Engine) -> Measured:
    """Compare the energy after each step with that at the start."""
    changes, steps = [], 0
    for tolerance in BOTH:
        found = run(INERTIAS, SLIP, CONDUCTANCE, np.array([UNTIL]), tolerance)
        energy = 0.5 * found.speeds**2 @ np.array(INERTIAS) + CAPACITY * (found.temperature - SURROUNDINGS)
        changes.append(np.max(np.abs(energy + found.lost - 0.5 * INERTIAS[0] * SLIP**2)))
        steps = len(found.times)
    size = 0.5 * INERTIAS[0] * SLIP**2
    return Measured(
        predicted=0.0,
        value=float(changes[0]),
        error=_error(np.array(changes[:1]), np.array(changes[1:]))
        + 8.0 * np.finfo(float).eps * size * float(np.sqrt(steps)),
        size=size,
    )
