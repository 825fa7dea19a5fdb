"""The examples and the code in README and docs run, and give the stated results."""

import ast
import importlib
import re
import runpy
import sys
from dataclasses import replace
from functools import cache
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread as read_image
from scipy.integrate import solve_ivp

from compare.cli import app as cli
from compare.engines import EVERY_KIND, Engine, reference
from compare.studies.drivetrain.coupled_clutches.theory import BREAKS, switches
from exudyn_models import PASSENGER_CAR
from fmu_models.archive import compiler
from reference_model import DiscOnDisc, PinOnDisc, self_centred_equilibria, simulate

ROOT = Path(__file__).parents[1]
DOCUMENTS = ["README.md", *(f"docs/{path.name}" for path in sorted((ROOT / "docs").glob("*.md")))]
DOCUMENTS = [name for name in DOCUMENTS if "```python" in (ROOT / name).read_text(encoding="utf-8")]
RUN_ELSEWHERE = {"docs/sweeps.md"}
"""Run in tests/compare/sweep/test_sweep_command.py, with the store of a sweep."""

VALUE = re.compile(r"True|False|-?\d+(?:\.(\d+))?")
"""Number in a comment, rounded to its decimal places."""


@cache
def run(name):
    return runpy.run_path(str(ROOT / "examples" / name))


def code_of(document):
    return re.findall(r"```python\n(.*?)```", (ROOT / document).read_text(), re.DOTALL)


def test_the_two_motions_of_the_pin_end_at_rest_in_space_and_on_the_whirl():
    example = run("01_pin.py")
    # Eq. 3: ρ* = √(X0² − (μN/C)²) = √(0.1² − 0.09²).
    assert example["to_equilibrium"].radius[-1] == pytest.approx(np.sqrt(0.1**2 - 0.09**2), abs=1e-8)
    assert example["to_whirl"].radius[-1] > 0.8
    # Exudyn's law is viscous below ε = 1e-7 m/s, which nine stick phases amplify to some 300·ε.
    assert example["in_exudyn"].at_end == pytest.approx(example["to_whirl"].at_end, abs=1e-4)
    assert "9 stick phases" in example["describe"](example["to_whirl"])


def test_a_block_stops_straight_ahead_by_a_cone_and_too_soon_by_a_box():
    example = run("10_block_on_a_plane.py")
    block = PinOnDisc(mass=1.0, stiffness=0.0, damping=0.0, friction_force=1.0, disc_speed=0.0)
    start, times = [0.0, 0.0, *np.sqrt([0.5, 0.5])], [0.0, 1.5]
    stops = [example[law](block, start, times, step=0.01).at_end for law in ("cone", "box")]
    assert stops[0] == pytest.approx([*np.sqrt([0.125, 0.125]), 0.0, 0.0], abs=1e-3)  # half a metre
    assert stops[1] == pytest.approx([0.25, 0.25, 0.0, 0.0], abs=1e-3)  # each axis separately


@pytest.mark.parametrize(
    ("name", "printed"),
    [
        ("05_your_own_engine.py", r"largest error at a tolerance of 1e-8: \de-0[789] m or m/s\n"),
        ("07_engine_under_pytest.py", r"Euler: error \de-0[123] .*\nRunge–Kutta: error \de-(?:0[6-9]|1\d) "),
        ("10_block_on_a_plane.py", r"cone: .* 0\.500 m \(Coulomb: 0\.5 m\)\nbox: .* 0\.35\d m "),
    ],
)
def test_an_example_prints_the_number_that_it_is_about(name, printed, monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", [name])
    runpy.run_path(str(ROOT / "examples" / name), run_name="__main__")
    assert re.match(printed, capsys.readouterr().out)


def test_exudyn_keeps_the_rates_of_first_order_with_full_newton_only():
    example = run("11_exudyn_first_order_rates.py")
    right = example["expected"]()
    assert example["obtained"](False) == pytest.approx(right, rel=1e-6)
    assert (
        abs(example["obtained"](True) - right) > 1.0
    )  # if this fails, Exudyn is repaired: remove our workaround


def test_the_steady_motions_of_the_pin_are_those_of_the_formulas():
    example = run("01_pin.py")
    assert (example["equilibrium"].x, example["equilibrium"].y) == pytest.approx(
        (0.019, 0.9 * np.sqrt(0.0019))
    )
    assert example["whirl"].radius == pytest.approx(0.9)  # μN/(βk)
    assert example["whirl"].frequency == 1.0
    assert example["radius"] == pytest.approx(0.02 / np.hypot(1.0 - 1.5**2, 0.15))
    # In a turn of the whirl the drive supplies the losses of dampers and friction.
    power = example["power"]
    heat = power.friction_heat[-1] + power.damper_heat[-1]
    assert power.drive_work[-1] == pytest.approx(heat, rel=1e-9)


def test_the_whirl_of_the_disc_gives_way_to_a_modulated_cycle():
    example = run("02_disc.py")
    assert example["whirl"].eigenvalues[1].real > 0.0 > example["by_23"].eigenvalues[1].real
    swings = [motion.radius[-2500:] for motion in (example["trajectory"], example["in_exudyn"])]
    for radius in swings:
        assert radius.min() < 0.5 * example["whirl"].radius < 1.5 * example["whirl"].radius < radius.max()
    # Errors grow with the whirl's instability until the motion reaches the cycle.
    assert swings[1] == pytest.approx(swings[0], abs=1e-6)


def test_the_disc_of_two_rotors_comes_to_rest_where_the_reference_has_its_equilibrium():
    example = run("03_two_rotors.py")
    speed, spin = example["flywheel_speed"][-1, 0], example["disc_velocity"][-1, 2]
    x, y = example["place"][-1, :2]
    offset, drag = example["OFFSET"], example["DRAG"]
    (expected,) = self_centred_equilibria(
        DiscOnDisc(
            mass=0.6,
            polar_inertia=0.01,
            stiffness=1e4,
            damping=20.0,
            friction_force=0.3 * 800.0,
            disc_speed=speed,
            offset=offset,
            contact_radius=0.1,
            shaft_damping=drag,
            shaft_speed=0.0,
        )
    )
    # The flywheel settles most slowly, at droop/inertia = 12 1/s, so exp(−24) = 4e-11 remains; the disc follows at
    # once.
    assert (x, y) == pytest.approx((expected.x, expected.y), abs=1e-10 * offset)
    assert spin == pytest.approx(expected.spin, abs=1e-10 * speed)
    # The shaft's force −C(z − X0) has the moment −C·X0·y about the flywheel's axis. Friction transmits all of it.
    moments = example["MOTOR_TORQUE"] - example["MOTOR_DROOP"] * speed - drag * spin - 1e4 * offset * y
    assert moments == pytest.approx(0.0, abs=1e-10 * example["MOTOR_TORQUE"])


def test_the_energy_of_two_rotors_is_accounted_for_to_a_share_of_its_smallest_part():
    balance = run("03_two_rotors.py")["balance"]
    smallest = balance.losses["shaft"][-1]
    assert 0.0 < smallest < 1e-5 * balance.losses["friction"][-1]
    assert np.max(np.abs(balance.residual)) < 1e-3 * smallest


def test_controlled_slip_falls_with_the_time_constant_of_the_closed_form():
    example = run("04_slip_control.py")
    times, slip, start, target = (example[name] for name in ("times", "slip", "START", "TARGET"))
    # RK44 multiplies the solution of s' = −s/T by 1 − x + x²/2 − x³/6 + x⁴/24, x = h/T, in every step.
    x = example["RATE"] * (times[1] - times[0])
    growth = 1.0 - x + x**2 / 2.0 - x**3 / 6.0 + x**4 / 24.0
    by_rk44 = target + (start - target) * growth ** np.arange(len(times))
    np.testing.assert_allclose(slip, by_rk44, rtol=0.0, atol=1e-10)
    np.testing.assert_allclose(by_rk44, example["closed_form"], rtol=0.0, atol=1e-4)
    # In the end the clutch transmits the vehicle's share of the engine's torque.
    engine, vehicle = example["ENGINE"], example["VEHICLE"]
    assert example["torque"][-1] == pytest.approx(example["TORQUE"] * vehicle / (engine + vehicle), rel=1e-6)


def test_the_engine_of_the_example_slides_as_the_reference_does():
    engine = run("05_your_own_engine.py")["simulate"]
    pin = run("01_pin.py")["pin"]
    times = np.linspace(0.0, 30.0, 31)
    start = (0.9, 0.0, 0.0, 0.9)
    exact = simulate(pin, start, times, tolerance=1e-12).states
    errors = [np.max(np.abs(engine(pin, start, times, tolerance=t).states - exact)) for t in (1e-6, 1e-8)]
    assert errors[0] < 1e-5
    assert errors[1] < 0.1 * errors[0]


def test_the_clutch_disc_centres_itself_and_whirls_against_its_stop_at_speed():
    example = run("06_drivetrain.py")
    motion, speed, radius, deflection = (example[n] for n in ("motion", "speed", "radius", "deflection"))
    assert np.max(np.abs(motion.energy.residual)) < 1e-6 * motion.energy.turnover
    # The engine's ripple alone changes the slip by ±T·r/(J·2ω).
    ripple = example["TORQUE"] / PASSENGER_CAR.engine_inertia / (2.0 * motion.engine_speed[0])
    np.testing.assert_allclose(motion.slip, example["SLIP"], rtol=0.0, atol=ripple)
    below, above = (speed > 2250.0) & (speed < 2500.0), speed > 3300.0
    assert radius[below].max() < PASSENGER_CAR.offset
    assert deflection[below].max() < PASSENGER_CAR.stop_gap < deflection[above].max()
    # A whirl at k that hits the stop head-on penetrates by p: ½·C_s·p² = ½·m·(k·gap)².
    whirl = PASSENGER_CAR.stop_gap * np.sqrt(PASSENGER_CAR.radial_stiffness / PASSENGER_CAR.stop_stiffness)
    assert deflection.max() < PASSENGER_CAR.stop_gap + whirl


def gear_change_by_scipy(example, epsilon):
    """Return speeds of engine, shafts and wheels and the heat of both clutches at the end, for ``epsilon`` in m/s."""
    names = ("ENGINE", "SHAFTS", "VEHICLE", "RATIOS", "TORQUE", "RESISTANCE", "RADIUS")
    engine_inertia, shaft_inertias, vehicle, ratios, torque, resistance, radius = (
        example[name] for name in names
    )
    capacity = example["PLATES"] * example["FRICTION_COEFFICIENT"] * radius

    def rates(t, y):
        (engine, *shafts, wheels), twists = y[:4], y[4:6]
        slip = engine - np.array(shafts)
        loads = np.array([example["opening"](t), example["closing"](t)])
        moments = capacity * loads * np.clip(radius * slip / epsilon, -1.0, 1.0)
        winding = shafts - np.array(ratios) * wheels
        gears = example["STIFFNESS"] * twists + example["DAMPING"] * winding
        speeding = (moments - gears) / shaft_inertias, (gears @ ratios - resistance) / vehicle
        return [
            (torque - moments.sum()) / engine_inertia,
            *speeding[0],
            speeding[1],
            *winding,
            *moments * slip,
        ]

    state = np.array([*example["speeds"][0], example["twist"], 0.0, 0.0, 0.0])
    for part in pairwise((0.0, example["BEGIN"], example["END"], example["UNTIL"])):
        state = solve_ivp(rates, part, state, method="LSODA", rtol=1e-10, atol=1e-10).y[:, -1]
    return state[[0, 1, 2, 3, 6, 7]]


def test_coupled_clutches_stick_and_release_at_the_times_of_the_closed_form():
    example = run("08_coupled_clutches.py")
    exact = sorted({*BREAKS, *(time for time, *_ in switches())})
    found = [change.time for change in example["changes"]]
    np.testing.assert_allclose(found, exact, rtol=0.0, atol=2e-5)
    assert [float(example["mbs"].GetSensorValues(mode)) for mode in example["modes"]] == [2.0, 0.0, 0.0]


def test_the_engine_for_joints_breaks_away_like_the_reference():
    example = run("09_joint_engine.py")
    exact, motion = example["exact"], example["motion"]
    assert exact.phases[1].start == pytest.approx(0.6)  # 1.5·2 N m at 5 N m/s
    np.testing.assert_allclose(motion.states, exact.states, rtol=0.0, atol=1e-3 * exact.at_end[1])


def test_a_dual_clutch_changes_gear_and_heats_as_the_equations_say():
    example = run("12_dual_clutch.py")
    balance = example["balance"]
    assert np.max(np.abs(balance.residual)) < 1e-6 * balance.turnover
    heats = [balance.losses[name][-1] for name in ("first clutch", "second clutch")]
    coarse, fine = (gear_change_by_scipy(example, epsilon) for epsilon in (1e-4, 5e-5))
    expected = 2.0 * fine - coarse  # without creep, which is of first order in ε
    # The heat of the first clutch, which slips only briefly, has the largest error.
    np.testing.assert_allclose([*example["speeds"][-1], *heats], expected, rtol=1e-4)
    engine, _, second, wheels = example["speeds"][-1]
    assert engine == pytest.approx(second, abs=1e-9)
    assert [int(change.after) for change in example["changes"]][-1] == 0
    assert second == pytest.approx(example["RATIOS"][1] * wheels, rel=1e-4)


def test_a_car_starts_on_a_slope_changes_gear_and_holds():
    """Each clutch and the second synchroniser lock once, and the brakes hold at the beginning and at the end."""
    example = run("13_car_on_a_slope.py")
    car, balance = example["car"], example["balance"]
    assert balance.imbalance == ""
    names = {int(contact.item): name for name, contact in car.contacts.items()}
    locked = [names[change.contact] for change in car.changes if change.after == 0]
    assert sorted(locked) == ["clutch 1", "clutch 2", "left brake", "right brake", "synchroniser 2"]
    assert car.speed("left wheel") == pytest.approx(0.0, abs=1e-12)
    assert abs(car.speed("car")) < 1e-6


def test_a_disc_in_exudyns_viewer_centres_itself():
    x, y = run("14_in_exudyns_viewer.py")["final_position"]()
    # Eq. 3, X0 = 40 mm, μN/C = 0.3·480/4000 m = 36 mm: ρ*² = X0² − (μN/C)².
    assert (x, y) == pytest.approx((0.0076, 0.9 * np.sqrt(0.04**2 - 0.036**2)), abs=1e-6)


@pytest.mark.parametrize("name", [path.name for path in sorted((ROOT / "examples").glob("[01]*.py"))])
def test_an_example_draws_its_picture_of_the_gallery(name, tmp_path):
    picture = f"gallery/{Path(name).stem}.png"
    assert f"]({picture})" in (ROOT / "docs" / "gallery.md").read_text(encoding="utf-8")
    shown = read_image(ROOT / "docs" / picture)
    if name == "14_in_exudyns_viewer.py":  # its viewer needs a display
        return
    run(name)["draw"](tmp_path / "drawn.png")
    assert read_image(tmp_path / "drawn.png").shape == pytest.approx(shown.shape, abs=2)


def test_the_claim_of_the_guide_for_contributors_agrees_draws_and_detects_its_fault(tmp_path, monkeypatch):
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8").partition("## How a claim is born")[2]
    blocks = re.findall(r"```(?:markdown|python)\n(.*?)```", text, re.DOTALL)
    (tmp_path / "pin" / "at_rest").mkdir(parents=True)
    names = ("study.md", "study.py", "pictures.py", "__init__.py")
    for name, content in zip(names, blocks, strict=False):
        code = content.replace("compare.studies.pin.at_rest", "at_rest")
        (tmp_path / "pin" / "at_rest" / name).write_text(code, encoding="utf-8")
    monkeypatch.syspath_prepend(tmp_path / "pin")
    study = importlib.import_module("at_rest").STUDY
    measured = sys.modules["at_rest.study"].rests(reference)
    difference = np.abs(np.subtract(measured.predicted, measured.value))
    assert np.all(difference <= measured.error)
    assert np.max(measured.error) < 1e-6  # the resolution of its claim
    assert study.title == "The pin at rest"
    weak = Engine(
        "weak", lambda pin, *a, **k: simulate(replace(pin, friction_force=0.0891), *a, **k), EVERY_KIND
    )
    faulty = sys.modules["at_rest.study"].rests(weak)
    assert np.linalg.norm(np.subtract(faulty.predicted, faulty.value)) > 1e-3
    assert np.max(faulty.error) < 1e-10
    (figure,) = sys.modules["at_rest.pictures"].draw({"reference": measured.data}).values()
    figure.savefig(tmp_path / "drawn.png")


@pytest.mark.parametrize("document", [name for name in DOCUMENTS if name not in RUN_ELSEWHERE])
def test_the_code_of_the_documents_gives_the_values_in_its_comments(document, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    if document == "docs/fmu.md":
        if compiler() is None:
            pytest.skip("there is no C compiler")
        text = (ROOT / document).read_text(encoding="utf-8")
        command = re.search(r"^friction-discs (export-fmu .* clutch\.fmu)$", text, re.MULTILINE)
        assert cli.status(command[1].split()) == 0
    given = set(tmp_path.iterdir())
    names, compared = {}, 0
    for code in code_of(document):
        lines = code.splitlines()
        for statement in ast.parse(code).body:
            if not isinstance(statement, ast.Expr):
                exec(compile(ast.Module([statement], []), document, "exec"), names)
                continue
            value = eval(compile(ast.Expression(statement.value), document, "eval"), names)
            _, mark, comment = lines[statement.end_lineno - 1].partition("  # ")
            if mark and value is not None:
                said = list(VALUE.finditer(comment))
                for found, match in zip(np.ravel(value), said, strict=False):
                    digits = len(match[1] or "")
                    assert round(float(found), digits) == float(ast.literal_eval(match[0])), comment
                assert len(said) >= np.size(value), f"no value is said of {lines[statement.lineno - 1]}"
                compared += 1
    assert compared >= 2
    assert set(tmp_path.iterdir()) == given, "a run has left files"


def test_a_limited_slip_differential_on_ice_moves_exactly():
    """The left tyre needs T·(1 − 2·ramp) − preload; all speeds are quadratic before and after it spins."""
    example = run("15_limited_slip_differential.py")
    car, wheel, case, radius, rise, until = (
        example[name] for name in ("CAR", "WHEEL", "CASE", "RADIUS", "TORQUE", "UNTIL")
    )
    ice, whole = example["ICE"] * example["LOAD"] * radius, case + 2.0 * wheel + car * radius**2
    for name, start in example["starts"].items():
        preload, ramp = example["DIFFERENTIALS"][name]
        needed = ((1.0 - case / whole) / 2.0 * (1.0 - 2.0 * ramp) - wheel / whole) * rise
        spins = (ice + preload) / needed
        system = np.array(
            [
                [case, 0.0, 0.0, 2.0],
                [0.0, wheel, 0.0, 2.0 * ramp - 1.0],
                [0.0, 0.0, wheel + car * radius**2, -1.0 - 2.0 * ramp],
                [-2.0, 1.0, 1.0, 0.0],
            ]
        )
        constant = np.linalg.solve(system, [0.0, -ice - preload, preload + ice, 0.0])[:3]
        rising = np.linalg.solve(system, [rise, 0.0, 0.0, 0.0])[:3]
        exact = rise / whole * spins**2 / 2.0 + constant * (until - spins)
        exact += rising * (until**2 - spins**2) / 2.0
        assert [change.time for change in start.changes] == pytest.approx(
            [spins] * len(start.changes), abs=1e-9
        )
        assert [start.end(part) for part in ("case", "left", "right")] == pytest.approx(exact, abs=1e-7)
        balance = start.read_balance()
        assert np.max(np.abs(balance.residual)) < 1e-6 * balance.turnover


def test_a_clutch_judders_as_its_eigenvalues_and_scipy_say():
    example = run("16_clutch_judder.py")
    inertias = np.array([example[name] for name in ("ENGINE", "DISC", "CAR")])
    load, radius, stiffness, damping = (example[name] for name in ("LOAD", "RADIUS", "STIFFNESS", "DAMPING"))
    shaft, clutch = np.outer([0.0, 1.0, -1.0], [0.0, 1.0, -1.0]), np.outer([1.0, -1.0, 0.0], [1.0, -1.0, 0.0])
    governor = np.diag([example["GOVERNOR"], 0.0, 0.0])
    for row, column in ((0, 0), (4, 10), (15, 39)):
        slip, at = example["SLIPS"][column], example["DAMPINGS"][row]
        slope = -load * radius**2 * 0.05 / 0.6 * np.exp(-radius * slip / 0.6)
        lower = -np.hstack((stiffness * shaft, at * shaft + slope * clutch + governor)) / inertias[:, None]
        values = np.linalg.eigvals(np.vstack((np.eye(3, 6, 3), lower)))
        vibrations = values[np.abs(values.imag) > 1.0]
        assert example["ratios"][row, column] == pytest.approx(
            np.min(-vibrations.real / np.abs(vibrations)), rel=1e-5
        )

    def rates(t, state):
        (twist, engine, disc, car) = state
        moment = radius * load * example["coefficient"](radius * (engine - disc))
        torque = example["TORQUE"] + example["GOVERNOR"] * (example["SPEED"] - engine)
        held = stiffness * twist + damping * (disc - car)
        return disc - car, *(np.array([torque - moment, moment - held, held]) / inertias)

    def sticks(t, state):
        return state[1] - state[2]

    sticks.terminal = True
    speed = example["SPEED"]
    start = [radius * load * example["coefficient"](radius * speed) / stiffness, speed, 0.0, 0.0]
    found = solve_ivp(rates, (0.0, example["UNTIL"]), start, events=sticks, rtol=1e-11, atol=1e-11)
    assert example["changes"][0].time == pytest.approx(found.t[-1], abs=1e-3)
    assert [int(change.after) for change in example["changes"]] == [0, -1, 0, -1, 0]


def test_an_eight_speed_automatic_has_the_published_ratios_and_shifts_as_scipy_says():
    """Ratios are those that ZF publishes for the 8HP70; events divide the run into smooth phases."""
    example = run("17_eight_speed_automatic.py")
    ratios = {gear: np.divide(*example["speeds_in"](gear, 1.0)[[0, -1]]) for gear in example["GEARS"]}
    published = [4.696, 3.130, 2.104, 1.667, 1.285, 1.0, 0.839, 0.667, -3.297]
    assert list(ratios.values()) == pytest.approx(published, abs=6e-4)
    slips = example["SLIPS"] | {"lock-up": example["row"](("engine", -1.0), ("input", 1.0))}
    inertias, resistance = np.array(list(example["INERTIAS"].values())), example["RESISTANCE"]
    converter, engine = np.array(example["CONVERTER"]).T, np.array(example["ENGINE"]).T
    loads = example["SHIFTS"].loads | {"lock-up": example["lock_up_load"]}

    def solution(t, speeds, held, slides):
        pump, turbine = speeds[:2]
        fast = max(pump, turbine)
        moment = np.interp(min(pump, turbine) / fast, converter[0], converter[1] ** -2.0) * fast**2
        gain = np.interp(turbine / pump, converter[0], converter[2])
        forces = np.zeros(len(speeds))
        forces[0] = np.interp(pump, *engine) - (moment if pump >= turbine else -moment)
        forces[1] = moment * gain if pump >= turbine else -moment
        way = resistance["radius"] * speeds[-1]
        drag = 0.6 * resistance["drag_area"] * way**2 + resistance["rolling"] * resistance["mass"] * 9.81
        forces[-1] = -resistance["radius"] * drag
        for name, direction in slides.items():
            forces -= direction * 0.05 * loads[name](t) * slips[name]
        rows = np.array([*example["GEAR_ROWS"], *(slips[name] for name in held)])
        size = len(speeds)
        system = np.zeros((size + len(rows),) * 2)
        system[:size, :size], system[:size, size:], system[size:, :size] = np.diag(inertias), -rows.T, rows
        found = np.linalg.solve(system, np.concatenate((forces, np.zeros(len(rows)))))
        return found[:size], dict(zip(held, found[size + len(example["GEAR_ROWS"]) :], strict=True))

    def phase(times, speeds, held, slides, event=None):
        if event is not None:
            event.terminal = True
        found = solve_ivp(
            lambda t, y: solution(t, y, held, slides)[0], times, speeds, events=event, rtol=1e-10, atol=1e-10
        )
        return found.t[-1], found.y[:, -1]

    starts = example["speeds_in"]("3", example["START"])
    _, y = phase((0.0, 0.5), np.array([1.1 * starts[0], *starts]), "BCE", {})
    over = {"D": np.sign(slips["D"] @ y)}
    release, y = phase(
        (0.5, 0.9), y, "BCE", over,
        lambda t, y: 0.05 * loads["C"](t) - abs(solution(t, y, "BCE", over)[1]["C"]),
    )  # fmt: skip
    over["C"] = -np.sign(solution(release, y, "BCE", over)[1]["C"])
    lock, y = phase((release, 0.9), y, "BE", over, lambda t, y: slips["D"] @ y)
    _, y = phase((lock, 0.9), y, "BDE", {"C": over["C"]})
    _, y = phase((0.9, 2.0), y, "BDE", {})
    closing = {"lock-up": np.sign(slips["lock-up"] @ y)}
    closed, y = phase((2.0, 3.0), y, "BDE", closing, lambda t, y: slips["lock-up"] @ y)
    _, y = phase((closed, 3.0), y, ["B", "D", "E", "lock-up"], {})
    car = example["car"]
    times, names, modes = zip(*car.events(), strict=True)
    assert list(zip(names, modes, strict=True)) == [
        ("D", over["D"]), ("C", over["C"]), ("D", 0), ("C", 2), ("lock-up", closing["lock-up"]), ("lock-up", 0),
    ]  # fmt: skip
    assert times == pytest.approx([0.5, release, lock, 0.9, 2.0, closed], abs=1e-5)
    ends = [float(car.mbs.GetSensorValues(sensor)) for sensor in car.speeds.values()]
    assert ends == pytest.approx(y, abs=1e-4)
    assert np.max(np.abs(example["balance"].residual)) < 1e-6 * example["balance"].turnover
