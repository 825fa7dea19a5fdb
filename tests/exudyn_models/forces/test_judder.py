"""Judder: a drive drags a clutch disc on a torsional spring, and friction falls with the slip."""

import math

import exudyn as exu
import numpy as np
import pytest
from free_bodies import coordinate, items, new_model, node_sensor, rotor, run_explicitly, settings_of

from exudyn_models import add_ring_friction, solve_dynamic

INERTIA, STIFFNESS, DAMPING = 0.02, 300.0, 0.1
SPEED, RADIUS, LOAD, COEFFICIENT = 50.0, 0.1, 1000.0, 0.5
MOMENT = COEFFICIENT * LOAD * RADIUS
ONSET = DAMPING / (RADIUS**2 * LOAD)
FALLS = [-1.0, 0.0, 0.9, 1.1, 4.0]
"""Slopes of the coefficient, divided by the slope at the onset of judder."""


def juddering(fall, push, epsilon=1e-3):
    mbs = new_model()
    drive, disc = rotor(mbs, 1e12, SPEED), rotor(mbs, INERTIA, push)
    mbs.SetNodeParameter(disc, "initialCoordinates", [MOMENT / STIFFNESS])
    ends = [coordinate(mbs, None), coordinate(mbs, disc)]
    mbs.AddObject(items.CoordinateSpringDamper(markerNumbers=ends, stiffness=STIFFNESS, damping=DAMPING))
    add_ring_friction(
        mbs,
        drive,
        disc,
        contact_radius=RADIUS,
        friction_coefficient=lambda slip_speed: COEFFICIENT - fall * ONSET * (slip_speed - RADIUS * SPEED),
        normal_load=LOAD,
        regularisation=epsilon,
    )
    kinds = exu.OutputVariableType.Coordinates, exu.OutputVariableType.Coordinates_t
    sensors = [node_sensor(mbs, disc, kind) for kind in kinds]
    mbs.Assemble()
    return mbs, sensors


def eigenvalue(fall):
    """J·λ² + (D − N·R²·γ)·λ + K = 0: a disc that moves with the drive slips less, so its friction is larger."""
    half = DAMPING * (1.0 - fall) / (2.0 * INERTIA)
    return -half + 1j * math.sqrt(STIFFNESS / INERTIA - half**2)


@pytest.mark.parametrize("fall", FALLS)
def test_exudyns_linearisation_has_the_eigenvalue_of_small_vibrations(fall):
    mbs, _ = juddering(fall, 0.1)
    values, _ = mbs.ComputeODE2Eigenvalues(computeComplexEigenvalues=True, useAbsoluteValues=False)
    found = max(values, key=lambda value: value.imag)
    assert found == pytest.approx(eigenvalue(fall), abs=1e-7)


@pytest.mark.parametrize("fall", FALLS)
def test_a_pushed_disc_vibrates_by_the_closed_form_while_it_slips(fall):
    mbs, sensors = juddering(fall, push := 0.1)
    run_explicitly(mbs, 0.5, 1000)
    root = eigenvalue(fall)
    (t, angle), (_, speed) = (mbs.GetSensorStoredData(sensor).T for sensor in sensors)
    wave = -1j * push / root.imag * np.exp(root * t)  # φ = φ₀ + Re(c·e^(λt)) from φ₀ with the push
    # RK67 with ω·h = 0.06 has an error of some 2e-9 of the amplitude.
    size = np.abs(wave).max()
    np.testing.assert_allclose(angle, MOMENT / STIFFNESS + wave.real, rtol=0.0, atol=1e-8 * size)
    np.testing.assert_allclose(speed, (root * wave).real, rtol=0.0, atol=1e-8 * size * abs(root))


def test_judder_that_has_grown_sticks_once_in_a_period_and_never_passes_the_drive():
    mbs, (_, of_speed) = juddering(2.0, push=40.0)
    settings = settings_of(0.6, 600)
    settings.solution.sensors.writePeriod = 0.0  # every step
    options = settings.timeIntegration
    options.absoluteTolerance, options.relativeTolerance = 1e-8, 0.0
    solve_dynamic(mbs, settings, exu.DynamicSolverType.DOPRI5)
    t, speed = mbs.GetSensorStoredData(of_speed).T
    creep = 1e-3 / RADIUS
    for begin in np.arange(0.3, 0.55, 0.06):  # slightly more than a period: 0.051 s plus stick
        assert np.max(speed[(t >= begin) & (t < begin + 0.06)]) == pytest.approx(SPEED, abs=creep)
