"""What friction costs in Exudyn, and what a smaller regularisation costs and brings.

Run as ``python benchmarks/exudyn_contact.py``; prints tables. Figures of one run compare with each other: the
least of several repetitions, interleaved so that a busy machine hits all rows alike.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import exudyn as exu
import exudyn.itemInterface
import numba
import numpy as np

import reference_model
from compare.paper import FIG5, FIG11
from exudyn_models import add_ring_friction, build_pin_on_disc, simulate
from exudyn_models.friction_laws import CONTINUOUS, NONE_HELD, Contact, ring_friction
from exudyn_models.planar_pairs import _force_on_rotor
from exudyn_models.strength import NumberOrFunction, Strength

STEPS = 20_000
EVALUATIONS_PER_STEP = 5  # four stages of RK44, and the acceleration at the end of the step
REPETITIONS = 7

AddContact = Callable[[Any, Any, Any], None]


def ours(normal_load: NumberOrFunction = FIG5.friction_force, **geometry: Any) -> AddContact:
    """Add the connector as it is used."""

    def add(mbs: Any, master: Any, disc: Any) -> None:
        add_ring_friction(
            mbs,
            master,
            disc,
            friction_coefficient=1.0,
            normal_load=normal_load,
            regularisation=1e-6,
            **geometry,
        )

    return add


def with_force(force: Callable[..., list[float]]) -> AddContact:
    """Add the same connector with another force function."""

    def add(mbs: Any, master: Any, disc: Any) -> None:
        mbs.AddObject(
            exudyn.itemInterface.ObjectGenericODE2(
                nodeNumbers=[master, disc], massMatrix=np.zeros((4, 4)), forceUserFunction=force
            )
        )

    return add


def kernel(function: Callable[..., Any], radius: float, points: int) -> AddContact:
    """Add the connector with its force evaluated by a given kernel."""
    strength = Strength((radius, points, 1.0, 1e-6, NONE_HELD, radius), 1.0, FIG5.friction_force)
    return with_force(_force_on_rotor(function, 0.0, 0.0, 0.0, strength, constant))


def constant(*arguments: Any) -> list[float]:
    """Return no force: what is left is the call itself."""
    return [0.0, 0.0, 0.0, 0.0]


CONTACTS: dict[str, AddContact | None] = {
    "no friction, native springs only": None,
    "a user function that returns constants": with_force(constant),
    "pin, connector as used": ours(contact_radius=0.0),
    "pin, numba": kernel(ring_friction, 0.0, 1),
    "six points, connector as used": ours(contact_radius=0.12, contact_points=6),
    "24 points, connector as used": ours(contact_radius=0.12, contact_points=24),
    "continuous ring, connector as used": ours(contact_radius=0.12),
    "the same under a load of time": ours(lambda t: FIG5.friction_force, contact_radius=0.12),
    "annulus, connector as used": ours(inner_radius=0.08, outer_radius=0.12),
}


@numba.njit
def evaluations_in_a_loop(count: int, contact: Contact, fastest: float) -> float:
    """Evaluate force and moment ``count`` times, with slip speeds of the centre up to ``fastest`` (m/s)."""
    total = 0.0
    for i in range(count):
        fx, _, moment, _ = ring_friction(
            0.0, 0.0, 0.3, fastest * (i % 1000) / 1000.0, 0.001, 0.0, 0.2, contact
        )
        total += fx + moment
    return total


def cost_of_kernels() -> None:
    """Print the time of one evaluation of the compiled law, without Exudyn and without a call from Python."""
    count = 5_000
    print(f"{'compiled law, force and moment':<42}{'ns/evaluation':>15}")
    for name, radius, points in (
        ("pin", 0.0, 1),
        ("six points", 0.12, 6),
        ("24 points", 0.12, 24),
        ("continuous ring", 0.12, CONTINUOUS),
    ):
        contact = (radius, points, FIG5.friction_force, 1e-7, NONE_HELD, radius)
        for where, fastest in (("around U = W", 0.048), ("U up to 20 W", 0.48)):
            best = math.inf
            for _ in range(200):
                began = time.perf_counter()
                evaluations_in_a_loop(count, contact, fastest)
                best = min(best, time.perf_counter() - began)
            print(f"{name + ', ' + where:<42}{best / count * 1e9:>15.1f}")


def seconds(add_contact: AddContact | None) -> float:
    """Return the time that ``STEPS`` steps of RK44 take."""
    without = replace(FIG5, friction_force=0.0)
    model = build_pin_on_disc(without, np.array([1.3, 0.0, 0.0, -1.3]), regularisation=1e-6)
    if add_contact is not None:
        add_contact(model.mbs, exu.NodeIndex(0), exu.NodeIndex(1))
    model.mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 1e9
    options = settings.timeIntegration
    options.verboseMode = 0
    options.numberOfSteps, options.endTime = STEPS, STEPS * 1e-3
    options.solverType = exu.DynamicSolverType.RK44
    solver: Any = exu.MainSolverExplicit()
    began = time.perf_counter()
    solver.SolveSystem(model.mbs, settings)
    return time.perf_counter() - began


def cost_of_contacts() -> None:
    """Print the table of costs per step and per evaluation."""
    best = dict.fromkeys(CONTACTS, math.inf)
    for _ in range(REPETITIONS):
        for name, contact in CONTACTS.items():
            best[name] = min(best[name], seconds(contact))
    bare = best["no friction, native springs only"]
    print(f"\n{'RK44, fixed step':<42}{'us/step':>9}{'ratio':>8}{'ns/evaluation of the contact':>30}")
    for name, value in best.items():
        extra = (value - bare) / STEPS / EVALUATIONS_PER_STEP * 1e9
        print(f"{name:<42}{value / STEPS * 1e6:>9.2f}{value / bare:>8.2f}{extra:>30.0f}")


def choice_of_regularisation() -> None:
    """Print error and cost of Fig. 5's second run over ε, the ground for ε = 100·tolerance."""
    start, times = [0.1, 0.0, 0.03, 0.0], [0.0, 400.0]
    exact = reference_model.simulate(FIG5, start, times, tolerance=1e-11)
    events = np.array([(phase.start, phase.end) for phase in exact.stick_phases])
    print(
        f"\n{'ε in m/s':>9}{'evaluations':>13}{'s':>7}{'state at 400 s':>16}{'/ε':>7}"
        f"{'1st stick':>11}{'1st release':>13}{'worst event':>13}{'/ε':>7}"
    )
    for epsilon in (1e-5, 1e-6, 1e-7, 1e-8):
        found = simulate(FIG5, start, times, regularisation=epsilon)
        error = np.abs(found.at_end - exact.at_end).max()
        late = np.abs(np.array([(phase.start, phase.end) for phase in found.stick_phases]) - events)
        print(
            f"{epsilon:>9.0e}{found.solution.evaluations:>13,}{found.solution.wall_time:>7.2f}"
            f"{error:>16.1e}{error / epsilon:>7.0f}{late[0, 0]:>11.1e}{late[0, 1]:>13.1e}"
            f"{late.max():>13.1e}{late.max() / epsilon:>7.0f}"
        )


def slip_of_discs() -> None:
    """Print error and cost of Fig. 11's disc to t = 100 s, the ground for DOPRI5's tolerance."""
    print(f"\n{'disc, t = 100 s':<18}{'tolerance':>10}{'evaluations':>13}{'s':>7}{'error at the end':>18}")
    for points in (None, 6):
        disc = replace(FIG11, contact_points=points)
        start, times = [0.05, 0.0, 0.0, 0.0, 0.05, 1.3], [0.0, 100.0]
        exact = reference_model.simulate(disc, start, times, tolerance=1e-13)
        for tolerance in (1e-6, 1e-8, 1e-9, 1e-10):
            found = simulate(disc, start, times, tolerance=tolerance)
            name = "continuous ring" if points is None else f"{points} points"
            print(
                f"{name:<18}{tolerance:>10.0e}{found.solution.evaluations:>13,}"
                f"{found.solution.wall_time:>7.2f}{np.abs(found.at_end - exact.at_end).max():>18.1e}"
            )


if __name__ == "__main__":
    exu.config.printToConsole = False
    cost_of_kernels()
    cost_of_contacts()
    choice_of_regularisation()
    slip_of_discs()
