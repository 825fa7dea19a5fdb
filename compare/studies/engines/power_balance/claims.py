"""Energy: what the drive puts in is heat and stored energy, on every kind of trajectory and without a reference."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from compare.claims.error_estimates import ROUNDING, refined
from compare.claims.measured import Measured
from compare.claims.study import Data, Study
from compare.engines import Engine, UnsupportedSystemError
from compare.studies.engines.power_balance.parameters import (
    RESOLUTION,
    Motion,
    all_motions,
    motions_of_the_disc,
    motions_of_the_pin,
)
from compare.studies.engines.power_balance.pictures import draw
from reference_model import PowerBalance, Trajectory, power_balance
from reference_model.systems import FloatArray

STUDY = Study.beside(__file__, "power-balance", seconds=2.5, quick=True, contact=True)
STUDY.provides(figures=draw)

SENTENCE = "What the drive puts in is heat and stored energy: {}"

NOTE = (
    "Largest residual at any time, as a fraction of the energy turned over (heat, and the most that was stored). "
    "Error: change with the engine's tolerance, and with every second sample left out of the balance's quadrature, "
    "and the rounding of the energies."
)

Motions = Callable[[], Mapping[str, Motion]]


@STUDY.claim(
    SENTENCE,
    equation="(1)",
    kind="conservation",
    resolution=RESOLUTION,
    note=NOTE,
    basis="reference",
    each=tuple(motions_of_the_pin()),
)
def pin(engine: Engine, name: str, motions: Motions = motions_of_the_pin) -> Measured | None:
    """Compare the largest residual of the balance of a pin's motion with zero."""
    return _residual(engine, name, motions()[name])


@STUDY.claim(
    SENTENCE,
    equation="(19)",
    kind="conservation",
    resolution=RESOLUTION,
    note=NOTE,
    basis="reference",
    each=tuple(motions_of_the_disc()),
)
def disc(engine: Engine, name: str, motions: Motions = motions_of_the_disc) -> Measured | None:
    """Compare the largest residual of the balance of a disc's motion with zero."""
    return _residual(engine, name, motions()[name])


def _residual(engine: Engine, name: str, motion: Motion) -> Measured | None:
    if engine.contact_only and not motion.contact_alone:
        return None
    if not engine.simulates(motion.system):
        raise UnsupportedSystemError(engine.lacking(one.system for one in all_motions().values()))
    balances: dict[float, PowerBalance] = {}
    quadrature: list[float] = []

    def largest_and_last(tolerance: float) -> FloatArray:
        trajectory = _run(engine, motion, tolerance)
        balance, coarser = power_balance(trajectory), power_balance(_every_second(trajectory))
        balances[tolerance] = balance
        quadrature.append(abs(_relative_residual(balance) - _relative_residual(coarser)))
        return np.array([_relative_residual(balance), balance.residual[-1] / balance.turned_over])

    found = refined(largest_and_last, motion.tolerance)
    return Measured(
        predicted=0.0,
        value=found.value[0],
        error=found.largest + min(quadrature) + ROUNDING,
        size=1.0,
        system=motion.system,
        source=motion.source,
        data=_drawn(balances[motion.tolerance]) if motion.drawn else {},
        named={name.replace(",", ""): None},
    )


def _run(engine: Engine, motion: Motion, tolerance: float) -> Trajectory:
    intervals = 2 * round(motion.until / (2.0 * motion.step))  # every second sample has the last one too
    times = np.linspace(0.0, motion.until, intervals + 1)
    return engine.simulate(motion.system, motion.start, times, tolerance=tolerance)


def _every_second(trajectory: Trajectory) -> Trajectory:
    """Return the trajectory with every second sample left out."""
    kept = trajectory.times[::2], trajectory.states[::2]
    return Trajectory(trajectory.system, *kept, trajectory.phases, trajectory.solution)


def _relative_residual(balance: PowerBalance) -> float:
    return float(np.max(np.abs(balance.residual)) / balance.turned_over)


def _drawn(balance: PowerBalance) -> Data:
    return {
        "times": balance.times,
        "drive work": balance.drive_work,
        "friction heat": balance.friction_heat,
        "damper heat": balance.damper_heat,
        "stored energy": balance.stored_energy,
        "residual": balance.residual / balance.turned_over,
    }
