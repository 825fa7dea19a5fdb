import functools
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import exudyn_models
import reference_model
from compare.claims.claim import Verdict
from compare.claims.error_estimates import extrapolated_order, observed_exponent
from compare.claims.paper_parameters import FIG5, FIG5_STARTS
from compare.engines import Engine, engines
from compare.figures import paper_style, saved
from compare.studies import STUDIES
from compare.studies.engines.engine_convergence.claims import (
    CREEP,
    FIRST_STICK,
    LATER,
    SCANS,
    SLIDES,
    SOLVERS,
    STATE,
    STICKS,
    STUDY,
    claim_of_creep,
    claim_of_sliding,
    claim_of_sticking,
    claims_of_regularisation,
    claims_of_steps,
    draw,
    measure,
    release_shift_by_creep,
)
from reference_model.motion.pin_equations import SlipMotion
from reference_model.trajectory import Solution, Trajectory

BOTH = ("reference", "exudyn")


@functools.cache
def findings(name):
    return measure(engines([name])[0])


def verdicts(claims):
    return {claim.sentence: claim.verdict for claim in claims}


@pytest.mark.parametrize("name", BOTH)
def test_every_order_is_the_declared_one(name):
    claims = findings(name).claims
    found = {claim.sentence: (claim.measured, claim.budget.total) for claim in claims}
    assert set(verdicts(claims).values()) == {Verdict.AGREES}, found


def test_study_is_part_of_the_report_and_has_claims_of_both_engines():
    assert STUDY in STUDIES
    assert set(verdicts(findings("reference").claims)) == {SLIDES, STICKS}
    assert set(verdicts(findings("exudyn").claims)) > {SLIDES, STICKS, FIRST_STICK, LATER, STATE, CREEP}


@pytest.mark.parametrize("names", [BOTH, ("reference",), ("exudyn",), ()])
def test_figures_are_drawn_from_whatever_engines_have_finished(names):
    with paper_style():
        figures = draw({name: findings(name).data for name in names})
    assert set(figures) <= set(STUDY.figures)
    assert ("engine-convergence-orders" in figures) == ("exudyn" in names)
    if names == BOTH:
        assert all(png.startswith(b"\x89PNG") for _, png in map(saved, figures.values()))


# --- engines that are broken on purpose


def simulate_of(name):
    return engines([name])[0].simulate


@pytest.mark.parametrize("name", BOTH)
def test_an_engine_whose_error_stays_at_1e_7_differs(name):
    def offset(*arguments, **options):
        trajectory = simulate_of(name)(*arguments, **options)
        phases = tuple(
            replace(phase, start=phase.start + 1e-4, end=phase.end + 1e-4) for phase in trajectory.phases
        )
        return replace(trajectory, states=trajectory.states + 1e-7, phases=phases)

    engine = Engine(name, offset)
    for part in (claim_of_sliding, claim_of_sticking):
        (claim,), _ = part(engine, SCANS[name])
        assert claim.verdict is Verdict.DIFFERS, (claim.sentence, claim.measured, claim.budget.total)


@pytest.mark.parametrize("name", BOTH)
def test_an_engine_that_follows_the_root_of_the_tolerance_differs(name):
    def lazy(*arguments, tolerance):
        return simulate_of(name)(*arguments, tolerance=1e-3 * tolerance**0.5)

    for part in (claim_of_sliding, claim_of_sticking):
        (claim,), _ = part(Engine(name, lazy), SCANS[name])
        assert claim.verdict is Verdict.DIFFERS, (claim.sentence, claim.measured, claim.budget.total)
        assert claim.measured == pytest.approx(0.5, abs=0.15)


def test_an_engine_that_misses_a_stick_phase_differs():
    def forgetful(*arguments, **options):
        trajectory = reference_model.simulate(*arguments, **options)
        return replace(trajectory, phases=trajectory.phases[:1])

    (claim,), _ = claim_of_sticking(Engine("reference", forgetful), SCANS["reference"])
    assert claim.verdict is Verdict.DIFFERS
    assert np.isnan(claim.measured)


def euler(pin, start, times, *, integrator, step):
    """Explicit Euler, whatever name it is given."""
    x, y, vx, vy = start
    z, v = complex(x, y), complex(vx, vy)
    states = [start]
    inside = round((times[1] - times[0]) / step)
    for _ in times[1:]:
        for _ in range(inside):
            slip = v - 1j * pin.disc_speed * z
            force = (
                -pin.damping * v - pin.stiffness * (z - pin.offset) - pin.friction_force * slip / abs(slip)
            )
            z, v = z + step * v, v + step * force / pin.mass
        states.append((z.real, z.imag, v.real, v.imag))
    return Trajectory(pin, times.copy(), np.array(states), (), Solution("Euler", np.nan, 0, 0, 0.0))


def test_an_integrator_of_first_order_differs_under_every_name():
    claims, _ = claims_of_steps(euler)
    assert [claim.verdict for claim in claims] == [Verdict.DIFFERS] * len(SOLVERS)
    assert claims[0].measured == pytest.approx(1.0, abs=0.2)


def test_an_integrator_of_second_order_differs_under_the_names_of_higher_order_only():
    def second_order(*arguments, integrator, step):
        return exudyn_models.simulate_fixed_step(*arguments, integrator="TrapezoidalIndex2", step=step)

    claims, _ = claims_of_steps(second_order)
    for claim, solver in zip(claims, SOLVERS, strict=True):
        assert (claim.verdict is Verdict.DIFFERS) == (solver.order != 2)


def test_a_regularisation_of_half_order_differs():
    def half(*arguments, tolerance, regularisation):
        epsilon = 1e-2 * regularisation**0.5
        return exudyn_models.simulate(*arguments, tolerance=tolerance, regularisation=epsilon)

    assert verdicts(claims_of_regularisation(half)[0]) == dict.fromkeys(
        (FIRST_STICK, LATER, STATE), Verdict.DIFFERS
    )


@pytest.mark.parametrize("factor", [10.0, 2.0, 0.5])
def test_a_regularisation_of_the_wrong_width_differs(factor):
    def wide(*arguments, regularisation, **options):
        return exudyn_models.simulate_fixed_step(
            *arguments, regularisation=factor * regularisation, **options
        )

    (claim,), _ = claim_of_creep(wide)
    assert claim.verdict is Verdict.DIFFERS, (claim.measured, claim.budget.total)


# --- the means of measurement


def test_creep_shifts_a_release_as_an_integration_of_the_creep_says():
    epsilon = 1e-6
    for start in FIG5_STARTS.values():
        stick = reference_model.simulate(FIG5, start, [0.0, 8.0], tolerance=1e-12).stick_phases[0]
        motion = SlipMotion.of(FIG5)

        def creep(_, z, motion=motion):
            z = complex(*z)
            v = 1j * motion.disc_speed * z + epsilon * motion.pull(z, 0j) / motion.friction
            return [v.real, v.imag]

        def excess(_, z, motion=motion):
            return abs(motion.pull(complex(*z), 0j)) - motion.friction

        excess.terminal = True
        run = solve_ivp(
            creep,
            (stick.start, stick.end + 1.0),
            stick.initial_state[:2],
            method="DOP853",
            events=excess,
            rtol=1e-13,
            atol=1e-14,
        )
        shift = (run.t_events[0][0] - stick.end) / epsilon
        assert release_shift_by_creep(FIG5, stick) == pytest.approx(shift, rel=1e-4)


def test_exponent_of_a_power_with_a_next_term_is_found():
    x = np.geomspace(1e-1, 1e-4, 16)
    exponent, numerical, model = observed_exponent(x, 3.0 * x**1.5 * np.exp(0.4 * x**0.25), next_term=0.25)
    assert exponent == pytest.approx(1.5, abs=1e-9)
    assert numerical < 1e-9
    assert 0.001 < model < 0.1


def test_scatter_widens_the_budget_of_an_exponent():
    random = np.random.default_rng(1)
    x = np.geomspace(1e-1, 1e-7, 25)
    inside = 0
    for _ in range(200):
        errors = x * np.exp(0.2 * random.standard_normal(25))
        exponent, numerical, _ = observed_exponent(x, errors, next_term=0.125)
        inside += abs(exponent - 1.0) <= numerical
    assert 0.9 <= inside / 200 <= 0.99


def test_order_is_extrapolated_to_small_steps():
    h = 0.5 ** np.arange(2, 8)
    order, numerical, model = extrapolated_order(h**4 * (1.0 + h), 0.0)
    assert order == pytest.approx(4.0, abs=1e-3)
    assert abs(order - 4.0) <= numerical + model < 0.05


@pytest.mark.parametrize("bad", [np.nan, np.inf, 0.0])
def test_without_numbers_there_is_no_order(bad):
    errors = np.array([1e-2, 1e-3, bad, 1e-5, 1e-6])
    assert np.isnan(observed_exponent(errors, errors, next_term=1.0)[0])
    assert np.isnan(extrapolated_order(errors, 0.0)[0])
