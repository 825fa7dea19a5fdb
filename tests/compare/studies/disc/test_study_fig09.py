"""The study of Figs. 9 and 10: what its claims see, and where its motions end."""

from dataclasses import replace

import numpy as np
import pytest
from faults.reference import simulate
from studies_under_test import altered
from study_harness import BLIND, LEFT_OUT, SEES, StudyTests, engine_named

from compare.claims.claim import Verdict
from compare.engines import Engine
from compare.studies.disc.fig09 import STUDY, of_theory, theory
from compare.studies.disc.fig09.theory import LARGEST_LOAD, OFFSETS, RING
from compare.studies.toolkit.steady_motion import last_load
from reference_model.contact.contact_law import Ring, Shares, Slopes
from reference_model.formulas.disc import pin_of, whirl_at
from reference_model.formulas.pin import first_order_whirl_shift


class OtherMoment(Ring):
    """A ring whose moment is 1 % too large."""

    def shares(self, slip_speed, relative_spin):
        resistance, moment = super().shares(slip_speed, relative_spin)
        return Shares(resistance, 1.01 * moment)

    def slopes(self, slip_speed, relative_spin):
        f_u, f_s, m_u, m_s = super().slopes(slip_speed, relative_spin)
        return Slopes(f_u, f_s, 1.01 * m_u, 1.01 * m_s)


def other_moment(system, state, times, *, tolerance=1e-9):
    return simulate(system, state, times, tolerance=tolerance, contact=OtherMoment(system.contact_radius))


def five_points(system, state, times, *, tolerance=1e-9):
    return simulate(replace(system, contact_points=5), state, times, tolerance=tolerance)


QUICK = (
    "orbits",
    "rests",
    "deviations_grow",
    "sticks",
    "releases",
    "coexist",
    "six_rests",
    "six_releases",
)


class TestFig09(StudyTests):
    study = STUDY
    sound = ("reference",)
    few = {
        "orbits": {"whirls": ((0.0015, 0), (0.0015, 1))},
        "rests": {"loads": (0.05,)},
        "sticks": {"loads": (0.2,)},
        "releases": {"loads": (0.2,)},
        "six_circles": {"circles": ((3e-4, 1), (2e-3, 0))},
        "six_rests": {"loads": (0.05,)},
        "six_releases": {"loads": (0.2,)},
        "curves": {"offsets": tuple(OFFSETS[::8]), "fold_offsets": (0.06, 0.15)},
    }
    faults = {
        "friction 0.1 % off": altered(friction_force=1.001),
        "damping 0.1 % off": altered(damping=1.001),
        "inertia 10 % off": altered(polar_inertia=1.1),
        "moment 1 % off": Engine("other moment", other_moment, ("ring",)),
        "five points for six": Engine("five points", five_points, ("points",)),
    }
    # The table turned: a row for each claim.
    by_claim = {
        # friction, damping, inertia, moment, five points
        "circles": (SEES, SEES, BLIND, SEES, LEFT_OUT),
        "error_of_23": (SEES, SEES, BLIND, SEES, LEFT_OUT),
        "limit_of_large_loads": (SEES, SEES, BLIND, SEES, LEFT_OUT),
        "orbits": (SEES, SEES, SEES, SEES, LEFT_OUT),
        # To first order the shift by the offset follows from damping alone.
        "offset_shifts": (BLIND, SEES, BLIND, BLIND, LEFT_OUT),
        "offset_changes_size": (SEES, SEES, BLIND, SEES, LEFT_OUT),
        # Neither damping nor inertia moves what rests.
        "rests": (SEES, BLIND, BLIND, SEES, LEFT_OUT),
        "deviations_grow": (SEES, SEES, SEES, SEES, LEFT_OUT),
        "whirl_attracts": (BLIND, SEES, BLIND, BLIND, LEFT_OUT),
        "sticks": (BLIND, BLIND, BLIND, BLIND, LEFT_OUT),
        "releases": (SEES, SEES, BLIND, SEES, LEFT_OUT),
        "coexist": (BLIND, BLIND, BLIND, BLIND, LEFT_OUT),
        "six_circles": (SEES, SEES, BLIND, LEFT_OUT, SEES),
        "six_rests": (SEES, BLIND, BLIND, LEFT_OUT, SEES),
        "six_releases": (SEES, SEES, SEES, LEFT_OUT, SEES),
    }
    columns = tuple(by_claim)
    table = dict(zip(faults, zip(*by_claim.values(), strict=True), strict=True))

    @pytest.mark.parametrize(
        ("name", "claim"),
        # How Exudyn's own contact sticks and lets go, test_native_contact asks at a tenth of the cost.
        [("exudyn", claim) for claim in QUICK] + [("exudyn-native", "six_rests")],
    )
    def test_the_quick_claims_hold_in_exudyn(self, name, claim):
        few = self.few | {"orbits": {"whirls": ((0.0015, 1),)}}
        (found,) = STUDY.measure(engine_named(name), few, only=(claim,)).claims
        assert found.verdict is Verdict.AGREES

    def test_a_disc_with_half_the_friction_does_not_stick_where_it_should(self):
        found = STUDY.measure(altered(friction_force=0.5), only=("sticks", "coexist")).claims
        assert [claim.verdict for claim in found] == [Verdict.DIFFERS] * 2

    def test_an_engine_of_points_only_measures_the_rows_of_six_points(self):
        found = STUDY.measure(replace(engine_named("reference"), name="points", kinds=("points",)), self.few)
        assert [claim.identity for claim in found.claims] == [
            "fig09/six-circles",
            "fig09/six-rests",
            "fig09/six-releases",
        ]
        assert "continuous ring" in found.not_simulated
        assert set(STUDY.draw({"points": found.data})) <= set(STUDY.figures)

    def test_the_spin_of_the_whirl_tends_to_a_limit_that_does_not_depend_on_the_load(self):
        far = [whirl_at(RING, alpha) for alpha in (1e-4, 1e-6)]
        assert far[1].load == pytest.approx(100.0 * far[0].load, rel=1e-6)
        # The next term of M : R²S/(2U) is of the order α².
        for whirl, alpha in zip(far, (1e-4, 1e-6), strict=True):
            assert whirl.spin == pytest.approx(theory.spin_of_large_whirl(RING), abs=alpha**2 + 1e-14)

    def test_the_shift_of_a_small_disc_is_that_of_a_pin(self):
        small = replace(RING, contact_radius=1e-5, shaft_damping=1e-9, damping=0.1, friction_force=0.12)
        shift = theory.first_order_shift(small)
        pin = first_order_whirl_shift(pin_of(small))
        assert [shift.real, shift.imag] == pytest.approx(pin, rel=1e-9)

    @pytest.mark.parametrize(("load", "stable"), [(0.02, True), (0.022, False), (0.1, False)])
    def test_the_equilibrium_is_stable_up_to_a_load_far_below_that_of_sticking(self, load, stable):
        assert theory.rest_of(load).stable is stable
        assert theory.last_stable_load(RING) < 0.25 * last_load(RING)

    @pytest.mark.parametrize(
        ("formula", "claim", "factor"),
        [
            ("weak_damping_load", "weak_damping", 1.1),
            ("last_stable_load", "merges", 1.001),
            ("smallest_load_with_whirl", "fold", 1.001),
        ],
    )
    def test_a_wrong_formula_is_seen(self, formula, claim, factor, monkeypatch):
        right = getattr(of_theory, formula)
        monkeypatch.setattr(of_theory, formula, lambda *which: factor * right(*which))
        (found,) = STUDY.measure_theory(only=(claim,)).claims
        assert found.verdict is Verdict.DIFFERS

    def test_the_curve_of_the_whirls_goes_from_the_largest_load_to_the_equilibrium(self):
        load, least, greatest, spin = self.found("theory").data["orbits"].T
        rest = theory.rest_of(load[-1])
        assert load[0] == pytest.approx(LARGEST_LOAD)
        assert load[-1] == pytest.approx(theory.last_stable_load(RING))
        assert least[-1] == pytest.approx(np.hypot(rest.x, rest.y))
        assert greatest[-1] == pytest.approx(least[-1])
        assert spin[-1] == pytest.approx(rest.spin)
        assert np.all(least <= greatest)
