"""Runs of solve_dynamic: they continue correctly, and errors show their time and cause."""

import math

import exudyn as exu
import pytest
from free_bodies import coordinate, coordinates, drive, items, new_model, planar_body, rotor, settings_of

from exudyn_models import add_ring_friction, solve_dynamic
from reference_model.trajectory import SimulationError

SOLVERS = exu.DynamicSolverType


def settings(solver=SOLVERS.RK44, start=0.0, end=1.0, steps=100):
    result = settings_of(end, steps, start)
    result.timeIntegration.solverType, result.timeIntegration.adaptiveStep = solver, False
    return result


def clutch(load=2.0):
    """Return a disc on the axis of a rotor; its spin grows at R·μN/J = 0.05·load."""
    mbs = new_model()
    master, disc = rotor(mbs, 1.0, 20.0), planar_body(mbs, 1.0, 1.0, [0.0] * 3, [0.0] * 3)
    law = {"contact_radius": 0.1, "friction_coefficient": 0.5, "regularisation": 5e-3}
    add_ring_friction(mbs, master, disc, normal_load=load, **law)
    return mbs, disc


def add_coordinate_force(mbs, node, force):
    """Add a spring with a user-defined force between the ground and the first coordinate of a node."""
    mbs.AddObject(
        items.ObjectConnectorCoordinateSpringDamper(
            markerNumbers=[coordinate(mbs, None), coordinate(mbs, node)],
            springForceUserFunction=lambda mbs, t, item, u, v, stiffness, damping, offset: force(t, u),
        )
    )


@pytest.mark.parametrize("solver", [SOLVERS.RK44, SOLVERS.DOPRI5, SOLVERS.GeneralizedAlpha])
def test_a_run_that_is_sound_goes_through_and_can_go_on(solver):
    mbs, disc = clutch()
    for start in (0.0, 1.0):  # the model is assembled for the first of them
        span = {"start": start, "end": start + 1.0}
        if start == 0.0:
            solve_dynamic(mbs, settings(solver, **span), updateInitialValues=True)
        else:
            solve_dynamic(mbs, settings(**span), solver, updateInitialValues=True)
        assert coordinates(mbs, disc)[1][2] == pytest.approx(0.1 * (start + 1.0), rel=1e-9)


@pytest.mark.parametrize("exact_stick", [False, True])
def test_an_explicit_solver_is_refused_where_the_model_has_constraints(exact_stick):
    mbs, disc = clutch()
    if exact_stick:
        law = {"contact_radius": 0.1, "friction_coefficient": 0.5, "normal_load": 1.0}
        add_ring_friction(mbs, None, rotor(mbs, 1.0, 0.0), **law)
    else:
        joint = [coordinate(mbs, None), coordinate(mbs, disc, 0)]
        mbs.AddObject(items.ObjectConnectorCoordinate(markerNumbers=joint))
    message = "solverType = RK44: explicit solvers ignore constraints, and this model has 1"
    with pytest.raises(ValueError, match=message):
        solve_dynamic(mbs, settings(), SOLVERS.RK44)
    solve_dynamic(mbs, settings(), SOLVERS.GeneralizedAlpha)
    assert coordinates(mbs, disc)[1] == pytest.approx([0.0, 0.0, 0.1])


def test_an_infinite_state_or_a_diverging_step_ends_the_run_with_its_time():
    mbs, disc = clutch()
    add_coordinate_force(mbs, disc, lambda t, u: math.nan if t > 0.503 else u)
    mbs.Assemble()
    assert mbs.SolveDynamic(settings(SOLVERS.RK44, 0.25))  # Exudyn itself reports no problem
    told = r"RK44 failed 0\.255 s after the start: the state is not finite any more"
    with pytest.raises(SimulationError, match=told):
        solve_dynamic(mbs, settings(SOLVERS.RK44, 0.25, 1.25, 200))
    with pytest.raises(
        SimulationError,
        match=r"GeneralizedAlpha failed 0\.5 s after the start: .*Newton.*, or TrapezoidalIndex2$",
    ):
        solve_dynamic(mbs, settings(), SOLVERS.GeneralizedAlpha)


def test_a_body_without_mass_is_reported():
    mbs = new_model()
    node = rotor(mbs, 0.0, 1.0)
    add_coordinate_force(mbs, node, lambda t, u: 0.0)
    for solver in (SOLVERS.RK44, SOLVERS.GeneralizedAlpha):
        told = f"{solver.name} failed 0 s after the start: the mass matrix is singular: coordinate 0 of node 0 has"
        with pytest.raises(SimulationError, match=told):
            solve_dynamic(mbs, settings(), solver)
    planar_body(mbs, 1.0, 0.0, [0.0] * 3, [0.0] * 3)
    told = "coordinate 0 of node 0, coordinate 2 of node 2 has neither mass nor inertia"
    with pytest.raises(SimulationError, match=told):
        solve_dynamic(mbs, settings(), SOLVERS.RK44)


def test_an_error_of_a_load_arrives_with_its_text_and_its_cause_and_an_interrupt_as_itself():
    def interrupted(time):
        raise KeyboardInterrupt

    message = r"normal_load\(time = 0\.\d* s\) = -\S* N: it must be"
    with pytest.raises(exu.ExudynError, match=message) as raised:
        solve_dynamic(clutch(lambda time: 0.5 - time)[0], settings())
    assert isinstance(raised.value.__cause__, ValueError)
    with pytest.raises(KeyboardInterrupt):
        solve_dynamic(clutch(interrupted)[0], settings())


@pytest.mark.parametrize("stops", [False, True])
def test_the_models_own_function_after_a_step_is_called_and_kept(stops):
    mbs, _ = clutch()
    mbs.Assemble()
    seen = []

    def own(mbs, t):
        seen.append(t)
        return not (stops and t > 0.495)

    mbs.SetPostStepUserFunction(own)
    solve_dynamic(mbs, settings())
    assert len(seen) == (51 if stops else 101)  # including the start
    assert mbs.GetPostStepUserFunction()["function"] is own


def test_a_solver_that_would_need_too_many_steps_gives_up():
    mbs = new_model()
    wheel = rotor(mbs, 1.0, 1.0)
    mbs.AddObject(
        items.ObjectConnectorCoordinateSpringDamper(
            markerNumbers=[coordinate(mbs, None), coordinate(mbs, wheel)], damping=1e6
        )
    )
    drive(mbs, wheel, lambda t: 1e3 * math.cos(t))
    with pytest.raises(
        SimulationError, match=r"failed .* s after the start: more than 20,000,000 further steps are needed"
    ):
        solve_dynamic(mbs, settings_of(1e3, 100), SOLVERS.DOPRI5)
