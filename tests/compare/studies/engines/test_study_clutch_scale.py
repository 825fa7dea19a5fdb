"""The study of the clutch's scale agrees for every sound engine, and its claims fail for broken ones."""

import functools

import pytest
from studies_under_test import altered, verdicts

import exudyn_models
from compare.claims.claim import Verdict
from compare.engines import EVERY_KIND, Engine, engines
from compare.figures import saved
from compare.studies.engines.clutch_scale import claims as study
from compare.studies.engines.clutch_scale.units import CLUTCH

CLAIMS = (
    study.RESTS,
    study.STICKS,
    study.ENDS,
    study.WHIRLS,
    study.SPINS,
    study.CYCLES.format("the continuous ring"),
    study.CYCLES.format("six points"),
)


def absolute(system, initial_state, times, *, tolerance=1e-9):
    """Exudyn with ε in m/s: 100·tolerance whatever the size of the motion."""
    return exudyn_models.simulate(
        system, initial_state, times, tolerance=tolerance, regularisation=100.0 * tolerance
    )


FAULTS = {
    "friction 1 % off": altered(friction_force=1.01),
    "friction 10 % off": altered(friction_force=1.1),
    "half the damping": altered(damping=0.5),
    "ε in m/s": Engine("ε in m/s", absolute, EVERY_KIND),
}
SEEN = {
    "friction 1 % off": set(CLAIMS) - {study.ENDS},
    # What rests in space is not damped.
    "half the damping": set(CLAIMS) - {study.ENDS, study.SPINS},
}


@functools.cache
def measured(name):
    engine = FAULTS[name] if name in FAULTS else engines([name])[0]
    return study.measure(engine)


@pytest.mark.parametrize("name", ["reference"])
def test_every_statement_holds_in_a_sound_engine(name):
    assert verdicts(measured(name)) == dict.fromkeys(CLAIMS, Verdict.AGREES)


@pytest.mark.parametrize("fault", SEEN)
def test_claims_see_the_faults_that_concern_them(fault):
    found = verdicts(measured(fault))
    assert {sentence for sentence, verdict in found.items() if verdict is not Verdict.AGREES} >= SEEN[fault]
    assert list(found.values()).count(Verdict.DIFFERS) >= 5


def test_a_regularisation_in_metres_per_second_is_no_pass():
    """1e-7 m/s are 33 times the ε of this motion: what sticks creeps too far for the claim's resolution."""
    claim = study.sticks_claim(FAULTS["ε in m/s"])
    assert claim.verdict is not Verdict.AGREES


def test_ends_see_friction_that_is_far_too_strong():
    assert study.ends_claim(FAULTS["friction 10 % off"]).verdict is Verdict.DIFFERS


def test_an_ensemble_has_the_same_ends_at_both_scales():
    claim = study.shares_claim(starts=200)
    assert claim.verdict is Verdict.AGREES
    assert 0.0 < claim.measured[0] < 1.0


def test_scaling_keeps_the_dimensionless_numbers():
    pin = CLUTCH.system(study.FIG5)
    assert pin.offset == pytest.approx(1e-4)
    assert pin.disc_speed == pytest.approx(300.0)
    assert pin.disc_speed / pin.natural_frequency == pytest.approx(1.5)
    assert pin.friction_force / (pin.stiffness * pin.offset) == pytest.approx(0.9)
    disc, paper = CLUTCH.system(study.FIG8), study.FIG8
    for one in (
        lambda d: d.polar_inertia / (d.mass * d.contact_radius**2),
        lambda d: d.shaft_damping / (d.polar_inertia * d.disc_speed),
        lambda d: d.shaft_speed / d.disc_speed,
        lambda d: d.contact_radius / d.offset,
        lambda d: d.damping / (d.mass * d.disc_speed),
    ):
        assert one(disc) == pytest.approx(one(paper))


@pytest.mark.parametrize("data", [{}, {"theory"}, {"theory", "reference"}, {"reference"}])
def test_the_figure_is_drawn_whatever_is_there(data):
    everything = {"theory": study.theory(4).data, "reference": {"states": study.exact_motion().states}}
    figures = study.draw({name: everything[name] for name in sorted(data)})
    assert saved(figures["clutch-scale"])[1].startswith(b"\x89PNG")
