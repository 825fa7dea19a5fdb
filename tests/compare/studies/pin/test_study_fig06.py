"""The study of Fig. 6 agrees for every sound engine, and each of its claims fails for broken ones."""

import functools
from dataclasses import replace

import numpy as np
import pytest
from broken_engines import broken_engines
from studies_under_test import altered, verdicts

from compare.claims.claim import Verdict
from compare.engines import engines
from compare.studies.pin.fig06 import claims as study
from reference_model import whirl_orbit
from reference_model.formulas.pin import equilibrium_radius, sticking_radius

EQUILIBRIUM_LOADS = (0.04, 0.095)  # of broken engines
WHIRL_LOADS = (0.12,)


def whirls_claim(engine):
    return study.whirls_claim(
        engine, {load: study.whirl(engine, load, study.SHOOTING) for load in WHIRL_LOADS}
    )


CLAIMS = {
    study.EQUILIBRIA: functools.partial(study.equilibria_claim, loads=EQUILIBRIUM_LOADS),
    study.WHIRLS: whirls_claim,
    study.LAST_WHIRL: study.last_whirl_claim,
    study.COEXIST: study.coexistence_claim,
    study.CYCLE: study.cycle_claim,
    study.CYCLE_STABLE: study.cycle_stability_claim,
}


FAULTS = broken_engines() | {
    "friction 1 % off": altered(friction_force=0.99),
    "damping 70 % too strong": altered(damping=1.7),
}

SEES, BLIND = Verdict.DIFFERS, Verdict.AGREES
NO_ORBIT = "no whirl near the guess"
"""What the search says that finds none; the runner shows the engine as one that failed, with this sentence."""

NO_WHIRL = "no whirl near the guess, or another orbit"
"""By how rounding leads the search where there is none."""

NO_PASS = "differs, or is inconclusive"
TAKES_LONG = None  # and is left out

TABLE = {
    #                  EQUILIBRIA WHIRLS   LAST_WHIRL COEXIST CYCLE  CYCLE_STABLE
    "wrong sign": (SEES, SEES, TAKES_LONG, SEES, SEES, SEES),
    # Such pins stick, and have whirls, of their own: that both exist is right for them too.
    "square": (SEES, SEES, NO_ORBIT, BLIND, SEES, SEES),
    # Its cycle is unstable, so that errors grow with what is measured.
    "half the damping": (SEES, SEES, SEES, BLIND, SEES, NO_PASS),
    "friction 1 % off": (SEES, SEES, TAKES_LONG, BLIND, SEES, SEES),
    # The whirl ends at 1.7 times the load then, 0.13 N. The pin still sticks, and comes to rest in the same place.
    "damping 70 % too strong": (BLIND, NO_WHIRL, NO_ORBIT, SEES, SEES, SEES),
}


@functools.cache
def claim_of(fault, sentence):
    return CLAIMS[sentence](FAULTS[fault])


@pytest.mark.parametrize("name", ["reference", "intact"])
def test_every_statement_holds_in_a_sound_engine(name):
    engine = FAULTS[name] if name in FAULTS else engines([name])[0]
    findings = study.measure(engine, whirl_loads=(0.08, 0.12))
    assert verdicts(findings) == dict.fromkeys(CLAIMS, Verdict.AGREES)


@pytest.mark.parametrize("sentence", [study.EQUILIBRIA, study.WHIRLS, study.COEXIST, study.CYCLE])
def test_the_quick_statements_hold_in_exudyn(sentence):
    assert CLAIMS[sentence](engines(["exudyn"])[0]).verdict is Verdict.AGREES


@pytest.mark.parametrize(
    ("fault", "sentence", "expected"),
    [
        (fault, sentence, expected)
        for fault, row in TABLE.items()
        for sentence, expected in zip(CLAIMS, row, strict=True)
        if expected is not TAKES_LONG
    ],
)
def test_each_claim_sees_the_faults_that_concern_it(fault, sentence, expected):
    try:
        claim = claim_of(fault, sentence)
    except RuntimeError as error:
        if NO_ORBIT not in str(error) or expected not in (NO_ORBIT, NO_WHIRL):
            raise
        return
    allowed = {NO_ORBIT: (), NO_WHIRL: (SEES,), NO_PASS: (SEES, Verdict.INCONCLUSIVE)}
    assert claim.sentence == sentence
    assert claim.verdict in allowed.get(expected, (expected,))


def test_half_the_damping_makes_the_stick_slip_cycle_unstable():
    claim = claim_of("half the damping", study.CYCLE_STABLE)
    assert claim.predicted < 1.0 < claim.measured


@pytest.fixture(scope="module")
def data():
    reference = engines(["reference"])[0]
    found = {
        "whirl loads": np.array([0.12]),
        "whirl extents": np.array([study.extent(study.whirl(reference, 0.12, study.SHOOTING))]),
        "equilibrium loads": np.array([0.04]),
        "equilibrium radius": np.array([equilibrium_radius(replace(study.FIG6, friction_force=0.04))]),
    }
    return {"theory": study.theory(innermost=0.3, step=0.25).data, "reference": found, "exudyn": found}


def test_theory_follows_the_branch_through_the_fold_to_orbits_that_stick(data):
    theory = data["theory"]
    loads = theory["branch load"]
    fold = int(np.argmin(loads))
    assert 0 < fold < len(loads) - 1
    assert theory["branch sticks"][0] == 0.0
    assert theory["branch sticks"][-1] == 1.0
    assert np.all(theory["branch extent"][:, 0] < theory["branch extent"][:, 1])
    outermost = whirl_orbit(replace(study.FIG6, friction_force=study.WHIRL_LOADS[-1]))
    assert theory["branch extent"][0] == pytest.approx(study.extent(outermost), abs=1e-4)


def test_the_equilibrium_ends_where_sticking_begins(data):
    """(5): at μN = C·X0 the radius (3) is zero, and (9) starts from zero."""
    theory = data["theory"]
    assert np.all(theory["equilibrium load"] < study.LIMIT)
    assert np.all(theory["sticking load"] > study.LIMIT)
    near = [replace(study.FIG6, friction_force=factor * study.LIMIT) for factor in (1.0 - 1e-6, 1.0 + 1e-6)]
    assert equilibrium_radius(near[0]) < 2e-3 * study.FIG6.offset
    assert sticking_radius(near[1]) < 1e-5 * study.FIG6.offset


NAMES = [("theory", "reference", "exudyn"), ("theory", "exudyn"), ("reference", "exudyn"), ("theory",)]


@pytest.mark.parametrize("names", NAMES, ids="+".join)
def test_figures_are_drawn_whatever_is_there(data, names):
    figures = study.draw({name: data[name] for name in names})
    assert set(figures) == set(study.STUDY.figures)
    for figure in figures.values():
        figure.canvas.draw()
