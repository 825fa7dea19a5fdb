"""The study of the launch agrees, and each of its claims fails for a drivetrain that is wrong."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad
from study_harness import BLIND, LEFT_OUT, SEES
from wrong_parts import WrongPartTests

import exudyn_models
from compare.studies.drivetrain.launch.claims import STUDY
from compare.studies.drivetrain.launch.parameters import EPSILONS, STUCK, UNTIL
from compare.studies.drivetrain.launch.theory import FullSlip, Launch, states_at, sticking_launch
from compare.studies.toolkit.drivetrain_bench import centred_car
from exudyn_models import PASSENGER_CAR, RingFriction

CENTRED = centred_car()


def with_car(**factors):
    """Let every drivetrain be built with parameters that are off by ``factors``."""

    def put(patch):
        build = exudyn_models.build_drivetrain

        def off(car, **options):
            # The load stays that of the true clutch.
            wrong = {name: factor * getattr(car, name) for name, factor in factors.items()}
            return build(replace(car, **wrong), **options)

        patch.setattr(exudyn_models, "build_drivetrain", off)

    return put


def heat_not_counted(patch):
    power = RingFriction.power
    patch.setattr(RingFriction, "power", lambda self, mbs, t: 0.99999 * power(self, mbs, t))


def creep_of_another_size_and_order(patch):
    build = exudyn_models.build_drivetrain
    patch.setattr(
        exudyn_models,
        "build_drivetrain",
        lambda car, *, regularisation, **options: build(
            car, regularisation=math.sqrt(0.1 * regularisation), **options
        ),
    )


class TestDrivetrainLaunch(WrongPartTests):
    study = STUDY
    few_of_faults = {"balance": {"until": 0.3}}
    faults = {
        "engine's inertia 0.1 % off": with_car(engine_inertia=1.001),
        "disc's inertia 0.1 % off": with_car(disc_inertia=1.001),
        "vehicle's inertia 0.1 % off": with_car(vehicle_inertia=1.001),
        "friction 0.1 % off": with_car(friction_coefficient=1.001),
        "torsional stiffness 0.1 % off": with_car(torsional_stiffness=1.001),
        "unbalance 0.1 % off": with_car(unbalance=1.001),
        "heat not counted": heat_not_counted,
        "holds 1 % less": with_car(friction_coefficient=0.99),
        "creep of another size and order": creep_of_another_size_and_order,
    }
    columns = ("balance", "momentum", "full_slip", "exact", "held", "order")
    table = {
        "engine's inertia 0.1 % off": (LEFT_OUT, SEES, SEES, LEFT_OUT, LEFT_OUT, LEFT_OUT),
        "disc's inertia 0.1 % off": (LEFT_OUT, SEES, SEES, LEFT_OUT, LEFT_OUT, LEFT_OUT),
        "vehicle's inertia 0.1 % off": (LEFT_OUT, SEES, SEES, LEFT_OUT, LEFT_OUT, LEFT_OUT),
        # Friction is inner force.
        "friction 0.1 % off": (LEFT_OUT, BLIND, SEES, LEFT_OUT, LEFT_OUT, LEFT_OUT),
        # Not torsional damping, which acts on the first oscillation only: 2e-11 of the heat, as much as the error.
        "torsional stiffness 0.1 % off": (LEFT_OUT, BLIND, SEES, LEFT_OUT, LEFT_OUT, LEFT_OUT),
        # A centred disc has none.
        "unbalance 0.1 % off": (LEFT_OUT, SEES, BLIND, LEFT_OUT, LEFT_OUT, LEFT_OUT),
        "heat not counted": (SEES, LEFT_OUT, SEES, LEFT_OUT, LEFT_OUT, LEFT_OUT),
        "holds 1 % less": (LEFT_OUT, LEFT_OUT, LEFT_OUT, SEES, LEFT_OUT, LEFT_OUT),
        "creep of another size and order": (LEFT_OUT, LEFT_OUT, LEFT_OUT, LEFT_OUT, SEES, SEES),
    }

    def test_the_car_slips_sticks_and_slips_again(self):
        _, parts = sticking_launch()
        assert [part.sticks for part in parts] == [False, False, True, True, False, False]
        data = self.found("exudyn").data
        slip = data["speeds"][:, 0] - data["speeds"][:, 1]
        creep = EPSILONS[0] / CENTRED.friction_radius
        start, end = data["stick"]
        during = (data["t"] > start + 0.01) & (data["t"] < end - 0.01)
        assert np.abs(slip[during]).max() < creep
        assert slip[0] > 200.0
        assert slip[-1] > 10.0

    def test_friction_pulls_the_disc_towards_the_engines_axis_where_the_slip_ends(self):
        data = self.found("exudyn").data
        radius = np.hypot(*data["centre"].T)
        before, stuck = (np.interp(time, data["t"], radius) for time in (0.5, STUCK[-1]))
        assert before == pytest.approx(PASSENGER_CAR.offset, rel=0.02)
        assert stuck < 0.5 * PASSENGER_CAR.offset

    @pytest.mark.parametrize("stiffness", [1000.0, 1500.0])
    def test_closed_form_of_full_slip_is_that_of_the_equations(self, stiffness):
        theory = FullSlip(replace(CENTRED, torsional_stiffness=stiffness), 210.0, 100.0, 225.0)
        until = theory.time_of(10.0)
        (part,) = Launch(theory.rotors, lambda t: 225.0 * t, [], lambda *_: 100.0, lambda *_: 0.0).run(
            210.0, until
        )
        *_, engine, disc, vehicle, heat = part.states(until)
        assert engine - disc == pytest.approx(10.0, rel=1e-9)
        np.testing.assert_allclose(theory.speeds(until), [engine, disc, vehicle], rtol=1e-11)
        assert theory.heat(until) == pytest.approx(heat, rel=1e-11)

    def test_exact_launch_keeps_energy_and_sticks_within_its_capacity(self):
        launch, parts = sticking_launch()

        def power(t):
            state = states_at(parts, t)
            engine = launch.engine_torque(t, state[0], state[3]) * state[3]
            vehicle = launch.vehicle_torque(t, state[2], state[5]) * state[5]
            return engine + vehicle - CENTRED.torsional_damping * (state[4] - state[5]) ** 2

        gained = sum(quad(power, part.start, part.end, limit=400, epsrel=1e-10)[0] for part in parts)
        start, end = parts[0].states(0.0), parts[-1].states(UNTIL)
        inertias = np.array([CENTRED.engine_inertia, CENTRED.disc_inertia, CENTRED.vehicle_inertia])

        def stored(state):
            return (
                inertias @ state[3:6] ** 2 + CENTRED.torsional_stiffness * (state[1] - state[2]) ** 2
            ) / 2.0

        assert stored(end) - stored(start) + end[6] == pytest.approx(gained, rel=1e-8)
        for part in parts:
            times = np.linspace(part.start, part.end, 50)[1:-1]
            if part.sticks:
                assert all(launch.spare(t, part.states(t)) > 0.0 for t in times)
                assert all(abs(part.states(t)[3] - part.states(t)[4]) < 1e-9 for t in times)
            else:
                assert all(part.states(t)[3] > part.states(t)[4] for t in times)
