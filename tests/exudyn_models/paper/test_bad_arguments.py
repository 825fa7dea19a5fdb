from dataclasses import replace

import numpy as np
import pytest

from compare.claims.parameters import FIG5, FIG11
from exudyn_models import eigenvalues, simulate, simulate_fixed_step, simulate_with_native_contact

POINTS = replace(FIG11, contact_points=4)
STARTS = {FIG5: [1.3, 0.0, 0.0, -1.3], FIG11: [0.05, 0.0, 0.4, 0.0, 0.05, 1.3]}
STARTS[POINTS] = STARTS[FIG11]
ENGINES = simulate, simulate_fixed_step, simulate_with_native_contact
WRONG = [
    *((engine, POINTS, {"initial_state": [0.0] * 4}, "DiscOnDisc takes 6 numbers") for engine in ENGINES),
    *((engine, FIG5, {"times": [1.0, 0.0]}, "times must increase") for engine in ENGINES),
    (simulate, FIG5, {"tolerance": 0.0}, "tolerance = 0"),
    (simulate, FIG5, {"regularisation": 0.0}, "regularisation = 0 m/s"),
    (simulate, FIG5, {"regularisation": np.inf}, "regularisation = inf"),
    (simulate, FIG11, {"solver": "magic"}, "solver = 'magic': it must be one of explicit, implicit"),
    (simulate, FIG5, {"friction": 1}, "friction = 1: it must be a Friction"),
    (
        simulate_fixed_step,
        FIG5,
        {"integrator": "Euler"},
        "integrator = 'Euler': it must be one of RK44, RK67",
    ),
    (simulate_fixed_step, FIG5, {"step": 0.0}, "step = 0 s: it must be > 0"),
    (simulate_fixed_step, FIG5, {"step": np.nan}, "step = nan"),
    (simulate_with_native_contact, FIG5, {"tolerance": 0.0}, "tolerance = 0"),
    (simulate_with_native_contact, FIG11, {}, "contact_points = None: Exudyn's built-in contact supports"),
]


@pytest.mark.parametrize(("engine", "system", "change", "message"), WRONG)
def test_arguments_of_a_simulation(engine, system, change, message):
    arguments = {"initial_state": STARTS[system], "times": [0.0, 1.0]}
    if engine is simulate_fixed_step:
        arguments["step"] = 0.1
    with pytest.raises(ValueError, match=message):
        engine(system, **arguments | change)


@pytest.mark.parametrize(
    ("system", "state", "message"),
    [
        (FIG11, [0.0, 0.0, 0.0, 0.0, 0.0, FIG11.disc_speed], "at rest, where friction has no derivative"),
        # Point 0 lies where both discs have the same velocity.
        (POINTS, [0.0, 0.0, 0.0, 0.0, 0.12, FIG11.disc_speed - 1.0], "or a point of it, is at rest"),
        (FIG11, [0.0, 0.0, 0.0, 0.0], "DiscOnDisc takes 6 numbers"),
    ],
)
def test_eigenvalues_of_a_contact_without_a_derivative(system, state, message):
    with pytest.raises(ValueError, match=message):
        eigenvalues(system, state)
