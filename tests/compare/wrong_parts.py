"""Faults in the components of the studies of drivetrains, convergence and thrown discs.

Each function takes a ``MonkeyPatch`` and inserts one fault, or returns a function that does.
"""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import exudyn.itemInterface
import numpy as np
import pytest
from faults.make import Make
from faults.plain import simulate as simulate_plainly

import compare.studies.drivetrain.clutch_parts as clutch_parts
import compare.studies.drivetrain.coupled_clutches.study as coupled_clutches
import compare.studies.drivetrain.coupled_clutches.theory as coupled_models
import exudyn_models
from compare.studies.drivetrain.frozen import whirls
from compare.studies.drivetrain.run_up import study as run_up
from compare.studies.plane import thrown_disc as thrown_disc
from compare.studies.plane.pushes import forward as pushed_forward
from compare.studies.plane.tosses import study as tosses
from compare.studies.toolkit.drivetrain_bench import (
    RPM,
    Operation,
    centred_car,
    natural_frequency,
    passenger_car,
)
from exudyn_models.forces.axial_pairs import AxialStick
from exudyn_models.parts.friction_sensors import RingFriction
from exudyn_models.solver.linear import matrices
from exudyn_models.solver.stick import resting
from exudyn_models.solver.stick.planar_stick import PlanarStick
from reference_model.contact.annulus import Annulus
from reference_model.contact.contact_law import Ring
from reference_model.contact.points import Points

items: Any = exudyn.itemInterface

CAR = centred_car()


def replaced(owner, name, wrong):
    """Return a patch that puts ``wrong(right)`` in place of the attribute ``right`` of ``owner``."""
    return lambda patch: patch.setattr(owner, name, wrong(getattr(owner, name)))


def factors_on(owner, factors):
    return {name: factor * getattr(owner, name) for name, factor in factors.items()}


# ---------------------------------------------------------------- judder and heat


def clutch_parts_off(**factors):
    """Build models with parameters off by ``factors``, unlike the prediction."""

    def put(patch):
        def wrong(build):
            def built(*arguments):
                with pytest.MonkeyPatch.context() as inner:
                    for name, value in factors_on(clutch_parts, factors).items():
                        inner.setattr(clutch_parts, name, value)
                    return build(*arguments)

            return built

        for name in ("juddering", "heating"):
            patch.setattr(clutch_parts, name, wrong(getattr(clutch_parts, name)))

    return put


def heat_astray(share):
    """Withhold a share of the heat from the thermal node."""

    def wrong(add):
        def added(*arguments, **options):
            friction = add(*arguments, **options)
            options["thermal_node"].heated_by(lambda mbs, t: -share * friction.power(mbs, t))
            return friction

        return added

    return replaced(exudyn_models, "add_ring_friction", wrong)


# ---------------------------------------------------------------- coupled clutches


def coarsely(patch):
    """Double each ε, which halves the number of steps."""
    patch.setattr(coupled_clutches, "EPSILONS", 2.0 * coupled_clutches.EPSILONS)


def coupled_off(**factors):
    """Build models with numbers off by ``factors``."""

    def put(patch):
        coarsely(patch)
        for name, factor in factors.items():
            patch.setattr(coupled_models, name, np.multiply(factor, getattr(coupled_models, name)).tolist())

    return put


def torque_late(patch):
    """Delay the torque by 0.1 ms."""
    coarsely(patch)
    replaced(coupled_models, "torque", lambda on_time: lambda time: on_time(time - 1e-4))(patch)


def creep_of_another_order(patch):
    """Replace ε by its root."""
    coarsely(patch)
    build = coupled_models.with_our_contact
    patch.setattr(coupled_clutches, "with_our_contact", lambda epsilon: build(epsilon**0.5 * 0.01))


# ---------------------------------------------------------------- the drivetrain at frozen speeds


def bench_off(**factors):
    """Change the drivetrain on the bench by ``factors``."""
    other = replace(CAR, **factors_on(CAR, factors))
    return replaced(Operation, "build", lambda build: lambda operation, car: build(operation, other))


def radial_damping_off(factor):
    """Change the drivetrain's radial damping by ``factor``."""
    damping = factor * CAR.radial_damping
    return replaced(
        exudyn_models,
        "build_drivetrain",
        lambda build: lambda car, **options: build(replace(car, radial_damping=damping), **options),
    )


def reaction_without_the_arm_of_the_force(patch):
    """Derive the engine's row of the state matrix from the disc's row."""

    def wrong(matrix):
        def without_arm(mbs):
            result = matrix(mbs)
            result[5] = -result[9] * CAR.disc_inertia / CAR.engine_inertia
            return result

        return without_arm

    replaced(matrices, "state_matrix", wrong)(patch)


def whirling_car_off(**factors):
    """Change the whirling car by ``factors``."""
    other = replace(CAR, **factors_on(CAR, factors))
    return replaced(
        whirls, "build", lambda build: lambda car, whirl, **options: build(other, whirl, **options)
    )


def balance_that_does_not_close(patch):
    """Remove a millionth of the energy."""
    energy = SimpleNamespace(residual=np.array([0.0, 2e-6]), turnover=1.0)
    motion = SimpleNamespace(times=np.zeros(2), disc=np.zeros((2, 3)), slip=np.zeros(2), energy=energy)
    model = SimpleNamespace(run=lambda *_, **options: motion)
    patch.setattr(whirls, "build", lambda *_, **options: model)


# ---------------------------------------------------------------- an isolated drivetrain, and the run-up


def moment_from_outside(moment):
    """Apply a moment in N m to a planar disc."""

    def wrong(add):
        def with_moment(mbs, base, disc, **parameters):
            marker = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=disc, coordinate=2))
            mbs.AddLoad(items.LoadCoordinate(markerNumber=marker, load=moment))
            return add(mbs, base, disc, **parameters)

        return with_moment

    return replaced(exudyn_models, "add_radial_support", wrong)


def shaft_of_exudyns_own_springs(patch):
    """Apply the shaft's force at the centres of both bodies, not along the line between them."""

    def added(mbs, base, disc, *, stiffness, damping, offset):
        markers = [mbs.AddMarker(items.MarkerNodePosition(nodeNumber=node)) for node in (base, disc)]
        springs = {"stiffness": [stiffness] * 3, "damping": [damping] * 3, "offset": [*offset, 0.0]}
        mbs.AddObject(items.CartesianSpringDamper(markerNumbers=markers, **springs))

    patch.setattr(exudyn_models, "add_radial_support", added)


def run_up_with(orders, until=6000.0):
    """Return data of a run-up whose disc circles with the given orders of the engine and amplitudes in m."""
    times = np.linspace(0.0, 5.0, 10001)
    start, end = 800.0 * RPM, until * RPM
    speed = start + (end - start) * times / times[-1]
    angle = start * times + 0.5 * (end - start) * times**2 / times[-1]
    z = sum(amplitude * np.exp(1j * order * angle) for order, amplitude in orders.items())
    engine, disc = np.column_stack((angle, speed)), np.column_stack((z.real, z.imag, angle))
    return {"times": times, "engine": engine, "disc": disc, "slip": 12.0 + 0.0 * times}


def as_predicted(off=0.0):
    """Return data of a run-up on the lines of the claim, shifted by ``off`` orders as the speed grows."""
    data = run_up_with({1.0: 1e-4})
    car = passenger_car()
    times, (angle, speed) = data["times"], data["engine"].T
    circling, _, frequency = run_up.whirls_above_onset(car).T
    below = speed < 0.5 * (circling[0] + natural_frequency(car))
    own = np.where(below, speed - run_up.SLIP, np.interp(speed, circling, frequency)) + off * speed
    phase = np.concatenate(([0.0], np.cumsum(0.5 * (own[1:] + own[:-1]) * np.diff(times))))
    z = 3e-4 * np.exp(1j * phase) + 1e-4
    return data | {"disc": np.column_stack((z.real, z.imag, angle))}


def moving(data):
    """Replace every run-up by this data, with balanced energy."""

    def put(patch):
        angle, speed = data["engine"].T
        energy = SimpleNamespace(residual=np.zeros(len(angle)), turnover=1.0)
        motion = SimpleNamespace(**data, engine_angle=angle, engine_speed=speed, energy=energy)
        patch.setattr(run_up, "_run_ups", lambda engine, top: (motion, motion))

    return put


def heat_counted_wrong(factor):
    """Multiply the power of friction by ``factor``."""
    return replaced(
        RingFriction, "power", lambda power: lambda friction, mbs, t: factor * power(friction, mbs, t)
    )


# ---------------------------------------------------------------- exact stick


def friction_off(factor):
    """Multiply the friction coefficient of every contact by ``factor``."""

    def wrong(add):
        def added(*arguments, friction_coefficient, **options):
            return add(*arguments, friction_coefficient=factor * friction_coefficient, **options)

        return added

    return replaced(exudyn_models, "add_ring_friction", wrong)


def static_friction_off(factor):
    """Multiply the static friction by ``factor``, so contacts release early if it is below 1."""

    def put(patch):
        limits, holding = AxialStick.limits, PlanarStick.holding_force
        patch.setattr(AxialStick, "limits", lambda *of: tuple(factor * limit for limit in limits(*of)))
        patch.setattr(PlanarStick, "holding_force", lambda *of: factor * holding(*of))

    return put


def unshared_load(patch):
    """Give the whole load to the contacts that are constraints, as if the others did not hold."""

    patch.setattr(resting, "least_maximum", lambda functions, start: 0.0 * start)


def sensed_heat_off(factor):
    """Multiply the heat of the sensors by ``factor``."""

    def wrong(new_power):
        def scaled(friction):
            power = new_power(friction)
            friction._contact.power = lambda t: factor * power(t)
            return friction._contact.power

        return scaled

    return replaced(RingFriction, "_new_power", wrong)


def friction_drives(patch):
    """Reverse the moment of sliding contacts on one axis."""
    replaced(AxialStick, "moment", lambda moment: lambda *of: -moment(*of))(patch)


# ---------------------------------------------------------------- Exudyn's solvers


def first_order(patch):
    """Replace every fixed-step solver by Euler's method."""

    def euler(pin, start, times, *, integrator, step, regularisation=0.0):
        return simulate_plainly(pin, start, times, make=Make(order=1, step=step))

    patch.setattr(exudyn_models, "simulate_fixed_step", euler)


def wider(factor):
    """Change ε of the solvers by ``factor``."""

    def wrong(right):
        def wide(*arguments, **options):
            if "regularisation" in options:
                options["regularisation"] *= factor
            return right(*arguments, **options)

        return wide

    return replaced(exudyn_models, "simulate_fixed_step", wrong)


def half_order(patch):
    """Make ε decrease as the root of the requested value."""

    def wrong(right):
        return lambda *arguments, tolerance, regularisation: right(
            *arguments, tolerance=tolerance, regularisation=1e-2 * regularisation**0.5
        )

    replaced(exudyn_models, "simulate", wrong)(patch)


# ---------------------------------------------------------------- the full disc


def full_disc_as_a_ring(patch):
    """Put the whole load of a full disc on its rim."""
    patch.setattr(thrown_disc, "Annulus", lambda inner, outer: Ring(outer))


def full_disc_with_a_small_hole(patch):
    """Give a full disc a hole of 2 % of its radius."""
    patch.setattr(thrown_disc, "Annulus", lambda inner, outer: Annulus(0.02 * outer, outer))


def cube_with_load_moved(factor):
    """Move the load of the reference's cube on four corners by a wrong distance."""

    def points(places):
        return Points([(x, y, 0.25 + factor * (share - 0.25)) for x, y, share in places])

    return lambda patch: patch.setattr(tosses, "Points", points)


def hand_with_friction(coefficient):
    """Change the friction of the hand in the Exudyn model of a pushed body."""
    return lambda patch: patch.setattr(pushed_forward, "HAND", coefficient)
