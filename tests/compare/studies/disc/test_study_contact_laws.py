"""The study of the laws of contact agrees for every sound engine and law, and fails for each broken one."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from studies_under_test import sentences, verdicts

from compare.claims.claim import Verdict
from compare.engines import EVERY_KIND, Engine, engines
from compare.studies.disc.contact_laws import claims as study
from compare.studies.disc.contact_laws import theory as laws
from reference_model.contact.annulus import Annulus
from reference_model.contact.contact_law import Shares
from reference_model.contact.elliptic import mean_directions
from reference_model.trajectory import Phase, Solution, Trajectory

FEW = {"ratios": (0.3, 0.8, 1.25)}
ALL = set(study.SENTENCES.values())


def many_points(disc):
    """As many as make the ring: within U/W <= 0.8 their error is below 0.8^400."""
    return disc.contact_points or 400


def disc_engine(name, *, number=many_points, radius=1.0, moment=1.0, force=lambda f: f, kinds=EVERY_KIND):
    """An engine of (19) to (21) in real coordinates, with what a fault changes as its arguments."""

    def simulate(disc, initial_state, times, *, tolerance=1e-9):
        around = 2.0 * np.pi * np.arange(number(disc)) / number(disc)
        R, mu = radius * disc.contact_radius, disc.friction_force

        def rates(_, state):
            x, y, angle, vx, vy, spin = state
            s, c = np.sin(angle + around), np.cos(angle + around)
            rim = R * (disc.disc_speed - spin)
            ux, uy = vx + disc.disc_speed * y + rim * s, vy - disc.disc_speed * x - rim * c
            speed = np.hypot(ux, uy)
            fx, fy = force(np.array((np.mean(-ux / speed), np.mean(-uy / speed))))
            turning = moment * R * np.mean((ux * s - uy * c) / speed)
            return (
                vx, vy, spin,
                (mu * fx - disc.damping * vx - disc.stiffness * (x - disc.offset)) / disc.mass,
                (mu * fy - disc.damping * vy - disc.stiffness * y) / disc.mass,
                (mu * turning - disc.shaft_damping * (spin - disc.shaft_speed)) / disc.polar_inertia,
            )  # fmt: skip

        run = solve_ivp(
            rates,
            (times[0], times[-1]),
            initial_state,
            "DOP853",
            times,
            rtol=0.1 * max(tolerance, 3e-13),
            atol=1e-14,
        )
        phase = Phase("slip", float(times[0]), float(times[-1]), np.array(initial_state, dtype=float))
        solution = Solution("DOP853", tolerance, run.nfev, 0, 0.0)
        return Trajectory(disc, np.array(times), run.y.T.copy(), (phase,), solution)

    return Engine(name, simulate, kinds)


@pytest.mark.parametrize(
    "engine", [*engines(["reference", "exudyn"]), disc_engine("intact")], ids=lambda engine: engine.name
)
def test_every_statement_holds_in_a_sound_engine(engine):
    findings = study.measure(engine, **FEW)
    assert verdicts(findings) == dict.fromkeys(ALL, Verdict.AGREES)
    assert findings.not_simulated == ""


@pytest.mark.parametrize(
    ("fault", "seen"),
    [
        ({"number": lambda disc: 6}, {"ring"}),
        ({"number": lambda disc: 12}, {"ring", "points6"}),
        ({"number": lambda disc: 400}, {"points6"}),
        ({"radius": 1.0001}, {"ring", "points6"}),
        ({"moment": -1.0}, {"ring", "points6"}),
        ({"moment": 1.0001}, {"ring", "points6"}),
        ({"force": lambda f: f[::-1]}, {"ring", "points6"}),
        ({"force": lambda f: 1.0001 * f}, {"ring", "points6"}),
    ],
)
def test_a_broken_engine_is_found_out(fault, seen):
    findings = study.measure(disc_engine("broken", **fault), **FEW)
    assert sentences(findings, Verdict.DIFFERS) == {study.SENTENCES[name] for name in seen}


def test_what_an_engine_does_not_simulate_is_left_out_and_said():
    points_only = study.measure(disc_engine("discrete", kinds=("pin", "points")), **FEW)
    assert set(verdicts(points_only)) == {study.SENTENCES["points6"]}
    assert points_only.not_simulated == "discrete does not simulate a disc on a continuous ring"
    pin_only = study.measure(disc_engine("plain", kinds=("pin",)), **FEW)
    assert pin_only.claims == ()
    assert pin_only.not_simulated


@pytest.fixture(scope="module")
def theory():
    return laws.theory()


def test_the_theory_holds(theory):
    assert set(verdicts(theory).values()) == {Verdict.AGREES}
    assert len(verdicts(theory)) == len(theory.claims)


# ---------------------------------------------------------------- laws broken on purpose


def naive_directions(slip, rim):
    """The modulus 4UW/(U + W)² in double precision, which cancels at extreme ratios."""
    from scipy.special import ellipe, ellipk

    m = 4.0 * slip * rim / (slip + rim) ** 2
    even = (slip + rim) * ellipe(m)
    odd = (slip - rim) * ellipk(m) if slip != rim else 0.0
    return float(even + odd) / (math.pi * slip), float(even - odd) / (math.pi * rim)


@pytest.mark.parametrize(
    "broken",
    [
        naive_directions,
        lambda slip, rim: mean_directions(slip, rim)[::-1],
        lambda slip, rim: tuple(np.array(mean_directions(slip, rim)) * (1.0 + 1e-9)),
    ],
)
def test_a_wrong_closed_form_is_found_out(broken, monkeypatch):
    monkeypatch.setattr("reference_model.contact.contact_law.mean_directions", broken)
    assert laws.closed_form().verdict is Verdict.DIFFERS


def test_a_wrong_expansion_is_found_out(monkeypatch):
    def two_terms(self, slip_speed, relative_spin):
        _, c, s = self._polar(slip_speed, relative_spin)
        return Shares(c * (1.0 - 0.5 * s**2), self.radius * s * (1.0 - 0.5 * c**2))

    monkeypatch.setattr("reference_model.contact.contact_law.ThreeTermRing.shares", two_terms)
    _, claims = laws.expansion()
    assert {claim.verdict for claim in claims} == {Verdict.DIFFERS}


def test_points_in_the_wrong_places_are_found_out(monkeypatch):
    def uneven(self, angle):
        return [
            self.radius * np.exp(1j * (angle + 2.0 * np.pi * i / (self.points + 1)))
            for i in range(self.points)
        ]

    monkeypatch.setattr("reference_model.contact.contact_law.PointsOnRing.arms", uneven)
    monkeypatch.setattr(laws, "NUMBERS", (6,))
    _, (size, place) = laws.greatest_errors_of_points()
    assert Verdict.DIFFERS in (size.verdict, place.verdict)


def test_an_annulus_that_is_not_split_at_its_kink_is_found_out(monkeypatch):
    monkeypatch.setattr(Annulus, "_resting_radius", lambda self, slip, spin: self.outer_radius)
    assert Verdict.AGREES not in {claim.verdict for claim in laws.convergence()}


def test_an_annulus_with_all_its_load_outside_is_found_out(monkeypatch):
    monkeypatch.setattr(Annulus, "_pressure_at", lambda self, radius: radius)
    assert laws.in_place().verdict is Verdict.DIFFERS
    monkeypatch.setattr(Annulus, "_resting_radius", lambda self, slip, spin: self.inner_radius)
    monkeypatch.setattr(Annulus, "_loads", lambda self, centre: [(self.outer_radius, 1.0)])
    assert laws.thin().verdict is Verdict.DIFFERS


def test_the_top_of_a_parabola_is_found():
    place, size, error = laws.top(lambda ratio: 2.0 - (ratio - 0.9) ** 2, 1e-12)
    assert place == pytest.approx(0.9, abs=error)
    assert size == pytest.approx(2.0)
    assert error == pytest.approx(2e-6, rel=0.01)


def test_figures_are_drawn_whatever_is_there(theory):
    points_only = replace(engines(["exudyn"])[0], kinds=("pin", "points"))
    data = {
        "exudyn": study.measure(engines(["exudyn"])[0], **FEW).data,
        "theory": theory.data,
        "discrete": study.measure(points_only, **FEW).data,
    }
    assert set(study.draw(data)) == set(study.STUDY.figures)
    for part in ({}, {"theory": data["theory"]}, {"exudyn": data["exudyn"]}, {"discrete": data["discrete"]}):
        assert set(study.draw(part)) == set(study.STUDY.figures)
