"""The examples and the README's code run, and give what they say."""

import re
import runpy
from pathlib import Path

import numpy as np
import pytest

from reference_model import simulate

ROOT = Path(__file__).parents[1]


def run(name):
    return runpy.run_path(str(ROOT / "examples" / name))


def test_the_two_motions_end_at_rest_in_space_and_on_the_whirl():
    example = run("01_two_motions.py")
    # Eq. 3: ρ* = √(X0² − (μN/C)²) = √(0.1² − 0.09²).
    assert example["to_equilibrium"].radius[-1] == pytest.approx(np.sqrt(0.1**2 - 0.09**2), abs=1e-8)
    assert example["to_whirl"].radius[-1] > 0.8
    # Exudyn's law is viscous below ε = 1e-7 m/s, which nine stick phases amplify to some 300·ε.
    assert example["in_exudyn"].at_end == pytest.approx(example["to_whirl"].at_end, abs=1e-4)
    assert "9 stick phases" in example["describe"](example["to_whirl"])


def test_the_steady_motions_are_those_of_the_formulas():
    example = run("02_steady_motions.py")
    assert (example["equilibrium"].x, example["equilibrium"].y) == pytest.approx(
        (0.019, 0.9 * np.sqrt(0.0019))
    )
    assert example["whirl"].radius == pytest.approx(0.9)  # μN/(βk)
    assert example["whirl"].frequency == 1.0
    assert example["radius"] == pytest.approx(0.02 / np.hypot(1.0 - 1.5**2, 0.15))
    # In a turn of the whirl the drive gives what the dampers and friction take.
    power = example["power"]
    heat = power.friction_heat[-1] + power.damper_heat[-1]
    assert power.drive_work[-1] == pytest.approx(heat, rel=1e-9)


def test_the_engine_of_the_example_slides_as_the_reference_does():
    engine = run("03_your_own_engine.py")["simulate"]
    pin = run("02_steady_motions.py")["pin"]
    times = np.linspace(0.0, 30.0, 31)
    start = (0.9, 0.0, 0.0, 0.9)
    exact = simulate(pin, start, times, tolerance=1e-12).states
    errors = [np.max(np.abs(engine(pin, start, times, tolerance=t).states - exact)) for t in (1e-6, 1e-8)]
    assert errors[0] < 1e-5
    assert errors[1] < 0.1 * errors[0]


def test_the_whirl_of_the_disc_gives_way_to_a_modulated_cycle():
    example = run("04_friction_disc.py")
    assert example["whirl"].eigenvalues[1].real > 0.0 > example["by_23"].eigenvalues[1].real
    swings = [motion.radius[-2500:] for motion in (example["trajectory"], example["in_exudyn"])]
    for radius in swings:
        assert radius.min() < 0.5 * example["whirl"].radius < 1.5 * example["whirl"].radius < radius.max()
    # The engines' errors grow with the whirl's own instability until the cycle holds them.
    assert swings[1] == pytest.approx(swings[0], abs=1e-6)


def test_the_engine_of_the_readme_is_that_of_the_example():
    code = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)[1]
    example = run("03_your_own_engine.py")
    names = {name: example[name] for name in ("solve_ivp", "Phase", "Solution", "Trajectory")}
    exec(code, names)
    arguments = (run("02_steady_motions.py")["pin"], (0.9, 0.0, 0.0, 0.9), np.linspace(0.0, 10.0, 11))
    assert np.array_equal(names["simulate"](*arguments).states, example["simulate"](*arguments).states)


def test_the_code_of_the_readme_gives_the_values_in_its_comments():
    code = re.search(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL).group(1)
    names = {}
    exec(code, names)
    trajectory = names["trajectory"]
    assert f"{trajectory.radius[-1]:.6f}" in code
    assert len(trajectory.stick_phases) == 9
    assert names["self_centred_equilibria"](names["pin"])[0].stable
    assert repr(names["whirl_orbit"](names["pin"]).mean.round(6)) in code
