"""Recordings of tosses: a simulated cube yields its own numbers, and invalid files give one line."""

import lzma
import re
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

sys.path.insert(0, str(Path(__file__).parents[4] / "builders"))

import reduce_tosses as reduction
import toss_flights as flights

TABLE = Path(__file__).parents[4] / "compare" / "studies" / "plane" / "tosses" / "slides.csv"

SCALE, CENTRE, RADIUS = 0.98, np.array([0.0, 0.3e-3, 5e-3]), 5.6e-3
GYRATION = np.array([2600.0, 2580.0, 2450.0]) * 1e-6
MU, SPIN, TURN = 0.22, 1.5, np.radians(2.0)
"""Deceleration over g, initial spin (rad/s) and turn (rad) from 0.6 to 0.12 m/s of each slide."""

SLOPE = 5e-3  # rad


def flown(place, velocity, heading, turn, spin, frames):
    """Return places of the centre of mass and attitudes in free flight over a board that slopes to the left."""
    t = np.arange(frames)[:, None] / flights.RATE
    pull = flights.GRAVITY * np.array([-SLOPE * np.sin(heading), SLOPE * np.cos(heading), -1.0])
    return place + velocity * t + 0.5 * pull * t**2, (Rotation.from_rotvec(t * spin) * turn).as_matrix()


def slid(heading, turn):
    """Return places and attitudes of a cube that slides to rest from 0.6 m/s, with a spin like its speed."""
    ends = 0.6 / (MU * flights.GRAVITY)
    t = np.minimum(np.arange(int(ends * flights.RATE) + 10) / flights.RATE, ends)
    fine = np.linspace(0.0, ends, 20001)
    speed = 0.6 - MU * flights.GRAVITY * fine
    direction = heading + TURN * (1.0 - speed / 0.6) / 0.8
    steps = np.concatenate(([0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(fine))))
    way = np.cumsum(np.diff(steps, prepend=0.0) * np.exp(1j * direction))
    at = np.interp(t, fine, way.real), np.interp(t, fine, way.imag)
    angles = SPIN * (t - 0.5 * t**2 / ends)
    turns = (Rotation.from_rotvec(np.outer(angles, (0.0, 0.0, 1.0))) * turn).as_matrix()
    height = flights.HALF_SIDE + (turns @ CENTRE)[:, 2]
    return np.column_stack((*at, height)), turns


def toss(number, random):
    """Return a recording: a flight, a bounce on one corner, another flight, and a slide elsewhere."""
    heading = random.uniform(-np.pi, np.pi)
    velocity = np.array([np.cos(heading), np.sin(heading), -0.8])
    before, spin = Rotation.random(random_state=random), random.normal(0.0, 6.0, 3)
    corner = flights.CORNERS[np.argmin((flights.CORNERS @ before.as_matrix().T)[:, 2])]
    arm = before.apply(corner * (flights.HALF_SIDE - RADIUS) - CENTRE) - np.array([0.0, 0.0, RADIUS])
    height = np.array([0.0, 0.0, -arm[2]])
    past = flown(height, -velocity, heading, before, -spin, 24)  # backwards in time from the bounce
    kick = np.array([-0.3 * np.cos(heading), -0.3 * np.sin(heading), 1.9])
    change = before.apply(before.inv().apply(np.cross(arm, kick)) / GYRATION)
    places, turns = flown(height, velocity + kick, heading, before, spin + change, 10)
    place, attitude = slid(heading, Rotation.from_rotvec([0.0, 0.0, random.uniform(0.0, 6.0)]))
    centres = np.concatenate((past[0][:0:-1], places, place))
    attitudes = np.concatenate((past[1][:0:-1], turns, attitude))
    recorded = SCALE * (centres - attitudes @ CENTRE) + random.normal(0.0, 2e-5, centres.shape)
    quaternions = Rotation.from_matrix(attitudes).as_quat()[:, [3, 0, 1, 2]]
    rows = np.column_stack((np.full(len(centres), number), np.arange(len(centres)), recorded, quaternions))
    return [",".join(f"{value:.9g}" for value in row) for row in rows]


@pytest.fixture(scope="module")
def lines():
    random = np.random.default_rng(3)
    return [reduction.COLUMNS, *(line for number in range(40) for line in toss(number, random))]


def reduced(folder, lines):
    path, output = folder / "tosses.csv.xz", folder / "table.csv"
    path.write_bytes(lzma.compress("\n".join(lines).encode()))
    assert reduction.main([str(path), "--output", str(output)]) == 0
    text = output.read_text("utf-8").splitlines()
    found = dict(line[2:].split(" = ") for line in text if " = " in line)
    constants = {name: [float(word) for word in value.split(" +- ")] for name, value in found.items()}
    names, *rows = (line.split(",") for line in text if not line.startswith("#"))
    return constants, [dict(zip(names, row, strict=True)) for row in rows]


def test_a_simulated_cube_yields_its_own_numbers(tmp_path, lines):
    constants, rows = reduced(tmp_path, lines)
    expected = {
        "length_scale": SCALE,
        "corner_radius_mm": 1e3 * RADIUS,
        "mean_mu": MU,
        "slope_mrad": 1e3 * SLOPE,
    }
    expected |= {f"centre_{axis}_mm": 1e3 * value for axis, value in zip("xyz", CENTRE, strict=True)}
    expected |= {f"gyration_{axis}_mm2": 1e6 * value for axis, value in zip("xyz", GYRATION, strict=True)}
    for name, value in expected.items():
        found, error = constants[name]
        # Straight lines through the flights at a bounce leave 0.05 mm of the corner.
        assert found == pytest.approx(
            value, abs=4.0 * error + 1e-3 * abs(value) + 0.05 * ("corner" in name)
        ), name
        assert error < 0.01 * abs(value) + 0.5, name
    assert len(rows) == 40
    for row in rows:
        assert row["up"] == "z"
        assert float(row["mu"]) == pytest.approx(MU, rel=0.02)
        assert float(row["spin_left"]) == pytest.approx(0.2 / float(row["speed_first"]), abs=0.02)
        expected = np.degrees(TURN) * (float(row["speed_first"]) - 0.12) / 0.48
        assert float(row["turn_deg"]) == pytest.approx(expected, abs=4.0 * float(row["turn_error"]))


@pytest.mark.parametrize(
    ("line", "text", "message"),
    [
        (0, "toss,frame,x", "line 1: expected the columns toss,frame,x_m,y_m,z_m,qw,qx,qy,qz"),
        (5, "0,4,1,2,3,1,0,0", "line 6: expected nine numbers, the last four a unit quaternion"),
        (5, "0,4,1,2,nan,1,0,0,0", "line 6: expected nine numbers, the last four a unit quaternion"),
        (5, "0,4,1,2,3,1,1,0,0", "line 6: expected nine numbers, the last four a unit quaternion"),
        (5, "0,5,1,2,3,1,0,0,0", "frames of toss 0 are missing or not in order"),
    ],
)
def test_an_invalid_recording_is_reported_in_one_line(tmp_path, capsys, lines, line, text, message):
    path = tmp_path / "tosses.csv"
    path.write_text("\n".join([*lines[:line], text, *lines[line + 1 : 30]]))
    assert reduction.main([str(path), "--output", str(tmp_path / "table.csv")]) == 1
    assert capsys.readouterr().err == f"{path}{', ' if 'line' in message else ': '}{message}\n"


def test_recordings_without_a_part_are_refused(tmp_path, capsys, lines, monkeypatch):
    monkeypatch.setattr(reduction, "bounces", lambda *_: [])
    path = tmp_path / "tosses.csv"
    first = [line for line in lines if line.startswith("0,")]
    for kept, message in (
        (first[:42], "none of 1 tosses ends with a slide from above 0.35 m/s"),
        (first[-30:], "no toss contains a free flight of 8 frames, so the scale is unknown"),
        (first, "0 bounces on one corner are too few to find the inertia"),
    ):
        renumbered = [re.sub(r"^0,\d+", f"0,{i}", line) for i, line in enumerate(kept)]
        path.write_text("\n".join([lines[0], *renumbered]))
        assert reduction.main([str(path), "--output", str(tmp_path / "table.csv")]) == 1
        assert capsys.readouterr().err == f"{message}\n"
    path = tmp_path / "tosses.csv.xz"
    path.write_bytes(lzma.compress(b"toss")[:-9])
    assert reduction.main([str(path), "--output", str(tmp_path / "table.csv")]) == 1
    assert capsys.readouterr().err.startswith(f"{path}: Compressed data ended")


def test_the_table_names_source_licence_filters_and_errors():
    text = TABLE.read_text("utf-8")
    for words in ("DAIRLab/contact-nets, commit c3dc21c9", "BSD-3-Clause", "Copyright (c) 2020"):
        assert words in text
    tosses, slides = re.search(r"# (\d+) tosses, (\d+) slides", text).groups()
    removed = sum(int(count) for count in re.findall(r"# - (\d+) tosses removed: ", text))
    rows = [line for line in text.splitlines() if not line.startswith("#")]
    assert int(tosses) == int(slides) + removed == len(rows) - 1 + removed == 312
    assert rows[0] == ",".join(reduction.NAMES)
