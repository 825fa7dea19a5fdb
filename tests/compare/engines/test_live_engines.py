"""Live foreign engines; tests of engines that are not installed are skipped."""

import importlib
import sys

import numpy as np
import pytest

from compare.engines import INSTALLED, KINDS, Engine, UnsupportedSystemError, engines, known_name
from reference_model import DiscOnDisc, FrictionJoint, PinOnDisc, simulate

NAMES = [f"{name}:{setting}" for name, known in INSTALLED.items() for setting in known.settings]
COARSE = 4e-3
ANOTHER_LAW = (
    *("mujoco:pyramid", "mujoco:elliptic", "mujoco:shipped", "bullet:box", "bullet:shipped"),
    *("dart:dantzig", "dart:pgs", "dart:shipped", "ode:shipped"),
)


def live(name):
    """Return the engine of that name, or skip the test."""
    try:
        return engines([name])[0]
    except ValueError as error:
        pytest.skip(str(error))


@pytest.mark.parametrize("name", INSTALLED)
def test_a_missing_engine_names_the_package_to_install(name, monkeypatch):
    adapter = f"compare.engines.live.{name}_engine"
    monkeypatch.setitem(sys.modules, adapter, None)  # as if its imports failed
    known = INSTALLED[name]
    with pytest.raises(ValueError, match=f"{known.title} is not installed .*: pip install {known.package}; "):
        engines([name])


@pytest.mark.parametrize("name", [*INSTALLED, *NAMES])
def test_engine_names_are_known_without_an_import(name, monkeypatch):
    monkeypatch.setattr(importlib, "import_module", None)
    assert known_name(name) == name


def test_the_default_setting_is_the_first():
    first = live("chipmunk")
    assert live("chipmunk:") == first == live("chipmunk:pivot")


@pytest.mark.parametrize("name", NAMES)
def test_errors_of_a_live_engine_fall_with_its_step(name):
    engine = live(name)
    assert isinstance(engine, Engine)
    assert set(engine.kinds) <= set(KINDS)
    assert engine.version
    assert not engine.phases
    hash(engine)  # the matrix uses it as a key
    slides = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=1.5, offset=0.1)
    if not engine.simulates(slides):
        pytest.skip("simulates only discs")
    times = np.linspace(0.0, 2.0, 5)
    exact = simulate(slides, (0.9, 0.0, 0.0, 0.9), times, tolerance=1e-12).states
    accuracy = (
        [{"step": COARSE}, {"step": COARSE / 4}]
        if engine.step
        else [{"tolerance": 1e-4}, {"tolerance": 1e-7}]
    )
    coarse, fine = (
        np.max(np.abs(engine.function(slides, (0.9, 0.0, 0.0, 0.9), times, **how).states - exact))
        for how in accuracy
    )
    assert (fine > 1e-3) if name in ANOTHER_LAW else fine < max(0.5 * coarse, 1e-6)


@pytest.mark.parametrize("name", NAMES)
def test_a_joint_of_a_live_engine_stops_and_breaks_away(name):
    engine = live(name)
    joint = FrictionJoint(inertia=0.5, friction_moment=2.0, moment=((1.0, 0.0), (3.0, 6.0)))
    if not engine.simulates(joint):
        pytest.skip("simulates no joints")
    times = np.linspace(0.0, 3.0, 7)
    exact = simulate(joint, (0.1, 2.0), times).states
    coarse, fine = (
        np.max(np.abs(engine.function(joint, (0.1, 2.0), times, step=step).states - exact))
        for step in (COARSE, COARSE / 4)
    )
    assert coarse < 0.5  # without friction, the joint would turn by 10 rad
    wrong = name in ("mujoco:shipped", "bullet:shipped")  # soft friction, and a damping of bodies
    assert (fine > 1e-3) if wrong else fine < max(0.5 * coarse, 1e-6)
    with pytest.raises(UnsupportedSystemError, match="one friction moment at rest and in motion"):
        engine.simulate(FrictionJoint(inertia=0.5, friction_moment=2.0, static_ratio=1.5), (0.0, 0.0), times)


@pytest.mark.parametrize(
    ("name", "moment"),
    [
        ("mujoco:condim-4", 0.8),
        ("mujoco:condim-6", 0.8),
        ("bullet:spinning", 1.0),
        ("chipmunk:gear", 1.0),
        ("box2d:torque", 1.0),
    ],
)
def test_one_contact_with_friction_against_spin_has_the_law_of_its_engine(name, moment):
    """Slip and rim have speeds of 0.6 and 0.8 m/s: an ellipse yields 0.8·μNR, separate limits μNR."""
    engine = live(name)
    disc = DiscOnDisc(
        mass=1.0, polar_inertia=1.0, stiffness=1e-6, damping=0.0, friction_force=1.0, disc_speed=0.0, offset=0.0,
        contact_radius=1.0, shaft_damping=0.0, shaft_speed=0.0, contact_points=None,
    )  # fmt: skip
    states = engine.function(disc, (0.0, 0.0, 0.0, 0.6, 0.0, 0.8), [0.0, 0.01], step=1e-3).states
    assert (0.8 - states[-1, 5]) / 0.01 == pytest.approx(moment, rel=1e-2)
