"""Energy: what the drive puts in is heat and stored energy, on every kind of trajectory and without a reference."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from compare.claims.claim import Claim, ErrorBudget
from compare.claims.error_estimates import ROUNDING, refined
from compare.claims.paper_parameters import CENTRED, FIG4, FIG5, FIG5_STARTS, FIG11
from compare.claims.parameters import parameters_of
from compare.claims.study import Data, Findings, Study
from compare.engines import Engine
from compare.figures import BLACK, GREEN, GREY, ORANGE, axis, curve, engines_in, new_figure
from reference_model import PinOnDisc, PowerBalance, Trajectory, power_balance, sticking_radius
from reference_model.formulas.pin import whirl_radius
from reference_model.systems import FloatArray, System

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SAMPLE_DISTANCE = 0.02
"""In s: close enough that the balance's quadrature through stick phases is good to 1e-9."""

RESOLUTION = 1e-8
"""Of the energy that is turned over."""

DRAWN = "the way to the whirl, with stick phases"


@dataclass(frozen=True)
class Motion:
    """A kind of motion: parameters, start, length and distance of samples in s, and where they come from."""

    system: System
    start: tuple[float, ...]
    until: float
    source: str
    tolerance: float = 1e-9
    step: float = SAMPLE_DISTANCE


SENTENCE = "What the drive puts in is heat and stored energy: {}"


def all_motions() -> dict[str, Motion]:
    """Return the motions by the words in which the claims name them."""
    return motions_of_the_pin() | motions_of_the_disc()


def motions_of_the_pin() -> dict[str, Motion]:
    """Return the motions of a pin; one of them is drawn."""
    radius = whirl_radius(CENTRED)
    sticky = FIG4
    stuck = 0.98 * sticking_radius(sticky)
    turning = sticky.disc_speed
    return {
        "the way to the equilibrium, with stick phases": Motion(
            FIG5, FIG5_STARTS["equilibrium"], 400.0, "Fig. 5"
        ),
        DRAWN: Motion(FIG5, FIG5_STARTS["whirl"], 400.0, "Fig. 5"),
        "a whirl that settles": Motion(
            CENTRED,
            (0.8 * radius, 0.0, 0.0, radius),
            100.0,
            "Fig. 4 with X0 = 0, started 20 % inside the whirl",
        ),
        "a pin that sticks all the time": Motion(
            # It turns over little energy, against which a smoothed law's creep must be small.
            sticky,
            (stuck, 0.0, 0.0, turning * stuck),
            10.0,
            "Fig. 4, at 0.98 of the radius (9)",
            tolerance=5e-11,
        ),
        "a pin on a resting disc": Motion(
            replace(FIG4, disc_speed=0.0), (0.8, 0.3, -0.2, 0.5), 40.0, "Fig. 4 with ω = 0, start by choice"
        ),
        "a disc that turns the other way": Motion(
            replace(FIG4, disc_speed=-FIG4.disc_speed),
            (0.5, 0.2, 0.0, -0.3),
            100.0,
            "Fig. 4 with −ω, start by choice",
        ),
    }


def motions_of_the_disc() -> dict[str, Motion]:
    """Return the motions of a friction disc, on the continuous ring and on six points."""
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
    on_table = "nothing but friction on a disc at rest, μN = 0.1 N, J = mR², start by choice"
    return {
        "a disc on its way to the modulated cycle": Motion(
            FIG11, near_axis, 100.0, "Fig. 11 with X0 = 0, start by choice"
        ),
        "a disc on six points": Motion(
            replace(FIG11, contact_points=6), near_axis, 40.0, "Fig. 11 with X0 = 0, start by choice"
        ),
        "a disc with an offset, turning the other way": Motion(
            replace(FIG11, disc_speed=-FIG11.disc_speed, shaft_speed=-FIG11.shaft_speed, offset=0.02),
            (0.02, 0.0, 0.0, 0.0, 0.0, -1.3),
            40.0,
            "Fig. 11 with −ω, −Ω and X0 = 0.02 m, start by choice",
        ),
        "a disc that sticks all the time": Motion(
            sticky,
            (0.05, 0.0, 0.0, 0.0, 0.05 * sticky.disc_speed, sticky.disc_speed),
            2.0,
            "Fig. 11, μN = 0.1 N",
        ),
        "a ring thrown on a table, to rest": Motion(table, thrown, 10.0, on_table),
        "six points thrown on a table, to rest": Motion(
            # One of the points rests before the others, where the quadrature is worse.
            replace(table, contact_points=6),
            thrown,
            10.0,
            on_table,
            step=0.1 * SAMPLE_DISTANCE,
        ),
    }


def free_points() -> dict[str, Motion]:
    """Return the motions of points that nothing but their contact acts on."""
    return {name: motion for name, motion in all_motions().items() if name.startswith("six points thrown")}


def measure(engine: Engine, motions: Mapping[str, Motion] | None = None) -> Findings:
    """Check the balance of every motion; keep that of Fig. 5's second start for the figure."""
    motions = motions or (free_points() if engine.contact_only else all_motions())
    mine = {name: motion for name, motion in motions.items() if engine.simulates(motion.system)}
    run = functools.cache(functools.partial(_run, engine))
    claims = tuple(balance_claim(engine, run, name, motion) for name, motion in mine.items())
    drawn = _drawn(power_balance(run(mine[DRAWN], mine[DRAWN].tolerance))) if DRAWN in mine else {}
    lacking = engine.lacking(motion.system for motion in motions.values())
    return Findings(claims, drawn, not_simulated=lacking)


def _drawn(balance: PowerBalance) -> Data:
    return {
        "times": balance.times,
        "drive work": balance.drive_work,
        "friction heat": balance.friction_heat,
        "damper heat": balance.damper_heat,
        "stored energy": balance.stored_energy,
        "residual": balance.residual / balance.turned_over,
    }


def _run(engine: Engine, motion: Motion, tolerance: float) -> Trajectory:
    intervals = 2 * round(motion.until / (2.0 * motion.step))  # every second sample has the last one too
    times = np.linspace(0.0, motion.until, intervals + 1)
    return engine.simulate(motion.system, motion.start, times, tolerance=tolerance)


def _relative_residual(balance: PowerBalance) -> float:
    return float(np.max(np.abs(balance.residual)) / balance.turned_over)


def balance_claim(
    engine: Engine, run: Callable[[Motion, float], Trajectory], name: str, motion: Motion
) -> Claim:
    """Compare the largest residual of the balance of ``motion`` with zero; ``run`` simulates it at a tolerance."""
    quadrature: dict[float, float] = {}

    def residual_at_ends(tolerance: float) -> FloatArray:
        trajectory = run(motion, tolerance)
        balance, coarser = power_balance(trajectory), power_balance(_every_second(trajectory))
        quadrature[tolerance] = abs(_relative_residual(balance) - _relative_residual(coarser))
        return np.array([_relative_residual(balance), balance.residual[-1] / balance.turned_over])

    (largest, _), errors = refined(residual_at_ends, motion.tolerance)
    return Claim(
        SENTENCE.format(name),
        equation="(1)" if isinstance(motion.system, PinOnDisc) else "(19)",
        kind="conservation",
        engine=engine.name,
        predicted=0.0,
        measured=largest,
        budget=ErrorBudget(
            float(np.max(errors)) + min(quadrature.values()) + ROUNDING, resolution=RESOLUTION
        ),
        parameters=parameters_of(motion.system),
        source=motion.source,
        note="Largest residual at any time, as a fraction of the energy turned over (heat, and the most that was "
        "stored). Error: change with the engine's tolerance, and with every second sample left out of the "
        "balance's quadrature, and the rounding of the energies.",
        basis="reference",
        named={name.replace(",", ""): None},
    )


def _every_second(trajectory: Trajectory) -> Trajectory:
    """Return the trajectory with every second sample left out."""
    return replace(trajectory, times=trajectory.times[::2], states=trajectory.states[::2])


def draw(data: Mapping[str, Data]) -> dict[str, Figure]:
    """Where the energy goes on the way to the whirl, and what is left over."""
    figure, (energies, residuals) = new_figure(ncols=2)
    looks: dict[str, dict[str, Any]] = {
        "drive work": {"color": BLACK, "linestyle": "-"},
        "friction heat": {"color": ORANGE, "linestyle": (0.0, (5.0, 1.5))},
        "damper heat": {"color": GREEN, "linestyle": (0.0, (1.0, 1.0))},
        "stored energy": {"color": GREY, "linestyle": "-"},
    }
    for rank, engine in enumerate(engines_in(data)):
        found = data[engine]
        sparse = slice(None, None, 5)
        if rank == 0:
            for name, look in looks.items():
                energies.plot(found["times"][sparse], found[name][sparse], label=name, linewidth=1.3, **look)
        size = np.maximum(np.abs(found["residual"]), 1e-16)
        residuals.semilogy(found["times"][sparse], size[sparse], **curve(engine, linewidth=1.0))
    residuals.axhline(RESOLUTION, color=BLACK, linewidth=0.8, linestyle=(0.0, (4.0, 3.0)), label="resolution")
    energies.set(xlabel=axis("t", "s"), ylabel="energy in J")
    residuals.set(xlabel=axis("t", "s"), ylabel="residual / energy turned over", ylim=(1e-14, 1e-7))
    energies.legend()
    residuals.legend(loc="lower right")
    return {"power-balance": figure}


STUDY = Study(
    name="power-balance",
    title="Power balance of every kind of motion",
    section="The engines",
    paper="Not in the paper, but implied by (1) and (19): what the drive of the disc puts in is friction heat, heat "
    "of the dampers, work on the shaft of a friction disc and stored energy. The drive's work is taken from the "
    "angular momentum of the motion and the heat from the slip, so the balance checks friction, damping, springs "
    "and integrator of an engine without any reference solution.",
    by_hand=measure,
    draw=draw,
    figures={
        "power-balance": "Left: energies on Fig. 5's way to the whirl (reference). Right: what the balance of each "
        "engine leaves over, as a fraction of the energy turned over."
    },
    seconds=4.0,
    quick=True,
    contact=True,
)
