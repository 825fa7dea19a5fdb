"""Compiled runs: closed forms, interruptions, and the same bits as interpreted."""

import _thread
import cmath
import functools
import math
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
from random_systems import TIMES, RandomMotion

from compare.claims.parameters import FIG5, FIG5_STARTS
from reference_model import Annulus, DiscOnDisc, PinOnDisc, Ring, ThreeTermRing, simulate, simulation
from reference_model.contact.contact_law import IsotropicContact
from reference_model.core import single
from reference_model.core.run import follow

SECOND = list(FIG5_STARTS.values())[1]
"""A start with nine stick phases."""

SHAFT = {"polar_inertia": 0.02, "contact_radius": 0.2, "shaft_damping": 0.0, "shaft_speed": 0.0}


@pytest.mark.parametrize("body", ["pin", "ring", "annulus"])
@pytest.mark.parametrize("excess", [1e-15, 1e-13, 1e-11, 1e-9, 1e-6, 1e-5, 1e-4, 1e-3, 3e-3])
def test_body_whose_pull_exceeds_friction_by_a_hair_and_falls_slips_briefly(excess, body):
    """Slip a·e·t − ½·|ȧ|·t² along the pull a ends after 2e·a/|ȧ|, to first order in the excess e."""
    omega, place, offset, damping = 0.5, 0.3 * cmath.exp(5.5j), 1.0, 0.1
    # a = p + q·exp(iωt)
    turning = complex(omega**2 - 1.0, -damping * omega) * place
    pull = abs(offset + turning)
    rate = ((offset + turning).conjugate() * 1j * omega * turning).real / pull
    parameters = {
        "mass": 1.0, "stiffness": 1.0, "damping": damping, "friction_force": pull / (1.0 + excess),
        "disc_speed": omega, "offset": offset,
    }  # fmt: skip
    v = 1j * omega * place
    start, chosen = [place.real, place.imag, v.real, v.imag], {}
    system = PinOnDisc(**parameters)
    if body != "pin":
        system = DiscOnDisc(**parameters, **SHAFT)
        start[2:2], start[6:] = [0.0], [omega]
    if body == "annulus":
        chosen["contact"] = Annulus(0.1, 0.2)
    found = simulate(system, start, [0.0, 1.0], compiled=True, **chosen)
    assert [phase.kind for phase in found.phases] == ["slip", "stick"]
    # The excess is known to rounding of the pull.
    error = 2.0 * excess + 2e-5 + 3e-16 / excess
    assert found.phases[0].end == pytest.approx(2.0 * excess * pull / -rate, rel=error)
    assert found.solution.steps < 200


@pytest.mark.parametrize("points", ["pin", None, 6])
@pytest.mark.parametrize("excess", [1e-16, 1e-13, 1e-12, 1e-11, 1e-9, 1e-6])
def test_body_whose_constant_pull_exceeds_friction_by_a_hair_slips_for_half_a_swing(excess, points):
    """Slip e·X0·k·sin(kt) ends at π/k; an excess within the rounding error of the pull does not count."""
    parameters = {
        "mass": 1.0, "stiffness": 1.0, "damping": 0.0, "friction_force": 1.0 / (1.0 + excess), "disc_speed": 0.0,
        "offset": 1.0,
    }  # fmt: skip
    system, start = PinOnDisc(**parameters), [0.0] * 4
    if points != "pin":
        system, start = DiscOnDisc(**parameters, **SHAFT, contact_points=points), [0.0] * 6
    found = simulate(system, start, [0.0, 4.0], compiled=True)
    if excess < 4e-16:
        assert [phase.kind for phase in found.phases] == ["stick"]
        return
    assert [phase.kind for phase in found.phases] == ["slip", "stick"]
    # A parabola describes the last 0.1 of a sine, with an error of 0.1³/3. The way is known to rounding of the pull.
    assert found.phases[0].end == pytest.approx(math.pi, abs=4e-4)
    assert found.at_end[0] == pytest.approx(2.0 * excess, rel=1e-3 + 1e-15 / excess)


@pytest.mark.parametrize("duration", [267.0, 500.0])
@pytest.mark.parametrize("tolerance", [1e-5, 1e-6, 1e-7])
def test_overdamped_pin_creeps_as_in_closed_form(tolerance, duration):
    pin = PinOnDisc(mass=1.0, stiffness=1.0, damping=8.44, friction_force=0.00285, disc_speed=0.0, offset=0.0)
    found = simulate(
        pin, [1.0, 0.0, 0.0, 0.0], np.linspace(0.0, duration, 90), tolerance=tolerance, compiled=True
    )
    rates = np.roots([1.0, pin.damping, 1.0])
    sizes = np.linalg.solve([[1.0, 1.0], rates], [1.0 - pin.friction_force, 0.0])
    exact = pin.friction_force + np.exp(np.outer(found.times, rates)) @ sizes
    assert [phase.kind for phase in found.phases] == ["slip"]
    assert np.abs(found.states[:, 0] - exact).max() < tolerance
    assert found.solution.steps < 500


@pytest.mark.parametrize("contact", [None, Annulus(0.1, 0.2)], ids=["ring", "annulus"])
def test_angle_after_a_thousand_turns(contact):
    disc = DiscOnDisc(
        mass=1.0, stiffness=1.0, damping=0.0, friction_force=0.05, disc_speed=0.8, offset=0.1, polar_inertia=0.02,
        contact_radius=0.2, shaft_damping=2.0, shaft_speed=83.0,
    )  # fmt: skip
    start, times = [0.15, 0.05, 0.0, 0.1, 0.0, 83.0], [0.0, 100.0]
    found, tight = (
        simulate(disc, start, times, tolerance=tolerance, compiled=True, contact=contact).at_end[2]
        for tolerance in (1e-9, 1e-12)
    )
    assert abs(found - tight) < 13e-9
    assert found > 8000.0


RING, POINTS = RandomMotion.of(1), RandomMotion.of(8)


@pytest.mark.parametrize(
    ("system", "start"),
    [(FIG5, SECOND), (RING.system, RING.start), (POINTS.system, POINTS.start)],
    ids=["pin", "ring", "points"],
)
def test_motion_depends_neither_on_the_requested_times_nor_on_the_length_of_a_call(
    system, start, monkeypatch
):
    times = np.linspace(0.0, 60.0, 601)
    fine = simulate(system, start, times, compiled=True)
    monkeypatch.setattr(single, "MOST_WORK", 1.0)
    coarse = simulate(system, start, times[::50], compiled=True)
    np.testing.assert_array_equal(fine.states[::50], coarse.states)
    assert fine.stick_times.tolist() == coarse.stick_times.tolist()
    assert fine.solution.steps == coarse.solution.steps
    assert fine.stick_phases


@pytest.mark.parametrize("seed", [0, 1, 2, 9, 13, 14, 24, 40])
def test_compiled_code_computes_the_same_bits_as_python(seed):
    random = RandomMotion.of(seed)
    system, times = random.system, TIMES[TIMES < 4.0]
    found = simulate(system, random.start, times, compiled=True)
    plain = simulate(system, random.start, times, compiled=False)
    np.testing.assert_array_equal(found.states, plain.states)
    assert [phase.start for phase in found.phases] == [phase.start for phase in plain.phases]


@pytest.fixture
def without_cache(monkeypatch):
    """Return the motions that compiled code was asked for."""
    asked = []
    monkeypatch.setattr(simulation, "is_compiled", lambda: False)
    monkeypatch.setattr(simulation, "compiled_core", lambda: asked.append(True) or follow)
    monkeypatch.setattr(simulation, "_interpreted", 0.0)
    return asked


def test_a_machine_without_compiled_code_compiles_when_python_has_taken_as_long(without_cache, monkeypatch):
    run = functools.partial(simulate, FIG5, SECOND, [0.0, 1.0])
    run()
    assert not without_cache
    monkeypatch.setattr(simulation, "COMPILATION", 0.0)
    run()
    assert without_cache == [True]


def test_runs_that_cannot_be_compiled_do_not_count(without_cache):
    simulate(FIG5, SECOND, [0.0, 1.0], compiled=False)
    simulate(RING.system, RING.start, [0.0, 1.0], contact=ThreeTermRing(0.1))
    assert simulation._interpreted == 0.0
    assert not without_cache


class OwnRing(IsotropicContact):
    """The law of a ring as a user would write it."""

    def __init__(self, radius):
        self.law = Ring(radius)

    resting_radii = property(lambda self: self.law.resting_radii)

    def shares(self, slip_speed, relative_spin):
        return self.law.shares(slip_speed, relative_spin)

    def slopes(self, slip_speed, relative_spin):
        return self.law.slopes(slip_speed, relative_spin)


@pytest.mark.parametrize("seed", [7, 19, 49])
def test_laws_of_the_user_move_a_disc_like_the_laws_of_the_core(seed):
    random = RandomMotion.of(seed)
    radius, times = random.system.contact_radius, TIMES[:26]
    even = Annulus(0.4 * radius, radius, pressure=lambda _: 1.0)
    for own, known in ((OwnRing(radius), Ring(radius)), (even, Annulus(0.4 * radius, radius))):
        found, expected = (simulate(random.system, random.start, times, contact=law) for law in (own, known))
        assert [phase.kind for phase in found.phases] == [phase.kind for phase in expected.phases]
        assert np.abs(found.states - expected.states).max() < 2.0 * 13e-9


def test_a_law_with_more_kinks_than_the_core_can_meet_is_refused():
    class Three(OwnRing):
        resting_radii = (0.1, 0.2, 0.3)

    with pytest.raises(
        ValueError, match=r"resting_radii = \(0.1, 0.2, 0.3\): at most two radii are possible"
    ):
        simulate(RING.system, RING.start, [0.0, 1.0], contact=Three(0.1))


@pytest.fixture
def obeyed():
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # background processes ignore it
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("obeyed")
def test_long_run_can_be_interrupted():
    start = [0.1, 0.0, 0.03, 0.0]
    simulate(FIG5, start, [0.0, 1.0], compiled=True)  # compiles
    timer = threading.Timer(0.2, _thread.interrupt_main)
    began = time.process_time()
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        simulate(FIG5, start, [0.0, 1.4e6], compiled=True)
    assert time.process_time() - began < 1.0  # the whole run takes 2 s


def test_digest_of_compiled_code_does_not_depend_on_the_order_of_imports():
    digests = {
        subprocess.run(
            [
                sys.executable, "-c",
                f"import reference_model.core.{first}; from reference_model.core import run;"
                "from reference_model.numerics import parts;"
                "print(parts.digest_with_parts(run.advance))",
            ],
            capture_output=True, text=True, check=True,
        ).stdout
        for first in ("steps.collocation", "limit")
    }  # fmt: skip
    assert len(digests) == 1
