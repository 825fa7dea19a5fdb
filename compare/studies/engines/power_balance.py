"""Energy balance: the work of the drive equals heat plus stored energy."""

import functools
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from compare.claims import ROUNDING, WORKING, ByEngine, Data, Figures, Measured, Study, refined
from compare.claims.parameters import CENTRED, FIG4, FIG5, FIG5_STARTS, FIG11
from compare.engines import DeclaredLackError, Engine
from compare.output.figures import (
    BLACK,
    GREEN,
    GREY,
    ORANGE,
    axis,
    curve,
    engine_style,
    engines_in,
    new_figure,
)
from reference_model import PowerBalance, Trajectory, power_balance, simulate, sticking_radius
from reference_model.formulas.pin import whirl_radius
from reference_model.systems import FloatArray, System

SAMPLE_DISTANCE, FINE = 0.02, 0.2 * 0.02
"""Intervals in s; the fine one is for discs, whose friction has a kink where a point of the contact rests."""

CLOSER, NUMBER, ROUGH = 0.8, 40, 1e-7
"""More samples near the bounds of phases, where integrands are not smooth.

Their distances from a bound form a geometric series with this ratio and number of terms, from the sampling interval
on. The reference supplies the bounds at the tolerance ``ROUGH``; the bounds of other engines differ by less.
"""

RESOLUTION = 1e-8
"""Relative to the energy turned over."""


@dataclass(frozen=True)
class Motion:
    """A motion to ``until`` (s), sampled every ``step`` (s).

    The figure shows it if ``drawn``; engines that only provide the contact take part if ``contact_alone``.
    """

    system: System
    start: tuple[float, ...]
    until: float
    source: str
    tolerance: float = WORKING
    step: float = SAMPLE_DISTANCE
    drawn: bool = False
    contact_alone: bool = False


def all_motions() -> dict[str, Motion]:
    return motions_of_the_pin() | motions_of_the_disc()


def motions_of_the_pin() -> dict[str, Motion]:
    radius = whirl_radius(CENTRED)
    sticky = FIG4
    stuck = 0.98 * sticking_radius(sticky)
    turning = sticky.disc_speed
    return {
        "the way to the equilibrium, with stick phases": Motion(
            FIG5, FIG5_STARTS["equilibrium"], 100.0, "Fig. 5"
        ),
        "the way to the whirl, with stick phases": Motion(
            FIG5, FIG5_STARTS["whirl"], 400.0, "Fig. 5", tolerance=2.0 * WORKING, drawn=True
        ),
        "a whirl that settles": Motion(
            CENTRED,
            (0.8 * radius, 0.0, 0.0, radius),
            100.0,
            "Fig. 4 with X0 = 0, started 20 % inside the whirl",
        ),
        "a pin that sticks all the time": Motion(
            # Its energy turnover is small, and the creep of a regularised law must be small compared with it.
            sticky,
            (stuck, 0.0, 0.0, turning * stuck),
            10.0,
            "Fig. 4, at 0.98 of the radius (9)",
            tolerance=WORKING / 20,
        ),
        "a pin on a resting disc": Motion(
            replace(FIG4, disc_speed=0.0), (0.8, 0.3, -0.2, 0.5), 40.0, "Fig. 4 with ω = 0, arbitrary start"
        ),
        "a disc that turns the other way": Motion(
            replace(FIG4, disc_speed=-FIG4.disc_speed),
            (0.5, 0.2, 0.0, -0.3),
            100.0,
            "Fig. 4 with −ω, arbitrary start",
        ),
    }


def motions_of_the_disc() -> dict[str, Motion]:
    near_axis, thrown = (0.02, 0.0, 0.0, 0.0, 0.0, 1.3), (0.0, 0.0, 0.0, 0.5, 0.2, 3.0)
    sticky = replace(FIG11, friction_force=0.1)
    table = replace(
        FIG11,
        stiffness=0.0,
        damping=0.0,
        shaft_damping=0.0,
        disc_speed=0.0,
        friction_force=0.1,
        polar_inertia=FIG11.mass * FIG11.contact_radius**2,
    )
    on_table = "only friction, on a disc at rest, μN = 0.1 N, J = mR², arbitrary start"
    return {
        "a disc on its way to the modulated cycle": Motion(
            FIG11, near_axis, 100.0, "Fig. 11 with X0 = 0, arbitrary start", step=FINE
        ),
        "a disc on six points": Motion(
            replace(FIG11, contact_points=6),
            near_axis,
            40.0,
            "Fig. 11 with X0 = 0, arbitrary start",
            step=FINE,
        ),
        "a disc with an offset, turning the other way": Motion(
            replace(FIG11, disc_speed=-FIG11.disc_speed, shaft_speed=-FIG11.shaft_speed, offset=0.02),
            (0.02, 0.0, 0.0, 0.0, 0.0, -1.3),
            40.0,
            "Fig. 11 with −ω, −Ω and X0 = 0.02 m, arbitrary start",
            step=FINE,
        ),
        "a disc that sticks all the time": Motion(
            sticky,
            (0.05, 0.0, 0.0, 0.0, 0.05 * sticky.disc_speed, sticky.disc_speed),
            2.0,
            "Fig. 11, μN = 0.1 N",
        ),
        "a ring thrown on a table, to rest": Motion(table, thrown, 10.0, on_table),
        "six points thrown on a table, to rest": Motion(
            # One of the points rests before the others, which makes the quadrature less accurate.
            replace(table, contact_points=6),
            thrown,
            10.0,
            on_table,
            step=0.25 * FINE,
            contact_alone=True,
        ),
    }


STUDY = Study.beside(__file__, "power-balance", seconds=2.5, quick=True, contact=True)

Motions = Callable[[], Mapping[str, Motion]]


_conserved = functools.partial(
    STUDY.claim,
    "The work of the drive equals heat plus stored energy: {}",
    kind="conservation",
    resolution=RESOLUTION,
    note="Largest residual at any time, relative to the energy turned over (heat, and the largest stored energy). "
    "Numerical error: the change with the engine's tolerance, the change of the quadrature without every second "
    "sample, and the rounding of the energies.",
    basis="reference",
)


@_conserved(equation="(1)", each=tuple(motions_of_the_pin()))
def pin(engine: Engine, name: str, motions: Motions = motions_of_the_pin) -> Measured | None:
    return _residual(engine, name, motions()[name])


@_conserved(equation="(19)", each=tuple(motions_of_the_disc()))
def disc(engine: Engine, name: str, motions: Motions = motions_of_the_disc) -> Measured | None:
    return _residual(engine, name, motions()[name])


def _residual(engine: Engine, name: str, motion: Motion) -> Measured | None:
    if engine.contact_only and not motion.contact_alone:
        return None
    if not engine.simulates(motion.system):
        raise DeclaredLackError(engine.lacking(one.system for one in all_motions().values()))
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
        data=lambda: _drawn(next(iter(balances.values()))) if motion.drawn else {},
        named={name.replace(",", ""): None},
    )


def _run(engine: Engine, motion: Motion, tolerance: float) -> Trajectory:
    return engine.simulate(motion.system, motion.start, _times(motion), tolerance=tolerance)


@functools.cache
def _times(motion: Motion) -> FloatArray:
    """Return an odd number of times (s), so every second sample includes the last sample."""
    evenly = np.linspace(0.0, motion.until, 2 * round(motion.until / (2.0 * motion.step)) + 1)
    rough = simulate(motion.system, motion.start, evenly[[0, -1]], tolerance=ROUGH)
    near = motion.step * CLOSER ** np.arange(NUMBER)
    bounds = np.array([phase.start for phase in rough.phases[1:]])
    closer = np.ravel(bounds[:, np.newaxis] + [*near, *-near])
    times = np.union1d(evenly, closer[(closer > 0.0) & (closer < motion.until)])
    return times if len(times) % 2 else np.delete(times, 1)


def _every_second(trajectory: Trajectory) -> Trajectory:
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


def draw(data: ByEngine) -> Figures:
    figure, (energies, residuals) = new_figure(ncols=2)
    looks: dict[str, dict[str, Any]] = {
        "drive work": {"color": BLACK, "linestyle": "-"},
        "friction heat": {"color": ORANGE, "linestyle": (0.0, (5.0, 1.5))},
        "damper heat": {"color": GREEN, "linestyle": (0.0, (1.0, 1.0))},
        "stored energy": {"color": GREY, "linestyle": "-"},
    }
    sparse = slice(None, None, 5)

    for rank, engine in enumerate(engines_in(data)):
        found = data[engine]
        if rank == 0:
            for name, look in looks.items():
                energies.plot(found["times"][sparse], found[name][sparse], linewidth=1.3, **look)
                end = (found["times"][-1], found[name][-1])
                energies.annotate(
                    name, end, (-2, 5), textcoords="offset points", color=look["color"], ha="right"
                )
        largest = np.maximum.accumulate(np.maximum(np.abs(found["residual"]), 1e-18))
        residuals.semilogy(found["times"][sparse], largest[sparse], **curve(engine))
        place = (found["times"][-1], largest[-1])
        residuals.annotate(
            engine,
            place,
            (0, 7 - 21 * rank),
            textcoords="offset points",
            color=engine_style(engine).colour,
            ha="right",
        )
    residuals.axhline(RESOLUTION, color=BLACK, linewidth=0.8, linestyle=(0.0, (4.0, 3.0)))
    residuals.annotate("resolution of the claim", (0.0, RESOLUTION), (0, 5), textcoords="offset points")
    energies.set(xlabel=axis("t", "s"), ylabel="energy in J")
    residuals.set(xlabel=axis("t", "s"), ylabel="largest residual so far / energy", ylim=(1e-16, 1e-7))
    return {"power-balance": figure}


STUDY.provides(figures=draw)
