"""The study of Fig. 11 agrees for every sound engine, and its claims fail for broken ones."""

from __future__ import annotations

import functools
import math
from dataclasses import replace

import numpy as np
import pytest
from studies_under_test import verdicts

from compare.claims.claim import Verdict
from compare.engines import EVERY_KIND, Engine, engines
from compare.studies.disc.fig11 import claims as study
from compare.studies.disc.fig11 import cycle, growth, offset, pictures
from compare.studies.toolkit.fig11_motion import DISCS, RING, SIX
from reference_model import simulate, whirl_orbit, whirls

RING_WORDS, SIX_WORDS = DISCS

FEW = (0.006, 0.009, 0.022)
"""X0 in m on all three sides of the critical ones."""

OF_RING = {
    cycle.TRAJECTORY.format(RING_WORDS),
    growth.RATE.format(RING_WORDS),
    growth.FREQUENCY.format(RING_WORDS),
    cycle.MODULATION,
    cycle.EXTREMES,
    offset.CRITICAL,
    offset.ENDS,
}
OF_SIX = {
    cycle.TRAJECTORY.format(SIX_WORDS),
    growth.RATE.format(SIX_WORDS),
    growth.FREQUENCY.format(SIX_WORDS),
    cycle.RESTS,
    cycle.SIX_EXTREMES,
}
OF_THEORY = {cycle.SHOOTING, growth.STABILITY, growth.DECAY, offset.BOTH}


def changed(name, kinds=EVERY_KIND, factors=None, **values):
    """Return an engine that computes with other parameters than it is asked for."""

    def simulated(system, initial_state, times, *, tolerance=1e-9):
        other = {key: factor * getattr(system, key) for key, factor in (factors or {}).items()}
        run = simulate(replace(system, **(values | other)), initial_state, times, tolerance=tolerance)
        return replace(run, system=system)

    return Engine(name, simulated, kinds)


FRICTION_OFF = changed("friction 0.1 % off", factors={"friction_force": 1.001})
WITHOUT_OFFSET = changed("no offset", ("ring",), offset=0.0)
FIVE_POINTS = changed("five points", ("points",), contact_points=5)


def wrong(system, initial_state, times, *, tolerance=1e-9):
    """A disc with Fig. 11's law replaced by (23)."""
    return simulate(system, initial_state, times, tolerance=tolerance, contact=growth.EXPANSION)


EXPANDED = Engine("(23)", wrong, ("ring",))


def only(kind):
    """Return Exudyn as an engine that knows one kind of contact."""
    return Engine(f"exudyn, {kind}", engines(["exudyn"])[0].function, (kind,))


@functools.cache
def measured(name):
    engine = engines([name])[0] if name == "reference" else only(name)
    return study.measure(engine, FEW)


@functools.cache
def theory():
    return study.theory()


def test_every_statement_holds_in_the_reference():
    assert verdicts(measured("reference")) == dict.fromkeys(OF_RING | OF_SIX, Verdict.AGREES)


@pytest.mark.parametrize(
    ("kind", "statements", "lacking"),
    [("ring", OF_RING, "a disc on single points"), ("points", OF_SIX, "a disc on a continuous ring")],
)
def test_an_engine_of_one_kind_of_contact_is_measured_by_what_it_simulates(kind, statements, lacking):
    findings = measured(kind)
    assert verdicts(findings) == dict.fromkeys(statements, Verdict.AGREES)
    assert findings.not_simulated == f"exudyn, {kind} does not simulate {lacking}"


def test_the_theory_holds():
    assert verdicts(theory()) == dict.fromkeys(OF_THEORY, Verdict.AGREES)


SEEN = {
    "trajectory: friction": lambda: [cycle.trajectory_claim(FRICTION_OFF, RING_WORDS, RING)],
    "trajectory: five points": lambda: [cycle.trajectory_claim(FIVE_POINTS, SIX_WORDS, SIX)],
    "trajectory: (23)": lambda: [cycle.trajectory_claim(EXPANDED, RING_WORDS, RING)],
    "growth: friction, ring": lambda: growth.growth_claims(FRICTION_OFF, RING_WORDS, RING),
    "growth: five points": lambda: growth.growth_claims(FIVE_POINTS, SIX_WORDS, SIX),
    "growth: (23)": lambda: growth.growth_claims(EXPANDED, RING_WORDS, RING),
    "cycle: friction": lambda: cycle.measure_cycle(FRICTION_OFF).claims,
    "six points: five": lambda: cycle.measure_six_points(FIVE_POINTS).claims,
    "critical offset: friction": lambda: [offset.critical_claim(FRICTION_OFF)],
    "critical offset: none": lambda: [offset.critical_claim(WITHOUT_OFFSET)],
    "ends: no offset": lambda: [offset.ends_claim(WITHOUT_OFFSET, 0.00726, FEW)[0]],
}
"""What each claim sees; a motion beside the whirl is not small, which may leave its growth inconclusive."""


@pytest.mark.parametrize("fault", SEEN)
def test_claims_see_the_faults_that_concern_them(fault):
    found = {claim.sentence: claim.verdict for claim in SEEN[fault]()}
    assert found
    assert Verdict.AGREES not in found.values()


def test_many_points_lose_their_stability_like_the_ring():
    """Points are a quadrature of the ring: it converges faster than any power while no point comes near to rest."""
    exact = growth.steady_whirl(RING).eigenvalue
    errors = [
        abs(growth.steady_whirl(replace(RING, contact_points=points)).eigenvalue - exact)
        for points in (6, 12, 24)
    ]
    # If the error fell like a power, each doubling would divide it by the same number.
    assert errors[0] / errors[1] < errors[1] / errors[2]
    assert errors[2] < 1e-3 * abs(exact)


def test_modes_of_the_whirl_are_eigenvectors_of_its_growth():
    """The share of the pair in a deviation along the mode is a half, and not that of the conjugate."""
    for disc in DISCS.values():
        whirl = growth.steady_whirl(disc)
        assert whirl.projection @ whirl.mode == pytest.approx(1.0, abs=1e-9)
        assert abs(whirl.projection @ whirl.mode.conj()) < 1e-5


def test_the_growth_of_an_exponential_is_found_with_its_scatter():
    times = np.linspace(0.0, 200.0, 33)
    share = 0.7j * np.exp((0.01 + 0.03j) * times)
    slopes, scatter = growth._fitted(times, share)
    assert slopes == pytest.approx([0.01, 0.03], abs=1e-12)
    assert np.all(scatter < 1e-12)
    noise = 1e-4 * np.random.default_rng(3).standard_normal(len(times))
    slopes, scatter = growth._fitted(times, share * (1.0 + noise))
    assert 0.0 < abs(slopes[0] - 0.01) < 2.0 * scatter[0] < 1e-5


def test_multipliers_by_variation_are_the_exponentials_of_the_eigenvalues_of_the_circle():
    circle = whirl_orbit(RING, tolerance=1e-10, samples=2)
    multipliers = offset.multipliers_by_variation(RING, circle)
    exact = np.exp(np.array(whirls(RING)[0].eigenvalues) * 2.0 * math.pi / RING.natural_frequency)
    assert sorted(np.abs(multipliers)) == pytest.approx(sorted(np.abs(exact)), abs=1e-8)


def test_the_whirl_ends_where_a_pair_of_eigenvalues_of_the_equilibrium_crosses_the_axis():
    below, above = (
        offset.self_centred_equilibria(offset.disc_at(offset.rest_offset() + shift))[0]
        for shift in (-1e-5, 1e-5)
    )
    assert above.stable
    assert not below.stable
    assert abs(below.eigenvalues[0].imag) == pytest.approx(RING.natural_frequency, rel=0.01)


def test_lines_of_a_known_modulation_are_its_side_bands():
    """A carrier whose size swings by a cosine has one side band on each side, with half of the swing."""
    period, carrier = 230.0, 1.002
    size = 0.02 + 0.01 * np.cos(2.0 * math.pi * cycle.TIMES / period)
    z = size * np.exp(1j * carrier * cycle.TIMES)
    states = np.column_stack((z.real, z.imag, *np.zeros((4, len(z)))))
    heights = pictures.harmonics(states, period, carrier)
    expected = np.zeros(2 * pictures.SIDE_BANDS + 1)
    expected[pictures.SIDE_BANDS - 1 : pictures.SIDE_BANDS + 2] = 0.005, 0.02, 0.005
    of_spline = (
        0.03 * cycle.TIMES[1] ** 4 / 384.0
    )  # a cubic spline's error, of a function with derivatives below 0.03
    assert heights == pytest.approx(expected, abs=of_spline)
    frequency, amplitude = pictures.spectrum(states)
    assert frequency[np.argmax(amplitude)] == pytest.approx(carrier, abs=math.pi / cycle.UNTIL)
    assert np.max(amplitude) == pytest.approx(0.02, rel=0.05)


def test_a_motion_without_a_modulation_has_none():
    z = 0.02 * np.exp(1j * cycle.TIMES)
    states = np.column_stack((z.real, z.imag, *np.zeros((4, len(z)))))
    last, change = cycle.last_modulation(states)
    assert last.shape == change.shape == (6,)


@pytest.mark.parametrize(
    "names",
    [("reference", "ring", "theory"), ("reference",), ("points", "theory"), ("points",), ("theory",), ()],
    ids=str,
)
def test_figures_are_drawn_whatever_is_there(names):
    data = {name: theory().data if name == "theory" else measured(name).data for name in names}
    figures = study.STUDY.draw(data)
    assert set(figures) <= set(study.STUDY.figures)
    if {"theory", "reference"} <= set(names):
        assert set(figures) == set(study.STUDY.figures)
    for figure in figures.values():
        figure.canvas.draw()
