"""Coefficients and loads in the user functions of Exudyn: Python and numba functions, and their errors."""

import math
import subprocess
import sys
from itertools import product
from pathlib import Path

import numba
import numpy as np
import pytest
from pairs_of_bodies import bodies_of

from exudyn_models import add_ring_friction
from exudyn_models.forces.laws.tables import kept

RING = {"contact_radius": 0.12, "friction_coefficient": 0.3, "normal_load": 2.0, "regularisation": 1e-3}
PAIRS = [*product((None, "rotor"), ("rotor", "planar")), ("planar", "planar"), ("planar", "Tait-Bryan")]
"""Pairs with specialised functions, and one example of the others."""


def stribeck(slip_speed):
    return 0.25 + 0.05 * math.exp(-slip_speed / 0.5)


def all_of_them(time, radius, slip_speed, relative_spin):
    return 2.0 + time + 3.0 * radius + 5.0 * slip_speed + math.sin(relative_spin)


# Compiled once for all pairs of bodies.
TWO_BY_NUMBA = numba.njit(lambda radius: 2)
LAW = {"friction_coefficient": stribeck, "normal_load": all_of_them}
LAW_BY_NUMBA = {name: numba.njit(function) for name, function in LAW.items()}


def added(kinds, **law):
    mbs, nodes = bodies_of(kinds)
    return mbs, add_ring_friction(mbs, *nodes, **RING | law)


def forces(kinds, **law):
    """Return the forces of the user function at ten states, shape (10, n)."""
    mbs, friction = added(kinds, **law)
    force = friction._contact.functions["force"]
    size = sum(len(mbs.GetNodeParameter(node, "referenceCoordinates")) for node in friction.nodes)
    states = np.random.default_rng(2).normal(size=(10, 2, size)).tolist()
    return np.array([force(mbs, 0.7, 0, *state) for state in states])


@pytest.mark.parametrize("kinds", PAIRS, ids=str)
def test_a_function_gives_the_force_of_its_number_and_one_of_numba_that_of_python(kinds):
    constant = forces(kinds)
    assert np.abs(constant).max() > 0.01
    for law in (
        {"friction_coefficient": lambda slip_speed: 0.3},
        {"normal_load": lambda time, relative_spin: 2.0},
        {"friction_coefficient": [[0.0, 0.3], [1.0, 0.3], [2.0, 0.3]]},
        {"normal_load": TWO_BY_NUMBA},
    ):
        np.testing.assert_allclose(forces(kinds, **law), constant, rtol=1e-14, atol=1e-17)
    by_python, by_numba = forces(kinds, **LAW), forces(kinds, **LAW_BY_NUMBA)
    np.testing.assert_allclose(by_numba, by_python, rtol=1e-14, atol=1e-17)
    assert np.abs(by_python - constant).max() > 0.1 * np.abs(constant).max()


@numba.njit
def out_of_range(time):
    if time > 0.5:
        raise ZeroDivisionError("a word of its own")
    return -1.0


@pytest.mark.parametrize("function", [out_of_range, out_of_range.py_func], ids=["numba", "python"])
@pytest.mark.parametrize("kinds", [("rotor", "rotor"), ("planar", "planar")])
def test_errors_of_functions_are_passed_on_and_invalid_numbers_reported(kinds, function):
    mbs, friction = added(kinds, normal_load=function)
    force = friction._contact.functions["force"]
    size = sum(len(mbs.GetNodeParameter(node, "referenceCoordinates")) for node in friction.nodes)
    state = [0.1] * size, [0.3 * i for i in range(size)]
    with pytest.raises(ZeroDivisionError, match="a word of its own"):
        force(mbs, 0.7, 0, *state)
    with pytest.raises(ValueError, match=r"normal_load\(time = 0.25 s\) = -1 N: it must be >= 0"):
        force(mbs, 0.25, 0, *state)


@pytest.mark.parametrize("kinds", [("rotor", "planar"), ("planar", "planar")])
def test_anything_but_a_list_of_all_velocities_is_a_type_error(kinds):
    mbs, friction = added(kinds, normal_load=lambda radius: 2.0)
    force, size = friction._contact.functions["force"], len(friction._contact.reference)
    for wrong in ([0.1] * (size - 1), [0.1] * 15, ["a"] * size, (0.1,) * size, None):
        with pytest.raises(TypeError):
            force(mbs, 0.7, 0, [0.1] * size, wrong)


USE_OF_ALL_PARTS = """
import sys

sys.path.insert(0, sys.argv[1])
from free_bodies import new_model, planar_body, rotor, settings_of
import exudyn as exu
from exudyn_models import add_radial_support, add_ring_friction, solve_dynamic

for regularisation in (1e-3, None):
    mbs = new_model()
    nodes = rotor(mbs, 0.2, 9.0), planar_body(mbs, 0.6, 0.01, [0.001, 0.0, 0.0], [0.0] * 3)
    shaft = add_radial_support(mbs, None, nodes[1], stiffness=1e4, damping=20.0)
    contact = add_ring_friction(
        mbs, *nodes, contact_radius=0.1, friction_coefficient=0.3, normal_load=8.0, regularisation=regularisation
    )
    contact.add_sensor("heat"), contact.add_sensor("mode"), shaft.add_sensor("force")
    mbs.Assemble()
    solve_dynamic(mbs, settings_of(0.05, 50), exu.DynamicSolverType.TrapezoidalIndex2)
"""

COMPILED = """
import gc

from numba.core.dispatcher import Dispatcher

for one in gc.get_objects():
    if isinstance(one, Dispatcher) and one.stats.cache_misses:
        print(one.py_func.__name__)
"""


def test_a_second_process_compiles_nothing_that_takes_long(monkeypatch):
    """Functions that Python calls are cached on disk, including those of sensors and Jacobians."""
    folder = str(Path(__file__).parents[1])
    monkeypatch.setattr(sys, "argv", ["", folder])
    exec(USE_OF_ALL_PARTS, {})  # the first process is this one
    run = subprocess.run(
        [sys.executable, "-c", USE_OF_ALL_PARTS + COMPILED, folder],
        capture_output=True,
        text=True,
        check=True,
    )
    assert set(run.stdout.split()) <= {
        "secant_stiffness",
        "elastic_energy",
        "share_of_ring",
        "impl",
    }  # 0.1 s each


def test_a_contact_that_changes_often_keeps_no_memory():
    _, friction = added(("planar", "planar"))
    before = kept.cache_info().currsize
    for load in range(50):
        friction.change(normal_load=1.0 + load)
    assert kept.cache_info().currsize == before
