"""Motions of the pin, the ring and six points: slip to the tolerance, stick to first order in ε, and limiting
cases."""

from dataclasses import replace

import exudyn as exu
import numpy as np
import pytest
from plain_slip import slide
from scipy.linalg import expm

import reference_model
from compare.claims.parameters import FIG11
from exudyn_models import add_ring_friction, simulate, simulate_fixed_step, simulate_with_native_contact
from exudyn_models.paper.alternating_solvers import Friction
from exudyn_models.paper.creep import RegularisedContact
from reference_model import SimulationError
from reference_model.systems import PinOnDisc

PIN = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=1.5, offset=0.1)
STUCK = replace(FIG11, polar_inertia=0.0072, damping=0.1, friction_force=0.09, offset=0.1)
SLIPPING = {
    "pin": (PIN, [1.3, 0.0, 0.0, -1.3]),
    "ring": (FIG11, [0.05, 0.0, 0.4, 0.0, 0.05, 1.3]),
    "off the axis": (replace(FIG11, offset=0.1), [0.05, 0.0, 0.4, 0.0, 0.05, 1.3]),
    "points": (replace(FIG11, contact_points=6), [0.05, 0.0, 0.4, 0.0, 0.05, 1.3]),
}
"""Systems and starts that never come to rest."""
STICKING = {
    "pin": (PIN, [0.1, 0.0, 0.03, 0.0]),  # Fig. 5, second start
    "ring": (STUCK, [0.1, 0.0, 0.0, 0.03, 0.0, 1.2]),
    "three points": (replace(STUCK, contact_points=3), [0.1, 0.0, 0.0, 0.03, 0.0, 1.2]),
    "six points": (replace(STUCK, contact_points=6), [0.1, 0.0, 0.0, 0.03, 0.0, 1.2]),
}
FREE = {"stiffness": 0.0, "damping": 0.0, "shaft_damping": 0.0, "disc_speed": 0.0, "shaft_speed": 0.0}
TABLE = replace(FIG11, polar_inertia=0.0144, friction_force=0.09, **FREE)  # a ring of J = mR² on a table
THROWN = [0.0, 0.0, 0.3, 0.3, 0.1, 2.0]
SLIPS = pytest.mark.parametrize("name", SLIPPING)
SOLVERS = pytest.mark.parametrize("solver", ["explicit", "implicit"])


def kinds(trajectory):
    return [phase.kind for phase in trajectory.phases]


def largest(difference):
    return np.abs(difference).max()


@SLIPS
def test_errors_while_slipping_fall_with_the_tolerance_at_every_output_time(name):
    """Compare with an integrator independent of Exudyn."""
    (system, start), times = SLIPPING[name], np.linspace(0.0, 20.0, 41)
    expected = slide(system, start, times).y.T
    found = [simulate(system, start, times, tolerance=tolerance) for tolerance in (1e-5, 1e-7, 1e-9)]
    assert all(kinds(run) == ["slip"] for run in found)
    errors = [largest(run.states - expected) for run in found]
    assert np.all(np.diff(errors) < 0.0), errors
    assert errors[-1] < 5e-9


@SLIPS
def test_the_implicit_solver_has_an_error_of_first_order_in_the_tolerance(name):
    (system, start), times = SLIPPING[name], np.linspace(0.0, 5.0, 11)
    expected = slide(system, start, times).y.T
    errors = [
        largest(simulate(system, start, times, tolerance=tolerance, solver="implicit").states - expected)
        for tolerance in (1e-6, 1e-8)
    ]
    assert np.log10(errors[0] / errors[1]) / 2.0 == pytest.approx(1.0, abs=0.15), errors
    assert errors[1] < 1e-4


@pytest.mark.parametrize(
    ("integrator", "order", "step"),
    [("RK44", 4, 0.1), ("RK67", 6, 0.2), ("GeneralizedAlpha", 2, 0.1), ("TrapezoidalIndex2", 2, 0.1)],
)
def test_integrators_converge_at_their_order(integrator, order, step):
    """A study measures the orders for a pin."""
    system, start = SLIPPING["points"][0], [0.6, 0.0, 0.4, 0.0, 0.6, 1.3]  # so fast that friction is smooth
    times = [0.0, 3.0]
    expected = slide(system, start, times).y[:, -1]
    errors = [
        largest(simulate_fixed_step(system, start, times, integrator=integrator, step=h).at_end - expected)
        for h in (step, step / 2.0)
    ]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(order, abs=0.3), errors


@pytest.mark.parametrize("name", ["pin", "points"])
def test_errors_of_the_built_in_contact_are_below_the_tolerance_and_of_first_order(name):
    (system, start), times = SLIPPING[name], [0.0, 40.0]
    expected = slide(system, start, times).y[:, -1]
    tolerances = 1e-6, 1e-7, 1e-8
    found = [simulate_with_native_contact(system, start, times, tolerance=one) for one in tolerances]
    errors = [largest(run.at_end - expected) for run in found]
    assert np.all(np.less(errors, tolerances)), errors
    assert np.polyfit(np.log(tolerances), np.log(errors), 1)[0] == pytest.approx(1.0, abs=0.1), errors
    assert found[0].solution.method == "Exudyn DOPRI5, generalised-α while sticking, built-in contact"


@pytest.mark.parametrize(
    ("name", "engine"), [*((name, simulate) for name in STICKING), ("pin", simulate_with_native_contact)]
)
def test_stick_phases_have_errors_of_first_order_in_the_regularisation(name, engine):
    (system, start), end = STICKING[name], {"pin": 24.0, "three points": 6.0}.get(name, 12.0)
    exact = reference_model.simulate(system, start, [0.0, end], tolerance=1e-11)
    expected = [kind for kind in kinds(exact) if kind != "pivot"]  # pivots at each release are short
    errors = []
    for tolerance in (1e-7, 1e-8):  # ε is 100 tolerances in units of the motion
        found = engine(system, start, [0.0, end], tolerance=tolerance)
        assert [kind for kind in kinds(found) if kind != "pivot"] == expected
        errors.append([*np.abs(found.stick_times - exact.stick_times), largest(found.at_end - exact.at_end)])
        # Phases follow each other without gaps, and a sticking body moves with the master.
        assert [phase.end for phase in found.phases] == [*[phase.start for phase in found.phases[1:]], end]
    errors = np.array(errors)
    # The first rest without a pivot precedes any creep; later times contain the error of earlier creep.
    if exact.phases[1].kind == "stick":
        assert errors[-1, 0] < 1e-8
        errors = errors[:, 1:]
    np.testing.assert_allclose(np.log10(errors[0] / errors[1]), 1.0, atol=0.1, err_msg=str(errors))
    assert errors[-1].max() < 2e-5


@pytest.mark.parametrize("name", ["pin", "six points"])
def test_the_implicit_solver_passes_through_sticking(name):
    system, start = STICKING[name]
    found = simulate(system, start, [0.0, 12.0], tolerance=1e-7, solver="implicit")
    exact = reference_model.simulate(system, start, [0.0, 12.0], tolerance=1e-9)
    assert len(found.stick_phases) == 2
    np.testing.assert_allclose(found.stick_times, exact.stick_times, rtol=0.0, atol=1e-3)


@pytest.mark.parametrize("change", [{}, {"damping": 0.2}, {"contact_points": 6, "stiffness": 1.0}])
def test_a_body_thrown_on_a_resting_table_comes_to_permanent_rest_and_never_gains_energy(change):
    ring = replace(TABLE, friction_force=0.3, **change)
    found = simulate(ring, THROWN, np.linspace(0.0, 6.0, 601))
    x, y, _, vx, vy, spin = found.states.T
    energy = 0.5 * ring.mass * (vx**2 + vy**2) + 0.5 * ring.polar_inertia * spin**2
    energy += 0.5 * ring.stiffness * (x**2 + y**2)
    assert np.all(np.diff(energy) <= 1e-12)
    assert found.phases[-1].kind == "stick"
    assert abs(found.at_end[5]) * ring.contact_radius < found.solution.regularisation


def test_a_long_pivot_has_errors_of_first_order_in_the_regularisation():
    # Fig. 11's disc on six points, near the centre of its modulated motion.
    disc, start = replace(FIG11, contact_points=6), [0.01, 0.0, 0.0, 0.0, 0.01, 1.45]
    exact = reference_model.simulate(disc, start, [0.0, 20.0], tolerance=1e-11)
    assert kinds(exact) == ["slip", "pivot", "slip"]
    errors = []
    for tolerance in (1e-7, 1e-8):
        found = simulate(disc, start, [0.0, 20.0], tolerance=tolerance)
        assert kinds(found) == kinds(exact)
        errors.append(largest(found.at_end - exact.at_end))
    assert np.log10(errors[0] / errors[1]) == pytest.approx(1.0, abs=0.1), errors
    assert errors[-1] < 2e-6


@pytest.mark.parametrize("change", [{}, FREE])
@pytest.mark.parametrize("name", ["pin", "ring"])
@SOLVERS
def test_without_friction_centre_and_spin_decay_freely_in_closed_form(name, change, solver):
    system, start = SLIPPING[name]
    known = {key: value for key, value in change.items() if hasattr(system, key)}
    system, times = replace(system, friction_force=0.0, **known), np.linspace(0.0, 5.0, 11)
    found, accuracy = simulate(system, start, times, solver=solver), 1e-10 if solver == "explicit" else 1e-5
    stiffness, damping = system.stiffness / system.mass, system.damping / system.mass
    matrix = np.block([[np.zeros((2, 2)), np.eye(2)], [-stiffness * np.eye(2), -damping * np.eye(2)]])
    rest = np.array([system.offset, 0.0, 0.0, 0.0])  # without a spring the offset has no effect
    plane = [0, 1, 2, 3] if name == "pin" else [0, 1, 3, 4]
    centre = [rest + expm(matrix * t) @ (np.array(start)[plane] - rest) for t in times]
    np.testing.assert_allclose(found.states[:, plane], centre, rtol=0.0, atol=accuracy)
    if name != "pin":
        rate = system.shaft_damping / system.polar_inertia
        aim = system.shaft_speed if rate > 0.0 else 0.0
        spin = aim + (start[5] - aim) * np.exp(-rate * times)
        np.testing.assert_allclose(found.states[:, 5], spin, rtol=0.0, atol=accuracy)
    assert kinds(found) == ["slip"]


@pytest.mark.parametrize("name", ["pin", "six points"])
def test_a_mirrored_or_turned_motion_is_otherwise_the_same(name):
    (system, start), delays = STICKING[name], np.linspace(0.0, 6.0, 13)
    expected = simulate(system, start, delays, tolerance=1e-8)
    mirror = np.array([1.0, -1.0, 1.0, -1.0] if name == "pin" else [1.0, -1.0, -1.0, 1.0, -1.0, -1.0])
    other = replace(system, disc_speed=-system.disc_speed)
    if name != "pin":
        other = replace(other, shaft_speed=-system.shaft_speed)
    mirrored = simulate(other, mirror * start, delays, tolerance=1e-8)
    np.testing.assert_allclose(mirrored.states, expected.states * mirror, rtol=0.0, atol=1e-8)
    assert kinds(mirrored) == kinds(expected)
    points = getattr(system, "contact_points", None)
    if points is not None:  # another point is at the position of the first
        turn = 2.0 * np.pi / points * np.eye(6)[2]
        turned = simulate(system, start + turn, delays, tolerance=1e-8)
        np.testing.assert_allclose(turned.states, expected.states + turn, rtol=0.0, atol=1e-8)


@pytest.mark.parametrize(("engine", "first"), [(simulate, 1e6), (simulate_with_native_contact, -5.0)])
def test_the_clock_at_the_start_does_not_matter(engine, first):
    (disc, start), delays = STICKING["six points"], np.linspace(0.0, 3.0, 7)
    moved, expected = engine(disc, start, first + delays), engine(disc, start, delays)
    # At a time of 1e6 s, one second has a rounding error of 1e-10.
    assert moved.states == pytest.approx(expected.states, abs=1e-9)
    assert kinds(moved) == kinds(expected)
    ends, expected_ends = (
        np.array([(one.start, one.end) for one in run.phases]) for run in (moved, expected)
    )
    assert (ends[0, 0], ends[-1, 1]) == (first, first + 3.0)
    assert ends - first == pytest.approx(expected_ends, abs=1e-9)


def test_a_coordinate_that_passes_minus_one_does_not_stop_the_solver():
    """Exudyn's error weight, absolute + relative·y, is zero at y = −1 if both tolerances are equal."""
    pin = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.12, disc_speed=1.5)
    start = [1.0, 0.0, 0.0, 1.0]  # inside the whirl of radius 1.2, so x and y pass −1 in every turn
    exact = reference_model.simulate(pin, start, [0.0, 50.0], tolerance=1e-13).at_end
    for tolerance in (1e-10, 1e-12):
        assert simulate(pin, start, [0.0, 50.0], tolerance=tolerance).at_end == pytest.approx(exact, abs=1e-9)


@pytest.mark.parametrize("engine", [simulate, simulate_with_native_contact])
def test_a_pin_that_starts_in_stick_stays_there_until_its_release(engine):
    start = [-0.053, -0.015, 0.0225, -0.0795]  # a change of units and back would round it
    exact, found = (
        simulator(PIN, start, [0.0, 1e-3, 3.0]) for simulator in (reference_model.simulate, engine)
    )
    assert kinds(found) == kinds(exact)
    assert found.phases[0].kind == "stick"
    assert found.phases[0].end == pytest.approx(exact.phases[0].end, abs=1e-6)
    np.testing.assert_allclose(found.states[1], exact.states[1], atol=found.solution.regularisation)
    once = engine(PIN, start, [2.0])
    np.testing.assert_array_equal(once.states, [start])
    assert [(phase.start, phase.end) for phase in once.phases] == [(2.0, 2.0)]


def test_sticking_with_nearly_all_of_the_friction_needs_few_steps():
    # Held permanently with 0.92 μN: the exact pin does not move, and the creep is 0.92 ε·t.
    pin = replace(PIN, disc_speed=0.0, friction_force=1.0)
    found = simulate(pin, [1.02, 0.0, 0.0, 0.0], [0.0, 30.0])
    assert kinds(found) == ["stick"]
    assert found.solution.steps < 10_000
    assert found.at_end[0] == pytest.approx(1.02 - 0.92 * 30.0 * found.solution.regularisation, abs=1e-7)


def test_states_do_not_depend_on_other_requested_times_and_are_as_accurate_as_at_a_step():
    system, start = STICKING["pin"]
    coarse, fine = (simulate(system, start, np.linspace(0.0, 12.0, count)) for count in (13, 1201))
    np.testing.assert_array_equal(fine.states[::100], coarse.states)
    assert fine.solution.evaluations == coarse.solution.evaluations
    apart = np.array([simulate(system, start, [0.0, t]).at_end for t in (2, 4, 6, 8)])
    np.testing.assert_allclose(coarse.states[[2, 4]], apart[:2], rtol=0.0, atol=1e-11)
    # Steps in stick divide the remaining time, which changes the result by a few per cent of ε.
    np.testing.assert_allclose(coarse.states[[6, 8]], apart[2:], rtol=0.0, atol=5e-9)
    times = [0.0, 0.05, 0.1, 0.15, 0.2]
    system, start = SLIPPING["pin"]
    found = simulate_fixed_step(system, start, times, integrator="RK67", step=0.1).states
    np.testing.assert_allclose(found, slide(system, start, times).y.T, rtol=0.0, atol=1e-7)


def friction_with(change):
    """Return friction with ``change`` applied to its force function."""

    def add(mbs, *nodes, **contact):
        connector = add_ring_friction(mbs, *nodes, **contact)
        force = mbs.GetObject(connector.item)["forceUserFunction"]["function"]
        mbs.SetObjectParameter(connector.item, "forceUserFunction", change(force))
        return connector

    return Friction(add, RegularisedContact.creeping)


@SOLVERS
def test_the_number_of_evaluations_is_correct(solver):
    calls = []

    def counted(force):
        return lambda *arguments: calls.append(1) or force(*arguments)

    friction = friction_with(counted)
    found = simulate(*STICKING["pin"], [0.0, 12.0], tolerance=1e-7, solver=solver, friction=friction)
    assert found.solution.evaluations == pytest.approx(len(calls), rel=0.01)


@SOLVERS
def test_a_force_of_nan_raises_an_error_with_its_time(solver):
    def broken(force):
        return lambda mbs, t, item, q, q_t: force(mbs, t, item, q, q_t) if q[1] > 0.0 else [float("nan")] * 4

    exact = slide(*STICKING["pin"], np.linspace(0.0, 4.0, 4001)).y
    crossing = np.argmax(exact[0] < 0.0) * 1e-3
    with pytest.raises(
        SimulationError, match=r"failed (\d+\.?\d*) s after the start: .*; use a smaller"
    ) as told:
        simulate(*STICKING["pin"], [0.0, 10.0], solver=solver, friction=friction_with(broken))
    time = float(str(told.value).split("failed ")[1].split(" s")[0])
    assert time == pytest.approx(crossing, abs=0.1)


@pytest.mark.parametrize(
    ("solver", "raised", "seen"),
    [("explicit", KeyboardInterrupt, KeyboardInterrupt), ("implicit", ZeroDivisionError, SimulationError)],
)
def test_an_error_inside_a_run_is_raised(solver, raised, seen):
    def interrupted(force):
        def function(*arguments):
            raise raised

        return function

    with pytest.raises(seen):
        simulate(*STICKING["pin"], [0.0, 10.0], solver=solver, friction=friction_with(interrupted))


def test_nothing_is_printed_and_no_file_is_written_nor_infinity_returned(tmp_path, monkeypatch, capfd):
    """RK44 is unstable for steps above 2.8·mε/μN, and diverges with a stiff spring."""
    monkeypatch.chdir(tmp_path)
    exu.config.printToConsole = True
    for solver in ("explicit", "implicit"):
        simulate(*STICKING["pin"], [0.0, 12.0], tolerance=1e-7, solver=solver)
    with pytest.raises(SimulationError, match="not finite"):
        simulate_fixed_step(replace(PIN, stiffness=1e6), [0.1, 0.0, 0.0, 0.0], [0.0, 100.0], step=0.1)
    printed = "".join(capfd.readouterr()).splitlines()
    assert [line for line in printed if not line.startswith("Compiling for this machine")] == []
    assert list(tmp_path.iterdir()) == []
