"""The study of convergence: engines whose errors do not fall as declared differ, and its means of measurement."""

from dataclasses import replace

import numpy as np
import pytest
from faults.reference import simulate
from scipy.integrate import solve_ivp
from study_harness import BLIND, LEFT_OUT, SEES, StudyTests, engine_named

import exudyn_models
from compare.claims.error_estimates import extrapolated_order, observed_exponent
from compare.claims.parameters import FIG5, FIG5_STARTS
from compare.engines import Engine
from compare.studies import STUDIES
from compare.studies.engines.engine_convergence.study import STUDY
from compare.studies.engines.engine_convergence.theory import SOLVERS, release_shift_by_creep
from reference_model.motion.pin_equations import SlipMotion
from reference_model.trajectory import Solution, Trajectory

BOTH = ("exudyn", "reference")


# --- engines and solvers that are broken on purpose


def staying_at_1e_7(name):
    """Return an engine whose error does not fall below 1e-7, nor that of its events below 1e-4 s."""

    def offset(*arguments, **options):
        trajectory = engine_named(name).simulate(*arguments, **options)
        phases = tuple(
            replace(phase, start=phase.start + 1e-4, end=min(phase.end + 1e-4, trajectory.times[-1]))
            for phase in trajectory.phases
        )
        return replace(trajectory, states=trajectory.states + 1e-7, phases=phases)

    return Engine(name, offset)


def lazy(name):
    """Return an engine that follows the root of the tolerance."""

    def simulated(*arguments, tolerance):
        return engine_named(name).simulate(*arguments, tolerance=1e-3 * tolerance**0.5)

    return Engine(name, simulated)


def forgetful(*arguments, **options):
    """Miss a stick phase."""
    trajectory = simulate(*arguments, **options)
    return replace(trajectory, phases=trajectory.phases[:1])


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


fixed_step, smoothed = exudyn_models.simulate_fixed_step, exudyn_models.simulate


def trapezoidal(*arguments, integrator, step):
    """An integrator of second order, whatever name it is given."""
    return fixed_step(*arguments, integrator="TrapezoidalIndex2", step=step)


def half_order(*arguments, tolerance, regularisation):
    """Smooth friction with an ε that falls like the root of what is asked for."""
    return smoothed(*arguments, tolerance=tolerance, regularisation=1e-2 * regularisation**0.5)


def of_width(factor):
    """Return a solver that smooths friction with another ε than it is asked for."""

    def wide(*arguments, regularisation, **options):
        return fixed_step(*arguments, regularisation=factor * regularisation, **options)

    return wide


SOLVERS_SEEN = {solver.name: SEES if solver.order != 2 else BLIND for solver in SOLVERS}


class TestEngineConvergence(StudyTests):
    study = STUDY
    sound = BOTH
    not_claimed = {"reference": ("steps", "first_stick", "later_events", "state", "creep")}
    few_of_faults = {claim: {"with_work": False} for claim in ("sliding", "sticking", "steps")}
    faults = (
        {f"{name} stays at 1e-7": staying_at_1e_7(name) for name in BOTH}
        | {f"{name} follows the root of the tolerance": lazy(name) for name in BOTH}
        | {
            "misses a stick phase": Engine("reference", forgetful),
            "first order": ("simulate_fixed_step", euler),
            "second order": ("simulate_fixed_step", trapezoidal),
            "ε of half order": ("simulate", half_order),
        }
        | {
            f"ε {factor:g} times as wide": ("simulate_fixed_step", of_width(factor))
            for factor in (10, 2, 0.5)
        }
    )
    columns = (
        "sliding",
        "sticking",
        *(f"steps/{name}" for name in SOLVERS_SEEN),
        "first_stick",
        "later_events",
        "state",
        "creep",
    )
    both, steps, last = (SEES, SEES), (LEFT_OUT,) * 4, (LEFT_OUT,) * 4
    table = {
        "reference stays at 1e-7": (*both, *steps, *last),
        "exudyn stays at 1e-7": (*both, *steps, *last),
        "reference follows the root of the tolerance": (*both, *steps, *last),
        "exudyn follows the root of the tolerance": (*both, *steps, *last),
        "misses a stick phase": (LEFT_OUT, SEES, *steps, *last),
        "first order": (LEFT_OUT, LEFT_OUT, *[SEES] * 4, *last),
        # It is what two of the solvers declare.
        "second order": (LEFT_OUT, LEFT_OUT, *SOLVERS_SEEN.values(), *last),
        "ε of half order": (LEFT_OUT, LEFT_OUT, *steps, SEES, SEES, SEES, LEFT_OUT),
        "ε 10 times as wide": (LEFT_OUT, LEFT_OUT, *steps, LEFT_OUT, LEFT_OUT, LEFT_OUT, SEES),
        "ε 2 times as wide": (LEFT_OUT, LEFT_OUT, *steps, LEFT_OUT, LEFT_OUT, LEFT_OUT, SEES),
        "ε 0.5 times as wide": (LEFT_OUT, LEFT_OUT, *steps, LEFT_OUT, LEFT_OUT, LEFT_OUT, SEES),
    }

    @classmethod
    def measured_with(cls, fault, few, only):
        """Measure with a wrong engine, or with a wrong function of Exudyn's models."""
        wrong = cls.faults[fault]
        if isinstance(wrong, Engine):
            return cls.study.measure(wrong, few, only)
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(exudyn_models, *wrong)
            return cls.study.measure(engine_named("exudyn"), few, only)

    def test_study_is_part_of_the_report(self):
        assert STUDY in STUDIES

    @pytest.mark.parametrize("names", [BOTH, ("reference",), ("exudyn",), ()])
    def test_figures_are_drawn_from_whatever_engines_have_finished(self, names):
        figures = STUDY.draw({name: self.found(name).data for name in names})
        assert set(figures) <= set(STUDY.figures)
        assert ("engine-convergence-orders" in figures) == ("exudyn" in names)

    @pytest.mark.parametrize("name", BOTH)
    @pytest.mark.parametrize("claim", ["sliding", "sticking"])
    def test_the_root_of_the_tolerance_has_half_the_exponent(self, name, claim):
        (found,) = self.claims_of_fault(f"{name} follows the root of the tolerance", claim)
        assert found.measured == pytest.approx(0.5, abs=0.15)

    def test_an_engine_that_misses_a_stick_phase_has_no_exponent(self):
        (found,) = self.claims_of_fault("misses a stick phase", "sticking")
        assert np.isnan(found.measured)

    def test_the_first_order_is_seen_as_what_it_is(self):
        (found,) = self.claims_of_fault("first order", "steps/RK44")
        assert found.measured == pytest.approx(1.0, abs=0.2)


# --- the means of measurement


def test_creep_shifts_a_release_as_an_integration_of_the_creep_says():
    epsilon = 1e-6
    for start in FIG5_STARTS.values():
        stick = simulate(FIG5, start, [0.0, 8.0], tolerance=1e-12).stick_phases[0]
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
